"""The fit: its objective by formula, by differences and by autograd; its optimum by other optimisers."""

from __future__ import annotations

import warnings
from typing import Any, get_args

import numpy as np
import pytest
import torch
from factors import Problem, both_settings, problems, seeds, solid_problem
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.optimize import minimize
from sklearn.linear_model import LogisticRegression

from dcg_torch.fitting.design import DesignMatrix, merge
from dcg_torch.fitting.fit import Solver, fit, objective_at
from dcg_torch.fitting.psi import BINARY, TERNARY, LogLinearFactor
from dcg_torch.fitting.reduction import reduce
from dcg_torch.fitting.rows import ArrowheadRows, GridRows, SparseRows
from dcg_torch.fitting.sparse_rows import count_firing
from dcg_torch.grounding.encoding import encode
from dcg_torch.model import GroundingModel
from dcg_torch.types import Correspondence
from dcg_torch.types.arrays import Floats

every_solver = pytest.mark.parametrize("solver", get_args(Solver))
TOLERANCE: dict[Solver, float] = {"auto": 1e-7, "newton": 1e-7, "lbfgs": 1e-7, "lbfgs-torch": 1e-5}
"""torch's line search goes by values alone, which stand still to rounding before the gradient is very small."""


def random_design(
    rng: np.random.Generator, *, phrases: int, rows: int, labels: int, columns: tuple[int, int], grid: bool = False
) -> DesignMatrix:
    """Random factors of two language columns and two grounding columns each."""
    language = rng.integers(0, columns[0], (phrases, 2))
    things = rng.integers(0, columns[1], (max(2, rows // 8) if grid else rows, 2))
    return merge(
        language,
        things[rng.integers(0, len(things), rows)],
        rng.integers(0, phrases, rows),
        rng.integers(0, labels, rows),
        np.ones(rows),
        labels,
    )


class TestObjective:
    @settings(max_examples=50)
    @given(problem=problems(), seed=seeds, l2=st.sampled_from([0.01, 1.0]))
    def test_merged_rows_sum_to_the_formula(self, problem: Problem, seed: int, l2: float) -> None:
        model = problem.model(np.random.default_rng(seed))
        value, _ = objective_at(model, [problem.design()], l2)
        assert value == pytest.approx(problem.loss(model.weight.numpy(), l2), rel=1e-10)

    @settings(max_examples=40)
    @given(problem=problems(rows=6), seed=seeds)
    def test_gradient_by_finite_differences(self, problem: Problem, seed: int) -> None:
        model = problem.model(np.random.default_rng(seed))
        _, gradient = objective_at(model, [problem.design()], 0.3)
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
        model, design = problem.model(np.random.default_rng(seed)), problem.design()
        _, gradient = objective_at(model, [design], 0.3)
        model.requires_grad_()
        log_psi = model.log_psi(design.language, design.grounding, design.phrase)
        value = 0.15 * model.weight.square().sum() - (torch.from_numpy(design.count.T) * log_psi).sum()
        (expected,) = torch.autograd.grad(value, model.weight)
        assert gradient == pytest.approx((expected * model.pairs).numpy(), abs=1e-10)


class TestRows:
    """The three ways to compute scores, of one random problem."""

    @pytest.mark.parametrize(
        ("solver", "grid", "kind"),
        [("newton", False, ArrowheadRows), ("lbfgs", False, SparseRows), ("lbfgs", True, GridRows)],
    )
    @both_settings
    @pytest.mark.parametrize("masked", [False, True])
    def test_value_and_gradient_are_those_of_the_formula(
        self, correspondences: tuple[Correspondence, ...], solver: str, grid: bool, kind: type, masked: bool
    ) -> None:
        """At weights that sum to zero over the correspondences, as those of the basis do."""
        rng = np.random.default_rng(3)
        design = random_design(rng, phrases=20, rows=90, labels=len(correspondences), columns=(6, 7), grid=grid)
        pairs = np.ones((6, 7), dtype=np.bool_)
        active = rng.random(pairs.shape) < 0.6 if masked else pairs
        strength = rng.uniform(0.5, 2.0, size=pairs.shape)
        factor = LogLinearFactor(pairs, correspondences)
        weight = rng.normal(size=(len(correspondences), 6, 7))
        fixed = np.where(active, 0.0, weight)
        weight = np.where(active, weight - weight.mean(axis=0), weight)
        reduced = reduce([design], weight, fixed, active, strength, prefer=solver)
        assert isinstance(reduced.objective.rows, kind)
        start = np.zeros_like(reduced.start) if solver == "newton" else reduced.start
        point = reduced.objective(start)
        outside = 0.5 * float((strength * fixed * fixed).sum())
        moved = reduced.weight(start)
        factor.set_weight(moved)
        value, gradient = objective_at(factor, [design], strength)
        assert point.value + reduced.constant + outside == pytest.approx(value, rel=1e-12)
        columns = reduced.columns
        assert point.norm == pytest.approx(np.abs(gradient.reshape(len(gradient), -1)[:, columns]).max(), rel=1e-9)


@pytest.mark.parametrize("labels", [2, 3])
def test_rows_written_out_that_share_too_many_weights_are_fitted_by_conjugate_gradients(labels: int) -> None:
    """Words that always come together are one variable; the optimum is that of all weights."""
    rng = np.random.default_rng(5)
    design = random_design(rng, phrases=60, rows=500, labels=labels, columns=(30, 40))
    language = np.hstack([design.language, np.where(design.language[:, :1] == 0, 30, -1)])  # beside each 0
    design = DesignMatrix(language, design.grounding, design.phrase, design.count)
    factor = LogLinearFactor(np.ones((31, 40), dtype=np.bool_), (BINARY, TERNARY)[labels - 2])
    weight = factor.weight.numpy()
    objective = reduce([design], weight, weight, np.ones((31, 40), dtype=np.bool_), np.ones((31, 40))).objective
    assert isinstance(objective.rows, SparseRows)
    point = objective(rng.normal(size=objective.strength.size * (labels - 1)))
    step = 1e-5 * rng.normal(size=point.at.shape)
    slope = objective(point.at + step).gradient - objective(point.at - step).gradient
    assert objective.product(point, step.reshape(labels - 1, -1)).reshape(-1) == pytest.approx(slope / 2.0, abs=1e-10)
    fit(factor, [design], l2=1.0)
    assert np.abs(objective_at(factor, [design], 1.0)[1]).max() < 1e-7
    assert np.array_equal(factor.weight.numpy()[:, 0], factor.weight.numpy()[:, 30])


def test_what_fires_is_counted() -> None:
    rng = np.random.default_rng(5)
    for grid in (False, True):
        designs = [random_design(rng, phrases=4, rows=9, labels=2, columns=(7, 8), grid=grid) for _ in range(2)]
        active = rng.random((7, 8)) < 0.7
        fires = {
            (left, right)
            for design in designs
            for phrase, things in zip(design.phrase, design.grounding, strict=True)
            for left in design.language[phrase]
            for right in things
            if left >= 0 and right >= 0 and active[left, right]
        }
        assert 5 < count_firing(designs, active) == len(fires) < 56


class TestFit:
    @settings(max_examples=10)
    @given(problem=problems(), seed=seeds, solver=st.sampled_from(["newton", "lbfgs", "auto"]))
    def test_two_starts_reach_one_optimum(self, problem: Problem, seed: int, solver: Solver) -> None:
        """The objective is l2-strongly convex: |w - w'| <= (|g| + |g'|) / l2, in Euclidean norm."""
        l2, rng, designs = 0.1, np.random.default_rng(seed), [problem.design()]
        ends = []
        for start in (problem.model(rng), problem.model(rng)):
            result = fit(start, designs, l2=l2, solver=solver)
            assert result.status == "converged"
            _, gradient = objective_at(start, designs, l2)
            ends.append((start.weight.numpy(), float(np.linalg.norm(gradient))))
        (one, g1), (other, g2) = ends
        assert float(np.linalg.norm(one - other)) <= (g1 + g2) / l2 + 1e-9
        assert np.abs(one - other).max() < 1e-5

    @every_solver
    def test_two_starts_on_the_initial_training_set(self, trained: GroundingModel, solver: Solver) -> None:
        designs = encode(
            trained.learner.training_examples(trained.features), trained.features, trained.factor.correspondences
        )
        ends = []
        for seed in (1, 2):
            model = LogLinearFactor(trained.features.pairs)
            model.set_weight(np.random.default_rng(seed).normal(size=model.weight.shape) * trained.features.pairs)
            found = fit(
                model, designs, l2=trained.variant.l2, max_steps=2_000, solver=solver, tolerance=TOLERANCE[solver]
            )
            assert found.status == "converged"
            assert np.abs(objective_at(model, designs, trained.variant.l2)[1]).max() <= 1.01 * TOLERANCE[solver]
            ends.append(model.weight.numpy())
        assert np.abs(ends[0] - ends[1]).max() < 100 * TOLERANCE[solver]

    @both_settings
    def test_scikit_learn_agrees(self, correspondences: tuple[Correspondence, ...]) -> None:
        """Multinomial logistic regression on the features written out.

        With two classes it has one weight vector, the difference of ours: w = 2 w_active, whose penalty is
        l2 / 2 (2 |w / 2|^2) = l2 / 4 |w|^2, so C = 2 / l2 instead of 1 / l2.
        """
        problem, l2 = solid_problem(correspondences), 0.2
        model = problem.model()
        fit(model, [problem.design()], l2=l2)
        labels = np.array([label for _, _, label, _ in problem.rows])
        scale = 2.0 if len(correspondences) == 2 else 1.0
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", FutureWarning)
            other: Any = LogisticRegression(C=scale / l2, fit_intercept=False, tol=1e-10, max_iter=5_000)
            other.fit(problem.products(), labels)
        ours = model.weight.numpy().reshape(len(correspondences), -1)
        expected = np.concatenate([-other.coef_ / 2, other.coef_ / 2]) if len(correspondences) == 2 else other.coef_
        assert ours == pytest.approx(expected, abs=1e-5)

    @both_settings
    def test_scipy_agrees(self, correspondences: tuple[Correspondence, ...]) -> None:
        """Minimising the formula itself, with differences for a gradient."""
        problem, l2 = solid_problem(correspondences, seed=3, rows=30), 0.5
        model = problem.model()
        result = fit(model, [problem.design()], l2=l2)
        free = np.argwhere(np.broadcast_to(problem.pairs, problem.shape))

        def loss(values: Floats) -> float:
            weight = np.zeros(problem.shape)
            weight[tuple(free.T)] = values
            return problem.loss(weight, l2)

        other = minimize(loss, np.zeros(len(free)), method="L-BFGS-B", options={"maxiter": 60, "maxfun": 20_000})
        assert result.value == pytest.approx(other.fun, abs=1e-5)
        assert result.value <= other.fun + 1e-9

    @pytest.mark.parametrize("grid", [False, True])
    @both_settings
    def test_the_solvers_agree_on_many_rows(self, correspondences: tuple[Correspondence, ...], grid: bool) -> None:
        """To 1e-6 in log-probabilities, where `auto` writes no row out."""
        rng = np.random.default_rng(0)
        shape, labels = (12, 16), len(correspondences)
        design = random_design(rng, phrases=40, rows=3_000, labels=labels, columns=shape, grid=grid)
        found = []
        for solver in get_args(Solver):
            model = LogLinearFactor(np.ones(shape, dtype=np.bool_), correspondences)
            result = fit(model, [design], l2=0.3, solver=solver, max_steps=3_000, tolerance=TOLERANCE[solver])
            assert result.status == "converged", solver
            assert result.gradient == pytest.approx(np.abs(objective_at(model, [design], 0.3)[1]).max(), abs=1e-9)
            found.append(model.log_psi(design.language, design.grounding, design.phrase).numpy())
        for solver, other in zip(get_args(Solver), found, strict=True):
            assert other == pytest.approx(found[0], abs=10 * TOLERANCE[solver])

    @every_solver
    def test_what_is_not_free_stays_and_the_rest_is_optimal(self, solver: Solver) -> None:
        rng = np.random.default_rng(0)
        design = random_design(rng, phrases=12, rows=60, labels=2, columns=(4, 5))
        free = rng.random((4, 5)) < 0.5
        model = LogLinearFactor(np.ones((4, 5), dtype=np.bool_), BINARY)
        model.set_weight(rng.normal(size=(2, 4, 5)))
        before = model.weight.numpy().copy()
        found = fit(model, [design], l2=0.1, free=free, solver=solver, tolerance=TOLERANCE[solver])
        assert found.status == "converged"
        after = model.weight.numpy()
        assert np.array_equal(after[:, ~free], before[:, ~free])
        value, gradient = objective_at(model, [design], 0.1)
        constant = 0.5 * 0.1 * float((before[:, ~free] ** 2).sum())
        assert found.value + constant == pytest.approx(value, rel=1e-12)
        assert np.abs(gradient[:, free]).max() <= 1.01 * TOLERANCE[solver]
        assert np.abs(gradient[:, ~free]).max() > 1e-2

    @every_solver
    def test_a_penalty_of_each_weight_around_a_prior(self, solver: Solver) -> None:
        rng = np.random.default_rng(7)
        problem = solid_problem(TERNARY)
        l2, prior = rng.uniform(0.05, 2.0, size=problem.pairs.shape), rng.normal(size=problem.shape) * problem.pairs
        model = problem.model()
        found = fit(model, [problem.design()], l2=l2, prior=prior, solver=solver, tolerance=TOLERANCE[solver])
        value, gradient = objective_at(model, [problem.design()], l2, prior)
        assert found.status == "converged"
        assert np.abs(gradient).max() <= 1.01 * TOLERANCE[solver]
        assert found.value == pytest.approx(value, rel=1e-12)

    def test_free_weights_that_fire_nowhere_become_their_prior(self) -> None:
        problem = Problem(BINARY, np.ones((2, 2), dtype=np.bool_), [[0]], [(0, [0], 1, 3.0)])
        prior = np.full(problem.shape, 0.25)
        model = problem.model(np.random.default_rng(0))
        fit(model, [problem.design()], l2=1.0, prior=prior)
        assert (model.weight.numpy()[:, 1, :] == 0.25).all()
        assert model.weight[1, 0, 0] > 0.25 > model.weight[0, 0, 0]

    @given(problem=problems(), seed=seeds)
    def test_weights_outside_the_pairs_stay_zero(self, problem: Problem, seed: int) -> None:
        model = problem.model(np.random.default_rng(seed))
        fit(model, [problem.design()], l2=0.1)
        assert not model.weight[:, ~model.pairs].any()

    def test_words_with_the_same_history_get_the_same_weights(self) -> None:
        """Eight nouns, each said once of its own type and of no other: two classes of weights among 64."""
        rows = [(noun, [kind], int(noun == kind), 1.0) for noun in range(8) for kind in range(8)]
        problem = Problem(BINARY, np.ones((8, 8), dtype=np.bool_), [[noun] for noun in range(8)], rows)
        model, alone = problem.model(), problem.model()
        result = fit(model, [problem.design()], l2=0.1)
        assert result.rows == 2
        assert len(np.unique(model.weight[1].numpy())) == 2
        fit(alone, [problem.design()], l2=0.1, solver="lbfgs")
        assert model.weight.numpy() == pytest.approx(alone.weight.numpy(), abs=1e-6)

    @every_solver
    def test_result(self, solver: Solver) -> None:
        problem = solid_problem(TERNARY)
        model, designs = problem.model(), [problem.design()]
        before, _ = objective_at(model, designs, 0.1)
        result = fit(model, designs, l2=0.1, solver=solver, tolerance=TOLERANCE[solver])
        value, gradient = objective_at(model, designs, 0.1)
        assert result.value == pytest.approx(value, rel=1e-12)
        assert result.gradient == pytest.approx(np.abs(gradient).max(), abs=1e-10)
        assert result.rows > 0
        assert 0 < result.steps <= result.evaluations
        assert result.seconds > 0
        assert result.status == "converged"
        assert result.value < before

    @every_solver
    def test_a_fit_that_is_cut_short_says_so(self, solver: Solver) -> None:
        problem = solid_problem(TERNARY)
        result = fit(problem.model(), [problem.design()], l2=0.1, tolerance=1e-12, max_steps=2, solver=solver)
        assert (result.status, result.steps) == ("step limit", 2)

    @every_solver
    def test_a_warm_start_is_only_faster(self, solver: Solver) -> None:
        problem = solid_problem(TERNARY)
        model, designs = problem.model(), [problem.design()]
        cold = fit(model, designs, l2=0.1, solver=solver, tolerance=TOLERANCE[solver])
        warm = fit(model, designs, l2=0.1, solver=solver, tolerance=TOLERANCE[solver])
        assert warm.steps <= 1 < cold.steps
        assert warm.value == pytest.approx(cold.value, rel=1e-9)

    def test_nothing_to_fit(self) -> None:
        model = LogLinearFactor(np.zeros((2, 3), dtype=np.bool_))
        problem = Problem(TERNARY, np.zeros((2, 3), dtype=np.bool_), [[0]], [(0, [1], 2, 2.0)])
        for designs in ([problem.design()], []):
            assert fit(model, designs, l2=0.1).status == "converged"

    @pytest.mark.parametrize("l2", [0.0, -1.0])
    def test_without_a_penalty_refused(self, l2: float) -> None:
        problem = solid_problem(BINARY)
        with pytest.raises(ValueError, match="l2 must be positive"):
            fit(problem.model(), [problem.design()], l2=l2)
