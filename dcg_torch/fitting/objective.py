"""The penalised likelihood of `fit` in the variables that solvers move.

Weights are a basis times the variables: with Q = P - 1 and d[q] = weight[q + 1] - weight[0],

    weight = prior + B d,   B = [0; I] - 1/P,   so that the weights of the P correspondences sum to those of the prior

where the optimum is: a constant added to all P changes no probability and only costs penalty. For two correspondences
B = [-1/2, 1/2]. As the scores matter only by their differences u[q] = score[q + 1] - score[0] too,

    objective(d) = sum_n ( total[n] log(1 + sum_q exp u[q, n]) - sum_q count[q + 1, n] u[q, n] )
                   + 1/2 sum_k l2[k] d[:, k]' (I - 1/P) d[:, k]

and its gradient with respect to d[q] is the gradient with respect to weight[q + 1].

Conventions: K variables of each of the Q differences, N rows, arrays (Q, K) and (Q, N).
"""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from dcg_torch.fitting.phrase_rows import PhraseRows
from dcg_torch.fitting.rows import ArrowheadRows, GridRows, Rows
from dcg_torch.fitting.solvers import Direction, Function, Point
from dcg_torch.types.arrays import Floats, Ints

_SETTLED = 1e-10
"""Variables of a block whose gradient is less stay where they are."""
_OF_TOLERANCE = 0.25
"""Share of the tolerance that may be left of the gradient after a Newton step."""
_ALL = slice(None)
_CG_STEPS = 1000
"""Conjugate gradient steps at the most for one Newton step."""


@dataclass(frozen=True)
class Objective:
    """The objective as a function of the flat variables.

    Attributes:
        rows: what fires.
        count: (P, N) summed weights of the examples with each label.
        offset: (Q, N) what is added to the scores, by weights that do not move; None: nothing.
        strength: (K,) l2 of each variable.
        scale: (K,) the gradient with respect to one weight over that with respect to its variable.
    """

    rows: Rows
    count: Floats
    offset: Floats | None
    strength: Floats
    scale: Floats | float = 1.0

    @cached_property
    def total(self) -> Floats:
        """(N,) examples of each row, whatever their label."""
        total: Floats = self.count.sum(axis=0)
        return total

    def _total(self, rows: slice) -> Floats:
        """(n,) of some rows; of many it is not kept."""
        total: Floats = self.total if rows == _ALL else self.count[:, rows].sum(axis=0)
        return total

    def __call__(self, flat: Floats) -> Point:
        """Value, gradient, and the gradient's max-norm over the P weights of each feature."""
        d = flat.reshape(len(self.count) - 1, -1)
        pull = self._pull(d)
        value, chances = 0.5 * float((pull * d).sum()), np.empty((len(d), 0))

        def bend(rows: slice, u: Floats) -> Floats:
            nonlocal value, chances
            own, residual, found = self._likelihood(rows, u)
            value += own
            if rows == _ALL:
                chances = found
            return residual

        gradient = self.rows.through(d, bend) + pull
        return Point(flat, value, gradient.reshape(-1), max_norm(gradient * self.scale), chances)

    def _likelihood(self, rows: slice, u: Floats) -> tuple[float, Floats, Floats]:
        """See `likelihood`, from what the variables add to the scores."""
        u = u if self.offset is None else u + self.offset[:, rows]
        return likelihood(u, self.count[:, rows], self._total(rows))

    def as_counted(self, flat: Floats) -> Floats | None:
        """Variables under which labels are as probable as counted, by the rows' own; for rows of the arrowhead.

        That is nearly the optimum where the penalty is small beside what was counted. Labels that were never counted
        keep their scores. None where each row was counted with one label alone, which says nothing.
        """
        assert isinstance(self.rows, ArrowheadRows)
        rows, r = self.rows, len(self.rows.entry)
        seen = self.count[:, :r] > 0.0
        if not (np.count_nonzero(seen, axis=0) > 1).any():
            return None
        d = flat.reshape(len(self.count) - 1, -1).copy()
        own = rows.scores(d)[:, :r] + (0.0 if self.offset is None else self.offset[:, :r])
        scores = np.concatenate([np.zeros((1, r)), own])
        count = self.count[:, :r]
        gap = np.log(count, out=np.zeros_like(count), where=seen) - scores
        gap -= (gap * seen).sum(axis=0) / np.maximum(seen.sum(axis=0), 1)
        gap *= seen
        d[:, rows.patterns.shape[1] :] += (gap[1:] - gap[0]) / rows.entry
        return d.reshape(-1)

    def newton_step(self, point: Point) -> Direction:
        """Minus the inverse Hessian times the gradient; for rows of the arrowhead.

        The rows' own variables are eliminated first: what is left is as if their rows were less curved.
        """
        assert isinstance(self.rows, ArrowheadRows)
        rows, r = self.rows, len(self.rows.entry)
        q, shared = len(point.chances), rows.patterns.shape[1]
        curvature = self.curvature(point)
        if not r:
            alone = self._shared_steps(curvature)
            return Direction(alone(-point.gradient.reshape(q, -1)).reshape(-1))
        coupled = rows.entry * curvature[:, :, :r]
        inverse = _inverse(rows.entry * coupled + self._basis[:, :, None] * self.strength[shared:])
        across = _times(coupled, inverse)
        curvature[:, :, :r] -= _times(across, coupled)
        steps = self._shared_steps(curvature)

        def step(flat: Floats) -> Floats:
            gradient = flat.reshape(q, -1)
            pull = np.zeros((q, curvature.shape[2]))
            pull[:, :r] = _times(across, gradient[:, None, shared:])[:, 0]
            found = steps(rows.by_pattern(pull) @ rows.patterns - gradient[:, :shared])
            moved = rows.by_row(found @ rows.patterns.T)[:, None, :r]
            left = gradient[:, None, shared:] + _times(coupled, moved)
            return np.concatenate([found, -_times(inverse, left)[:, 0]], axis=1).reshape(-1)

        return Direction(step(point.gradient), step)

    def _shared_steps(self, curvature: Floats) -> Callable[[Floats], Floats]:
        """(Q, S) the step of the shared variables along (Q, S), from the curvature (Q, Q, N) of each row."""
        assert isinstance(self.rows, ArrowheadRows)
        q, blocks, hessians = len(curvature), self.rows.blocks, dict[int, Floats]()
        pairs = [(a, b) for a in range(q) for b in range(a + 1)]  # the matrices are symmetric
        curvatures = self.rows.by_pattern(np.array([curvature[pair] for pair in pairs]))

        def hessian_of(rows: Ints, columns: Ints, matrix: Floats) -> Floats:
            own, k = curvatures.take(rows, axis=1), len(columns)
            products = ((matrix.T * own[:, None]).reshape(-1, len(rows)) @ matrix).reshape(-1, k, k)
            hessian = np.empty((q, k, q, k))
            for (a, b), product in zip(pairs, products, strict=True):
                hessian[a, :, b] = hessian[b, :, a] = product
            diagonal = np.einsum("akbk->abk", hessian)  # a view
            diagonal += self._basis[:, :, None] * self.strength[columns]
            return hessian.reshape(q * k, q * k)

        def step(downhill: Floats) -> Floats:
            found = np.zeros_like(downhill)
            for number, (rows, columns, matrix) in enumerate(blocks):
                right = downhill[:, columns].reshape(-1)
                if np.abs(right).max() < _SETTLED:
                    continue
                if number not in hessians:
                    hessians[number] = hessian_of(rows, columns, matrix)
                found[:, columns] = np.linalg.solve(hessians[number], right).reshape(q, -1)
            return found

        return step

    @cached_property
    def _basis(self) -> Floats:
        """(Q, Q) I - 1/P: the penalty of a variable's differences."""
        q = len(self.count) - 1
        return np.eye(q) - 1.0 / (q + 1)

    def product(self, point: Point, d: Floats) -> Floats:
        """(Q, K) the Hessian at a point times d (Q, K)."""
        return self._hessian(self.curvature(point))(d)

    def _hessian(self, curvature: Floats) -> Callable[[Floats], Floats]:
        """As a function of d (Q, K), from the curvature (Q, Q, N) of each row."""
        if len(curvature) == 1:
            own, strength = curvature[0], self.strength / 2.0

            def times_alone(d: Floats) -> Floats:
                bent = self.rows.through(d, lambda rows, u: own[:, rows] * u)
                bent += strength * d
                return bent

            return times_alone

        def bend(rows: slice, u: Floats) -> Floats:
            return _times(curvature[:, :, rows], u[:, None])[:, 0]

        def times(d: Floats) -> Floats:
            bent: Floats = self.rows.through(d, bend)
            bent += self._pull(d)
            return bent

        return times

    def curvature(self, point: Point) -> Floats:
        """(Q, Q, N) the curvature of each row by its score differences."""
        q = len(point.chances)
        found, one = np.empty((q, q, self.count.shape[1])), np.eye(q)[:, :, None]
        parts: Iterable[tuple[slice, Floats]] = [(_ALL, point.chances)]
        if isinstance(self.rows, PhraseRows):  # so many that their probabilities are not kept
            scores = self.rows.in_parts(point.at.reshape(q, -1))
            parts = ((rows, self._likelihood(rows, u)[2]) for rows, u in scores)
        for rows, chances in parts:
            np.multiply((self._total(rows) * chances)[:, None], one - chances, out=found[:, :, rows])
        return found

    def _pull(self, d: Floats) -> Floats:
        """(Q, K) the gradient of the penalty."""
        pull: Floats = self.strength * (d / 2.0 if len(d) == 1 else d - d.sum(axis=0) / len(self.count))
        return pull

    def newton_cg_step(self, point: Point, tolerance: float = 0.0) -> Direction:
        """An approximate Newton step by preconditioned conjugate gradients.

        The system is solved as well as the gradient is small: so the last steps converge superlinearly.

        Args:
            tolerance: of the gradient's max-norm; the system is not solved much better than that asks for.
        """
        curvature = self.curvature(point)
        solve, hessian = self._preconditioner(point, curvature), self._hessian(curvature)
        residual, shape = -point.gradient, (len(point.chances), -1)
        step, left = np.zeros_like(residual), residual.reshape(shape)  # a view, as `moving` is
        towards = solve(left).reshape(-1)
        moving, size = towards.reshape(shape), float(residual @ towards)
        enough = size * max(min(0.1, point.norm), _OF_TOLERANCE * tolerance / point.norm) ** 2
        for _ in range(_CG_STEPS):
            bent = hessian(moving).reshape(-1)
            length = size / float(towards @ bent)
            step += length * towards
            bent *= length
            residual -= bent
            eased = solve(left).reshape(-1)
            before, size = size, float(residual @ eased)
            if size <= enough:
                break
            towards *= size / before
            towards += eased
        return Direction(step)

    def _preconditioner(self, point: Point, curvature: Floats) -> Callable[[Floats], Floats]:
        """About the inverse Hessian: by the structure of a grid, or else by its diagonal."""
        if isinstance(self.rows, GridRows):
            return self.rows.preconditioner(point.chances, self.total, float(self.strength.mean()))
        inverse = 1.0 / self.diagonal(curvature)
        return lambda gradient: inverse * gradient

    def diagonal(self, curvature: Floats) -> Floats:
        """(Q, K) the diagonal of the Hessian, from the curvature (Q, Q, N) of each row."""
        of_rows = curvature[0] if len(curvature) == 1 else np.einsum("aan->an", curvature)
        own: Floats = self.rows.gradient(of_rows) + self.strength * (1.0 - 1.0 / len(self.count))
        return own

    def scaled(self, root: Floats) -> Function:
        """The same function of variables that are `root` times as large: their curvatures are about equal."""

        def function(flat: Floats) -> Point:
            point = self(flat / root)
            return replace(point, at=flat, gradient=point.gradient / root)

        return function


def likelihood(u: Floats, count: Floats, total: Floats) -> tuple[float, Floats, Floats]:
    """The negative log-likelihood of score differences (Q, N), its gradient by them, and the Q probabilities."""
    top = np.maximum(u.max(axis=0), 0.0) if u.size and u.max() > 300.0 else None  # else exp cannot overflow
    chances = np.exp(u if top is None else u - top)
    partition = chances.sum(axis=0) + (1.0 if top is None else np.exp(-top))
    log_partition = np.log(partition) + (0.0 if top is None else top)
    chances /= partition
    value = float(total @ log_partition) - float(np.vdot(count[1:], u))
    return value, chances * total - count[1:], chances


def _times(left: Floats, right: Floats) -> Floats:
    """(a, c, n) products of n matrices (a, b, n) and (b, c, n) each."""
    total: Floats = left[:, 0, None] * right[None, 0]
    for k in range(1, len(right)):
        total += left[:, k, None] * right[None, k]
    return total


def _inverse(matrices: Floats) -> Floats:
    """(Q, Q, n) of symmetric matrices (Q, Q, n)."""
    inverse: Floats
    if len(matrices) == 1:
        inverse = 1.0 / matrices
    elif len(matrices) == 2:
        (a, b), (_, c) = matrices
        inverse = np.array([[c, -b], [-b, a]]) / (a * c - b * b)
    else:
        inverse = np.linalg.inv(matrices.transpose(2, 0, 1)).transpose(1, 2, 0).astype(np.float64)
    return inverse


def max_norm(gradient: Floats) -> float:
    """The max-norm of the gradient by all P weights, which sum to zero, from the gradient by the last Q."""
    if not gradient.size:
        return 0.0
    last = float(np.abs(gradient).max())
    return last if len(gradient) == 1 else max(last, float(np.abs(gradient.sum(axis=0)).max()))
