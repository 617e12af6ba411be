"""The shipped model: made from what is in the repository (`make pretrain`), and read from a file of the package.

It is the open-world model with relations: the 53 hand-made examples, and generated lessons on what words for relations
mean. No human corpus enters it.
"""

from __future__ import annotations

import sys
from importlib.resources import files
from pathlib import Path

from dcg_torch.grounding.features import PAPER, Group
from dcg_torch.learning.word_posterior import Assumptions, WordPosterior
from dcg_torch.lessons import initial_training
from dcg_torch.lessons.generated import generated_lessons
from dcg_torch.model import GroundingModel, TrainingSet, Variant
from dcg_torch.model.checkpoint import load, save

VARIANT = Variant(groups=PAPER | {Group.OPEN, Group.RELATION}, beam=12)
LESSONS = 1000
_ROUNDS = 2
_SHIPPED = Path(str(files("dcg_torch.model"))) / "shipped"


def pretrained() -> GroundingModel:
    """The shipped model: it knows cube, sphere and cylinder, colours, relations, and learns everything else."""
    return load(_SHIPPED)


def train_open_world(
    training: TrainingSet, variant: Variant = VARIANT, lessons: int = LESSONS, assumed: Assumptions | None = None
) -> GroundingModel:
    """An open-world model from the hand-made examples and so many generated lessons.

    Args:
        training: the hand-made examples, or others of their kind.
        variant: with the feature group `relation` if there are lessons.
        assumed: what its learner takes for granted.
    """
    from dcg_torch.language import default_parser

    model = GroundingModel.trained(training, variant, WordPosterior.start(training, assumed))
    if lessons and Group.RELATION in variant.groups:
        model.teach(generated_lessons(default_parser().parse, lessons), relations_only=True, rounds=_ROUNDS)
    return model


def main() -> int:
    """Make the shipped model anew."""
    save(train_open_world(initial_training()), _SHIPPED)
    size = sum(path.stat().st_size for path in _SHIPPED.iterdir())
    print(f"{_SHIPPED}: {size / 1e6:.2f} MB")
    return 0


if __name__ == "__main__":
    sys.exit(main())
