"""How far a thing is from the size that is said: "the large one", "the tiny black specks", "of medium size"."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np

from dcg_torch.grounding.encoding import WorldEncoder
from dcg_torch.scene.bodies import bulk
from dcg_torch.types.arrays import Bools, Floats

_SAME_SIZE = 0.05
"""Logarithms of volumes that differ by less are equal."""
_LIKE_SIZES = 0.15
"""Sizes that differ by no more than this share of the differences among all of a kind are not told apart."""
_UNLIKE_SIZES = 0.5
"""Those that differ by so much are as unlike as can be, and by less the less."""


def size_deviation(sides: Sequence[int], encoder: WorldEncoder, *sets: Bools) -> Floats | None:
    """(things,) from 0 to 1: how far a thing is from the largest (1), smallest (-1) or mean size (0) that is said.

    Args:
        sets: (things,) the first of them that has several sizes is what is compared; the last is all of a kind.

    Returns:
        The largest of the distances, 0 for what has no size; None where all are of one size.
    """
    sizes = [math.nan if o.size is None else bulk(o.size) for o in encoder.world.objects]
    logs = np.log([v if v > 0.0 else math.nan for v in sizes])
    differ = [
        float(np.ptp(logs[own])) if (own := among[: len(logs)] & np.isfinite(logs)).any() else 0.0 for among in sets
    ]
    least = 2 if 0 in sides else 1  # of two none is of medium size
    for among in (*sets, encoder.perceived) if 0 in sides else sets:
        known = logs[among[: len(logs)] & np.isfinite(logs)]
        if len(known) > least and np.ptp(known) > max(_SAME_SIZE, _LIKE_SIZES * differ[-1]):
            place = np.clip((logs - known.min()) / np.ptp(known), 0.0, 1.0)
            wide = np.expm1((logs - known.min()) / 3.0) / np.expm1(np.ptp(known) / 3.0)
            short = 1.0 - np.clip(np.minimum(place, wide), 0.0, 1.0)
            off = [2.0 * np.abs(place - 0.5) if not side else short if side > 0 else place for side in sides]
            told = min(1.0, float(np.ptp(known)) / max(_UNLIKE_SIZES * differ[-1], _SAME_SIZE))
            return np.pad(told * np.nan_to_num(np.max(off, axis=0)), (0, len(encoder.all) - len(logs)))
    return None
