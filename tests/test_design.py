"""The design matrix: rows merged, parts joined, columns renamed, and the likelihood that all of it leaves as it was."""

from __future__ import annotations

import numpy as np
import pytest
from factors import Problem, bag, problems, seeds
from hypothesis import given
from hypothesis import strategies as st

from dcg_torch.fitting.design import concatenate, distinct_rows, run_starts
from dcg_torch.fitting.fit import objective_at
from dcg_torch.fitting.psi import BINARY, LogLinearFactor


def test_identical_factors_are_merged() -> None:
    """[0, 1] and [1, 0] are one factor; a third of its examples weighs three."""
    rows = [(0, [0, 1], 1, 1.0), (0, [1, 0], 1, 2.0), (0, [0, 1], 0, 4.0), (1, [0, 1], 1, 8.0), (0, [1], 1, 16.0)]
    # Phrases 0 and 2 fire the same columns; a column that is named twice is one.
    problem = Problem(BINARY, np.ones((2, 2), dtype=np.bool_), [[0], [0, 1], [0]], [*rows, (2, [0, 1, 1, 0], 1, 32.0)])
    counts = sorted(tuple(c) for c in problem.design().count.T.tolist())
    assert counts == [(0.0, 8.0), (0.0, 16.0), (4.0, 35.0)]


@given(rows=st.lists(st.lists(st.integers(0, 6), max_size=4), min_size=1, max_size=30))
def test_distinct_rows_are_the_sets_of_columns(rows: list[list[int]]) -> None:
    found, which = distinct_rows(bag(rows))
    as_sets = [{c for c in row if c >= 0} for row in found.tolist()]
    assert [as_sets[k] for k in which] == [set(row) for row in rows]
    assert len({frozenset(s) for s in as_sets}) == len(as_sets)


def test_rows_are_merged_across_chunks() -> None:
    """More rows than are hashed at once."""
    rows = np.random.default_rng(0).integers(0, 5, size=(150_000, 2))
    found, which = distinct_rows(rows)
    assert len(found) == 15  # five alone, ten pairs
    assert (found[which].max(axis=1) == rows.max(axis=1)).all()
    least = np.where(found[which] < 0, 99, found[which]).min(axis=1)
    assert (least == rows.min(axis=1)).all()


@given(problem=problems(), seed=seeds, data=st.data())
def test_parts_sum_to_the_whole(problem: Problem, seed: int, data: st.DataObject) -> None:
    cut = data.draw(st.integers(1, len(problem.rows)))
    parts = [
        Problem(problem.correspondences, problem.pairs, problem.phrases, rows).design()
        for rows in (problem.rows[:cut], problem.rows[cut:])
        if rows
    ]
    model = problem.model(np.random.default_rng(seed))
    one = objective_at(model, [problem.design()], 0.1)
    for several in (parts, [concatenate(parts)]):
        value, gradient = objective_at(model, several, 0.1)
        assert value == pytest.approx(one[0], rel=1e-10)
        assert gradient == pytest.approx(one[1], abs=1e-10)
    assert len(concatenate(parts).phrase) == len(problem.design().phrase)


def test_renamed_columns_stand_for_two_one_or_none() -> None:
    """Column 0 of the groundings becomes 1 and 2, column 1 becomes 2, column 2 goes; languages swap."""
    problem = Problem(
        BINARY,
        np.ones((2, 3), dtype=np.bool_),
        [[0], [1]],
        [(0, [0], 1, 1.0), (0, [1], 0, 2.0), (1, [2], 1, 4.0), (1, [0, 1], 0, 8.0)],
    )
    languages = np.array([[1], [0], [-1]])
    groundings = np.array([[1, 2], [2, -1], [-1, -1], [-1, -1]])
    expected = Problem(
        BINARY,
        problem.pairs,
        [[1], [0]],
        [(0, [1, 2], 1, 1.0), (0, [2], 0, 2.0), (1, [], 1, 4.0), (1, [1, 2], 0, 8.0)],
    )
    model = LogLinearFactor(problem.pairs, BINARY)
    model.set_weight(np.random.default_rng(2).normal(size=model.weight.shape))
    renamed = problem.design().renamed(languages, groundings)
    assert objective_at(model, [renamed], 0.1)[0] == pytest.approx(expected.loss(model.weight.numpy(), 0.1))
    assert len(concatenate([renamed]).phrase) == 4


@given(numbers=st.lists(st.integers(0, 2), min_size=1, max_size=12))
def test_runs_begin_where_a_number_differs_from_the_one_before(numbers: list[int]) -> None:
    starts = [k for k, number in enumerate(numbers) if k == 0 or number != numbers[k - 1]]
    assert run_starts(np.array(numbers, dtype=np.int64)).tolist() == starts
