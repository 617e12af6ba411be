"""Weights of new columns: zeros, and those from which a fit arrives in fewer steps.

The optimum does not depend on where a fit starts.
"""

from __future__ import annotations

from collections.abc import Iterable
from typing import TypeVar

import numpy as np
from numpy.typing import NDArray

from dcg_torch.fitting.psi import LogLinearFactor
from dcg_torch.grounding.features import FeatureSet
from dcg_torch.types import Symbol

Value = TypeVar("Value", bound=np.generic)


def widened(values: NDArray[Value], shape: tuple[int, int]) -> NDArray[Value]:
    """(..., L, G) values with zeros for the columns that are new."""
    wider = np.zeros((*values.shape[:-2], *shape), dtype=values.dtype)
    wider[..., : values.shape[-2], : values.shape[-1]] = values
    return wider


def start_as_the_last(
    factor: LogLinearFactor, features: FeatureSet, before: tuple[int, int], symbols: Iterable[Symbol]
) -> None:
    """Give a new noun and its new type the weights of the last ones before them, in place.

    Args:
        factor, features: with the new columns, whose weights are zero.
        before: how many columns of language and groundings there were.
        symbols: in the order of learning; where the last is not the one that is new, nothing is done.
    """
    at = [
        (features.language.get(f"noun: {s.word}", -1), features.grounding.get(f"type: {s.type}", -1)) for s in symbols
    ]
    old = [(row, column) for row, column in at if 0 <= row < before[0] and 0 <= column < before[1]]
    if len(old) < 2 or at[-1][0] < before[0] or at[-1][1] < before[1]:
        return
    (_, other), (row, column), (new_row, new_column) = old[-2], old[-1], at[-1]
    weight = factor.weight.detach().cpu().numpy().copy()
    weight[:, new_row], weight[:, :, new_column] = weight[:, row], weight[:, :, column]
    weight[:, new_row, new_column] = weight[:, row, column]
    weight[:, new_row, column] = weight[:, row, new_column] = weight[:, row, other]
    factor.set_weight(np.where(factor.pairs.cpu().numpy(), weight, 0.0))
