"""What is measured of how things stand to landmarks, beside what is learned of it.

Of several landmarks that are named alike the nearest pair counts, or none. In the plural all that stand so are meant.
Extents say what is within reach of a thing, and what can be in it.
"""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from dcg_torch.grounding.encode import WorldEncoder
from dcg_torch.names.vocabulary import OF_TWO
from dcg_torch.scene.order import numbered
from dcg_torch.scene.relations import RELATION_NAMES, between
from dcg_torch.types import Phrase

Floats = NDArray[np.float64]
Bools = NDArray[np.bool_]


def means_all(phrase: Phrase) -> bool:
    """Does a modifier in the plural describe all that stand so, and not the nearest of them above all?"""
    whole = phrase.count is None and (phrase.words[0] in _ON_A_SIDE or phrase.words[0] in OF_TWO)
    return phrase.plural and (whole or phrase.words[0] in _AROUND)


def of_all(phrase: Phrase, log_psi: Floats, landmarks: Sequence[tuple[int, ...]], encoder: WorldEncoder) -> Floats:
    """(combos, things) of a modifier that `means_all`; the rest as it was."""
    name = phrase.words[0]
    if not means_all(phrase):
        return log_psi
    if name in _AROUND:
        return _within_reach(log_psi, [of[0] for of in landmarks], encoder)
    if name in _ON_A_SIDE:
        return _on_the_side(name, log_psi, [of[0] for of in landmarks], encoder)
    return _all_between(log_psi, landmarks, encoder) if all(len(of) > 1 for of in landmarks) else log_psi


def _within_reach(log_psi: Floats, landmarks: Sequence[int], encoder: WorldEncoder) -> Floats:
    """(combos, things) "the chairs around the table" are all that stand close to it, not the nearest one above all.

    Where extents are known, by the gap between the two; the rest as it was.
    """
    where = encoder.layout
    if where.bodies is None or max(landmarks, default=0) >= len(where.bodies.half):
        return log_psi
    n = len(where.bodies.half)
    at, half = where.position[:n, :2], where.bodies.half
    apart = np.abs(at[landmarks][:, None] - at[None]) - half[landmarks][:, None] - half[None]
    gap = np.linalg.norm(np.maximum(apart, 0.0), axis=2)
    near = np.where(np.isfinite(gap), -np.logaddexp(0.0, (np.nan_to_num(gap) - _REACH) / _VAGUE), np.nan)
    found = log_psi.copy()
    found[:, :n] = np.where(np.isfinite(near), near, found[:, :n])
    found[np.arange(len(landmarks)), landmarks] = log_psi[np.arange(len(landmarks)), landmarks]
    return found


_AROUND = frozenset({"around", "near", "at", "by", "next to", "beside", "surrounded by"})
_REACH, _VAGUE = 0.6, 0.12
"""Units of a gap up to which things stand around another, and how vague that is."""


def _on_the_side(name: str, log_psi: Floats, landmarks: Sequence[int], encoder: WorldEncoder) -> Floats:
    """(combos, things) "the chairs left of the table" are all on that side of it, not the nearest of them above all.

    Args:
        name: one of `_ON_A_SIDE`.
        log_psi: what is known of the one that is meant.
        landmarks: numbers of things.
    """
    where, (x, y) = encoder.layout, _ON_A_SIDE[name]
    offset = where.position[None, :, :2] - where.position[landmarks][:, None, :2]
    half = where.half[landmarks][:, None]
    offset = np.sign(offset) * np.maximum(np.abs(offset) - half, 0.0)
    ahead, aside = offset @ np.array([x, y]), np.abs(offset @ np.array([-y, x]))
    aslant = np.arctan2(aside, ahead)
    found = np.where(np.isfinite(aslant), -np.logaddexp(0.0, (np.nan_to_num(aslant) - _ASLANT) / _UNSURE), log_psi)
    found[np.arange(len(landmarks)), landmarks] = log_psi[np.arange(len(landmarks)), landmarks]
    return found


_ON_A_SIDE = {"left of": (0.0, 1.0), "right of": (0.0, -1.0), "behind": (1.0, 0.0), "in front of": (-1.0, 0.0)}
"""Preposition -> the direction in which what is so stands, as who looks sees it."""
_ASLANT, _UNSURE = math.radians(65.0), math.radians(6.0)
"""Angle off that direction up to which a thing is on that side, and how vague that is."""


def _all_between(log_psi: Floats, landmarks: Sequence[tuple[int, ...]], encoder: WorldEncoder) -> Floats:
    """(combos, things) "the chairs between the table and the door" are all of them, as much as the likeliest is."""
    name = RELATION_NAMES.index(f"{_BETWEEN}between")
    inside = between(encoder.layout, landmarks) == name
    best = np.where(inside, log_psi, -np.inf).max(axis=1, keepdims=True)
    return np.where(inside, best, log_psi)


_BETWEEN = "relation: between, "


def of_none(log_psi: Floats, scores: Floats) -> Floats:
    """(combos, things) what is not at a desk is at none of them: of landmarks that are named alike the worst counts."""
    alike = scores >= scores.max() - _ALIKE
    found = log_psi.copy()
    found[alike] = log_psi[alike].min(axis=0)
    return found


_ALIKE = 1.0
"""Nats by which the scores of landmarks of one name may differ."""


def by_distance(
    name: str, landmarks: Sequence[int], scores: Floats, compared: Bools | None, encoder: WorldEncoder
) -> Floats:
    """(combos, things) "the mug closest to a lamp" is the nearest of all mugs to any lamp, not one for each lamp.

    Args:
        name: of the relation.
        landmarks: (combos,) number of each.
        scores: (combos,) of the landmarks; those described alike are weighed against one another, corners and objects
            each with their like.
        compared: (things,) those that are compared; None: those of one type.

    Returns:
        What is lost for each e-fold by which a thing is farther from its landmark than the nearest thing is from one;
        or nearer to any landmark than the farthest.
    """
    fold = _E_FOLD.get(name, 0.0)
    if not fold or len(landmarks) < 2:
        return np.zeros((len(landmarks), len(encoder.all)))
    solid, best = encoder.layout.solid, landmarks[int(scores.argmax())]
    same = np.array([solid[j] if solid[best] else encoder.all[j].type == encoder.all[best].type for j in landmarks])
    alike = np.flatnonzero((scores >= scores.max() - _ALIKE) & same)
    lost = np.zeros((len(landmarks), len(encoder.all)))
    if len(alike) < 2:
        return lost
    mark = np.array(landmarks)[alike]
    gap = encoder.distances(mark.tolist()) + _TOUCHING
    gap[~np.isfinite(gap)] = np.inf
    gap[np.arange(len(mark)), mark] = np.inf  # nothing is near itself
    nearest = gap.min(axis=0)
    there = (np.isfinite(nearest) & encoder.layout.solid).nonzero()[0]
    kind = numbered([o.type for o in encoder.all]) if compared is None else compared.astype(np.int64)
    away = fold * np.log(gap[:, there] if fold > 0.0 else nearest[None, there])
    ends = np.full(len(kind) + 1, np.inf)
    np.minimum.at(ends, kind[there], away.min(axis=0))
    lost[np.ix_(alike, there)] = np.maximum(_FARTHEST, ends[kind[there]] - away)
    return lost


_TOUCHING = 0.1
"""Units of a gap below which distances are alike."""
_E_FOLD = {"closest to": 3.0, "farthest from": -3.0} | dict.fromkeys(
    ("close to", *_AROUND - {"around", "surrounded by"}), 1.5
)
"""Nats for each e-fold of a distance, by relation."""
_FARTHEST = -6.0
"""The most that is lost."""


def inside_of(name: str, landmarks: Sequence[tuple[int, ...]], encoder: WorldEncoder) -> Floats | None:
    """(combos, things) what things lose that are too large to be in a landmark, or are not above the floor it covers.

    Returns:
        None where nobody says how large the landmarks are, and for all other prepositions.
    """
    where = encoder.layout
    if name not in _INSIDE or where.bodies is None:
        return None
    half = where.bodies.half
    if any(len(of) != 1 or of[0] >= len(half) for of in landmarks):
        return None
    mark = [of[0] for of in landmarks]
    area, at = half.prod(axis=1), where.position[: len(half), :2]
    with np.errstate(invalid="ignore"):
        larger = area[None] > _LARGER * area[mark][:, None]
        within = (np.abs(at[mark][:, None] - at[None]) <= half[mark][:, None] + _RIM).all(axis=2) & ~larger
    within[np.arange(len(mark)), mark] = False
    out = np.isfinite(area[mark])[:, None] & within.any(axis=1)[:, None] & ~within
    return np.pad(np.where(larger | out, -_NOT_IN, 0.0), ((0, 0), (0, len(encoder.all) - len(area))))


_INSIDE = frozenset({"in", "inside", "into"})
_NOT_IN = 5.0
"""Nats that a thing loses that can't be in a landmark."""
_LARGER = 1.5
"""How much more floor than a landmark a thing covers at most that is in it."""
_RIM = 0.05
"""Units that the middle of what is in a thing may be beyond its rim."""
