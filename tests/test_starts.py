"""Where fits start: nearer to the optimum, which does not depend on it."""

from __future__ import annotations

import sys

import numpy as np
import pytest

from dcg_torch.fitting.design import DesignMatrix
from dcg_torch.fitting.objective import likelihood
from dcg_torch.fitting.psi import TERNARY, LogLinearFactor
from dcg_torch.fitting.reduction import reduce
from dcg_torch.grounding.features import PAPER, FeatureSet
from dcg_torch.learning.assignment import propagate
from dcg_torch.model.growth import start_as_the_last, widened
from dcg_torch.scene import groups
from dcg_torch.scene.clusters import clusters
from dcg_torch.types import Object, Symbol


def counted(count: np.ndarray) -> np.ndarray:
    """The probabilities that `as_counted` gives to labels (P, N) of rows with a variable of their own each."""
    n = count.shape[1]
    language, grounding = np.array([[0]]), np.array([[0, 1 + k] for k in range(n)])
    design = DesignMatrix(language, grounding, np.zeros(n, dtype=np.int64), count)
    zero, pairs = np.zeros((len(count), 1, 1 + n)), np.ones((1, 1 + n), dtype=np.bool_)
    objective = reduce([design], zero, zero.copy(), pairs, np.full(pairs.shape, 0.1), prefer="newton").objective
    start = np.zeros((len(count) - 1) * len(objective.strength))
    found = objective.as_counted(start)
    assert found is not None
    u = objective.rows.scores(found.reshape(len(count) - 1, -1))
    _, _, chances = likelihood(u, objective.count, objective.total)
    whole = np.concatenate([1.0 - chances.sum(axis=0, keepdims=True), chances])
    order = [int(np.argmin(np.abs(objective.count - of[:, None]).sum(axis=0))) for of in count.T]
    return whole[:, order]


def test_labels_are_as_probable_as_they_were_counted() -> None:
    count = np.array([[2.0, 1.0, 5.0], [6.0, 3.0, 1.0], [2.0, 8.0, 2.0]])
    assert counted(count) == pytest.approx(count / count.sum(axis=0))


def test_a_label_that_was_never_counted_keeps_its_score() -> None:
    chances = counted(np.array([[0.0, 0.0], [6.0, 1.0], [2.0, 9.0]]))
    assert chances[1] / chances[2] == pytest.approx([3.0, 1.0 / 9.0])
    assert chances[0] == pytest.approx(1.0 / (1.0 + np.sqrt([3.0, 9.0]) + 1.0 / np.sqrt([3.0, 9.0])))


def test_a_new_symbol_starts_as_the_last() -> None:
    symbols = [Symbol(word, word) for word in ("cube", "ball", "mug")]
    before = FeatureSet.initial(PAPER, symbols[:2], [], [])
    factor = LogLinearFactor(before.pairs, TERNARY)
    rng = np.random.default_rng(0)
    factor.set_weight(rng.normal(size=factor.weight.shape) * before.pairs)
    old, features = factor.weight.numpy().copy(), before.grow(symbols[2])
    factor.grow(features.pairs)
    start_as_the_last(factor, features, before.shape, symbols)
    weight = factor.weight.numpy()
    assert np.array_equal(weight[:, : old.shape[1], : old.shape[2]], old)
    assert not weight[:, ~features.pairs].any()
    noun, type_ = ({w: of[f"{name}: {w}"] for w in ("cube", "ball", "mug")} for name, of in _columns(features))
    assert np.array_equal(weight[:, noun["mug"], type_["mug"]], old[:, noun["ball"], type_["ball"]])
    assert np.array_equal(weight[:, noun["mug"], type_["ball"]], old[:, noun["ball"], type_["cube"]])
    start_as_the_last(factor, features, features.shape, symbols)  # nothing is new
    assert np.array_equal(factor.weight.numpy(), weight)


def _columns(features: FeatureSet) -> list[tuple[str, dict[str, int]]]:
    return [("noun", features.language), ("type", features.grounding)]


def test_what_is_widened_has_zeros_for_new_columns() -> None:
    values = np.arange(12.0).reshape(2, 2, 3)
    wide = widened(values, (3, 5))
    assert wide.shape == (2, 3, 5)
    assert np.array_equal(wide[:, :2, :3], values)
    assert wide.sum() == values.sum()


@pytest.mark.parametrize("scale", [0.1, 1.0, 2.0])
@pytest.mark.parametrize("repeat", [0.0, 0.05, 0.9])
def test_propagation_ends_where_many_more_sweeps_end(scale: float, repeat: float) -> None:
    psi = np.exp(scale * np.random.default_rng(3).normal(size=(30, 24)))
    free = np.ones(24, dtype=np.bool_)
    free[-2:] = False
    found, further = propagate(psi, repeat, free), propagate(psi, repeat, free, tolerance=1e-13, most=3000)
    assert np.abs(found.word - further.word).max() < 2e-6
    assert np.abs(found.taken - further.taken).max() < 5e-6


@pytest.mark.parametrize("grid", [False, True])
def test_few_points_come_together_as_many_do(grid: bool, monkeypatch: pytest.MonkeyPatch) -> None:
    module = sys.modules[clusters.__module__]
    rng = np.random.default_rng(1)
    for _ in range(30):
        points = rng.integers(-3, 4, (12, 3)).astype(float) if grid else rng.uniform(-3.0, 3.0, (12, 3))
        one = np.zeros(len(points), dtype=np.int64)
        few = sorted(map(sorted, clusters(points, one)))
        with monkeypatch.context() as patch:
            patch.setattr(module, "_FEW", 0)
            assert few == sorted(map(sorted, clusters(points, one)))


def test_groups_of_all_classes_together_are_those_of_each(monkeypatch: pytest.MonkeyPatch) -> None:
    module = sys.modules[groups.__module__]
    rng = np.random.default_rng(2)
    for _ in range(20):
        points = rng.integers(-3, 4, (14, 3)) * [1.0, 1.0, 0.5]
        kinds = rng.choice(["cube", "ball"], 14).tolist(), rng.choice(["red", "green"], 14).tolist()
        things = [
            Object(str(k), kind, True, color=color, position=tuple(place))
            for k, (kind, color, place) in enumerate(zip(*kinds, points.tolist(), strict=True))
        ]
        together = groups(things)
        with monkeypatch.context() as patch:
            patch.setattr(module, "_FEW", 0)
            assert groups(things) == together
