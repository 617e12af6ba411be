"""Ranks among things that are alike: which are compared with one another, and how many of these come before each."""

from __future__ import annotations

import itertools
from collections import defaultdict
from collections.abc import Hashable, Iterable, Iterator, Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from dcg_torch.types.arrays import Bools, Floats, Ints

TIE = 1e-6
"""Values that differ by less are equal."""
_FEW = 64
"""Things up to which each is held against each."""
_SORTED_WHOLE = 320
"""Values up to which it takes less time to sort all than to find the highest."""
_SORTED = 8
"""Places that are counted to one by one; beyond, they are searched."""


@dataclass(frozen=True)
class Alike:
    """Which of n things each is compared with: the members of its class, be it one of them or not.

    Attributes:
        code: (n,) the class of each, -1 for none.
        given: the members of each class, where others than those of its code.
    """

    code: Ints
    given: Sequence[Ints] | None = None

    @classmethod
    def of(cls, keys: Sequence[Hashable | None]) -> Alike:
        """The class of a thing is that of its key; None: it has none."""
        number: dict[Hashable | None, int] = {None: -1}
        return cls(np.array([number.setdefault(key, len(number) - 1) for key in keys], dtype=np.int64))

    @classmethod
    def by(cls, code: Ints) -> Alike:
        """The class of a thing is that of its code; -1: it has none."""
        if len(code) <= _FEW:
            return cls.of([None if value < 0 else value for value in code.tolist()])
        known, which = np.unique(code, return_inverse=True)
        none = int(len(known) > 0 and known[0] < 0)
        order = np.argsort(which, kind="stable")
        bounds = np.searchsorted(which[order], np.arange(none, len(known) + 1)).tolist()
        return cls(which - none, [order[a:b] for a, b in itertools.pairwise(bounds)])

    @cached_property
    def members(self) -> Sequence[Ints]:
        """The numbers of the members of each class."""
        if self.given is not None:
            return self.given
        return [(self.code == k).nonzero()[0] for k in range(int(self.code.max(initial=-1)) + 1)]

    @cached_property
    def table(self) -> Bools:
        """(n, n) is j one of those that i is compared with? For few things."""
        if self.given is None:
            same: Bools = self.code[:, None] == self.code
            same &= (self.code >= 0)[:, None]
            return same
        inside = np.zeros((len(self.members) + 1, len(self.code)), dtype=np.bool_)
        for own, members in zip(inside, self.members, strict=False):  # the last is of what has no class
            own[members] = True
        found: Bools = inside[self.code]
        return found

    @cached_property
    def asking(self) -> Sequence[Ints]:
        """The things of each class; not its members where classes share some."""
        order = np.argsort(self.code, kind="stable")
        bounds = np.searchsorted(self.code[order], np.arange(len(self.members) + 1))
        return [order[a:b] for a, b in itertools.pairwise(bounds.tolist())]


def numbered(values: Iterable[Hashable]) -> Ints:
    """(n,) numbers from 0 in the order in which values come first: equal ones for equal values."""
    number: defaultdict[Hashable, int] = defaultdict(itertools.count().__next__)
    return np.fromiter(map(number.__getitem__, values), dtype=np.int64)


def signatures(*columns: Sequence[Hashable] | Ints) -> tuple[list[int], Ints]:
    """Which of n things are alike in every column: the first of each kind, and (n,) the kind of each."""
    rows = [column.tolist() if isinstance(column, np.ndarray) else column for column in columns]
    kind = numbered(zip(*rows, strict=True))
    if len(kind) <= _FEW:
        few = kind.tolist()
        return [few.index(k) for k in range(max(few, default=-1) + 1)], kind
    highest_yet = np.maximum.accumulate(kind)
    return np.flatnonzero(np.diff(highest_yet, prepend=-1)).tolist(), kind


def before(values: Floats, alike: Alike, most: int) -> Ints:
    """How many of those alike have a value lower than a thing's by more than `TIE`, counted up to `most`.

    Args:
        values: (r, n); what is NaN comes before nothing, and nothing before it.

    Returns:
        (r, n); 0 for what is in no class. A count of `most` or more means as many or more.
    """
    if values.shape[1] <= _FEW:
        less = values[:, None, :] < (values - TIE)[:, :, None]
        less &= alike.table
        few: Ints = np.einsum("rij->ri", less.view(np.int8)).astype(np.int64)  # far faster than a sum of truth values
        return few
    with np.errstate(invalid="ignore"):
        bound = values - TIE
        if most > _SORTED:
            return _searched(values, bound, alike)
        return _counted_to(list(_lowest(values, alike, most)), bound, alike.code)


def _counted_to(lowest: Sequence[Floats], bound: Floats, code: Ints) -> Ints:
    """(r, n) how many of the lowest values of its class are below a thing's bound; most things are beyond the last."""
    out = np.zeros(bound.shape, dtype=np.int64)
    if lowest:
        beyond = lowest[-1].take(code, axis=1) < bound
        out[beyond] = len(lowest)
        row, few = np.nonzero(~beyond)
        for value in lowest[:-1]:
            out[row, few] += value[row, code[few]] < bound[row, few]
    return out


def counted(before: Ints, count: int | None) -> Ints:
    """Places where the first so many are meant together: both of "the two on the left" get the first place."""
    return before if count is None or count < 2 else np.maximum(before - (count - 1), 0)


def _lowest(values: Floats, alike: Alike, most: int) -> Iterator[Floats]:
    """(r, classes + 1) the lowest value of each class, then the next ...; the last column is of what has no class."""
    sizes = [len(members) for members in alike.members]
    there = np.flatnonzero(sizes)
    found = np.full((len(values), len(sizes) + 1), np.inf)
    if not len(there):
        return
    inside = np.concatenate([alike.members[k] for k in there.tolist()])
    counts = np.array(sizes)[there]
    starts = np.cumsum(counts) - counts
    left = values[:, inside]
    left[np.isnan(left)] = np.inf
    rows, numbers = np.arange(len(values))[:, None], np.arange(len(inside))
    for _ in range(most):
        lowest = np.minimum.reduceat(left, starts, axis=1)
        found[:, there] = lowest
        yield found.copy()
        here = np.where(left == np.repeat(lowest, counts, axis=1), numbers, len(inside))
        left[rows, np.minimum.reduceat(here, starts, axis=1)] = np.inf


def _searched(values: Floats, bound: Floats, alike: Alike) -> Ints:
    """As `before`, however many come before."""
    out = np.zeros(values.shape, dtype=np.int64)
    for members, asking in zip(alike.members, alike.asking, strict=True):
        if len(members) and len(asking):
            ordered = np.sort(values[:, members], axis=1)  # NaN goes last
            out[:, asking] = [np.searchsorted(v, b) for v, b in zip(ordered, bound[:, asking], strict=True)]
    out[np.isnan(bound)] = 0
    return out


def highest(values: Floats, count: int) -> Ints:
    """The numbers of the highest of (n,) values, the highest first; of equal ones the first."""
    if count == 1:
        return np.array([values.argmax()])
    order: Ints
    if len(values) <= max(_SORTED_WHOLE, 2 * count):
        order = (-values).argsort(kind="stable")
        return order[:count]
    least = np.partition(values, len(values) - count)[len(values) - count]
    among = np.flatnonzero(values >= least)
    order = (-values[among]).argsort(kind="stable")
    return among[order[:count]]
