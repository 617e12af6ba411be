"""Where things stand to the ends and the sides of what has extents: "at the head of the table", "on its window side".

That is measured, not learned. A thing's place is told in half extents of the landmark, from its middle.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from dcg_torch.grounding.encoding import WorldEncoder
from dcg_torch.grounding.measured_relations import inside_of, within_reach
from dcg_torch.names.vocabulary import AT_END, OF_OUTLINE, TOWARDS
from dcg_torch.scene.layout import HEADINGS
from dcg_torch.types.arrays import Floats, Ints

_LONGER = 1.15
"""How many times as long as wide a thing is that has two ends."""
_END = 0.5
"""Share of the half length from which on a thing is at an end."""
_SIDE, _SLANT = 0.3, 0.8
"""Half extents that a thing is out to a side at least, and how many times as far it may be off to another."""
_VAGUE = 0.15
"""How many half extents that is vague."""
_SQUARE = 2.0
"""How many times as far that way as across a thing stands that one side alone faces."""
_REACH = 0.8
"""Units from an outline up to which things are at it."""
_ELSEWHERE = -8.0
"""The most that is lost."""


def by_outline(name: str, log_psi: Floats, landmarks: Sequence[tuple[int, ...]], encoder: WorldEncoder) -> Floats:
    """(combos, things) how well things stand so to the outlines of landmarks.

    Args:
        name: of the relation.
        log_psi: what is learned; it stays for other relations, and where nobody says how large a landmark is.
    """
    bodies = encoder.layout.bodies
    if name not in OF_OUTLINE or bodies is None:
        outside = inside_of(name, landmarks, encoder)
        return log_psi if outside is None else log_psi + outside
    known = [k for k, of in enumerate(landmarks) if of[0] < len(bodies.half) and np.isfinite(bodies.half[of[0]]).all()]
    if not known:
        return log_psi
    at, (mark, *others) = encoder.layout.position[:, :2], np.array([landmarks[k] for k in known]).T
    half = bodies.half[mark]
    offset = (at[None] - at[mark][:, None]) / half[:, None]
    if name == AT_END or not others:
        by = _out_to_an_end(offset, half)
    else:
        way = _ways(at[others[0]] - at[mark], half, _halves(bodies.half, others[0]))
        for k, seen in enumerate(encoder.all[j].attributes & HEADINGS.keys() for j in others[0].tolist()):
            if len(seen) == 1 and not encoder.layout.solid[others[0][k]]:
                way[k] = HEADINGS[next(iter(seen))]
        by = _out_to_a_side(offset, way if name == TOWARDS else -way)
    found = log_psi.copy()
    reach = within_reach(mark.tolist(), encoder, _REACH)
    there = encoder.layout.solid[None] & np.isfinite(by) & np.isfinite(reach)
    stands = _at_least(np.where(there, by, 0.0)) + np.where(there, reach, 0.0)
    found[known] = np.where(there, np.maximum(stands, _ELSEWHERE), log_psi[known])
    found[known, mark] = log_psi[known, mark]
    return found


def _at_least(by: Floats) -> Floats:
    out: Floats = -np.logaddexp(0.0, -by / _VAGUE)
    return out


def _out_to_an_end(offset: Floats, half: Floats) -> Floats:
    """(combos, things) half extents by which a thing is farther along than across; all of what has no ends."""
    along = (half[:, 0] > half[:, 1])[:, None, None]
    far = np.abs(np.where(along, offset, offset[..., ::-1]))
    long = half.max(axis=1) > _LONGER * half.min(axis=1)
    out = np.minimum(far[..., 0] - far[..., 1], far[..., 0] - _END)
    return np.where(long[:, None], out, np.nan)


def _halves(half: Floats, numbers: Ints) -> Floats:
    """(combos, 2) half extents, 0 of what has none."""
    found = np.zeros((len(numbers), 2))
    known = numbers < len(half)
    found[known] = np.nan_to_num(half[numbers[known]])
    return found


def _ways(offset: Floats, half: Floats, others: Floats) -> Floats:
    """(combos, 2) unit vectors to what a side faces: straight out where it stands beside that side alone."""
    gap = np.sign(offset) * np.maximum(np.abs(offset) - half - others, 0.0)
    gap = np.where((gap == 0.0).all(axis=1, keepdims=True), offset, gap)
    straight = np.abs(gap) >= np.abs(gap).max(axis=1, keepdims=True) / _SQUARE
    gap = np.where(straight, gap, 0.0)
    length = np.hypot(*gap.T)[:, None]
    with np.errstate(invalid="ignore", divide="ignore"):
        found: Floats = gap / length
    return found


def _out_to_a_side(offset: Floats, way: Floats) -> Floats:
    """(combos, things) half extents by which a thing is farther out to a side than off it."""
    ahead = np.einsum("cnd,cd->cn", offset, way)
    across = np.abs(offset[..., 1] * way[:, None, 0] - offset[..., 0] * way[:, None, 1])
    out: Floats = np.minimum(ahead - _SIDE, ahead - _SLANT * across)
    return out
