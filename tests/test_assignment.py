"""Marginals over assignments against a plain enumeration, and belief propagation against the exact sum."""

from __future__ import annotations

import itertools
import math
import time

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from dcg_torch.learning.assignment import exact, marginals, propagate
from dcg_torch.types.arrays import Bools, Floats

Problem = tuple[Floats, float, Bools]


@st.composite
def problems(draw: st.DrawFn) -> Problem:
    words, types = draw(st.integers(1, 4)), draw(st.integers(1, 4))
    cells = draw(st.lists(st.floats(0.01, 1.0), min_size=words * types, max_size=words * types))
    free = draw(st.lists(st.booleans(), min_size=types, max_size=types))
    repeat = draw(st.sampled_from([0.01, 0.1, 0.5, 1.0]))
    return np.array(cells).reshape(words, types), repeat, np.array(free)


def enumerate_all(problem: Problem) -> tuple[list[list[float]], list[float]]:
    """The definition, in plain Python."""
    psi, repeat, free = problem
    words, types = psi.shape
    total = 0.0
    word = [[0.0] * types for _ in range(words)]
    taken = [0.0] * types
    for choice in itertools.product(range(types), repeat=words):
        weight = math.prod(float(psi[w, t]) for w, t in enumerate(choice))
        for t in range(types):
            if free[t]:
                weight *= repeat ** max(0, choice.count(t) - 1)
        total += weight
        for w, t in enumerate(choice):
            word[w][t] += weight
        for t in set(choice):
            taken[t] += weight * bool(free[t])
    return [[x / total for x in row] for row in word], [x / total for x in taken]


@given(problems())
def test_the_exact_sum_is_the_enumeration(problem: Problem) -> None:
    word, taken = enumerate_all(problem)
    found = exact(*problem)
    assert np.allclose(found.word, word, atol=1e-10)
    assert np.allclose(found.taken, taken, atol=1e-10)


@given(problems(), st.randoms(use_true_random=False))
def test_the_order_of_words_and_types_does_not_matter(problem: Problem, random: object) -> None:
    psi, repeat, free = problem
    rng = np.random.default_rng(random.getrandbits(32))  # type: ignore[attr-defined]
    rows, columns = rng.permutation(psi.shape[0]), rng.permutation(psi.shape[1])
    for solve in (exact, propagate):
        one = solve(psi, repeat, free).word[rows][:, columns]
        assert np.allclose(solve(psi[rows][:, columns], repeat, free[columns]).word, one, atol=1e-6)


@settings(max_examples=40, deadline=None)
@given(problems())
def test_propagation_is_a_distribution(problem: Problem) -> None:
    found = propagate(*problem)
    assert np.allclose(found.word.sum(axis=1), 1.0)
    assert ((found.taken >= 0) & (found.taken <= 1 + 1e-9)).all()


def as_they_arise(rng: np.random.Generator, words: int, types: int, share: float) -> Floats:
    """Words that fit some of the types, the right one among them."""
    psi = np.where(rng.random((words, types)) < share, 1.0, 0.005)
    psi[np.arange(words), np.arange(words)] = 1.0
    return psi


@pytest.mark.parametrize(("words", "types"), [(8, 8), (5, 10), (10, 10)])
def test_propagation_on_problems_as_they_arise(words: int, types: int) -> None:
    """Mean error below three points a cell, also where there is no slack, which is the worst case."""
    rng = np.random.default_rng(1)
    free = np.ones(types, dtype=np.bool_)
    errors = []
    for _ in range(20):
        psi = as_they_arise(rng, words, types, 0.25)
        errors.append(np.abs(propagate(psi, 0.05, free).word - exact(psi, 0.05, free).word).mean())
    assert np.mean(errors) < 0.03


def test_clusters_are_summed_exactly(monkeypatch: pytest.MonkeyPatch) -> None:
    """Two words on two types, six times over: propagation alone is wrong by much, the clusters are right."""
    block = np.array([[1.0, 0.9], [0.9, 0.2]])
    psi = np.full((12, 12), 1e-4)
    for k in range(0, 12, 2):
        psi[k : k + 2, k : k + 2] = block
    free = np.ones(12, dtype=np.bool_)
    truth = exact(psi, 0.02, free).word
    monkeypatch.setattr("dcg_torch.learning.assignment.EXACT_COST", 1_000)
    assert np.abs(propagate(psi, 0.02, free).word - truth).max() > 0.02
    assert np.abs(marginals(psi, 0.02, free).word - truth).max() < 0.01


def test_propagation_is_exact_for_a_single_word_and_for_independent_ones() -> None:
    psi = np.array([[0.5, 0.3, 0.2]])
    free = np.ones(3, dtype=np.bool_)
    assert np.allclose(propagate(psi, 0.05, free).word, psi)
    two = np.array([[0.5, 0.3, 0.2], [0.1, 0.1, 0.8]])
    assert np.allclose(propagate(two, 1.0, free).word, two)


def test_fifty_words_and_types_take_milliseconds() -> None:
    rng = np.random.default_rng(0)
    psi = np.where(rng.random((50, 50)) < 0.1, 1.0, 0.005)
    psi[np.arange(50), np.arange(50)] = 1.0
    began = time.process_time()
    found = marginals(psi, 0.05, np.ones(50, dtype=np.bool_))
    assert found.sweeps > 0
    assert time.process_time() - began < 0.5  # about 5 ms on an idle core
    assert np.allclose(found.word.sum(axis=1), 1.0)


def test_elimination_names_the_last_type() -> None:
    psi = np.array([[1.0, 1.0, 0.0], [1.0, 1.0, 0.0], [1.0, 1.0, 1.0]])
    assert exact(psi, 0.0, np.ones(3, dtype=np.bool_)).word[2].tolist() == [0.0, 0.0, 1.0]


@pytest.mark.parametrize(("psi", "repeat"), [(np.ones((2, 2)), 1.5), (np.zeros((1, 2)), 0.1), (np.ones((2, 3)), 0.1)])
def test_nonsense_is_refused(psi: Floats, repeat: float) -> None:
    with pytest.raises(ValueError):
        marginals(psi, repeat, np.ones(2, dtype=np.bool_))
