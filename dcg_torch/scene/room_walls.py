"""The walls of a room that nobody lists: the box around all that is there, and how far each thing is from its sides."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from dcg_torch.types import Object, Percept
from dcg_torch.types.arrays import Floats
from dcg_torch.types.geometry import positions

THINGS, CLASSES, _WIDE = 10, 4, 2.0
"""Things and classes at least in a room, and metres between its walls."""


def box_around(at: Floats, half: Floats) -> Floats:
    """(2, 2) the least and the greatest x and y of things; NaN of all that are nowhere is left out.

    Args:
        at: (n, 2) their middles, of which some are somewhere.
        half: (n, 2) half of their extents.
    """
    return np.array([np.nanmin(at - half, axis=0), np.nanmax(at + half, axis=0)])


def is_wide(box: Floats, unit: float = 1.0) -> bool:
    """Is a box as wide as a room? `unit`: metres of what it is measured in."""
    return bool(((box[1] - box[0]) * unit >= _WIDE).all())


def gaps_to_walls(at: Floats, half: Floats, box: Floats) -> Floats:
    """(n, 4) from each thing to the walls at low x, low y, high x and high y, in what these are measured in."""
    found: Floats = np.concatenate([at - half - box[0], box[1] - at - half], axis=1)
    return found


def reach_along_walls(half: Floats) -> Floats:
    """(n, 4) half of how far each thing reaches along each of these walls."""
    return np.tile(half[:, ::-1], 2)


def room_walls(things: Sequence[Object] | Sequence[Percept]) -> Floats | None:
    """(2, 2) the least and the greatest x and y of the things of a room, metres; None for what is no room.

    The many unlike things of a room are not those of a board or of a table.
    """
    at = positions(things)[:, :2]
    if len({thing.type for thing in things if thing.position is not None}) < CLASSES:
        return None
    half = np.array([(0.0, 0.0) if thing.size is None else thing.size[:2] for thing in things]) / 2.0
    if np.isfinite(at).all(axis=1).sum() < THINGS:
        return None
    box = box_around(at, half)
    return box if is_wide(box) else None
