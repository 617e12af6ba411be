"""Where things are, as names of binary features: states, ranks, and relations between two things.

All is seen from the robot: x away from it, y to its left, z up, metres. A world without a robot pose is seen along
its own axes. What has no position (a hypothetical object) fires nothing.

    states      by itself: clear or covered, on the floor or on something, in a stack or alone, what it is held by ...
    ranks       among those alike: leftmost, second from the left, nearest, biggest ...
    relations   to a landmark: above, beside, at which distance and on which side, closest to it of those alike;
                to two landmarks: between them
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from dcg_torch.symbols import Object, Pose, WorldModel

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]

SAME_SPOT = 0.6
"""Metres between two feet, seen from above, within which one thing is over the other."""
ONE_LEVEL = 1.2
"""Metres of height within which the upper one rests on the lower one."""
NEXT = 1.6
"""Metres within which things are neighbours."""
_NEAREST = 3  # ranks that are told apart
_TIE = 1e-6

DISTANCES = (0.6, 1.2, 1.6, 2.5, 4.0, 6.0)
"""Metres: the bounds of the distance features."""
SETS = ("kind", "type", "color", "all")
THOSE = "those"
"""That one of the sets with which the phrase at hand compares its object."""
DIRECTION = "direction"
"""Attribute of a place that is a direction, in a world without edges."""
_SIDE_AT = 20.0  # metres from the robot to where such a side is taken to be: the leftmost is the closest to the left
AXES = ("left", "right", "far", "near", "high", "low", "big", "small", "middle", "robot", "remote", "speaker")

VERTICAL = ("level", "on top", "higher over", "right under", "lower under", "above", "below")
SECTORS = ("ahead", "ahead left", "left", "behind left", "behind", "behind right", "right", "ahead right")


def _names() -> dict[str, list[str]]:
    """Family of relation features -> the names of its values."""
    bounds = [f"to {d:g} m" for d in DISTANCES] + ["farther"]
    families = {"vertical": list(VERTICAL), "distance": bounds, "place distance": bounds}
    families |= {frame: [f"{frame} {s}" for s in SECTORS] for frame in ("side", "side seen", "toward")}
    for order in ("closest", "farthest"):
        families |= {
            f"{order} of {which}": [f"{order} {k} of {which}" for k in range(1, _NEAREST + 1)]
            for which in (*SETS, THOSE)
        }
    families |= {
        "itself": ["itself"],
        "between": ["between", "not between"],
        "line": ["in line across", "in line along"],
    }
    return families


RELATIONS = {family: [f"relation: {family}, {name}" for name in names] for family, names in _names().items()}
"""Family of relation features -> the names of its values; at most one value of a family fires."""

STATES = [
    *(f"state: {s}" for s in ("clear", "covered", "on the floor", "on something", "alone", "in a stack")),
    *(f"state: {s}" for s in ("beside something", "held", "near side", "far side", "left side", "right side")),
]
"""The states that are always features; further attributes of objects become features as they are met."""

RANKS = [f"rank: {axis} {k} of {which}" for which in (*SETS, THOSE) for axis in AXES for k in range(1, _NEAREST + 1)]


@dataclass(frozen=True)
class Layout:
    """A world's things as arrays, seen from the robot.

    Attributes:
        position: (n, 3) metres; NaN for what has none.
        half: (n, 2) half extents in x and y of what is no point (an edge), metres.
        kind, type, color: (n,) equal numbers for things of one type and colour, of one type, of one colour.
        place: (n,) is it a place rather than an object?
        over: (n, n) does i rest on j?
        speaker: (2,) where the speaker is, or None.
    """

    position: Floats
    half: Floats
    kind: Ints
    type: Ints
    color: Ints
    place: NDArray[np.bool_]
    over: NDArray[np.bool_]
    speaker: Floats | None
    origin: Floats
    facing: Floats


def layout(world: WorldModel) -> Layout:
    """The arrays of a world's things."""
    things = world.things
    n = len(things)
    robot = world.robot or Pose(0.0, 0.0)
    position = np.array([(math.nan,) * 3 if o.position is None else o.position for o in things]).reshape(n, 3)
    position = position.astype(np.float64)
    position[:, :2] = seen_from(robot, position[:, :2])
    half = np.array([(0.0, 0.0) if o.size is None else o.size[:2] for o in things]).reshape(n, 2) / 2
    place = np.arange(n) >= len(world.objects)
    half[~place] = 0.0
    kinds: dict[object, int] = {}
    kind = np.array([kinds.setdefault((o.type, o.color), len(kinds)) for o in things], dtype=np.int64)
    type_ = np.array([kinds.setdefault(o.type, len(kinds)) for o in things], dtype=np.int64)
    with np.errstate(invalid="ignore"):
        apart = np.hypot(*(position[:, None, :2] - position[None, :, :2]).transpose(2, 0, 1))
        up = position[:, None, 2] - position[None, :, 2]
        over = (apart < SAME_SPOT) & (up > 0.01) & (up <= ONE_LEVEL) & ~place[:, None] & ~place[None, :]
    color = np.array([kinds.setdefault(("color", o.color), len(kinds)) for o in things], dtype=np.int64)
    speaker = None if world.speaker is None else seen_from(robot, np.array([[world.speaker.x, world.speaker.y]]))[0]
    return Layout(position, half, kind, type_, color, place, over, speaker, *_directions(things, position))


def _directions(things: Sequence[Object], position: Floats) -> tuple[Floats, Floats]:
    """(n, 2) from where and (n,) along which angle one looks in the direction that a thing stands for.

    "Behind you" is seen from the robot, "on your left" along its left; a speaker who stands apart looks at the robot.
    """
    facing = np.full(len(things), math.nan)
    origin = np.zeros((len(things), 2))
    for j, thing in enumerate(things):
        if DIRECTION not in thing.attributes:
            continue
        x, y = position[j, :2]
        if thing.type == "robot" or math.hypot(x, y) < SAME_SPOT:
            facing[j] = 0.0
        elif thing.type == "speaker":
            origin[j], facing[j] = (x, y), math.atan2(-y, -x)
        else:
            facing[j] = math.atan2(y, x)
    return origin, facing


def seen_from(robot: Pose, points: Floats) -> Floats:
    """Points (n, 2) in the robot's frame."""
    c, s = math.cos(robot.yaw), math.sin(robot.yaw)
    moved = points - np.array([robot.x, robot.y])
    seen: Floats = moved @ np.array([[c, -s], [s, c]])
    return seen


def states(things: Sequence[Object], where: Layout) -> list[list[str]]:
    """Names of the state features of every thing."""
    position = where.position
    with np.errstate(invalid="ignore"):
        apart = np.hypot(*(position[:, None, :2] - position[None, :, :2]).transpose(2, 0, 1))
        other = ~where.place[None, :] & ~np.eye(len(things), dtype=np.bool_)
        column = other & (apart < SAME_SPOT)
        beside = other & (apart < NEXT)
    above, below = where.over.sum(axis=0), where.over.sum(axis=1)
    neighbours, stack = beside.sum(axis=1), column.sum(axis=1)
    out = []
    for j, thing in enumerate(things):
        names = [f"state: {a}" for a in sorted(thing.attributes)]
        if thing.position is not None and not where.place[j]:
            names += [
                "state: covered" if above[j] else "state: clear",
                "state: on something" if below[j] else "state: on the floor",
                "state: alone" if not neighbours[j] else "state: in a stack" if stack[j] else "state: beside something",
            ]
            colors = {thing.color for thing, over in zip(things, column[j], strict=True) if over} - {None}
            names += [f"stack color: {color}" for color in sorted(map(str, colors))]
        out.append(names)
    return out


def ranks(things: Sequence[Object], where: Layout, compared: str | None = None) -> list[list[str]]:
    """Names of the rank features of every thing: its place among those alike along every axis.

    Args:
        compared: the set that is "those" as well; None: none is.
    """
    position = where.position
    x, y, z = position.T
    volume = np.array([math.nan if o.size is None else math.prod(o.size) for o in things])
    centre = position[~where.place, :2]
    middle = np.nanmean(centre, axis=0) if np.isfinite(centre).any() else np.zeros(2)
    to_middle = np.hypot(x - middle[0], y - middle[1])
    to_robot = np.hypot(x, y)
    to_speaker = np.full(len(x), math.nan) if where.speaker is None else np.hypot(*(position[:, :2] - where.speaker).T)
    values = np.stack([-y, y, -x, x, -z, z, -volume, volume, to_middle, to_robot, -to_robot, to_speaker])
    out: list[list[str]] = [[] for _ in things]
    for which, alike in zip(SETS, _alike(where), strict=True):
        with np.errstate(invalid="ignore"):
            less = values[:, None, :] < values[:, :, None] - _TIE  # (axes, j, k): is k before j?
        before = (less & alike[None]).sum(axis=2)
        for axis, j in zip(*np.nonzero((before < _NEAREST) & np.isfinite(values)), strict=True):
            if not where.place[j]:
                place = f"rank: {AXES[axis]} {before[axis, j] + 1} of"
                out[j] += [f"{place} {which}", *([f"{place} {THOSE}"] if which == compared else [])]
    return out


def _alike(where: Layout) -> list[NDArray[np.bool_]]:
    """(n, n) for each of `SETS`: is k one of those that j is compared with?"""
    objects = ~where.place[None, :] & ~where.place[:, None]
    return [
        objects & (where.kind[:, None] == where.kind[None, :]),
        objects & (where.type[:, None] == where.type[None, :]),
        objects & (where.color[:, None] == where.color[None, :]),
        objects,
    ]


def relations(where: Layout, landmarks: Sequence[Sequence[int]], compared: str | None = None) -> dict[str, Ints]:
    """The value of every relation family, for every thing and every tuple of landmarks.

    Args:
        landmarks: c tuples of thing numbers; distances and sides are to the first.
        compared: the set that is "those" as well; None: none is.

    Returns:
        family -> (c, n) index into `RELATIONS[family]`, -1 where none fires.
    """
    first = np.array([tuple_[0] for tuple_ in landmarks], dtype=np.int64)
    position = where.position
    with np.errstate(invalid="ignore", divide="ignore"):
        offset = position[None, :, :] - position[first][:, None, :]  # (c, n, 3)
        flat = offset[..., :2]
        half = where.half[first][:, None, :]
        flat = np.sign(flat) * np.maximum(np.abs(flat) - half, 0.0)
        distance = np.hypot(flat[..., 0], flat[..., 1])
        exists = np.isfinite(distance) & (first[:, None] != np.arange(len(position))[None, :])
        steps = np.searchsorted(DISTANCES, np.where(exists, distance, 0.0), side="left")
        of_place = where.place[first][:, None]
        found = {
            "distance": np.where(exists & ~of_place, steps, -1),
            "place distance": np.where(exists & of_place, steps, -1),
            "vertical": np.where(exists & ~of_place, _vertical(distance, offset[..., 2]), -1),
        }
        itself = first[:, None] == np.arange(len(position))[None, :]
        found["itself"] = np.where(itself & ~of_place, 0, -1)
        aside = exists & (distance >= SAME_SPOT)
        about = position[None, :, :2] - where.origin[first][:, None]
        turned = np.arctan2(about[..., 1], about[..., 0]) - where.facing[first][:, None]
        found["toward"] = np.where(exists & np.isfinite(turned), _sector(turned), -1)
        bearing = np.arctan2(flat[..., 1], flat[..., 0])
        to_landmark = np.arctan2(position[first][:, 1], position[first][:, 0])[:, None]
        found["side"] = np.where(aside & ~of_place, _sector(bearing), -1)
        found["side seen"] = np.where(aside & ~of_place, _sector(bearing - to_landmark), -1)
        across, along = np.abs(flat[..., 1]) < SAME_SPOT, np.abs(flat[..., 0]) < SAME_SPOT
        found["line"] = np.where(aside & along, 0, np.where(aside & across, 1, -1))
        for which, alike in zip(SETS, _alike(where), strict=True):
            for order, sign in (("closest", 1.0), ("farthest", -1.0)):
                value = np.where(exists, sign * distance, math.inf)
                before = ((value[:, None, :] < value[:, :, None] - _TIE) & alike[None]).sum(axis=2)
                found[f"{order} of {which}"] = np.where(exists & (before < _NEAREST), before, -1)
    if compared is not None:
        found |= {f"{order} of {THOSE}": found[f"{order} of {compared}"] for order in ("closest", "farthest")}
    found["between"] = _between(position, landmarks)
    return found


def _vertical(distance: Floats, up: Floats) -> Ints:
    same = distance < SAME_SPOT
    return np.select(
        [
            same & (up > ONE_LEVEL),
            same & (up > 0.01),
            same & (up < -ONE_LEVEL),
            same & (up < -0.01),
            up > 0.01,
            up < -0.01,
        ],
        [VERTICAL.index(name) for name in ("higher over", "on top", "lower under", "right under", "above", "below")],
        VERTICAL.index("level"),
    )


def _sector(angle: Floats) -> Ints:
    """Which of the eight `SECTORS`, as seen by who looks along angle 0."""
    return np.nan_to_num(np.round(angle / (math.pi / 4)), nan=0.0).astype(np.int64) % 8


def _between(position: Floats, landmarks: Sequence[Sequence[int]]) -> Ints:
    """Is a thing between the first two landmarks: over their line, and not off to the side?"""
    out = np.full((len(landmarks), len(position)), -1, dtype=np.int64)
    for row, pair in enumerate(landmarks):
        if len(pair) < 2 or pair[0] == pair[1]:
            continue
        a, b = position[pair[0], :2], position[pair[1], :2]
        span = b - a
        length = math.hypot(*span)
        if not math.isfinite(length) or length < _TIE:
            continue
        offset = position[:, :2] - a
        along = offset @ span / length**2
        aside = np.abs(offset @ np.array([-span[1], span[0]])) / length
        inside = (along > 0.05) & (along < 0.95) & (aside < max(SAME_SPOT, 0.35 * length))
        out[row] = np.where(np.isfinite(along), np.where(inside, 0, 1), -1)
        out[row, list(pair)] = -1
    return out


def places(
    bounds: tuple[float, float, float, float] | None, robot: Pose | None, speaker: Pose | None
) -> tuple[Object, ...]:
    """The places that can be spoken of.

    Args:
        bounds: (near, far, right, left) of the workspace, seen from the robot, metres; None: it has no edges, and its
            sides are directions from the robot.
        robot: "you" to the speaker.
        speaker: "me".
    """
    origin = robot or Pose(0.0, 0.0)
    found: list[Object] = []

    def add(kind: str, x: float, y: float, sides: Sequence[str] = (), size: tuple[float, float] = (0.0, 0.0)) -> None:
        c, s = math.cos(origin.yaw), math.sin(origin.yaw)
        where = (origin.x + c * x - s * y, origin.y + s * x + c * y, 0.0)
        name = " ".join(("place:", *sides, kind))
        attributes = frozenset({*(f"{side} side" for side in sides), *([] if bounds else [DIRECTION])})
        found.append(Object(name, kind, known=True, position=where, size=(*size, 0.0), attributes=attributes))

    if bounds is not None:
        near, far, right, left = bounds
        mid_x, mid_y, deep, wide = (near + far) / 2, (right + left) / 2, far - near, left - right
        for x, ahead in ((near, "near"), (far, "far")):
            add("edge", x, mid_y, (ahead,), (0.0, wide))
            for y, side in ((right, "right"), (left, "left")):
                add("corner", x, y, (ahead, side))
        for y, side in ((right, "right"), (left, "left")):
            add("edge", mid_x, y, (side,), (deep, 0.0))
        add("middle", mid_x, mid_y)
    elif robot is not None:
        for x, y, side in ((-1, 0, "near"), (1, 0, "far"), (0, -1, "right"), (0, 1, "left")):
            add("edge", _SIDE_AT * x, _SIDE_AT * y, (side,))
    for kind, pose in (("robot", robot), ("speaker", speaker)):
        if pose is not None:
            x, y = seen_from(origin, np.array([[pose.x, pose.y]]))[0]
            add(kind, float(x), float(y))
    return tuple(found)
