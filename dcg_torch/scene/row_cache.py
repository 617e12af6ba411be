"""Arrays with a row for each landmark, which are worked out once."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from dcg_torch.types.arrays import Ints

Arrays = tuple[NDArray[Any], ...]

_MANY = 1024
"""Numbers from which one is found after the other: what is worked out of many takes room."""


class KeptRows:
    """Rows of arrays by number, kept once they are found: the last axis but one of each array is that of the rows.

    Args:
        find: the arrays of some numbers, a row for each.
        count: of all numbers.
    """

    def __init__(self, find: Callable[[Ints], Arrays], count: int) -> None:
        self._find = find
        self._count = count
        self._row: dict[int, int] = {}
        self._block: Arrays = ()
        self._together: dict[tuple[int, ...], Arrays] = {}

    def of(self, numbers: Sequence[int]) -> Arrays:
        """The rows of some numbers, one at least; not to be written to."""
        found = self._together.get(tuple(numbers))
        return self._looked_up(numbers) if found is None else found

    def _looked_up(self, numbers: Sequence[int]) -> Arrays:
        new = [j for j in dict.fromkeys(numbers) if j not in self._row]
        if new:
            step = len(new) if self._count <= _MANY else 1
            parts = [self._find(np.array(new[start : start + step])) for start in range(0, len(new), step)]
            blocks = [self._block, *parts] if self._row else parts
            joined = [np.concatenate(of, axis=-2) for of in zip(*blocks, strict=True)] if blocks[1:] else blocks[0]
            self._block = tuple(joined)
            self._row |= zip(new, range(len(self._row), len(self._row) + len(new)), strict=True)
        rows = [self._row[j] for j in numbers]
        all_of_them = rows == list(range(len(self._row)))
        whole = self._block if all_of_them else tuple([of.take(rows, axis=-2) for of in self._block])
        if self._count <= _MANY:
            self._together[tuple(numbers)] = whole  # the same are mostly asked for several times in a row
        return whole
