"""A value for each thing of a world, by its id."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from itertools import islice

import numpy as np

from dcg_torch.types.arrays import Floats


class ByThing(Mapping[str, float]):
    """A value for each of the first things of a world, by id.

    Args:
        number: id of a thing -> its number, in the order of the numbers.
        values: (things,) those of the first of them.
    """

    def __init__(self, number: Mapping[str, int], values: Floats) -> None:
        self._number = number
        self._values = values

    def __getitem__(self, id_: str) -> float:
        number = self._number[id_]
        if number >= len(self._values):
            raise KeyError(id_)
        return float(self._values[number])

    def __iter__(self) -> Iterator[str]:
        return islice(self._number, len(self._values))

    def __len__(self) -> int:
        return len(self._values)

    def __repr__(self) -> str:
        return repr(dict(self))

    @staticmethod
    def mixture(parts: Sequence[Mapping[str, float]], shares: Sequence[float]) -> ByThing | None:
        """The sum of some mappings, each times its share; None unless all are of the very same things."""
        same = [part for part in parts if isinstance(part, ByThing)]
        if len(same) < len(parts) or any(p._number is not same[0]._number or len(p) != len(same[0]) for p in same):
            return None
        total = np.zeros(len(same[0]))
        for part, share in zip(same, shares, strict=True):
            total += part._values * share
        return ByThing(same[0]._number, total)
