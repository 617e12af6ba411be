"""Rows of a fit written out as the pairs that fire in them, beside what does not move: a sparse binary matrix."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from dcg_torch.fitting.design import DesignMatrix, numbered
from dcg_torch.fitting.objective import likelihood
from dcg_torch.fitting.psi import Bag, scores, wrapped
from dcg_torch.fitting.symmetry import Incidence, bits_of, count_distinct, row_keys
from dcg_torch.types.arrays import Bools, Floats, Ints

_SCATTERED = 8
"""By how much longer it takes to look at a weight here and there than at all in a row."""


@dataclass(frozen=True)
class Written:
    """The rows in which some weight moves, those that fire the same merged, and the K variables of each difference.

    Attributes:
        incidence: (N, K) which variable fires in which row.
        count: (P, N) summed weights of the examples with each label.
        offset: (Q, N) score differences by weights that do not move; None: nothing.
        start: (Q, K) the variables at the present weights.
        strength: (K,) l2 of each.
        columns: (K,) the cells of (L, G) that they are.
        constant: of the likelihood, from rows in which no weight moves.
    """

    incidence: Incidence
    count: Floats
    offset: Floats | None
    start: Floats
    strength: Floats
    columns: Ints
    constant: float


def write_out(
    designs: Sequence[DesignMatrix],
    weight: Floats,
    fixed: Floats,
    active: Bools,
    strength: Floats,
    times: Floats | None = None,
) -> Written:
    """The rows of designs, of which there is at least one; for the arguments see `reduction.reduce`."""
    codes = [_codes(design, active.shape) for design in designs]
    incidence, rows, columns = _written_out(codes, active)
    offset, count = _offset(designs, codes, fixed), np.concatenate([design.count for design in designs], axis=1)
    unmoved = np.ones(count.shape[1], dtype=np.bool_)
    unmoved[rows] = False
    constant = constant_of(count, offset, unmoved)
    start, own = differences(weight, fixed, columns), at_cells(strength, columns, times)
    count, offset = count[:, rows], None if offset is None else offset[:, rows]
    if len(rows):
        incidence, count, offset = _merged(incidence, count, offset)
    return Written(incidence, count, offset, start, own, columns, constant)


def count_firing(designs: Sequence[DesignMatrix], active: Bools) -> int:
    """How many of the active weights fire in some row."""
    seen = np.zeros((active.shape[0] + 1) * (active.shape[1] + 1), dtype=np.bool_)
    for design in designs:
        seen[_codes(design, active.shape)] = True
    return int(np.count_nonzero(seen & _one_more(active).reshape(-1)))


def at_cells(strength: Floats, cells: Ints, times: Floats | None = None) -> Floats:
    """(K,) the penalty l2 (L, G) at some cells, each as often as its language column counts."""
    alike = not any(strength.strides)  # one number for all
    own = np.full(len(cells), strength.flat[0]) if alike else strength.reshape(-1)[cells]
    return own if times is None else own * times[cells // strength.shape[1]]


def weight_at(d: Floats, fixed: Floats, columns: Ints) -> Floats:
    """(P, L, G) weights at variables (Q, K) of some cells, beside those that do not move; written into `fixed`."""
    mean = d.sum(axis=0) / len(fixed)
    flat = fixed.reshape(len(fixed), -1)
    flat[0, columns] -= mean
    flat[1:, columns] += d - mean
    return fixed


def offset_of(designs: Sequence[DesignMatrix], fixed: Floats) -> Floats | None:
    """(Q, N) score differences by weights that do not move."""
    if not fixed.any():
        return None
    totals = []
    for design in designs:
        (left, language), (right, grounding) = (_compact(bag) for bag in (design.language, design.grounding))
        totals.append(scores(fixed[:, left[:, None], right], language, grounding, design.phrase))
    total = np.concatenate(totals, axis=1)
    offset: Floats = total[1:] - total[0]
    return offset


def _compact(bag: Bag) -> tuple[Ints, Bag]:
    """The columns that occur in a bag, and the bag with their numbers among these."""
    occurs = np.zeros(int(bag.max(initial=-1)) + 2, dtype=np.bool_)
    occurs[bag] = True
    occurs[-1] = False  # the padding
    columns = np.flatnonzero(occurs)
    number = np.full(len(occurs), -1, dtype=np.int64)
    number[columns] = np.arange(len(columns))
    return columns, number[bag]


def constant_of(count: Floats, offset: Floats | None, rows: Bools) -> float:
    """The negative log-likelihood of some rows, whose scores are `offset`."""
    own = count[:, rows]
    u = np.zeros((len(count) - 1, own.shape[1])) if offset is None else offset[:, rows]
    return likelihood(u, own, own.sum(axis=0))[0]


def differences(weight: Floats, fixed: Floats, columns: Ints) -> Floats:
    """(Q, K) how the weights of P - 1 correspondences differ from the first's, beside the prior's."""
    moved = weight.reshape(len(weight), -1)[:, columns] - fixed.reshape(len(weight), -1)[:, columns]
    differences: Floats = moved[1:] - moved[0]
    return differences


def _codes(design: DesignMatrix, shape: tuple[int, int]) -> Ints:
    """(N, k, k') the cell of each pair that fires, in a table of one language and one grounding column more."""
    languages, groundings = shape
    left = (wrapped(design.language, languages + 1) * (groundings + 1))[design.phrase]
    return left[:, :, None] + wrapped(design.grounding, groundings + 1)[:, None, :]


def _one_more(mask: Bools) -> Bools:
    """(L + 1, G + 1) with what padding fires: nothing."""
    found = np.zeros((mask.shape[0] + 1, mask.shape[1] + 1), dtype=np.bool_)
    found[:-1, :-1] = mask
    return found


def _offset(designs: Sequence[DesignMatrix], codes: Sequence[Ints], fixed: Floats) -> Floats | None:
    """(Q, N) score differences by weights that do not move; few of those that fire are not zero."""
    some = _not_zero(designs, fixed)
    if not some.any():
        return None
    flat, width, totals = some.reshape(-1), fixed.shape[2], []
    for code in codes:
        fires = flat[code]
        rows = np.repeat(np.arange(len(code)), np.count_nonzero(fires, axis=(1, 2)))
        left, right = np.divmod(code[fires], width + 1)
        values = fixed[:, left, right]
        totals.append(summed(values[1:] - values[0], rows, len(code)))
    return np.concatenate(totals, axis=1)


def _not_zero(designs: Sequence[DesignMatrix], weight: Floats) -> Bools:
    """(L + 1, G + 1) which of the pairs that may fire have a weight; of others it may say anything."""
    firing = [tuple(_compact(bag)[0] for bag in (design.language, design.grounding)) for design in designs]
    if sum(len(left) * len(right) for left, right in firing) * _SCATTERED > weight[0].size:
        return _one_more((weight != 0.0).any(axis=0))
    some = np.zeros((weight.shape[1] + 1, weight.shape[2] + 1), dtype=np.bool_)
    for left, right in firing:
        some[np.ix_(left, right)] = (weight[:, left[:, None], right] != 0.0).any(axis=0)
    return some


def _written_out(codes: Sequence[Ints], active: Bools) -> tuple[Incidence, Ints, Ints]:
    """Which pairs fire: of the rows in which some does, the rows' numbers, and the cells of (L, G) that do."""
    groundings = active.shape[1]
    mask = _one_more(active)
    flat, parts, lengths = mask.reshape(-1), [], []
    for code in codes:
        fires = flat.take(code)
        parts.append(code.take(np.flatnonzero(fires)))
        lengths.append(np.count_nonzero(fires, axis=(1, 2)))
    pairs, length = np.concatenate(parts), np.concatenate(lengths)
    seen = np.zeros(mask.size, dtype=np.bool_)
    seen[pairs] = True
    cells = np.flatnonzero(seen)
    number = np.empty(mask.size, dtype=np.int64)
    number[cells] = np.arange(len(cells))
    rows = np.flatnonzero(length)
    incidence = Incidence(np.repeat(np.arange(len(rows)), length[rows]), number[pairs], len(rows), len(cells))
    return incidence, rows, cells - cells // (groundings + 1)  # without the last column of each language column


def _merged(incidence: Incidence, count: Floats, offset: Floats | None) -> tuple[Incidence, Floats, Floats | None]:
    """Rows in which the same pairs fire become one."""
    keys = row_keys(incidence)
    if offset is not None:
        keys = keys + bits_of(offset, incidence.rows)
    if count_distinct(keys) == len(keys):
        return incidence, count, offset
    first, which = numbered(keys)
    order = np.argsort(first)  # rows stay in their order
    rank = np.empty_like(order)
    rank[order] = np.arange(len(order))
    first = first[order]
    return (
        incidence.keep(first),
        summed(count, rank[which], len(first)),
        None if offset is None else offset[:, first],
    )


def summed(values: Floats, which: Ints, size: int) -> Floats:
    """(n, size): sums of the columns of `values` with the same number."""
    return np.stack([np.bincount(which, row, minlength=size) for row in values])
