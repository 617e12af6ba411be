"""The log-linear factor by its formula, its gradient by differences, its fit by other optimisers."""

from __future__ import annotations

import math
import warnings
from dataclasses import dataclass
from itertools import pairwise
from typing import Any

import numpy as np
import pytest
import torch
from hypothesis import given, settings
from hypothesis import strategies as st
from numpy.typing import NDArray
from scipy.optimize import minimize
from sklearn.linear_model import LogisticRegression

from dcg_torch.grounding.psi import BINARY, TERNARY, LogLinearModel, Table, fit, objective, tabulate
from dcg_torch.model import GroundingModel, TrainingSet, encode
from dcg_torch.types import Correspondence

both_settings = pytest.mark.parametrize("correspondences", [BINARY, TERNARY], ids=["binary", "ternary"])


@dataclass(frozen=True)
class Problem:
    """Labelled factors as lists of what fires: the phrases, and (phrase, grounding, label, weight) of each factor."""

    correspondences: tuple[Correspondence, ...]
    pairs: NDArray[np.bool_]
    phrases: list[list[int]]
    rows: list[tuple[int, list[int], int, float]]

    @property
    def shape(self) -> tuple[int, int, int]:
        languages, groundings = self.pairs.shape
        return len(self.correspondences), languages, groundings

    def model(self, rng: np.random.Generator | None = None) -> LogLinearModel:
        """A model of zero weights, or of random ones where there are features."""
        model = LogLinearModel(self.pairs, self.correspondences)
        if rng is not None:
            model.weight = torch.from_numpy(rng.normal(size=self.shape) * self.pairs)
        return model

    def table(self) -> Table:
        return tabulate(
            bag(self.phrases),
            bag([grounding for _, grounding, _, _ in self.rows]),
            np.array([phrase for phrase, _, _, _ in self.rows]),
            np.array([label for _, _, label, _ in self.rows]),
            np.array([weight for _, _, _, weight in self.rows]),
            self.shape,
        )

    def products(self) -> NDArray[np.float64]:
        """(n, L * G): each factor's features written out, without those that `pairs` leaves out."""
        out = np.zeros((len(self.rows), *self.pairs.shape))
        for row, (phrase, grounding, _, _) in zip(out, self.rows, strict=True):
            for left in self.phrases[phrase]:
                for right in grounding:
                    row[left, right] = self.pairs[left, right]
        return out.reshape(len(self.rows), -1)

    def loss(self, weight: NDArray[np.float64], l2: float) -> float:
        """The objective as its formula stands, a factor at a time."""
        terms = []
        for phrase, grounding, label, count in self.rows:
            ones = [(left, right) for left in set(self.phrases[phrase]) for right in set(grounding)]
            scores = [math.fsum(float(w[left, right]) for left, right in ones) for w in weight]
            terms.append(count * (math.log(math.fsum(map(math.exp, scores))) - scores[label]))
        return math.fsum(terms) + 0.5 * l2 * math.fsum(float(w) ** 2 for w in weight.flat)


def bag(rows: list[list[int]]) -> NDArray[np.int64]:
    width = max(map(len, rows), default=0)
    return np.array([[*row, *[-1] * (width - len(row))] for row in rows], dtype=np.int64).reshape(len(rows), width)


@st.composite
def problems(draw: st.DrawFn, *, rows: int = 12) -> Problem:
    languages, groundings = draw(st.integers(1, 4)), draw(st.integers(1, 5))
    correspondences = draw(st.sampled_from([BINARY, TERNARY]))
    pairs = np.array(draw(st.lists(st.booleans(), min_size=languages * groundings, max_size=languages * groundings)))
    phrases = draw(st.lists(st.lists(st.integers(0, languages - 1), max_size=4), min_size=1, max_size=4))
    factor = st.tuples(
        st.integers(0, len(phrases) - 1),
        st.lists(st.integers(0, groundings - 1), max_size=4),
        st.integers(0, len(correspondences) - 1),
        st.sampled_from([0.5, 1.0, 3.0]),
    )
    return Problem(
        correspondences,
        pairs.reshape(languages, groundings),
        phrases,
        draw(st.lists(factor, min_size=1, max_size=rows)),
    )


seeds = st.integers(0, 2**32)


def solid_problem(correspondences: tuple[Correspondence, ...], seed: int = 0, rows: int = 60) -> Problem:
    """Enough random factors that every label occurs and the optimum is far from zero."""
    rng = np.random.default_rng(seed)
    pairs = rng.random((4, 5)) < 0.8
    phrases = [sorted(rng.choice(4, size=2, replace=False).tolist()) for _ in range(5)]
    factors = [
        (int(rng.integers(5)), sorted(rng.choice(5, size=2, replace=False).tolist()), k % len(correspondences), 1.0)
        for k in range(rows)
    ]
    return Problem(correspondences, pairs, phrases, factors)


class TestLogPsi:
    @settings(max_examples=60)
    @given(problem=problems(), seed=seeds)
    def test_is_the_formula(self, problem: Problem, seed: int) -> None:
        """A column that is named twice is still one feature."""
        model = problem.model(np.random.default_rng(seed))
        found = model.log_psi(
            bag(problem.phrases), bag([g for _, g, _, _ in problem.rows]), np.array([p for p, _, _, _ in problem.rows])
        ).numpy()
        assert np.exp(found).sum(axis=1) == pytest.approx(1.0)
        weight = model.weight.numpy()
        for row, (phrase, grounding, _, _) in zip(found, problem.rows, strict=True):
            ones = [(left, right) for left in set(problem.phrases[phrase]) for right in set(grounding)]
            scores = [math.fsum(float(w[left, right]) for left, right in ones) for w in weight]
            total = math.log(math.fsum(map(math.exp, scores)))
            assert row == pytest.approx([s - total for s in scores], abs=1e-12)

    @both_settings
    def test_equal_factors_are_equal_to_the_bit(self, correspondences: tuple[Correspondence, ...]) -> None:
        """Wherever they stand among others, or a tie would not be one."""
        rng = np.random.default_rng(5)
        model = LogLinearModel(np.ones((3, 4), dtype=np.bool_), correspondences)
        for copies in [*range(2, 90)] * 4:
            model.weight = torch.from_numpy(rng.normal(size=model.weight.shape) * rng.choice([0.1, 1.0, 5.0]))
            rows = model.log_psi(bag([[0, 2]]), bag([[1, 3]] * copies), np.zeros(copies, dtype=np.int64)).numpy()
            assert (rows == rows[0]).all()

    @both_settings
    def test_a_new_model_knows_nothing(self, correspondences: tuple[Correspondence, ...]) -> None:
        model = LogLinearModel(np.ones((2, 3), dtype=np.bool_), correspondences)
        rows = model.log_psi(bag([[0, 1]]), bag([[2], []]), np.array([0, 0]))
        assert rows.exp().numpy() == pytest.approx(np.full((2, len(correspondences)), 1 / len(correspondences)))

    def test_extreme_weights_stay_finite(self) -> None:
        model = LogLinearModel(np.ones((1, 1), dtype=np.bool_), BINARY)
        model.weight[1] = 5_000.0
        row = model.log_psi(bag([[0]]), bag([[0]]), np.array([0])).tolist()[0]
        assert row == [-5_000.0, 0.0]


class TestObjective:
    @settings(max_examples=50)
    @given(problem=problems(), seed=seeds, l2=st.sampled_from([0.01, 1.0]))
    def test_merged_rows_sum_to_the_formula(self, problem: Problem, seed: int, l2: float) -> None:
        model = problem.model(np.random.default_rng(seed))
        value, _ = objective(model.weight, [problem.table()], model.pairs, l2)
        assert float(value) == pytest.approx(problem.loss(model.weight.numpy(), l2), rel=1e-10)

    @given(problem=problems(), seed=seeds, data=st.data())
    def test_the_split_into_tables_does_not_matter(self, problem: Problem, seed: int, data: st.DataObject) -> None:
        cut = data.draw(st.integers(1, len(problem.rows)))
        parts = [
            Problem(problem.correspondences, problem.pairs, problem.phrases, rows).table()
            for rows in (problem.rows[:cut], problem.rows[cut:])
            if rows
        ]
        model = problem.model(np.random.default_rng(seed))
        one = objective(model.weight, [problem.table()], model.pairs, 0.1)
        several = objective(model.weight, parts, model.pairs, 0.1)
        assert float(several[0]) == pytest.approx(float(one[0]), rel=1e-10)
        assert several[1].numpy() == pytest.approx(one[1].numpy(), abs=1e-10)

    def test_identical_factors_are_merged(self) -> None:
        """[0, 1] and [1, 0] are one factor; a third of its examples weighs three."""
        rows = [(0, [0, 1], 1, 1.0), (0, [1, 0], 1, 2.0), (0, [0, 1], 0, 4.0), (1, [0, 1], 1, 8.0), (0, [1], 1, 16.0)]
        # Phrases 0 and 2 fire the same columns.
        problem = Problem(BINARY, np.ones((2, 2), dtype=np.bool_), [[0], [0, 1], [0]], [*rows, (2, [0, 1], 1, 32.0)])
        counts = sorted(tuple(c) for c in problem.table().count.T.tolist())
        assert counts == [(0.0, 8.0), (0.0, 16.0), (4.0, 35.0)]

    @settings(max_examples=40)
    @given(problem=problems(rows=6), seed=seeds)
    def test_gradient_by_finite_differences(self, problem: Problem, seed: int) -> None:
        model = problem.model(np.random.default_rng(seed))
        _, gradient = objective(model.weight, [problem.table()], model.pairs, 0.3)
        weight, step = model.weight.numpy(), 1e-5
        for at in np.ndindex(*weight.shape):
            if not problem.pairs[at[1:]]:
                assert gradient[at] == 0.0
                continue
            up, down = weight.copy(), weight.copy()
            up[at] += step
            down[at] -= step
            slope = (problem.loss(up, 0.3) - problem.loss(down, 0.3)) / (2 * step)
            assert float(gradient[at]) == pytest.approx(slope, abs=1e-6)

    @given(problem=problems(), seed=seeds)
    def test_gradient_by_autograd(self, problem: Problem, seed: int) -> None:
        model, table = problem.model(np.random.default_rng(seed)), problem.table()
        weight = model.weight.clone().requires_grad_()
        value, gradient = objective(weight, [table], model.pairs, 0.3)
        (expected,) = torch.autograd.grad(value, weight)
        assert gradient.detach().numpy() == pytest.approx((expected * model.pairs).numpy(), abs=1e-10)

    def test_gradcheck_of_the_value(self) -> None:
        problem = solid_problem(TERNARY)
        table, pairs = problem.table(), torch.from_numpy(problem.pairs)
        weight = problem.model(np.random.default_rng(1)).weight.requires_grad_()
        assert torch.autograd.gradcheck(lambda w: objective(w, [table], pairs, 0.1)[0], (weight,))


class TestFit:
    @settings(max_examples=10)
    @given(problem=problems(), seed=seeds)
    def test_two_starts_reach_one_optimum(self, problem: Problem, seed: int) -> None:
        """The objective is l2-strongly convex: |w - w'| <= (|g| + |g'|) / l2, in Euclidean norm."""
        l2, rng, tables = 0.1, np.random.default_rng(seed), [problem.table()]
        ends = []
        for start in (problem.model(rng), problem.model(rng)):
            result = fit(start, tables, l2=l2, tolerance=1e-6)
            _, gradient = objective(start.weight, tables, start.pairs, l2)
            ends.append((start.weight, float(gradient.norm()), result))
        (one, g1, r1), (other, g2, r2) = ends
        assert r1.status == r2.status == "converged"
        assert float((one - other).norm()) <= (g1 + g2) / l2 + 1e-12
        assert (one - other).abs().max() < 1e-3
        assert r1.value == pytest.approx(r2.value, abs=1e-8)

    def test_two_starts_on_the_initial_training_set(self, training: TrainingSet, trained: GroundingModel) -> None:
        tables = encode(trained.examples, trained.features, trained.loglinear)
        ends = []
        for seed in (1, 2):
            model = LogLinearModel(trained.features.pairs)
            model.weight = torch.from_numpy(np.random.default_rng(seed).normal(size=model.weight.shape)) * model.pairs
            assert fit(model, tables, l2=trained.variant.l2, tolerance=1e-9, max_steps=2_000).status == "converged"
            ends.append(model.weight)
        assert (ends[0] - ends[1]).abs().max() < 1e-4

    @both_settings
    def test_scikit_learn_agrees(self, correspondences: tuple[Correspondence, ...]) -> None:
        """Multinomial logistic regression on the features written out.

        With two classes it has one weight vector, the difference of ours: w = 2 w_active, whose penalty is
        l2 / 2 (2 |w / 2|^2) = l2 / 4 |w|^2, so C = 2 / l2 instead of 1 / l2.
        """
        problem, l2 = solid_problem(correspondences), 0.2
        model = problem.model()
        fit(model, [problem.table()], l2=l2, tolerance=1e-10)
        labels = np.array([label for _, _, label, _ in problem.rows])
        scale = 2.0 if len(correspondences) == 2 else 1.0
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", FutureWarning)
            other: Any = LogisticRegression(C=scale / l2, fit_intercept=False, tol=1e-10, max_iter=5_000)
            other.fit(problem.products(), labels)
        ours = model.weight.numpy().reshape(len(correspondences), -1)
        expected = np.concatenate([-other.coef_ / 2, other.coef_ / 2]) if len(correspondences) == 2 else other.coef_
        assert ours == pytest.approx(expected, abs=1e-4)

    @both_settings
    def test_scipy_agrees(self, correspondences: tuple[Correspondence, ...]) -> None:
        """Minimising the formula itself, with differences for a gradient."""
        problem, l2 = solid_problem(correspondences, seed=3, rows=30), 0.5
        model = problem.model()
        result = fit(model, [problem.table()], l2=l2, tolerance=1e-10)
        free = np.argwhere(np.broadcast_to(problem.pairs, problem.shape))

        def loss(values: NDArray[np.float64]) -> float:
            weight = np.zeros(problem.shape)
            weight[tuple(free.T)] = values
            return problem.loss(weight, l2)

        start = np.zeros(len(free))
        other = minimize(loss, start, method="L-BFGS-B", options={"maxiter": 60, "maxfun": 20_000})
        assert result.value == pytest.approx(other.fun, abs=1e-5)
        assert result.value <= other.fun + 1e-9

    @given(problem=problems(), seed=seeds)
    def test_weights_outside_the_pairs_stay_zero(self, problem: Problem, seed: int) -> None:
        model = problem.model(np.random.default_rng(seed))
        fit(model, [problem.table()], l2=0.1)
        assert not model.weight[:, ~model.pairs].any()

    def test_result(self) -> None:
        problem = solid_problem(TERNARY)
        model, tables = problem.model(), [problem.table()]
        result = fit(model, tables, l2=0.1)
        value, gradient = objective(model.weight, tables, model.pairs, 0.1)
        assert result.value == float(value)
        assert result.gradient == float(gradient.abs().max())
        assert result.rows == tables[0].count.shape[1]
        assert 0 < result.steps <= result.evaluations
        assert result.seconds > 0
        assert result.status == "converged"
        assert result.value < float(objective(torch.zeros_like(model.weight), tables, model.pairs, 0.1)[0])

    def test_a_fit_that_is_cut_short_says_so(self) -> None:
        problem = solid_problem(TERNARY)
        result = fit(problem.model(), [problem.table()], l2=0.1, tolerance=1e-12, max_steps=2)
        assert (result.status, result.steps) == ("step limit", 2)

    def test_a_warm_start_is_only_faster(self) -> None:
        problem = solid_problem(TERNARY)
        model, tables = problem.model(), [problem.table()]
        cold = fit(model, tables, l2=0.1)
        warm = fit(model, tables, l2=0.1)
        assert warm.steps <= 1 < cold.steps
        assert warm.value == pytest.approx(cold.value, rel=1e-9)

    @pytest.mark.parametrize("l2", [0.0, -1.0])
    def test_without_a_penalty_refused(self, l2: float) -> None:
        problem = solid_problem(BINARY)
        with pytest.raises(ValueError, match="l2 must be positive"):
            fit(problem.model(), [problem.table()], l2=l2)


class TestGrowth:
    @settings(max_examples=50)
    @given(problem=problems(), seed=seeds, steps=st.lists(st.tuples(st.integers(0, 3), st.integers(0, 3)), max_size=5))
    def test_old_probabilities_to_the_bit(self, problem: Problem, seed: int, steps: list[tuple[int, int]]) -> None:
        rng = np.random.default_rng(seed)
        model = problem.model(rng)
        arguments = (
            bag(problem.phrases),
            bag([g for _, g, _, _ in problem.rows]),
            np.array([p for p, _, _, _ in problem.rows]),
        )
        before, old = model.log_psi(*arguments), model.weight.clone()
        pairs = problem.pairs
        for languages, groundings in steps:
            grown = rng.random((pairs.shape[0] + languages, pairs.shape[1] + groundings)) < 0.5
            grown[: pairs.shape[0], : pairs.shape[1]] = pairs
            pairs = grown
            model.grow(pairs)
            assert torch.equal(model.log_psi(*arguments), before)
        assert model.weight.shape[1:] == pairs.shape
        rows, columns = problem.pairs.shape
        assert torch.equal(model.weight[:, :rows, :columns], old)
        model.weight[:, :rows, :columns] = 0.0
        assert not model.weight.any()

    def test_new_columns_can_be_trained(self) -> None:
        problem = solid_problem(BINARY)
        model = problem.model()
        fit(model, [problem.table()], l2=0.1)
        model.grow(np.pad(problem.pairs, ((0, 1), (0, 1)), constant_values=True))
        languages, groundings = problem.pairs.shape
        grown = Problem(
            BINARY,
            model.pairs.numpy(),
            [*problem.phrases, [languages]],
            [*problem.rows, (len(problem.phrases), [groundings], 1, 5.0)],
        )
        fit(model, [grown.table()], l2=0.1)
        row = model.log_psi(bag([[languages]]), bag([[groundings]]), np.array([0])).exp().tolist()[0]
        assert row[1] > 0.8

    @pytest.mark.parametrize(
        "pairs",
        [
            np.ones((1, 3), dtype=np.bool_),
            np.ones((3, 1), dtype=np.bool_),
            np.zeros((3, 3), dtype=np.bool_),
            np.ones((2, 3), dtype=np.bool_) ^ (np.arange(6).reshape(2, 3) == 1),
        ],
        ids=["fewer rows", "fewer columns", "another mask", "a feature gone"],
    )
    def test_a_mask_that_does_not_extend_is_refused(self, pairs: NDArray[np.bool_]) -> None:
        model = LogLinearModel(np.ones((2, 2), dtype=np.bool_))
        model.weight += 1.0
        with pytest.raises(ValueError, match="does not extend"):
            model.grow(pairs)
        assert model.weight.shape == (3, 2, 2)
        assert (model.weight == 1.0).all()


def test_the_correspondences_are_those_of_the_equations() -> None:
    assert [list(map(int, c)) for c in (TERNARY, BINARY)] == [[-1, 0, 1], [0, 1]]
    assert all(a < b for c in (TERNARY, BINARY) for a, b in pairwise(c))
