"""What is on, over or under a thing, as far as extents say it.

What lies on one board of a shelf is on that board and not on the next. What is straight over a thing, or under it, is
so rather than what is aslant, how far up it may be. That is measured, not learned.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from dcg_torch.grounding.encode import WorldEncoder
from dcg_torch.grounding.reach import TOUCHING, gaps
from dcg_torch.names.relations import listed
from dcg_torch.scene.bodies import Bodies

Floats = NDArray[np.float64]
Bools = NDArray[np.bool_]

_ON = listed("resting on")
_UPRIGHT = {"above": 1.0, "under": -1.0, "below": -1.0}
_NOT_ON = 5.0
"""Nats that a thing loses that is over or under a landmark on which others are."""
_REACH = 0.6
"""Units of a gap, seen from above, up to which a thing is over or under another."""
_ASLANT, _FOLD, _NOT_SO = 2.0, 0.7, 3.0
"""Nats that a thing loses for each unit by which it is less straight over or under another than the straightest, for
each e-fold by which it is farther up or down than the nearest that is so, and where it is neither over nor under."""
_CLEAR, _BESIDE = 0.03, 2.0
"""Units of a gap from which on a thing is over or under no part of another, and nats that it loses where others are:
of two cabinets side by side the one below the printer is under it."""


def by_height(name: str, log_psi: Floats, landmarks: Sequence[tuple[int, ...]], encoder: WorldEncoder) -> Floats:
    """(combos, things) of a modifier, with what extents say of it.

    Args:
        name: of the relation.
        log_psi: what is learned; it stays for other relations, and where nobody says how large things are.
    """
    bodies = encoder.layout.bodies
    if bodies is None or name not in _ON | _UPRIGHT.keys():
        return log_psi
    if any(len(of) != 1 or of[0] >= len(bodies.half) for of in landmarks):
        return log_psi
    mark = np.array([of[0] for of in landmarks])
    return _resting(mark, log_psi, encoder) if name in _ON else _straight(_UPRIGHT[name], mark, log_psi, encoder)


def _resting(mark: NDArray[np.int64], log_psi: Floats, encoder: WorldEncoder) -> Floats:
    """What is over or under a landmark is not on it where others are."""
    where, bodies = encoder.layout, encoder.layout.bodies
    assert bodies is not None
    at = where.position[: len(bodies.half), :2]
    covers, step = _steps(mark, bodies, at)
    covers[np.arange(len(mark)), mark] = False
    others = (covers & (step == 1)).any(axis=1)[:, None]
    found = log_psi.copy()
    found[:, : len(at)] -= np.where(covers & (step != 1) & others, _NOT_ON, 0.0)
    return found


def _straight(up: float, mark: NDArray[np.int64], log_psi: Floats, encoder: WorldEncoder) -> Floats:
    """What is straight over a landmark, or under it, where anything is.

    Args:
        up: 1 over, -1 under.
    """
    where, bodies = encoder.layout, encoder.layout.bodies
    assert bodies is not None
    height = where.position[:, 2]
    with np.errstate(invalid="ignore"):
        gap, rise = gaps(mark.tolist(), encoder)[0], up * (height[None] - height[mark][:, None])
        so = np.isfinite(gap) & (rise > TOUCHING)
    so[:, : len(bodies.half)] &= _is_over(up, mark, bodies, where.position[: len(bodies.half), :2])
    gap = np.where(so, gap, np.inf)
    least = gap.min(axis=1, keepdims=True)
    any_so = least <= _REACH
    aslant = np.where(so, gap - np.where(any_so, least, 0.0), 0.0)
    nearest = np.where(so & (aslant <= TOUCHING), rise, np.inf).min(axis=1, keepdims=True)
    farther = np.where(so, rise, 1.0) / np.where(np.isfinite(nearest), nearest, 1.0)
    lost = _ASLANT * aslant + _FOLD * np.log(np.maximum(1.0, farther))
    lost += np.where((least <= 0.0) & (aslant > _CLEAR), _BESIDE, 0.0)
    found: Floats = np.where(so, np.maximum(log_psi, -lost), log_psi - _NOT_SO)
    return np.where(any_so & where.solid, found, log_psi)


def _steps(mark: NDArray[np.int64], bodies: Bodies, at: Floats) -> tuple[Bools, NDArray[np.int64]]:
    """(combos, things) which cover a landmark, seen from above, and how far up or down they are; see `Bodies.steps`."""
    covers, _ = bodies.over(mark, at[None] - at[mark][:, None])
    return covers, bodies.steps(mark, covers)


def _is_over(up: float, mark: NDArray[np.int64], bodies: Bodies, at: Floats) -> Bools:
    """(combos, things) is a thing's foot higher than the landmark's middle, or on it; with `up` -1 the other way round?

    What nobody says the size of may be.
    """
    middle, foot = (bodies.bottom + bodies.top) / 2.0, bodies.bottom
    with np.errstate(invalid="ignore"):
        lower = foot[None] < middle[mark][:, None] if up > 0.0 else foot[mark][:, None] < middle[None]
    return ~lower | (up * _steps(mark, bodies, at)[1] > 0)
