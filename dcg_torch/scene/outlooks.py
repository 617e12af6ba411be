"""Where somebody stands who tells sides of things: "left of the bed", in a room of which nobody knows the speaker.

Nobody says where who speaks stands in a room that was scanned. People then mean a thing's sides as who stands before it
sees them: its back is to the wall that it stands at. What lies on a table is looked at from the nearest edge of that;
what else stands at no wall, from the middle of the room. Where a robot stands in the middle of a room, what is at a
wall has its sides so as well, wherever the robot looks: who speaks thinks of it as it is used.
"""

from __future__ import annotations

import numpy as np

from dcg_torch.scene.bodies import Bodies
from dcg_torch.scene.order import TIE
from dcg_torch.scene.room_walls import CLASSES, THINGS, box_around, gaps_to_walls, is_wide, reach_along_walls
from dcg_torch.types.arrays import Bools, Floats

_AT_WALL = 0.4
"""Metres from a wall up to which a thing stands at it."""
_RESTS, _MANY = 0.12, 512
"""Units between the top of a thing and the foot of another that lies on it; things up to which that is looked for."""
_FEW = 5
"""Things at least in a room in which nobody stands."""


def outlooks(position: Floats, bodies: Bodies, classes: int, unit: float, *, at_walls: bool = False) -> Floats | None:
    """(n,) angles along which who stands before things looks at them; None for what is no room.

    Args:
        position: (n, 2 or more) of the objects, in units.
        classes: how many there are.
        unit: metres.
        at_walls: leave out what is at no wall, which is NaN then: somebody is there to look at it.
    """
    at = position[: len(bodies.half), :2]
    half = np.nan_to_num(bodies.half)
    there = np.isfinite(at).all(axis=1)
    if there.sum() < (THINGS if at_walls else _FEW) or classes < CLASSES:
        return None
    box = box_around(at, half)
    if not is_wide(box, unit):
        return None
    gaps = gaps_to_walls(at, half, box) * unit
    wall = np.where(gaps <= _AT_WALL, reach_along_walls(half) - TIE * gaps, -np.inf)
    stands, out = np.isfinite(wall.max(axis=1)), _OUT[wall.argmax(axis=1)]
    if at_walls:
        return np.where(stands, np.arctan2(out[:, 1], out[:, 0]), np.nan)
    inward, lies = _from_edges(at, bodies)
    out = np.where(stands[:, None], out, np.where(lies[:, None], inward, at - box.mean(axis=0)))
    found: Floats = np.where(there, np.arctan2(out[:, 1], out[:, 0]), 0.0)
    return found


_OUT = np.array([(-1.0, 0.0), (0.0, -1.0), (1.0, 0.0), (0.0, 1.0)])


def _from_edges(at: Floats, bodies: Bodies) -> tuple[Floats, Bools]:
    """(n, 2) from the nearest edge of what each thing lies on straight inward, and (n,) which things lie on another."""
    numbers = np.arange(len(at))
    if len(at) > _MANY:
        return np.zeros_like(at), np.zeros(len(at), dtype=np.bool_)
    offset = at[None] - at[:, None]  # (below, on, 2)
    with np.errstate(invalid="ignore"):
        area = bodies.half.prod(axis=1)
        inside = (np.abs(offset) < bodies.half[:, None]).all(axis=2) & (area[:, None] > area)
        on = inside & (np.abs(bodies.bottom[None] - bodies.top[:, None]) < _RESTS)
    below = np.where(on, bodies.top[:, None], -np.inf).argmax(axis=0)
    own, half = offset[below, numbers], bodies.half[below]
    room = half - np.abs(own)  # up to each edge
    nearest = room == room.min(axis=1, keepdims=True)
    inward: Floats = np.where(nearest, -own, 0.0)
    return inward, np.logical_and(on.any(axis=0), inward.any(axis=1))
