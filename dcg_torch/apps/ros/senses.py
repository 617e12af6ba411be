"""What the messages of a robot say, kept for another thread to wait for."""

from __future__ import annotations

import math
import threading
import time
from collections.abc import Callable
from dataclasses import dataclass
from typing import TypeVar

from dcg_torch.types import DriveResult, Percept, Pose
from dcg_torch.types.geometry import wrap_angle

T = TypeVar("T")
_MOVED, _TURNED = 0.02, 0.03  # metres, radians: less is the jitter of a robot that stands
_SETTLED = 0.5  # seconds
_SILENCE = 2.0  # seconds without a newer message, after which an older stamp is a clock that was set anew


class RobotSilentError(RuntimeError):
    """The robot says nothing of what was waited for; the message is one line."""


class HaltedError(RuntimeError):
    """Somebody stopped the robot."""


@dataclass(frozen=True, slots=True)
class _Seen:
    """A pose or a look: its stamp, its number among all messages, and when it came (seconds of this machine)."""

    stamp: int
    number: int
    came: float


class Senses:
    """The newest pose and look of a robot; any thread may put, one waits.

    A message with an older stamp than one before is late, and left alone.

    Attributes:
        refused: why the last message was refused or left alone, for error messages.
    """

    def __init__(self) -> None:
        self._changed = threading.Condition()
        self._pose: tuple[Pose, _Seen] | None = None
        self._look: tuple[tuple[Percept, ...], _Seen] | None = None
        self._moved: tuple[Pose, _Seen] | None = None  # since when it has stood about where it stands
        self._result: tuple[int, DriveResult, float] | None = None
        self._number = 0
        self._halted = False
        self.refused = ""

    def put_pose(self, pose: Pose, stamp: int) -> None:
        """The robot is there."""
        with self._changed:
            seen = self._seen(stamp, self._pose and self._pose[1])
            if seen is None:
                return
            self._pose = (pose, seen)
            if self._moved is None or apart(pose, self._moved[0]):
                self._moved = (pose, seen)
            self._changed.notify_all()

    def put_look(self, percepts: tuple[Percept, ...], stamp: int) -> None:
        """The robot sees this."""
        with self._changed:
            seen = self._seen(stamp, self._look and self._look[1])
            if seen is not None:
                self._look = (percepts, seen)
                self._changed.notify_all()

    def put_result(self, goal: int, result: DriveResult) -> None:
        """The robot says how it fared with the goal of this stamp."""
        with self._changed:
            if self._result is None or self._result[0] != goal:
                self._result = (goal, result, time.monotonic())
            self._changed.notify_all()

    def halt(self) -> None:
        """End every wait until `go_on`."""
        with self._changed:
            self._halted = True
            self._changed.notify_all()

    def go_on(self) -> None:
        """Wait again."""
        with self._changed:
            self._halted = False

    def pose(self, seconds: float) -> Pose:
        """Where the robot is.

        Args:
            seconds: to wait for a pose, and the age at which one is too old.

        Raises:
            RobotSilentError: no pose came.
            HaltedError: somebody stopped the robot.
        """
        found = self.wait(lambda: self._pose if self._pose and _fresh(self._pose[1], seconds) else None, seconds)
        if found is None:
            raise RobotSilentError(f"no pose of the robot for {seconds:g} s{self._because()}")
        return found[0]

    def look(self, seconds: float) -> tuple[Percept, ...]:
        """What is in view from where the robot stands: a look taken since it last moved. See `pose`.

        Raises:
            RobotSilentError: no such look came in so many seconds.
        """

        def recent() -> tuple[tuple[Percept, ...], _Seen] | None:
            look, moved = self._look, self._moved
            if look is None or not _fresh(look[1], seconds):
                return None
            return look if moved is None or _since(look[1], moved[1]) else None

        found = self.wait(recent, seconds)
        if found is None:
            raise RobotSilentError(f"no percepts from where the robot stands for {seconds:g} s{self._because()}")
        return found[0]

    def result(self, goal: int) -> DriveResult | None:
        """What the robot said of a goal, if it did; call it within `wait`."""
        return self._result[1] if self._result and self._result[0] == goal else None

    def settled(self, goal: int) -> bool:
        """Has a pose come so long after the robot's word on a goal that it is of that place? Within `wait`."""
        if self._pose is None or self._result is None or self._result[0] != goal:
            return False
        return self._pose[1].came - self._result[2] > _SETTLED

    def here(self) -> Pose | None:
        """The newest pose, however old; call it within `wait`."""
        return self._pose and self._pose[0]

    def wait(self, ready: Callable[[], T | None], seconds: float) -> T | None:
        """What `ready` gives as soon as it is not None; None after so many seconds.

        Raises:
            HaltedError: somebody stopped the robot.
        """
        found: list[T] = []

        def done() -> bool:
            value = ready()
            found[:] = [] if value is None else [value]
            return self._halted or bool(found)

        with self._changed:
            self._changed.wait_for(done, seconds)
            if self._halted:
                raise HaltedError("stopped")
        return found[0] if found else None

    def notify(self) -> None:
        """Let those who wait look again."""
        with self._changed:
            self._changed.notify_all()

    def _seen(self, stamp: int, before: _Seen | None) -> _Seen | None:
        self._number += 1
        now = time.monotonic()
        if before is not None and 0 < stamp < before.stamp and now - before.came < _SILENCE:
            self.refused = "one was late"
            return None
        return _Seen(stamp, self._number, now)

    def _because(self) -> str:
        return f"; the last message was refused: {self.refused}" if self.refused else ""


def apart(one: Pose, other: Pose) -> bool:
    """Has the robot moved between these poses, by more than jitter?"""
    return math.dist((one.x, one.y), (other.x, other.y)) > _MOVED or abs(wrap_angle(one.yaw - other.yaw)) > _TURNED


def _fresh(seen: _Seen, seconds: float) -> bool:
    return time.monotonic() - seen.came <= seconds


def _since(look: _Seen, moved: _Seen) -> bool:
    """Was the look taken at this pose? By the robot's clock where both say it, else by the order of arrival."""
    return look.stamp >= moved.stamp if look.stamp and moved.stamp else look.number > moved.number
