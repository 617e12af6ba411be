"""Ways to compute scores from the variables of a fit, and their transposes.

`phrase_rows` has one more, for many rows.

Conventions: K variables of each of Q differences, N rows, arrays (Q, K) and (Q, N); see `objective`.
"""

from __future__ import annotations

import functools
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING, Protocol, Self, cast

import numpy as np

from dcg_torch.fitting.psi import Numbers
from dcg_torch.fitting.symmetry import Incidence
from dcg_torch.types.arrays import Floats, Ints

if TYPE_CHECKING:
    from scipy.sparse import csr_array


Bend = Callable[[slice, Floats], Floats]
"""(Q, n) from the scores (Q, n) of the rows that a slice names."""


class Rows(Protocol):
    """What fires in each of N rows, as a linear map from K variables to scores, and its transpose."""

    def scores(self, d: Floats) -> Floats:
        """(Q, N) the scores of all rows, from the variables (Q, K)."""
        ...

    def gradient(self, residual: Floats) -> Floats:
        """(Q, K) from (Q, N): the transpose of `scores`."""
        ...

    def through(self, d: Floats, bend: Bend) -> Floats:
        """(Q, K) the transpose of `scores` applied to what `bend` makes of the scores of (Q, K)."""
        ...


class _AllAtOnce:
    """Rows that are few enough for arrays of all of them."""

    def through(self: Rows, d: Floats, bend: Bend) -> Floats:
        """As the protocol says."""
        return self.gradient(bend(slice(None), self.scores(d)))


@dataclass(frozen=True)
class ArrowheadRows(_AllAtOnce):
    """Rows of which many have a variable of their own beside those that they share: the Hessian is an arrowhead.

    A noun with a type is such a variable, where every pair of them is shown once. Rows that share the same variables
    are of one pattern. The variables are the S shared ones, then the R own ones, which the first R rows have.

    Attributes:
        patterns: (M, S) what fires of the shared variables.
        pattern: (N,) the pattern of each row; None: each row is its own.
        entry: (R,) how much each own variable counts in its row.
    """

    patterns: Floats
    pattern: Ints | None
    entry: Floats

    def scores(self, d: Floats) -> Floats:
        """(Q, N) the scores of all rows, from the variables (Q, K)."""
        shared = self.patterns.shape[1]
        total = self.by_row(d[:, :shared] @ self.patterns.T)
        total[:, : len(self.entry)] += self.entry * d[:, shared:]
        return total

    def gradient(self, residual: Floats) -> Floats:
        """(Q, K) the transpose of `scores`, of residuals (Q, N)."""
        shared = self.by_pattern(residual) @ self.patterns
        return np.concatenate([shared, self.entry * residual[:, : len(self.entry)]], axis=1)

    def by_row(self, values: Floats) -> Floats:
        """(n, N) for each row the value (n, M) of its pattern."""
        return values if self.pattern is None else values.take(self.pattern, axis=1)

    def by_pattern(self, values: Floats) -> Floats:
        """(n, M) sums over the rows of each pattern, of values (n, N)."""
        if self.pattern is None:
            return values
        return np.stack([np.bincount(self.pattern, row, minlength=len(self.patterns)) for row in values])

    @cached_property
    def blocks(self) -> list[tuple[Ints, Ints, Floats]]:
        """Patterns, shared variables and matrix of every part that shares none with the others: verbs, nouns."""
        row, column = np.nonzero(self.patterns != 0.0)
        label = np.arange(self.patterns.shape[1])
        while True:  # the least label spreads through all that is connected
            of_row = np.full(len(self.patterns), len(label))
            np.minimum.at(of_row, row, label[column])
            spreading = label.copy()
            np.minimum.at(spreading, column, of_row[row])
            if (spreading == label).all():
                break
            label = spreading
        found = []
        for one in np.unique(label):
            rows, columns = np.flatnonzero(of_row == one), np.flatnonzero(label == one)
            found.append((rows, columns, np.asfortranarray(self.patterns[rows][:, columns])))
        return found


@dataclass(frozen=True)
class GridRows(_AllAtOnce):
    """Every phrase with every grounding: scores are A d B', whose cells are the rows.

    Attributes:
        language: (A, L).
        grounding: (M, G).
        active: (K,) which cells of (L, G) the variables are; None: all.
    """

    language: Floats
    grounding: Floats
    active: Ints | None

    def scores(self, d: Floats) -> Floats:
        """(Q, A * M) the scores of all cells, from the variables (Q, K)."""
        left = self.language @ spread(d, self.active, (self.language.shape[1], self.grounding.shape[1]))
        return (left @ self.grounding.T).reshape(len(d), -1)

    def gradient(self, residual: Floats) -> Floats:
        """(Q, K) the transpose of `scores`, of residuals (Q, A * M)."""
        cells = residual.reshape(len(residual), len(self.language), len(self.grounding))
        return gathered(self.language.T @ (cells @ self.grounding), self.active)

    def preconditioner(self, chances: Floats, total: Floats, l2: float) -> Callable[[Floats], Floats]:
        """About the inverse Hessian, as a function of (Q, K): exact where curvature is a product of three sides.

        The curvature of a row is taken to be that of its phrase times that of its grounding times a (Q, Q) matrix. So
        the Hessian is a Kronecker product of three small matrices plus the penalty, and their eigenvectors invert it.
        """
        q = len(chances)
        shape = len(self.language), len(self.grounding)
        mean = np.einsum("an,bn,n->ab", chances, -chances, total)
        mean[np.diag_indices(q)] += chances @ total
        curvature = ((chances * (1.0 - chances)).sum(axis=0) * total).reshape(shape)
        whole = max(float(curvature.sum()), np.finfo(float).tiny)
        half = np.linalg.cholesky(np.linalg.inv(np.eye(q) - 1.0 / (q + 1)))
        values, vectors = np.linalg.eigh(half.T @ mean @ half / max(float(np.trace(mean)), np.finfo(float).tiny))
        vectors = half @ vectors
        left, across = np.linalg.eigh((self.language.T * (curvature.sum(axis=1) / whole)) @ self.language)
        right, down = np.linalg.eigh((self.grounding.T * curvature.sum(axis=0)) @ self.grounding)
        divisor = values[:, None, None] * left[:, None] * right + l2

        def solve(gradient: Floats) -> Floats:
            cells = spread(gradient, self.active, (len(left), len(right)))
            turned = np.einsum("ab,alg->blg", vectors, across.T @ cells @ down) / divisor
            return gathered(across @ np.einsum("ab,blg->alg", vectors, turned) @ down.T, self.active)

        return solve


_FEW_ENTRIES = 200_000
"""Variables in all rows up to which these are written out."""


@dataclass(frozen=True)
class SparseRows(_AllAtOnce):
    """Rows that are sums of cells, and cells that are sums of variables: a cell is a phrase with a grounding column.

    Attributes:
        factors: matrices, CSR, whose product says how much of which variables each row has: (N, cells) and (cells, K),
            which are binary, or where that is small, the product itself.
    """

    factors: tuple[csr_array, ...]

    @classmethod
    def of(
        cls, row_cells: tuple[Ints, Numbers], cell_variables: tuple[Ints, Numbers], shape: tuple[int, int, int]
    ) -> Self:
        """From which cells each row has, and which variables each cell.

        Args:
            row_cells: (N + 1,) where each row's begin, and their numbers.
            cell_variables: the same of the variables.
            shape: N, cells, K.
        """
        (starts, cells), (cell_starts, variables) = row_cells, cell_variables
        factors = ones_at(starts, cells, shape[:2]), ones_at(cell_starts, variables, shape[1:])
        few = int(np.diff(cell_starts)[cells].sum()) <= _FEW_ENTRIES
        return cls((factors[0] @ factors[1],) if few else factors)

    @classmethod
    def written(cls, incidence: Incidence, value: Floats) -> Self:
        """From what fires in each row, and how much (entries,) each of it counts."""
        starts = np.append(incidence.starts, len(incidence.row))
        return cls((_csr(starts, incidence.column, value, (incidence.rows, incidence.columns)),))

    @cached_property
    def _back(self) -> tuple[csr_array, ...]:
        few = len(self.factors) == 1  # then a copy by columns costs little, and is the faster way
        return tuple(factor.T.tocsr() if few else factor.T for factor in self.factors)

    @cached_property
    def _products(self) -> tuple[Sequence[_Product], Sequence[_Product]]:
        """What multiplies one vector by each matrix, for scores and for their transpose."""
        return list(map(_product, self.factors[::-1])), list(map(_product, self._back))

    def scores(self, d: Floats) -> Floats:
        """(Q, N) the scores of all rows, from the variables (Q, K)."""
        return _applied(self.factors[::-1], d) if len(d) > 1 else _in_turn(self._products[0], d)

    def gradient(self, residual: Floats) -> Floats:
        """(Q, K) the transpose of `scores`, of residuals (Q, N)."""
        return _applied(self._back, residual) if len(residual) > 1 else _in_turn(self._products[1], residual)


def _applied(matrices: Sequence[csr_array], values: Floats) -> Floats:
    """Each matrix in turn, to every row of values (Q, n)."""
    found = values.T
    for matrix in matrices:
        found = matrix @ found
    return np.ascontiguousarray(found.T)


_Product = Callable[[Floats], Floats]


def _in_turn(products: Sequence[_Product], values: Floats) -> Floats:
    """The same of one row (1, n)."""
    found: Floats = values[0]
    for product in products:
        found = product(found)
    return found.reshape(1, -1)


def _product(matrix: csr_array) -> _Product:
    """A matrix times a vector: what `@` comes to, without its checks, which take longer than a small product."""
    added = _product_of_csr()
    if added is None or matrix.format != "csr":
        return cast("_Product", matrix.__matmul__)
    (n, k), starts, columns, values = matrix.shape, matrix.indptr, matrix.indices, matrix.data

    def product(vector: Floats) -> Floats:
        found = np.zeros(n)
        added(n, k, starts, columns, values, vector, found)
        return found

    return product


@functools.cache
def _product_of_csr() -> Callable[..., None] | None:
    """What adds the product of a CSR matrix, as its parts, and a vector to another; None where scipy has it no more."""
    try:
        from scipy.sparse._sparsetools import csr_matvec  # here: only large fits need it
    except ImportError:
        return None
    return cast("Callable[..., None]", csr_matvec)


def ones_at(starts: Ints, numbers: Numbers, shape: tuple[int, ...], ones: Floats | None = None) -> csr_array:
    """The binary matrix of some shape whose rows begin at `starts` (n + 1,) in the numbers of the columns that fire.

    Args:
        ones: as many or more, which are not copied; None: they are made.
    """
    return _csr(starts, numbers, np.ones(len(numbers)) if ones is None else ones[: len(numbers)], shape)


def _csr(starts: Ints, numbers: Numbers, values: Floats, shape: tuple[int, ...]) -> csr_array:
    from scipy.sparse import csr_array  # here: only large fits need it

    small = smallest_index(max(len(numbers), *shape))
    return csr_array((values, numbers.astype(small, copy=False), starts.astype(small)), shape=shape)


def smallest_index(size: int) -> type[np.int32 | np.int64]:
    """The type of numbers below a size that takes the least room."""
    return np.int32 if size < 1 << 31 else np.int64


def spread(d: Floats, active: Ints | None, shape: tuple[int, int]) -> Floats:
    """(Q, L, G) variables (Q, K) in their cells; zero where there is none."""
    if active is None:
        return d.reshape(len(d), *shape)
    whole = np.zeros((len(d), shape[0] * shape[1]))
    whole[:, active] = d
    return whole.reshape(len(d), *shape)


def gathered(whole: Floats, active: Ints | None) -> Floats:
    """(Q, K) the cells of (Q, L, G) that are variables: the transpose of `spread`."""
    flat = whole.reshape(len(whole), -1)
    return flat if active is None else flat[:, active]
