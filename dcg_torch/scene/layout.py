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

from dcg_torch.names.marks import kinds_of
from dcg_torch.names.vocabulary import LINE_ACROSS, LINE_ALONG
from dcg_torch.scene.bodies import Bodies
from dcg_torch.scene.neighbours import Neighbours, nearest_other, neighbours
from dcg_torch.scene.order import Alike, numbered
from dcg_torch.types import Object
from dcg_torch.types.arrays import Bools, Floats, Ints

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
        outlook: (n,) angles along which things are looked at, in a room where nobody says who stands where. Around a
            robot, of what is at the walls; NaN of all else.
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
        """Who is near whom, among the objects, which come first."""
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

    @functools.cached_property
    def stacked(self) -> Bools:
        """(n,) is it an object with another on its spot?"""
        found = np.zeros(len(self.things), dtype=np.bool_)
        found[: len(self.near.stacked)] = self.near.stacked
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
