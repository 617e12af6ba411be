"""Rows of a fit that are not written out: a grid of phrases and groundings, or sums of cells."""

from __future__ import annotations

import numpy as np

from dcg_torch.fitting.design import DesignMatrix, may_have_few
from dcg_torch.fitting.phrase_rows import PhraseRows
from dcg_torch.fitting.psi import Bag, Numbers, binary
from dcg_torch.fitting.rows import GridRows, SparseRows, smallest_index
from dcg_torch.types.arrays import Bools, Ints

_GRID = 0.25
"""Share of phrases and groundings that occur together from which on the whole product is the faster way."""
_MANY, _SCATTERED = 1 << 18, 2
"""Entries of all rows from which on rows are done by phrases, if tables of what each phrase may fire with have at most
so many times as many cells."""
_AT_ONCE = 1 << 10
"""Phrases at once."""


def fills_grid(design: DesignMatrix) -> bool:
    """Do most phrases occur with most groundings?"""
    most = len(design.phrase) / (_GRID * max(1, len(design.language)))
    return may_have_few(design.grounding, most) and len(design.things[0]) <= most


def cell_rows(
    design: DesignMatrix, fires: Bools, *, whole: bool, unique: bool
) -> tuple[GridRows | PhraseRows | SparseRows, Ints | slice]:
    """What fires, and where the design's rows are in the grid, or which of them are left.

    Args:
        design: its rows are merged, or in the order of their phrases.
        fires: (L, G) the pairs that move.
        whole: all pairs may move, whether they fire or not; to a grid they are all the same.
        unique: no two rows fire the same.
    """
    active = np.flatnonzero(fires)
    if unique and fills_grid(design):
        return _grid(design, fires.shape, None if whole else active)
    if _MANY < design.grounding.size >= len(design.language) * (fires.shape[1] + 1) / _SCATTERED:
        return PhraseRows.of(design, active, fires.shape), slice(None)
    language = binary(design.language, len(fires))
    moving = np.zeros((len(language), fires.shape[1] + 1), dtype=np.bool_)
    moving[:, :-1] = language @ fires > 0.0
    rows, row_cells, cells = _used_cells(design, moving)
    cell_variables = _variables(design.language, np.divmod(cells, moving.shape[1]), fires, active)
    shape = len(rows), len(cells), len(active)
    return SparseRows.of(row_cells, cell_variables, shape), rows


def _grid(design: DesignMatrix, shape: tuple[int, int], active: Ints | None) -> tuple[GridRows, Ints]:
    """The design's rows as cells of a grid."""
    (things, thing), language = design.things, binary(design.language, shape[0])
    return GridRows(language, binary(things, shape[1]), active), design.phrase * len(things) + thing


def _used_cells(design: DesignMatrix, moving: Bools) -> tuple[Ints, tuple[Ints, Numbers], Ints]:
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


def _variables(language: Bag, cells: tuple[Ints, Ints], fires: Bools, active: Ints) -> tuple[Ints, Numbers]:
    """Which variables each cell, of a phrase and a grounding column, has: where each one's begin, and their numbers."""
    phrase, column = cells
    variable = np.full(fires.size + 1, -1, dtype=smallest_index(fires.size))
    variable[active] = np.arange(len(active))
    wide = language.astype(np.int64)
    pairs = np.where(wide >= 0, wide * fires.shape[1], fires.size)[phrase]
    pairs += column[:, None]
    of_cell = variable[np.minimum(pairs, fires.size, out=pairs)]
    fire = of_cell >= 0
    return _starts(np.count_nonzero(fire, axis=1)), of_cell[fire]


def _starts(lengths: Ints) -> Ints:
    """(n + 1,) where each of n lists begins, one after another."""
    return np.concatenate([[0], np.cumsum(lengths)])


def firing(design: DesignMatrix, active: Bools) -> Bools:
    """(L, G) which of the active weights fire."""
    together = np.zeros((len(design.language), active.shape[1] + 1), dtype=np.bool_)
    for column in design.grounding.T:
        together[design.phrase, column] = True
    found = np.zeros(active.shape, dtype=np.bool_)
    for start in range(0, len(together), _AT_ONCE):
        phrases = slice(start, start + _AT_ONCE)
        found |= binary(design.language[phrases], len(active)).T @ together[phrases, :-1].astype(np.float64) > 0.0
    found &= active
    return found
