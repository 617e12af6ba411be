"""Which weights are equal at the optimum of a fit, by symmetry: so that each class of them is fitted as one.

The rows and columns of a design matrix are coloured: two rows alike if equally many columns of every colour fire in
them, two columns alike if they fire in equally many rows of every colour (colour refinement, also called the
1-dimensional Weisfeiler-Leman algorithm). Averaging the weights within a class averages the scores within classes of
rows, and the objective is strictly convex. So its one optimum has equal weights within a class (Mladenov, Ahmadi and
Kersting, "Lifted linear programming", AISTATS 2012, show it for linear programs; convexity is all that it needs).
Words with the same history are such a class; so are columns that always fire together.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from dcg_torch.fitting.design import Hashes, numbered, run_starts, scrambled
from dcg_torch.types.arrays import Floats, Ints


@dataclass(frozen=True)
class Incidence:
    """A sparse binary matrix: entry e says that column `column[e]` fires in row `row[e]`; sorted by row.

    Every row and every column has an entry.
    """

    row: Ints
    column: Ints
    rows: int
    columns: int

    @cached_property
    def starts(self) -> Ints:
        """(rows,) the first entry of each row."""
        return run_starts(self.row)

    def keep(self, rows: Ints) -> Incidence:
        """The incidence of these rows alone, in ascending order; columns keep their numbers."""
        number = np.full(self.rows, -1, dtype=np.int64)
        number[rows] = np.arange(len(rows))
        own = number[self.row]
        kept = own >= 0
        return Incidence(own[kept], self.column[kept], len(rows), self.columns)


@dataclass(frozen=True)
class Classes:
    """Rows and columns that are alike.

    Attributes:
        row, column: the class of each.
        row_first, column_first: the first of each class.
        row_size, column_size: how many each class has.
    """

    row: Ints
    column: Ints
    row_first: Ints
    column_first: Ints
    row_size: Ints
    column_size: Ints

    def incidence(self, of: Incidence) -> tuple[Incidence, Floats]:
        """Which column classes fire in which row classes, and how many columns of them."""
        size = len(self.column_size)
        if len(self.row_size) == of.rows:  # then columns that are alike fire in the same rows
            return self._columns_alone(of)
        one = of.keep(np.sort(self.row_first))
        of_row = self.row[np.sort(self.row_first)]
        cells, count = np.unique(of_row[one.row] * size + self.column[one.column], return_counts=True)
        return Incidence(cells // size, cells % size, len(self.row_size), size), count.astype(np.float64)

    def _columns_alone(self, of: Incidence) -> tuple[Incidence, Floats]:
        """The same where no two rows are alike; rows stay in their order."""
        first = np.zeros(of.columns, dtype=np.bool_)
        first[self.column_first] = True
        kept = first[of.column]
        column = self.column[of.column[kept]]
        one = Incidence(of.row[kept], column, of.rows, len(self.column_size))
        return one, self.column_size[column].astype(np.float64)


def row_keys(incidence: Incidence) -> Hashes:
    """(rows,) equal for rows in which the same columns fire."""
    bits = scrambled(np.arange(incidence.columns, dtype=np.uint64))
    return np.add.reduceat(bits[incidence.column], incidence.starts)


def bits_of(values: Sequence[Floats] | Floats, size: int) -> Hashes:
    """(size,) a hash of each column of `values` (n, size), bit by bit."""
    total = np.zeros(size, dtype=np.uint64)
    for row in values:
        total = scrambled(total ^ np.ascontiguousarray(row, dtype=np.float64).view(np.uint64))
    return total


def classes(incidence: Incidence, row_start: Hashes, column_start: Hashes) -> Classes:
    """The coarsest classes of rows and columns that are alike; rows stay in their order where no two of them are.

    Args:
        row_start: (rows,) rows that differ here are never alike.
        column_start: (columns,) the same of columns.
    """
    row_starts = incidence.starts
    rows, columns, found = row_start, column_start, (0, 0)
    while True:
        columns = scrambled(columns)
        mixed = scrambled(rows)
        np.add.at(columns, incidence.column, mixed[incidence.row])
        rows = mixed + np.add.reduceat(scrambled(columns)[incidence.column], row_starts)
        before, found = found, (count_distinct(rows), count_distinct(columns))
        apart = before[0] == len(rows)  # all rows were: no column can be told further from others
        if apart or found in (before, (len(rows), len(columns))):
            break
    every = np.arange(len(rows))
    row_first, row = (every, every) if found[0] == len(rows) else numbered(rows)
    column_first, column = numbered(columns)
    return Classes(row, column, row_first, column_first, np.bincount(row), np.bincount(column))


def count_distinct(keys: Hashes) -> int:
    """How many distinct ones there are."""
    ordered = np.sort(keys)
    return int(np.count_nonzero(ordered[1:] != ordered[:-1])) + min(1, len(keys))
