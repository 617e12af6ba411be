"""Labelled factors as plain lists, with the objective as its formula stands: what the fit is tested against."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
import pytest
from hypothesis import strategies as st

from dcg_torch.fitting.design import DesignMatrix, merge
from dcg_torch.fitting.psi import BINARY, TERNARY, LogLinearFactor
from dcg_torch.types import Correspondence
from dcg_torch.types.arrays import Bools, Floats, Ints

both_settings = pytest.mark.parametrize("correspondences", [BINARY, TERNARY], ids=["binary", "ternary"])


@dataclass(frozen=True)
class Problem:
    """Labelled factors as lists of what fires: the phrases, and (phrase, grounding, label, weight) of each factor."""

    correspondences: tuple[Correspondence, ...]
    pairs: Bools
    phrases: list[list[int]]
    rows: list[tuple[int, list[int], int, float]]

    @property
    def shape(self) -> tuple[int, int, int]:
        languages, groundings = self.pairs.shape
        return len(self.correspondences), languages, groundings

    def model(self, rng: np.random.Generator | None = None) -> LogLinearFactor:
        """A model of zero weights, or of random ones where there are features."""
        model = LogLinearFactor(self.pairs, self.correspondences)
        if rng is not None:
            model.set_weight(rng.normal(size=self.shape) * self.pairs)
        return model

    def design(self) -> DesignMatrix:
        return merge(
            bag(self.phrases),
            bag([grounding for _, grounding, _, _ in self.rows]),
            np.array([phrase for phrase, _, _, _ in self.rows]),
            np.array([label for _, _, label, _ in self.rows]),
            np.array([weight for _, _, _, weight in self.rows]),
            len(self.correspondences),
        )

    def products(self) -> Floats:
        """(n, L * G): each factor's features written out, without those that `pairs` leaves out."""
        out = np.zeros((len(self.rows), *self.pairs.shape))
        for row, (phrase, grounding, _, _) in zip(out, self.rows, strict=True):
            for left in self.phrases[phrase]:
                for right in grounding:
                    row[left, right] = self.pairs[left, right]
        return out.reshape(len(self.rows), -1)

    def loss(self, weight: Floats, l2: float) -> float:
        """The objective as its formula stands, a factor at a time."""
        terms = []
        for phrase, grounding, label, count in self.rows:
            ones = [(left, right) for left in set(self.phrases[phrase]) for right in set(grounding)]
            scores = [math.fsum(float(w[left, right]) for left, right in ones) for w in weight]
            terms.append(count * (math.log(math.fsum(map(math.exp, scores))) - scores[label]))
        return math.fsum(terms) + 0.5 * l2 * math.fsum(float(w) ** 2 for w in weight.flat)


def bag(rows: list[list[int]]) -> Ints:
    width = max(map(len, rows), default=0)
    return np.array([[*row, *[-1] * (width - len(row))] for row in rows], dtype=np.int64).reshape(len(rows), width)


@st.composite
def problems(draw: st.DrawFn, *, rows: int = 12) -> Problem:
    languages, groundings = draw(st.integers(1, 4)), draw(st.integers(1, 5))
    correspondences = draw(st.sampled_from([BINARY, TERNARY]))
    pairs = np.array(draw(st.lists(st.booleans(), min_size=languages * groundings, max_size=languages * groundings)))
    phrases = draw(st.lists(st.lists(st.integers(0, languages - 1), max_size=4), min_size=1, max_size=4))
    factor = st.tuples(
        st.integers(0, len(phrases) - 1),
        st.lists(st.integers(0, groundings - 1), max_size=4),
        st.integers(0, len(correspondences) - 1),
        st.sampled_from([0.5, 1.0, 3.0]),
    )
    return Problem(
        correspondences,
        pairs.reshape(languages, groundings),
        phrases,
        draw(st.lists(factor, min_size=1, max_size=rows)),
    )


seeds = st.integers(0, 2**32)


def solid_problem(correspondences: tuple[Correspondence, ...], seed: int = 0, rows: int = 60) -> Problem:
    """Enough random factors that every label occurs and the optimum is far from zero."""
    rng = np.random.default_rng(seed)
    pairs = rng.random((4, 5)) < 0.8
    phrases = [sorted(rng.choice(4, size=2, replace=False).tolist()) for _ in range(5)]
    factors = [
        (int(rng.integers(5)), sorted(rng.choice(5, size=2, replace=False).tolist()), k % len(correspondences), 1.0)
        for k in range(rows)
    ]
    return Problem(correspondences, pairs, phrases, factors)
