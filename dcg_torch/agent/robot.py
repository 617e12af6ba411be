"""What Algorithm 1 asks of a robot, and a robot without physics that can run it in milliseconds."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Protocol

import numpy as np

from dcg_torch.types import Percept, Pose
from dcg_torch.world.files import World

FIELD_OF_VIEW = math.radians(57.0)  # Kinect, the paper's camera
REACH = 0.5
"""Metres from an object's middle within which the robot has arrived."""


class Robot(Protocol):
    """A robot in a world; `simulator.SimulatedRobot` is one."""

    def load(self, world: World, *, rng: np.random.Generator | None = None) -> None:
        """Stand at the start pose of a world, all counters at zero."""
        ...

    @property
    def pose(self) -> Pose:
        """Where it is now."""
        ...

    @property
    def path_length(self) -> float:
        """Metres driven since `load`."""
        ...

    @property
    def turned(self) -> float:
        """Radians turned since `load`, both directions counted positive."""
        ...

    @property
    def collisions(self) -> int:
        """How often it came to touch an object since `load`."""
        ...

    def perceive(self) -> list[Percept]:
        """What is in view, in the order of the bearing from the middle of the view outwards (line 8)."""
        ...

    def spin(self, angle: float) -> None:
        """Turn in place by `angle` radians, left positive (line 13)."""
        ...

    def drive_to(self, target: str, percepts: list[Percept], *, avoid: frozenset[str] = frozenset()) -> bool:
        """Drive to an object round all others; True when it ended within 0.5 m of it (line 15)."""
        ...

    def drive_away(self, target: str, percepts: list[Percept]) -> bool:
        """Leave the surroundings of an object; True when it ended outside them."""
        ...

    def go_to(self, x: float, y: float, percepts: list[Percept]) -> bool:
        """Drive to a place round all objects; True when it got there."""
        ...

    @property
    def seconds(self) -> float:
        """Simulated seconds that it has moved since `load`."""
        ...


Labels = Callable[[Sequence[str], np.random.Generator], Sequence[str | None]]


@dataclass
class _State:
    world: World
    pose: Pose
    path_length: float = 0.0
    turned: float = 0.0


class FakeRobot:
    """A robot of pure geometry: it sees through objects, turns exactly, and is where it is sent at once.

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

    def perceive(self) -> list[Percept]:
        """Every object within half the field of view of the heading."""
        seen = []
        for o in self._state.world.objects:
            bearing, label = abs(self._bearing(o.position)), self._recognised[o.id]
            if bearing < FIELD_OF_VIEW / 2 and label is not None:
                seen.append((bearing, o.id, Percept(o.id, label, o.color, (*o.position, 0.0))))
        return [percept for _, _, percept in sorted(seen, key=lambda item: item[:2])]

    def spin(self, angle: float) -> None:
        """Turn."""
        state = self._state
        yaw = math.remainder(state.pose.yaw + angle, math.tau)
        state.pose, state.turned = Pose(state.pose.x, state.pose.y, yaw), state.turned + abs(angle)

    def drive_to(self, target: str, percepts: list[Percept], *, avoid: frozenset[str] = frozenset()) -> bool:
        """Face the target and go straight until it is within reach."""
        x, y = next(p.position[:2] for p in percepts if p.id == target)
        self._go((x, y), math.dist((x, y), (self.pose.x, self.pose.y)) - REACH)
        return True

    def drive_away(self, target: str, percepts: list[Percept]) -> bool:
        """Face the other way and go straight for two metres."""
        x, y = next(p.position[:2] for p in percepts if p.id == target)
        self._go((2 * self.pose.x - x, 2 * self.pose.y - y), 2.0)
        return True

    def go_to(self, x: float, y: float, percepts: list[Percept]) -> bool:
        """Face the place and go there."""
        self._go((x, y), math.dist((x, y), (self.pose.x, self.pose.y)))
        return True

    @property
    def seconds(self) -> float:
        """As if it drove 0.65 metres and turned 2 radians a second."""
        return self.path_length / 0.65 + self.turned / 2.0

    def _bearing(self, point: tuple[float, float]) -> float:
        pose = self.pose
        return math.remainder(math.atan2(point[1] - pose.y, point[0] - pose.x) - pose.yaw, math.tau)

    def _go(self, towards: tuple[float, float], distance: float) -> None:
        self.spin(self._bearing(towards))
        state, distance = self._state, max(0.0, distance)
        pose = state.pose
        state.path_length += distance
        state.pose = Pose(pose.x + distance * math.cos(pose.yaw), pose.y + distance * math.sin(pose.yaw), pose.yaw)
