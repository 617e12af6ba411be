"""Generated lessons in arranged scenes: rows and clusters on the floor, stacks on a table with edges and corners.

Like `training.relations` they are definitions by this project and no human data, and are given where a description is
true of exactly what is meant. What they teach is the tree that the language room makes of their text.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Collection, Iterator, Sequence
from dataclasses import dataclass
from typing import Protocol

import numpy as np

from dcg_torch.learning.landmarks import Lesson
from dcg_torch.scene.places import scene_bounds
from dcg_torch.scene.upsilon import world_model
from dcg_torch.scene.workspace import Workspace, with_places
from dcg_torch.types import ParseTree, Percept, Pose

KINDS = ("cube", "sphere", "cylinder")
COLORS = ("red", "green", "blue")
_NUMBERS = {3: "three", 4: "four", 5: "five", 6: "six"}
_ORDINALS = ("first", "second", "third", "fourth")
SEAT = Pose(-2.0, 3.5)
TABLE = Workspace(scene_bounds([(0.0, 0.0), (7.0, 7.0)], SEAT))
"""Eight by eight fields of a metre; the robot stands two metres before the middle of the near edge."""

Told = tuple[str, frozenset[str]]
"""A command, and the ids of what it means."""


class Reading(Protocol):
    """What reading a command gives."""

    @property
    def tree(self) -> ParseTree | None:
        """The phrases, or None if there are none."""


@dataclass(frozen=True)
class Scene:
    """Objects, where the robot is, its workspace (None: the open floor), and what could be said there."""

    objects: tuple[Percept, ...]
    robot: Pose
    workspace: Workspace | None
    commands: tuple[Told, ...]


def arranged_lessons(
    parse: Callable[[str, Collection[str]], Reading],
    count: int = 300,
    seed: int = 0,
    makers: Sequence[Callable[[np.random.Generator], Scene]] | None = None,
) -> tuple[Lesson, ...]:
    """Lessons, the same for the same arguments: one command of each scene.

    Args:
        parse: reads commands.
        makers: of scenes, taken in turn; by default rows, tables and clusters.

    Raises:
        ValueError: a lesson is not read as a command.
    """
    rng = np.random.default_rng(seed)
    makers = makers or (row_scene, table_scene, table_scene, cluster_scene)
    lessons: list[Lesson] = []
    while len(lessons) < count:
        scene = makers[len(lessons) % len(makers)](rng)
        if not scene.commands:
            continue
        text, meant = scene.commands[int(rng.integers(len(scene.commands)))]
        tree = parse(text, KINDS).tree
        if tree is None:
            raise ValueError(f"the lesson {text!r} is not read as a command")
        upsilon = world_model(scene.objects, KINDS, hypothetical=False, robot=scene.robot)
        lessons.append(Lesson(tree, with_places(upsilon, scene.workspace), meant))
    return tuple(lessons)


def row_scene(rng: np.random.Generator) -> Scene:
    """A row of one type across the view or away from the robot, others of the type elsewhere, and other things."""
    kind, other = map(str, rng.permutation(KINDS)[:2])
    number, step = int(rng.integers(3, 7)), float(rng.uniform(0.7, 1.6))
    across = bool(rng.random() < 0.7)
    way = np.array([0.0, -1.0]) if across else np.array([1.0, 0.0])
    start = np.array([rng.uniform(2.0, 4.0), 0.5 * step * (number - 1) if across else rng.uniform(-2.0, 2.0)])
    row = [_percept(f"row {k}", kind, rng, start + k * step * way) for k in range(number)]
    beyond = [start + np.array([0.0, 3.5]), start + number * step * way + np.array([3.0, -2.0])]
    apart = [_percept(f"apart {k}", kind, rng, at) for k, at in enumerate(beyond[: int(rng.integers(1, 3))])]
    others = [_percept(f"other {k}", other, rng, start + np.array([-1.2, -2.5 + 5 * k])) for k in range(2)]
    ids = [o.id for o in row]
    said: list[Told] = [
        (f"go to the row of {kind}s", frozenset(ids)),
        (f"go to the {kind}s in the row", frozenset(ids)),
    ]
    said.append((f"go to the row of {_NUMBERS[number]} {kind}s", frozenset(ids)))
    if len(apart) == 1:
        said.append((f"go to the {kind} that is not in the row", frozenset({apart[0].id})))
    if number % 2:
        said.append((f"go to the middle {kind} in the row", frozenset({ids[number // 2]})))
    if across:
        said += [(f"go to the leftmost {kind} in the row", frozenset({ids[0]}))]
        said += [(f"go to the {kind} in the row on the right", frozenset({ids[-1]}))] if not apart else []
        for k in range(1, min(number, 4)):
            said.append((f"go to the {_ORDINALS[k]} {kind} from the left in the row", frozenset({ids[k]})))
            said.append((f"go to the {_ORDINALS[k]} {kind} from the right in the row", frozenset({ids[-1 - k]})))
    else:
        said += [(f"go to the nearest {kind} in the row", frozenset({ids[0]}))]
        said += [(f"go to the farthest {kind} in the row", frozenset({ids[-1]}))]
    return Scene((*row, *apart, *others), Pose(0.0, 0.0), None, tuple(said))


def cluster_scene(rng: np.random.Generator) -> Scene:
    """A cluster of one type, and single things of this and of another type."""
    kind, other = map(str, rng.permutation(KINDS)[:2])
    number = int(rng.integers(3, 6))
    centre, turn = np.array([rng.uniform(2.5, 4.0), rng.uniform(-2.0, 2.0)]), float(rng.uniform(0.0, math.tau))
    angles = turn + math.tau * np.arange(number) / number
    points = centre + 0.7 * np.column_stack([np.cos(angles), np.sin(angles)])
    near = [_percept(f"near {k}", kind, rng, p + rng.uniform(-0.1, 0.1, 2)) for k, p in enumerate(points)]
    apart = _percept("apart", kind, rng, centre + np.array([2.0, 4.0]))
    others = [_percept(f"other {k}", other, rng, centre + np.array([3.0 * k, -4.0])) for k in range(2)]
    ids = frozenset(o.id for o in near)
    said = [(f"go to the {word} of {kind}s", ids) for word in ("group", "cluster", "bunch")]
    said.append((f"go to the {kind}s in the group", ids))
    said.append((f"go to the {kind} that is not in the group", frozenset({apart.id})))
    return Scene((*near, apart, *others), Pose(0.0, 0.0), None, tuple(said))


def table_scene(rng: np.random.Generator) -> Scene:
    """Cubes, spheres and stacks of them on a table; all that is true of one object alone can be said."""
    fields = [(int(c) // 8, int(c) % 8) for c in rng.permutation(64)[: int(rng.integers(4, 9))]]
    objects: list[Percept] = []
    for x, y in fields:
        for z in range(int(rng.choice([1, 1, 1, 2, 3]))):
            kind = str(rng.choice(KINDS[:2])) if z else "cube"
            objects.append(Percept(f"o{len(objects)}", kind, str(rng.choice(COLORS)), (float(x), float(y), float(z))))
    said = [told for o in objects for told in _about(o, objects)]
    return Scene(tuple(objects), SEAT, TABLE, tuple(said))


def _about(one: Percept, objects: Sequence[Percept]) -> Iterator[Told]:
    """What tells an object of a table apart from those of its type and colour."""
    head = f"{one.color} {one.type}"
    alike = [o for o in objects if (o.type, o.color) == (one.type, one.color)]
    if len(alike) < 2:
        return
    only = frozenset({one.id})

    def alone(fits: Callable[[Percept], bool]) -> bool:
        return [o for o in alike if fits(o)] == [one]

    def rests_on(o: Percept) -> Percept | None:
        return next((p for p in objects if p.position == (*o.position[:2], o.position[2] - 1.0)), None)

    def covered(o: Percept) -> bool:
        return any(rests_on(p) is o for p in objects)

    below = rests_on(one)
    if below is None and alone(lambda o: rests_on(o) is None):
        yield from ((f"take the {head} {where}", only) for where in ("on the floor", "on the ground", "from the board"))
    if below is None and not covered(one) and alone(lambda o: rests_on(o) is None and not covered(o)):
        yield f"take the single {head}", only
    if alone(lambda o: not covered(o)):
        yield f"take the {head} with nothing on it", only
    if below is not None and alone(lambda o: (p := rests_on(o)) is not None and _same(p, below)):
        for word in ("on top of", "on", "above"):
            yield f"take the {head} {word} the {below.color} {below.type}", only
    above = next((p for p in objects if rests_on(p) is one), None)
    if above is not None and alone(lambda o: any(rests_on(p) is o and _same(p, above) for p in objects)):
        yield f"take the {head} under the {above.color} {above.type}", only
    if below is not None and not covered(one) and alone(lambda o: rests_on(o) is not None and not covered(o)):
        for word in ("stack", "tower"):
            yield f"take the {head} on top of the {word}", only
    yield from _at_edges(one, alike, head)


def _at_edges(one: Percept, alike: Sequence[Percept], head: str) -> Iterator[Told]:
    """Where on the table: at an edge, in a corner, in the middle, the one that is farthest to a side."""
    only = frozenset({one.id})
    ways = {"left": (0.0, 1.0), "right": (0.0, -1.0), "top": (1.0, 0.0), "bottom": (-1.0, 0.0)}
    centre = np.array([3.5, 3.5])
    place = {o.id: np.array(o.position[:2]) - centre for o in alike}

    def first(value: Callable[[str], float], margin: float = 1.0) -> bool:
        ranked = sorted(alike, key=lambda o: value(o.id))
        return ranked[0] is one and value(ranked[1].id) - value(one.id) >= margin

    for side, way in ways.items():
        reach = {i: float(p @ np.array(way)) for i, p in place.items()}
        if first(lambda i, reach=reach: -reach[i]):  # type: ignore[misc]
            yield f"take the {head} closest to the {side} edge", only
            yield f"take the {head} near the {side}", only
            if side in ("left", "right"):
                yield from ((f"take the {text}", only) for text in (f"{side} {head}", f"{head} on the {side}"))
                yield f"take the {side}most {head}", only
            if reach[one.id] == 3.5:
                yield f"take the {head} at the {side} edge", only
    inside = {i: 3.5 - float(np.abs(p).max()) for i, p in place.items()}  # how far from the nearest edge
    if inside[one.id] == 0.0 and first(lambda i: inside[i], margin=2.0):
        yield from (
            (f"take the {head} {where} the {edge}", only) for where in ("at", "on") for edge in ("edge", "border")
        )
    corners = {i: float(np.linalg.norm(3.5 - np.abs(p))) for i, p in place.items()}  # how far from the nearest one
    if corners[one.id] == 0.0 and first(lambda i: corners[i], margin=2.0):
        yield from ((f"take the {head} in {which} corner", only) for which in ("the", "a"))
        yield f"take the {head} in the corner of the board", only
    for depth in ("top", "bottom"):
        for side in ("left", "right"):
            corner = 3.5 * (np.array(ways[depth]) + np.array(ways[side]))
            off = {i: float(np.linalg.norm(p - corner)) for i, p in place.items()}
            if first(lambda i, off=off: off[i]):  # type: ignore[misc]
                yield f"take the {head} closest to the {depth} {side} corner", only
                if off[one.id] == 0.0:
                    yield f"take the {head} in the {depth} {side} corner", only
    if first(lambda i: float(np.linalg.norm(place[i]))) and np.linalg.norm(place[one.id]) < 1.5:
        yield f"take the {head} in the middle", only


def _same(one: Percept, other: Percept) -> bool:
    return (one.type, one.color) == (other.type, other.color)


def _percept(
    name: str, kind: str, rng: np.random.Generator, at: np.ndarray[tuple[int], np.dtype[np.float64]]
) -> Percept:
    return Percept(name, kind, str(rng.choice(COLORS)), (float(at[0]), float(at[1]), 0.0))
