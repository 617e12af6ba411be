"""95 % intervals: Wilson's for shares, Student's for means over trials, a jackknife over trials for slopes."""

from __future__ import annotations

import functools
import math
from collections.abc import Sequence
from dataclasses import dataclass
from statistics import NormalDist

import numpy as np
from numpy.typing import NDArray

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


def _slopes(sums: NDArray[np.float64]) -> NDArray[np.float64] | None:
    n, x, y, xx, xy = sums.T
    varying = n * xx - x * x
    if (varying <= 1e-9 * np.maximum(1.0, n * xx)).any():
        return None
    slopes: NDArray[np.float64] = (n * xy - x * y) / varying
    return slopes


@functools.cache
def student_quantile(freedom: int) -> float:
    """The t with P(|T| <= t) = 0.95 for `freedom` degrees of freedom.

    Bisection on the finite series for whole degrees of freedom (Abramowitz and Stegun, 26.7.3 and 26.7.4), so that
    the report needs no statistics package. Beyond 200 degrees it uses their expansion 26.7.5, good to 1e-7 there.
    """
    if freedom < 1:
        raise ValueError(f"need at least 1 degree of freedom, not {freedom}")
    if freedom > 200:
        z = _Z
        return z + (z**3 + z) / (4 * freedom) + (5 * z**5 + 16 * z**3 + 3 * z) / (96 * freedom**2)
    low, high = 0.0, 13.0  # 12.71 at one degree of freedom is the largest
    for _ in range(60):
        middle = (low + high) / 2
        low, high = (middle, high) if _student_inside(middle, freedom) < LEVEL else (low, middle)
    return (low + high) / 2


def _student_inside(t: float, freedom: int) -> float:
    """P(|T| <= t)."""
    angle = math.atan(t / math.sqrt(freedom))
    odd = freedom % 2
    term, series = math.cos(angle) ** odd, 0.0
    for power in range(odd, freedom - 1, 2):
        series += term
        term *= math.cos(angle) ** 2 * (power + 1) / (power + 2)
    inside = math.sin(angle) * series
    return 2 / math.pi * (angle + inside) if odd else inside
