"""A path with the place reached on it: where to steer next, how much is left.

Conventions: metres; a path is (k, 2) float64 with k >= 2.
"""

from __future__ import annotations

import bisect
import itertools
import math

import numpy as np

from dcg_torch.types.arrays import Points

_WINDOW = 0.5


class Track:
    """A path with the place reached on it, measured in metres along it."""

    def __init__(self, path: Points) -> None:
        steps = np.linalg.norm(np.diff(path, axis=0), axis=1)
        # plain floats: one short path is asked thousands of times
        corners = path[np.concatenate([[True], steps > 1e-9])]
        self._corners: list[tuple[float, float]] = [(float(x), float(y)) for x, y in corners]
        self._at = [0.0, *np.cumsum(steps[steps > 1e-9]).tolist()]
        self.length: float = self._at[-1]
        self._reached = 0.0

    def progress(self, x: float, y: float) -> float:
        """The place on the path nearest to (x, y), at most `_WINDOW` metres on from the last one; never back."""
        best, found = math.inf, self._reached
        pieces = zip(itertools.pairwise(self._corners), itertools.pairwise(self._at), strict=True)
        for (a, b), (begin, end) in pieces:
            low, high = max(begin, self._reached), min(end, self._reached + _WINDOW)
            if low > high:
                continue
            ux, uy = (b[0] - a[0]) / (end - begin), (b[1] - a[1]) / (end - begin)
            place = min(max(begin + (x - a[0]) * ux + (y - a[1]) * uy, low), high)
            distance = math.hypot(a[0] + (place - begin) * ux - x, a[1] + (place - begin) * uy - y)
            if distance < best:
                best, found = distance, place
        self._reached = found
        return found

    def point(self, place: float) -> tuple[float, float]:
        """The point `place` metres along; beyond the end, straight on."""
        if self.length == 0.0:
            return self._corners[0]
        piece = min(bisect.bisect_right(self._at, place), len(self._at) - 1)
        (a, b), begin, end = self._corners[piece - 1 : piece + 1], self._at[piece - 1], self._at[piece]
        part = (place - begin) / (end - begin)
        return a[0] + part * (b[0] - a[0]), a[1] + part * (b[1] - a[1])

    def rest(self, place: float) -> Points:
        """The path from `place` on, as (k, 2)."""
        later = [corner for corner, at in zip(self._corners, self._at, strict=True) if at > place]
        return np.array([self.point(place), *(later or [self._corners[-1]])], dtype=np.float64)
