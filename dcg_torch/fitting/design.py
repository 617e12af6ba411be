"""The design matrix of the log-linear factor: labelled factors with identical rows merged.

Rows are merged by number, not by sorting them. Every phrase and every grounding gets a number from a hash of what it
fires, and a factor is a cell of the table of phrases and groundings. A hash is the sum of 64 random bits of each
column, so two different rows among a million share one with a chance below one in ten million.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from dcg_torch.fitting.psi import Bag, Floats, distinct

Ints = NDArray[np.int64]
Hashes = NDArray[np.uint64]

_1, _27, _30, _31 = (np.uint64(number) for number in (1, 27, 30, 31))
_WEYL, _FIRST, _SECOND = (np.uint64(factor) for factor in (0x9E3779B97F4A7C15, 0xBF58476D1CE4E5B9, 0x94D049BB133111EB))
_CHUNK = 1 << 16
"""Rows that are hashed at once, so that a million of them need little memory beside their own."""


@dataclass(frozen=True)
class DesignMatrix:
    """Labelled factors, identical ones merged, as bags whose columns can be renamed: sufficient statistics of a fit.

    Attributes:
        language: (A, k) bag of the distinct phrases.
        grounding: (N, k') bag of the distinct factors.
        phrase: (N,) the phrase of each factor.
        count: (P, N) summed weights of the examples with each label.
    """

    language: Bag
    grounding: Bag
    phrase: Ints
    count: Floats

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
        return replace(self, language=_renamed(self.language, language), grounding=_renamed(self.grounding, grounding))


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
    cells = _Cells.of(language, grounding, phrase)
    size = len(cells.phrase)
    count = np.zeros(correspondences * size)
    np.add.at(count, label * size + cells.which, weight)
    return cells.design(count.reshape(correspondences, size))


def concatenate(parts: Sequence[DesignMatrix]) -> DesignMatrix:
    """One design matrix of several, which is the sum of their likelihoods; identical rows are merged again."""
    stacked = stack(parts)
    cells = _Cells.of(stacked.language, stacked.grounding, stacked.phrase)
    size = len(cells.phrase)
    return cells.design(np.stack([np.bincount(cells.which, c, minlength=size) for c in stacked.count]))


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
    out = np.full((sum(map(len, bags)), max((bag.shape[1] for bag in bags), default=0)), -1, dtype=np.int64)
    start = 0
    for bag in bags:
        out[start : start + len(bag), : bag.shape[1]] = bag
        start += len(bag)
    return out


def distinct_rows(bag: Bag) -> tuple[Bag, Ints]:
    """The distinct rows of a bag, each sorted, and which of them every row is."""
    firsts, parts, seen = [], [], 0
    found: list[Hashes] = []
    for start in range(0, max(1, len(bag)), _CHUNK):
        hashes = row_hashes(bag[start : start + _CHUNK])
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
    own, among = numbered(row_hashes(rows))
    return rows[own], among[which]


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


def run_starts(numbers: Ints) -> Ints:
    """Where in (n,) numbers, n > 0, each run of equal ones begins."""
    found = np.flatnonzero(numbers[1:] != numbers[:-1])
    found += 1
    return np.concatenate([np.zeros(1, dtype=np.int64), found])


@dataclass(frozen=True)
class _Cells:
    """The distinct factors of many: which phrase and grounding each has, and which of them every factor is."""

    language: Bag
    things: Bag
    phrase: Ints
    thing: Ints
    which: Ints

    @classmethod
    def of(cls, language: Bag, grounding: Bag, phrase: Ints) -> _Cells:
        phrases, phrase_of = distinct_rows(language)
        things, code = distinct_rows(grounding)
        code += phrase_of[phrase] * len(things)
        if len(phrases) * len(things) > 4 * len(code) + 1024:
            cells, which = np.unique(code, return_inverse=True)
        else:
            present = np.zeros(len(phrases) * len(things), dtype=np.bool_)
            present[code] = True
            cells = np.flatnonzero(present)
            which = (np.cumsum(present) - 1)[code]
        phrase, thing = np.divmod(cells, max(1, len(things)))
        return cls(phrases, things, phrase, thing, which)

    def design(self, count: Floats) -> DesignMatrix:
        return DesignMatrix(self.language, self.things[self.thing], self.phrase, count)


def _renamed(bag: Bag, table: Ints) -> Bag:
    """A bag under other columns, without columns of padding alone."""
    rows = distinct(table[bag].reshape(len(bag), -1))  # two unknown colours of a group are one feature
    used = (rows >= 0).any(axis=0)
    return rows[:, used]
