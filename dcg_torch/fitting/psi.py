"""The log-linear factor Psi: how probable each correspondence of a phrase and a grounding is.

Mathematics (eqs. 4, 8 and 9 of the paper, for factor n and correspondence phi)

    score[n, phi]   = sum_{l, g} language[n, l] * weight[phi, l, g] * grounding[n, g]
    log Psi[n, phi] = score[n, phi] - log sum_{phi'} exp score[n, phi']

`language` and `grounding` are binary, so a row is stored as the list of its ones, and a score is a sum of weights.

Conventions
    P   correspondences: (INVERTED, INACTIVE, ACTIVE) of eq. 4, or (INACTIVE, ACTIVE) of eqs. 6, 8 and 9
    L   language columns; G  grounding columns
    pairs is an (L, G) mask: the (l, g) that are features; all other weights are zero and stay so
    a bag is an integer array of shape (n, k): the columns that are one in each row, padded with -1
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
import torch
from numpy.typing import NDArray
from torch import nn

from dcg_torch.types import Correspondence
from dcg_torch.types.arrays import Bools, Floats, Ints

Numbers = NDArray[np.signedinteger[Any]]
Bag = Numbers

TERNARY = (Correspondence.INVERTED, Correspondence.INACTIVE, Correspondence.ACTIVE)
BINARY = (Correspondence.INACTIVE, Correspondence.ACTIVE)


class LogLinearFactor(nn.Module):
    """Psi with its weights, float64.

    Attributes:
        correspondences: what the P axis of `weight` stands for.
        weight: (P, L, G) parameter. `fit` sets it, so it needs no gradient; `requires_grad_()` asks for one.
        pairs: (L, G) boolean buffer.

    Args:
        pairs: (L, G) mask of the features.
        device: of the weights; the processor if None.
    """

    if TYPE_CHECKING:
        pairs: torch.Tensor

    def __init__(
        self,
        pairs: Bools,
        correspondences: tuple[Correspondence, ...] = TERNARY,
        device: torch.device | str | None = None,
    ) -> None:
        super().__init__()
        self.correspondences = correspondences
        self.register_buffer("pairs", torch.as_tensor(pairs, device=device))
        zero = torch.zeros(len(correspondences), *pairs.shape, dtype=torch.float64, device=device)
        self.weight = nn.Parameter(zero, requires_grad=False)

    def set_weight(self, weight: torch.Tensor | Floats) -> None:
        """Take over weights (P, L, G), which are not copied.

        Raises:
            ValueError: they have another shape.
        """
        values = torch.as_tensor(weight, dtype=torch.float64, device=self.weight.device)
        if values.shape != self.weight.shape:
            raise ValueError(f"weights of shape {tuple(values.shape)} for a factor of {tuple(self.weight.shape)}")
        self.weight = nn.Parameter(values.detach(), requires_grad=self.weight.requires_grad)

    def grow(self, pairs: Bools) -> None:
        """Add columns of zero weight; every old probability stays bit-identical.

        Args:
            pairs: (L', G') the mask with the new columns appended, L' >= L and G' >= G.

        Raises:
            ValueError: the new mask is smaller, or differs from the old one where both have columns.
        """
        old, (languages, groundings) = self.weight, self.weight.shape[1:]
        mask = torch.as_tensor(pairs, device=old.device)
        grown = mask.shape[0] >= languages and mask.shape[1] >= groundings
        # The meta device has shapes alone to compare.
        if not grown or not (mask.is_meta or _equal(mask[:languages, :groundings], self.pairs)):
            raise ValueError(
                f"a mask of {pairs.shape} columns does not extend the old one of {(languages, groundings)}"
            )
        weight = torch.zeros(old.shape[0], *pairs.shape, dtype=torch.float64, device=old.device)
        weight[:, :languages, :groundings] = old.detach()
        self.pairs = mask
        self.weight = nn.Parameter(weight, requires_grad=old.requires_grad)

    def log_psi(self, language: Bag, grounding: Bag, phrase: Ints) -> torch.Tensor:
        """log Psi of n factors.

        On the processor equal factors have equal bits wherever they stand, or a tie between two objects would not be
        one: sums are elementwise, column by column, in an order that depends on what fires alone.

        Args:
            language: (m, k) bag, a row per phrase.
            grounding: (n, k') bag, a row per factor.
            phrase: (n,) which row of `language` belongs to each factor.

        Returns:
            (n, P) log-probabilities.
        """
        weight = self.weight
        if weight.device.type != "cpu" or weight.requires_grad:
            return self._differentiable(language, grounding, phrase)
        total = scores(weight.numpy(), distinct(language), distinct(grounding), phrase)
        total -= total.max(axis=0)
        total -= np.log(np.exp(total).sum(axis=0))
        return torch.from_numpy(total.T)

    def _differentiable(self, language: Bag, grounding: Bag, phrase: Ints) -> torch.Tensor:
        """The same in torch: for other devices, and where gradients are asked for."""
        weight = self.weight
        left, right = (
            torch.as_tensor(binary(bag, n), device=weight.device)
            for bag, n in zip((language, grounding), weight.shape[1:], strict=True)
        )
        of_phrase = torch.einsum("ml,plg->mpg", left, weight)
        where = torch.as_tensor(phrase, device=weight.device)
        return torch.log_softmax(torch.einsum("npg,ng->np", of_phrase[where], right), dim=1)

    def forward(self, *arguments: Any) -> torch.Tensor:
        """log Psi of n factors, as `log_psi`."""
        return self.log_psi(*arguments)


def _equal(one: torch.Tensor, other: torch.Tensor) -> bool:
    if one.device.type == "cpu":  # numpy compares parts of arrays without a copy
        return np.array_equal(one.numpy(), other.numpy())
    return torch.equal(one, other)


def distinct(bag: Bag) -> Bag:
    """The rows sorted, every column named once: a binary feature that is named twice fires once."""
    rows = np.sort(bag, axis=1)
    repeated = (rows[:, 1:] == rows[:, :-1]) & (rows[:, 1:] >= 0)
    if not repeated.any():
        return rows
    rows[:, 1:][repeated] = -1
    return np.sort(rows, axis=1)


def scores(weight: Floats, language: Bag, grounding: Bag, phrase: Ints) -> Floats:
    """(P, n) scores of factors whose bags name no column twice; for the arguments see `LogLinearFactor.log_psi`."""
    size, m = weight.shape[2] + 1, len(language)
    of_phrase = np.zeros((len(weight), m, size))  # the last column stays zero: it is what padding adds
    for row, columns in enumerate(language.tolist()):
        own = of_phrase[:, row, :-1]
        for column in columns:
            if column >= 0:
                own += weight[:, column]
    flat = of_phrase.reshape(len(weight), m * size)
    cells = wrapped(grounding, size) + (phrase * size)[:, None]
    total = np.zeros((len(weight), len(grounding)))
    for k in range(grounding.shape[1]):
        total += flat.take(cells[:, k], axis=1)
    return total


def wrapped(bag: Bag, size: int) -> Ints:
    """The bag (n, k) with its padding, -1, as the last column, size - 1."""
    found: Ints = bag.astype(np.int64, copy=False) % size  # short integers may not hold the size
    return found


def binary(bag: Bag, columns: int) -> Floats:
    """The (n, columns) binary matrix of a bag."""
    out = np.zeros((len(bag), columns + 1))
    np.put_along_axis(out, wrapped(bag, columns + 1), 1.0, axis=1)
    return out[:, :columns].copy()
