"""Other fits of the same rows and the same objective: scikit-learn, glum, CRFsuite, and ours by torch's L-BFGS.

Each has the time that it needs from labelled rows to weights. Those who want a design matrix get it ready made; a
peer that is not installed is left out. A tolerance is divided by the rows where the objective is; peers often stop
earlier, when the value stands still, so their gradients are given too.
"""

from __future__ import annotations

import importlib.util
import tempfile
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from typing import Any

import numpy as np

from dcg_torch.bench.rows import Rows
from dcg_torch.types.arrays import Floats

L2 = 1.0
TOLERANCE = 1e-6
"""Of the gradient's max-norm, absolute."""
_MOST = {"newton-cholesky": 10_000, "newton-cg": 200_000, "torch": 200_000, "crfsuite": 20_000, "glum": 5_000}
"""Rows up to which a peer is asked: beyond, it takes minutes or gigabytes."""


@dataclass(frozen=True)
class Peer:
    """A fit by others.

    Attributes:
        run: finds the weights (P, L, G); None where it does not give them.
    """

    name: str
    run: Callable[[], Floats | None]


def peers(rows: Rows, by_torch: Callable[[], Floats]) -> Iterator[Peer]:
    """All that can be asked for so many rows.

    Args:
        by_torch: our fit by torch's L-BFGS.
    """
    count, two = len(rows.phrase), len(rows.correspondences) == 2
    if count <= _MOST["torch"]:
        yield Peer("torch L-BFGS", by_torch)
    if importlib.util.find_spec("sklearn") is not None:
        for solver in ("lbfgs", "newton-cg", "newton-cholesky"):
            if count <= _MOST.get(solver, count):
                yield Peer(f"scikit-learn {solver}", _scikit_learn(rows, solver))
    if importlib.util.find_spec("glum") is not None and two and count <= _MOST["glum"]:
        yield Peer("glum", _glum(rows))
    if importlib.util.find_spec("pycrfsuite") is not None and count <= _MOST["crfsuite"]:
        yield Peer("CRFsuite L-BFGS", _crfsuite(rows))


def _scikit_learn(rows: Rows, solver: str) -> Callable[[], Floats]:
    from sklearn.linear_model import LogisticRegression

    design, used, two = *_design(rows), len(rows.correspondences) == 2

    def run() -> Floats:
        model: Any = LogisticRegression(
            C=(2.0 if two else 1.0) / L2,
            fit_intercept=False,
            solver=solver,
            tol=TOLERANCE / len(rows.phrase),
            max_iter=5_000,
        )
        model.fit(design, rows.label)
        return _weights(rows, used, np.concatenate([-model.coef_, model.coef_]) / 2 if two else model.coef_)

    return run


def _glum(rows: Rows) -> Callable[[], Floats]:
    """For two correspondences: the mean of the likelihood and half of alpha times the squares."""
    from glum import GeneralizedLinearRegressor

    (design, used), count = _design(rows), len(rows.phrase)
    matrix = design.tocsc()

    def run() -> Floats:
        model: Any = GeneralizedLinearRegressor(
            family="binomial",
            alpha=L2 / (2.0 * count),
            l1_ratio=0.0,
            fit_intercept=False,
            gradient_tol=TOLERANCE / count,
            max_iter=500,
        )
        model.fit(matrix, rows.label.astype(np.float64))
        return _weights(rows, used, np.stack([-model.coef_, model.coef_]) / 2)

    return run


def _crfsuite(rows: Rows) -> Callable[[], None]:
    """Sequences of one, whose states are the labels; reading them in is not counted."""
    import pycrfsuite

    trainer = pycrfsuite.Trainer(algorithm="lbfgs", verbose=False)
    trainer.set_params(
        {
            "c1": 0.0,
            "c2": L2 / 2.0,
            "epsilon": TOLERANCE,
            "delta": 0.0,
            "max_iterations": 5_000,
            "feature.possible_states": True,
        }
    )
    design = _design(rows)[0]
    names = [str(k) for k in range(design.shape[1])]
    for row, label in enumerate(rows.label.tolist()):
        fires = design.indices[design.indptr[row] : design.indptr[row + 1]]
        trainer.append([[names[k] for k in fires.tolist()]], [str(label)])

    def run() -> None:
        with tempfile.NamedTemporaryFile() as file:
            trainer.train(file.name)

    return run


def _design(rows: Rows) -> tuple[Any, Any]:
    """(n, columns) binary, CSR, of the pairs that fire, and the cells of (L, G) that they are."""
    from scipy.sparse import csr_array

    count, groundings = len(rows.phrase), rows.pairs.shape[1]
    columns = (rows.language[rows.phrase][:, :, None] * groundings + rows.grounding[:, None, :]).reshape(count, -1)
    kept = rows.pairs.reshape(-1)[columns]
    starts = np.concatenate([[0], np.cumsum(kept.sum(axis=1))])
    design = csr_array((np.ones(int(starts[-1])), columns[kept], starts), (count, rows.pairs.size))
    used = np.unique(design.indices)
    return design[:, used], used


def _weights(rows: Rows, used: Any, found: Floats) -> Floats:
    """(P, L, G) that sum to zero over P."""
    shape = (len(rows.correspondences), *rows.pairs.shape)
    weight = np.zeros((shape[0], shape[1] * shape[2]))
    weight[:, used] = found
    centred: Floats = (weight - weight.mean(axis=0)).reshape(shape)
    return centred
