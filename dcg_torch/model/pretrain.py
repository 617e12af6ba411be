"""The shipped model: made from what is in the repository (`cli.pretrain`), and read from a file of the package.

It is the open-world model with relations: the 53 hand-made examples, and generated lessons on what words for relations
mean. No human corpus enters it.
"""

from __future__ import annotations

from dataclasses import replace
from importlib.resources import files
from pathlib import Path

from dcg_torch.grounding.features import PAPER, FeatureSet, Group
from dcg_torch.learning.word_posterior import Assumptions, WordPosterior
from dcg_torch.model import GroundingModel, TrainingSet, Variant
from dcg_torch.model.checkpoint import load

VARIANT = Variant(groups=PAPER | {Group.OPEN, Group.RELATION, Group.NAMES}, beam=12)
_ASSUMED = Assumptions().with_names(evident=True)
LESSONS = 4500
_ROUNDS = 3
SHIPPED = Path(str(files("dcg_torch.model"))) / "shipped"


def pretrained(*, opaque: bool = False, device: str = "cpu") -> GroundingModel:
    """The shipped model: it knows cube, sphere and cylinder, colours, relations, and learns everything else.

    Args:
        opaque: the names of classes say nothing of what people call them, as in the paper's experiments.
        device: see `GroundingModel.to`.

    Raises:
        DeviceError: torch cannot use the device here.
    """
    model = load(SHIPPED, device=device)
    return without_names(model) if opaque else model


def without_names(model: GroundingModel) -> GroundingModel:
    """The model to which names of classes say nothing, with its words trained anew."""
    groups = model.variant.groups - {Group.NAMES}
    features = FeatureSet(groups, model.features.language, model.features.grounding)
    learner = model.learner
    if isinstance(learner, WordPosterior):
        learner = learner.with_names(evident=False)
    bare = GroundingModel(replace(model.variant, groups=groups), features, model.factor, learner)
    bare.train()
    return bare


def train_open_world(
    training: TrainingSet, variant: Variant = VARIANT, lessons: int = LESSONS, assumed: Assumptions | None = None
) -> GroundingModel:
    """An open-world model from the hand-made examples and so many generated lessons.

    Args:
        training: the hand-made examples, or others of their kind.
        variant: with the feature group `relation` if there are lessons.
        assumed: what its learner takes for granted.
    """
    from dcg_torch.language import default_parser  # here: who takes the shipped model makes no lessons
    from dcg_torch.lessons.curriculum import generated_lessons

    model = GroundingModel.trained(training, variant, WordPosterior.start(training, assumed or _ASSUMED))
    if lessons and variant.related:
        model.teach(generated_lessons(default_parser().parse, lessons), relations_only=True, rounds=_ROUNDS)
    return model
