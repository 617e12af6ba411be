"""How much each fact between a noun and a class name tells: weights learned from `data/nouns.yaml`, shipped.

    P(class c | noun n) is proportional to exp(sum of the weights of the facts between n and c)

over the classes in view, and over one more choice of weight 0: none of them. The weights are a prior; whoever learns
from use starts from them.
"""

from __future__ import annotations

import functools
from collections.abc import Collection, Mapping, Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from dcg_torch.names.evidence import FORMS, KINDS, evidence
from dcg_torch.names.normal import read_data

FACTS = FORMS + KINDS
WEIGHTS = "weights.yaml"
_L2 = 0.1
_STEPS = 100


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
    column = {fact: k for k, fact in enumerate(FACTS)}
    nouns = sorted(meanings)
    design = np.zeros((len(nouns), len(classes) + 1, len(FACTS)))
    meant = np.zeros((len(nouns), len(classes) + 1), dtype=bool)
    for i, noun in enumerate(nouns):
        meant[i, -1] = not meanings[noun]
        for j, name in enumerate(classes):
            meant[i, j] = name in meanings[noun]
            design[i, j, [column[fact] for fact in evidence(noun, name)]] = 1.0
    weights = np.zeros(len(FACTS))
    for _ in range(_STEPS):
        loss, gradient, curvature = _derivatives(design, meant, weights)
        step = np.linalg.solve(curvature, gradient)
        while np.abs(step).max() > 1e-6 and _derivatives(design, meant, weights - step)[0] > loss:
            step /= 2.0
        weights -= step
        if np.abs(step).max() <= 1e-6:
            break
    return {fact: round(float(weights[column[fact]]), 2) for fact in FACTS}


def _derivatives(
    design: NDArray[Any], meant: NDArray[Any], weights: NDArray[Any]
) -> tuple[float, NDArray[Any], NDArray[Any]]:
    """The loss, its gradient, and the curvature of its convex part, which makes every step one downhill."""
    scores = design @ weights
    all_, right = _softmax(scores), _softmax(np.where(meant, scores, -np.inf))
    mean = np.einsum("ij,ijk->ik", all_, design)
    loss = -np.log((all_ * meant).sum(axis=1)).sum() + _L2 / 2 * weights @ weights
    gradient = (mean - np.einsum("ij,ijk->ik", right, design)).sum(axis=0) + _L2 * weights
    weighted = (design * all_[:, :, None]).reshape(-1, design.shape[2])
    curvature = weighted.T @ design.reshape(weighted.shape) - mean.T @ mean + _L2 * np.eye(len(weights))
    return float(loss), gradient, curvature


def _softmax(scores: NDArray[Any]) -> NDArray[Any]:
    weight = np.exp(scores - scores.max(axis=1, keepdims=True))
    result: NDArray[Any] = weight / weight.sum(axis=1, keepdims=True)
    return result
