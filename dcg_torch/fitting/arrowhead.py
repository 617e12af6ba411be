"""Which variables of a fit are one row's own: from what fires in which row to rows of the arrowhead."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from dcg_torch.fitting.design import numbered, scrambled
from dcg_torch.fitting.rows import ArrowheadRows
from dcg_torch.fitting.symmetry import Incidence
from dcg_torch.types.arrays import Floats, Ints

_MOSTLY_APART = 0.9
"""Share of patterns among rows from which on it takes less time to treat each row as its own."""


@dataclass(frozen=True)
class Split:
    """The columns that rows share, and those that are one row's own.

    Attributes:
        incidence: all that fires.
        value: (entries,) how much.
        private: (entries,) the numbers of those of a column that fires nowhere else; at most one of each row.
        shared: (S,) the other columns.
        pattern: (rows,) the number of what fires of the shared columns.
        first: (M,) the first row of each pattern.
    """

    incidence: Incidence
    value: Floats
    private: Ints
    shared: Ints
    pattern: Ints
    first: Ints

    @property
    def order(self) -> Ints:
        """(columns,) the column of each variable: the shared ones, then the rows' own."""
        return np.concatenate([self.shared, self.incidence.column[self.private]])

    @cached_property
    def row_order(self) -> Ints:
        """(rows,) the rows as a fit has them: those with a variable of their own come first."""
        own = self.incidence.row[self.private]
        others = np.ones(self.incidence.rows, dtype=np.bool_)
        others[own] = False
        return np.concatenate([own, np.flatnonzero(others)])

    @cached_property
    def rows(self) -> ArrowheadRows:
        """The rows of the fit, in `row_order`."""
        incidence, order = self.incidence, self.row_order
        number = np.full(incidence.columns, -1, dtype=np.int64)
        number[self.shared] = np.arange(len(self.shared))
        alone = len(self.first) >= _MOSTLY_APART * incidence.rows
        first = order if alone else self.first
        at = np.full(incidence.rows, -1, dtype=np.int64)
        at[first] = np.arange(len(first))
        kept = (at[incidence.row] >= 0) & (number[incidence.column] >= 0)
        patterns = np.zeros((len(first), len(self.shared)))
        patterns[at[incidence.row[kept]], number[incidence.column[kept]]] = self.value[kept]
        return ArrowheadRows(patterns, None if alone else self.pattern[order], self.value[self.private])


def split(incidence: Incidence, value: Floats) -> Split:
    """Tell what rows share from what is one row's own.

    Args:
        value: (entries,) how much each entry counts; equal ones of a column are equal to the last bit.
    """
    once = np.bincount(incidence.column, minlength=incidence.columns)[incidence.column] == 1
    private = np.flatnonzero(once)
    _, first = np.unique(incidence.row[private], return_index=True)
    private = private[first]
    alone = np.zeros(len(incidence.row), dtype=np.bool_)
    alone[private] = True
    is_shared = np.ones(incidence.columns, dtype=np.bool_)
    is_shared[incidence.column[private]] = False
    bits = scrambled(scrambled(incidence.column.astype(np.uint64)) ^ value.view(np.uint64))
    keys = np.add.reduceat(np.where(alone, np.uint64(0), bits), incidence.starts)
    first, pattern = numbered(keys)
    return Split(incidence, value, private, np.flatnonzero(is_shared), pattern, first)
