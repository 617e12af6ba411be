"""Plain things to compare with, on the same episodes and the same candidates as the model.

    overlap   words of the text that are words of the class or the colour; first mention first
    nearest   the nearest to the robot of those that `overlap` names
    outcomes  `overlap`, and how often each word went with each type: in training, and then in its own choices
    bow       logistic regression on words x properties of an object
    minilm    cosines of a sentence embedding

A baseline has state of its own: `fit`, then `predict` and `learn` episode by episode.
"""

from dcg_torch.evaluation.baselines.base import Baseline, Guess
from dcg_torch.evaluation.baselines.registry import BASELINES, make_baseline
from dcg_torch.evaluation.baselines.run import run_baseline

__all__ = ["BASELINES", "Baseline", "Guess", "make_baseline", "run_baseline"]
