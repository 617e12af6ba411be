"""The log-linear factor: by its formula, to the bit where bits matter, as a module of torch, as it grows."""

from __future__ import annotations

import math
from itertools import pairwise

import numpy as np
import pytest
import torch
from factors import Problem, bag, both_settings, problems, seeds, solid_problem
from hypothesis import given, settings
from hypothesis import strategies as st

from dcg_torch.fitting.fit import fit
from dcg_torch.fitting.psi import BINARY, TERNARY, LogLinearFactor
from dcg_torch.types import Correspondence
from dcg_torch.types.arrays import Bools


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
        model = LogLinearFactor(np.ones((3, 4), dtype=np.bool_), correspondences)
        for copies in [*range(2, 90)] * 4:
            model.set_weight(rng.normal(size=model.weight.shape) * rng.choice([0.1, 1.0, 5.0]))
            rows = model.log_psi(bag([[0, 2]]), bag([[1, 3]] * copies), np.zeros(copies, dtype=np.int64)).numpy()
            assert (rows == rows[0]).all()

    @both_settings
    def test_a_new_model_knows_nothing(self, correspondences: tuple[Correspondence, ...]) -> None:
        model = LogLinearFactor(np.ones((2, 3), dtype=np.bool_), correspondences)
        rows = model.log_psi(bag([[0, 1]]), bag([[2], []]), np.array([0, 0]))
        assert rows.exp().numpy() == pytest.approx(np.full((2, len(correspondences)), 1 / len(correspondences)))

    def test_extreme_weights_stay_finite(self) -> None:
        model = LogLinearFactor(np.ones((1, 1), dtype=np.bool_), BINARY)
        model.weight[1] = 5_000.0
        row = model.log_psi(bag([[0]]), bag([[0]]), np.array([0])).tolist()[0]
        assert row == [-5_000.0, 0.0]


class TestModule:
    def test_a_state_is_saved_and_restored(self) -> None:
        problem = solid_problem(TERNARY)
        model, other = problem.model(np.random.default_rng(1)), LogLinearFactor(np.zeros((4, 5), dtype=np.bool_))
        other.load_state_dict(model.state_dict())
        assert set(model.state_dict()) == {"weight", "pairs"}
        assert torch.equal(other.weight, model.weight)
        assert torch.equal(other.pairs, model.pairs)

    def test_it_works_on_another_device(self) -> None:
        """The meta device has no numbers: what would reach for the processor's fails on it."""
        model = solid_problem(TERNARY).model().to("meta")
        rows = model(bag([[0, 1]]), bag([[2], [1, 3]]), np.array([0, 0]))
        assert rows.device.type == "meta"
        assert rows.shape == (2, 3)
        model.grow(np.pad(np.asarray(solid_problem(TERNARY).pairs), ((0, 1), (0, 2))))
        assert model.weight.device.type == model.pairs.device.type == "meta"
        assert model.weight.shape == (3, 5, 7)

    @given(problem=problems(), seed=seeds)
    def test_with_gradients_it_says_the_same(self, problem: Problem, seed: int) -> None:
        model = problem.model(np.random.default_rng(seed))
        arguments = (
            bag(problem.phrases),
            bag([g for _, g, _, _ in problem.rows]),
            np.array([p for p, _, _, _ in problem.rows]),
        )
        plain = model.log_psi(*arguments).numpy()
        model.requires_grad_()
        followed = model.log_psi(*arguments)
        assert followed.requires_grad
        assert followed.detach().numpy() == pytest.approx(plain, abs=1e-12)

    def test_weights_of_another_shape_are_refused(self) -> None:
        with pytest.raises(ValueError, match=r"shape \(3, 5, 4\) for a factor of \(3, 4, 5\)"):
            solid_problem(TERNARY).model().set_weight(np.zeros((3, 5, 4)))


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
        fit(model, [problem.design()], l2=0.1)
        model.grow(np.pad(problem.pairs, ((0, 1), (0, 1)), constant_values=True))
        languages, groundings = problem.pairs.shape
        grown = Problem(
            BINARY,
            model.pairs.numpy(),
            [*problem.phrases, [languages]],
            [*problem.rows, (len(problem.phrases), [groundings], 1, 5.0)],
        )
        fit(model, [grown.design()], l2=0.1)
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
    def test_a_mask_that_does_not_extend_is_refused(self, pairs: Bools) -> None:
        model = LogLinearFactor(np.ones((2, 2), dtype=np.bool_))
        model.weight.add_(1.0)
        with pytest.raises(ValueError, match="does not extend"):
            model.grow(pairs)
        assert model.weight.shape == (3, 2, 2)
        assert (model.weight == 1.0).all()


def test_the_correspondences_are_those_of_the_equations() -> None:
    assert [list(map(int, c)) for c in (TERNARY, BINARY)] == [[-1, 0, 1], [0, 1]]
    assert all(a < b for c in (TERNARY, BINARY) for a, b in pairwise(c))
