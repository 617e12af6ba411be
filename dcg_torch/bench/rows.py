"""Rows of labelled factors for benchmarks of the fit: few phrases, or as a corpus has them."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from dcg_torch.fitting.psi import BINARY, TERNARY, Bag, LogLinearFactor
from dcg_torch.types import Correspondence
from dcg_torch.types.arrays import Bools, Ints


@dataclass(frozen=True)
class Rows:
    """Labelled factors, drawn from a model of their own.

    Attributes:
        language: (m, k) bag of the phrases.
        grounding: (n, k') bag of the factors.
        phrase: (n,) the phrase of each.
        label: (n,) the number of its correspondence.
        pairs: (L, G) the features.
        correspondences: what the labels stand for.
    """

    language: Bag
    grounding: Bag
    phrase: Ints
    label: Ints
    pairs: Bools
    correspondences: tuple[Correspondence, ...]

    def factor(self) -> LogLinearFactor:
        """A factor of zero weights for these rows."""
        return LogLinearFactor(self.pairs, self.correspondences)


def dense_rows(count: int, rng: np.random.Generator) -> Rows:
    """Few phrases with few groundings, nearly all of which occur together; about a sixth of the rows are distinct."""
    languages, groundings, ones = 40, 30, 3
    side = math.ceil(math.sqrt(count / 6))
    phrases = np.stack([rng.choice(languages, ones, replace=False) for _ in range(side)])
    objects = np.stack([rng.choice(groundings, ones, replace=False) for _ in range(side)])
    pairs = np.ones((languages, groundings), dtype=np.bool_)
    return _labelled(
        phrases, objects[rng.integers(side, size=count)], rng.integers(side, size=count), pairs, TERNARY, rng
    )


def sparse_rows(count: int, rng: np.random.Generator) -> Rows:
    """Rows as a corpus gives them: each phrase among the twenty things of its own scene; a few words are frequent.

    A phrase fires 5 of 150 language columns and a thing 8 of 120 grounding columns, by Zipf's law; a third of the
    pairs are features.
    """
    languages, groundings, scene = 150, 120, 20
    phrases = max(1, count // scene)
    kinds = _zipf_bags(max(10, phrases // 4), languages, 5, rng)  # what people say is often the same
    grounding = _zipf_bags(phrases * scene, groundings, 8, rng)
    pairs = rng.random((languages, groundings)) < 1 / 3
    phrase = np.repeat(rng.integers(len(kinds), size=phrases), scene)
    return _labelled(kinds, grounding, phrase, pairs, BINARY, rng)


def _zipf_bags(count: int, columns: int, ones: int, rng: np.random.Generator) -> Bag:
    chance = 1.0 / np.arange(1, columns + 1)
    keys = rng.exponential(size=(count, columns)) / chance  # the least of exponential times: drawn without repeats
    return np.argpartition(keys, ones, axis=1)[:, :ones].astype(np.int64)


def _labelled(
    language: Bag,
    grounding: Bag,
    phrase: Ints,
    pairs: Bools,
    correspondences: tuple[Correspondence, ...],
    rng: np.random.Generator,
) -> Rows:
    factor = LogLinearFactor(pairs, correspondences)
    factor.set_weight(rng.normal(size=tuple(factor.weight.shape)) * pairs)
    chances = factor.log_psi(language, grounding, phrase).exp().numpy()
    label = (rng.random((len(phrase), 1)) > chances.cumsum(axis=1)).sum(axis=1).clip(0, len(correspondences) - 1)
    return Rows(language, grounding, phrase, label, pairs, correspondences)
