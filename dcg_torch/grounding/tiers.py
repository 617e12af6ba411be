"""Things in two tiers, as kitchen cabinets: "the upper cabinet on the far left" is leftmost among the upper ones.

A word for a height then says which tier is meant, and other ranks are within it. That is measured, not learned.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from dcg_torch.grounding.encoding import WorldEncoder
from dcg_torch.grounding.hypotheses import ModifierFactor
from dcg_torch.grounding.modifiers import ranks_from
from dcg_torch.names.vocabulary import ORDINALS, is_superlative
from dcg_torch.types import Phrase
from dcg_torch.types.arrays import Bools, Floats

_ENDS = {"highest": 1.0, "lowest": -1.0}
_OTHER_TIER = -8.0
"""Nats that a thing loses that is in the other tier."""
_APART, _LEVEL = 0.5, 0.5
"""Units by which tiers are apart at least, and share of that within which the things of a tier stand on a level."""


def of_tier(
    phrase: Phrase, named: Bools, modifiers: Sequence[ModifierFactor], encoder: WorldEncoder
) -> tuple[Phrase, Floats]:
    """What a noun phrase says of a tier that ranks otherwise, too.

    Args:
        named: (things,) what it names.
        modifiers: of the noun phrase.

    Returns:
        The phrase without the word that is taken up, and the log-factor of each thing.
    """
    log, where = np.zeros(len(named)), encoder.layout
    ends = [word for word in phrase.words if word in _ENDS]
    ranks = any((is_superlative(word) or word in ORDINALS) and word not in _ENDS for word in phrase.words)
    if len(ends) != 1 or where.bodies is None or not (ranks or any(ranks_from(m.tree) for m in modifiers)):
        return phrase, log
    at = np.flatnonzero(named & where.solid & np.isfinite(where.position[:, 2]))
    high = _ENDS[ends[0]] * where.position[at, 2]
    order = np.sort(high)[::-1]
    gaps = order[:-1] - order[1:]
    if len(at) < 3 or gaps.max() < _APART:
        return phrase, log
    first = int(gaps.argmax()) + 1
    if first < 2 or order[0] - order[first - 1] > _LEVEL * gaps.max():
        return phrase, log
    log[:] = _OTHER_TIER
    log[at[high >= order[first - 1]]] = 0.0
    return replace(phrase, words=tuple(word for word in phrase.words if word not in ends)), log
