"""Where things are on a map: "the tower north of the lake". That is measured, not learned.

On a table who says "south of" a thing means its near side, of which weights are learned. They were learned of things
that stand close together, where the nearest is meant even if it stands aslant. On a map the direction is what is told.
"""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np

from dcg_torch.grounding.bearings import that_way
from dcg_torch.grounding.encoding import WorldEncoder
from dcg_torch.grounding.measured_relations import ON_A_SIDE
from dcg_torch.names.vocabulary import BY_COMPASS
from dcg_torch.types import ParseTree
from dcg_torch.types.arrays import Bools, Floats

_SLANT = math.radians(25.0)
"""Angle at which a thing is half a nat less that way than one straight on."""


def by_compass(
    tree: ParseTree, log_psi: Floats, landmarks: Sequence[int], compared: Bools | None, encoder: WorldEncoder
) -> Floats:
    """(landmarks, things) log Psi of a modifier, measured where it names a point of the compass, from a thing.

    What is north of several is so of each of them.

    Args:
        log_psi: what is learned, which stays for all else: from places and groups, and in a room of unknown north.
        landmarks: the number of each.
        compared: (things,) those of which the nearest is meant; None: those of one type.
    """
    phrase = tree.phrase
    sides = BY_COMPASS.get(" ".join(phrase.text.split(" ")[-2:]), ())
    where = encoder.layout
    if phrase.words[0] not in sides or (where.outlook is not None and encoder.world.robot is None):
        return log_psi
    way = np.sum([ON_A_SIDE[side] for side in sides], axis=0)[None] / math.sqrt(len(sides))
    found = log_psi.copy()
    for k, j in enumerate(landmarks):
        if where.solid[j]:
            offset = _beyond(where.position[:, :2] - where.position[j, :2], where.half[j], straight=len(sides) == 1)
            (off,) = that_way(offset, way, compared, encoder, whole=phrase.plural, aslant=_SLANT)
            found[k] = off / len(sides)  # each of its sides says it once
            found[k, j] = log_psi[k, j]
    if tree.children[0].phrase.plural:
        alike = encoder.type_number[list(landmarks)] == encoder.type_number[landmarks[0]]
        found[alike] = found[alike].min(axis=0)
    return found


def _beyond(offset: Floats, half: Floats, *, straight: bool) -> Floats:
    """(things, 2) from the sides of what has half extents (2,) or, for what is aslant of it, from its middle."""
    return np.sign(offset) * np.maximum(np.abs(offset) - half, 0.0) if straight else offset
