"""95 % intervals: Wilson's for shares, Student's for means over trials, a jackknife over trials for slopes."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from statistics import NormalDist

import numpy as np

from dcg_torch.types.arrays import Floats

LEVEL = 0.95
_Z = NormalDist().inv_cdf(0.5 + LEVEL / 2)


@dataclass(frozen=True, slots=True)
class Estimate:
    """A value and its 95 % interval; the bounds are None where there is too little to tell them from."""

    value: float
    low: float | None = None
    high: float | None = None


def wilson(correct: int, n: int) -> Estimate:
    """Share `correct / n` with Wilson's score interval.

    Raises:
        ValueError: unless 0 <= correct <= n and n >= 1.
    """
    if not (n >= 1 and 0 <= correct <= n):
        raise ValueError(f"{correct} of {n} is not a share; need 0 <= correct <= n and n >= 1")
    share = correct / n
    centre = (share + _Z**2 / (2 * n)) / (1 + _Z**2 / n)
    half = _Z * math.sqrt(share * (1 - share) / n + _Z**2 / (4 * n**2)) / (1 + _Z**2 / n)
    # At the ends the exact bounds are 0 and 1; rounding must not leave them just inside.
    low = 0.0 if correct == 0 else max(0.0, centre - half)
    high = 1.0 if correct == n else min(1.0, centre + half)
    return Estimate(share, low, high)


def mean_over_trials(values: Sequence[float]) -> Estimate:
    """Mean of one value per trial with Student's t interval; without bounds for a single trial.

    Raises:
        ValueError: without values.
    """
    if not values:
        raise ValueError("no values to average")
    n = len(values)
    mean = math.fsum(values) / n
    if n == 1:
        return Estimate(mean)
    variance = math.fsum((v - mean) ** 2 for v in values) / (n - 1)
    half = student_quantile(n - 1) * math.sqrt(variance / n)
    return Estimate(mean, mean - half, mean + half)


def slope_over_trials(trials: Sequence[tuple[Sequence[float], Sequence[float]]]) -> Estimate | None:
    """Least-squares slope of y on x, pooled over trials given as pairs (x, y).

    The interval is a delete-one-trial jackknife, since commands of one trial depend on each other. None where x does
    not vary; without bounds where x stops varying once a trial is left out.
    """
    # sums[t] = n, sum x, sum y, sum x^2, sum xy of trial t: leaving a trial out is then a subtraction.
    sums = np.array(
        [
            [len(x), sum(x), sum(y), sum(a * a for a in x), sum(a * b for a, b in zip(x, y, strict=True))]
            for x, y in trials
        ],
        dtype=np.float64,
    ).reshape(-1, 5)
    total = sums.sum(axis=0)
    full = _slopes(total[None, :])
    if full is None:
        return None
    value = float(full[0])
    count = len(sums)
    without = _slopes(total - sums) if count > 1 else None
    if without is None:
        return Estimate(value)
    spread = math.sqrt((count - 1) / count * float(((without - without.mean()) ** 2).sum()))
    half = student_quantile(count - 1) * spread
    return Estimate(value, value - half, value + half)


def _slopes(sums: Floats) -> Floats | None:
    n, x, y, xx, xy = sums.T
    varying = n * xx - x * x
    if (varying <= 1e-9 * np.maximum(1.0, n * xx)).any():
        return None
    slopes: Floats = (n * xy - x * y) / varying
    return slopes


def student_quantile(freedom: int) -> float:
    """The t with P(|T| <= t) = 0.95 for `freedom` degrees of freedom, at least 1."""
    from scipy.special import stdtrit  # here: a run of one trial needs none, and it takes a tenth of a second to import

    return float(stdtrit(freedom, 0.5 + LEVEL / 2))
