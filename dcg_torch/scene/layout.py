"""A world's things as arrays, seen from the robot: what all features of space are computed from.

The robot's frame: x away from it, y to its left, z up, lengths in units of the world (`WorldModel.unit`). A world
without a robot pose is seen along its own axes. What has no position (a hypothetical object) is NaN.
"""

from __future__ import annotations

import functools
import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from dcg_torch.geometry import to_robot_frame
from dcg_torch.types import Object, Pose, WorldModel

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]
Bools = NDArray[np.bool_]

SAME_SPOT = 0.6
"""Units between two feet, seen from above, within which one thing is over the other."""
ONE_LEVEL = 1.2
"""Units of height within which the upper one rests on the lower one."""
NEXT = 1.6
"""Units within which things are neighbours."""
NEAREST = 3
"""Ranks that are told apart by their number."""
TIE = 1e-6

SETS = ("kind", "type", "color", "all", "row")
"""What a thing may be compared with: those of its type and colour, of its type, of its colour, all, or those in its row
or stack. Which, depends on what the phrase says of it."""

DIRECTION = "direction"
"""Type of the places that are no point but a way to look: "on your left"."""
GROUND = "ground"
"""Type of the place that everything stands on."""
HEADINGS = {"far side": (1.0, 0.0), "near side": (-1.0, 0.0), "left side": (0.0, 1.0), "right side": (0.0, -1.0)}
"""Attribute of a place -> where that side is, in the frame of who looks."""


@dataclass(frozen=True)
class Layout:
    """The things of a world, n of them: its objects, then its groups, then its places.

    Attributes:
        position: (n, 3); the mean of its members for a group, the origin for a direction.
        half: (n, 2) half extents in x and y of what is no point (an edge, a group).
        heading: (n, 2) unit vector towards the side that a place is at; NaN for all else.
        group, place: (n,) what kind of thing it is; neither is an object.
        direction, ground, edge: (n,) which places have relations of their own.
        member: (n, n) is j a member of the group i?
        over: (n, n) does i rest on j?
        alike: `SETS` -> (n, n) is j one of those that i is compared with?
        middle: (2,) the middle of the objects.
        speaker: (2,) where the speaker is, or None.
    """

    things: tuple[Object, ...]
    position: Floats
    half: Floats
    heading: Floats
    group: Bools
    place: Bools
    direction: Bools
    ground: Bools
    edge: Bools
    member: Bools
    over: Bools
    alike: dict[str, Bools]
    middle: Floats
    speaker: Floats | None

    @property
    def solid(self) -> Bools:
        """(n,) is it an object?"""
        solid: Bools = ~(self.group | self.place)
        return solid

    @functools.cached_property
    def apart(self) -> Floats:
        """(n, n) distances seen from above."""
        offset = self.position[:, None, :2] - self.position[None, :, :2]
        with np.errstate(invalid="ignore"):
            return np.hypot(offset[..., 0], offset[..., 1])


def layout(world: WorldModel) -> Layout:
    """The arrays of a world's things."""
    things = world.things
    n, robot = len(things), world.robot or Pose(0.0, 0.0)
    position = np.array([(math.nan,) * 3 if o.position is None else o.position for o in things], dtype=np.float64)
    position = position.reshape(n, 3)
    position[:, :2] = to_robot_frame(robot, position[:, :2])
    position /= world.unit
    size = np.array([(0.0, 0.0) if o.size is None else o.size[:2] for o in things], dtype=np.float64).reshape(n, 2)
    numbers = np.arange(n)
    place = numbers >= n - len(world.places)
    group = (numbers >= len(world.objects)) & ~place
    solid = ~(place | group)
    half = np.where(solid[:, None], 0.0, size / 2 / world.unit)
    number = {o.id: j for j, o in enumerate(things)}
    member = np.zeros((n, n), dtype=np.bool_)
    for i in np.flatnonzero(group):
        inside = [number[m] for m in things[i].members]
        member[i, inside] = True
        position[i] = position[inside].mean(axis=0)
        half[i] = np.ptp(position[inside, :2], axis=0) / 2
    offset = position[:, None, :] - position[None, :, :]
    with np.errstate(invalid="ignore"):
        apart = np.hypot(offset[..., 0], offset[..., 1])
        over = (apart < SAME_SPOT) & (offset[..., 2] > 0.01) & (offset[..., 2] <= ONE_LEVEL)
    over &= solid[:, None] & solid[None, :]
    seen = position[solid, :2]
    middle = np.nanmean(seen, axis=0) if np.isfinite(seen).any() else np.zeros(2)
    types = [o.type for o in things]
    return Layout(
        things,
        position,
        half,
        _headings(things, position, middle),
        group,
        place,
        np.array([t == DIRECTION for t in types], dtype=np.bool_) & place,
        np.array([t == GROUND for t in types], dtype=np.bool_) & place,
        np.array([t in ("edge", "corner") for t in types], dtype=np.bool_) & place,
        member,
        over,
        {**_alike(things, solid, group), "row": _mates(member)},
        middle,
        None
        if world.speaker is None
        else to_robot_frame(robot, np.array([[world.speaker.x, world.speaker.y]]))[0] / world.unit,
    )


def _headings(things: tuple[Object, ...], position: Floats, middle: Floats) -> Floats:
    """Where the side of each place is; the speaker is taken to look at the middle of the objects."""
    out = np.full((len(things), 2), math.nan)
    for j, thing in enumerate(things):
        sides = [HEADINGS[a] for a in sorted(thing.attributes) if a in HEADINGS]
        if not sides:
            continue
        x, y = np.sum(sides, axis=0) / math.sqrt(len(sides))
        ahead = np.array([1.0, 0.0])
        if "of speaker" in thing.attributes:
            view = middle - position[j, :2]
            ahead = view / max(float(np.hypot(*view)), TIE)
        out[j] = x * ahead + y * np.array([-ahead[1], ahead[0]])
    return out


def _alike(things: tuple[Object, ...], solid: Bools, group: Bools) -> dict[str, Bools]:
    numbers: dict[object, int] = {}

    def same(keys: list[object]) -> Bools:
        codes = np.array([numbers.setdefault(key, len(numbers)) for key in keys], dtype=np.int64)
        found: Bools = codes[:, None] == codes[None, :]
        return found

    of_type, of_color = same([o.type for o in things]), same([("color", o.color) for o in things])
    objects, groups = solid[:, None] & solid[None, :], group[:, None] & group[None, :] & of_type
    return {
        "kind": (objects & of_type & of_color) | (groups & of_color),
        "type": (objects & of_type) | groups,
        "color": (objects & of_color) | (groups & of_color),
        "all": objects | groups,
    }


def _mates(member: Bools) -> Bools:
    """The longest group that a thing is in is its row."""
    mates = np.zeros_like(member)
    longest = np.zeros(len(member), dtype=np.int64)
    for inside in member[member.any(axis=1)]:
        better = inside & (inside.sum() > longest)
        longest[better] = inside.sum()
        mates[better] = inside
    return mates
