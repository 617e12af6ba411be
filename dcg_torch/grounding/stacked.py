"""What lies straight over and under one another: "the box on the red box" is the next one up, not the top of the stack.

That is measured, not learned: in most of what teaches "on top of" one thing lies on another, and no third.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from dcg_torch.grounding.encode import WorldEncoder
from dcg_torch.names.relations import listed
from dcg_torch.scene.layout import Layout
from dcg_torch.scene.neighbours import SAME_SPOT

Floats = NDArray[np.float64]
Bools = NDArray[np.bool_]

_OVER, _UNDER = listed("straight over"), listed("straight under")
_BETWEEN = "between"
_FARTHER = -2.0
"""Nats that a thing loses for each other of its type that lies between it and the landmark, up to two."""
_MANY = 2
_AMONG, _ELSEWHERE = -0.1, -5.0
"""Log Psi of what lies between two things of its stack, and the least that all else loses."""
_OVERLAP = 0.1
"""Units by which things that lie on one another may reach into each other."""
_LEVEL = 0.01
"""Units by which one thing is higher than another at least."""


def by_levels_of_stacks(
    name: str, log_psi: Floats, landmarks: Sequence[tuple[int, ...]], encoder: WorldEncoder, *, whole: bool = False
) -> Floats:
    """(combos, things) how well things stand over, under and between the things of stacks.

    Args:
        name: of the relation.
        log_psi: what is learned; it stays for other relations, and where nothing is straight over or under a landmark.
        whole: is all meant that lies that way, and not the next one?
    """
    up = 1.0 if name in _OVER else -1.0 if name in _UNDER else 0.0
    if up == 0.0 and name != _BETWEEN:
        return log_psi
    where, found = encoder.layout, log_psi
    stacked = set(where.near.stacked.nonzero()[0].tolist())
    for k, of in enumerate(landmarks):
        if len(of) != (1 if up else 2) or not stacked.issuperset(of):
            continue
        if up != 0.0:
            lost = _levels_off(of[0], up, where)
            if lost is not None:
                found = found.copy() if found is log_psi else found
                found[k] = np.where(lost <= 0.0, _AMONG, found[k]) if whole else found[k] + np.nan_to_num(lost)
        else:
            inside = _inside(of[0], of[1], where)
            if inside.any():
                found = found.copy() if found is log_psi else found
                found[k] = np.where(inside, _AMONG, np.minimum(log_psi[k], _ELSEWHERE))
    return found


def _straight(landmark: int, where: Layout) -> Bools:
    """(things,) what is on a landmark's spot, seen from above: what covers it, where extents are known."""
    offset = where.position[:, :2] - where.position[landmark, :2]
    found: Bools = where.solid & (np.hypot(*offset.T) < SAME_SPOT)
    if where.bodies is not None:
        n = len(where.bodies.half)
        _, apart = where.bodies.over(np.array([landmark]), offset[None, :n])
        found[:n] &= ~apart[0]
    return found


def _levels_off(landmark: int, up: float, where: Layout) -> Floats | None:
    """(things,) what those lose that lie beyond the next one, NaN for all else; None where fewer than two do."""
    lifted = _lifted(landmark, up, where)
    higher = lifted > _LEVEL
    if not higher.any():  # all stands on one level
        return None
    that_way = np.flatnonzero(higher & _straight(landmark, where))
    if len(that_way) < 2:
        return None
    heights, types = lifted[that_way], [where.things[j].type for j in that_way.tolist()]
    alike = np.array([[one == other for other in types] for one in types])
    nearer = (alike & (heights[None] < heights[:, None] - _LEVEL)).sum(axis=1)
    lost = np.full(len(lifted), np.nan)
    lost[that_way] = _FARTHER * np.minimum(nearer, _MANY)
    return lost


def _lifted(landmark: int, up: float, where: Layout) -> Floats:
    """(things,) how much higher each is than a landmark, with `up` -1 lower; from its top where that is known."""
    lifted: Floats = up * (where.position[:, 2] - where.position[landmark, 2])
    if where.bodies is not None:
        n, height = len(where.bodies.half), where.position[:, 2]
        bottom, top = (np.where(np.isfinite(v), v, height[:n]) for v in (where.bodies.bottom, where.bodies.top))
        clear = bottom - top[landmark] if up > 0.0 else bottom[landmark] - top
        lifted[:n] = np.where(clear < -_OVERLAP, 0.0, lifted[:n])
    return lifted


def _inside(one: int, other: int, where: Layout) -> Bools:
    """(things,) what lies between two things of one stack; nothing where they are of two."""
    height = where.position[:, 2]
    low, high = sorted((height[one], height[other]))
    found: Bools = (height > low + _LEVEL) & (height < high - _LEVEL)
    if found.any():
        straight = _straight(one, where)
        found &= straight & straight[other]
    return found
