"""The middle one of a row that is there: "the middle child in the top row" is as far from one end as from the other.

It is counted, not measured: of five the third, wherever the others stand. Of an even number none is in the middle.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from dcg_torch.grounding.counting import WAYS, start_of_line
from dcg_torch.grounding.encoding import WorldEncoder
from dcg_torch.grounding.hypotheses import ModifierFactor
from dcg_torch.grounding.modifiers import is_in_a_group
from dcg_torch.names.relations import listed
from dcg_torch.types import Phrase
from dcg_torch.types.arrays import Bools, Floats

_MIDDLE = listed("middle")
_LEAST, _STRAIGHT = 3, 0.25
"""Things at least that have one in the middle, and how wide their line is at most for its length."""
_BY_PLACE = 3.0
"""Nats for each place away from the middle."""


def middle_of_row(
    phrase: Phrase, modifiers: Sequence[ModifierFactor], among: Bools, encoder: WorldEncoder
) -> tuple[Phrase, Floats]:
    """What "middle" says of those in a row.

    Args:
        modifiers: of the noun phrase.
        among: (things,) what the rest of the phrase describes.

    Returns:
        The phrase without that word, where it is taken up, and the log-factor of each thing.
    """
    where, log = encoder.layout, np.zeros(len(among))
    if _MIDDLE.isdisjoint(phrase.words) or phrase.plural or not any(is_in_a_group(m.tree) for m in modifiers):
        return phrase, log
    at = np.flatnonzero(among & where.solid & np.isfinite(where.position).all(axis=1))
    if len(at) < _LEAST or len(at) % 2 == 0:
        return phrase, log
    side, wide = start_of_line(where.position[at], picture=where.picture)
    if wide >= _STRAIGHT:
        return phrase, log
    place = (where.position[at, :2] @ np.array(WAYS[side])).argsort().argsort()
    lost = _BY_PLACE * np.abs(place - len(at) // 2)
    log[:] = -lost.max()
    log[at] = -lost
    return replace(phrase, words=tuple(word for word in phrase.words if word not in _MIDDLE)), log
