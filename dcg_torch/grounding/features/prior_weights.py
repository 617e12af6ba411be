"""The weights that are known before anything is learned: those of the facts between words and names."""

from __future__ import annotations

import numpy as np

from dcg_torch.fitting.psi import LogLinearFactor
from dcg_torch.grounding.features.columns import FeatureSet
from dcg_torch.grounding.features.name_facts import fact_odds
from dcg_torch.types import Correspondence


def give_odds(factor: LogLinearFactor, features: FeatureSet) -> None:
    """Give the facts between words and the names of classes, colours and attributes their odds, in place."""
    weight = factor.weight.detach().cpu().numpy().copy()
    sign = np.array([0.5 if c is Correspondence.ACTIVE else -0.5 for c in factor.correspondences])
    for fact, odds in fact_odds().items():
        column = features.grounding[fact]
        rows = np.flatnonzero(features.pairs[:, column])
        weight[:, rows, column] = (sign * odds)[:, None]
    factor.set_weight(weight)
