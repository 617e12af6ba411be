"""Maximum-likelihood fit of the log-linear factor, for any number of correspondences.

    objective(weight) = - sum_n count[n] log Psi[n, phi_n]  +  1/2 sum_{phi, l, g} l2[l, g] (weight - prior)^2

It is strictly convex, so the optimum does not depend on the start. Only weights that are free and fire in some row are
moved by a solver: of the other free ones the prior is the optimum, and what is not free adds a constant to the scores.
`reduction` makes that smaller problem.
"""

from __future__ import annotations

import functools
import time
from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Literal, NamedTuple

import numpy as np
import torch

from dcg_torch.fitting import solvers
from dcg_torch.fitting.design import DesignMatrix
from dcg_torch.fitting.device_objective import minimise
from dcg_torch.fitting.devices import device_of
from dcg_torch.fitting.lifting import Lifted, lift
from dcg_torch.fitting.objective import likelihood, max_norm
from dcg_torch.fitting.psi import LogLinearFactor, scores
from dcg_torch.fitting.reduction import Reduced, reduce
from dcg_torch.fitting.rows import ArrowheadRows, SparseRows
from dcg_torch.fitting.sparse_rows import weight_at, write_out
from dcg_torch.fitting.threads import one_thread
from dcg_torch.types.arrays import Bools, Floats

Solver = Literal["auto", "newton", "lbfgs", "lbfgs-torch"]


@dataclass(frozen=True)
class FitResult:
    """How a fit went.

    Attributes:
        value: of the objective at the end, without the penalty of weights that may not change, which is constant.
        gradient: max-norm of the gradient with respect to the free weights.
        steps, evaluations: of the solver.
        rows: distinct ones that the solver saw.
        seconds: wall clock.
    """

    value: float
    gradient: float
    steps: int
    evaluations: int
    rows: int
    status: solvers.Status
    seconds: float


def fit(
    factor: LogLinearFactor,
    designs: Sequence[DesignMatrix],
    *,
    l2: float | Floats,
    free: Bools | None = None,
    prior: Floats | None = None,
    tolerance: float = 1e-7,
    max_steps: int = 500,
    solver: Solver = "auto",
    device: str | None = None,
) -> FitResult:
    """Maximise the penalised likelihood from the factor's present weights, in place.

    Args:
        factor: its `weight` is the start and receives the optimum.
        designs: labelled factors; the objective is the sum over all.
        l2: strength of the penalty, > 0; one number or (L, G).
        free: (L, G) the features whose weights may change, the others stay as they are; None: all.
        prior: (P, L, G) the weights that cost no penalty; None: zero.
        tolerance: stop when the max-norm of the objective's gradient falls below it; absolute, not per example.
        max_steps: of the solver, at the most.
        solver: "auto" takes what measurements say is fastest: Newton's method where rows share few weights, else
            Newton-CG. "newton" insists on the former; "lbfgs" is for few steps that need not arrive; "lbfgs-torch" is
            torch.optim.LBFGS. A device other than the processor knows "auto" alone, which is Newton-CG there.
        device: where the sums over rows are done; None: where the factor's weights are.

    Raises:
        ValueError: l2 is not positive, or the device has no such solver.
        DeviceError: the device is not there.
    """
    began = time.perf_counter()
    where = factor.weight.device if device is None else device_of(device)
    with one_thread():
        problem, lifted = _problem_of(factor, designs, l2, free, prior)
        solved = _solved(problem, where, tolerance, max_steps, solver)
    lifted.spread(solved.weight)
    factor.set_weight(solved.weight)
    return solved.result(seconds=time.perf_counter() - began)


def _problem_of(
    factor: LogLinearFactor,
    designs: Sequence[DesignMatrix],
    l2: float | Floats,
    free: Bools | None,
    prior: Floats | None,
) -> tuple[Problem, Lifted]:
    """What is to be solved, with words of the same history as one, and how their weights are shared out again.

    Raises:
        ValueError: l2 is not positive.
    """
    weight = factor.weight.detach().cpu().numpy()
    pairs = factor.pairs.cpu().numpy()
    active = pairs if free is None else pairs & free
    strength = _strength(l2, active)
    fixed = _with_prior(weight, prior, active)
    lifted = lift(designs, fixed, active, strength)
    return Problem(lifted.designs, weight, fixed, active, strength, lifted.times), lifted


def _strength(l2: float | Floats, active: Bools) -> Floats:
    """(L, G) of the penalty.

    Raises:
        ValueError: it is not positive.
    """
    strength = np.broadcast_to(np.asarray(l2, dtype=np.float64), active.shape)
    if not (np.all(np.asarray(l2) > 0.0) or (strength[active] > 0.0).all()):
        raise ValueError(f"l2 must be positive, not {strength.min():g}: without it the optimum is not unique")
    return strength


def _with_prior(weight: Floats, prior: Floats | None, active: Bools) -> Floats:
    """New weights (P, L, G), the prior where they are to move."""
    return np.where(active, 0.0 if prior is None else prior, weight)


class Problem(NamedTuple):
    """What `reduction.reduce` and `sparse_rows.write_out` start from."""

    designs: Sequence[DesignMatrix]
    weight: Floats
    fixed: Floats
    active: Bools
    strength: Floats
    times: Floats | None


class _Solved(NamedTuple):
    """Where a solver ended.

    Attributes:
        found: its minimum, in its own variables.
        weight: (P, L, G) the weights there.
        constant: to add to the value of the minimum.
        rows: distinct ones that the solver saw.
    """

    found: solvers.Minimum
    weight: Floats
    constant: float
    rows: int

    def result(self, seconds: float) -> FitResult:
        """How the fit went that took so many seconds."""
        found = self.found
        value, gradient = found.point.value + self.constant, found.point.norm
        return FitResult(value, gradient, found.steps, found.evaluations, self.rows, found.status, seconds)


def _solved(problem: Problem, device: torch.device, tolerance: float, max_steps: int, solver: Solver) -> _Solved:
    """The optimum, where the device can find it.

    Raises:
        ValueError: it has no such solver.
    """
    if device.type == "cpu":
        return _on_processor(problem, tolerance, max_steps, solver)
    if solver == "auto":
        return _on_device(problem, device, tolerance, max_steps)
    raise ValueError(f"solver={solver} runs on the processor alone; on {device} there is auto")


def _on_processor(problem: Problem, tolerance: float, max_steps: int, solver: Solver) -> _Solved:
    reduced = reduce(*problem, prefer=solver)
    found = _solve(reduced, tolerance, max_steps, solver)
    return _Solved(found, reduced.weight(found.point.at), reduced.constant, reduced.objective.count.shape[1])


def _on_device(problem: Problem, device: torch.device, tolerance: float, max_steps: int) -> _Solved:
    if not problem.designs:
        return _on_processor(problem, tolerance, max_steps, "auto")
    written = write_out(*problem)
    found = minimise(written, device, tolerance=tolerance, max_steps=max_steps)
    d = found.point.at.reshape(len(problem.weight) - 1, -1)
    return _Solved(found, weight_at(d, problem.fixed, written.columns), written.constant, written.incidence.rows)


def _solve(reduced: Reduced, tolerance: float, max_steps: int, solver: Solver) -> solvers.Minimum:
    objective, start = reduced.objective, reduced.start
    if solver == "lbfgs-torch":
        return solvers.lbfgs_of_torch(objective, start, tolerance=tolerance, max_steps=max_steps)
    if solver in ("auto", "newton") and isinstance(objective.rows, ArrowheadRows):
        function, step, guess = objective, objective.newton_step, objective.as_counted
        return solvers.newton(function, step, start, tolerance=tolerance, max_steps=max_steps, guess=guess)
    sparse = isinstance(objective.rows, SparseRows)
    if solver == "lbfgs" and sparse:
        root = np.sqrt(objective.diagonal(objective.curvature(objective(start)))).reshape(-1)
        found = solvers.lbfgs(objective.scaled(root), start * root, tolerance=tolerance, max_steps=max_steps)
        return replace(found, point=replace(found.point, at=found.point.at / root))
    if solver != "lbfgs":
        step = functools.partial(objective.newton_cg_step, tolerance=tolerance)
        return solvers.newton(objective, step, start, tolerance=tolerance, max_steps=max_steps)
    return solvers.lbfgs(objective, start, tolerance=tolerance, max_steps=max_steps)


def objective_at(
    factor: LogLinearFactor,
    designs: Sequence[DesignMatrix],
    l2: float | Floats,
    prior: Floats | None = None,
) -> tuple[float, Floats]:
    """The objective and its gradient (P, L, G) at the factor's weights, a row at a time: to check a fit by.

    Args:
        designs, l2, prior: as for `fit`.
    """
    weight, pairs = factor.weight.detach().cpu().numpy(), factor.pairs.cpu().numpy()
    distance = weight if prior is None else weight - prior
    value = 0.5 * float((l2 * distance * distance).sum())
    gradient = l2 * distance
    for design in designs:
        total = scores(weight, design.language, design.grounding, design.phrase)
        more, residual, _ = likelihood(total[1:] - total[0], design.count, design.count.sum(axis=0))
        value += more
        whole = np.concatenate([-residual.sum(axis=0, keepdims=True), residual])
        for left in design.language[design.phrase].T:
            for right in design.grounding.T:
                fires = (left >= 0) & (right >= 0)
                for p, own in enumerate(whole):
                    np.add.at(gradient[p], (left[fires], right[fires]), own[fires])
    return value, gradient * pairs


__all__ = ["FitResult", "Solver", "fit", "max_norm", "objective_at"]
