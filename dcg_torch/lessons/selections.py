"""Generated lessons on picking from a set: ordinals and superlatives among what all the rest of a phrase describes.

"The leftmost cone in front of you" picks among the cones in front, however far to a side they are, and not among
those behind; "the second biggest red one" among the red ones. Definitions by this project, no human data.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Iterator, Sequence

import numpy as np

from dcg_torch.lessons.arrangements import COLORS, KINDS, Scene, Told
from dcg_torch.types import Percept, Pose

ORDINALS = ("first", "second", "third", "fourth", "fifth")
NUMBERS = {2: "two", 3: "three", 4: "four", 5: "five", 6: "six", 7: "seven"}
CLEAR = 0.2  # metres by which a rank must be told apart
_CLEAR_SIZE = 0.15  # by which the logarithms of two sizes must be told apart
_WHO = ("you", "the robot")
Unclear = tuple[str, frozenset[str | None]]
"""A command and the ids of what it means; None is one that can hardly be told from another."""


def half_scene(rng: np.random.Generator) -> Scene:
    """Things of one kind in front of the robot and behind it, scattered or in uneven rows."""
    kind, other = map(str, rng.permutation(KINDS)[:2])
    in_rows = bool(rng.random() < 0.5)
    front = _half(kind, "front", rng, 1.0, in_rows)
    behind = _half(kind, "behind", rng, -1.0, in_rows)
    others = [
        thing(f"other {k}", other, rng, (float(rng.uniform(-5.0, 6.0)), float(rng.uniform(-4.0, 4.0))))
        for k in range(int(rng.integers(1, 4)))
    ]
    said = [*_clear(_of_half(kind, front, "in front of", rng)), *_clear(_of_half(kind, behind, "behind", rng))]
    marks = {"the robot": (0.0, 0.0), "you": (0.0, 0.0)}
    if len(others) == 1:
        marks[f"the {other}"] = others[0].position[:2]
    said += [told for name, at in marks.items() for told in _clear(_from_mark(kind, (*front, *behind), name, at))]
    said += _clear(_by_distance(kind, (*front, *behind)))
    if in_rows:
        for half, where in ((front, "in front of"), (behind, "behind")):
            if len(half) >= 3:
                ids = frozenset(o.id for o in half)
                who = str(rng.choice(_WHO))
                said += [(f"go to the row of {kind}s {where} {who}", ids)] * 2
                said.append((f"go to the row of {NUMBERS[len(half)]} {kind}s {where} {who}", ids))
    return Scene((*front, *behind, *others), Pose(0.0, 0.0), None, tuple(said))


def size_scene(rng: np.random.Generator) -> Scene:
    """Things of several sizes and colours, of two kinds."""
    kind, other = map(str, rng.permutation(KINDS)[:2])
    sizes = rng.permutation(np.linspace(0.15, 0.8, 8))
    objects = []
    for k, size in enumerate(sizes[: int(rng.integers(4, 9))].tolist()):
        at = (float(rng.uniform(1.5, 6.0)), float(rng.uniform(-4.0, 4.0)))
        of = kind if k < 3 or rng.random() < 0.6 else other
        objects.append(thing(f"o{k}", of, rng, at, size))
    said = [told for color in (None, *COLORS) for told in _by_size(kind, color, objects)]
    return Scene(tuple(objects), Pose(0.0, 0.0), None, tuple(said))


def _half(kind: str, name: str, rng: np.random.Generator, sign: float, in_rows: bool) -> list[Percept]:
    number = int(rng.integers(3, 8)) if sign > 0 or in_rows else int(rng.integers(1, 4))
    if in_rows:
        x, steps = float(rng.uniform(1.5, 5.0)), rng.uniform(0.7, 1.3, number) * rng.uniform(0.5, 1.4)
        ys = np.cumsum(steps) - steps.sum() / 2
        points = [(sign * x + float(rng.uniform(-0.12, 0.12)), float(y)) for y in ys]
    else:
        points = [(sign * float(rng.uniform(1.2, 6.0)), float(rng.uniform(-4.5, 4.5))) for _ in range(number)]
    return [thing(f"{name} {k}", kind, rng, point) for k, point in enumerate(points)]


def _of_half(kind: str, half: Sequence[Percept], where: str, rng: np.random.Generator) -> Iterator[Unclear]:
    """What picks one or some of a half of the scene; left and right are the robot's as it faces that half."""
    who = str(rng.choice(_WHO))
    yield f"go to the {kind}s {where} {who}", frozenset(o.id for o in half)
    by_side = ranked(half, lambda o: -o.position[1])
    if where == "in front of":
        for side, order in (("left", by_side), ("right", by_side[::-1])):
            yield from ((f"go to the {text} {where} {who}", frozenset({i})) for text, i in _counted(kind, side, order))
        if len(by_side) % 2 and len(by_side) > 2:
            yield f"go to the middle {kind} {where} {who}", frozenset({by_side[len(by_side) // 2]})
    by_way = ranked(half, lambda o: float(np.hypot(*o.position[:2])))
    if len(by_way) > 1:
        for near, far in (("nearest", "farthest"), ("closest", "furthest")):
            yield f"go to the {near} {kind} {where} {who}", frozenset({by_way[0]})
            yield f"go to the {far} {kind} {where} {who}", frozenset({by_way[-1]})
    if len(by_way) > 2:
        yield f"go to the two nearest {kind}s {where} {who}", frozenset(by_way[:2])


def _from_mark(kind: str, things: Sequence[Percept], name: str, at: tuple[float, float]) -> Iterator[Unclear]:
    """Ways to count by the distance from something."""
    order = ranked(things, lambda o: float(np.hypot(o.position[0] - at[0], o.position[1] - at[1])))
    for k, ordinal in enumerate(ORDINALS[1 : min(3, len(order))], start=1):
        yield f"go to the {ordinal} closest {kind} to {name}", frozenset({order[k]})
        yield f"go to the {ordinal} farthest {kind} from {name}", frozenset({order[-1 - k]})
    yield f"go to the {kind} closest to {name}", frozenset({order[0]})
    yield f"go to the {kind} farthest from {name}", frozenset({order[-1]})


def _by_distance(kind: str, things: Sequence[Percept]) -> Iterator[Unclear]:
    """The nearest and the farthest of all, also of those behind the robot."""
    order = ranked(things, lambda o: float(np.hypot(*o.position[:2])))
    for near, far in (("nearest", "farthest"), ("closest", "furthest")):
        yield f"go to the {near} {kind}", frozenset({order[0]})
        yield f"go to the {far} {kind}", frozenset({order[-1]})


def _counted(kind: str, side: str, order: Sequence[str | None]) -> Iterator[tuple[str, str | None]]:
    """Ways to count from one side, each with the id of the one meant."""
    yield f"{side}most {kind}", order[0]
    yield f"{kind} farthest to the {side}", order[0]
    yield f"{kind} farthest to your {side}", order[0]
    for k, ordinal in enumerate(ORDINALS[: len(order)]):
        yield f"{ordinal} {kind} from the {side}", order[k]
    yield f"last {kind} from the {side}", order[-1]
    if len(order) > 1:
        yield f"second last {kind} from the {side}", order[-2]
        yield f"second {side}most {kind}", order[1]
        yield f"second {kind} farthest to the {side}", order[1]


def _of_mean_size(order: Sequence[Percept]) -> str | None:
    """Whose size is the nearest to what lies between the largest and the smallest; None where two are about as near."""
    logs = [math.log(o.size[0]) if o.size is not None else 0.0 for o in order]
    away = sorted((abs(v - (logs[0] + logs[-1]) / 2.0), o.id) for v, o in zip(logs, order, strict=True))
    return away[0][1] if away[1][0] - away[0][0] > _CLEAR_SIZE else None


def _by_size(kind: str, color: str | None, objects: Sequence[Percept]) -> Iterator[Told]:
    alike = [o for o in objects if o.type == kind and color in (None, o.color)]
    if len(alike) < 2:
        return
    order = sorted(alike, key=lambda o: -o.size[0] if o.size is not None else 0.0)
    head = " ".join(filter(None, (color, kind)))
    for big, small in (("biggest", "smallest"), ("largest", "smallest"), ("big", "small"), ("large", "little")):
        yield f"go to the {big} {head}", frozenset({order[0].id})
        yield f"go to the {small} {head}", frozenset({order[-1].id})
    if len(order) > 2 and (mean := _of_mean_size(order)) is not None:
        yield from ((f"go to the {word} {head}", frozenset({mean})) for word in ("medium", "medium sized"))
    for k, ordinal in enumerate(ORDINALS[1 : len(order) - 1], start=1):
        for big, small in (("biggest", "smallest"), ("largest", "smallest")):
            yield f"go to the {ordinal} {big} {head}", frozenset({order[k].id})
            yield f"go to the {ordinal} {small} {head}", frozenset({order[-1 - k].id})


def ranked(things: Sequence[Percept], value: Callable[[Percept], float], clear: float = CLEAR) -> list[str | None]:
    """The ids in the order of a value; None in the place of one that can hardly be told from a neighbour.

    Args:
        clear: by how much the values of two must differ.
    """
    order = sorted(things, key=value)
    apart = np.array([np.inf, *np.diff([value(o) for o in order]), np.inf]) > clear
    return [o.id if apart[k] and apart[k + 1] else None for k, o in enumerate(order)]


def _clear(said: Iterable[Unclear]) -> Iterator[Told]:
    """What names none that can hardly be told from another."""
    for text, ids in said:
        clear = frozenset(i for i in ids if i is not None)
        if len(clear) == len(ids):
            yield text, clear


def thing(id_: str, kind: str, rng: np.random.Generator, at: tuple[float, float], size: float | None = None) -> Percept:
    """A thing of a colour by chance; `size` is its edge in metres."""
    extents = None if size is None else (size, size, size)
    return Percept(id_, kind, str(rng.choice(COLORS)), (*at, 0.0), extents)
