"""What an ordinal counts on a side: "the second from the top on the left" is one of at least two on the left.

What is learned of a side says how likely a single thing there is meant: the one at its edge above all. So where that
describes fewer than are counted, the side is the part of what is there in which there are as many.
"""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np

from dcg_torch.grounding.encoding import WorldEncoder
from dcg_torch.grounding.hypotheses import ModifierFactor
from dcg_torch.names.relations import listed
from dcg_torch.names.vocabulary import LATERAL, ORDINALS, PLACE_WORDS, SIDED, VERTICAL
from dcg_torch.types import ParseTree, Phrase
from dcg_torch.types.arrays import Bools, Floats

_ALIKE = math.log(0.5)
_PARTS = (1.0 / 3.0, 1.0 / 2.0, 2.0 / 3.0)
"""Shares of all that is there, from its edge, that are looked at in turn."""


def counted_on_side(
    phrase: Phrase, modifiers: Sequence[ModifierFactor], fit: Floats, described: Bools, encoder: WorldEncoder
) -> Bools:
    """(things,) those that a noun phrase with an ordinal picks from.

    Args:
        fit: (things,) log-factor of all but the ranks; -inf of what is not there.
        described: (things,) those that are described about as well as the best; returned where they are enough.
    """
    ordinal = max((ORDINALS[word] for word in phrase.words if word in ORDINALS), default=0)
    number = max(2, ordinal) if ordinal else 0  # the first is one of several, too
    sides = [(m, side) for m in modifiers if (side := _side(m.tree)) is not None]
    if described.sum() >= number or not sides:
        return described
    rest = fit - np.sum([m.log_psi for m, _ in sides], axis=0)
    position = encoder.layout.position
    alike: Bools = (rest >= rest.max() + _ALIKE) & np.isfinite(position).all(axis=1) & encoder.perceived
    if alike.sum() < number:
        return described
    for part in _PARTS:
        inside: Bools = alike.copy()
        for _, side in sides:
            inside &= _within(side, position, alike, part)
        if inside.sum() >= number:
            return inside
    return described


def deepest_few(tree: ParseTree, log_psi: Floats, encoder: WorldEncoder) -> Floats:
    """(combos, things) log Psi of a modifier: "the three cubes in the back" are the three that are farthest back.

    Args:
        tree: of the modifier; its phrase has the count of what it is said of.
        log_psi: what is learned; it stays for all else.
    """
    several, side = tree.phrase.count or 1, _side(tree)
    if several < 2 or side not in VERTICAL:
        return log_psi
    kind, along = encoder.type_number, encoder.layout.position[:, 0]
    along = along if PLACE_WORDS[side][1] == "far side" else -along
    things = np.flatnonzero(encoder.layout.solid & np.isfinite(along) & encoder.perceived)
    found = log_psi.copy()
    for own in (things[kind[things] == number] for number in np.unique(kind[things])):
        if len(own) > several:
            first = along[own] >= np.sort(along[own])[-several] - 1e-9
            found[:, own] = np.where(first, log_psi[:, own].max(), np.minimum(log_psi[:, own], -_NOT_FIRST))
    return found


_NOT_FIRST = 4.0
"""Log Psi at most of what is not among the so many that are farthest on a side."""


def _side(tree: ParseTree) -> str | None:
    """The side at which a modifier says that a thing is."""
    if (
        tree.phrase.words[0] not in listed("on a side of the scene")
        or len(tree.phrase.words) > 1
        or len(tree.children) != 1
    ):
        return None
    place = tree.children[0]
    return place.phrase.noun if place.phrase.noun in SIDED and not (place.children or place.phrase.words) else None


def _within(side: str, position: Floats, among: Bools, part: float) -> Bools:
    """(things,) those in a part of what is `among`, from its edge on a side: x is away from who looks, y left."""
    along = position[:, 1] if side in LATERAL else position[:, 0]
    along = along if side in ("left", "top", "back") else -along
    low, high = along[among].min(), along[among].max()
    found: Bools = along >= high - part * (high - low) - 1e-9
    return found
