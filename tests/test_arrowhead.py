"""Weights that one row alone has: what elimination gives is what the whole system gives."""

from __future__ import annotations

import numpy as np
import pytest
from factors import both_settings

from dcg_torch.fitting.design import DesignMatrix
from dcg_torch.fitting.fit import fit, objective_at
from dcg_torch.fitting.psi import LogLinearFactor
from dcg_torch.fitting.reduction import reduce
from dcg_torch.fitting.rows import ArrowheadRows, SparseRows
from dcg_torch.types import Correspondence


@both_settings
@pytest.mark.parametrize("many", [False, True])
def test_the_step_solves_the_whole_system(correspondences: tuple[Correspondence, ...], many: bool) -> None:
    """Nouns by types, each pair once, so that it has a weight of its own beside those that all share."""
    rng, words, q = np.random.default_rng(4), 260 if many else 6, len(correspondences) - 1
    types = 260 if many else 5
    language = np.stack([np.zeros(words, dtype=np.int64), np.arange(1, words + 1)], axis=1)
    grounding = np.stack([np.zeros(types, dtype=np.int64), np.arange(1, types + 1)], axis=1)
    pairs = np.ones((words + 1, types + 1), dtype=np.bool_)
    pairs[0, 1:] = pairs[1:, 0] = False
    phrase, thing = np.divmod(np.arange(words * types), types)
    design = DesignMatrix(language, grounding[thing], phrase, rng.uniform(0.1, 2.0, size=(q + 1, len(phrase))))
    weight, strength = np.zeros((q + 1, *pairs.shape)), rng.uniform(0.5, 2.0, size=pairs.shape)
    objective = reduce([design], weight, weight, pairs, strength).objective
    assert isinstance(objective.rows, ArrowheadRows)
    assert len(objective.rows.entry) == words * types
    point = objective(rng.normal(size=q * len(objective.strength)) * 0.3)
    towards, again = objective.newton_step(point)
    assert objective.product(point, towards.reshape(q, -1)).reshape(-1) == pytest.approx(-point.gradient, abs=1e-8)
    other = rng.normal(size=len(point.gradient))
    assert again is not None
    assert objective.product(point, again(other).reshape(q, -1)).reshape(-1) == pytest.approx(-other, abs=1e-8)


@both_settings
@pytest.mark.parametrize("parts", [1, 3])
def test_rows_in_parts_are_eliminated_part_by_part(correspondences: tuple[Correspondence, ...], parts: int) -> None:
    """So many weights in one part take longer; either way the gradient is zero at the optimum."""
    rng, rows, columns = np.random.default_rng(5), 1_950, 150 // parts
    grounding = np.stack([rng.choice(columns, 3, replace=False) for _ in range(rows)])
    language, phrase = np.arange(parts)[:, None], np.arange(rows) % parts
    count = rng.uniform(0.1, 2.0, size=(len(correspondences), rows))
    design = DesignMatrix(language, grounding, phrase, count)
    pairs = np.ones((parts, columns), dtype=np.bool_)
    weight = np.zeros((len(correspondences), *pairs.shape))
    found = reduce([design], weight, weight, pairs, np.ones(pairs.shape)).objective.rows
    assert isinstance(found, ArrowheadRows if parts > 1 else SparseRows)
    factor = LogLinearFactor(pairs, correspondences)
    fit(factor, [design], l2=1.0)
    assert np.abs(objective_at(factor, [design], 1.0)[1]).max() < 1e-6
