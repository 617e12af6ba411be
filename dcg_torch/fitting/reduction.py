"""From design matrices to the smallest problem that has the same optimum.

Few rows: each row is written out as the pairs that fire, and rows and weights that are alike by symmetry become one.
Where few weights are left that rows share, weights of a single row are eliminated, and Newton's method has a dense
matrix of the others.

Many rows: pairs are never written out. Scores are sums over cells of the phrases' side times the weights, or, where
most phrases occur with most groundings, the whole product of the phrases' side, the weights and the groundings' side.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from dcg_torch.fitting.arrowhead import Split, split
from dcg_torch.fitting.cells import cell_rows, fills_grid, firing
from dcg_torch.fitting.design import DesignMatrix, concatenate, stack
from dcg_torch.fitting.objective import Objective
from dcg_torch.fitting.rows import ArrowheadRows, GridRows, SparseRows
from dcg_torch.fitting.sparse_rows import (
    Written,
    at_cells,
    constant_of,
    count_firing,
    differences,
    offset_of,
    summed,
    weight_at,
    write_out,
)
from dcg_torch.fitting.symmetry import Classes, Incidence, bits_of, classes
from dcg_torch.types.arrays import Bools, Floats, Ints

_FEW_ENTRIES, _SOME_ENTRIES, _MOST_ENTRIES = 50_000, 200_000, 2_000_000
"""Pairs that may fire, over all rows, up to which rows are written out: always; unless they share many weights and are
a grid, as then few of them are alike; if they share few weights."""
_CROWDED = 50
"""Rows in which a weight fires, on average, from which on rows are taken to share all of them."""
_SHARING = 4
"""Rows in which a weight fires, on average, from which on rows are fitted as they are written out."""
_NEWTON_COLUMNS, _NEWTON_WORK, _LITTLE_WORK = 400, 3e8, 4.5e7
"""Weights that rows share, and multiplications a step, up to which Newton's method is the fastest way; the latter
where rows may be fitted as they are written out."""
_IN_PARTS = 8
"""By how much less work it may be that rows and weights fall into parts that share nothing: from there on it is not
looked at."""


@dataclass(frozen=True)
class Reduced:
    """The problem for a solver, and the way back.

    Attributes:
        objective: of the flat variables.
        start: the variables at the present weights.
        constant: of the likelihood, from rows in which no weight moves.
        fixed: (P, L, G) the weights without what the solver moves.
        columns: (K',) the cells of (L, G) that move.
        tied: the class of each of the K' among the solver's K variables, and its share of it; None: they are the same.
    """

    objective: Objective
    start: Floats
    constant: float
    fixed: Floats
    columns: Ints
    tied: tuple[Ints, Floats] | None

    def weight(self, at: Floats) -> Floats:
        """(P, L, G) at the solver's variables; written into `fixed`, so it is to be asked for once."""
        d = at.reshape(len(self.fixed) - 1, -1)
        if self.tied is not None:
            d = d[:, self.tied[0]] * self.tied[1]
        return weight_at(d, self.fixed, self.columns)


def reduce(
    designs: Sequence[DesignMatrix],
    weight: Floats,
    fixed: Floats,
    active: Bools,
    strength: Floats,
    times: Floats | None = None,
    *,
    prefer: str = "auto",
) -> Reduced:
    """The problem of moving the `active` weights.

    Args:
        designs: labelled factors; the objective is the sum over all.
        weight: (P, L, G) the start.
        fixed: (P, L, G) the weights that do not move, and the prior of those that do.
        active: (L, G) which may move.
        strength: (L, G) l2.
        times: (L,) as how many each language column counts; None: one.
        prefer: the solver that was asked for.
    """
    if not designs:
        empty = np.zeros((0, 0), dtype=np.int64)
        designs = [DesignMatrix(empty, empty, np.zeros(0, dtype=np.int64), np.zeros((len(weight), 0)))]
    if prefer == "newton" or (prefer == "auto" and _may_be_written(designs, active)):
        found = _written(write_out(designs, weight, fixed, active, strength, times), fixed, always=prefer == "newton")
        if found is not None:
            return found
    return _factored(designs, weight, fixed, active, strength, times)


def _written(written: Written, fixed: Floats, *, always: bool) -> Reduced | None:
    """Rows written out and made few by symmetry; None if neither Newton's method nor fitting them as they are pays.

    Args:
        always: Newton's method it is to be.
    """
    incidence, columns, constant = written.incidence, written.columns, written.constant
    count, offset, start, own = written.count, written.offset, written.start, written.strength
    if not incidence.rows:
        none = ArrowheadRows(np.zeros((0, 0)), None, np.zeros(0))
        return Reduced(Objective(none, count, None, np.zeros(0)), np.zeros(0), constant, fixed, columns, None)
    alike = _alike(incidence, count, offset, own)
    root = np.sqrt(alike.column_size)
    incidence, fires = alike.incidence(incidence)
    count = count[:, alike.row_first] * alike.row_size
    offset = None if offset is None else offset[:, alike.row_first]
    own, start = own[alike.column_first], summed(start, alike.column, len(root)) / root
    value = fires / root[incidence.column]
    sparse = _SHARING * len(root) <= len(incidence.column) <= _CROWDED * len(root)
    found = split(incidence, value) if always or _may_pay(incidence) else None
    if found is None or not (always or _pays(found, len(start), _LITTLE_WORK if sparse else _NEWTON_WORK)):
        if not sparse:
            return None
        rows = SparseRows.written(incidence, value)
        tied = alike.column, (1.0 / root)[alike.column]
        return Reduced(
            Objective(rows, count, offset, own, 1.0 / root), start.reshape(-1), constant, fixed, columns, tied
        )
    order = found.order
    number = np.empty_like(order)
    number[order] = np.arange(len(order))
    tied = number[alike.column], (1.0 / root)[alike.column]
    count, offset = count[:, found.row_order], None if offset is None else offset[:, found.row_order]
    objective = Objective(found.rows, count, offset, own[order], 1.0 / root[order])
    return Reduced(objective, start[:, order].reshape(-1), constant, fixed, columns, tied)


def _may_pay(incidence: Incidence) -> bool:
    """May Newton's method pay? Not if too many columns fire in several rows."""
    return int(np.count_nonzero(np.bincount(incidence.column) > 1)) <= _NEWTON_COLUMNS


def _pays(found: Split, q: int, most: float) -> bool:
    """Does a step of Newton's method take at most so many multiplications, and are few weights shared?"""
    shared, own = len(found.shared), 40 * q * q * found.incidence.rows
    work = _work(len(found.first), q * shared) + own
    if shared > _NEWTON_COLUMNS or work > _IN_PARTS * most:
        return False
    return work <= most or sum(_work(len(rows), q * len(part)) for rows, part, _ in found.rows.blocks) + own <= most


def _work(rows: int, variables: int) -> int:
    """Multiplications for a Hessian of so many variables in so many rows, and to solve it."""
    return (rows + variables) * variables * variables


def _alike(incidence: Incidence, count: Floats, offset: Floats | None, strength: Floats) -> Classes:
    rows = bits_of(count if offset is None else np.concatenate([count, offset]), incidence.rows)
    return classes(incidence, rows, bits_of(strength[None], incidence.columns))


def _may_be_written(designs: Sequence[DesignMatrix], active: Bools) -> bool:
    """May it pay to write rows out? Not if so many share each of many weights that Newton's method takes long."""
    entries: int = sum(design.grounding.size * design.language.shape[1] for design in designs)
    if entries <= _FEW_ENTRIES or entries > _MOST_ENTRIES:
        return entries <= _FEW_ENTRIES
    columns = count_firing(designs, active)
    crowded = columns > _NEWTON_COLUMNS and entries > _CROWDED * columns
    return not crowded or (entries <= _SOME_ENTRIES and not all(map(fills_grid, designs)))


def _factored(
    designs: Sequence[DesignMatrix],
    weight: Floats,
    fixed: Floats,
    active: Bools,
    strength: Floats,
    times: Floats | None,
) -> Reduced:
    """Rows as cells of the phrases' side times the weights."""
    design = stack(designs)
    fires = firing(design, active)
    left, right = (np.flatnonzero(fires.any(axis=axis)) for axis in (1, 0))
    narrow = (len(left), len(right)) != active.shape
    kept = _kept(left, active.shape[0]), _kept(right, active.shape[1])
    if fixed.any():  # rows that fire the same columns of those that move may have different scores
        design = concatenate([design])
        offset, design = offset_of([design], fixed), design.renamed(*kept) if narrow else design
    else:
        offset, design = None, concatenate([design.renamed(*kept) if narrow else design])
    own, whole = fires[np.ix_(left, right)], bool(active[np.ix_(left, right)].all())
    rows, cells = cell_rows(design, own, whole=whole, unique=offset is None or not narrow)
    count, constant = design.count, 0.0
    if isinstance(cells, slice):
        pass  # all are left as they are
    elif isinstance(rows, GridRows):
        size = len(rows.language) * len(rows.grounding)
        count, offset = _placed(count, cells, size), None if offset is None else _placed(offset, cells, size)
    else:
        unmoved = np.ones(count.shape[1], dtype=np.bool_)
        unmoved[cells] = False
        constant = constant_of(count, offset, unmoved)
        count, offset = count[:, cells], None if offset is None else offset[:, cells]
    columns = (left[:, None] * active.shape[1] + right).reshape(-1)
    if not isinstance(rows, GridRows):
        columns = columns[np.flatnonzero(own)]
    elif rows.active is not None:
        columns = columns[rows.active]
    start = differences(weight, fixed, columns).reshape(-1)
    objective = Objective(rows, count, offset, at_cells(strength, columns, times))
    return Reduced(objective, start, constant, fixed, columns, None)


def _kept(columns: Ints, size: int) -> Ints:
    """(size + 1, 1) the new number of each column that is kept, -1 of the others: see `DesignMatrix.renamed`."""
    table = np.full((size + 1, 1), -1, dtype=np.int64)
    table[columns, 0] = np.arange(len(columns))
    return table


def _placed(values: Floats, cells: Ints, size: int) -> Floats:
    whole = np.zeros((len(values), size))
    whole[:, cells] = values
    return whole
