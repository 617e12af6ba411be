"""The fit's objective over tensors, for devices other than the processor; see `objective` for the mathematics.

Rows are written out as the pairs that fire, and stay on the device. Between two steps of Newton's method the variables
alone, K numbers for each of Q differences, come back: the line search is that of the processor.

Conventions: K variables of each of the Q differences, N rows, E pairs that fire, tensors (Q, K) and (Q, N), float64.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import torch

from dcg_torch.fitting import solvers
from dcg_torch.fitting.objective import max_norm
from dcg_torch.fitting.sparse_rows import Written
from dcg_torch.types.arrays import Floats

_CG_STEPS = 1000
"""Conjugate gradient steps at the most for one Newton step."""


@dataclass(frozen=True)
class DeviceObjective:
    """The objective as a function of the variables.

    Attributes:
        row, column: (E,) which variable fires in which row.
        count: (P, N) summed weights of the examples with each label.
        offset: (Q, N) what is added to the scores, by weights that do not move.
        strength: (K,) l2 of each variable.
    """

    row: torch.Tensor
    column: torch.Tensor
    count: torch.Tensor
    offset: torch.Tensor
    strength: torch.Tensor

    @classmethod
    def of(cls, written: Written, device: torch.device) -> DeviceObjective:
        """The rows of a fit, on a device."""
        q, rows = len(written.count) - 1, written.incidence.rows
        offset = np.zeros((q, rows)) if written.offset is None else written.offset
        arrays = written.incidence.row, written.incidence.column, written.count, offset, written.strength
        return cls(*(torch.tensor(array, device=device) for array in arrays))

    def scores(self, d: torch.Tensor) -> torch.Tensor:
        """(Q, N) the scores of all rows, from the variables (Q, K)."""
        return torch.zeros_like(self.offset).index_add_(1, self.row, d.index_select(1, self.column))

    def transposed(self, residual: torch.Tensor) -> torch.Tensor:
        """(Q, K) from (Q, N): the transpose of `scores`."""
        zero = residual.new_zeros(len(residual), len(self.strength))
        return zero.index_add_(1, self.column, residual.index_select(1, self.row))

    def at(self, d: torch.Tensor) -> tuple[torch.Tensor, torch.Tensor, torch.Tensor]:
        """Value (), gradient (Q, K) and the rows' probabilities (Q, N) at variables (Q, K)."""
        u, total = self.scores(d) + self.offset, self.count.sum(dim=0)
        whole = torch.cat([torch.zeros_like(u[:1]), u])
        log_partition = torch.logsumexp(whole, dim=0)
        chances = torch.exp(u - log_partition)
        pull = self.strength * (d - d.sum(dim=0) / len(self.count))
        value = (total * log_partition).sum() - (self.count[1:] * u).sum() + 0.5 * (pull * d).sum()
        return value, self.transposed(chances * total - self.count[1:]) + pull, chances

    def product(self, chances: torch.Tensor, d: torch.Tensor) -> torch.Tensor:
        """(Q, K) the Hessian, where the rows have these probabilities, times d (Q, K)."""
        u = self.scores(d)
        bent = chances * (u - (chances * u).sum(dim=0)) * self.count.sum(dim=0)
        return self.transposed(bent) + self.strength * (d - d.sum(dim=0) / len(self.count))

    def diagonal(self, chances: torch.Tensor) -> torch.Tensor:
        """(Q, K) the diagonal of the Hessian."""
        curvature = chances * (1.0 - chances) * self.count.sum(dim=0)
        return self.transposed(curvature) + self.strength * (1.0 - 1.0 / len(self.count))

    def __call__(self, flat: Floats) -> solvers.Point:
        """The same as numbers, for the line search; the rows' probabilities stay on the device."""
        value, gradient, _ = self.at(self._variables(flat))
        back = gradient.cpu().numpy()
        return solvers.Point(flat, float(value), back.reshape(-1), max_norm(back), np.zeros((len(back), 0)))

    def newton_cg_step(self, point: solvers.Point) -> solvers.Direction:
        """An approximate Newton step by conjugate gradients, preconditioned by the diagonal."""
        _, gradient, chances = self.at(self._variables(point.at))
        inverse, residual = 1.0 / self.diagonal(chances), -gradient
        step = torch.zeros_like(residual)
        towards = eased = inverse * residual
        size = float((residual * eased).sum())
        enough = size * min(0.1, point.norm) ** 2
        for _ in range(_CG_STEPS):
            bent = self.product(chances, towards)
            length = size / float((towards * bent).sum())
            step += length * towards
            residual = residual - length * bent
            eased = inverse * residual
            before, size = size, float((residual * eased).sum())
            if size <= enough:
                break
            towards = eased + size / before * towards
        return solvers.Direction(step.cpu().numpy().reshape(-1))

    def _variables(self, flat: Floats) -> torch.Tensor:
        return torch.tensor(flat, device=self.strength.device).reshape(len(self.offset), -1)


def minimise(written: Written, device: torch.device, *, tolerance: float, max_steps: int) -> solvers.Minimum:
    """The minimum of a fit's objective, its rows on a device; for the arguments see `solvers.newton`."""
    objective = DeviceObjective.of(written, device)
    start = written.start.reshape(-1)
    return solvers.newton(objective, objective.newton_cg_step, start, tolerance=tolerance, max_steps=max_steps)
