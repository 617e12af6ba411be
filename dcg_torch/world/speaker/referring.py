"""Referring expressions: which object "the cube behind the sphere" means, for a robot that stands in the world.

No human data is behind them: they are definitions by this project. Each names an object (or a set of objects) only
where it stands out: by a margin in metres, or because nothing else that the words could be said of is near the
direction named (`fit`). `generate` draws a description that is true of a world; `lessons.relations` teaches from it,
and `speaker=relational` says it where nothing was written.
"""

from __future__ import annotations

from collections.abc import Collection
from dataclasses import dataclass

import numpy as np

from dcg_torch.types import ParseTree
from dcg_torch.types.arrays import Bools
from dcg_torch.world.speaker.fit import (
    ABOUT_ROBOT,
    DIRECTIONS,
    NEARNESS,
    Fit,
    Surroundings,
    about_robot,
    behind_on_side,
    between,
    by_distance,
    from_landmark,
)
from dcg_torch.world.speaker.phrases import PLURALS, a_side, noun_phrase, person, plural, prepositional


@dataclass(frozen=True)
class Description:
    """A noun phrase and the numbers of the objects that it means."""

    tree: ParseTree
    meant: frozenset[int]


@dataclass(frozen=True)
class _Head:
    """The noun (None: "thing") and colour that are said, and the objects that they fit."""

    kind: str | None
    color: str | None
    alike: Bools

    def phrase(self, words: tuple[str, ...] = (), *modifiers: ParseTree) -> ParseTree:
        return noun_phrase(self.kind, self.color, words, modifiers)


@dataclass(frozen=True)
class _Modifier:
    """A prepositional phrase, and how every object fits it."""

    tree: ParseTree
    fit: Fit


@dataclass(frozen=True, slots=True)
class _Order:
    """By what objects are ordered: an axis ("distance" from the robot, or "left" of it), its sign, and how many of
    them come before the one meant."""

    axis: str
    sign: float
    before: int = 0


_ORDERS = {
    "leftmost": _Order("left", -1.0),
    "rightmost": _Order("left", 1.0),
    "closest": _Order("distance", 1.0),
    "nearest": _Order("distance", 1.0),
    "farthest": _Order("distance", -1.0),
    "second closest": _Order("distance", 1.0, 1),
    "second farthest": _Order("distance", -1.0, 1),
    "second from the left": _Order("left", -1.0, 1),
    "second from the right": _Order("left", 1.0, 1),
    "third from the left": _Order("left", -1.0, 2),
    "third from the right": _Order("left", 1.0, 2),
}
_SIZES = {"biggest": -1.0, "largest": -1.0, "smallest": 1.0}


RELATIONS: tuple[str, ...] = (
    *DIRECTIONS, *NEARNESS, "far from", "closest to", "nearest to", "farthest from", "between",
    *(" ".join(pair) for pair in ABOUT_ROBOT), "closest to you", "nearest to me", "farthest from you",
    *_ORDERS, *_SIZES, "middle", "in a chain", "closest on your left", "farthest on your right",
    "behind you on the right", "behind you on the left", "all", "several on your left", "several on your right",
    "several next to",
)  # fmt: skip
"""All that can be told."""
SETS = frozenset(name for name in RELATIONS if name.startswith(("all", "several")))
"""Those that mean more than one object."""


DIRECTED = (*DIRECTIONS, *(" ".join(pair) for pair in ABOUT_ROBOT), "several on your left", "several on your right")
"""Those by a direction, of a landmark or of the robot."""
_SIZED = frozenset(_SIZES)
SPOKEN = tuple(name for name in RELATIONS if name not in SETS | _SIZED)
"""Those that mean one object, of which it is not known how big it is."""


def generate(
    around: Surroundings,
    relation: str,
    rng: np.random.Generator,
    named: Collection[str],
    landmarks: Collection[str] | None = None,
) -> Description | None:
    """A description by one relation that is true of a world and says what is meant.

    Args:
        relation: one of `RELATIONS`.
        named: the types that the speaker calls by name, others are "thing" or "object".
        landmarks: the types that are named as landmarks; None: those.

    Returns:
        None if the objects drawn don't admit of one; draw again.

    Raises:
        ValueError: no such relation.
    """
    if relation not in RELATIONS:
        raise ValueError(f"{relation!r} is no relation; choose from {', '.join(RELATIONS)}")
    if len(around.types) < 2:
        return None
    return ReferringExpressionGenerator(around, rng, named, landmarks).generate(relation)


class ReferringExpressionGenerator:
    """Draws descriptions of one world; the arguments are those of `generate`."""

    def __init__(
        self,
        around: Surroundings,
        rng: np.random.Generator,
        named: Collection[str],
        landmarks: Collection[str] | None = None,
    ) -> None:
        self._around, self._rng, self._named = around, rng, named
        self._landmarks = named if landmarks is None else landmarks

    def generate(self, relation: str) -> Description | None:
        """A description by this relation; None if the objects drawn don't admit of one."""
        head = self._head()
        if relation == "all":
            return self._every(head)
        if head.alike.sum() < 2:
            return None
        if relation in _ORDERS or relation in _SIZES or relation == "middle":
            return self._ordered(relation, head)
        if relation.startswith("several"):
            return self._several(relation.removeprefix("several "), head)
        if relation in ("closest on your left", "farthest on your right"):
            word, _, place = relation.partition(" on ")
            return self._ordered_on_side(word, place, head)
        if relation in ("behind you on the right", "behind you on the left"):
            side = relation.removeprefix("behind you on ")
            modifiers = prepositional("behind", person("you")), prepositional("on", a_side(side))
            return _single(behind_on_side(self._around, side).best(head.alike), head.phrase((), *modifiers))
        modifier = self._modifier(relation)
        if modifier is None:
            return None
        return _single(modifier.fit.best(head.alike), head.phrase((), modifier.tree))

    def _head(self) -> _Head:
        """What is said of a random object."""
        around = self._around
        j = int(self._rng.integers(len(around.types)))
        kind = around.types[j] if around.types[j] in self._named and self._rng.random() < 0.6 else None
        color = around.colors[j] if self._rng.random() < 0.35 else None
        return _Head(kind, color, around.fitting(kind, color))

    def _landmark(self) -> tuple[int, ParseTree] | None:
        """An object that a noun, with its colour where that is needed, says by itself."""
        around = self._around
        j = int(self._rng.integers(len(around.types)))
        kind, color = around.types[j], around.colors[j] if self._rng.random() < 0.6 else None
        if kind not in self._landmarks or around.fitting(kind, color).sum() != 1:
            return None
        return j, noun_phrase(kind, color)

    def _modifier(self, relation: str) -> _Modifier | None:
        around = self._around
        for word, place in ABOUT_ROBOT:
            if relation == f"{word} {place}":
                return _about_robot(around, word, place)
        if relation in ("closest to you", "nearest to me", "farthest from you"):
            word, _, who = relation.rpartition(" ")
            return _Modifier(prepositional(word, person(who)), by_distance(around, farthest=word == "farthest from"))
        if relation == "in a chain":
            return self._chain()
        landmark = self._landmark()
        if landmark is None:
            return None
        j, noun = landmark
        if relation != "between":
            return _Modifier(prepositional(relation, noun), from_landmark(around, relation, j))
        other = self._landmark()
        if other is None or other[0] == j:
            return None
        return _Modifier(prepositional("between", noun, other[1]), between(around, j, other[0]))

    def _chain(self) -> _Modifier | None:
        """ "Next to the cube behind the sphere": a landmark that is itself described by a relation."""
        inner = ("behind", "next to", "on your left", "on your right", "behind you", "in front of you")
        relation = str(self._rng.choice(["next to", "behind", "closest to", "in front of"]))
        below = self.generate(str(self._rng.choice(inner)))
        if below is None or len(below.meant) != 1 or below.tree.phrase.noun in (None, "thing", "object"):
            return None
        (j,) = below.meant
        fit = from_landmark(self._around, relation, j)
        other = ~self._around.fitting(self._around.types[j], None)  # nobody says "the cube next to the cube ..."
        return _Modifier(
            prepositional(relation, below.tree), Fit(fit.value, fit.well & other, fit.loosely & other, fit.margin)
        )

    def _ordered(self, relation: str, head: _Head) -> Description | None:
        """A superlative or an ordinal."""
        front, _, edge = relation.partition(" from ")
        words = (*front.split(), *([f"from {edge}"] if edge else []))
        return _single(_in_order(self._around, relation, head.alike), head.phrase(words))

    def _ordered_on_side(self, word: str, place: str, head: _Head) -> Description | None:
        """ "The closest cube on your left"."""
        modifier = _about_robot(self._around, "on", place)
        alike = modifier.fit.loosely & head.alike
        best = None if alike.sum() < 2 else _in_order(self._around, word, alike)
        if best is None or not modifier.fit.well[best]:
            return None
        return _single(best, head.phrase((word,), modifier.tree))

    def _every(self, head: _Head) -> Description | None:
        """ "All red cubes", "the cubes"."""
        if head.kind is None or head.kind not in PLURALS or head.alike.sum() < 2:
            return None
        words = ("all",) if self._rng.random() < 0.5 else ()
        return Description(plural(head.kind, head.color, words), _numbers(head.alike))

    def _several(self, relation: str, head: _Head) -> Description | None:
        """ "The two cubes on your left"; nothing may be in doubt."""
        if head.kind is not None and head.kind not in PLURALS:
            return None
        modifier = self._modifier(relation)
        if modifier is None:
            return None
        well, loosely = modifier.fit.well, modifier.fit.loosely
        if relation == "next to":
            distance = modifier.fit.value
            well, loosely = (
                well & (distance <= NEARNESS[relation] - _DOUBT),
                loosely & (distance <= NEARNESS[relation] + _DOUBT),
            )
        meant = well & head.alike
        if meant.sum() < 2 or meant.sum() == head.alike.sum() or (loosely & head.alike).sum() != meant.sum():
            return None
        number = int(meant.sum())
        count = number if number <= 3 and self._rng.random() < 0.5 else None
        return Description(plural(head.kind, head.color, (), count, (modifier.tree,)), _numbers(meant))


_DOUBT = 0.5  # metres about the limit of "next to", where it is in doubt whether a thing is one of several there


def _about_robot(around: Surroundings, word: str, place: str) -> _Modifier:
    noun = person(place) if place == "you" else a_side(place)
    return _Modifier(prepositional(word, noun), about_robot(around, word, place))


def _in_order(around: Surroundings, relation: str, alike: Bools) -> int | None:
    """Which of those alike comes at a place of an order, a fair way off from its neighbours."""
    members = np.flatnonzero(alike)
    margin, before = 0.4, 0
    if relation in _ORDERS:
        order = _ORDERS[relation]
        before = order.before
        value = order.sign * (around.position[:, 1] if order.axis == "left" else around.distance)
    elif relation == "middle":
        if len(members) != 3:
            return None
        value, before = around.position[:, 1], 1
        middle = np.hypot(*(around.position[members] - around.position[members].mean(axis=0)).T)
        if middle.argmin() != value[members].argsort()[1]:
            return None
    elif around.size is None:
        return None
    else:
        value, margin = _SIZES[relation] * np.log(around.size), 0.3
    ranked = members[np.argsort(value[members], kind="stable")]
    if len(ranked) <= before or (before and len(ranked) == before + 1 and relation != "middle"):
        return None
    gaps = np.diff(value[ranked])[max(0, before - 1) : before + 1]
    return int(ranked[before]) if (gaps >= margin).all() else None


def _single(meant: int | None, tree: ParseTree) -> Description | None:
    return None if meant is None else Description(tree, frozenset({meant}))


def _numbers(objects: Bools) -> frozenset[int]:
    return frozenset(map(int, np.flatnonzero(objects)))
