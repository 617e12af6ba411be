"""How much each fact between a noun and a class name tells: weights learned from `data/nouns.yaml`, shipped.

    P(class c | noun n) is proportional to exp(sum of the weights of the facts between n and c)

over the classes in view, and over one more choice of weight 0: none of them. The weights are a prior; whoever learns
from use starts from them.
"""

from __future__ import annotations

import functools
from collections.abc import Collection, Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from dcg_torch.names.evidence import FORMS, KINDS, evidence
from dcg_torch.names.normal import read_data

Array = NDArray[np.float64]

FACTS = FORMS + KINDS
WEIGHTS = "weights.yaml"
_L2 = 0.1
_STEPS = 100
_TOLERANCE = 1e-6


@functools.cache
def fact_weights() -> Mapping[str, float]:
    """The shipped weight of each fact, as log-odds."""
    return {str(fact): float(weight) for fact, weight in read_data(WEIGHTS).items()}


@functools.lru_cache(maxsize=65536)
def log_odds(noun: str, class_name: str) -> float:
    """log P(the noun means this class) - log P(it means nothing that is there), were this class alone in view."""
    weights = fact_weights()
    return sum(weights.get(fact, 0.0) for fact in evidence(noun, class_name))


def fit_weights(classes: Sequence[str], meanings: Mapping[str, Collection[str]]) -> dict[str, float]:
    """The weights under which the nouns are likeliest to mean what they mean (L2-regularised maximum likelihood).

    Args:
        classes: all classes in view.
        meanings: the classes that each noun may mean, none of them included as an empty collection.
    """
    nouns = sorted(meanings)
    facts = [[evidence(noun, name) for name in classes] + [()] for noun in nouns]
    patterns = sorted({one for row in facts for one in row})
    design = np.array([[fact in pattern for fact in FACTS] for pattern in patterns], dtype=np.float64)
    number = {pattern: k for k, pattern in enumerate(patterns)}
    problem = _Problem(
        design,
        np.array([[number[one] for one in row] for row in facts]),
        np.array([[*(name in meanings[noun] for name in classes), not meanings[noun]] for noun in nouns]),
    )
    weights = np.zeros(len(FACTS))
    for _ in range(_STEPS):
        loss, gradient, curvature = problem.derivatives(weights)
        step = np.linalg.solve(curvature, gradient)
        while np.abs(step).max() > _TOLERANCE and problem.derivatives(weights - step)[0] > loss:
            step /= 2.0
        weights -= step
        if np.abs(step).max() <= _TOLERANCE:
            break
    return {fact: round(float(weight), 2) for fact, weight in zip(FACTS, weights, strict=True)}


@dataclass(frozen=True)
class _Problem:
    """n nouns, c choices for each, p different sets of facts, f facts.

    Attributes:
        design: (p, f), the facts of each set.
        pattern: (n, c), which set of facts holds between a noun and a choice.
        meant: (n, c), may the noun mean the choice?
    """

    design: Array
    pattern: NDArray[np.int64]
    meant: NDArray[np.bool_]

    def derivatives(self, weights: Array) -> tuple[float, Array, Array]:
        """The loss, its gradient (f,), and the curvature (f, f) of its convex part, which makes each step downhill."""
        scores = (self.design @ weights)[self.pattern]
        all_, right = _softmax(scores), _softmax(np.where(self.meant, scores, -np.inf))
        loss = -np.log((all_ * self.meant).sum(axis=1)).sum() + _L2 / 2 * weights @ weights
        share = self._by_pattern(all_)
        gradient = (share - self._by_pattern(right)).sum(axis=0) @ self.design + _L2 * weights
        mean = share @ self.design
        spread = self.design.T @ (share.sum(axis=0)[:, None] * self.design) - mean.T @ mean
        return float(loss), gradient, spread + _L2 * np.eye(len(weights))

    def _by_pattern(self, values: Array) -> Array:
        """Values (n, c) summed by pattern: (n, p)."""
        n, p = len(values), len(self.design)
        cells = np.arange(n)[:, None] * p + self.pattern
        sums: Array = np.bincount(cells.ravel(), weights=values.ravel(), minlength=n * p).astype(np.float64)
        return sums.reshape(n, p)


def _softmax(scores: Array) -> Array:
    weight = np.exp(scores - scores.max(axis=1, keepdims=True))
    result: Array = weight / weight.sum(axis=1, keepdims=True)
    return result
