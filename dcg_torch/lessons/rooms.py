"""Generated lessons in furnished rooms: many things on, in and beside furniture, told apart by where they are.

Like the other generated lessons they are definitions by this project and no human data. The class names are everyday
ones, so what is meant by a noun is known beforehand; what is taught is what "in", "on", "from" or "by" mean there.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Collection
from dataclasses import dataclass

import numpy as np

from dcg_torch.learning.landmarks import Lesson
from dcg_torch.lessons.arrangements import Reading
from dcg_torch.scene.upsilon import world_model
from dcg_torch.scene.workspace import Workspace, with_places
from dcg_torch.types import Percept, Pose

_OPEN = {"table": 0.8, "counter": 0.9, "shelf": 1.2, "desk": 0.75, "bed": 0.5, "sofa": 0.45, "chair": 0.5, "stove": 0.9}
"""Furniture that things lie on, and its height in metres."""
_HOLLOW = {"sink": 0.85, "box": 0.3, "drawer": 0.5, "basket": 0.3, "fridge": 0.9, "microwave": 1.0, "bin": 0.3}
"""What things lie in, and how high they lie there."""
_SMALL = (
    *("apple", "book", "bottle", "bowl", "bread", "candle", "cup", "fork", "key", "knife", "lamp", "mug", "pan"),
    *("pen", "pencil", "phone", "pillow", "plate", "pot", "sponge", "spoon", "tomato", "towel", "vase", "watch"),
)
_ON = ("on", "on", "on top of", "from", "off", "that is on", "at")
_IN = ("in", "in", "inside", "from", "out of", "that is in")
_BY = ("next to", "beside", "by", "near", "close to", "to the side of")
_VERBS = ("pick up", "take", "get", "go to", "bring me", "find", "grab")
_DRAWS = 20  # rooms tried for one lesson


@dataclass(frozen=True)
class _Place:
    """A thing, the furniture that it is at, and how: "on", "in" or "by"."""

    thing: Percept
    at: Percept
    how: str


def room_lessons(
    parse: Callable[[str, Collection[str]], Reading], count: int = 200, seed: int = 0
) -> tuple[Lesson, ...]:
    """Lessons, the same for the same arguments: one command of each room.

    Args:
        parse: reads commands.
    """
    rng = np.random.default_rng(seed)
    lessons: list[Lesson] = []
    while len(lessons) < count:
        lessons.append(_lesson(parse, rng))
    return tuple(lessons)


def _lesson(parse: Callable[[str, Collection[str]], Reading], rng: np.random.Generator) -> Lesson:
    for _ in range(_DRAWS):
        furniture, places = _room(rng)
        told = _told(places, rng)
        if told is None:
            continue
        text, meant = told
        tree = parse(text, ()).tree
        if tree is None:
            raise ValueError(f"the lesson {text!r} is not read as a command")
        percepts = [*furniture, *(p.thing for p in places)]
        upsilon = world_model(percepts, (), hypothetical=False, robot=Pose(0.0, 0.0))
        return Lesson(tree, with_places(upsilon, Workspace.of(percepts)), frozenset({meant}))
    raise ValueError(f"no room of {_DRAWS} had two things of one kind in different places")


def _room(rng: np.random.Generator) -> tuple[list[Percept], list[_Place]]:
    """Furniture along the room, and things that are at some piece of it."""
    kinds = [*rng.choice([*_OPEN, *_HOLLOW], size=int(rng.integers(5, 13))).tolist()]
    sized = bool(rng.random() < 0.5)  # some recognisers say how large a thing is
    furniture: list[Percept] = []
    for k, kind in enumerate(kinds):
        x, y = rng.uniform(1.0, 8.0), rng.uniform(-4.0, 4.0)
        width = 0.4 if kind in _HOLLOW else 1.0
        height = (_OPEN | _HOLLOW)[kind]
        size = (width, width, height) if sized else None
        furniture.append(Percept(f"f{k}", kind, None, (x, y, 0.0 if rng.random() < 0.5 else height), size))
    places = []
    names = rng.choice(_SMALL, size=int(rng.integers(4, 9)), replace=False).tolist()
    for k in range(int(rng.integers(10, 40))):
        at = furniture[int(rng.integers(len(furniture)))]
        how = "by" if rng.random() < 0.25 else "in" if at.type in _HOLLOW else "on"
        spread = 0.15 if how == "in" else 0.35
        angle = rng.uniform(0.0, math.tau)
        away = rng.uniform(0.7, 1.1) if how == "by" else rng.uniform(0.0, spread)
        height = 0.0 if how == "by" else (_OPEN | _HOLLOW)[at.type] + rng.uniform(0.0, 0.15)
        at_x, at_y = at.position[0] + away * math.cos(angle), at.position[1] + away * math.sin(angle)
        kind = names[int(rng.integers(len(names)))]
        places.append(_Place(Percept(f"m{k}", kind, None, (at_x, at_y, height)), at, how))
    return furniture, places


def _told(places: list[_Place], rng: np.random.Generator) -> tuple[str, str] | None:
    """A command, and the id of what it means; None if nothing needs to be told apart by its place."""
    for k in rng.permutation(len(places)):
        one = places[int(k)]
        alike = [p for p in places if p.thing.type == one.thing.type]
        there = [p for p in alike if p.at.type == one.at.type]
        if len(alike) < 2 or len(there) > 1:
            continue
        words = {"on": _ON, "in": _IN, "by": _BY}[one.how]
        verb, word = str(rng.choice(_VERBS)), str(rng.choice(words))
        return f"{verb} the {one.thing.type} {word} the {one.at.type}", one.thing.id
    return None
