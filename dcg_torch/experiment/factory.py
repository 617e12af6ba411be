"""From settings to what they describe: the model, the robot, how it explores and asks."""

from __future__ import annotations

import copy
import dataclasses
import functools
import json
from collections.abc import Callable

import numpy as np

from dcg_torch.agent.asking import Asking
from dcg_torch.agent.explore import Explorer, LookBefore, Worth
from dcg_torch.agent.robot import FakeRobot, Robot
from dcg_torch.grounding.features import Group
from dcg_torch.language import default_parser
from dcg_torch.lessons import training_set
from dcg_torch.lessons.generated import generated_lessons
from dcg_torch.model import GroundingModel, Variant
from dcg_torch.open_world import OpenWorld, OpenWorldModel
from dcg_torch.settings import Asking as WhenToAsk
from dcg_torch.settings import ModelSettings, RobotKind, Settings, SettingsError, SimulatorSettings
from dcg_torch.supervised import teach
from dcg_torch.world.names import MORE_TYPES


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
        synonyms=settings.synonyms,
    )


def make_model(settings: ModelSettings, training: str | None = None) -> GroundingModel:
    """A model of one's own, after the initial examples and the generated lessons, before the first command.

    Args:
        training: a YAML file of initial examples; None: those that come along.

    Raises:
        SettingsError: a feature group that does not exist.
        TrainingFileError: the file is missing or not valid.
    """
    return copy.deepcopy(_made(variant(settings), settings.lessons, settings.posterior, training))


@functools.cache
def _made(chosen: Variant, lessons: int, posterior: bool, training: str | None) -> GroundingModel:
    """The model of a configuration, which is the same for every trial."""
    examples = training_set(training)
    model = (
        OpenWorldModel.trained(examples, chosen, OpenWorld()) if posterior else GroundingModel.trained(examples, chosen)
    )
    if lessons and Group.RELATION in chosen.groups:
        teach(model, generated_lessons(default_parser().parse, lessons), rounds=2)
    if isinstance(model, OpenWorldModel):
        model.settle()
    return model


def make_robot(settings: SimulatorSettings, types: int) -> Robot:
    """This process's robot: made once, since a world's outcome does not depend on the worlds before it."""
    return _robot(json.dumps(dataclasses.asdict(settings)), types)


@functools.cache
def _robot(described: str, types: int) -> Robot:
    settings = SimulatorSettings(**json.loads(described))
    fake, faulty = settings.kind == RobotKind.fake, bool(settings.wrong_class or settings.missed)
    if fake and not faulty:
        return FakeRobot()
    from dcg_torch.simulator import Recogniser, SimulatedRobot  # here: PyBullet need not be there for the fake robot

    recogniser = Recogniser(
        min_pixels=settings.min_pixels,
        wrong_class=settings.wrong_class,
        missed=settings.missed,
        types=MORE_TYPES[:types],
    )
    if fake:
        return FakeRobot(recogniser.labels)
    return SimulatedRobot(recogniser=recogniser, rng=np.random.default_rng(0), gui=settings.gui)


def make_explorer(settings: Settings, model: GroundingModel) -> Callable[[], Explorer] | None:
    """Looking before deciding, for the model that can tell what it is unsure of; None: the paper's turning."""
    chosen = settings.model.open_world
    if not isinstance(model, OpenWorldModel):
        return None
    sure = chosen.ask_below if settings.asking is WhenToAsk.when_unsure else None
    worth = Worth(meanings=chosen.look_above, sure=sure, views=chosen.views)
    return functools.partial(LookBefore, model.beliefs_of, worth)


def make_asking(settings: Settings) -> Asking | None:
    """When to ask back; None: never."""
    if settings.asking is WhenToAsk.never:
        return None
    return Asking(below=settings.model.open_world.ask_below)
