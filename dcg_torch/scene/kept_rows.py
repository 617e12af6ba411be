"""Arrays with a row for each landmark, which are worked out once."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

Arrays = tuple[NDArray[Any], ...]

_MANY = 1024
"""Numbers from which one is found after the other: what is worked out of many takes room."""


class KeptRows:
    """Rows of arrays by number, kept once they are found: the last axis but one of each array is that of the rows.

    Args:
        find: the arrays of some numbers, a row for each.
        count: of all numbers.
    """

    def __init__(self, find: Callable[[NDArray[np.int64]], Arrays], count: int) -> None:
        self._find = find
        self._count = count
        self._kept: dict[int, tuple[Arrays, int]] = {}
        self._together: dict[tuple[int, ...], Arrays] = {}

    def of(self, numbers: Sequence[int]) -> Arrays:
        """The rows of some numbers; not to be written to."""
        found = self._together.get(tuple(numbers))
        return self._looked_up(numbers) if found is None else found

    def _looked_up(self, numbers: Sequence[int]) -> Arrays:
        new = [j for j in dict.fromkeys(numbers) if j not in self._kept]
        step = len(new) or 1 if self._count <= _MANY else 1
        for start in range(0, len(new), step):
            part = new[start : start + step]
            found = self._find(np.array(part))
            self._together[tuple(part)] = found
            self._kept |= {j: (found, row) for row, j in enumerate(part)}
        if len(new) == len(numbers) and (whole := self._together.get(tuple(numbers))) is not None:
            return whole  # as is usual
        whole = self._joined([self._kept[j] for j in numbers])
        if self._count <= _MANY:
            self._together[tuple(numbers)] = whole  # the same are mostly asked for several times in a row
        return whole

    @staticmethod
    def _joined(kept: Sequence[tuple[Arrays, int]]) -> Arrays:
        """The rows of some blocks as one block."""
        block = kept[0][0]
        if all(one is block for one, _ in kept):
            rows = [row for _, row in kept]
            return tuple([one.take(rows, axis=-2) for one in block])
        slices = [[one[..., row : row + 1, :] for one in found] for found, row in kept]
        return tuple([np.concatenate(parts, axis=-2) for parts in zip(*slices, strict=True)])
