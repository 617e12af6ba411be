"""A world's things as arrays, seen from the robot: what all features of space are computed from.

The robot's frame: x away from it, y to its left, z up, lengths in units of the world (`WorldModel.unit`). Where the
world has another viewer it is that one's. A world without a robot pose is seen along its own axes. What has no position
(a hypothetical object) is NaN.
"""

from __future__ import annotations

import functools
import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from dcg_torch.names.marks import kinds_of
from dcg_torch.names.vocabulary import LINE_ACROSS, LINE_ALONG
from dcg_torch.scene.bodies import Bodies, bodies
from dcg_torch.scene.neighbours import Neighbours, nearest_other, neighbours
from dcg_torch.scene.order import TIE, Alike, numbered
from dcg_torch.scene.outlooks import outlooks
from dcg_torch.scene.upright import before_it, laid_flat
from dcg_torch.types import Object, Pose, WorldModel
from dcg_torch.types.geometry import positions, to_robot_frame

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]
Bools = NDArray[np.bool_]

NEAREST = 3
"""Ranks that are told apart by their number."""
_FEW = 64
"""Things up to which it takes less time to look at one after another."""

SETS = ("kind", "type", "color", "all", "row")
"""What a thing may be compared with: those of its type and colour, of its type, of its colour, all, or those in its row
or stack. Which, depends on what the phrase says of it."""

LINES = (LINE_ACROSS, LINE_ALONG)
"""Groups that are the rows and the columns of a whole scene, see `groups`; one may have a single thing."""
LINE_NUMBERS = tuple(f"{k} from the {end}" for end in ("top", "bottom", "left", "right") for k in range(1, 11))
"""Their attributes: which one it is."""

DIRECTION = "direction"
"""Type of the places that are no point but a way to look: "on your left"."""
GROUND = "ground"
"""Type of the place that everything stands on."""
EDGES = ("edge", "corner")
"""Types of the places that are no point."""
HEADINGS = {"far side": (1.0, 0.0), "near side": (-1.0, 0.0), "left side": (0.0, 1.0), "right side": (0.0, -1.0)}
"""Attribute of a place -> where that side is, in the frame of who looks."""
_ROBOT = "robot"
OF_ROBOT, OF_SPEAKER = "of robot", "of speaker"
"""Attributes of the sides of somebody."""


@dataclass(frozen=True)
class Layout:
    """The things of a world, n of them: its objects, then its groups, then its places.

    What only some commands ask for is worked out at the first call; nothing has n x n entries.

    Attributes:
        position: (n, 3); the mean of its members for a group, the origin for a direction.
        half: (n, 2) half extents in x and y of what is no point (an edge, a group).
        heading: (n, 2) unit vector towards the side that a place is at; NaN for all else.
        group, place: (n,) what kind of thing it is; neither is an object.
        direction, ground, edge: (n,) which places have relations of their own.
        members: number of a group -> the numbers of its members.
        middle: (2,) the middle of the objects.
        robot: (2,) where the robot is.
        speaker: (2,) where the speaker is, or None.
        bodies: how large the objects are, or None.
        picture: does it show a page or a wall, where none is over another?
        outlook: (n,) angles along which things are looked at, in a room where nobody says who stands where.
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
    members: dict[int, Ints]
    middle: Floats
    robot: Floats
    speaker: Floats | None
    bodies: Bodies | None = None
    picture: bool = False
    outlook: Floats | None = None

    @functools.cached_property
    def solid(self) -> Bools:
        """(n,) is it an object?"""
        solid: Bools = ~(self.group | self.place)
        return solid

    @functools.cached_property
    def line(self) -> Bools:
        """(n,) is it a row or a column of the whole scene?"""
        found = np.zeros(len(self.things), dtype=np.bool_)
        found[[j for j in self.members if not self.things[j].attributes.isdisjoint(LINES)]] = True
        return found

    @functools.cached_property
    def wide(self) -> Floats | None:
        """(n, 2) what of the half extents makes objects more than points; None where all things are points."""
        if self.bodies is not None:
            return self.bodies.wide
        return np.zeros_like(self.half) if self.half.any() else None

    @functools.cached_property
    def colors(self) -> tuple[str, ...]:
        """The colours that are there, in alphabetical order."""
        return tuple(sorted({o.color for o in self.things if o.color is not None}))

    @functools.cached_property
    def color(self) -> Ints:
        """(n,) the number of each colour in `colors`, -1 for none."""
        number: dict[str | None, int] = {color: k for k, color in enumerate(self.colors)} | {None: -1}
        return np.array([number[o.color] for o in self.things], dtype=np.int64)

    @functools.cached_property
    def near(self) -> Neighbours:
        """Of the objects, which come first: who is near whom."""
        n = int(self.solid.sum())
        if self.bodies is None:
            return neighbours(self.position[:n], self.color[:n])
        heights = self.bodies.bottom[:n], self.bodies.top[:n]
        return neighbours(self.position[:n], self.color[:n], self.bodies.half[:n], heights)

    @functools.cached_property
    def apart(self) -> Floats:
        """(n,) how far the nearest other object is; NaN for what is none."""
        n = int(self.solid.sum())
        return np.concatenate([nearest_other(self.position[:n]), np.full(len(self.things) - n, math.nan)])

    @functools.cached_property
    def resting(self) -> Bools:
        """(n,) does it rest on an object?"""
        found = np.zeros(len(self.things), dtype=np.bool_)
        found[: len(self.near.resting)] = self.near.resting
        return found

    def alike(self, among: str) -> Alike:
        """Which of `SETS` each thing is compared with, by the name of the set."""
        if among not in self._alike:
            self._alike[among] = self._row if among == "row" else self._by_class(among)
        return self._alike[among]

    @functools.cached_property
    def _alike(self) -> dict[str, Alike]:
        return {}

    @functools.cached_property
    def _kinds(self) -> list[str | None]:
        """The type of each thing; of those that marks alone tell apart, what they are called alike."""
        objects = self.things[: int(np.count_nonzero(self.solid))]  # they come first
        kind = kinds_of(frozenset([o.type for o in objects if o.type is not None and not o.hypothetical]))
        types = [o.type for o in self.things]
        return [kind.get(type_ or "", type_) for type_ in types] if kind else types

    @functools.cached_property
    def _kind(self) -> Ints:
        """(n,) the number of each one's kind."""
        return numbered(self._kinds)

    def _by_class(self, among: str) -> Alike:
        """Groups are compared with those of their type alone."""
        code = self._class_of(among)
        return Alike.by(code) if len(code) > _FEW else Alike(code)

    def _class_of(self, among: str) -> Ints:
        """(n,) the class of each as a number; -1 of places."""
        code = self._kind if among in ("kind", "type") else np.where(self.group, self._kind, 0)
        if among in ("kind", "color"):
            code = code * (len(self.colors) + 1) + self.color + 1
        return np.where(self.place, -1, 2 * code + self.group)

    @functools.cached_property
    def _row(self) -> Alike:
        """The longest group that a thing is in is its row."""
        code, longest = [-1] * len(self.things), [0] * len(self.things)
        for k, (group, inside) in enumerate(self.members.items()):
            if self.line[group]:
                continue
            for j in inside.tolist():
                if longest[j] < len(inside):
                    longest[j], code[j] = len(inside), k
        return Alike(np.array(code, dtype=np.int64), list(self.members.values()))


def layout(world: WorldModel) -> Layout:
    """The arrays of a world's things."""
    things = world.things
    n, robot = len(things), world.robot or Pose(0.0, 0.0)
    viewer = world.viewer or robot
    objects, placed = len(world.objects), n - len(world.places)
    position, on_floor = _as_seen(world, viewer)
    half = np.zeros((n, 2))
    half[placed:] = [(0.0, 0.0) if place.size is None else place.size[:2] for place in world.places] or 0.0
    half /= 2 * world.unit
    members = _members(world) if world.groups else {}
    if members:
        _of_groups(members, position, half)
    numbers = np.arange(n)
    place, group = numbers >= placed, (numbers >= objects) & (numbers < placed)
    middle = _middle(position[:objects, :2])
    none, types = [False] * placed, [place.type for place in world.places]
    direction, ground, edge = (
        np.array([*none, *[type_ in of for type_ in types]], dtype=np.bool_) for of in ((DIRECTION,), (GROUND,), EDGES)
    )
    speaker = None if world.speaker is None else _foot(world.speaker, viewer, world.unit)
    own = np.zeros(2) if world.viewer is None else _foot(robot, viewer, world.unit)
    if not on_floor and objects:
        own = before_it(position[:objects])[:2]
    heading = _headings(things, position, middle, None if world.viewer is None else robot.yaw - viewer.yaw)
    sized = bodies(world.objects, position[:, 2], viewer.yaw, world.unit) if on_floor else None
    outlook = None
    if sized is not None and world.robot is None and world.viewer is None:
        outlook = outlooks(position, sized, len({o.type for o in world.objects if not o.hypothetical}), world.unit)
        outlook = None if outlook is None else np.pad(outlook, (0, n - len(outlook)))
    return Layout(
        things,
        position,
        half,
        heading,
        group,
        place,
        direction,
        ground,
        edge,
        members,
        middle,
        own,
        speaker,
        sized,
        picture=not on_floor,
        outlook=outlook,
    )


def _as_seen(world: WorldModel, viewer: Pose) -> tuple[Floats, bool]:
    """(n, 3) where things are in the viewer's frame, in units, a picture laid flat; and is there no picture?"""
    position = positions(world.things)
    position[:, :2] = to_robot_frame(viewer, position[:, :2])
    seen = position[: len(world.objects)]
    flat = laid_flat(seen)
    position[: len(world.objects)] = flat
    if flat is not seen:
        position[[j for j in range(len(seen), len(position)) if world.things[j].type == _ROBOT]] = before_it(flat)
    position /= world.unit
    return position, flat is seen


def _foot(pose: Pose, viewer: Pose, unit: float) -> Floats:
    """(2,) where somebody stands in the viewer's frame, in units."""
    found: Floats = to_robot_frame(viewer, np.array([[pose.x, pose.y]]))[0] / unit
    return found


def _members(world: WorldModel) -> dict[int, Ints]:
    number = {o.id: j for j, o in enumerate(world.things)}
    first = len(world.objects)
    return {first + g: np.array([number[m] for m in o.members], dtype=np.int64) for g, o in enumerate(world.groups)}


def _of_groups(members: dict[int, Ints], position: Floats, half: Floats) -> None:
    """Where groups are, the mean of their members, and how far they reach; in place."""
    group, inside = list(members), np.concatenate(list(members.values()))
    counts = np.array([len(of) for of in members.values()])
    starts, own = np.cumsum(counts) - counts, position[inside]
    which = np.repeat(np.arange(len(group)), counts)
    total = [np.bincount(which, axis) for axis in own.T]  # member after member: the same bits every time
    position[group] = np.transpose(total / counts)
    reach = np.maximum.reduceat(own[:, :2], starts, axis=0) - np.minimum.reduceat(own[:, :2], starts, axis=0)
    half[group] = reach / 2


def _middle(seen: Floats) -> Floats:
    """(2,) the mean of where the objects are that are somewhere."""
    there = np.isfinite(seen).all(axis=1)
    middle: Floats = seen[there].sum(axis=0) / max(1, np.count_nonzero(there))
    return middle


def _headings(things: tuple[Object, ...], position: Floats, middle: Floats, turned: float | None) -> Floats:
    """Where the side of each place is; the speaker is taken to look at the middle of the objects.

    Args:
        turned: the angle from where another viewer looks to where the robot does; None: the robot is the viewer.
    """
    out = np.full((len(things), 2), math.nan)
    for j, thing in [(j, thing) for j, thing in enumerate(things) if thing.attributes and not thing.members]:
        if (side := _side(thing.attributes)) is None:
            continue
        x, y = side
        if OF_SPEAKER in thing.attributes:
            view = middle - position[j, :2] if turned is None else np.array([math.cos(turned), math.sin(turned)])
            ahead = view / max(float(np.hypot(*view)), TIE)
            out[j] = x * ahead + y * np.array([-ahead[1], ahead[0]])
        else:
            out[j] = x, y
    return out


@functools.lru_cache(maxsize=1024)
def _side(attributes: frozenset[str]) -> tuple[float, float] | None:
    """The direction of a side in the frame of who looks; None for what has none."""
    sides = [HEADINGS[a] for a in sorted(attributes) if a in HEADINGS]
    if not sides:
        return None
    x, y = np.sum(sides, axis=0) / math.sqrt(len(sides))
    return float(x), float(y)
