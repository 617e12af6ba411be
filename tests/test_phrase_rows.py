"""Many rows of a fit, done by phrases: the same objective, and little memory."""

from __future__ import annotations

import itertools

import numpy as np
import pytest

from dcg_torch.bench.rows import sparse_rows
from dcg_torch.fitting import design as designs
from dcg_torch.fitting.design import DesignMatrix, merge, runs
from dcg_torch.fitting.fit import objective_at
from dcg_torch.fitting.phrase_rows import PhraseRows
from dcg_torch.fitting.psi import BINARY, TERNARY, LogLinearFactor
from dcg_torch.fitting.reduction import Reduced, reduce
from dcg_torch.types.arrays import Floats

ROWS, SHAPE = 40_000, (150, 120)


def a_design(labels: int, rng: np.random.Generator) -> DesignMatrix:
    """Phrases with the things of their scenes; every tenth row lacks a column, which padding stands for."""
    rows = sparse_rows(ROWS, rng)
    grounding = rows.grounding.copy()
    grounding[::10, 0] = -1
    return merge(
        rows.language, grounding, rows.phrase, rng.integers(0, labels, ROWS), rng.uniform(0.5, 2.0, ROWS), labels
    )


def a_problem(labels: int, *, masked: bool) -> tuple[Reduced, DesignMatrix, Floats]:
    """What is reduced of it, and the fixed weights."""
    rng = np.random.default_rng(labels)
    design, weight = a_design(labels, rng), rng.normal(size=(labels, *SHAPE))
    active = rng.random(SHAPE) < (0.6 if masked else 1.0)
    fixed = np.where(active, 0.0, weight)
    weight = np.where(active, weight - weight.mean(axis=0), weight)
    return reduce([design], weight, fixed.copy(), active, np.ones(SHAPE)), design, fixed


@pytest.mark.parametrize("labels", [2, 3])
@pytest.mark.parametrize("masked", [False, True])
def test_value_and_gradient_are_those_of_the_formula(labels: int, masked: bool) -> None:
    reduced, design, fixed = a_problem(labels, masked=masked)
    assert isinstance(reduced.objective.rows, PhraseRows)
    point = reduced.objective(reduced.start)
    factor = LogLinearFactor(np.ones(SHAPE, dtype=np.bool_), (BINARY, TERNARY)[labels - 2])
    factor.set_weight(reduced.weight(reduced.start))
    value, gradient = objective_at(factor, [design], 1.0)
    assert point.value + reduced.constant + 0.5 * float((fixed * fixed).sum()) == pytest.approx(value, rel=1e-11)
    assert point.norm == pytest.approx(np.abs(gradient.reshape(labels, -1)[:, reduced.columns]).max(), rel=1e-8)


@pytest.mark.parametrize("labels", [2, 3])
def test_the_curvature_is_the_slope_of_the_gradient(labels: int) -> None:
    reduced, _, _ = a_problem(labels, masked=True)
    objective, at = reduced.objective, reduced.start
    step = 1e-5 * np.random.default_rng(0).normal(size=at.shape)
    slope = (objective(at + step).gradient - objective(at - step).gradient) / 2.0
    found = objective.product(objective(at), step.reshape(labels - 1, -1)).reshape(-1)
    assert found == pytest.approx(slope, abs=1e-6 * np.abs(slope).max())


def test_scores_and_their_transpose_belong_together() -> None:
    reduced, _, _ = a_problem(2, masked=False)
    rows, rng = reduced.objective.rows, np.random.default_rng(1)
    d = rng.normal(size=(1, len(reduced.start)))
    residual = rng.normal(size=(1, reduced.objective.count.shape[1]))
    assert float((rows.scores(d) * residual).sum()) == pytest.approx(float((rows.gradient(residual) * d).sum()))


def test_all_ways_to_merge_find_the_same_rows(monkeypatch: pytest.MonkeyPatch) -> None:
    """By a table of phrases and groundings, by their numbers, and phrase after phrase."""
    rng = np.random.default_rng(2)
    language, things = rng.integers(-1, 6, (30, 2)), rng.integers(-1, 5, (9_000, 3))
    phrase, label, weight = rng.integers(0, 30, 9_000), rng.integers(0, 2, 9_000), rng.uniform(0.5, 2.0, 9_000)

    def counted() -> dict[tuple[frozenset[int], frozenset[int]], tuple[float, ...]]:
        found = merge(language, things, phrase, label, weight, 2)
        assert (np.diff(found.phrase) >= 0).all()
        keys = [
            (frozenset(found.language[p].tolist()) - {-1}, frozenset(thing) - {-1})
            for p, thing in zip(found.phrase.tolist(), found.grounding.tolist(), strict=True)
        ]
        assert len(set(keys)) == len(keys)
        return dict(zip(keys, map(tuple, found.count.T.tolist()), strict=True))

    by_table = counted()
    monkeypatch.setattr(designs, "_TABLE", 0)
    by_number = counted()
    monkeypatch.setattr(designs, "_CHUNK", 1_000)
    by_phrase = counted()
    assert by_phrase.keys() == by_number.keys() == by_table.keys()
    for key, counts in by_table.items():
        assert by_phrase[key] == pytest.approx(counts)
        assert by_number[key] == pytest.approx(counts)


def test_runs_of_phrases_hold_all_rows_once() -> None:
    """A phrase is never cut, so that one with many rows is a run by itself; one without rows is in some run."""
    ends = np.array([3, 3, 5, 50, 51, 51])
    found = list(runs(ends, 10))
    assert [k for run in found for k in range(run.phrases.start, run.phrases.stop)] == list(range(6))
    assert [k for run in found for k in range(run.rows.start, run.rows.stop)] == list(range(51))
    assert all(before.rows.stop == after.rows.start for before, after in itertools.pairwise(found))
    assert [run.rows.stop - run.rows.start for run in found] == [5, 45, 1]
