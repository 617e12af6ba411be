"""The log-linear factor Psi and its maximum-likelihood fit: torch only, no language, no robots.

Mathematics (eqs. 4, 8 and 9 of the paper, for factor n and correspondence phi)

    score[n, phi] = sum_{l, g} language[n, l] * weight[phi, l, g] * grounding[n, g]
    log Psi[n, phi] = score[n, phi] - log sum_{phi'} exp score[n, phi']

    objective(weight) = - sum_n count[n] * log Psi[n, phi_n]  +  l2 / 2 * |weight|^2

`language` and `grounding` are binary, so a row is stored as the list of its ones. Identical factors are merged, and
with A the distinct language rows, scores are sums of entries of A weight[phi]: the phrases' side is multiplied once
for all groundings. With R the residual (probability minus label, weighted by count), spread over the same entries,
the gradient is A' R[phi] + l2 weight[phi].

Conventions
    P   correspondences: (INVERTED, INACTIVE, ACTIVE) of eq. 4, or (INACTIVE, ACTIVE) of eqs. 6, 8 and 9
    L   language columns; G  grounding columns
    pairs is an (L, G) mask: the (l, g) that are features; all other weights are zero and stay so
    a bag is an integer array of shape (n, k): the columns that are one in each row, padded with -1
"""

from __future__ import annotations

import time
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Literal

import numpy as np
import torch
from numpy.typing import NDArray

from dcg_torch.types import Correspondence

Bag = NDArray[np.int64]

TERNARY = (Correspondence.INVERTED, Correspondence.INACTIVE, Correspondence.ACTIVE)
BINARY = (Correspondence.INACTIVE, Correspondence.ACTIVE)


class LogLinearModel:
    """Psi with its weights, float64.

    Attributes:
        correspondences: what the P axis of `weight` stands for.
        weight: (P, L, G).
        pairs: (L, G) boolean.
    """

    def __init__(self, pairs: NDArray[np.bool_], correspondences: tuple[Correspondence, ...] = TERNARY) -> None:
        self.correspondences = correspondences
        self.pairs = torch.from_numpy(pairs)
        self.weight = torch.zeros(len(correspondences), *pairs.shape, dtype=torch.float64)

    def grow(self, pairs: NDArray[np.bool_]) -> None:
        """Add columns of zero weight; every old probability stays bit-identical.

        Args:
            pairs: (L', G') the mask with the new columns appended, L' >= L and G' >= G.

        Raises:
            ValueError: the new mask is smaller, or differs from the old one where both have columns.
        """
        old, (languages, groundings) = self.weight, self.weight.shape[1:]
        mask = torch.from_numpy(pairs)
        if not torch.equal(mask[:languages, :groundings], self.pairs):
            raise ValueError(
                f"a mask of {pairs.shape} columns does not extend the old one of {(languages, groundings)}"
            )
        self.pairs = mask
        self.weight = torch.zeros(old.shape[0], *pairs.shape, dtype=torch.float64)
        self.weight[:, :languages, :groundings] = old

    def log_psi(self, language: Bag, grounding: Bag, phrase: NDArray[np.int64]) -> torch.Tensor:
        """log Psi of n factors.

        Args:
            language: (m, k) bag, a row per phrase.
            grounding: (n, k') bag, a row per factor.
            phrase: (n,) which row of `language` belongs to each factor.

        Returns:
            (n, P) log-probabilities.
        """
        # Bags are summed column by column, elementwise: the order of additions, and so every bit of the
        # result, depends on what fires and not on how many columns there are.
        language, grounding = _distinct(language), _distinct(grounding)
        padded = torch.nn.functional.pad(self.weight, (0, 1, 0, 1))
        of_phrase = _bag_sum(padded, torch.from_numpy(language), dim=1)  # (P, m, G + 1)
        flat = of_phrase.reshape(of_phrase.shape[0], -1)
        columns = torch.from_numpy(np.where(grounding < 0, self.weight.shape[2], grounding))
        offset = torch.from_numpy(phrase * (self.weight.shape[2] + 1))[:, None]
        scores = _bag_sum(flat, columns + offset, dim=1)  # (P, n)
        # Padded to whole vector registers: torch rounds what is left over in another way, and equal factors must have
        # equal bits wherever they stand, or a tie between two objects would not be one.
        whole = torch.nn.functional.pad(scores, (0, -scores.shape[1] % 32))
        return torch.log_softmax(whole, dim=0)[:, : scores.shape[1]].T


def _distinct(bag: Bag) -> Bag:
    """The rows sorted, every column named once: a binary feature that is named twice fires once."""
    rows = np.sort(bag, axis=1)
    repeated = rows[:, 1:] == rows[:, :-1]
    if not repeated[rows[:, 1:] >= 0].any():
        return rows
    rows[:, 1:][repeated] = -1
    return np.sort(rows, axis=1)


def _bag_sum(table: torch.Tensor, bag: torch.Tensor, dim: int) -> torch.Tensor:
    """Sum of `table`'s entries along `dim` named by each row of `bag` (-1: the last, a zero)."""
    if bag.shape[1] == 0:
        bag = torch.full((bag.shape[0], 1), -1, dtype=torch.int64)
    bag = bag % table.shape[dim]
    total = table.index_select(dim, bag[:, 0])
    for k in range(1, bag.shape[1]):
        total = total + table.index_select(dim, bag[:, k])
    return total


@dataclass(frozen=True)
class Table:
    """Labelled factors with identical rows merged: the sufficient statistics of a fit.

    Attributes:
        language: (A, L) the distinct language rows, dense.
        position: (N, k) where each distinct factor's scores come from: cells of the (A, G + 1) matrix that is
            `language` times a weight, flattened; the last column is zero and pads.
        count: (P, N) summed weights of the examples with each label.
    """

    language: torch.Tensor
    position: torch.Tensor
    count: torch.Tensor


@dataclass(frozen=True)
class FitResult:
    """How a fit went: objective value, gradient max-norm, iterations, evaluations, distinct rows, seconds."""

    value: float
    gradient: float
    steps: int
    evaluations: int
    rows: int
    status: Literal["converged", "step limit", "stalled"]
    seconds: float


@dataclass(frozen=True)
class Merged:
    """Labelled factors with identical rows merged, as bags: a `Table` whose columns can still be renamed.

    Attributes:
        language: (A, k) bag of the distinct phrases.
        grounding: (N, k') bag of the distinct factors.
        phrase: (N,) the phrase of each factor.
        count: (P, N) summed weights of the examples with each label.
    """

    language: Bag
    grounding: Bag
    phrase: NDArray[np.int64]
    count: NDArray[np.float64]

    def table(self, shape: tuple[int, int]) -> Table:
        """As a table of (L, G) columns."""
        languages, groundings = shape
        position = self.phrase[:, None] * (groundings + 1) + self.grounding % (groundings + 1)
        return Table(_dense(self.language, languages), torch.from_numpy(position), torch.from_numpy(self.count))


def merge(
    language: Bag,
    grounding: Bag,
    phrase: NDArray[np.int64],
    label: NDArray[np.int64],
    weight: NDArray[np.float64],
    correspondences: int,
) -> Merged:
    """Merge labelled factors.

    Args:
        language: (m, k) bag of the phrases.
        grounding: (n, k') bag of the factors.
        phrase: (n,) the phrase of each factor.
        label: (n,) index into the P correspondences.
        weight: (n,) of each factor in the likelihood.
        correspondences: P.
    """
    a_rows, a_of = _unique(_distinct(language))
    rows, which = _unique(np.column_stack([a_of[phrase], _distinct(grounding)]))
    count = np.zeros((correspondences, len(rows)))
    np.add.at(count, (label, which), weight)
    return Merged(a_rows, rows[:, 1:], rows[:, 0], count)


def _unique(rows: Bag) -> tuple[Bag, NDArray[np.int64]]:
    """`numpy.unique` of rows, with the inverse: most repeats fall away by a hash, before rows are sorted."""
    factors = np.random.default_rng(0).integers(1, 2**63, size=rows.shape[1], dtype=np.uint64) | np.uint64(1)
    hashed = (rows.astype(np.uint64) * factors).sum(axis=1, dtype=np.uint64)
    _, first, group = np.unique(hashed, return_index=True, return_inverse=True)
    group = group.reshape(-1)
    if not np.array_equal(rows[first][group], rows):  # two rows with one hash
        first, group = np.arange(len(rows)), np.arange(len(rows))
    found, which = np.unique(rows[first], axis=0, return_inverse=True)
    return found, which.reshape(-1)[group]


def tabulate(
    language: Bag,
    grounding: Bag,
    phrase: NDArray[np.int64],
    label: NDArray[np.int64],
    weight: NDArray[np.float64],
    shape: tuple[int, int, int],
) -> Table:
    """`merge`, as a table of columns (P, L, G)."""
    return merge(language, grounding, phrase, label, weight, shape[0]).table(shape[1:])


def _dense(bag: Bag, columns: int) -> torch.Tensor:
    """The (n, columns) binary matrix of a bag."""
    out = np.zeros((len(bag), columns + 1))
    np.put_along_axis(out, bag % (columns + 1), 1.0, axis=1)
    return torch.from_numpy(out[:, :columns].copy())


def objective(
    weight: torch.Tensor, tables: Sequence[Table], pairs: torch.Tensor, l2: float, prior: torch.Tensor | float = 0.0
) -> tuple[torch.Tensor, torch.Tensor]:
    """The penalised negative log-likelihood and its gradient with respect to `weight` (P, L, G).

    Args:
        tables: labelled factors; the objective is the sum over all.
    """
    value = 0.5 * l2 * (weight - prior).square().sum()
    gradient = torch.zeros_like(weight)
    padded = torch.nn.functional.pad(weight, (0, 1))
    for table in tables:
        by_phrase = (table.language @ padded).flatten(1)  # (P, A * (G + 1))
        n, k = table.position.shape
        flat = table.position.reshape(-1)
        scores = by_phrase.index_select(1, flat).view(len(weight), n, k).sum(2)  # (P, N)
        log_psi = torch.log_softmax(scores, dim=0)
        value = value - (table.count * log_psi).sum()
        residual = log_psi.exp() * table.count.sum(0) - table.count
        spread = torch.zeros_like(by_phrase).index_add_(1, flat, residual.repeat_interleave(k, dim=1))
        gradient += (table.language.T @ spread.view(len(weight), len(table.language), -1))[:, :, :-1]
    return value, (gradient + l2 * (weight - prior)) * pairs


def lbfgs(weight: torch.Tensor, tolerance: float, max_steps: int, history: int) -> torch.optim.LBFGS:
    """L-BFGS with a strong Wolfe search over one tensor; to be made anew for each fit, as it remembers the old shape.

    Args:
        tolerance: of the gradient's max-norm.
        history: curvature pairs kept.
    """
    return torch.optim.LBFGS(
        [weight],
        max_iter=max_steps,
        max_eval=2 * max_steps,
        history_size=history,
        tolerance_grad=tolerance,
        tolerance_change=1e-14,
        line_search_fn="strong_wolfe",
    )


def fit(
    model: LogLinearModel,
    tables: Sequence[Table],
    *,
    l2: float,
    tolerance: float = 1e-7,
    max_steps: int = 500,
    history: int = 20,
    free: NDArray[np.bool_] | None = None,
    prior: torch.Tensor | float = 0.0,
) -> FitResult:
    """Maximise the penalised likelihood by L-BFGS from the model's present weights, in place.

    The objective is strictly convex for l2 > 0, so the optimum does not depend on the start.

    Args:
        model: its `weight` is the start and receives the optimum.
        tables: the labelled factors.
        l2: strength of the penalty, > 0.
        tolerance: stop when the gradient's max-norm, per unit of the examples' weight, falls below it.
        max_steps: L-BFGS iterations at the most.
        history: curvature pairs kept.
        free: (L, G) the features whose weights may change, the others stay as they are; None: all.

    Raises:
        ValueError: l2 is not positive.
    """
    if l2 <= 0:
        raise ValueError(f"l2 must be positive, not {l2}: without it the optimum is not unique")
    began = time.perf_counter()
    tolerance *= max(1.0, sum(float(table.count.sum()) for table in tables))
    pairs = model.pairs if free is None else model.pairs & torch.from_numpy(free)
    every = None if free is None else pairs.expand_as(model.weight)

    def whole(moving: torch.Tensor) -> torch.Tensor:
        return moving if every is None else model.weight.masked_scatter(every, moving)

    # What stays as it is costs the optimiser nothing: it moves the free weights alone.
    weight = (model.weight.clone() if every is None else model.weight[every]).requires_grad_()
    optimizer = lbfgs(weight, tolerance, max_steps, history)

    def closure() -> float:
        with torch.no_grad():
            value, gradient = objective(whole(weight), tables, pairs, l2, prior)
            weight.grad = gradient if every is None else gradient[every]
        return float(value)

    optimizer.step(closure)  # type: ignore[no-untyped-call]
    state = optimizer.state[weight]
    with torch.no_grad():
        model.weight = whole(weight.detach())
        value, gradient = objective(model.weight, tables, pairs, l2, prior)
    norm = float(gradient.abs().max()) if gradient.numel() else 0.0
    steps = int(state["n_iter"])
    limit = steps >= max_steps or state["func_evals"] >= 2 * max_steps
    return FitResult(
        value=float(value),
        gradient=norm,
        steps=steps,
        evaluations=int(state["func_evals"]),
        rows=sum(len(table.position) for table in tables),
        status="converged" if norm <= tolerance else "step limit" if limit else "stalled",
        seconds=time.perf_counter() - began,
    )
