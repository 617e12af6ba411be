"""Rows of a fit that are not written out: a grid of phrases and groundings, or sums of cells."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from dcg_torch.fitting.design import DesignMatrix, Ints, distinct_rows
from dcg_torch.fitting.psi import Bag, Floats, binary
from dcg_torch.fitting.rows import GridRows, Numbers, SparseRows, smallest_index

Mask = NDArray[np.bool_]

_GRID = 0.25
"""Share of phrases and groundings that occur together from which on the whole product is the faster way."""


def fills_grid(design: DesignMatrix) -> bool:
    """Do most phrases occur with most groundings?"""
    return len(design.phrase) >= _GRID * len(design.language) * len(design.things[0])


def cell_rows(design: DesignMatrix, fires: Mask, *, whole: bool, unique: bool) -> tuple[GridRows | SparseRows, Ints]:
    """What fires, and where the design's rows are in the grid, or which of them are left.

    Args:
        fires: (L, G) the pairs that move.
        whole: all pairs may move, whether they fire or not; to a grid they are all the same.
        unique: no two rows fire the same.
    """
    language, active = binary(design.language, len(fires)), np.flatnonzero(fires)
    grid = _grid(design, language, fires.shape[1], None if whole else active) if unique else None
    if grid is not None:
        return grid
    moving = np.zeros((len(language), fires.shape[1] + 1), dtype=np.bool_)
    moving[:, :-1] = language @ fires > 0.0
    rows, row_cells, cells = _used_cells(design, moving)
    cell_variables = _variables(design.language, np.divmod(cells, moving.shape[1]), fires, active)
    shape = len(rows), len(cells), len(active)
    return SparseRows.of(row_cells, cell_variables, shape), rows


def _grid(design: DesignMatrix, language: Floats, groundings: int, active: Ints | None) -> tuple[GridRows, Ints] | None:
    """The design's rows as cells of a grid, if they fill it."""
    things, thing = distinct_rows(design.grounding)
    if len(thing) < _GRID * len(language) * len(things):
        return None
    return GridRows(language, binary(things, groundings), active), design.phrase * len(things) + thing


def _used_cells(design: DesignMatrix, moving: Mask) -> tuple[Ints, tuple[Ints, Numbers], Ints]:
    """The rows in which something moves, which cells each has, by their numbers, and the cells of all.

    Args:
        moving: (A, G + 1) the cells in which something does; in those of padding nothing.
    """
    used = moving[design.phrase[:, None], design.grounding]
    length = np.count_nonzero(used, axis=1)
    rows = np.flatnonzero(length)
    small = smallest_index(moving.size)
    start = (design.phrase * moving.shape[1]).astype(small)
    code = (design.grounding.astype(small) + start[:, None])[used]
    occurs = np.zeros(moving.size, dtype=np.bool_)
    occurs[code] = True
    number = (np.cumsum(occurs, dtype=small) - 1)[code]
    return rows, (_starts(length[rows]), number), np.flatnonzero(occurs)


def _variables(language: Bag, cells: tuple[Ints, Ints], fires: Mask, active: Ints) -> tuple[Ints, Numbers]:
    """Which variables each cell, of a phrase and a grounding column, has: where each one's begin, and their numbers."""
    phrase, column = cells
    variable = np.full(fires.size + 1, -1, dtype=smallest_index(fires.size))
    variable[active] = np.arange(len(active))
    pairs = np.where(language >= 0, language * fires.shape[1], fires.size)[phrase]
    pairs += column[:, None]
    of_cell = variable[np.minimum(pairs, fires.size, out=pairs)]
    fire = of_cell >= 0
    return _starts(np.count_nonzero(fire, axis=1)), of_cell[fire]


def _starts(lengths: Ints) -> Ints:
    """(n + 1,) where each of n lists begins, one after another."""
    return np.concatenate([[0], np.cumsum(lengths)])


def together(design: DesignMatrix, groundings: int) -> Floats:
    """(A, G) does a grounding column fire in some row of a phrase?"""
    found = np.zeros((len(design.language), groundings + 1))
    for column in design.grounding.T:
        found[design.phrase, column] = 1.0
    return found[:, :-1]
