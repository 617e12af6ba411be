"""Pictures that stand upright: a page or a wall that who looks has before them, where what is higher is farther up.

"Top", "above" and "the bottom row" are said of them as of a table that is seen from one side, so they are laid flat.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from dcg_torch.scene.order import TIE
from dcg_torch.types import Object, Percept, Pose
from dcg_torch.types.arrays import Bools, Floats
from dcg_torch.types.geometry import positions, to_robot_frame

_SPOT = 0.05
"""Share of the picture's width within which one thing is straight over another."""
_EVEN = 1.2
"""Steps from row to row of a rack are at most so many times as high as others."""
_FAR_BEFORE = 20.0
"""How many times as far as a picture is wide."""
_ROWS, _COLUMNS = 2, 3
"""A wall of blocks is seldom so large; a page of pictures mostly is."""


def laid_flat(position: Floats) -> Floats:
    """Positions (n, 3) in the viewer's frame; of an upright picture with what is higher farther away, all on a level.

    A picture is what stands at one distance and at several heights, some of it over nothing (so it is no stack), or in
    rows and columns that are all full.
    """
    if not len(position) or position[:, 0].max() - position[:, 0].min() > TIE:
        return position
    seen = position[np.isfinite(position).all(axis=1)]
    if len(seen) < 3 or np.ptp(seen[:, 0]) > TIE or np.ptp(seen[:, 2]) <= TIE or np.ptp(seen[:, 1]) <= TIE:
        return position
    spot = _SPOT * np.ptp(seen[:, 1])
    beside = np.abs(seen[:, None, 1] - seen[None, :, 1]) <= spot
    apart = seen[:, None, 2] - seen[None, :, 2]
    below = (apart > TIE) & (apart < _next_row(seen[:, 2]))
    lowest = seen[:, 2] <= seen[:, 2].min() + TIE
    if (lowest | (beside & below).any(axis=1)).all() and not _is_full_grid(beside, seen[:, 2]):
        return position
    flat = position.copy()
    flat[:, 0] += position[:, 2] - seen[:, 2].min()
    flat[:, 2] = np.where(np.isfinite(position[:, 2]), 0.0, position[:, 2])
    return flat


def before_it(flat: Floats) -> Floats:
    """(3,) where who looks at a picture that is laid flat is: so far before it that what is lower in it is closer.

    Args:
        flat: (n, 3) what is in it; NaN of what is nowhere.
    """
    low, high = np.nanmin(flat, axis=0), np.nanmax(flat, axis=0)
    return np.array([low[0] - _FAR_BEFORE * max(float(high[1] - low[1]), TIE), (low[1] + high[1]) / 2.0, 0.0])


def is_upright(objects: Sequence[Object] | Sequence[Percept], viewer: Pose | None) -> bool:
    """Do objects stand as on a page or a wall that the viewer has before them?"""
    at = positions(objects)
    there = at[np.isfinite(at).all(axis=1)]
    if len(there) < 3 or np.ptp(there[:, 2]) <= TIE:
        return False
    there[:, :2] = to_robot_frame(viewer or Pose(0.0, 0.0), there[:, :2])
    return laid_flat(there) is not there


def _next_row(height: Floats) -> float:
    """How far below a thing what bears it is at most; where rows are even, one that is two rows below bears none."""
    steps = np.diff(np.unique(np.round(height / TIE))) * TIE
    even = len(steps) >= _ROWS and steps.max() <= _EVEN * steps.min()
    return 1.5 * float(steps.max()) if even else np.inf


def _is_full_grid(beside: Bools, height: Floats) -> bool:
    """Whether things (n,) fill at least two rows of three, so that there are as many in every column.

    Args:
        beside: (n, n) which stand in one column.
    """
    rows = len(np.unique(np.round(height / TIE)))
    deep = beside.sum(axis=1)
    return bool(rows >= _ROWS and (deep == rows).all() and len(height) >= _COLUMNS * rows)
