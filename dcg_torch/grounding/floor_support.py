"""What stands on the floor: "the pallet on the ground" rests on nothing and is no higher than what stands there.

That is measured, not learned: where on the floor a thing stands tells nothing.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from dcg_torch.grounding.encoding import WorldEncoder
from dcg_torch.names.relations import listed
from dcg_torch.types.arrays import Floats

_ON = listed("on the ground")
_RESTS = -4.0
"""Nats that what rests on something loses, and the most that what is high up does."""
_HIGH = -4.0
"""Nats for each metre by which a thing is higher than the lowest."""
_THERE = -0.1
"""Log Psi of what stands there."""


def by_floor_support(name: str, log_psi: Floats, landmarks: Sequence[tuple[int, ...]], encoder: WorldEncoder) -> Floats:
    """(combos, things) how well things stand on the ground, where that is the landmark; else what is learned.

    Args:
        name: of the relation.
        log_psi: what is learned.
    """
    where = encoder.layout
    rows = [k for k, of in enumerate(landmarks) if len(of) == 1 and where.ground[of[0]]] if name in _ON else []
    known = where.solid & encoder.perceived
    if not rows or not known.any():
        return log_psi
    height = where.position[:, 2] * encoder.world.unit
    up = np.minimum(0.0, _HIGH * (height - height[known].min()))
    stands = np.maximum(_RESTS, np.where(where.resting, _RESTS, up)) + _THERE
    found = log_psi.copy()
    found[rows] = np.where(known, stands, log_psi[rows])
    return found
