"""What is at the wall of its landmark or at the one opposite: "the door on the same wall as the dresser"."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np

from dcg_torch.scene.room_walls import box_around, gaps_to_walls, reach_along_walls
from dcg_torch.types import Object
from dcg_torch.types.arrays import Floats

AT_WALL_OF = {"same wall as": 0, "opposite wall from": 2}
"""Prepositions, and how many walls further round a room things are then than their landmark."""
_REACH = 0.5
"""Metres from a wall up to which a thing is at it."""
_SURE, _CORNER, _OPEN = 0.98, 0.15, 0.5
"""Probabilities: of what is at that wall; of what is at another that meets it, and within reach of both; of a thing
where nobody can tell at which wall its landmark is."""
_TIE = 1e-3


def log_at_wall_of(name: str, things: Sequence[Object], landmarks: Sequence[tuple[int, ...]]) -> Floats:
    """(landmarks, things) the logarithm of the probability that a thing is at the wall that is told.

    Args:
        name: one of `AT_WALL_OF`.
        landmarks: numbers of things; the first of each is the landmark. It is not at its own wall.
    """
    walls = _walls(things)
    found = np.full((len(landmarks), len(things)), _OPEN)
    for row, (first, *_) in zip(found, landmarks, strict=True):
        if not walls[first]:
            continue
        wall = (walls[first][0] + AT_WALL_OF[name]) % 4
        row[:] = [_SURE if at[:1] == [wall] else _CORNER if wall in at else 1.0 - _SURE for at in walls]
        row[first] = 1.0 - _SURE
    log: Floats = np.log(found)
    return log


def _walls(things: Sequence[Object]) -> list[list[int]]:
    """The walls at which each thing is, the one along which it reaches farther first; round the room from low x."""
    there = [k for k, o in enumerate(things) if o.position is not None and o.size is not None and not o.hypothetical]
    found: list[list[int]] = [[] for _ in things]
    if not there:
        return found
    at = np.array([(things[k].position or ())[:2] for k in there])
    half = np.array([(things[k].size or (math.nan,) * 2)[:2] for k in there]) / 2.0
    gaps = gaps_to_walls(at, half, box_around(at, half))
    for k, gap, reach in zip(there, gaps, reach_along_walls(half), strict=True):
        near = [wall for wall in range(4) if gap[wall] <= _REACH]
        found[k] = sorted(near, key=lambda wall: float(_TIE * gap[wall] - reach[wall]))
    return found
