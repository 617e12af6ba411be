"""A robot whose eyes and wheels are messages: Algorithm 1 drives it as any other."""

from __future__ import annotations

import itertools
import math
import time
from collections.abc import Callable, Sequence

from dcg_torch.apps.ros.options import Options
from dcg_torch.apps.ros.senses import HaltedError, Senses, apart
from dcg_torch.types import DriveResult, Percept, Pose
from dcg_torch.types.geometry import wrap_angle

_BERTH = 0.5  # metres from the middle of another object to where the robot may stand
_LEAVE = 2.0  # metres that it drives to leave an object
_SIDES = [0.0, *(sign * math.radians(step) for step in range(30, 181, 30) for sign in (1, -1))]

SendGoal = Callable[[Pose, int], None]
"""Sends a goal with its stamp; the same stamp says that it is the same goal."""


class TopicRobot:
    """An `agent.robot.Robot` that is known by its messages alone. One thread may use it.

    A goal is sent again while the robot stands: it, or the first sign of it, may be lost. A drive has ended when the
    robot says so, or stands at the goal. The way round obstacles is the robot's own affair.

    Args:
        senses: what it says.
        send: how it is sent somewhere.
        options: gives distances and times.
    """

    def __init__(self, senses: Senses, send: SendGoal, options: Callable[[], Options]) -> None:
        self._senses, self._send, self._options = senses, send, options
        self._last = itertools.count(time.time_ns())

    @property
    def pose(self) -> Pose:
        """Where it is.

        Raises:
            RobotSilentError: it does not say.
            HaltedError: somebody stopped it.
        """
        return self._senses.pose(self._options().look_timeout)

    def perceive(self) -> Sequence[Percept]:
        """What it sees since it last moved. Raises what `pose` does."""
        return self._senses.look(self._options().look_timeout)

    def spin(self, angle: float) -> None:
        """Turn in place; raises what `pose` does."""
        here = self.pose
        self._go(Pose(here.x, here.y, wrap_angle(here.yaw + angle)))

    def drive_to(self, target: str, percepts: Sequence[Percept]) -> DriveResult:
        """Stand before the object, facing it."""
        goal = approach(self.pose, target, percepts, self._options().standoff)
        return self._drive(goal)

    def drive_away(self, target: str, percepts: Sequence[Percept]) -> DriveResult:
        """Two metres on, with the object behind it."""
        here, thing = self.pose, next(p for p in percepts if p.id == target)
        yaw = math.atan2(here.y - thing.position[1], here.x - thing.position[0])
        return self._drive(Pose(here.x + _LEAVE * math.cos(yaw), here.y + _LEAVE * math.sin(yaw), yaw))

    def go_to(self, x: float, y: float, percepts: Sequence[Percept]) -> DriveResult:
        """To a place, to look from there; raises what `pose` does."""
        here = self.pose
        return self._go(Pose(x, y, math.atan2(y - here.y, x - here.x)))

    def stand(self) -> None:
        """Send it to where it is, which ends every drive."""
        here = self._senses.here()
        if here is not None:
            self._send(here, next(self._last))

    def _drive(self, goal: Pose) -> DriveResult:
        try:
            return self._go(goal)
        except HaltedError:
            return DriveResult.STOPPED

    def _go(self, goal: Pose) -> DriveResult:
        options, stamp = self._options(), next(self._last)
        before, ends = None, time.monotonic() + options.drive_timeout

        def result() -> DriveResult | None:
            said, here = self._senses.result(stamp), self._senses.here()
            there = here is not None and _close(here, goal, options.near, options.near_angle)
            if said is None or said is DriveResult.ARRIVED:  # from where it arrived it goes on, so that must be known
                return DriveResult.ARRIVED if there or self._senses.settled(stamp) else None
            return said

        while True:
            here = self._senses.here()
            if here is None or before is None or not apart(here, before):
                self._send(goal, stamp)
            before = here
            left = ends - time.monotonic()
            found = self._senses.wait(result, max(0.0, min(options.resend, left)))
            if found is not None:
                return found
            if left <= 0.0:
                self.stand()
                return DriveResult.BLOCKED


def approach(here: Pose, target: str, percepts: Sequence[Percept], standoff: float) -> Pose:
    """Where to stand before an object: on the robot's side of it, or the next side that is free; facing it.

    Args:
        standoff: metres from the object's middle, to which half of its width is added beyond 0.3 m.
    """
    thing = next(p for p in percepts if p.id == target)
    x, y = thing.position[:2]
    half = 0.0 if thing.size is None else max(thing.size[:2]) / 2
    away = standoff + max(0.0, half - 0.3)
    side = math.atan2(here.y - y, here.x - x)
    others = [p.position[:2] for p in percepts if p.id != target]
    places = [(x + away * math.cos(side + s), y + away * math.sin(side + s)) for s in _SIDES]
    free = (place for place in places if all(math.dist(place, other) >= _BERTH for other in others))
    at = next(free, places[0])
    return Pose(*at, math.atan2(y - at[1], x - at[0]))


def _close(one: Pose, other: Pose, metres: float, radians: float) -> bool:
    near = math.dist((one.x, one.y), (other.x, other.y)) <= metres
    return near and abs(wrap_angle(one.yaw - other.yaw)) <= radians
