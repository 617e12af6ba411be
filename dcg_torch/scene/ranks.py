"""What is to be said of a thing by its place alone: states, and its rank among those alike."""

from __future__ import annotations

import math

import numpy as np

from dcg_torch.scene.groups import ACROSS, ALONG, CLUSTER, ROW, STACK
from dcg_torch.scene.layout import HEADINGS, NEAREST, NEXT, SAME_SPOT, TIE, Bools, Floats, Ints, Layout

AXES = (
    *("left", "right", "far", "near", "high", "low", "big", "small", "tall", "short"),
    *("middle", "robot", "remote", "speaker"),
)
STATES = [
    *(f"state: {s}" for s in ("clear", "covered", "on the floor", "on something", "alone", "in a stack")),
    *(f"state: {s}" for s in ("beside something", "held", "in a row")),
    *(f"part: {s}" for s in (*HEADINGS, "of robot", "of speaker", ROW, STACK, CLUSTER, ACROSS, ALONG)),
    *(f"part: of {n}" for n in range(2, 11)),
]
"""The states of objects, and what places and groups are, that are always features; further attributes of objects become
features as they are met."""

_NUMBERED = [str(k) for k in range(1, NEAREST + 1)]
RANKS = [f"rank: {axis} {k}" for axis in AXES for k in (*_NUMBERED, "nth", "first")]
"""By number, and by what the phrase asks for: the nth of a row, one of the first few."""


def states(where: Layout) -> list[list[str]]:
    """Names of the state features of every thing, and of the colours in its stack or group."""
    things, solid = where.things, where.solid
    with np.errstate(invalid="ignore"):
        other = solid[None] & ~np.eye(len(things), dtype=np.bool_)
        column = other & (where.apart < SAME_SPOT)
        beside = other & (where.apart < NEXT)
    above, below = where.over.sum(axis=0), where.over.sum(axis=1)
    neighbours, stack, rows = beside.sum(axis=1), column.sum(axis=1), where.member.sum(axis=0)
    out = []
    for j, thing in enumerate(things):
        names = [f"{'state' if solid[j] else 'part'}: {a}" for a in sorted(thing.attributes)]
        if solid[j] and thing.position is not None:
            names += [
                "state: covered" if above[j] else "state: clear",
                "state: on something" if below[j] else "state: on the floor",
                "state: alone" if not neighbours[j] else "state: in a stack" if stack[j] else "state: beside something",
            ]
            if rows[j]:
                names.append("state: in a row")
            names += [f"stack color: {c}" for c in _colors(where, column[j])]
        elif where.group[j]:
            names += [f"group color: {c}" for c in _colors(where, where.member[j])]
        out.append(names)
    return out


def _colors(where: Layout, of: np.ndarray[tuple[int], np.dtype[np.bool_]]) -> list[str]:
    return sorted({c for j in np.flatnonzero(of) if (c := where.things[j].color) is not None})


def ranks(where: Layout, members: Bools | None = None, *, ordinal: int | None = None, count: int | None = None) -> Ints:
    """The rank features of every thing: its place along every axis among those that it is compared with.

    Args:
        members: (n,) the things compared, objects and groups each with their like; None: all.
        ordinal: what the phrase counts to: 2 for "the second cone".
        count: how many the phrase means: 2 for "the two cones on the right".

    Returns:
        (n, k) bag of indices into `RANKS`, padded with -1.
    """
    compared = np.ones(len(where.things), dtype=np.bool_) if members is None else members
    solid = where.solid
    alike: Bools = np.outer(solid, solid) | np.outer(where.group, where.group)
    alike &= np.outer(compared, compared).astype(np.bool_)
    values = _values(where)
    values[AXES.index("middle")] = _from_middle(where, alike)
    with np.errstate(invalid="ignore"):
        less = values[:, None, :] < values[:, :, None] - TIE  # (axes, j, k): is k before j?
    before = (less & alike[None]).sum(axis=2)  # (axes, n)
    there = np.isfinite(values) & alike.any(axis=1, keepdims=True).T
    first = np.arange(len(AXES))[:, None] * (NEAREST + 2)
    out = [np.where(there & (before < NEAREST), first + before, -1)]
    if ordinal is not None:
        out.append(np.where(there & (before == ordinal - 1), first + NEAREST, -1))
    if count is not None and count > 1:
        out.append(np.where(there & (before < count), first + NEAREST + 1, -1))
    bag: Ints = np.concatenate(out).T
    return bag


def _values(where: Layout) -> Floats:
    """(axes, n): the lower, the earlier along the axis."""
    x, y, z = where.position.T
    unsized = where.place | where.group
    sizes = [(math.nan,) * 3 if o.size is None or unsized[j] else o.size for j, o in enumerate(where.things)]
    volume, height = np.array([math.prod(s) for s in sizes]), np.array([s[2] for s in sizes])
    nothing = np.full(len(x), math.nan)
    with np.errstate(invalid="ignore"):
        to_robot = np.hypot(x, y)
        to_speaker = nothing if where.speaker is None else np.hypot(*(where.position[:, :2] - where.speaker).T)
    along = (-y, y, -x, x, -z, z, -volume, volume, -height, height)
    return np.stack([*along, nothing, to_robot, -to_robot, to_speaker])


def _from_middle(where: Layout, alike: Bools) -> Floats:
    """(n,) distance of every thing to the middle of those alike; NaN where there are none."""
    with np.errstate(invalid="ignore", divide="ignore"):
        middle = (alike @ np.nan_to_num(where.position)) / alike.sum(axis=1)[:, None]
        distance: Floats = np.linalg.norm(where.position - middle, axis=1)
    return distance
