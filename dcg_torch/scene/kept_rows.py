"""Arrays with a row for each landmark, which are worked out once."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

Arrays = tuple[NDArray[Any], ...]


class KeptRows:
    """Rows of arrays by number, kept once they are found: the last axis but one of each array is that of the rows.

    Args:
        find: the arrays of some numbers, a row for each.
        most: numbers that are looked for at once; None: all that are asked for.
    """

    def __init__(self, find: Callable[[NDArray[np.int64]], Arrays], most: int | None = None) -> None:
        self._find = find
        self._most = most
        self._kept: dict[int, tuple[Arrays, int]] = {}
        self._together: dict[tuple[int, ...], Arrays] = {}

    def of(self, numbers: Sequence[int]) -> Arrays:
        """The rows of some numbers; not to be written to."""
        found = self._together.get(tuple(numbers))
        return self._looked_up(numbers) if found is None else found

    def _looked_up(self, numbers: Sequence[int]) -> Arrays:
        new = [j for j in dict.fromkeys(numbers) if j not in self._kept]
        step = self._most or len(new)
        for start in range(0, len(new), step or 1):
            part = new[start : start + step]
            found = self._find(np.array(part))
            self._together[tuple(part)] = found
            self._kept |= {j: (found, row) for row, j in enumerate(part)}
        if len(new) == len(numbers) and (whole := self._together.get(tuple(numbers))) is not None:
            return whole  # as is usual
        kept = [self._kept[j] for j in numbers]
        block = kept[0][0]
        if all(one is block for one, _ in kept):
            return tuple([one.take([row for _, row in kept], axis=-2) for one in block])
        slices = [[one[..., row : row + 1, :] for one in found] for found, row in kept]
        return tuple([np.concatenate(parts, axis=-2) for parts in zip(*slices, strict=True)])
