"""The fit of `loglinear` for two correspondences, where corpora are large and fits are many.

With phi in {INACTIVE, ACTIVE} the optimum is antisymmetric, weight[ACTIVE] = -weight[INACTIVE] = d / 2, and half of the
arithmetic falls away:

    s[n]          = sum_{l, g} language[n, l] * d[l, g] * grounding[n, g]
    objective(d)  = - sum_n ( active[n] log sigmoid(s[n]) + inactive[n] log sigmoid(-s[n]) )  +  l2 / 4 * |d|^2

It is the same objective as a function of another variable, so `fit` finds the same weights as `loglinear.fit`, which
serves for all numbers of correspondences. What fires is kept as lists of cells of (phrases, G), without padding.
"""

from __future__ import annotations

import time
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import torch
from numpy.typing import NDArray

from dcg_torch.grounding.psi import BINARY, FitResult, LogLinearModel, Table, lbfgs

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]
Mask = NDArray[np.bool_]


@dataclass(frozen=True)
class Factors:
    """Labelled factors, as one list of what fires.

    Attributes:
        language: (A, L) the phrases.
        cells: (K,) which cells of the (A, G) matrix `language` d fire, factor after factor.
        starts: (N,) where each factor's cells begin.
        count: (2, N) summed weights of the examples with each label.
        columns: G.
    """

    language: Floats
    cells: Ints
    starts: Ints
    count: Floats
    columns: int

    @classmethod
    def of(cls, tables: Sequence[Table], columns: int) -> Factors:
        """Of tables, whose columns are (L, G = `columns`)."""
        cells, lengths, counts, phrases = [], [], [], 0
        for table in tables:
            position = table.position.numpy()
            column = position % (columns + 1)
            fires = column < columns
            used = fires.any(axis=1)  # a factor that fires nothing depends on no weight
            cell = (position // (columns + 1) + phrases) * columns + column
            cells.append(cell[used][fires[used]])
            lengths.append(fires[used].sum(axis=1))
            counts.append(table.count.numpy()[:, used])
            phrases += len(table.language)
        ends = np.cumsum(np.concatenate(lengths))
        return cls(
            np.concatenate([table.language.numpy() for table in tables]),
            np.concatenate(cells),
            np.concatenate([[0], ends[:-1]]).astype(np.int64),
            np.concatenate(counts, axis=1),
            columns,
        )

    @property
    def lengths(self) -> Ints:
        """(N,) how many cells of each factor fire."""
        return np.diff(self.starts, append=len(self.cells))

    def fire(self) -> Mask:
        """(L, G) which features fire in some factor."""
        cells = np.zeros(len(self.language) * self.columns)
        cells[self.cells] = 1.0
        found: Mask = self.language.T @ cells.reshape(-1, self.columns) > 0.0
        return found

    def objective(self, d: Floats) -> tuple[float, Floats]:
        """The negative log-likelihood and its gradient (L, G) with respect to d."""
        if not len(self.starts):
            return 0.0, np.zeros_like(d)
        by_phrase = (self.language @ d).reshape(-1)
        score = np.add.reduceat(by_phrase[self.cells], self.starts)
        inactive, active = self.count
        value = float(active @ np.logaddexp(0.0, -score) + inactive @ np.logaddexp(0.0, score))
        residual = (inactive + active) / (1.0 + np.exp(-np.clip(score, -700.0, 700.0))) - active
        spread = np.bincount(self.cells, np.repeat(residual, self.lengths), minlength=len(by_phrase))
        gradient: Floats = self.language.T @ spread.reshape(-1, self.columns)
        return value, gradient


def fit(
    model: LogLinearModel,
    factors: Sequence[Factors],
    *,
    l2: float,
    free: Mask,
    tolerance: float = 1e-7,
    max_steps: int = 500,
    history: int = 20,
) -> FitResult:
    """Maximise the penalised likelihood by L-BFGS from the model's present weights, in place.

    Args:
        model: of two correspondences; its `weight` is the start and receives the optimum.
        factors: the labelled factors; the objective is the sum over all.
        l2: strength of the penalty, > 0.
        free: (L, G) the features whose weights move.
        tolerance: stop when the gradient's max-norm, per unit of the examples' weight, falls below it.
        max_steps: L-BFGS iterations at the most.
        history: curvature pairs kept.

    Raises:
        ValueError: l2 is not positive, or there are more correspondences.
    """
    if l2 <= 0 or model.correspondences != BINARY:
        raise ValueError(f"l2={l2} must be positive, and {model.correspondences} the two of eq. 8")
    began = time.perf_counter()
    tolerance *= max(1.0, sum(float(f.count.sum()) for f in factors))
    start: Floats = (model.weight[1] - model.weight[0]).numpy()
    free = free & model.pairs.numpy()
    moving = torch.from_numpy(start[free]).requires_grad_()

    def whole() -> Floats:
        d = start.copy()
        d[free] = moving.detach().numpy()
        return d

    def closure() -> float:
        d = whole()
        value, gradient = 0.25 * l2 * float((d * d).sum()), 0.5 * l2 * d
        for of_some in factors:
            more, slope = of_some.objective(d)
            value += more
            gradient = gradient + slope
        moving.grad = torch.from_numpy(gradient[free])
        return value

    optimizer = lbfgs(moving, tolerance, max_steps, history)
    steps = evaluations = 0
    if free.any():
        optimizer.step(closure)  # type: ignore[no-untyped-call]
        state = optimizer.state[moving]
        steps, evaluations = int(state["n_iter"]), int(state["func_evals"])
    value = closure()
    gradient = moving.grad
    half = torch.from_numpy(whole() / 2.0)
    model.weight = torch.stack([-half, half])
    norm = float(gradient.abs().max()) if gradient is not None and gradient.numel() else 0.0
    limit = steps >= max_steps or evaluations >= 2 * max_steps
    return FitResult(
        value=value,
        gradient=norm,
        steps=steps,
        evaluations=evaluations,
        rows=sum(len(f.starts) for f in factors),
        status="converged" if norm <= tolerance else "step limit" if limit else "stalled",
        seconds=time.perf_counter() - began,
    )
