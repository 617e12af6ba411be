"""What Algorithm 1 asks of a robot, and what an experiment asks of a simulated one beside that."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Protocol

import numpy as np

from dcg_torch.types import DriveResult, Percept, Pose
from dcg_torch.world.files import World


class Robot(Protocol):
    """A robot that can be given commands; implement these six for one of your own.

    Metres and radians in one world frame with z up, in which `pose` and the percepts are. Percepts are of whole
    objects, each with an id that stays the same from look to look.
    """

    @property
    def pose(self) -> Pose:
        """Where it is now."""

    def perceive(self) -> Sequence[Percept]:
        """What is in view, the best in view first (Alg. 1, line 8)."""

    def spin(self, angle: float) -> None:
        """Turn in place by `angle` radians, left positive (line 13)."""

    def drive_to(self, target: str, percepts: Sequence[Percept]) -> DriveResult:
        """Drive to the object of this id round all others, and say how it ended (line 15)."""

    def drive_away(self, target: str, percepts: Sequence[Percept]) -> DriveResult:
        """Leave the surroundings of the object of this id."""

    def go_to(self, x: float, y: float, percepts: Sequence[Percept]) -> DriveResult:
        """Drive to a place round all objects, to look from there."""


class SimulationRobot(Robot, Protocol):
    """A robot that can be put into a world, and knows what no real robot does: `simulator` has two of them."""

    def load(self, world: World, *, rng: np.random.Generator | None = None) -> None:
        """Stand at the start pose of a world, all counters at zero; `rng` draws the recogniser's mistakes."""

    @property
    def path_length(self) -> float:
        """Metres driven since `load`."""

    @property
    def turned(self) -> float:
        """Radians turned since `load`, both directions counted positive."""

    @property
    def collisions(self) -> int:
        """How often it came to touch an object since `load`."""

    @property
    def seconds(self) -> float:
        """Simulated seconds that it has moved since `load`."""


class InteractiveRobot(SimulationRobot, Protocol):
    """One that can be watched and stopped while it moves, as both of `simulator` can."""

    on_tick: Callable[[Pose], None] | None

    def stop(self) -> None:
        """End the motion under way, and do nothing more until `resume` or `load`; any thread may call it."""

    def resume(self) -> None:
        """Move again when asked to."""

    def close(self) -> None:
        """Let go of what it holds."""
