"""Words that are alike are fitted as one: the optimum is that of all rows."""

from __future__ import annotations

import numpy as np
import pytest

from dcg_torch.fitting import lifting
from dcg_torch.fitting.design import DesignMatrix
from dcg_torch.fitting.fit import fit, objective_at
from dcg_torch.fitting.lifting import lift
from dcg_torch.fitting.psi import BINARY, LogLinearFactor
from dcg_torch.types.arrays import Bools, Floats

WORDS, TYPES = 12, 6
LANGUAGE, GROUNDING = WORDS + 2, TYPES + 1


@pytest.fixture(autouse=True)
def few_rows_are_enough(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(lifting, "_ROWS", 0)


def told(different: int = 0) -> DesignMatrix:
    """Every word with every type; all but the last `different` words are said of what has no row of its own."""
    language = np.array([[0, 2 + w] for w in range(WORDS)])
    grounding = np.array([[0, 1 + t] for _ in range(WORDS) for t in range(TYPES)])
    phrase = np.repeat(np.arange(WORDS), TYPES)
    active = np.tile(np.linspace(0.5, 2.0, TYPES), (WORDS, 1))
    for k in range(different):
        active[-1 - k, k % TYPES] += 3.0 + k
    return DesignMatrix(language, grounding, phrase, np.stack([np.full(WORDS * TYPES, 1.5), active.reshape(-1)]))


def optimum(design: DesignMatrix, l2: float | Floats, free: Bools, weight: Floats) -> LogLinearFactor:
    factor = LogLinearFactor(np.ones((LANGUAGE, GROUNDING), dtype=np.bool_), BINARY)
    factor.set_weight(weight.copy())
    fit(factor, [design], l2=l2, free=free)
    _, gradient = objective_at(factor, [design], l2)
    assert np.abs(gradient[:, free]).max() <= 1.01e-7
    return factor


@pytest.mark.parametrize("different", [0, 3])
def test_the_optimum_is_that_of_all_rows(different: int) -> None:
    design, free = told(different), np.ones((LANGUAGE, GROUNDING), dtype=np.bool_)
    weight = np.zeros((2, LANGUAGE, GROUNDING))
    found = lift([design], weight, free, np.full(free.shape, 0.1))
    assert [len(twins.columns) for twins in found.twins] == [WORDS - different]
    assert len(found.designs[0].phrase) == TYPES * (1 + different)
    assert found.designs[0].count.sum() == pytest.approx(design.count.sum())
    fitted = optimum(design, 0.1, free, weight).weight.numpy()
    assert np.ptp(fitted[:, 2 : 2 + WORDS - different], axis=1).max() < 1e-12
    if different:
        assert np.ptp(fitted[:, 2:], axis=1).max() > 0.1


def test_words_that_were_there_before_start_anywhere() -> None:
    rng = np.random.default_rng(0)
    free = np.ones((LANGUAGE, GROUNDING), dtype=np.bool_)
    cold = optimum(told(2), 0.1, free, np.zeros((2, LANGUAGE, GROUNDING)))
    warm = optimum(told(2), 0.1, free, rng.normal(size=(2, LANGUAGE, GROUNDING)))
    assert np.abs(cold.weight.numpy() - warm.weight.numpy()).max() < 1e-6


def test_words_with_weights_of_their_own_are_not_alike() -> None:
    """Weights that do not move, and those that move in other cells."""
    design, free = told(), np.ones((LANGUAGE, GROUNDING), dtype=np.bool_)
    free[2:5, 1] = False
    weight = np.zeros((2, LANGUAGE, GROUNDING))
    weight[1, 3:5, 1] = 1.0, 2.0
    fixed = np.where(free, 0.0, weight)
    found = lift([design], fixed, free, np.full(free.shape, 0.1))
    assert [twins.columns.tolist() for twins in found.twins] == [list(range(5, 2 + WORDS))]
    fitted = optimum(design, 0.1, free, weight).weight.numpy()
    assert np.array_equal(fitted[:, ~free], weight[:, ~free])


def test_words_with_other_penalties_are_not_alike() -> None:
    l2 = np.full((LANGUAGE, GROUNDING), 0.1)
    l2[2:6, 3] = 0.4
    free = np.ones((LANGUAGE, GROUNDING), dtype=np.bool_)
    weight = np.zeros((2, LANGUAGE, GROUNDING))
    found = lift([told()], weight, free, l2)
    assert sorted(len(twins.columns) for twins in found.twins) == [4, WORDS - 4]
    optimum(told(), l2, free, weight)


def test_a_column_that_two_phrases_fire_is_nobodys_own() -> None:
    design = told()
    other = DesignMatrix(np.array([[0, 2]]), np.array([[0, 1]]), np.array([0]), np.array([[1.0], [2.0]]))
    free = np.ones((LANGUAGE, GROUNDING), dtype=np.bool_)
    found = lift([design, other], np.zeros((2, LANGUAGE, GROUNDING)), free, np.full(free.shape, 0.1))
    assert [twins.columns.tolist() for twins in found.twins] == [list(range(3, 2 + WORDS))]
    assert found.designs[1] is other
