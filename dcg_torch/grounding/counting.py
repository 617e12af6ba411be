"""Counting things by their places: which way a side is, where a line begins, and what is lost by each place."""

from __future__ import annotations

import numpy as np

from dcg_torch.scene.layout import HEADINGS
from dcg_torch.types.arrays import Floats

_CALLED = {"left": "left side", "right": "right side", "back": "far side", "front": "near side"}
WAYS = {side: HEADINGS[heading] for side, heading in _CALLED.items()}
"""Side -> its direction, x and y, as who looks sees it."""
EVEN = 0.02
"""Units by which places differ at most that are one place."""
_BY_PLACE = 3.0
"""Nats for each place by which a thing stays behind the one that is counted."""


def start_of_line(position: Floats, *, picture: bool) -> tuple[str, float]:
    """The side at which counting begins that names none, and how wide things stand for the length of their line.

    A queue begins at its near end, a column of a picture at its top. What stands side by side is read from the left.

    Args:
        position: (things, 2 or 3) in units, as who looks sees them; at least one.
    """
    deep, across = np.ptp(position[:, 0]), np.ptp(position[:, 1])
    side = "left" if across >= deep else "back" if picture else "front"
    return side, float(min(deep, across) / max(deep, across, EVEN))


def behind(values: Floats, number: int, count: int, *, even: float = EVEN, nats: float = _BY_PLACE) -> Floats:
    """(things,) what is lost by the places from the most: the first `count`, or the one with a number, lose nothing.

    Args:
        even: values that differ by less are of one place.
        nats: lost for each place.
    """
    ahead: Floats = (values[None, :] > values[:, None] + even).sum(axis=1).astype(np.float64)
    return nats * (np.abs(ahead + 1 - number) if number > 1 else np.maximum(0.0, ahead + 1 - count))
