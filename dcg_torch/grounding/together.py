"""Several that stand together: "the two dots that almost touch", "the left one of the three cups".

People who count a few of many mean those that are nearest to one another. That is measured, not learned: a thing is as
likely one of N as the distance to its Nth nearest is small beside that of the closest N.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]
Bools = NDArray[np.bool_]

_TIGHT = 4.0
"""Nats that a thing loses for each e-fold by which its N stand wider than the closest."""
_FAR = -8.0
"""The most that it loses."""
_TOUCHING = 0.02
"""Share of the largest distance below which distances are alike."""


def closest_together(position: Floats, candidates: Bools, log_fit: Floats, several: int) -> tuple[Bools, Floats]:
    """The so many things that stand closest together, and how likely each thing is one of such.

    Args:
        position: (n, 3).
        candidates: (n,) the things that are compared; there are at least `several`.
        log_fit: (n,) what else says how well a thing is meant.

    Returns:
        (n,) which these are; (n,) the log-factor of every thing, 0 for these.
    """
    at = np.flatnonzero(candidates)
    away = np.linalg.norm(position[at, None] - position[None, at], axis=2)
    near = np.argsort(away, axis=1, kind="stable")[:, :several]
    wide = away[np.arange(len(at)), near[:, -1]] + _TOUCHING * away.max() + 1e-9
    loss = -_TIGHT * np.log(wide / wide.min())
    first = int((loss + log_fit[at]).argmax())
    found = np.zeros(len(position), dtype=np.bool_)
    found[at[near[first]]] = True
    log_close = np.full(len(position), _FAR)
    log_close[at] = np.maximum(_FAR, np.minimum(0.0, loss - loss[first]))
    return found, np.where(found, 0.0, log_close)
