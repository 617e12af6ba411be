"""A simulated robot without physics, which can run Algorithm 1 in milliseconds."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np

from dcg_torch.geometry import bearing, in_field_of_view, wrap_angle
from dcg_torch.simulator.limits import ARRIVED, MAX_DISTANCE, check_spin, find_percept
from dcg_torch.types import DriveResult, Percept, Pose
from dcg_torch.world.files import World

Labels = Callable[[Sequence[str], np.random.Generator], Sequence[str | None]]
"""What objects of some types are recognised as, see `Recogniser.labels`."""
_LEAVE = 2.0  # metres that it drives to leave an object
_SPEED, _TURN = 0.65, 2.0  # m/s and rad/s that its seconds are reckoned with


@dataclass
class _State:
    world: World
    pose: Pose
    path_length: float = 0.0
    turned: float = 0.0


class FakeRobot:
    """A robot of pure geometry: it sees through objects, turns exactly, and is where it is sent at once.

    It is an `agent.robot.SimulationRobot`.

    Args:
        labels: what the objects of a world, given their types in order, are recognised as (None: not at all); by
            default as what they are.
    """

    def __init__(self, labels: Labels | None = None) -> None:
        self._labels = labels
        self._now: _State | None = None
        self.collisions = 0

    def load(self, world: World, *, rng: np.random.Generator | None = None) -> None:
        """Stand at the start pose of `world`."""
        self._now = _State(world, world.start)
        types = [o.type for o in world.objects]
        if self._labels is None:
            self._recognised: dict[str, str | None] = {o.id: o.type for o in world.objects}
        else:
            if rng is None:
                raise ValueError("a recogniser that makes mistakes needs an rng to draw them from")
            self._recognised = dict(zip((o.id for o in world.objects), self._labels(types, rng), strict=True))

    @property
    def _state(self) -> _State:
        if self._now is None:
            raise RuntimeError("the robot is in no world yet; load one first")
        return self._now

    @property
    def pose(self) -> Pose:
        """Where it is."""
        return self._state.pose

    @property
    def path_length(self) -> float:
        """Metres since `load`."""
        return self._state.path_length

    @property
    def turned(self) -> float:
        """Radians since `load`."""
        return self._state.turned

    @property
    def seconds(self) -> float:
        """As if it drove 0.65 metres and turned 2 radians a second."""
        return self.path_length / _SPEED + self.turned / _TURN

    def perceive(self) -> list[Percept]:
        """Every object in the field of view, from its middle outwards."""
        seen = []
        for o in self._state.world.objects:
            label = self._recognised[o.id]
            if label is not None and in_field_of_view(self.pose, *o.position):
                off = abs(bearing(self.pose, *o.position))
                seen.append((off, o.id, Percept(o.id, label, o.color, (*o.position, 0.0))))
        return [percept for _, _, percept in sorted(seen, key=lambda item: item[:2])]

    def spin(self, angle: float) -> None:
        """Turn.

        Raises:
            ValueError: more than `limits.MAX_SPIN`.
        """
        check_spin(angle)
        state = self._state
        state.pose = Pose(state.pose.x, state.pose.y, wrap_angle(state.pose.yaw + angle))
        state.turned += abs(angle)

    def drive_to(self, target: str, percepts: Sequence[Percept]) -> DriveResult:
        """Face the target and go straight until it is within reach."""
        x, y = find_percept(target, percepts).position[:2]
        return self._go((x, y), self._distance(x, y) - ARRIVED)

    def drive_away(self, target: str, percepts: Sequence[Percept]) -> DriveResult:
        """Face the other way and go straight for two metres."""
        x, y = find_percept(target, percepts).position[:2]
        return self._go((2 * self.pose.x - x, 2 * self.pose.y - y), _LEAVE)

    def go_to(self, x: float, y: float, percepts: Sequence[Percept]) -> DriveResult:
        """Face the place and go there."""
        return self._go((x, y), self._distance(x, y))

    def _distance(self, x: float, y: float) -> float:
        return math.dist((x, y), (self.pose.x, self.pose.y))

    def _go(self, towards: tuple[float, float], distance: float) -> DriveResult:
        if not distance <= MAX_DISTANCE:
            return DriveResult.TOO_FAR
        self.spin(bearing(self.pose, *towards))
        state, distance = self._state, max(0.0, distance)
        pose = state.pose
        state.path_length += distance
        state.pose = Pose(pose.x + distance * math.cos(pose.yaw), pose.y + distance * math.sin(pose.yaw), pose.yaw)
        return DriveResult.ARRIVED
