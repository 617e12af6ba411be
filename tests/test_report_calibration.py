"""The calibration error against cases worked out by hand and against scikit-learn's binning."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from sklearn.calibration import calibration_curve

from dcg_torch.report.calibration import Calibration, calibrate, calibration_error


@pytest.mark.parametrize(
    ("said", "error"),
    [
        ([(1.0, True), (0.0, False)], 0.0),
        ([(1.0, False)], 1.0),
        ([(0.75, True), (0.75, True), (0.75, True), (0.75, False)], 0.0),
        # |1 - 0| + |0 - 0.25| + 2 |0.5 - 0.975|, over 4: the last two share the bin from 0.9 to 1
        ([(0.0, True), (0.25, False), (0.95, True), (1.0, False)], (1 + 0.25 + 0.95) / 4),
        # one bin each side of 0.5
        ([(0.45, True), (0.55, True)], 0.5),
    ],
)
def test_by_hand(said: list[tuple[float, bool]], error: float) -> None:
    assert calibration_error([p for p, _ in said], [c for _, c in said]) == pytest.approx(error)


def test_without_a_probability_nothing_is_compared() -> None:
    assert calibration_error([None, None], [True, False]) is None
    assert calibration_error([], []) is None
    assert calibration_error([0.8, None, None], [True, True, False]) == pytest.approx(0.2)
    assert calibrate([None], [False]) == Calibration(None, None, (), 0, 1)
    calibration = calibrate([0.85, None, 0.82, None], [True, False, False, True])
    assert (calibration.n, calibration.without) == (2, 2)
    (only,) = calibration.bins
    assert (only.low, only.high, only.n, only.accuracy) == (0.8, 0.9, 2, 0.5)
    assert only.probability == pytest.approx(0.835)


@pytest.mark.parametrize("wrong", [-0.1, 1.5, float("nan")])
def test_refuses_what_is_no_probability(wrong: float) -> None:
    with pytest.raises(ValueError, match="not between 0 and 1"):
        calibration_error([wrong], [True])
    with pytest.raises(ValueError, match="shorter"):
        calibration_error([0.5], [])


@given(st.lists(st.tuples(st.floats(0.001, 0.999), st.booleans()), min_size=1, max_size=60))
def test_bins_are_scikit_learn_s(said: list[tuple[float, bool]]) -> None:
    # Their bins are closed on the right, so what lies on a border is moved off it.
    p = np.array([x + 1e-6 if abs(10 * x - round(10 * x)) < 1e-6 else x for x, _ in said])
    right = np.array([c for _, c in said])
    shares, means = calibration_curve(right, p, n_bins=10)
    bins = calibrate(p.tolist(), right.tolist()).bins
    np.testing.assert_allclose([b.accuracy for b in bins], shares, atol=1e-9)
    np.testing.assert_allclose([b.probability for b in bins], means, atol=1e-9)
    error = sum(b.n * abs(m - s) for b, m, s in zip(bins, means, shares, strict=True)) / len(said)
    assert calibration_error(p.tolist(), right.tolist()) == pytest.approx(error, abs=1e-9)


def test_chance_is_what_a_calibrated_robot_rarely_exceeds() -> None:
    rng = np.random.default_rng(5)
    beyond = 0
    for _ in range(100):
        p = rng.beta(6, 2, size=40)
        right = rng.random(40) < p
        calibration = calibrate(p.tolist(), right.tolist())
        assert calibration.error is not None
        assert calibration.chance is not None
        beyond += calibration.error > calibration.chance
    assert 0 < beyond <= 12  # 5 % of 100, standard deviation 2.2
    # A certain robot can't miss; with more commands chance explains less.
    assert calibrate([1.0] * 9, [True] * 9).chance == 0.0
    few, many = (calibrate([0.7] * n, [True] * n).chance for n in (10, 1000))
    assert few is not None
    assert many is not None
    assert many < few / 5
