"""Rows as sparse matrices: scores and their transpose, by scipy's compiled product and without it."""

from __future__ import annotations

import numpy as np
import pytest

from dcg_torch.fitting import rows
from dcg_torch.fitting.rows import SparseRows


@pytest.mark.parametrize("differences", [1, 2])
@pytest.mark.parametrize("compiled", [True, False])
@pytest.mark.parametrize("few", [True, False])
def test_scores_and_their_transpose_are_those_of_the_written_matrix(
    differences: int, compiled: bool, few: bool, monkeypatch: pytest.MonkeyPatch
) -> None:
    rng = np.random.default_rng(0)
    row_cells, cell_variables = rng.integers(0, 9, (40, 3)), rng.integers(0, 7, (9, 2))
    if not compiled:
        monkeypatch.setattr(rows, "_product_of_csr", lambda: None)
    if not few:
        monkeypatch.setattr(rows, "_FEW_ENTRIES", 0)
    sparse = SparseRows.of(
        (3 * np.arange(41), row_cells.reshape(-1)), (2 * np.arange(10), cell_variables.reshape(-1)), (40, 9, 7)
    )
    whole = np.zeros((40, 7))
    for k, cells in enumerate(row_cells):
        for cell in cells:
            np.add.at(whole[k], cell_variables[cell], 1.0)
    d, residual = rng.normal(size=(differences, 7)), rng.normal(size=(differences, 40))
    assert len(sparse.factors) == (1 if few else 2)
    np.testing.assert_allclose(sparse.scores(d), d @ whole.T, rtol=1e-13)
    np.testing.assert_allclose(sparse.gradient(residual), residual @ whole, rtol=1e-12, atol=1e-14)


def test_scipy_has_the_compiled_product() -> None:
    """Without it sparse fits are correct, and slower by a tenth."""
    assert rows._product_of_csr() is not None
