"""What lies on, over, under and between things: "the box on the red box" is the next one up, not the top of the stack.

That is measured, not learned: in most of what teaches "on top of" one thing lies on another, and no third. Where
extents are known, what lies on one board of a shelf is on that board and not on the next. What is straight over a
thing, or under it, is so rather than what is aslant, how far up it may be.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from dcg_torch.grounding.encoding import WorldEncoder
from dcg_torch.grounding.measured_relations import TOUCHING, gaps
from dcg_torch.names.relations import listed
from dcg_torch.scene.bodies import Bodies
from dcg_torch.scene.layout import Layout
from dcg_torch.scene.neighbours import LEVEL, SAME_SPOT
from dcg_torch.types.arrays import Bools, Floats, Ints

_OVER, _UNDER = listed("straight over"), listed("straight under")
_ON, _UPRIGHT = listed("resting on"), {"above"} | _UNDER
"""Of those, what says that one thing touches another, and what says in which direction it is."""
_BETWEEN = "between"
_OVERLAP = 0.1
"""Units by which things may reach into what they lie on."""
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
_FARTHER, _MANY = -2.0, 2
"""Nats that a thing loses for each other of its type that lies between it and the landmark, and the most that count."""
_AMONG, _ELSEWHERE = -0.1, -5.0
"""Log Psi of what lies between two things of its stack, and the least that all else loses."""


def by_height(
    name: str, log_psi: Floats, landmarks: Sequence[tuple[int, ...]], encoder: WorldEncoder, *, whole: bool = False
) -> Floats:
    """(combos, things) log Psi of a modifier, with what heights and extents say of it.

    Args:
        name: of the relation.
        log_psi: what is learned; it stays for other relations, and where heights tell nothing.
        whole: is all meant that lies that way, and not the next one?
    """
    up = 1.0 if name in _OVER else -1.0 if name in _UNDER else 0.0
    marks = np.array(landmarks)
    if up == 0.0 or marks.shape[1] != 1:
        return _between(marks, log_psi, encoder) if name == _BETWEEN and marks.shape[1] == 2 else log_psi
    mark, bodies = marks[:, 0], encoder.layout.bodies
    if bodies is not None and (mark < len(bodies.half)).all():
        if name in _ON:
            log_psi = _resting(mark, bodies, log_psi, encoder)
        elif name in _UPRIGHT:
            log_psi = _straightest(up, mark, log_psi, encoder)
    return _next_ones(up, mark, log_psi, encoder, whole=whole)


def _resting(mark: Ints, bodies: Bodies, log_psi: Floats, encoder: WorldEncoder) -> Floats:
    """(combos, things) what is over or under a landmark is not on it where others are."""
    n = len(bodies.half)
    covers, step = _steps(mark, bodies, encoder.layout)
    covers[np.arange(len(mark)), mark] = False
    others = (covers & (step == 1)).any(axis=1)[:, None]
    found = log_psi.copy()
    found[:, :n] -= np.where(covers & (step != 1) & others, _NOT_ON, 0.0)
    return found


def _straightest(up: float, mark: Ints, log_psi: Floats, encoder: WorldEncoder) -> Floats:
    """(combos, things) what is straight over a landmark, or under it, where anything is, and the nearest of that."""
    rise, so = _that_way(up, mark, encoder.layout)
    gap = gaps(mark.tolist(), encoder)[0]
    so &= np.isfinite(gap)
    gap = np.where(so, gap, np.inf)
    least = gap.min(axis=1, keepdims=True)
    any_so = least <= _REACH
    aslant = np.where(so, gap - np.where(any_so, least, 0.0), 0.0)
    nearest = np.where(so & (aslant <= TOUCHING), rise, np.inf).min(axis=1, keepdims=True)
    farther = np.where(so, rise, 1.0) / np.where(np.isfinite(nearest), nearest, 1.0)
    lost = _ASLANT * aslant + _FOLD * np.log(np.maximum(1.0, farther))
    lost += np.where((least <= 0.0) & (aslant > _CLEAR), _BESIDE, 0.0)
    found: Floats = np.where(so, np.maximum(log_psi, -lost), log_psi - _NOT_SO)
    return np.where(any_so & encoder.layout.solid, found, log_psi)


def _next_ones(up: float, mark: Ints, log_psi: Floats, encoder: WorldEncoder, *, whole: bool) -> Floats:
    """(combos, things) of the things of a stack the next one of each type, unless the whole is meant."""
    where, found = encoder.layout, log_psi
    some = where.stacked[mark].nonzero()[0].tolist()
    if not some:
        return log_psi
    for k, rise, so in zip(some, *_that_way(up, mark[some], where), strict=True):
        stacked = np.flatnonzero(so & _on_the_spot(mark[k], where)) if so.any() else ()
        if len(stacked) < 2:
            continue
        alike, heights = encoder.type_number[stacked], rise[stacked]
        nearer = ((alike[None] == alike[:, None]) & (heights[None] < heights[:, None] - LEVEL)).sum(axis=1)
        found = found.copy() if found is log_psi else found
        if whole:
            found[k, stacked] = _AMONG
        else:
            found[k, stacked] += _FARTHER * np.minimum(nearer, _MANY)
    return found


def _between(marks: Ints, log_psi: Floats, encoder: WorldEncoder) -> Floats:
    """(combos, things) what lies between two things of one stack; the rest where they are of two."""
    where, found = encoder.layout, log_psi
    height = where.position[:, 2]
    for k in np.flatnonzero(where.stacked[marks].all(axis=1)).tolist():
        one, other = marks[k]
        low, high = sorted((height[one], height[other]))
        inside = (height > low + LEVEL) & (height < high - LEVEL)
        if inside.any():
            spot = _on_the_spot(one, where)
            inside &= spot & spot[other]
        if inside.any():
            found = found.copy() if found is log_psi else found
            found[k] = np.where(inside, _AMONG, np.minimum(log_psi[k], _ELSEWHERE))
    return found


def _on_the_spot(landmark: int, where: Layout) -> Bools:
    """(things,) what is straight over or under a landmark: with extents, what shares floor and is not inside it."""
    offset = where.position - where.position[landmark]
    found: Bools = where.solid & (np.hypot(*offset[:, :2].T) < SAME_SPOT)
    if where.bodies is not None:
        n, height = len(where.bodies.half), where.position[:, 2]
        _, apart = where.bodies.over(np.array([landmark]), offset[None, :n])
        bottom, top = (np.where(np.isfinite(v), v, height[:n]) for v in (where.bodies.bottom, where.bodies.top))
        inside = np.where(offset[:n, 2] > 0.0, top[landmark] - bottom, top - bottom[landmark]) > _OVERLAP
        found[:n] &= ~(apart[0] | inside)
    return found


def _that_way(up: float, mark: Ints, where: Layout) -> tuple[Floats, Bools]:
    """(combos, things) by how many units each thing is higher than a landmark, and whether that makes it one over it.

    Where extents are known its foot is higher than the landmark's middle, or it lies on the landmark. With `up` -1 all
    of that the other way round.
    """
    height = where.position[:, 2]
    with np.errstate(invalid="ignore"):
        rise = up * (height[None] - height[mark][:, None])
        so = rise > LEVEL
    if where.bodies is not None:
        bodies, n = where.bodies, len(where.bodies.half)
        middle, foot = (bodies.bottom + bodies.top) / 2.0, bodies.bottom
        with np.errstate(invalid="ignore"):
            lower = foot[None] < middle[mark][:, None] if up > 0.0 else foot[mark][:, None] < middle[None]
        so[:, :n] &= ~lower | (up * _steps(mark, bodies, where)[1] > 0)
    return rise, so


def _steps(mark: Ints, bodies: Bodies, where: Layout) -> tuple[Bools, Ints]:
    """(combos, things) which cover a landmark, seen from above, and how far up or down they are; see `Bodies.steps`."""
    at = where.position[: len(bodies.half), :2]
    covers, _ = bodies.over(mark, at[None] - at[mark][:, None])
    return covers, bodies.steps(mark, covers)
