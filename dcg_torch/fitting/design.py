"""The design matrix of the log-linear factor: labelled factors with identical rows merged.

Rows are merged by number, not by sorting them: a hash of what they fire gives each phrase and each grounding a number.
Where nearly all groundings differ, those of a few phrases are compared at a time: a million rows need little memory
beside their own. A hash is the sum of 64 random bits of each column, so two different rows among a million share
one with a chance below one in ten million.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from dcg_torch.fitting.psi import Bag, Numbers, distinct
from dcg_torch.types.arrays import Floats, Ints

Hashes = NDArray[np.uint64]

_1, _27, _30, _31 = (np.uint64(number) for number in (1, 27, 30, 31))
_WEYL, _FIRST, _SECOND = (np.uint64(factor) for factor in (0x9E3779B97F4A7C15, 0xBF58476D1CE4E5B9, 0x94D049BB133111EB))
_CHUNK = 1 << 16
"""Rows that are hashed at once, so that a million of them need little memory beside their own."""
_TABLE = 4
"""How many times the factors a table of phrases and groundings may have cells."""


@dataclass(frozen=True)
class DesignMatrix:
    """Labelled factors, identical ones merged, as bags whose columns can be renamed: sufficient statistics of a fit.

    Attributes:
        language: (A, k) bag of the distinct phrases.
        grounding: (N, k') bag of the distinct factors; in short integers where they were merged.
        phrase: (N,) the phrase of each factor.
        count: (P, N) summed weights of the examples with each label.
        merged: no two rows are alike, and they are in the order of their phrases.
    """

    language: Bag
    grounding: Bag
    phrase: Ints
    count: Floats
    merged: bool = False

    @cached_property
    def things(self) -> tuple[Bag, Ints]:
        """(M, k') bag of the distinct groundings, and (N,) which of them each factor is about."""
        return distinct_rows(self.grounding)

    def renamed(self, language: Ints, grounding: Ints) -> DesignMatrix:
        """Under other columns; rows that become identical stay apart until they are merged with others.

        Args:
            language: (old columns + 1, c) the new columns that stand for each old one, -1 for none; the last row is
                that of the padding, all -1.
            grounding: the same for the grounding columns.
        """
        bags = _renamed(self.language, language), _renamed(self.grounding, grounding)
        return replace(self, language=bags[0], grounding=bags[1], merged=False)


def merge(
    language: Bag,
    grounding: Bag,
    phrase: Ints,
    label: Ints,
    weight: Floats,
    correspondences: int,
) -> DesignMatrix:
    """Merge labelled factors.

    Args:
        language: (m, k) bag of the phrases.
        grounding: (n, k') bag of the factors.
        phrase: (n,) the phrase of each factor.
        label: (n,) index into the P correspondences.
        weight: (n,) of each factor in the likelihood.
        correspondences: P.
    """

    def counted(rows: Numbers | slice, which: Ints, size: int) -> Floats:
        cells = label[rows] * size + which
        count: Floats = np.bincount(cells, weight[rows], minlength=correspondences * size).astype(np.float64)
        return count.reshape(correspondences, size)

    return _merged(language, grounding, phrase, counted)


def concatenate(parts: Sequence[DesignMatrix]) -> DesignMatrix:
    """One design matrix of several, which is the sum of their likelihoods; identical rows are merged again."""
    stacked = stack(parts)
    if stacked.merged:
        return stacked

    def counted(rows: Numbers | slice, which: Ints, size: int) -> Floats:
        return np.stack([np.bincount(which, c[rows], minlength=size) for c in stacked.count])

    return _merged(stacked.language, stacked.grounding, stacked.phrase, counted)


def stack(parts: Sequence[DesignMatrix]) -> DesignMatrix:
    """Several design matrices one after another, nothing merged."""
    if len(parts) == 1:
        return parts[0]
    starts = np.cumsum([0, *(len(part.language) for part in parts[:-1])])
    return DesignMatrix(
        stack_bags([part.language for part in parts]),
        stack_bags([part.grounding for part in parts]),
        np.concatenate([part.phrase + start for part, start in zip(parts, starts, strict=True)]),
        np.concatenate([part.count for part in parts], axis=1),
    )


def stack_bags(bags: Sequence[Bag]) -> Bag:
    """Bags of different widths one after another."""
    shape = sum(map(len, bags)), max((bag.shape[1] for bag in bags), default=0)
    out: Bag = np.full(shape, -1, dtype=np.result_type(np.int8, *bags))
    start = 0
    for bag in bags:
        out[start : start + len(bag), : bag.shape[1]] = bag
        start += len(bag)
    return out


def distinct_rows(bag: Bag, apart: Numbers | None = None) -> tuple[Bag, Ints]:
    """The distinct rows of a bag, each sorted, and which of them every row is.

    Args:
        apart: (n,) rows that differ here are never alike; None: there are none such.
    """
    firsts, parts, seen = [], [], 0
    found: list[Hashes] = []
    for start in range(0, max(1, len(bag)), _CHUNK):
        hashes = row_hashes(bag[start : start + _CHUNK])
        if apart is not None:
            hashes += _bits_apart(apart[start : start + _CHUNK])
        first, which = numbered(hashes)
        found.append(hashes[first])
        firsts.append(first + start)
        parts.append(which + seen)
        seen += len(first)
    first, which = np.concatenate(firsts), np.concatenate(parts)
    if len(found) > 1:
        own, among = numbered(np.concatenate(found))
        first, which = first[own], among[which]
    rows = distinct(bag[first])
    if np.count_nonzero(rows < 0) == np.count_nonzero(bag[first] < 0):
        return rows, which
    # Rows that name a column twice hashed as others do until now.
    hashes = row_hashes(rows)
    if apart is not None:
        hashes += _bits_apart(apart[first])
    own, among = numbered(hashes)
    return rows[own], among[which]


def _bits_apart(numbers: Numbers) -> Hashes:
    """64 bits for each number, others than those of the columns."""
    return scrambled(~numbers.astype(np.uint64))


def row_hashes(bag: Bag) -> Hashes:
    """(n,) a hash of each row's columns, whatever their order and however much padding."""
    bits = scrambled(np.arange(int(bag.max(initial=-1)) + 2, dtype=np.uint64))
    bits[-1] = 0  # the padding
    total = np.zeros(len(bag), dtype=np.uint64)
    for columns in bag.T:
        total += bits[columns]
    return total


def scrambled(numbers: Hashes) -> Hashes:
    """64 bits for each number that look random and are the same in every process (the finaliser of SplitMix64)."""
    bits = numbers + _1
    bits *= _WEYL
    bits ^= bits >> _30
    bits *= _FIRST
    bits ^= bits >> _27
    bits *= _SECOND
    bits ^= bits >> _31
    return bits


def numbered(keys: Hashes) -> tuple[Ints, Ints]:
    """Where each distinct key stands first, in ascending order of the keys, and the number of every key."""
    if not len(keys):
        return np.zeros(0, dtype=np.int64), np.zeros(0, dtype=np.int64)
    order = keys.argsort()
    ordered = keys[order]
    new = np.ones(len(keys), dtype=np.bool_)
    np.not_equal(ordered[1:], ordered[:-1], out=new[1:])
    which = np.empty_like(order)
    which[order] = new.cumsum() - 1
    return np.minimum.reduceat(order, new.nonzero()[0]), which


def shortest(most: int) -> type[np.signedinteger[Any]]:
    """The shortest type of whole numbers from -1 to `most`."""
    return next(t for t in (np.int8, np.int16, np.int32, np.int64) if most <= np.iinfo(t).max)


class Run(NamedTuple):
    """Phrases that follow one another, and their rows."""

    phrases: slice
    rows: slice


def runs(ends: Ints, most: int) -> Iterator[Run]:
    """Phrases in runs of at most so many rows, but for a phrase that has more.

    Args:
        ends: (phrases,) how many rows the phrases up to each one have; rows are in their order.
    """
    phrase = row = 0
    while phrase < len(ends):
        after = max(phrase + 1, int(ends.searchsorted(row + most, "right")))
        yield Run(slice(phrase, after), slice(row, int(ends[after - 1])))
        phrase, row = after, int(ends[after - 1])


def run_starts(numbers: Ints) -> Ints:
    """Where in (n,) numbers, n > 0, each run of equal ones begins."""
    found = np.flatnonzero(numbers[1:] != numbers[:-1])
    found += 1
    return np.concatenate([np.zeros(1, dtype=np.int64), found])


def may_have_few(bag: Bag, most: float) -> bool:
    """May there be so few distinct rows? The first of many may show that there are not."""
    return len(bag) <= _CHUNK or len(distinct_rows(bag[:_CHUNK])[0]) <= most


_Counted = Callable[[Numbers | slice, Ints, int], Floats]
"""(P, size) sums of what is counted of the factors of some numbers, by which of `size` distinct ones each one is."""


def _merged(language: Bag, grounding: Bag, phrase: Numbers, counted: _Counted) -> DesignMatrix:
    """Labelled factors in the order of their phrases, identical ones merged.

    Where groundings or factors are few, by the number of each grounding; else those of some phrases at a time.
    """
    phrases, number = distinct_rows(language)
    own = number.astype(shortest(len(phrases)))[phrase]
    most = (_TABLE * len(own) + 1024) / max(1, len(phrases))
    if may_have_few(grounding, most):
        things, thing = distinct_rows(grounding)
        if len(things) <= most or len(own) <= _CHUNK:
            return _by_number(phrases, own, things, thing, counted)
    return _by_phrase(phrases, own, grounding, counted)


def _by_number(phrases: Bag, own: Numbers, things: Bag, thing: Ints, counted: _Counted) -> DesignMatrix:
    """The factors from which phrase and grounding each has."""
    thing += own.astype(np.int64) * len(things)
    if len(phrases) * len(things) > _TABLE * len(own) + 1024:
        first, which = numbered(thing.view(np.uint64))
        cells = thing[first]
    else:
        present = np.zeros(len(phrases) * len(things), dtype=np.bool_)
        present[thing] = True
        cells, which = np.flatnonzero(present), (present.cumsum() - 1)[thing]
    phrase, kind = np.divmod(cells, max(1, len(things)))
    return DesignMatrix(phrases, things[kind], phrase, counted(slice(None), which, len(cells)), True)


def _by_phrase(phrases: Bag, own: Numbers, grounding: Bag, counted: _Counted) -> DesignMatrix:
    """The factors, phrase after phrase."""
    order = own.argsort(kind="stable").astype(shortest(len(own)), copy=False)
    ends = np.bincount(own, minlength=len(phrases)).cumsum()
    bag_type = shortest(int(grounding.max(initial=0)))
    bags, owners, counts = list[Bag](), list[Numbers](), list[Floats]()
    for phrase_run in runs(ends, _CHUNK):
        rows = order[phrase_run.rows]
        bag, which = distinct_rows(grounding[rows], own[rows])
        owner = np.empty_like(own, shape=len(bag))
        owner[which] = own[rows]
        by_phrase = owner.argsort(kind="stable")
        rank = np.empty_like(by_phrase)
        rank[by_phrase] = np.arange(len(bag))
        bags.append(bag[by_phrase].astype(bag_type))
        owners.append(owner[by_phrase])
        counts.append(counted(rows, rank[which], len(bag)))
    del own, order
    count = np.concatenate(counts, axis=1)
    counts.clear()  # it is the largest
    return DesignMatrix(phrases, np.concatenate(bags), np.concatenate(owners).astype(np.int64), count, True)


def _renamed(bag: Bag, table: Ints) -> Bag:
    """A bag under other columns, without columns of padding alone."""
    short = table.astype(shortest(int(table.max(initial=0))))
    rows = distinct(short[bag].reshape(len(bag), -1))  # two unknown colours of a group are one feature
    used = (rows >= 0).any(axis=0)
    return rows[:, used]
