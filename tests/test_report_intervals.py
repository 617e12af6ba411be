"""95 % intervals against textbook values and plain computations."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from dcg_torch.report.intervals import Estimate, mean_over_trials, slope_over_trials, student_quantile, wilson


@pytest.mark.parametrize(
    ("freedom", "quantile"),  # two-sided 95 % points as printed in tables
    [(1, 12.706), (2, 4.303), (3, 3.182), (4, 2.776), (9, 2.262), (10, 2.228), (29, 2.045), (100, 1.984), (199, 1.972)],
)
def test_student_quantile_is_the_table_s(freedom: int, quantile: float) -> None:
    assert student_quantile(freedom) == pytest.approx(quantile, abs=6e-4)


def test_student_quantile_meets_the_normal() -> None:
    assert student_quantile(200) > student_quantile(201) > student_quantile(202)
    assert student_quantile(10**9) == pytest.approx(1.959964, abs=1e-6)


def test_wilson_by_hand() -> None:
    # 8 of 10 with z = 1.96: centre (0.8 + 3.8416 / 20) / 1.38416, half 1.96 sqrt(0.016 + 3.8416 / 400) / 1.38416
    estimate = wilson(8, 10)
    centre = (0.8 + 3.8416 / 20) / 1.38416
    half = 1.96 * math.sqrt(0.016 + 3.8416 / 400) / 1.38416
    assert estimate.value == 0.8
    assert estimate.low == pytest.approx(centre - half, abs=1e-4)
    assert estimate.high == pytest.approx(centre + half, abs=1e-4)


@given(n=st.integers(1, 500), data=st.data())
def test_wilson_holds_its_value_and_mirrors(n: int, data: st.DataObject) -> None:
    correct = data.draw(st.integers(0, n))
    estimate, mirrored = wilson(correct, n), wilson(n - correct, n)
    assert estimate.low is not None
    assert estimate.high is not None
    assert mirrored.low is not None
    assert 0 <= estimate.low <= estimate.value <= estimate.high <= 1
    assert estimate.low < estimate.high
    assert estimate.high == pytest.approx(1 - mirrored.low, abs=1e-12)


@pytest.mark.parametrize(("correct", "n"), [(0, 0), (3, 2), (-1, 4)])
def test_wilson_refuses_what_is_no_share(correct: int, n: int) -> None:
    with pytest.raises(ValueError, match="not a share"):
        wilson(correct, n)


def test_mean_over_trials_by_hand() -> None:
    # mean 2, variance (1 + 0 + 1) / 2 = 1, half-width 4.303 / sqrt 3
    estimate = mean_over_trials([1.0, 2.0, 3.0])
    assert estimate.value == 2.0
    assert estimate.low == pytest.approx(2 - 4.3027 / math.sqrt(3), abs=1e-3)
    assert estimate.high == pytest.approx(2 + 4.3027 / math.sqrt(3), abs=1e-3)
    assert mean_over_trials([0.7]) == Estimate(0.7)
    with pytest.raises(ValueError, match="no values"):
        mean_over_trials([])


def test_slope_of_a_line_is_certain() -> None:
    trials = [([0, 1, 2], [1.0, 3.0, 5.0]), ([1, 3], [3.0, 7.0]), ([0, 5], [1.0, 11.0])]
    estimate = slope_over_trials(trials)
    assert estimate is not None
    assert estimate.low is not None
    assert estimate.high is not None
    assert (estimate.value, estimate.low, estimate.high) == pytest.approx((2.0, 2.0, 2.0))


def test_slope_and_jackknife_against_refitting() -> None:
    rng = np.random.default_rng(3)
    trials = [(rng.integers(3, 9, 6).tolist(), rng.integers(0, 2, 6).astype(float).tolist()) for _ in range(7)]

    def fit(some: list[tuple[list[int], list[float]]]) -> float:
        x, y = np.concatenate([t[0] for t in some]), np.concatenate([t[1] for t in some])
        return float(np.polyfit(x, y, 1)[0])

    left_out = np.array([fit(trials[:k] + trials[k + 1 :]) for k in range(7)])
    half = 2.446912 * math.sqrt(6 / 7 * ((left_out - left_out.mean()) ** 2).sum())  # t for 6 degrees of freedom
    estimate = slope_over_trials(trials)
    assert estimate is not None
    assert estimate.value == pytest.approx(fit(trials))
    assert estimate.high == pytest.approx(fit(trials) + half, abs=1e-5)


def test_no_slope_where_x_stands_still() -> None:
    assert slope_over_trials([([3, 3], [0.0, 1.0])]) is None
    assert slope_over_trials([]) is None
    # Without the second trial x would not vary: a slope, but no interval.
    assert slope_over_trials([([3, 3], [0.0, 1.0]), ([3, 4], [0.0, 1.0])]) == Estimate(2 / 3)
    assert slope_over_trials([([0, 1], [0.0, 1.0])]) == Estimate(1.0)
