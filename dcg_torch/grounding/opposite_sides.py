"""What is opposite a thing: on the other side of what stands between, "the chair across the table from the red one".

Where nothing stands between them it is the other side of all that is there. That is measured, not learned.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from dcg_torch.grounding.encoding import WorldEncoder
from dcg_torch.grounding.stated_distances import gaps_between
from dcg_torch.types.arrays import Floats, Ints

OPPOSITE = "opposite"
_REACH = 1.0
"""Units of a gap up to which two things stand at a third."""
_ASLANT = np.radians(30.0)
"""Angle at which a thing is half a nat less opposite than one straight across."""
_NOT_ACROSS = -2.0
"""Nats from which on a thing is not across what stands between, but beside it."""
_LEAST = -5.0
"""The most nats that are lost."""


def by_opposite_side(name: str, log_psi: Floats, landmarks: Sequence[tuple[int, ...]], encoder: WorldEncoder) -> Floats:
    """(combos, things) how straight across from a landmark each thing is.

    Args:
        name: of the relation.
        log_psi: what is learned; it stays for other relations.
    """
    if name != OPPOSITE:
        return log_psi
    where = encoder.layout
    solid = np.flatnonzero(where.solid & np.isfinite(where.position[:, :2]).all(axis=1))
    if not len(solid):
        return log_psi
    found, at = log_psi.copy(), where.position[:, :2]
    middle = (at[solid].min(axis=0) + at[solid].max(axis=0)) / 2.0
    for k, mark in enumerate(of[0] for of in landmarks):
        if np.isfinite(at[mark]).all():
            across = _lost(at, mark, middle)
            for between in _between(mark, solid, encoder):
                lost = _lost(at, mark, at[between])
                there = (gaps_between([between], encoder)[0] <= _REACH) & (lost > _NOT_ACROSS)
                across = np.maximum(across, np.where(there, lost - _LEAST, -np.inf))
            found[k, solid] = across[solid] - across[solid].max()
            found[k, mark] = _LEAST
    return np.maximum(found, 2.0 * _LEAST)


def _between(mark: int, solid: Ints, encoder: WorldEncoder) -> list[int]:
    """What a landmark stands at and others may stand at: larger things near by."""
    bodies = encoder.layout.bodies
    if bodies is None or mark >= len(bodies.half):
        return []
    area, near = bodies.half.prod(axis=1), gaps_between([mark], encoder)[0] <= _REACH
    return [j for j in solid.tolist() if j != mark and j < len(area) and near[j] and area[j] > area[mark]]


def _lost(at: Floats, mark: int, middle: Floats) -> Floats:
    """(things,) nats that a thing loses by how far it is from straight across a middle."""
    one, other = at[mark] - middle, at - middle
    with np.errstate(invalid="ignore"):
        turn = np.arctan2(one[0] * other[:, 1] - one[1] * other[:, 0], other @ one)
        off = np.pi - np.abs(turn)
        found: Floats = np.maximum(_LEAST, -0.5 * (off / _ASLANT) ** 2)
    return np.where(np.isfinite(found), found, _LEAST)
