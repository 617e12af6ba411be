"""The two at the ends: "the outermost cups", "the cups at both ends"; and those between them, "the inner cups".

Measured along the line in which what the rest of a noun phrase describes is spread most.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from dcg_torch.grounding.encoding import WorldEncoder
from dcg_torch.names.relations import listed
from dcg_torch.types import Phrase
from dcg_torch.types.arrays import Bools, Floats

_OUTER, _INNER = listed("outer"), listed("inner")
_NOT_THERE = -8.0
"""Nats that a thing loses that is not at an end, or is."""


def of_line_ends(phrase: Phrase, among: Bools, encoder: WorldEncoder) -> tuple[Phrase, Floats]:
    """What a noun phrase in the plural says of ends.

    Args:
        among: (things,) what the rest of the phrase describes.

    Returns:
        The phrase without the words that are taken up, and the log-factor of each thing.
    """
    log = np.zeros(len(among))
    said = [word for word in phrase.words if word in _OUTER | _INNER]
    position = encoder.layout.position
    at = np.flatnonzero(among & encoder.layout.solid & np.isfinite(position).all(axis=1))
    if not (said and phrase.plural) or len(at) < 3:
        return phrase, log
    offset = position[at] - position[at].mean(axis=0)
    along = np.argsort(offset @ np.linalg.svd(offset, full_matrices=False)[2][0], kind="stable")
    outer = said[0] in _OUTER
    ends = max(1, (phrase.count or 2) // 2) if outer else max(1, (len(at) - (phrase.count or len(at) - 2)) // 2)
    end = np.zeros(len(among), dtype=np.bool_)
    end[at[np.concatenate((along[:ends], along[-ends:]))]] = True
    log[~end if outer else end] = _NOT_THERE
    return replace(phrase, words=tuple(word for word in phrase.words if word not in said)), log
