"""Generated lessons among things that say how large they are: on, under and beside furniture, and close on a table.

Like the other generated lessons they are definitions by this project and no human data. What they teach is that a thing
at the end of a bed is on it as much as one in its middle, and that two things side by side are no stack.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np

from dcg_torch.lessons.arranged import COLORS, Scene, Told
from dcg_torch.scene.workspace import Workspace
from dcg_torch.types import Percept, Pose

_FURNITURE = {
    **{"table": (1.3, 0.9, 0.75), "desk": (1.4, 0.7, 0.74), "bed": (1.9, 1.5, 0.5), "couch": (2.0, 0.95, 0.45)},
    **{"coffee table": (1.0, 0.6, 0.45), "counter": (2.0, 0.6, 0.9), "dresser": (1.1, 0.45, 0.9)},
    **{"nightstand": (0.5, 0.45, 0.6), "shelf": (0.8, 0.35, 1.2), "workbench": (2.0, 1.0, 0.8)},
}
"""Pieces and their extents in metres."""
_OPEN_BELOW = ("table", "desk", "workbench")
_THINGS = {
    **{"pillow": (0.5, 0.35, 0.15), "cup": (0.08, 0.08, 0.1), "book": (0.2, 0.15, 0.04), "lamp": (0.25, 0.25, 0.45)},
    **{"vase": (0.15, 0.15, 0.3), "laptop": (0.32, 0.22, 0.2), "box": (0.35, 0.35, 0.3), "plant": (0.3, 0.3, 0.5)},
    **{"chair": (0.5, 0.5, 0.9), "bin": (0.3, 0.3, 0.4), "stool": (0.35, 0.35, 0.45), "backpack": (0.35, 0.3, 0.45)},
}
_ON_FLOOR = ("chair", "bin", "stool", "plant", "backpack", "box")
_SMALL = {
    **{"cup": (0.08, 0.08, 0.1), "box": (0.28, 0.28, 0.18), "ball": (0.08, 0.08, 0.08), "cube": (0.09, 0.09, 0.09)},
    **{"bowl": (0.2, 0.2, 0.08), "hammer": (0.28, 0.12, 0.04), "fork": (0.18, 0.03, 0.02), "can": (0.07, 0.07, 0.11)},
    **{"bottle": (0.07, 0.07, 0.25), "plate": (0.24, 0.24, 0.03), "jar": (0.1, 0.1, 0.14), "book": (0.2, 0.15, 0.04)},
}
_BEGIN = ("take the", "pick up the", "the", "find the", "bring me the", "choose the", "go to the", "get the")
_BY = ("next to", "beside", "by", "near", "close to")
_NUMBERS = {2: "two", 3: "three", 4: "four"}
_CLOSE, _APART = 0.45, 1.0
"""Metres between the sides of things that are beside each other in a room, and of those that are not."""
_TRIES = 40


@dataclass(frozen=True)
class _Body:
    """A thing, its middle and its extents."""

    kind: str
    color: str | None
    middle: tuple[float, float, float]
    size: tuple[float, float, float]

    def gap(self, other: _Body) -> float:
        """Metres between the footprints, 0 where they share floor."""
        apart = [abs(self.middle[k] - other.middle[k]) - (self.size[k] + other.size[k]) / 2 for k in (0, 1)]
        return math.hypot(max(0.0, apart[0]), max(0.0, apart[1]))

    @property
    def name(self) -> str:
        """What it is called, its colour first."""
        return f"{self.color} {self.kind}" if self.color else self.kind


def furnished_scene(rng: np.random.Generator) -> Scene:
    """A room: things on, under and beside pieces of furniture, and things that are nowhere near any."""
    pieces = _pieces(rng)
    kinds = [str(kind) for kind in rng.choice([*_THINGS], size=int(rng.integers(3, 6)), replace=False)]
    placed: list[tuple[_Body, _Body | None, str]] = []
    for kind in kinds:
        at = int(rng.integers(len(pieces)))  # several of a kind are at one piece
        for k in range(int(rng.integers(2, 6))):
            piece = pieces[at] if k < 2 or rng.random() < 0.3 else pieces[int(rng.integers(len(pieces)))]
            found = _placed(kind, piece, rng)
            if all(found[0].gap(other) > 0.0 or found[2] != how for other, _, how in placed):
                placed.append(found)
    said = [*_on(placed, rng), *_under(placed, rng), *_beside(placed, pieces, rng)]
    return _scene([*pieces, *(thing for thing, _, _ in placed)], said, rng)


def table_top_scene(rng: np.random.Generator) -> Scene:
    """A table with many small things close together, some of them on others, and things that are elsewhere."""
    table = _Body("table", None, (1.3, 0.0, 0.375), (1.1, 2.0, 0.75))
    kinds = [str(kind) for kind in rng.choice([*_SMALL], size=int(rng.integers(3, 5)), replace=False)]
    top: list[_Body] = []
    for _ in range(int(rng.integers(7, 14))):
        kind = kinds[int(rng.integers(len(kinds)))]
        size = _scaled(_SMALL[kind], rng)
        reach = [(table.size[k] - size[k]) / 2 for k in (0, 1)]
        x, y = table.middle[0] + rng.uniform(-reach[0], reach[0]), rng.uniform(-reach[1], reach[1])
        thing = _Body(kind, str(rng.choice(COLORS)), (x, y, 0.75 + size[2] / 2), size)
        if all(thing.gap(other) > 0.02 for other in top):
            top.append(thing)
    stacked: list[tuple[_Body, _Body]] = []
    for below in top[:2]:
        kind = str(rng.choice(["cup", "cube", "ball", "can"]))
        size = _SMALL[kind]
        if below.size[0] > size[0] * 0.9 and below.size[1] > size[1] * 0.9:
            height = below.middle[2] + (below.size[2] + size[2]) / 2
            stacked.append((_Body(kind, str(rng.choice(COLORS)), (*below.middle[:2], height), size), below))
    things = [*top, *(thing for thing, _ in stacked)]
    floor = [
        _Body("stool", None, (0.2, 1.5, 0.3), (0.35, 0.35, 0.6)),
        _Body("shelf", None, (2.5, 0.5, 1), (0.4, 1.6, 2)),
    ]
    said = [*_close(top, rng), *_stacked(stacked, things, rng)]
    return _scene([table, *floor, *things], said, rng)


def _pieces(rng: np.random.Generator) -> list[_Body]:
    pieces: list[_Body] = []
    kinds = rng.choice([*_FURNITURE], size=int(rng.integers(4, 9))).tolist()
    for kind in kinds:
        for _ in range(_TRIES):
            width, depth, height = _scaled(_FURNITURE[kind], rng)
            size = (width, depth, height) if rng.random() < 0.5 else (depth, width, height)
            piece = _Body(kind, None, (rng.uniform(0.5, 7.0), rng.uniform(-3.5, 3.5), height / 2), size)
            if all(piece.gap(other) > 0.5 for other in pieces):
                pieces.append(piece)
                break
    return pieces


def _scaled(size: Sequence[float], rng: np.random.Generator) -> tuple[float, float, float]:
    by = rng.uniform(0.85, 1.15)
    return (by * size[0], by * size[1], by * size[2])


def _placed(kind: str, piece: _Body, rng: np.random.Generator) -> tuple[_Body, _Body | None, str]:
    """A thing somewhere at a piece, or nowhere near it."""
    size = _scaled(_THINGS[kind], rng)
    draw = rng.random()
    inside = [max(0.0, (piece.size[k] - size[k]) / 2) for k in (0, 1)]
    x, y = (piece.middle[k] + rng.uniform(-inside[k], inside[k]) for k in (0, 1))
    if kind in _ON_FLOOR and piece.kind in _OPEN_BELOW and draw < 0.3:
        return _Body(kind, None, (x, y, size[2] / 2), size), piece, "under"
    if kind not in ("chair", "stool") and draw < 0.75:
        top = piece.middle[2] + piece.size[2] / 2
        return _Body(kind, None, (x, y, top + size[2] / 2), size), piece, "on"
    away = rng.uniform(0.05, 0.35)
    side, sign = int(rng.integers(2)), float(rng.choice([-1.0, 1.0]))
    at = [x, y]
    at[side] = piece.middle[side] + sign * ((piece.size[side] + size[side]) / 2 + away)
    return _Body(kind, None, (at[0], at[1], size[2] / 2), size), piece, "by"


def _on(
    placed: Sequence[tuple[_Body, _Body | None, str]], rng: np.random.Generator
) -> Iterator[tuple[str, list[_Body]]]:
    """Those of a kind that are on the one piece of its name; the biggest of them."""
    for kind, piece in {(thing.kind, id(at)): (thing.kind, at) for thing, at, how in placed if how == "on"}.values():
        there = [
            thing
            for thing, at, how in placed
            if thing.kind == kind and how == "on" and at and piece and at.kind == piece.kind
        ]
        others = [thing for thing, _, _ in placed if thing.kind == kind and thing not in there]
        if piece is None or not others or len({id(at) for thing, at, _ in placed if thing in there}) > 1:
            continue
        where = f"{rng.choice(('on', 'on', 'on top of', 'that is on', 'from'))} the {piece.kind}"
        if len(there) == 1:
            yield f"{kind} {where}", there
        elif len(there) < 5:
            many = str(rng.choice(("", "", f"{_NUMBERS[len(there)]} ")))
            yield f"{many}{kind}s {where}", there
            ranked = sorted(there, key=lambda thing: math.prod(thing.size))
            if math.prod(ranked[-1].size) > 1.1 * math.prod(ranked[-2].size):
                yield f"{rng.choice(('biggest', 'largest'))} {kind} {where}", ranked[-1:]


def _under(
    placed: Sequence[tuple[_Body, _Body | None, str]], rng: np.random.Generator
) -> Iterator[tuple[str, list[_Body]]]:
    for thing, piece, how in placed:
        alike = [at.kind for other, at, where in placed if other.kind == thing.kind and where == "under" and at]
        if how == "under" and piece is not None and alike.count(piece.kind) == 1:
            yield f"{thing.kind} {rng.choice(('under', 'underneath', 'below'))} the {piece.kind}", [thing]


def _beside(
    placed: Sequence[tuple[_Body, _Body | None, str]], pieces: Sequence[_Body], rng: np.random.Generator
) -> Iterator[tuple[str, list[_Body]]]:
    """A thing that is close to the side of a piece, where no other of its kind is anywhere near one of that name."""
    for thing, piece, how in placed:
        if how != "by" or piece is None:
            continue
        named = [other for other in pieces if other.kind == piece.kind]
        others = [other for other, _, _ in placed if other.kind == thing.kind and other is not thing]
        if thing.gap(piece) < _CLOSE and all(other.gap(at) > _APART for other in others for at in named):
            yield f"{thing.kind} {rng.choice(_BY)} the {piece.kind}", [thing]


def _close(top: Sequence[_Body], rng: np.random.Generator) -> Iterator[tuple[str, list[_Body]]]:
    """Of the small things of a kind the one that is close to another thing."""
    for mark in top:
        if sum(other.name == mark.name for other in top) > 1:
            continue
        for kind in sorted({thing.kind for thing in top} - {mark.kind}):
            gaps = sorted((thing.gap(mark), k) for k, thing in enumerate(top) if thing.kind == kind)
            if len(gaps) > 1 and gaps[0][0] < 0.2 and gaps[1][0] > max(0.3, 2.5 * gaps[0][0]):
                yield f"{kind} {rng.choice(_BY)} the {mark.name}", [top[gaps[0][1]]]


def _stacked(
    stacked: Sequence[tuple[_Body, _Body]], things: Sequence[_Body], rng: np.random.Generator
) -> Iterator[tuple[str, list[_Body]]]:
    for thing, below in stacked:
        unique = sum(other.name == below.name for other in things) == 1
        if unique and sum(other.kind == thing.kind for other in things) > 1:
            yield f"{thing.kind} {rng.choice(('on', 'on top of'))} the {below.name}", [thing]


def _scene(bodies: Sequence[_Body], said: Sequence[tuple[str, list[_Body]]], rng: np.random.Generator) -> Scene:
    """Positions are middles, as most recognisers give them, or feet."""
    feet = rng.random() < 0.3
    percepts = [
        Percept(f"o{k}", b.kind, b.color, (*b.middle[:2], b.middle[2] - (b.size[2] / 2 if feet else 0.0)), b.size)
        for k, b in enumerate(bodies)
    ]
    number = {id(body): f"o{k}" for k, body in enumerate(bodies)}
    told: list[Told] = [
        (f"{rng.choice(_BEGIN)} {text}", frozenset(number[id(body)] for body in meant)) for text, meant in said
    ]
    points = np.array([p.position for p in percepts])
    apart = np.linalg.norm(points[None] - points[:, None], axis=2)
    np.fill_diagonal(apart, np.inf)
    return Scene(tuple(percepts), Pose(0.0, 0.0), Workspace(None, float(np.median(apart.min(axis=1)))), tuple(told))
