"""A simulated robot without physics, which can run Algorithm 1 in milliseconds."""

from __future__ import annotations

import math
import threading
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass

import numpy as np

from dcg_torch.simulator.limits import ARRIVED, MAX_DISTANCE, check_spin, find_percept
from dcg_torch.types import DriveResult, Percept, Pose
from dcg_torch.types.geometry import bearing, in_field_of_view, wrap_angle
from dcg_torch.world.files import World

Labels = Callable[[Sequence[str], np.random.Generator], Sequence[str | None]]
"""What objects of some types are recognised as, see `Recogniser.labels`."""
_LEAVE = 2.0  # metres that it drives to leave an object
_SPEED, _TURN = 0.65, 2.0  # m/s and rad/s that its seconds are reckoned with
_TICK = 1.0 / 30.0  # seconds between two poses on the way


@dataclass
class _State:
    world: World
    pose: Pose
    path_length: float = 0.0
    turned: float = 0.0


class FakeRobot:
    """A robot of pure geometry: it sees through objects, turns exactly, and is where it is sent at once.

    It is an `agent.robot.InteractiveRobot`: with `on_tick` it passes through poses on the way, 30 to a second of its.

    Args:
        labels: what the objects of a world, given their types in order, are recognised as (None: not at all); by
            default as what they are.
    """

    def __init__(self, labels: Labels | None = None) -> None:
        self._labels = labels
        self._now: _State | None = None
        self._stopped = threading.Event()
        self.collisions = 0
        self.on_tick: Callable[[Pose], None] | None = None

    def load(self, world: World, *, rng: np.random.Generator | None = None) -> None:
        """Stand at the start pose of `world`.

        Raises:
            ValueError: its recogniser makes mistakes, and there is no `rng` to draw them from.
        """
        self._now = _State(world, world.start)
        self._stopped.clear()
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
        """Where the robot is."""
        return self._state.pose

    @property
    def path_length(self) -> float:
        """Metres driven since `load`."""
        return self._state.path_length

    @property
    def turned(self) -> float:
        """Radians turned since `load`."""
        return self._state.turned

    @property
    def seconds(self) -> float:
        """Seconds that all driving and turning would have taken, at 0.65 metres and 2 radians a second."""
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
        """Turn by an angle in radians.

        Raises:
            ValueError: more than `limits.MAX_SPIN`.
        """
        check_spin(angle)
        state, start = self._state, self.pose
        share = 0.0
        for share in self._shares(abs(angle) / _TURN):
            state.pose = Pose(start.x, start.y, wrap_angle(start.yaw + share * angle))
            self._tick()
        state.turned += share * abs(angle)

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
        state, start, distance = self._state, self.pose, max(0.0, distance)
        share = 0.0
        for share in self._shares(distance / _SPEED):
            way = share * distance
            state.pose = Pose(start.x + way * math.cos(start.yaw), start.y + way * math.sin(start.yaw), start.yaw)
            self._tick()
        state.path_length += share * distance
        return DriveResult.ARRIVED if share == 1.0 else DriveResult.STOPPED

    def _shares(self, seconds: float) -> Iterator[float]:
        """The shares of a motion that are done by and by, the last one 1, until somebody stops the robot."""
        steps = max(1, math.ceil(seconds / _TICK)) if self.on_tick is not None else 1
        for step in range(1, steps + 1):
            if self._stopped.is_set():
                return
            yield step / steps

    def _tick(self) -> None:
        if self.on_tick is not None:
            self.on_tick(self.pose)

    def stop(self) -> None:
        """End the motion under way, and do nothing more until `resume` or `load`; any thread may call it."""
        self._stopped.set()

    def resume(self) -> None:
        """Move again when asked to."""
        self._stopped.clear()

    def close(self) -> None:
        """Nothing: it holds nothing."""
