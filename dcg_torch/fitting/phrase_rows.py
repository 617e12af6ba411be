"""Many rows of a fit, a few phrases at a time: a million of them take little more room than what they fire.

Scores of a phrase with every grounding column are a small table, and a row's score is the sum of some cells of it. The
table of one run of phrases stays in the processor's cache while its rows read it and add to it.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING, NamedTuple, Self

import numpy as np

from dcg_torch.fitting.design import DesignMatrix, Run, runs
from dcg_torch.fitting.psi import Bag
from dcg_torch.fitting.rows import Bend, gathered, ones_at, spread
from dcg_torch.types.arrays import Floats, Ints

if TYPE_CHECKING:
    from scipy.sparse import csr_array

_ROWS = 1 << 15
"""Rows at once."""


class _Part(NamedTuple):
    """Phrases and rows that are done at once: (phrases, L) what the former fire, and its transpose."""

    run: Run
    phrases: csr_array
    back: csr_array


@dataclass(frozen=True)
class PhraseRows:
    """Rows in the order of their phrases.

    Attributes:
        language: (A, k) bag of the phrases.
        grounding: (N, k') bag of the rows.
        ends: (A,) how many rows the phrases up to each one have.
        active: (K,) which cells of (L, G) the variables are.
        shape: L, G.
    """

    language: Bag
    grounding: Bag
    ends: Ints
    active: Ints
    shape: tuple[int, int]

    @classmethod
    def of(cls, design: DesignMatrix, active: Ints, shape: tuple[int, int]) -> Self:
        """The rows of a design, which are in the order of their phrases."""
        ends = np.bincount(design.phrase, minlength=len(design.language)).cumsum()
        return cls(design.language, design.grounding, ends, active, shape)

    def scores(self, d: Floats) -> Floats:
        """(Q, N) the scores of all rows, from the variables (Q, K)."""
        return np.concatenate([scores for _, scores in self.in_parts(d)], axis=1)

    def gradient(self, residual: Floats) -> Floats:
        """(Q, K) from (Q, N): the transpose of `scores`."""
        return self.through(np.zeros((len(residual), len(self.active))), lambda rows, _: residual[:, rows])

    def through(self, d: Floats, bend: Bend) -> Floats:
        """(Q, K) the transpose of `scores` applied to what `bend` makes of the scores of (Q, K), part by part."""
        total = np.zeros((len(d), self.shape[0], self.shape[1] + 1))
        for part, cells, scores in self._scored(d):
            for own, one in zip(bend(part.run.rows, scores), total, strict=True):
                one += part.back @ (cells.T @ own).reshape(len(part.phrases.indptr) - 1, -1)
        return gathered(total[:, :, 1:], self.active)

    def in_parts(self, d: Floats) -> Iterator[tuple[slice, Floats]]:
        """Rows, and their scores (Q, n) from (Q, K)."""
        return ((part.run.rows, scores) for part, _, scores in self._scored(d))

    def _scored(self, d: Floats) -> Iterator[tuple[_Part, csr_array, Floats]]:
        """Each part, which cells of its tables its rows have, and their scores (Q, n)."""
        weight = np.zeros((len(d), self.shape[0], self.shape[1] + 1))
        weight[:, :, 1:] = spread(d, self.active, self.shape)
        for part in self._parts:
            cells = self._cells(part.run)
            yield part, cells, np.array([cells @ (part.phrases @ own).reshape(-1) for own in weight])

    @cached_property
    def _parts(self) -> list[_Part]:
        found = []
        for run in runs(self.ends, _ROWS):
            language = self.language[run.phrases]
            fires = language >= 0
            starts = np.append(0, np.count_nonzero(fires, axis=1).cumsum())
            phrases = ones_at(starts, language[fires], (len(language), self.shape[0]))
            found.append(_Part(run, phrases, phrases.T.tocsr()))
        return found

    def _cells(self, run: Run) -> csr_array:
        """(rows, phrases * (G + 1)) which cells of the phrases' tables each row has; the first of each is padding's."""
        grounding, size = self.grounding[run.rows], self.shape[1] + 1
        ends, width = self.ends[run.phrases] - run.rows.start, grounding.shape[1]
        firsts = np.arange(1, len(ends) * size + 1, size, dtype=np.int32)
        cells = grounding.reshape(-1) + firsts.repeat(width * np.diff(ends, prepend=0))
        starts = np.arange(0, len(cells) + 1, width)
        return ones_at(starts, cells, (len(grounding), len(ends) * size), self._ones)

    @cached_property
    def _ones(self) -> Floats:
        """As many as a part may need."""
        longest = max(part.run.rows.stop - part.run.rows.start for part in self._parts)
        return np.ones(longest * self.grounding.shape[1])
