"""Grounding commands to known, unknown and unseen objects, and learning new words from the outcome.

A reimplementation of DCG-UPUP-Away (Tucker, Aksaray, Paul, Roy: "DCG-UPUP-Away: Automatic Symbol Learning through
Grounding to Unknowns") on PyTorch, with an experiment around it in PyBullet, and what goes beyond the paper.

How the paper is read here:

* Eq. 4 normalises over {-1, 0, 1}, eqs. 6, 8 and 9 over {0, 1}. Both are one setting (`Variant.ternary`), and
  INVERTED is really trained: "stay away from the cube".
* Eq. 6 as printed leaves the sum over F_U outside exp; eq. 8 shows what is meant. F_BCG there is F_DCG.
* A command means one thing: phi* is sought among the configurations in which each phrase corresponds to exactly one
  grounding (`grounding.graph`).
* "Known" is a fact about the training set, so an example recorded while "cone" was unknown changes its meaning when
  the word is learned; `commit_first.replace_unknown` covers its negatives too. The hand-made examples that teach
  "unknown" use invented nouns, which no later lesson can make known.
* M.train takes all of M.Gamma: beside the object that was meant, training sees one of every other known type
  (`commit_first.contrast`).
* While the grounding is hypothetical the robot turns and grounds anew with what it has seen; lines 16 to 25 follow once
  a command, from the last grounding.

The names below are what most users import; each is loaded when it is first used.
"""

from __future__ import annotations

import importlib
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from dcg_torch.fitting.fit import FitResult
    from dcg_torch.fitting.psi import LogLinearFactor
    from dcg_torch.grounding.explanation import explain, rivalry
    from dcg_torch.grounding.features import Group
    from dcg_torch.grounding.graph import FactorGraph
    from dcg_torch.grounding.solution import Solution
    from dcg_torch.language import Parse, Parser
    from dcg_torch.language import parse_command as parse
    from dcg_torch.lessons import initial_training, read_training
    from dcg_torch.model import Experience, GroundingModel, Learned, Told, TrainingSet, Variant
    from dcg_torch.model.checkpoint import load, save
    from dcg_torch.model.pretrain import pretrained
    from dcg_torch.scene.workspace import Workspace
    from dcg_torch.types import Correspondence, Example, Object, ParseTree, Percept, Phrase, Pose, Symbol, WorldModel

__version__ = "0.2.0"

_WHERE = {
    "model.checkpoint": "load save",
    "grounding.explanation": "explain rivalry",
    "grounding.features": "Group",
    "grounding.graph": "FactorGraph",
    "fitting.fit": "FitResult",
    "fitting.psi": "LogLinearFactor",
    "grounding.solution": "Solution",
    "language": "Parse Parser",
    "lessons": "initial_training read_training",
    "model": "Experience GroundingModel Learned Told TrainingSet Variant",
    "model.pretrain": "pretrained",
    "scene.workspace": "Workspace",
    "types": "Correspondence Example Object ParseTree Percept Phrase Pose Symbol WorldModel",
}
_MODULES = {name: module for module, names in _WHERE.items() for name in names.split()}

__all__ = [
    "Correspondence",
    "Example",
    "Experience",
    "FactorGraph",
    "FitResult",
    "GroundingModel",
    "Group",
    "Learned",
    "LogLinearFactor",
    "Object",
    "Parse",
    "ParseTree",
    "Parser",
    "Percept",
    "Phrase",
    "Pose",
    "Solution",
    "Symbol",
    "Told",
    "TrainingSet",
    "Variant",
    "Workspace",
    "WorldModel",
    "explain",
    "initial_training",
    "load",
    "parse",
    "pretrained",
    "read_training",
    "rivalry",
    "save",
]


def __getattr__(name: str) -> Any:
    """Load a public name from its room."""
    if name == "parse":
        return importlib.import_module("dcg_torch.language").parse_command
    if name not in _MODULES:
        raise AttributeError(f"module 'dcg_torch' has no attribute {name!r}")
    return getattr(importlib.import_module(f"dcg_torch.{_MODULES[name]}"), name)


def __dir__() -> list[str]:
    """The public names, loaded or not."""
    return sorted({*globals(), *__all__})
