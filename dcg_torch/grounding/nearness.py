"""Who is near, and who is nearer than others: by degrees, beside what is learned of the nearest.

Of several landmarks that are named alike the nearest pair counts. On a side of a thing the nearest counts, and what
stands straight before what stands aslant.
"""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np

from dcg_torch.grounding.encoding import WorldEncoder
from dcg_torch.grounding.measured_relations import (
    ASLANT,
    NEARNESS,
    ON_A_SIDE,
    STRAIGHT,
    TOUCHING,
    alike_by,
    aslant,
    is_between,
    means_all,
)
from dcg_torch.names.vocabulary import FARTHEST, NEAREST, OF_TWO
from dcg_torch.scene.neighbours import LEVEL, SAME_SPOT
from dcg_torch.types import NOT, Phrase
from dcg_torch.types.arrays import Bools, Floats, Ints


def by_nearness(
    name: str,
    log_psi: Floats,
    landmarks: Sequence[int],
    scores: Floats,
    compared: Bools | None,
    encoder: WorldEncoder,
) -> Floats:
    """(combos, things) log Psi of a modifier to one landmark, with what is measured of distances.

    Args:
        name: of the relation.
        log_psi: what is learned.
        landmarks, scores: (combos,) number of each, and its score.
        compared: (things,) those that are compared; None: those of one type.
    """
    log_psi = _nearly_as_near(name, log_psi, landmarks, compared, encoder)
    log_psi = _no_less_near(name, log_psi, landmarks, compared, encoder)
    log_psi = log_psi + by_distance(name, landmarks, scores, compared, encoder)
    return _nearest_on_a_side(name, log_psi, landmarks, compared, encoder)


def _nearly_as_near(
    name: str, log_psi: Floats, landmarks: Sequence[int], compared: Bools | None, encoder: WorldEncoder
) -> Floats:
    """(combos, things) what is nearly as near to a thing as the nearest of its kind is near to it as well.

    Args:
        log_psi: what is known of each thing; it stays where it is more, for what is no nearness, and where nobody says
            how large things are.
        compared: (things,) those that are compared; None: those of one type.
    """
    if name not in NEARNESS or encoder.layout.bodies is None:
        return log_psi
    gap = encoder.distances(list(landmarks)) + TOUCHING
    gap[~np.isfinite(gap)] = np.inf
    gap[np.arange(len(landmarks)), landmarks] = np.inf
    gap[:, ~encoder.layout.solid] = np.inf
    gap[~encoder.layout.solid[list(landmarks)]] = np.inf
    of_each, nearest = nearest_of_a_kind(gap, compared, encoder)
    best = np.full(len(nearest), -np.inf)
    first = np.isfinite(gap) & (gap <= nearest[of_each])
    np.maximum.at(best, of_each[first], log_psi[first])
    with np.errstate(invalid="ignore"):
        behind = np.where(np.isfinite(gap), _NEARLY * np.log(gap / nearest[of_each]), np.inf)
        aside = np.where(np.isfinite(gap), _ASIDE * np.log(gap / nearest[of_each]), 0.0)
    found: Floats = np.maximum(log_psi - aside, best[of_each] - behind)
    return found


_NEARLY, _ASIDE = 9.0, 6.0
"""Nats that a thing loses at most for each e-fold by which it is farther than the nearest of its kind, and at least:
"next to" is on the left or the right rather than behind, but not far off."""


def _no_less_near(
    name: str, log_psi: Floats, landmarks: Sequence[int], compared: Bools | None, encoder: WorldEncoder
) -> Floats:
    """(combos, things) what stands clearly nearer than others of its kind is no less beside a thing for its height.

    That is for what stands higher or lower than the landmark, and not straight over or under it.
    """
    if name not in NEARNESS:
        return log_psi
    where, mark = encoder.layout, list(landmarks)
    gap = encoder.distances(mark) + TOUCHING
    offset = where.position[None] - where.position[mark][:, None]
    on_spot = np.hypot(offset[..., 0], offset[..., 1]) < SAME_SPOT
    raised = np.abs(offset[..., 2]) > LEVEL
    beside = np.isfinite(gap) & ~on_spot & where.solid[None] & where.solid[mark][:, None]
    away = _NEARER * np.log(np.where(beside, gap, 1.0))
    value = np.where(beside, log_psi + away, -np.inf)
    found = log_psi.copy()
    kind = encoder.type_number if compared is None else compared.astype(np.int64)
    for number in np.unique(kind[where.solid]).tolist():
        alike = np.flatnonzero(kind == number)
        order = np.argsort(np.where(beside, -away, np.inf)[:, alike], axis=1, kind="stable")
        farther = np.take_along_axis(value[:, alike], order, axis=1)
        best = np.empty_like(farther)
        np.put_along_axis(best, order, np.maximum.accumulate(farther, axis=1), axis=1)
        least = np.where((beside & raised)[:, alike], best - away[:, alike] - _CLEARLY, -np.inf)
        found[:, alike] = np.maximum(found[:, alike], least)
    return found if compared is None else _nearest_by_far(found, np.where(beside & compared, gap, np.inf), raised)


def _nearest_by_far(log_psi: Floats, gap: Floats, raised: Bools) -> Floats:
    """(combos, things) what is far nearer than all others that are compared is beside a landmark: which else is meant?

    Args:
        gap: (combos, things), inf for what is not compared.
        raised: (combos, things) those of which this is told.
    """
    if gap.shape[1] < 2:
        return log_psi
    first, second = np.partition(gap, 1, axis=1)[:, :2].T
    row = np.flatnonzero(np.isfinite(second) & (second >= _TWICE * first))
    nearest = gap[row].argmin(axis=1)
    found = log_psi.copy()
    row, nearest = row[raised[row, nearest]], nearest[raised[row, nearest]]
    found[row, nearest] = np.maximum(found[row, nearest], _NEAREST)
    return found


_TWICE, _NEAREST = 2.0, -2.0
"""How many times farther the second nearest is, where the nearest is meant however far off it is, and its log Psi at
least."""
_NEARER, _CLEARLY = 1.5, 1.0
"""Nats that a thing is more beside a landmark than another for each e-fold by which it is nearer, and how many of them
what else is known of both may be worth."""


def nearest_of_a_kind(gap: Floats, compared: Bools | None, encoder: WorldEncoder) -> tuple[Ints, Floats]:
    """(combos, things) a number for each landmark and kind, and by these numbers the gap of the nearest; inf: none.

    Args:
        gap: (combos, things) how far each is from each landmark, or what else is least of the nearest.
    """
    kind = encoder.type_number if compared is None else compared.astype(np.int64)
    of_each: Ints = kind + (kind.max(initial=0) + 1) * np.arange(len(gap))[:, None]
    nearest = np.full(of_each.max(initial=0) + 1, np.inf)
    np.minimum.at(nearest, of_each, gap)
    return of_each, nearest


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
    alike = np.flatnonzero(alike_by(scores) & same)
    lost = np.zeros((len(landmarks), len(encoder.all)))
    if len(alike) < 2:
        return lost
    mark = np.array(landmarks)[alike]
    gap = encoder.distances(mark.tolist()) + TOUCHING
    gap[~np.isfinite(gap)] = np.inf
    gap[np.arange(len(mark)), mark] = np.inf  # nothing is near itself
    nearest = gap.min(axis=0)
    there = (np.isfinite(nearest) & encoder.layout.solid).nonzero()[0]
    kind = encoder.type_number if compared is None else compared.astype(np.int64)
    away = fold * np.log(gap[:, there] if fold > 0.0 else nearest[None, there])
    ends = np.full(len(kind) + 1, np.inf)
    np.minimum.at(ends, kind[there], away.min(axis=0))
    lost[np.ix_(alike, there)] = np.maximum(_FARTHEST, ends[kind[there]] - away)
    return lost


def _nearest_on_a_side(
    name: str, log_psi: Floats, landmarks: Sequence[int], compared: Bools | None, encoder: WorldEncoder
) -> Floats:
    """(combos, things) the nearest of a kind on a side of a thing is meant rather than others there, or elsewhere.

    What stands aslant loses where another stands straight. The only one of its kind there is meant however far off.

    Args:
        log_psi: what is known of each thing; it stays for what is no side, and for places.
        compared: (things,) those that are compared; None: those of one type.
    """
    if name not in ON_A_SIDE:
        return log_psi
    solid, mark = encoder.layout.solid, list(landmarks)
    gap = encoder.distances(mark) + TOUCHING
    off = np.where(solid[mark][:, None] & solid, aslant(name, mark, encoder), np.inf)
    off[np.arange(len(mark)), mark] = np.inf
    beside, slanting = off < STRAIGHT, (off >= STRAIGHT) & (off < ASLANT)
    of_each, nearest = nearest_of_a_kind(np.where(beside, gap, np.inf), compared, encoder)
    on_side, across, known = (
        np.bincount(of_each[some], minlength=len(nearest))[of_each]
        for some in (off < ASLANT, off < _ACROSS, np.isfinite(off))
    )
    lost = np.zeros(gap.shape)
    lost[beside] = -_SIDE_FOLD * np.log(gap[beside] / nearest[of_each[beside]])
    lost[slanting] = np.where(nearest[of_each[slanting]] < _NOT_FARTHER * gap[slanting], -_LESS_STRAIGHT, 0.0)
    elsewhere = np.isfinite(off) & (on_side > 0)
    lost[elsewhere & (off > _ACROSS)] = -_NOT_THERE
    lost[elsewhere & (off > _OTHER_SIDE)] = -2.0 * _NOT_THERE
    alone = (off < ASLANT) & (across == 1) & (known > 1)
    found: Floats = np.where(alone, np.maximum(log_psi, _ONLY_ONE), log_psi) + lost
    return found


def nearer_between(
    phrase: Phrase,
    log_psi: Floats,
    landmarks: Sequence[tuple[int, ...]],
    scores: Floats,
    compared: Bools | None,
    encoder: WorldEncoder,
) -> Floats:
    """(combos, things) what stands between two: "between the bed and the desk", of two beds, is in the narrower gap.

    Args:
        landmarks, scores: (combos,) numbers of each, and its score; of those described alike what is between one pair
            loses by how much wider the gap is than that of another of its kind.
        compared: (things,) those that are compared; None: those of one type.
    """
    if phrase.words[0] not in OF_TWO or NOT in phrase.words or means_all(phrase) or len(landmarks[0]) < 2:
        return log_psi
    alike = np.flatnonzero(alike_by(scores))
    pairs = np.array([landmarks[int(j)][:2] for j in alike])
    gap = encoder.distances(pairs[:, 0].tolist()) + encoder.distances(pairs[:, 1].tolist()) + TOUCHING
    inside = is_between(pairs.tolist(), encoder) & encoder.layout.solid & np.isfinite(gap)
    kind = encoder.type_number if compared is None else compared.astype(np.int64)
    nearest = np.full(kind.max(initial=0) + 1, np.inf)
    np.minimum.at(nearest, np.broadcast_to(kind, gap.shape)[inside], gap[inside])
    found = log_psi.copy()
    row, thing = inside.nonzero()
    found[alike[row], thing] += np.maximum(_FARTHEST, _GAP_FOLD * np.log(nearest[kind[thing]] / gap[row, thing]))
    return found


_ACROSS, _OTHER_SIDE, _NOT_THERE = math.radians(80.0), math.radians(100.0), 2.0
"""Angles from which on a thing is not on a side, and on the other, and nats that it loses where another of its kind is
on this side; twice as many on the other side."""
_ONLY_ONE = -1.5
"""Log Psi at least of the only one of its kind on a side, however far off."""
_LESS_STRAIGHT, _NOT_FARTHER = 1.0, 2.0
"""Nats that a thing aslant loses where another is straight on that side, and at most so many times as far off."""
_SIDE_FOLD = 0.7
"""Nats for each e-fold by which a thing is farther off than the nearest on that side."""
_GAP_FOLD = 1.5
"""Nats for each e-fold by which the gap in which a thing stands between two is wider than another of theirs."""
_E_FOLD = {NEAREST: 3.0, FARTHEST: -3.0} | dict.fromkeys(NEARNESS, 1.5)
"""Nats for each e-fold of a distance, by relation."""
_FARTHEST = -6.0
"""The most that is lost."""
