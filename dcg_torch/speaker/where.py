"""Definitions of relations: which object "the cube behind the sphere" means, for a robot that stands in the world.

No human data is behind them: they are definitions by this project. Each names an object (or a set of objects) only
where it stands out: by a margin in metres, or because nothing else that the words could be said of is near the
direction named. `tell` draws a description that is true of a world; it is what `training.relations` teaches from, and
what `speaker=relational` says where nothing was written.

Conventions: all is seen from the robot, x ahead, y to its left, metres. "Behind", "left of" a thing are along the
robot's line of sight to the thing; "on your left" and "behind you" are sectors about the robot.
"""

from __future__ import annotations

import math
from collections.abc import Collection
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from dcg_torch.geometry import to_robot_frame
from dcg_torch.speaker.phrases import PLURALS, a_side, noun_phrase, person, plural, prepositional
from dcg_torch.types import ParseTree
from dcg_torch.world.files import World

Floats = NDArray[np.float64]
Mask = NDArray[np.bool_]


@dataclass(frozen=True)
class View:
    """The objects of a world as they are spoken of.

    Attributes:
        types, colors: of every object.
        position: (n, 2).
        size: (n,) anything that grows with the size; None: all are of a size.
    """

    types: tuple[str, ...]
    colors: tuple[str, ...]
    position: Floats
    size: Floats | None = None

    @classmethod
    def of(cls, world: World, size: Floats | None = None) -> View:
        """A world as it is seen from the robot's start."""
        objects = world.objects
        position = to_robot_frame(world.start, np.array([o.position for o in objects], dtype=np.float64))
        return cls(tuple(o.type for o in objects), tuple(o.color for o in objects), position, size)


@dataclass(frozen=True)
class Told:
    """A noun phrase and the numbers of the objects that it means."""

    tree: ParseTree
    meant: frozenset[int]


_Value = tuple[Floats, Mask, Mask, float]
"""Of every object: the least is meant; which fit well; which might be said to fit; by how much it must stand out."""

_SECTORS = {"behind": 0.0, "in front of": math.pi, "to the left of": math.pi / 2, "to the right of": -math.pi / 2}
_NEAR = {"next to": 2.5, "beside": 2.5, "near": 3.0, "close to": 3.0, "by": 2.5}
_ABOUT_ROBOT = {
    **{("behind", "you"): math.pi, ("in front of", "you"): 0.0, ("ahead of", "you"): 0.0},
    **{("on", "your left"): math.pi / 2, ("on", "your right"): -math.pi / 2},
    **{("on", "the left"): math.pi / 2, ("on", "the right"): -math.pi / 2},
}
_ORDERS = {
    **{"leftmost": (1, -1.0, 0), "rightmost": (1, 1.0, 0), "closest": (0, 1.0, 0), "nearest": (0, 1.0, 0)},
    **{"farthest": (0, -1.0, 0), "second closest": (0, 1.0, 1), "second farthest": (0, -1.0, 1)},
    **{"second from the left": (1, -1.0, 1), "second from the right": (1, 1.0, 1)},
    **{"third from the left": (1, -1.0, 2), "third from the right": (1, 1.0, 2)},
}
"""Word -> axis (0: distance from the robot, 1: to the left), sign, how many come before."""
_SIZES = {"biggest": -1.0, "largest": -1.0, "smallest": 1.0}


RELATIONS: tuple[str, ...] = (
    *_SECTORS, *_NEAR, "far from", "closest to", "nearest to", "farthest from", "between",
    *(" ".join(pair) for pair in _ABOUT_ROBOT), "closest to you", "nearest to me", "farthest from you",
    *_ORDERS, *_SIZES, "middle", "in a chain", "closest on your left", "farthest on your right",
    "behind you on the right", "behind you on the left", "all", "several on your left", "several on your right",
    "several next to",
)  # fmt: skip
"""All that can be told."""
SETS = frozenset(name for name in RELATIONS if name.startswith(("all", "several")))
"""Those that mean more than one object."""


DIRECTED = (*_SECTORS, *(" ".join(pair) for pair in _ABOUT_ROBOT), "several on your left", "several on your right")
"""Those by a direction, of a landmark or of the robot."""
_SIZED = frozenset(_SIZES)
SPOKEN = tuple(name for name in RELATIONS if name not in SETS | _SIZED)
"""Those that mean one object, of which it is not known how big it is."""


def tell(view: View, relation: str, rng: np.random.Generator, named: Collection[str]) -> Told | None:
    """A description by one relation that is true of a world and says what is meant.

    Args:
        relation: one of `RELATIONS`.
        named: the types that the speaker calls by name, others are "thing" or "object".

    Returns:
        None if the objects drawn don't admit of one; draw again.

    Raises:
        ValueError: no such relation.
    """
    if relation not in RELATIONS:
        raise ValueError(f"{relation!r} is no relation; choose from {', '.join(RELATIONS)}")
    if len(view.types) < 2:
        return None
    return _Teller(view, rng, named).tell(relation)


class _Teller:
    """Draws descriptions of one world."""

    def __init__(self, view: View, rng: np.random.Generator, named: Collection[str]) -> None:
        self.view, self.rng, self.named = view, rng, named
        self.distance = np.hypot(*view.position.T)
        self.bearing = np.arctan2(view.position[:, 1], view.position[:, 0])

    def tell(self, relation: str) -> Told | None:
        kind, color, alike = self.head()
        if relation == "all":
            return self.every(kind, color, alike)
        if alike.sum() < 2:
            return None
        if relation in _ORDERS or relation in _SIZES or relation == "middle":
            return self.ordered(relation, kind, color, alike)
        if relation.startswith("several"):
            return self.several(relation.removeprefix("several "), kind, color, alike)
        if relation in ("closest on your left", "farthest on your right"):
            word, _, place = relation.partition(" on ")
            return self.ordered_at(word, ("on", place), kind, color, alike)
        if relation in ("behind you on the right", "behind you on the left"):
            return self.quarter(relation.removeprefix("behind you on "), kind, color, alike)
        found = self.modifier(relation, alike)
        if found is None:
            return None
        modifier, (value, well, loosely, margin) = found
        best = _stands_out(value, well & alike, loosely & alike, margin)
        return None if best is None else Told(noun_phrase(kind, color, modifiers=(modifier,)), frozenset({best}))

    def head(self) -> tuple[str | None, str | None, Mask]:
        """The noun (None: "thing") and colour said of a random object, and the objects that they fit."""
        j = int(self.rng.integers(len(self.view.types)))
        kind = self.view.types[j] if self.view.types[j] in self.named and self.rng.random() < 0.6 else None
        color = self.view.colors[j] if self.rng.random() < 0.35 else None
        return kind, color, self.fitting(kind, color)

    def fitting(self, kind: str | None, color: str | None) -> Mask:
        return np.array(
            [
                (kind is None or t == kind) and (color is None or c == color)
                for t, c in zip(self.view.types, self.view.colors, strict=True)
            ]
        )

    def landmark(self) -> tuple[int, ParseTree] | None:
        """An object that a noun, with its colour where that is needed, says by itself."""
        j = int(self.rng.integers(len(self.view.types)))
        kind, color = self.view.types[j], self.view.colors[j] if self.rng.random() < 0.6 else None
        if kind not in self.named or self.fitting(kind, color).sum() != 1:
            return None
        return j, noun_phrase(kind, color)

    def modifier(self, relation: str, alike: Mask) -> tuple[ParseTree, _Value] | None:
        """A prepositional phrase, and how every object fits it."""
        everything = np.ones(len(alike), dtype=np.bool_)
        for (word, place), angle in _ABOUT_ROBOT.items():
            if relation == f"{word} {place}":
                return self.about_robot(word, place, angle)
        if relation in ("closest to you", "nearest to me", "farthest from you"):
            word, _, who = relation.rpartition(" ")
            sign = -1.0 if word == "farthest from" else 1.0
            return prepositional(word, person(who)), (sign * self.distance, everything, everything, 0.4)
        if relation == "in a chain":
            return self.chain(alike)
        mark = self.landmark()
        if mark is None:
            return None
        j, noun = mark
        if relation == "between":
            return self.between(j, noun)
        return prepositional(relation, noun), self.from_landmark(relation, j)

    def from_landmark(self, relation: str, j: int) -> _Value:
        """How every object stands to the object j; itself stands in no relation."""
        offset = self.view.position - self.view.position[j]
        distance = np.hypot(*offset.T)
        other = np.arange(len(distance)) != j
        if relation in _SECTORS:
            ahead = self.bearing[j] + _SECTORS[relation]
            turn = np.abs(_wrapped(np.arctan2(offset[:, 1], offset[:, 0]) - ahead))
            well = other & (turn <= math.radians(45)) & (distance <= 3.5)
            return distance, well, other & (turn <= math.radians(70)) & (distance <= 4.5), 0.5
        if relation in _NEAR:
            return distance, other & (distance <= _NEAR[relation]), other, 0.6
        if relation == "far from":
            return -distance, other & (distance >= 3.5), other, 1.0
        return (-distance if relation == "farthest from" else distance), other, other, 0.4

    def about_robot(self, word: str, place: str, angle: float) -> tuple[ParseTree, _Value]:
        """Behind, ahead, on one side; "on the left" may also be the leftmost of those that one could speak of."""
        turn = np.abs(_wrapped(self.bearing - angle))
        well, loosely = turn <= math.radians(50), turn <= math.radians(70)
        value, margin = turn, math.radians(40)
        if place in ("the left", "the right"):
            margin = 1.0
            value = -np.sign(angle) * self.view.position[:, 1]
            loosely = np.ones(len(turn), dtype=np.bool_)
        noun = person(place) if place == "you" else a_side(place)
        return prepositional(word, noun), (value, well, loosely, margin)

    def between(self, j: int, noun: ParseTree) -> tuple[ParseTree, _Value] | None:
        other = self.landmark()
        if other is None or other[0] == j:
            return None
        a, b = self.view.position[j], self.view.position[other[0]]
        length = float(np.hypot(*(b - a)))
        along = (self.view.position - a) @ (b - a) / length
        aside = np.abs((self.view.position - a) @ np.array([a[1] - b[1], b[0] - a[0]])) / length
        free = ~np.isin(np.arange(len(along)), [j, other[0]])
        well = free & (along > 0.5) & (along < length - 0.5) & (aside < max(0.5, 0.25 * length))
        loosely = free & (along > 0.0) & (along < length) & (aside < 0.5 * length)
        return prepositional("between", noun, other[1]), (np.zeros(len(along)), well, loosely, 1.0)

    def chain(self, alike: Mask) -> tuple[ParseTree, _Value] | None:
        """ "next to the cube behind the sphere": a landmark that is itself told by a relation."""
        inner = ("behind", "next to", "on your left", "on your right", "behind you", "in front of you")
        relation = str(self.rng.choice(["next to", "behind", "closest to", "in front of"]))
        below = self.tell(str(self.rng.choice(inner)))
        if below is None or len(below.meant) != 1 or below.tree.phrase.noun in (None, "thing", "object"):
            return None
        (j,) = below.meant
        value, well, loosely, margin = self.from_landmark(relation, j)
        same = self.fitting(self.view.types[j], None)  # "the cube next to the cube ..." is said by nobody
        return prepositional(relation, below.tree), (value, well & ~same, loosely & ~same, margin)

    def ordered(self, relation: str, kind: str | None, color: str | None, alike: Mask) -> Told | None:
        """A superlative or an ordinal."""
        head, _, edge = relation.partition(" from ")
        words = (*head.split(), *([f"from {edge}"] if edge else []))
        best = self.in_order(relation, alike)
        return None if best is None else Told(noun_phrase(kind, color, words), frozenset({best}))

    def in_order(self, relation: str, alike: Mask) -> int | None:
        """Which of those alike comes at a place of an order, a fair way off from its neighbours."""
        members = np.flatnonzero(alike)
        margin, before = 0.4, 0
        if relation in _ORDERS:
            axis, sign, before = _ORDERS[relation]
            value = sign * (self.view.position[:, 1] if axis else self.distance)
        elif relation == "middle":
            if len(members) != 3:
                return None
            value, before = self.view.position[:, 1], 1
            middle = np.hypot(*(self.view.position[members] - self.view.position[members].mean(axis=0)).T)
            if middle.argmin() != value[members].argsort()[1]:
                return None
        elif self.view.size is None:
            return None
        else:
            value, margin = _SIZES[relation] * np.log(self.view.size), 0.3
        ranked = members[np.argsort(value[members], kind="stable")]
        if len(ranked) <= before or (before and len(ranked) == before + 1 and relation != "middle"):
            return None
        gaps = np.diff(value[ranked])[max(0, before - 1) : before + 1]
        return int(ranked[before]) if (gaps >= margin).all() else None

    def ordered_at(
        self, word: str, at: tuple[str, str], kind: str | None, color: str | None, alike: Mask
    ) -> Told | None:
        """ "The closest cube on your left"."""
        modifier, (_, well, loosely, _) = self.about_robot(*at, _ABOUT_ROBOT[at])
        best = None if (loosely & alike).sum() < 2 else self.in_order(word, loosely & alike)
        if best is None or not well[best]:
            return None
        return Told(noun_phrase(kind, color, (word,), (modifier,)), frozenset({best}))

    def quarter(self, side: str, kind: str | None, color: str | None, alike: Mask) -> Told | None:
        """ "Behind you on the right"."""
        sign = 1.0 if side == "the left" else -1.0
        left = sign * self.bearing
        well = (left >= math.radians(110)) & (left <= math.radians(160))
        loosely = (left >= math.radians(80)) | (left <= math.radians(-170))
        best = _stands_out(np.zeros(len(left)), well & alike, loosely & alike, 1.0)
        modifiers = prepositional("behind", person("you")), prepositional("on", a_side(side))
        return None if best is None else Told(noun_phrase(kind, color, modifiers=modifiers), frozenset({best}))

    def every(self, kind: str | None, color: str | None, alike: Mask) -> Told | None:
        """ "All red cubes", "the cubes"."""
        if kind is None or kind not in PLURALS or alike.sum() < 2:
            return None
        words = ("all",) if self.rng.random() < 0.5 else ()
        return Told(plural(kind, color, words), frozenset(map(int, np.flatnonzero(alike))))

    def several(self, relation: str, kind: str | None, color: str | None, alike: Mask) -> Told | None:
        """ "The two cubes on your left"; nothing may be in doubt."""
        if kind is not None and kind not in PLURALS:
            return None
        found = self.modifier(relation, alike)
        if found is None:
            return None
        modifier, (_, well, loosely, _) = found
        if relation == "next to":
            distance = found[1][0]
            well, loosely = well & (distance <= 2.0), loosely & (distance <= 3.0)
        meant = np.flatnonzero(well & alike)
        if len(meant) < 2 or len(meant) == alike.sum() or (loosely & alike).sum() != len(meant):
            return None
        count = len(meant) if len(meant) <= 3 and self.rng.random() < 0.5 else None
        return Told(plural(kind, color, (), count, (modifier,)), frozenset(map(int, meant)))


def _stands_out(value: Floats, well: Mask, loosely: Mask, margin: float) -> int | None:
    """The object of least value among those that fit well, if all that might fit are worse by a margin."""
    if not well.any():
        return None
    best = int(np.where(well, value, np.inf).argmin())
    rivals = (well | loosely) & (np.arange(len(value)) != best)
    return best if (value[rivals] - value[best] >= margin).all() else None


def _wrapped(angle: Floats) -> Floats:
    """To within pi of zero."""
    wrapped: Floats = (angle + math.pi) % math.tau - math.pi
    return wrapped
