"""Generated lessons on which of several scattered things lies at an end: on the left, on the far right, the third
farthest. Definitions by this project, no human data.

A thing is said to be on a side where it is the farthest there and the robot must turn farthest for it as well.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Sequence

import numpy as np

from dcg_torch.lessons.arrangements import KINDS, Scene, Told
from dcg_torch.lessons.selections import NUMBERS, ORDINALS, ranked, thing
from dcg_torch.scene.workspace import Workspace
from dcg_torch.types import Percept, Pose

_APART = 0.4  # metres at least between two things
_VERBS = ("take", "get", "go to", "pick up")


def scattered_scene(rng: np.random.Generator) -> Scene:
    """Three to seven things of one kind in front of the robot, and some of another."""
    kind, other = map(str, rng.permutation(KINDS)[:2])
    points = scattered(rng, int(rng.integers(3, 8)) + int(rng.integers(0, 4)))
    number = max(3, len(points) - int(rng.integers(0, 4)))
    sized = bool(rng.random() < 0.5)  # some recognisers say how large a thing is
    things = [
        thing(f"o{k}", kind if k < number else other, rng, at, float(rng.uniform(0.1, 1.0)) if sized else None)
        for k, at in enumerate(points)
    ]
    alike = things[:number]
    verb = str(rng.choice(_VERBS))
    said: list[Told] = [
        (f"{verb} the {text}", frozenset({meant}))
        for text, meant in (*_on_sides(kind, alike), *_by_way(kind, alike), *_in_depth(kind, alike))
        if meant is not None
    ]
    said += [(f"{verb} the {text}", ids) for text, ids in _several(kind, alike)]
    return Scene(tuple(things), Pose(0.0, 0.0), Workspace.of(things), tuple(said))


def _on_sides(kind: str, alike: Sequence[Percept]) -> Iterator[tuple[str, str | None]]:
    for side, sign in (("left", 1.0), ("right", -1.0)):
        by_place = ranked(alike, _side(sign))
        by_turn = ranked(alike, _turn(sign), _CLEAR_TURN)
        if by_place[0] == by_turn[0]:
            for text in (
                f"{kind} on the {side}",
                f"{kind} on the {side} side",
                f"{kind} to the {side}",
                f"{side} {kind}",
            ):
                yield text, by_place[0]
        if by_place[1] == by_turn[1]:
            yield f"second {kind} on the {side}", by_place[1]
        for k, ordinal in enumerate(ORDINALS[: len(alike)]):
            yield f"{ordinal} {kind} from the {side}", by_place[k]
            yield f"{kind} {ordinal} from the {side}", by_place[k]


def _in_depth(kind: str, alike: Sequence[Percept]) -> Iterator[tuple[str, str | None]]:
    """The back and the front of what lies ahead, as of a picture: there things are the farthest and the nearest."""
    by_depth, by_way = ranked(alike, lambda o: o.position[0]), ranked(alike, lambda o: math.hypot(*o.position[:2]))
    for end, name, most in ((0, "front", "frontmost"), (-1, "back", "rearmost")):
        if by_depth[end] == by_way[end]:
            texts = (f"{kind} in the {name}", f"{kind} at the {name}", f"{name} {kind}", f"{most} {kind}")
            yield texts[len(alike) % len(texts)], by_depth[end]


def _by_way(kind: str, alike: Sequence[Percept]) -> Iterator[tuple[str, str | None]]:
    """Ways to count by the distance from the robot."""
    order = ranked(alike, lambda o: math.hypot(*o.position[:2]))
    for words, of in ((("nearest", "closest"), order), (("farthest", "furthest"), order[::-1])):
        for word in words:
            yield f"{word} {kind}", of[0]
            yield from ((f"{ORDINALS[k]} {word} {kind}", of[k]) for k in range(1, min(len(of), 4)))


def _several(kind: str, alike: Sequence[Percept]) -> Iterator[Told]:
    """The first two or three of them from a side or from the robot."""
    orders = {
        side: (ranked(alike, _side(sign)), ranked(alike, _turn(sign), _CLEAR_TURN))
        for side, sign in (("left", 1.0), ("right", -1.0))
    }
    near = ranked(alike, lambda o: math.hypot(*o.position[:2]))
    for count in (2, 3):
        if count >= len(alike):
            return
        for side, (by_place, by_turn) in orders.items():
            ids = frozenset(i for i in by_place[:count] if i is not None)
            if len(ids) == count and ids == frozenset(by_turn[:count]):
                for text in (f"{side}most {kind}s", f"{kind}s on the {side}", f"{kind}s farthest to the {side}"):
                    yield f"{NUMBERS[count]} {text}", ids
        for order, text in ((near, f"{kind}s closest to you"), (near[::-1], f"{kind}s farthest from the robot")):
            ids = frozenset(i for i in order[:count] if i is not None)
            if len(ids) == count:
                yield f"{NUMBERS[count]} {text}", ids


_CLEAR_TURN = 0.05  # radians by which two directions must be told apart


def scattered(rng: np.random.Generator, number: int) -> list[tuple[float, float]]:
    """So many places in front of the robot, drawn by chance, apart from one another."""
    found: list[tuple[float, float]] = []
    while len(found) < number:
        point = float(rng.uniform(0.8, 6.5)), float(rng.uniform(-4.5, 4.5))
        if all(math.dist(point, other) > _APART for other in found):
            found.append(point)
    return found


def _side(sign: float) -> Callable[[Percept], float]:
    return lambda o: -sign * o.position[1]


def _turn(sign: float) -> Callable[[Percept], float]:
    return lambda o: -sign * math.atan2(o.position[1], o.position[0])
