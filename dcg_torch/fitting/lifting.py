"""Words with the same history are fitted as one: found before their rows are written out.

Two phrases are alike if each fires one language column that no other phrase fires, and all else about them is the same:
their other columns, their rows with what is counted of each, and what is known of their own column's weights. To swap
the two columns changes nothing of the objective, which is strictly convex: so both have the same weights at the optimum
(`symmetry` has the general case). A model that has been told a thousand words knows few kinds of them.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace

import numpy as np

from dcg_torch.fitting.design import DesignMatrix, Hashes, row_hashes, scrambled
from dcg_torch.fitting.symmetry import bits_of, count_distinct
from dcg_torch.types.arrays import Bools, Floats, Ints

_ROWS = 1_000
"""Rows from which on it pays to look."""


@dataclass(frozen=True)
class Twins:
    """Language columns with the same weights at the optimum, in the grounding columns that fire beside them."""

    columns: Ints
    grounding: Ints


@dataclass(frozen=True)
class Lifted:
    """Rows of one phrase for all that are alike.

    Attributes:
        designs: the rows that are left; what is counted of them is counted for all.
        times: (L,) as how many each language column counts.
        twins: those that are alike, the one that stands for them first.
    """

    designs: Sequence[DesignMatrix]
    times: Floats | None
    twins: Sequence[Twins]

    def spread(self, weight: Floats) -> None:
        """Give to all the weights (P, L, G) of the one that stands for them, in place."""
        for alike in self.twins:
            first, *others = alike.columns.tolist()
            weight[:, np.array(others)[:, None], alike.grounding] = weight[:, first, alike.grounding][:, None]


def lift(designs: Sequence[DesignMatrix], fixed: Floats, active: Bools, strength: Floats) -> Lifted:
    """Leave out the rows of phrases that are like others.

    Args:
        designs, fixed, active, strength: see `reduction.reduce`.
    """
    sizes = [len(design.phrase) for design in designs]
    largest = int(np.argmax(sizes)) if sizes else 0
    if not sizes or sizes[largest] < _ROWS:
        return Lifted(designs, None, ())
    design, own = designs[largest], _own_columns(designs, largest, len(active))
    number, times = np.arange(len(own)), np.ones(len(own))
    twins = []
    for phrases in _alike(design, own):
        mine = design.grounding[design.phrase == phrases[0]]
        firing = np.unique(mine[mine >= 0])
        for same in _with_equal_cells(own[phrases], firing, fixed, active, strength):
            among = phrases[same]
            number[among], times[among[0]] = among[0], len(among)
            twins.append(Twins(own[among], firing))
    if not twins:
        return Lifted(designs, None, ())
    rows = np.flatnonzero(number[design.phrase] == design.phrase)
    few = replace(design, grounding=design.grounding[rows], count=design.count[:, rows] * times[design.phrase[rows]])
    phrases, phrase = np.unique(design.phrase[rows], return_inverse=True)
    few = replace(few, language=design.language[phrases], phrase=phrase)
    of_columns = np.ones(len(active))
    of_columns[own[times > 1.0]] = times[times > 1.0]
    return Lifted([*designs[:largest], few, *designs[largest + 1 :]], of_columns, twins)


def _own_columns(designs: Sequence[DesignMatrix], which: int, columns: int) -> Ints:
    """(phrases,) the one language column that each phrase of a design has for itself; -1: it has none, or several."""
    uses = np.zeros(columns + 1, dtype=np.int64)
    for design in designs:
        np.add.at(uses, design.language, 1)
    language = designs[which].language
    alone = (language >= 0) & (uses[language] == 1)
    found: Ints = np.where(np.count_nonzero(alone, axis=1) == 1, np.where(alone, language, -1).max(axis=1), -1)
    return found


def _alike(design: DesignMatrix, own: Ints) -> Iterator[Ints]:
    """Numbers of phrases with equal rows, and equal columns but for their own."""
    others = np.where(design.language == own[:, None], -1, design.language)
    keys = scrambled(row_hashes(others))
    if count_distinct(keys[own >= 0]) == np.count_nonzero(own >= 0):
        return
    rows = scrambled(row_hashes(design.grounding) ^ bits_of(design.count, len(design.phrase)))
    np.add.at(keys, design.phrase, rows)
    used = np.zeros(len(own), dtype=np.bool_)
    used[design.phrase] = True
    yield from _groups(np.flatnonzero((own >= 0) & used), keys)


def _with_equal_cells(columns: Ints, firing: Ints, fixed: Floats, active: Bools, strength: Floats) -> Iterator[Ints]:
    """Positions in `columns` of those that are free in the same cells, and have the same values where they are not."""
    cells = np.ix_(columns, firing)
    values = [active[cells].astype(np.float64), *fixed[:, columns[:, None], firing]]
    if any(strength.strides):
        values.append(strength[cells])
    bits = np.hstack(values).view(np.uint64)
    keys = scrambled(bits ^ scrambled(np.arange(bits.shape[1], dtype=np.uint64))).sum(axis=1)
    return _groups(np.arange(len(columns)), keys)


def _groups(members: Ints, keys: Hashes) -> Iterator[Ints]:
    """The members with equal keys, where there are several; each group in ascending order."""
    _, which, size = np.unique(keys[members], return_inverse=True, return_counts=True)
    order, end = members[np.argsort(which, kind="stable")], np.cumsum(size)
    for k in np.flatnonzero(size > 1).tolist():
        yield order[end[k] - size[k] : end[k]]
