"""From settings to robots; neither torch nor, for the fake robot, PyBullet is loaded for it."""

from __future__ import annotations

import dataclasses
import functools
import json

import numpy as np

from dcg_torch.agent.robot import SimulationRobot
from dcg_torch.settings import RobotKind, SimulatorSettings
from dcg_torch.simulator.fake_robot import FakeRobot
from dcg_torch.simulator.recogniser import Recogniser
from dcg_torch.world.names import MORE_TYPES


def make_robot(settings: SimulatorSettings, types: int) -> SimulationRobot:
    """This process's robot: made once, since a world's outcome does not depend on the worlds before it."""
    return _robot(json.dumps(dataclasses.asdict(settings)), types)


@functools.cache
def _robot(described: str, types: int) -> SimulationRobot:
    return new_robot(SimulatorSettings(**json.loads(described)), types)


def new_robot(settings: SimulatorSettings, types: int) -> SimulationRobot:
    """A robot of one's own, for who has several in one process.

    Args:
        types: how many of `MORE_TYPES` the recogniser may take an object for.

    Raises:
        SimulatorError: PyBullet is asked for and is not there, or its server did not start.
    """
    recogniser = Recogniser(
        min_pixels=settings.min_pixels,
        wrong_class=settings.wrong_class,
        missed=settings.missed,
        types=MORE_TYPES[:types],
    )
    if settings.kind == RobotKind.fake:
        return FakeRobot(recogniser.labels if settings.wrong_class or settings.missed else None)
    from dcg_torch.simulator import SimulatedRobot  # here: PyBullet need not be there for the fake robot

    return SimulatedRobot(recogniser=recogniser, rng=np.random.default_rng(0), gui=settings.gui)
