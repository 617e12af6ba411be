"""Who is near, and who is nearer than others: by degrees, beside what is learned of the nearest."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from dcg_torch.grounding.encode import WorldEncoder
from dcg_torch.grounding.reach import NEARNESS, TOUCHING, by_distance, nearer_on_a_side
from dcg_torch.scene.order import numbered

Floats = NDArray[np.float64]
Bools = NDArray[np.bool_]


def by_nearness(
    name: str,
    log_psi: Floats,
    landmarks: Sequence[int],
    scores: Floats,
    compared: Bools | None,
    encoder: WorldEncoder,
) -> Floats:
    """(combos, things) of a modifier to one landmark, with what is measured of distances.

    Args:
        name: of the relation.
        log_psi: what is learned.
        landmarks, scores: (combos,) number of each, and its score.
        compared: (things,) those that are compared; None: those of one type.
    """
    log_psi = nearly_as_near(name, log_psi, landmarks, compared, encoder)
    log_psi = log_psi + by_distance(name, landmarks, scores, compared, encoder)
    nearer = nearer_on_a_side(name, landmarks, compared, encoder)
    return log_psi if nearer is None else log_psi + nearer


def nearly_as_near(
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
    kind = numbered([o.type for o in encoder.all]) if compared is None else compared.astype(np.int64)
    of_each = kind + (kind.max(initial=0) + 1) * np.arange(len(gap))[:, None]
    nearest, best = (np.full(of_each.max(initial=0) + 1, end) for end in (np.inf, -np.inf))
    np.minimum.at(nearest, of_each, gap)
    first = np.isfinite(gap) & (gap <= nearest[of_each])
    np.maximum.at(best, of_each[first], log_psi[first])
    with np.errstate(invalid="ignore"):
        behind = np.where(np.isfinite(gap), _NEARLY * np.log(gap / nearest[of_each]), np.inf)
    found: Floats = np.maximum(log_psi, best[of_each] - behind)
    return found


_NEARLY = 9.0
"""Nats that a thing loses at most for each e-fold by which it is farther than the nearest of its kind."""
