"""Which of several readings commands mean: log-linear weights of a parser's choices, learned from known objects.

p(objects | command) = sum over readings r of p(r | command) p(objects | r), with p(r | command) proportional to
exp(log-weight of the grammar + what is learned of the choices that led to r + how well r names something there).
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np

from dcg_torch.fitting.solvers import Point, lbfgs
from dcg_torch.grounding.readings import Reading, log_weight, sense
from dcg_torch.grounding.solution import Solution
from dcg_torch.learning.landmarks import Lesson
from dcg_torch.types.arrays import Floats

GroundAll = Callable[[Lesson], Sequence[Solution]]
"""Grounds every reading of a lesson."""

_L2 = 2.0
_MOST = 500
"""Lessons of which all readings are grounded: of more, as many as their weights say."""
_CHANCE = 0.02
"""Of an object that no reading means: labels and groundings are wrong now and then."""


@dataclass(frozen=True)
class _Told:
    """What one lesson tells: of each of its R readings the score without learned weights, which of the K choices led
    to it (R, K), and the log-probability of what was meant."""

    score: Floats
    choices: Floats
    meant: Floats


def in_meant_readings(
    lessons: Sequence[Lesson], ground: GroundAll, learned: Mapping[str, float]
) -> tuple[list[Lesson], dict[str, float]]:
    """Lessons, each with the tree of its likeliest reading, and the weights of choices with what they tell of them.

    Args:
        learned: the weights before, towards which they are drawn.
    """
    asked = dict(_sampled(lessons))
    rules = sorted({rule for lesson in asked.values() for r in lesson.readings for rule in r.rules})
    told = {k: _told(lesson, ground(lesson), rules) for k, lesson in asked.items()}
    weights = _fitted(list(told.values()), len(rules))
    new = {rule: float(w) for rule, w in zip(rules, weights, strict=True) if abs(w) > 1e-3}
    found = []
    for k, lesson in enumerate(lessons):
        if k in told:
            best = int((told[k].score + told[k].choices @ weights + told[k].meant).argmax())
        else:
            best = _likeliest(lesson.readings, new)
        found.append(replace(lesson, tree=lesson.readings[best].tree) if lesson.readings else lesson)
    return found, {rule: learned.get(rule, 0.0) + new.get(rule, 0.0) for rule in sorted({*learned, *new})}


def _sampled(lessons: Sequence[Lesson]) -> Iterator[tuple[int, Lesson]]:
    """At most about `_MOST` lessons that can be read in several ways, spread evenly, and their numbers."""
    several = [(k, lesson) for k, lesson in enumerate(lessons) if len(lesson.readings) > 1]
    rate = min(1.0, _MOST / max(1e-9, sum(lesson.weight for _, lesson in several)))
    owed = 0.5
    for k, lesson in several:
        owed += rate * lesson.weight
        if owed >= 1.0:
            owed -= 1.0
            yield k, lesson


def _told(lesson: Lesson, solutions: Sequence[Solution], rules: Sequence[str]) -> _Told:
    chance = [min(1.0, sum(s.probabilities.get(i, 0.0) for i in lesson.targets)) for s in solutions]
    return _Told(
        np.array([r.log_weight + sense(s) for r, s in zip(lesson.readings, solutions, strict=True)]),
        np.array([[float(r.rules.count(rule)) for rule in rules] for r in lesson.readings]),
        np.array([math.log(_CHANCE + (1.0 - _CHANCE) * p) for p in chance]),
    )


def _fitted(told: Sequence[_Told], number: int) -> Floats:
    """(K,) weights of the choices at the maximum of the penalised likelihood of what was meant."""

    def objective(weights: Floats) -> Point:
        value, gradient = 0.5 * _L2 * float(weights @ weights), _L2 * weights
        for one in told:
            prior = one.score + one.choices @ weights
            both = prior + one.meant
            before, after = np.logaddexp.reduce(prior), np.logaddexp.reduce(both)
            value -= after - before
            gradient = gradient - (np.exp(both - after) - np.exp(prior - before)) @ one.choices
        return Point(weights, float(value), gradient, float(np.abs(gradient).max(initial=0.0)), np.empty(0))

    return lbfgs(objective, np.zeros(number), tolerance=1e-6, max_steps=50).point.at if told else np.zeros(number)


def _likeliest(readings: Sequence[Reading], learned: Mapping[str, float]) -> int:
    weights = [log_weight(r, learned) for r in readings]
    return max(range(len(weights)), key=weights.__getitem__, default=0)
