"""What is to be said of a thing by its place alone: states, and its rank among those alike."""

from __future__ import annotations

import functools
import math

import numpy as np

from dcg_torch.names.vocabulary import MIDDLE_LINE, WORKED_OUT
from dcg_torch.scene.bodies import bulk
from dcg_torch.scene.groups import ACROSS, ALONG, CLUSTER, ROW, STACK
from dcg_torch.scene.layout import HEADINGS, LINE_NUMBERS, LINES, NEAREST, Layout
from dcg_torch.scene.order import TIE, Alike, counted, signatures
from dcg_torch.scene.order import before as lower
from dcg_torch.types.arrays import Bools, Floats, Ints

AXES = (
    *("left", "right", "far", "near", "high", "low", "big", "small", "tall", "short"),
    *("middle", "robot", "remote", "speaker", "apart", "medium"),
)
STATES = [
    *(f"state: {s}" for s in ("clear", "covered", "on the floor", "on something", "alone", "in a stack")),
    *(f"state: {s}" for s in ("beside something", "held", "in a row")),
    *(f"part: {s}" for s in (*HEADINGS, "of robot", "of speaker", ROW, STACK, CLUSTER, ACROSS, ALONG)),
    *(f"part: {s}" for s in (*LINES, *LINE_NUMBERS, MIDDLE_LINE)),
    *(f"part: of {n}" for n in range(2, 11)),
]
"""The states of objects, and what places and groups are, that are always features; further attributes of objects become
features as they are met."""

_NUMBERED = [str(k) for k in range(1, NEAREST + 1)]
RANKS = [f"rank: {axis} {k}" for axis in AXES for k in (*_NUMBERED, "nth")]
"""By number, and by what the phrase asks for: the nth of a row."""


def states(where: Layout) -> list[list[str]]:
    """Names of the state features of every thing, and of the colours in its stack or group."""
    distinct, which = state_signatures(where)
    return [list(distinct[k]) for k in which.tolist()]


def state_signatures(where: Layout) -> tuple[list[tuple[str, ...]], Ints]:
    """The state features that things have together, each set once, and (n,) which of the sets each thing has."""
    things, solid, near = where.things, where.solid, where.near
    count = int(solid.sum())
    there = np.isfinite(where.position[:count]).all(axis=1)
    in_row = np.zeros(len(things), dtype=np.bool_)
    rows = [members for group, members in where.members.items() if not where.line[group]]
    if rows:
        in_row[np.concatenate(rows)] = True
    beside = np.where(near.stacked, 1, np.where(near.beside, 2, 0))
    code = near.covered + 2 * near.resting + 4 * beside + 12 * in_row[:count] + 24
    code = np.where(there, code, 0)  # what is nowhere has attributes alone
    attributes = [o.attributes for o in things]
    around: list[tuple[int, ...] | None] = [None] * count
    for j, others in near.colors.items():
        around[j] = others
    first, kind = signatures(attributes[:count], code, around) if count else ([], np.zeros(0, dtype=np.int64))
    codes = code[first].tolist()
    stacked = [tuple([where.colors[c] for c in around[j] or ()]) for j in first]
    names = [_state_names(attributes[j], k, colors) for j, k, colors in zip(first, codes, stacked, strict=True)]
    which = kind.tolist()
    for j in range(count, len(things)):
        inside = {things[m].color for m in where.members[j].tolist()} if j in where.members else ()
        which.append(len(names))
        names.append(_part_names(attributes[j], tuple(sorted([c for c in inside if c is not None]))))
    return names, np.array(which, dtype=np.int64)


@functools.lru_cache(maxsize=4096)
def _part_names(attributes: frozenset[str], colors: tuple[str, ...]) -> tuple[str, ...]:
    """Of a place, or of a group with the colours of its members."""
    return (*[f"part: {a}" for a in sorted(attributes)], *[f"group color: {c}" for c in colors])


@functools.lru_cache(maxsize=4096)
def _state_names(attributes: frozenset[str], code: int, stacked: tuple[str, ...]) -> tuple[str, ...]:
    """Of an object.

    Args:
        code: of its states, see `state_signatures`.
        stacked: the colours of others on its spot.
    """
    names = [f"state: {a}" for a in sorted(attributes) if not a.startswith(WORKED_OUT)]
    if code:
        code -= 24
        names += [
            "state: covered" if code % 2 else "state: clear",
            "state: on something" if code // 2 % 2 else "state: on the floor",
            ("state: alone", "state: in a stack", "state: beside something")[code // 4 % 3],
        ]
        if code >= 12:
            names.append("state: in a row")
    return (*names, *[f"stack color: {color}" for color in stacked])


def ranks(where: Layout, members: Bools | None = None, *, ordinal: int | None = None, count: int | None = None) -> Ints:
    """The rank features of every thing: its place along every axis among those that it is compared with.

    Args:
        members: (n,) the things compared, objects and groups each with their like; None: all.
        ordinal: what the phrase counts to: 2 for "the second cone".
        count: how many the phrase means: 2 for "the two cones on the right", which are the first of them together.

    Returns:
        (n, k) bag of indices into `RANKS`, padded with -1.
    """
    compared = np.ones(len(where.things), dtype=np.bool_) if members is None else members
    code = np.where(compared & ~where.place, where.group.astype(np.int64), -1)
    if code.max(initial=-1) < 0:  # "your left": places have no ranks
        return np.full((len(code), 1), -1)
    alike = Alike(code, [np.flatnonzero(code == k) for k in range(2)])
    values = _values(where)
    values[AXES.index("middle")] = _from_middle(where, alike)
    values[AXES.index("medium")] = _from_mean_size(values[AXES.index("small")], alike)
    told = np.flatnonzero(np.isfinite(values).any(axis=1))  # few scenes have a speaker and sizes
    values = values[told]
    before = lower(values, alike, max(NEAREST + (count or 1) - 1, ordinal or 0))
    there = np.isfinite(values) & (code >= 0)
    first, place = told[:, None] * (NEAREST + 1), counted(before, count)
    out = [np.where(there & (place < NEAREST), first + place, -1)]
    if ordinal is not None:
        out.append(np.where(there & (place == ordinal - 1), first + NEAREST, -1))
    bag: Ints = np.concatenate(out).T
    return bag


def _values(where: Layout) -> Floats:
    """(axes, n): the lower, the earlier along the axis."""
    x, y, z = where.position.T
    z = z.copy()
    nothing = np.full(len(x), math.nan)
    volume, height = nothing.copy(), nothing.copy()
    for j in np.flatnonzero(where.solid).tolist():
        if (size := where.things[j].size) is not None:
            volume[j], height[j] = bulk(size), size[2]
    heights = z.tolist()
    for group, inside in where.members.items():  # "the highest stack", "the largest group"
        own = [heights[j] for j in inside.tolist()]
        volume[group], z[group] = len(own), max(own, default=-math.inf)
        height[group] = max(own) - min(own) if own else math.nan
    with np.errstate(invalid="ignore"):
        to_robot = np.hypot(x - where.robot[0], y - where.robot[1])
        to_speaker = nothing if where.speaker is None else np.hypot(*(where.position[:, :2] - where.speaker).T)
    along = (-y, y, -x, x, -z, z, -volume, volume, -height, height)
    return np.array([*along, nothing, to_robot, -to_robot, to_speaker, -where.apart, nothing])


def _from_mean_size(volume: Floats, alike: Alike) -> Floats:
    """(n,) how far a thing is from the geometric mean of the least and the largest of those alike, in log volume.

    NaN where sizes are unknown or all alike.
    """
    away = np.full(len(volume), math.nan)
    if np.isnan(volume).all():
        return away
    size = np.log(np.where(volume > 0.0, volume, math.nan))
    for members in alike.members:
        own = size[members]
        there = own[np.isfinite(own)]
        if len(there) and np.ptp(there) > TIE:
            away[members] = np.abs(own - (there.min() + there.max()) / 2.0)
    return away


def _from_middle(where: Layout, alike: Alike) -> Floats:
    """(n,) distance of every thing to the middle of those alike; NaN where there are none.

    Of all that is there it is the middle of the box around it, and so it is for one or two groups.
    """
    distance = np.full(len(where.things), math.nan)
    solid = where.position[where.solid & np.isfinite(where.position).all(axis=1)]
    for members in alike.members:
        if len(members):
            of_all = (where.group[members[0]] and len(members) < 3) or where.solid[members].sum() == len(solid)
            own = where.position[members]
            middle = np.where(np.isfinite(own), own, 0.0).sum(axis=0) / len(members)
            if of_all and len(solid):
                middle[:2] = (solid[:, :2].min(axis=0) + solid[:, :2].max(axis=0)) / 2
            distance[members] = np.sqrt(((own - middle) ** 2).sum(axis=1))
    return distance
