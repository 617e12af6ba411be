"""Which of several that lie on a thing is on a side of it: "the pillow on the left side of the couch".

Who stands beyond a thing is left of it by an angle. What lies on it is so by how far it is to that side, beside others
of its kind that lie there as well. That is measured, not learned.
"""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np

from dcg_torch.grounding.encoding import WorldEncoder
from dcg_torch.grounding.measured_relations import ON_A_SIDE, TOUCHING, sides_of
from dcg_torch.names.vocabulary import BESIDE_WHOM
from dcg_torch.types import Phrase
from dcg_torch.types.arrays import Floats, Ints

_ALIKE = math.pi / 4.0
"""Angle by which views of one side differ at most."""
_OTHER_END = 4.0
"""Nats that the one at the other end loses; others by how far they are from this one."""


def by_support_side(
    phrase: Phrase, log_psi: Floats, landmarks: Sequence[tuple[int, ...]], encoder: WorldEncoder
) -> Floats:
    """(combos, things) log Psi of a modifier, with what is measured of things that lie on its one landmark.

    Args:
        phrase: the modifier; "left of" and "right of" are measured, and "on the left of" is said of what lies there.
        log_psi: what is known of each.
    """
    where, name = encoder.layout, phrase.words[0]
    if name not in BESIDE_WHOM or where.bodies is None or any(len(of) != 1 for of in landmarks):
        return log_psi
    half, n = where.bodies.half, len(where.bodies.half)
    at, kind = where.position[:n, :2], encoder.type_number[:n]
    found = log_psi.copy()
    for k, (j,) in enumerate(landmarks):
        if j >= n or not np.isfinite(half[j]).all():
            continue
        offset = at - at[j]
        upon = (np.abs(offset) < half[j]).all(axis=1) & (half.prod(axis=1) < half[j].prod())
        for one in np.unique(kind[upon]):
            alike = np.flatnonzero(upon & (kind == one))
            seen = alike.tolist() if _looked_at_alike(alike, encoder) else [j]
            aside = offset @ sides_of(ON_A_SIDE[name], seen, encoder).mean(axis=0)
            if np.ptp(aside[alike]) > TOUCHING:
                if phrase.text.startswith("on "):
                    found[k, alike] = log_psi[k].max()
                found[k, alike] -= _OTHER_END * (aside[alike].max() - aside[alike]) / np.ptp(aside[alike])
    return found


def _looked_at_alike(things: Ints, encoder: WorldEncoder) -> bool:
    """Are things looked at from one side, so that their sides are not those of what they lie on?"""
    outlook = encoder.layout.outlook
    if outlook is None:
        return True
    turned = np.abs(np.nan_to_num(outlook[things] - outlook[things[0]])) % (2.0 * math.pi)
    return bool((np.minimum(turned, 2.0 * math.pi - turned) < _ALIKE).all())
