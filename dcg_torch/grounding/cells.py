"""Rows of a fit that are not written out: a grid of phrases and groundings, or sums of cells."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from dcg_torch.grounding.design import DesignMatrix, Ints, distinct_rows
from dcg_torch.grounding.psi import Floats, binary
from dcg_torch.grounding.rows import GridRows, SparseRows

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
    things, thing = distinct_rows(design.grounding)
    if unique and len(thing) >= _GRID * len(language) * len(things):
        grid = GridRows(language, binary(things, fires.shape[1]), None if whole else active)
        return grid, design.phrase * len(things) + thing
    moving = np.zeros((len(language), fires.shape[1] + 1), dtype=np.bool_)
    moving[:, :-1] = language @ fires > 0.0
    used = moving[design.phrase[:, None], design.grounding]
    length = used.sum(axis=1)
    rows = np.flatnonzero(length)
    code = (design.grounding + design.phrase[:, None] * moving.shape[1])[used]
    occurs = np.zeros(moving.size, dtype=np.bool_)
    occurs[code] = True
    cells = np.flatnonzero(occurs)
    number = (np.cumsum(occurs) - 1)[code]
    variable = np.full(fires.size + 1, -1, dtype=np.int64)
    variable[active] = np.arange(len(active))
    phrase, column = np.divmod(cells, moving.shape[1])
    pairs = np.where(design.language >= 0, design.language * fires.shape[1], fires.size)[phrase] + column[:, None]
    of_cell = variable[np.minimum(pairs, fires.size)]
    fire = of_cell >= 0
    shape = len(rows), len(cells), len(active)
    return SparseRows.of((_starts(length[rows]), number), (_starts(fire.sum(axis=1)), of_cell[fire]), shape), rows


def _starts(lengths: Ints) -> Ints:
    """(n + 1,) where each of n lists begins, one after another."""
    return np.concatenate([[0], np.cumsum(lengths)])


def together(design: DesignMatrix, groundings: int) -> Floats:
    """(A, G) does a grounding column fire in some row of a phrase?"""
    found = np.zeros((len(design.language), groundings + 1))
    for column in design.grounding.T:
        found[design.phrase, column] = 1.0
    return found[:, :-1]
