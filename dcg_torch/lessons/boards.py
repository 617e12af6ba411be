"""Generated lessons on a board of things that all look alike, seen from its near edge: rows and columns counted through
the whole board, corners, ends and the middle, single things, and stacks as landmarks.

Definitions by this project, no human data. A description is given where it fits one thing and no other nearly.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Sequence

import numpy as np

from dcg_torch.lessons.arrangements import KINDS, Scene, Told
from dcg_torch.lessons.selections import NUMBERS, ORDINALS
from dcg_torch.scene.places import scene_bounds
from dcg_torch.scene.workspace import Workspace
from dcg_torch.types import Percept, Pose

_DEEP, _HALF = 7.0, 3.5
_SEAT = Pose(-3.0, 0.0)
_BOARD = Workspace(scene_bounds([(0.0, -_HALF), (_DEEP, _HALF)], _SEAT))
_HIGH = 0.7
"""Height of a thing, in units: neighbours are a little farther apart than things are wide."""
_LEAST, _TRIES = 0.75, 300
_SPREAD, _GAP = 0.4, 1.0
"""Things of a line are within so much of one another, and those of two lines so far apart."""
_CLEAR = 0.4
"""Units by which a rank must be told apart."""
_ALONE, _BESIDE = 1.7, 1.3
Spot = tuple[Percept, ...]
"""Things on one spot, the lowest first; the last is the one that can be taken."""


def board_scene(rng: np.random.Generator) -> Scene:
    """Single things and stacks of them, scattered over a board or in lines across it or along it."""
    kind = str(rng.choice(KINDS))
    lines = int(rng.integers(3))
    points = _scattered(rng) if not lines else _in_lines(rng)
    if lines == 2:
        points = [(y + _HALF, x - _HALF) for x, y in points]
    stacks = {} if rng.random() < 0.35 else {k: int(rng.integers(2, 4)) for k in range(int(rng.integers(1, 3)))}
    spots = [
        tuple(Percept(f"o{k} {z}", kind, None, (x, y, _HIGH * z)) for z in range(stacks.get(k, 1)))
        for k, (x, y) in enumerate(points)
    ]
    said = [tuple(_lines(kind, spots)), tuple(_ranks(kind, spots)), tuple(_stacks(kind, spots, rng))]
    said = [
        told for told in (*said, *said, said[0], tuple(_corners(kind, spots, rng)), tuple(_alone(kind, spots))) if told
    ]
    objects = [o for spot in spots for o in spot]
    return Scene(
        tuple(objects[k] for k in rng.permutation(len(objects)).tolist()),
        _SEAT,
        _BOARD,
        said[int(rng.integers(len(said)))] if said else (),
    )


def _scattered(rng: np.random.Generator) -> list[tuple[float, float]]:
    points: list[tuple[float, float]] = []
    for _ in range(_TRIES):
        at = float(rng.uniform(0.0, _DEEP)), float(rng.uniform(-_HALF, _HALF))
        if points and rng.random() < 0.5:  # things stand in clumps
            (x, y), turn = points[int(rng.integers(len(points)))], float(rng.uniform(0.0, math.tau))
            at = x + _LEAST * math.cos(turn), y + _LEAST * math.sin(turn)
        if 0.0 <= at[0] <= _DEEP and abs(at[1]) <= _HALF and all(math.dist(at, p) > _LEAST - 1e-6 for p in points):
            points.append(at)
        if len(points) == 9:
            break
    return points


def _in_lines(rng: np.random.Generator) -> list[tuple[float, float]]:
    """Some lines across, each with a few things."""
    number = int(rng.integers(3, 6))
    steps = rng.uniform(1.2, 1.6, number)
    found = []
    for x in np.cumsum(steps).tolist():
        ys = np.sort(rng.choice(8, int(rng.integers(1, 5)), replace=False)) - _HALF
        found += [(x - 1.2 + float(rng.uniform(-0.15, 0.15)), float(y + rng.uniform(-0.1, 0.1))) for y in ys]
    return [found[k] for k in rng.permutation(len(found)).tolist()]


_AXES: dict[str, tuple[int, float, tuple[str, ...], tuple[str, ...], tuple[str, str]]] = {
    "row": (0, -1.0, ("top", "back", "first"), ("bottom", "front", "last"), ("top", "bottom")),
    "column": (1, -1.0, ("left", "leftmost", "first"), ("right", "rightmost", "last"), ("left", "right")),
}
"""Kind of line -> the axis that tells them apart, its sign, what the first and the last are called, where one counts
from."""


def _lines(kind: str, spots: Sequence[Spot]) -> Iterator[Told]:
    """What is in the third row, and the second thing in it."""
    for name, (axis, sign, firsts, lasts, ends) in _AXES.items():
        lines = _parted(spots, axis, sign)
        for k, line in enumerate(lines):
            back = len(lines) - 1 - k
            names = [f"the {ORDINALS[k]} {name}", f"the {ORDINALS[k]} {name} from the {ends[0]}"] if k < 5 else []
            names += [f"the {ORDINALS[back]} {name} from the {ends[1]}"] if back < 5 else []
            names += [f"the {word} {name}" for word in (*(firsts if k == 0 else ()), *(lasts if back == 0 else ()))]
            for text, meant in _in_one(kind, line, 1 - axis):
                yield from ((f"go to the {text} in {which}", frozenset({meant})) for which in names)


def _parted(spots: Sequence[Spot], axis: int, sign: float) -> list[list[Spot]]:
    """The lines along an axis, in order; none where there are too few, or where it is hard to tell where one ends."""
    order = sorted(spots, key=lambda spot: sign * spot[0].position[axis])
    value = [spot[0].position[axis] for spot in order]
    steps = np.abs(np.diff(value))
    lines = [list(part) for part in np.split(np.arange(len(order)), np.flatnonzero(steps >= _GAP) + 1)]
    spread = max(abs(value[line[-1]] - value[line[0]]) for line in lines)
    return [[order[k] for k in line] for line in lines] if len(lines) > 2 and spread <= _SPREAD else []


def _in_one(kind: str, line: Sequence[Spot], axis: int) -> Iterator[tuple[str, str]]:
    """The things of a line, as one reads: from the left, or from the far end."""
    order = [spot[-1].id for spot in sorted(line, key=lambda spot: -spot[0].position[axis])]
    first, last = ("left", "right") if axis == 1 else ("top", "bottom")
    if len(order) == 1:
        yield from ((f"{word}{kind}", order[0]) for word in ("", "", "single ", "lone "))
        return
    for k, ordinal in enumerate(ORDINALS[: len(order)]):
        yield f"{ordinal} {kind}", order[k]
        yield f"{ordinal} {kind} from the {last}", order[-1 - k]
    yield f"{first} {kind}", order[0]
    yield f"{last} {kind}", order[-1]
    yield f"last {kind}", order[-1]
    if axis == 1:
        yield f"leftmost {kind}", order[0]
        yield f"rightmost {kind}", order[-1]
    if len(order) == 3:
        yield f"middle {kind}", order[1]


_DEPTHS = {1.0: ("top", "upper"), -1.0: ("bottom", "lower")}
_COMPASS = {(1.0, 1.0): "northwest", (1.0, -1.0): "northeast", (-1.0, 1.0): "southwest", (-1.0, -1.0): "southeast"}


def _corners(kind: str, spots: Sequence[Spot], rng: np.random.Generator) -> Iterator[Told]:
    """What is nearest to a corner of the board."""
    for (depth, side), compass in _COMPASS.items():
        corner = (_DEEP / 2 * (1.0 + depth), _HALF * side)
        meant = _least(spots, lambda spot, corner=corner: math.dist(spot[0].position[:2], corner), 0.6)  # type: ignore[misc]
        if meant is None:
            continue
        word, lateral = str(rng.choice(_DEPTHS[depth])), "left" if side > 0.0 else "right"
        for text in (
            f"{word} {lateral} {kind}",
            f"{kind} in the {word} {lateral}",
            f"{kind} at the {word} {lateral} of the board",
            f"{kind} in the {word} {lateral} corner",
            f"{compass}ern {kind}",
            f"{kind} closest to the {compass} corner of the table",
        ):
            yield f"go to the {text}", meant


def _ranks(kind: str, spots: Sequence[Spot]) -> Iterator[Told]:
    """The first few from each side, in all and on one half of the board; the middle one."""
    level = all(len(spot) == 1 for spot in spots)
    ways = {"top": (0, -1.0), "bottom": (0, 1.0), "left": (1, -1.0), "right": (1, 1.0)}
    superlative: dict[str, tuple[str, ...]] = {"top": ("topmost", "farthest"), "bottom": ("bottommost", "closest")}
    superlative |= {"left": ("leftmost",), "right": ("rightmost",)}
    if level:
        superlative = {**superlative, "top": (*superlative["top"], "highest"), "bottom": ("bottommost", "lowest")}
    halves = {"": spots}
    if all(abs(spot[0].position[1]) > 0.5 for spot in spots):
        for side, sign in (("left", 1.0), ("right", -1.0)):
            halves[f" on the {side}"] = [s for s in spots if s[0].position[1] * sign > 0.0]
    for where, some in halves.items():
        for way, (axis, sign) in ways.items():
            order = sorted(some, key=lambda spot, a=axis, s=sign: s * spot[0].position[a])  # type: ignore[misc]
            value = [math.inf, *(spot[0].position[axis] for spot in order), math.inf]
            if where and axis == 1:
                continue
            for k, spot in enumerate(order[:4]):
                if min(abs(value[k + 1] - value[k]), abs(value[k + 2] - value[k + 1])) < _CLEAR:
                    continue
                only, ordinal = frozenset({spot[-1].id}), ORDINALS[k]
                yield f"go to the {ordinal} {kind} from the {way}{where}", only
                yield f"go to the {kind}{where} that is {ordinal} from the {way}", only
                for word in () if where else superlative[way]:
                    yield f"go to the {'' if k == 0 else ordinal + ' '}{word} {kind}{where}", only
    middle = _least(spots, lambda spot: math.dist(spot[0].position[:2], (_DEEP / 2, 0.0)), 0.8)
    if middle is not None:
        for text in ("{} in the middle", "middle {}", "{} in the center of the board", "most central {}"):
            yield f"go to the {text.format(kind)}", middle


def _stacks(kind: str, spots: Sequence[Spot], rng: np.random.Generator) -> Iterator[Told]:
    """The top of a stack, and what stands before, behind and beside one."""
    stacks = [spot for spot in spots if len(spot) > 1]
    centre: Spot = (Percept("centre", kind, None, (_DEEP / 2, 0.0, 0.0)),)
    if all(_apart(spot, centre) > _BESIDE for spot in spots):
        yield from _beside(
            kind, str(rng.choice(("the middle", "the center", "the center of the board"))), centre, spots
        )
    for stack in stacks:
        word = str(rng.choice(("stack", "tower", "pile")))
        names = [f"the {word}"] if len(stacks) == 1 else []
        names += (
            [f"the {word} of {NUMBERS[len(stack)]} {kind}s"] if [len(s) for s in stacks].count(len(stack)) == 1 else []
        )
        names += _of_several(word, stack, stacks, rng)
        for name in names:
            only = frozenset({stack[-1].id})
            yield f"go to the top {kind} of {name}", only
            yield f"go to the {kind} on top of {name}", only
            yield f"take the top {kind} from {name}", only
            near = _least([s for s in spots if s is not stack], lambda s, at=stack: _apart(s, at), 0.5)  # type: ignore[misc]
            if near is not None:
                yield from ((f"go to the {kind} {by} {name}", near) for by in ("closest to", "next to", "near"))
            yield from _beside(kind, name, stack, spots)


def _of_several(word: str, stack: Spot, stacks: Sequence[Spot], rng: np.random.Generator) -> Iterator[str]:
    """What tells a stack from the others by where it stands."""
    if len(stacks) < 2:
        return
    for name, axis, sign in (("left", 1, 1.0), ("right", 1, -1.0), ("top", 0, 1.0), ("bottom", 0, -1.0)):
        if all(sign * (stack[0].position[axis] - s[0].position[axis]) > 0.8 for s in stacks if s is not stack):
            yield f"the {name} {word}"
            yield f"the {word} on the {name}" if axis else f"the {word} at the {name}"
            yield f"the {word} closest to the {name} edge of the board"
    for (depth, side), compass in _COMPASS.items():
        corner = (_DEEP / 2 * (1.0 + depth), _HALF * side)
        meant = _least(stacks, lambda s, corner=corner: math.dist(s[0].position[:2], corner), 0.8)  # type: ignore[misc]
        if meant == frozenset({stack[-1].id}):
            lateral = "left" if side > 0.0 else "right"
            yield f"the {word} in the {rng.choice(_DEPTHS[depth])} {lateral}{rng.choice(('', ' corner'))}"
            yield f"the {word} closest to the {compass} corner"


_WAYS = {
    "above": (1.0, 0.0),
    "behind": (1.0, 0.0),
    "below": (-1.0, 0.0),
    "in front of": (-1.0, 0.0),
    "to the left of": (0.0, 1.0),
    "to the right of": (0.0, -1.0),
} | {f"{name} of": (depth, side) for (depth, side), name in _COMPASS.items()}


def _beside(kind: str, name: str, stack: Spot, spots: Sequence[Spot]) -> Iterator[Told]:
    """The nearest that is straight that way from a stack, where none is nearer aslant."""
    for way, (x, y) in _WAYS.items():

        def off(spot: Spot, x: float = x, y: float = y) -> float:
            dx, dy = (a - b for a, b in zip(spot[0].position[:2], stack[0].position[:2], strict=True))
            along = (x * dx + y * dy) / max(math.hypot(dx, dy) * math.hypot(x, y), 1e-9)
            return math.degrees(math.acos(max(-1.0, min(1.0, along))))

        there = [s for s in spots if s is not stack and off(s) < 65.0]
        meant = _least(there, lambda s: _apart(s, stack), 0.5)
        spot = next((s for s in there if meant is not None and s[-1].id in meant), None)
        if spot is not None and meant is not None and off(spot) < 25.0:
            yield from ((f"go to the {kind} {just}{way} {name}", meant) for just in ("", "just ", "directly "))


def _alone(kind: str, spots: Sequence[Spot]) -> Iterator[Told]:
    """The one that has no neighbour."""
    nearest = [min(_apart(spot, s) for s in spots if s is not spot) for spot in spots]
    far = [spot for spot, away in zip(spots, nearest, strict=True) if away > _BESIDE or len(spot) > 1]
    if len(far) == 1 and len(far[0]) == 1 and max(nearest) > _ALONE:
        for text in ("lone {}", "single {}", "{} by itself", "isolated {}"):
            yield f"go to the {text.format(kind)}", frozenset({far[0][0].id})


def _least(spots: Sequence[Spot], value: Callable[[Spot], float], margin: float) -> frozenset[str] | None:
    """The top of the spot of least value; None where another is nearly as low."""
    order = sorted(spots, key=value)
    if not order or (len(order) > 1 and value(order[1]) - value(order[0]) < margin):
        return None
    return frozenset({order[0][-1].id})


def _apart(one: Spot, other: Spot) -> float:
    return math.dist(one[0].position[:2], other[0].position[:2])
