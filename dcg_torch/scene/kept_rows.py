"""Arrays with a row for each landmark, which are worked out once."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
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
        self._row: dict[int, int] = {}
        self._kept: Arrays = ()

    def of(self, numbers: Sequence[int]) -> Arrays:
        """The rows of some numbers; not to be written to."""
        new = [j for j in dict.fromkeys(numbers) if j not in self._row]
        if new:
            found = list(self._in_parts(new))
            blocks = [self._kept, *found] if self._row else found
            self._row |= {j: k for k, j in enumerate(new, start=len(self._row))}
            self._kept = blocks[0] if len(blocks) == 1 else tuple(map(_stacked, zip(*blocks, strict=True)))
        rows = [self._row[j] for j in numbers]
        if rows == list(range(len(self._row))):  # all of them, as is usual
            return self._kept
        return tuple([kept.take(rows, axis=-2) for kept in self._kept])

    def _in_parts(self, new: Sequence[int]) -> Iterator[Arrays]:
        step = self._most or len(new)
        return (self._find(np.array(new[start : start + step])) for start in range(0, len(new), step))


def _stacked(parts: Sequence[NDArray[Any]]) -> NDArray[Any]:
    return np.concatenate(parts, axis=-2)
