"""From settings to what they describe: the model, how it explores and asks. `robots` makes the robot."""

from __future__ import annotations

import functools
from collections.abc import Callable
from dataclasses import replace

from dcg_torch.agent.asking import AskingPolicy
from dcg_torch.agent.explore import Explorer, LookBefore, Worth
from dcg_torch.grounding.features import Group
from dcg_torch.lessons import training_set
from dcg_torch.model import GroundingModel, Variant
from dcg_torch.model.pretrain import LESSONS, VARIANT, pretrained, train_open_world, without_names
from dcg_torch.settings import Asking, LearnerKind, ModelSettings, Names, Settings, SettingsError


def variant(settings: ModelSettings) -> Variant:
    """The model variant of a configuration.

    Raises:
        SettingsError: a feature group that does not exist.
    """
    try:
        groups = frozenset(Group(name) for name in settings.groups)
    except ValueError:
        raise SettingsError(f"model.groups={settings.groups}: choose from {', '.join(Group)}") from None
    return Variant(
        groups=groups,
        unknown=Group.UNKNOWN in groups,
        hypothetical=settings.hypothetical,
        learns=settings.learns,
        ternary=settings.ternary,
        l2=settings.l2,
        beam=settings.beam,
    )


def make_model(settings: ModelSettings, names: Names, training: str | None = None) -> GroundingModel:
    """A model of one's own, after the initial examples and the generated lessons, before the first command.

    Args:
        names: whether class names are evidence; of use to a learner that keeps a posterior.
        training: a YAML file of initial examples; None: those that come along.

    Raises:
        SettingsError: a feature group that does not exist.
        TrainingFileError: the file is missing or not valid.
    """
    return _made(variant(settings), settings.lessons, settings.learner, names, training).copy()


@functools.cache
def _made(chosen: Variant, lessons: int, learner: LearnerKind, names: Names, training: str | None) -> GroundingModel:
    """The model of a configuration, which is the same for every trial: the shipped one, where that is what is asked."""
    if learner is LearnerKind.commit_first:
        return GroundingModel.trained(training_set(training), chosen)
    chosen = replace(chosen, groups=chosen.groups | {Group.NAMES})
    shipped = (chosen, lessons, training) == (VARIANT, LESSONS, None)
    model = pretrained() if shipped else train_open_world(training_set(training), chosen, lessons)
    return model if names is Names.words else without_names(model)


def make_explorer(settings: Settings, model: GroundingModel) -> Callable[[], Explorer] | None:
    """Looking before deciding, for the model that can tell what it is unsure of; None: the paper's turning."""
    chosen = settings.model.open_world
    if settings.model.learner is LearnerKind.commit_first:
        return None
    sure = chosen.ask_below if settings.asking is Asking.when_unsure else None
    worth = Worth(meanings=chosen.look_above, sure=sure, views=chosen.views)
    return functools.partial(LookBefore, model.beliefs_of, worth)


def make_asking(settings: Settings) -> AskingPolicy | None:
    """When to ask back; None: never."""
    if settings.asking is Asking.never:
        return None
    return AskingPolicy(below=settings.model.open_world.ask_below)
