"""Why a command was grounded as it was: the features that moved each phrase towards its grounding, and by how much.

And why not otherwise: the features by which the answer and the second best object differ.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace
from typing import Protocol

from dcg_torch.fitting.psi import LogLinearFactor
from dcg_torch.grounding.encoding import WorldEncoder
from dcg_torch.grounding.features import FeatureSet
from dcg_torch.grounding.hypotheses import Hypothesis
from dcg_torch.grounding.solution import Solution
from dcg_torch.types import Correspondence, Example, Object


class Weighted(Protocol):
    """What explanations need of a model."""

    @property
    def features(self) -> FeatureSet:
        """The columns."""

    @property
    def factor(self) -> LogLinearFactor:
        """The weights."""


@dataclass(frozen=True)
class Reason:
    """One feature (l, g) that fired for a phrase and its grounding, and its share of the log-odds for `ACTIVE`."""

    phrase: str
    grounding: str
    language: str
    feature: str
    log_odds: float


@dataclass(frozen=True)
class Rivalry:
    """The second best object, and what told the best one from it.

    Attributes:
        object: the second best.
        log_odds: of the best configuration about the best object over that about this one.
        reasons: features that fired for one of the two alone, strongest first; above 0 they speak for the best.
    """

    object: Object
    log_odds: float
    reasons: tuple[Reason, ...]


def explain(model: Weighted, solution: Solution) -> list[Reason]:
    """The reasons for the best configuration, phrase by phrase from the root, strongest first.

    The log-odds of a phrase's reasons add up to log Psi(correspondence) - log Psi(INACTIVE).
    """
    walk = [] if solution.best is None else solution.best.walk()
    return [
        reason
        for hypothesis in walk
        for reason in sorted(_reasons(model, hypothesis, solution), key=lambda r: -abs(r.log_odds))
    ]


def rivalry(model: Weighted, solution: Solution) -> Rivalry | None:
    """What decided between the answer and the second best object; None if there is no other object.

    Each phrase is compared with itself in the best configuration about the other object, whose landmarks may differ.
    """
    second = solution.runner_up
    if solution.best is None or second is None:
        return None
    found: list[Reason] = []
    for ours, theirs in zip(solution.best.walk(), second.walk(), strict=True):
        for_us = {(r.language, r.feature): r for r in _reasons(model, ours, solution)}
        for_them = {(r.language, r.feature): r for r in _reasons(model, theirs, solution)}
        found += [r for key, r in for_us.items() if key not in for_them]
        found += [replace(r, log_odds=-r.log_odds) for key, r in for_them.items() if key not in for_us]
    found.sort(key=lambda r: -abs(r.log_odds))
    return Rivalry(second.child.grounding.object, solution.best.log_score - second.log_score, tuple(found))


def _reasons(model: Weighted, hypothesis: Hypothesis, solution: Solution) -> Iterator[Reason]:
    """The features that fire for a phrase and its grounding, but those of weight zero."""
    world = solution.world
    languages, groundings = list(model.features.language), list(model.features.grounding)
    phrase, child = hypothesis.tree.phrase, hypothesis.child
    sign = model.factor.correspondences.index(child.correspondence)
    zero = model.factor.correspondences.index(Correspondence.INACTIVE)
    odds = model.factor.weight[sign] - model.factor.weight[zero]
    chosen = [thing.id for thing in world.things].index(child.grounding.object.id)
    encoder = WorldEncoder(model.features, world)
    if phrase == solution.noun:
        row = encoder.ranked(phrase, solution.compared)[chosen]
    else:
        row = encoder.bag(Example(phrase, world, (), hypothesis.factor_children))[chosen]
    for language in model.features.encode_phrases([phrase])[0]:
        for grounding in row[row >= 0]:
            if language >= 0 and odds[language, grounding] != 0.0:
                yield Reason(
                    phrase.text or phrase.kind.value,
                    child.grounding.object.id,
                    languages[language],
                    groundings[grounding],
                    float(odds[language, grounding]),
                )
