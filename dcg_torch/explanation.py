"""Why a command was grounded as it was: the features that moved each phrase towards its grounding, and by how much."""

from __future__ import annotations

from dataclasses import dataclass

from dcg_torch.graph import Solution
from dcg_torch.learning import labelled
from dcg_torch.model import GroundingModel, example_bag
from dcg_torch.symbols import Correspondence


@dataclass(frozen=True)
class Reason:
    """One feature (l, g) that fired for a phrase and its grounding, and its share of the log-odds for `ACTIVE`."""

    phrase: str
    grounding: str
    language: str
    feature: str
    log_odds: float


def explain(model: GroundingModel, solution: Solution) -> list[Reason]:
    """The reasons for the best configuration, phrase by phrase from the root, strongest first.

    The log-odds of a phrase's reasons add up to log Psi(correspondence) - log Psi(INACTIVE).
    """
    reasons: list[Reason] = []
    if solution.best is None:
        return reasons
    languages, groundings = list(model.features.language), list(model.features.grounding)
    for hypothesis in solution.best.walk():
        example = labelled(
            hypothesis.tree.phrase,
            hypothesis.child,
            hypothesis.factor_children,
            solution.world,
        )
        sign = model.loglinear.correspondences.index(hypothesis.child.correspondence)
        zero = model.loglinear.correspondences.index(Correspondence.INACTIVE)
        odds = model.loglinear.weight[sign] - model.loglinear.weight[zero]
        chosen = [thing.id for thing in solution.world.things].index(hypothesis.child.grounding.object.id)
        row = example_bag(example, model.features)[chosen]
        own = [
            Reason(
                hypothesis.tree.phrase.text or hypothesis.tree.phrase.kind,
                hypothesis.child.grounding.object.id,
                languages[language],
                groundings[grounding],
                float(odds[language, grounding]),
            )
            for language in model.features.encode_phrases([hypothesis.tree.phrase])[0]
            for grounding in row[row >= 0]
            if odds[language, grounding] != 0.0
        ]
        reasons += sorted(own, key=lambda reason: -abs(reason.log_odds))
    return reasons
