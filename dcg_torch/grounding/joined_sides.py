"""What stands on a side of each of several things: "the cup behind the lamp and right of the plate".

"Behind the lamp" alone means what stands there before others: near, and not aslant. What is told by two sides need be
the nearest on neither. All that are on a side count there, and only of equals the one that is meant by a side alone.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from dcg_torch.grounding.encoding import WorldEncoder
from dcg_torch.grounding.measured_relations import ON_A_SIDE, aslant
from dcg_torch.types import NOT, ParseTree
from dcg_torch.types.arrays import Floats

_JOINED = "beside another side"
"""The context of a modifier that is one of several sides."""
_WIDE, _UNSURE = math.radians(80.0), math.radians(4.0)
"""Angle off a side up to which a thing is on it, and how vague that is."""
_OF_EQUALS = 0.1
"""The share of what is known of a side alone that is left."""


def joined(noun: ParseTree, modifier: ParseTree) -> ParseTree:
    """A modifier of a noun phrase that tells one of several sides; others as they are."""
    if not _is_side(modifier) or noun.phrase.plural or sum(map(_is_side, noun.children)) < 2:
        return modifier
    phrase = modifier.phrase
    return ParseTree(replace(phrase, context=(*phrase.context, _JOINED)), modifier.children)


def by_joined_side(tree: ParseTree, log_psi: Floats, landmarks: Sequence[int], encoder: WorldEncoder) -> Floats:
    """(combos, things) of a modifier that tells one of several sides; of others as it was.

    Args:
        log_psi: of the one that is meant by this side alone.
        landmarks: numbers of things.
    """
    if _JOINED not in tree.phrase.context:
        return log_psi
    off = aslant(tree.phrase.words[0], landmarks, encoder)
    known = np.isfinite(off)
    known[np.arange(len(landmarks)), landmarks] = False
    best = np.where(known, log_psi, -np.inf).max(axis=1, keepdims=True)
    there = -np.logaddexp(0.0, (np.nan_to_num(off) - _WIDE) / _UNSURE)
    with np.errstate(invalid="ignore"):
        return np.where(known, there + _OF_EQUALS * (log_psi - best), log_psi)


def _is_side(modifier: ParseTree) -> bool:
    phrase = modifier.phrase
    sided = phrase.words[:1] != () and phrase.words[0] in ON_A_SIDE and NOT not in phrase.words
    return sided and len(modifier.children) == 1 and "to a thing" in phrase.context
