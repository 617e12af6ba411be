"""Does a probability mean what it says? The one definition, for experiments and for episode files.

Predictions fall into bins of equal width by their probability; a probability of 1 belongs to the last bin. The
expected calibration error is the mean over predictions of |mean probability - share right| of the bin they are in
(Guo et al. 2017, "On Calibration of Modern Neural Networks", eq. 3).

A prediction whose probability is None stated nothing that could be compared with the outcome. It is left out of bins
and error, and counted in `Calibration.without`.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from dcg_torch.types.arrays import Floats, Ints

BINS = 10
_DRAWS = 400


@dataclass(frozen=True, slots=True)
class Bin:
    """Predictions with a probability in [low, high): their number, mean probability and share that was right."""

    low: float
    high: float
    n: int
    probability: float
    accuracy: float


@dataclass(frozen=True, slots=True)
class Calibration:
    """The reliability of `n` probabilities.

    `error` is the expected calibration error. `chance` is what a perfectly calibrated robot would stay below in 95 %
    of runs as short as this one: an error under it shows nothing. Both are None without probabilities. `bins` has
    only the bins that hold something; `without` counts the predictions without a probability.
    """

    error: float | None
    chance: float | None
    bins: tuple[Bin, ...]
    n: int
    without: int


def calibration_error(probabilities: Sequence[float | None], correct: Sequence[bool]) -> float | None:
    """The expected calibration error of predictions; see the module.

    Args:
        probabilities: from 0 to 1, or None for a prediction without one, which is left out.
        correct: whether each prediction was right; of the same length.

    Returns:
        A number from 0 to 1; None where no prediction has a probability.

    Raises:
        ValueError: if the lengths differ, or a probability is not from 0 to 1.
    """
    stated, right = _stated(probabilities, correct)
    return _error(stated, right) if stated.size else None


def calibrate(probabilities: Sequence[float | None], correct: Sequence[bool]) -> Calibration:
    """Bins, error and what chance alone would give; arguments and errors as for `calibration_error`."""
    stated, right = _stated(probabilities, correct)
    without = len(probabilities) - stated.size
    if not stated.size:
        return Calibration(None, None, (), 0, without)
    which = _bin_of(stated)
    bins = tuple(
        Bin(k / BINS, (k + 1) / BINS, int(inside.sum()), float(stated[inside].mean()), float(right[inside].mean()))
        for k in range(BINS)
        if (inside := which == k).any()
    )
    return Calibration(_error(stated, right), _by_chance(stated), bins, stated.size, without)


def _by_chance(stated: Floats) -> float:
    """The 95 % quantile of the error if every outcome were drawn with its own probability."""
    rng = np.random.default_rng(0)  # the same rows give the same report
    errors = [_error(stated, (rng.random(stated.size) < stated).astype(np.float64)) for _ in range(_DRAWS)]
    return float(np.quantile(errors, 0.95))


def _stated(probabilities: Sequence[float | None], correct: Sequence[bool]) -> tuple[Floats, Floats]:
    # Sorted, so that the order of the predictions changes no bit of a sum.
    pairs = sorted((p, c) for p, c in zip(probabilities, correct, strict=True) if p is not None)
    stated = np.array([p for p, _ in pairs], dtype=np.float64)
    if not ((stated >= 0) & (stated <= 1 + 1e-9)).all():
        raise ValueError("a probability is not between 0 and 1")
    return stated, np.array([c for _, c in pairs], dtype=np.float64)


def _bin_of(stated: Floats) -> Ints:
    return np.minimum((stated * BINS).astype(np.int64), BINS - 1)


def _error(stated: Floats, right: Floats) -> float:
    apart = np.bincount(_bin_of(stated), weights=stated - right, minlength=BINS)
    return float(np.abs(apart).sum() / stated.size)
