"""Generated lessons on sides as parts of the scene: the nearest on your left, the leftmost in the back, all that are on
the right. Definitions by this project, no human data.

What is ranked there is ranked among all that lie on that side, and a plural means all of these.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Sequence

import numpy as np

from dcg_torch.lessons.arrangements import KINDS, Scene, Told
from dcg_torch.lessons.ends import scattered
from dcg_torch.lessons.selections import ORDINALS, ranked, thing
from dcg_torch.scene.places import scene_bounds
from dcg_torch.scene.workspace import Workspace
from dcg_torch.types import Percept, Pose

_ASIDE = 0.35
"""Metres from the line between two parts from which a thing is clearly in one of them."""
_VERBS = ("take", "get", "go to", "pick up")
_SIDEWAYS = ("on the {}", "on your {}", "on the {} side", "to the {}")
_IN_DEPTH = ("in the {}", "at the {}")


def part_scene(rng: np.random.Generator) -> Scene:
    """Four to eight things of one kind in front of the robot, on the floor or on a table, and some of another."""
    kind, other = map(str, rng.permutation(KINDS)[:2])
    number, more = int(rng.integers(4, 9)), int(rng.integers(0, 4))
    sized = bool(rng.random() < 0.4)
    things = [
        thing(f"o{k}", kind if k < number else other, rng, at, float(rng.uniform(0.1, 1.0)) if sized else None)
        for k, at in enumerate(scattered(rng, number + more))
    ]
    points = [o.position[:2] for o in things]
    robot = Pose(0.0, 0.0)
    table = scene_bounds(points, robot) if rng.random() < 0.5 else None
    verb = str(rng.choice(_VERBS))
    said = [(f"{verb} the {text}", ids) for text, ids in _in_parts(kind, things, number)]
    return Scene(tuple(things), robot, Workspace.of(things, table), tuple(said))


def _in_parts(kind: str, things: Sequence[Percept], number: int) -> Iterator[Told]:
    depth = [o.position[0] for o in things]
    middle = (min(depth) + max(depth)) / 2.0
    parts: tuple[tuple[str, tuple[str, ...], Callable[[Percept], float]], ...] = (
        ("left", _SIDEWAYS, lambda o: o.position[1]),
        ("right", _SIDEWAYS, lambda o: -o.position[1]),
        ("front", _IN_DEPTH, lambda o: middle - o.position[0]),
        ("back", _IN_DEPTH, lambda o: o.position[0] - middle),
    )
    alike = things[:number]
    for side, wordings, inside in parts:
        there = [o for o in alike if inside(o) > 0.0]
        if 2 <= len(there) < number and all(abs(inside(o)) > _ASIDE for o in alike):
            where = [wording.format(side) for wording in wordings]
            yield from _ranked_there(kind, where[len(there) % len(where)], there, len(things) % 2 == 0)
            yield from ((f"{kind}s {place}", frozenset(o.id for o in there)) for place in where)


def _ranked_there(kind: str, where: str, there: Sequence[Percept], short: bool) -> Iterator[Told]:
    """The ends of every order among those that lie there.

    Args:
        short: "closest", for "nearest".
    """
    far = ranked(there, lambda o: math.hypot(*o.position[:2]))
    across = ranked(there, lambda o: -o.position[1])
    middle = np.mean([o.position[:2] for o in there], axis=0)
    inner = ranked(there, lambda o: math.dist(o.position[:2], middle))
    near, remote = ("closest", "furthest") if short else ("nearest", "farthest")
    ends = {near: far[0], remote: far[-1], "leftmost": across[0], "rightmost": across[-1]}
    ends |= {f"{ORDINALS[1]} {near}": far[1], f"{ORDINALS[1]} {remote}": far[-2]}
    if len(there) > 2:
        ends["middle"] = inner[0]
    if there[0].size is not None:
        by_size = ranked(there, lambda o: 0.0 if o.size is None else o.size[0], 0.05)
        ends |= {"smallest": by_size[0], "biggest": by_size[-1]}
    for word, meant in ends.items():
        if meant is not None:
            yield f"{word} {kind} {where}", frozenset({meant})
    if far[0] is not None:
        yield f"{kind} {where} that is closest to you", frozenset({far[0]})
