"""When a drive has arrived, and how far a robot goes at a time: the same for every simulated robot. Metres, radians."""

from __future__ import annotations

import math
from collections.abc import Sequence

from dcg_torch.types import Percept

ARRIVED = 0.5
"""Metres from the middle of an object within which the robot has arrived at it."""
LEFT = 1.5
"""Metres from the middle of an object beyond which the robot has left its surroundings."""
AT_PLACE = 0.1
"""Metres from a place within which the robot is there."""
MAX_DISTANCE = 100.0
"""Metres: the farthest goal of a drive, and the farthest object of a world, from where the robot is."""
MAX_SPIN = 4.0 * math.tau
"""Radians: the most that the robot turns at a time."""


def check_spin(angle: float) -> None:
    """See that an angle is one to turn by.

    Raises:
        ValueError: it is not finite, or more than `MAX_SPIN`.
    """
    if not abs(angle) <= MAX_SPIN:
        raise ValueError(f"can't turn by {angle} radians; give at most {MAX_SPIN:.1f} either way")


def find_percept(target: str, percepts: Sequence[Percept]) -> Percept:
    """The percept of the object to drive by.

    Raises:
        ValueError: `target` is not among the percepts.
    """
    for percept in percepts:
        if percept.id == target:
            return percept
    raise ValueError(f"no percept of {target!r} to drive by; perceived are {sorted(p.id for p in percepts)}")
