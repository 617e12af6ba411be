"""Racks and boards of things in even rows and columns, of which some cells may be empty: the cell of each thing."""

from __future__ import annotations

import itertools
import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from dcg_torch.scene.upright_pictures import laid_flat
from dcg_torch.types import Object, Pose
from dcg_torch.types.arrays import Floats, Ints
from dcg_torch.types.geometry import positions, to_robot_frame

_LEAST, _FULL = 6, 0.6
"""Things of a grid, and the share of its cells that they fill."""
_EVEN, _ASIDE = 1.35, 0.2
"""Steps are at most so many times as long as others; a thing is beside its line by so much of a step at most."""

_FEW, _CLEARLY = 64, 1.01
"""Things up to which they are looked at one by one, and how far beyond a bound is clearly beyond it."""

Cell = tuple[int, int]
"""Row from the top and column from the left, from 0."""


@dataclass(frozen=True)
class Grid:
    """Ids of things and the cells that they are in, and how many rows and columns there are."""

    cells: dict[str, Cell]
    rows: int
    columns: int

    def central(self) -> set[Cell]:
        """The cell in the middle, or those around it."""
        rows, columns = ({(n - 1) // 2, n // 2} for n in (self.rows, self.columns))
        return {(r, c) for r in rows for c in columns}

    def rim(self) -> set[Cell]:
        """The cells at the ends of rows or columns."""
        return {(r, c) for r, c in self._all() if r in (0, self.rows - 1) or c in (0, self.columns - 1)}

    def corners(self) -> set[Cell]:
        """The cells at the ends of both."""
        return {(r, c) for r, c in self._all() if r in (0, self.rows - 1) and c in (0, self.columns - 1)}

    def _all(self) -> set[Cell]:
        return {(r, c) for r in range(self.rows) for c in range(self.columns)}


def grid_of(objects: Sequence[Object], viewer: Pose | None = None) -> Grid | None:
    """The grid in which all things stand, as the viewer sees it; None where they stand in none.

    Args:
        objects: those without a position are nowhere.
    """
    there = [o for o in objects if o.position is not None]
    if len(there) < _LEAST or _lies_scattered([o.position for o in there if o.position is not None], viewer):
        return None
    position = positions(there)
    position[:, :2] = to_robot_frame(viewer or Pose(0.0, 0.0), position[:, :2])
    position = laid_flat(position)
    if np.ptp(position[:, 2]) > 1e-3 * max(1e-9, float(np.ptp(position[:, :2]))):
        return None
    row = _numbered(-position[:, 0])
    column = None if row is None else _numbered(-position[:, 1])
    if row is None or column is None:
        return None
    cells = list(zip(row.tolist(), column.tolist(), strict=True))
    rows, columns = int(row.max()) + 1, int(column.max()) + 1
    if len(set(cells)) < len(cells) or min(rows, columns) < 2 or len(cells) < _FULL * rows * columns:
        return None
    return Grid({o.id: cell for o, cell in zip(there, cells, strict=True)}, rows, columns)


def _lies_scattered(position: Sequence[tuple[float, float, float]], viewer: Pose | None) -> bool:
    """Are few things on one level clearly on no even lines, from front to back? It takes little time to tell."""
    if len(position) > _FEW or len({z for _, _, z in position}) > 1:
        return False
    yaw = 0.0 if viewer is None else viewer.yaw
    c, s = math.cos(yaw), math.sin(yaw)
    order = sorted([c * x + s * y for x, y, _ in position])
    gaps = [after - before for before, after in itertools.pairwise(order)]
    bound = 0.5 * max(gaps)
    starts = [0, *(k + 1 for k, gap in enumerate(gaps) if gap > bound), len(order)]
    middles = [sum(order[a:b]) / (b - a) for a, b in itertools.pairwise(starts)]
    steps = [after - before for before, after in itertools.pairwise(middles)]
    spread = max(order[b - 1] - order[a] for a, b in itertools.pairwise(starts))
    least = _CLEARLY * min(steps, default=0.0)
    return len(steps) > 1 and (max(steps) > _EVEN * least or spread > _ASIDE * least)


def _numbered(values: Floats) -> Ints | None:
    """(n,) the number of the line on which each lies, lines being one step apart; None where they are not."""
    order = np.sort(values)
    gaps = order[1:] - order[:-1]
    if not len(gaps) or gaps.max() <= 0.0:
        return None
    bounds = [0, *((gaps > 0.5 * gaps.max()).nonzero()[0] + 1).tolist(), len(order)]
    starts, ends = np.array(bounds[:-1]), np.array(bounds[1:])
    middles = np.add.reduceat(order, starts) / (ends - starts)
    steps = middles[1:] - middles[:-1]
    spread = (order[ends - 1] - order[starts]).max()
    if (len(steps) > 1 and steps.max() > _EVEN * steps.min()) or spread > _ASIDE * steps.min():
        return None
    found: Ints = np.abs(values[:, None] - middles[None]).argmin(axis=1)
    return found
