"""Generated lessons among things that say how large they are: on, under and beside furniture, and far from it.

Like the other generated lessons they are definitions by this project and no human data. What they teach is that a thing
at the end of a bed is on it as much as one in its middle, and that two things side by side are no stack.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence

import numpy as np

from dcg_torch.lessons.arrangements import Scene
from dcg_torch.lessons.sized_things import BY, THING, Body, scaled, scene_of

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
_NUMBERS = {2: "two", 3: "three", 4: "four"}
_HIGH = (("tallest", "shortest"), ("tall", "short"))
_AWAY = ("away from", "far from", "that is not by", "not next to", "that is not near")
_SHELVES = (0.15, 0.4, 0.65, 1.0)
"""Heights of boards of a shelf, as shares of its own."""
_HUNG = {"picture": (0.7, 0.5), "mirror": (0.6, 0.8), "clock": (0.3, 0.3)}
"""Widths and heights of what hangs on a wall; it is 4 cm deep."""
_WHEREVER = (("on", ("on", "on top of", "lying on")), *3 * (("under", ("under", "underneath", "below")),))
_CLOSE, _APART = 0.45, 1.0
"""Metres between the sides of things that are beside each other in a room, and of those that are not."""
_TRIES = 40


def furnished_scene(rng: np.random.Generator) -> Scene:
    """A room: things on, under and beside pieces of furniture, and things that are nowhere near any."""
    pieces = _pieces(rng)
    kinds = [str(kind) for kind in rng.choice([*_THINGS], size=int(rng.integers(3, 6)), replace=False)]
    placed: list[tuple[Body, Body | None, str]] = []
    for kind in kinds:
        at = int(rng.integers(len(pieces)))  # several of a kind are at one piece
        for k in range(int(rng.integers(2, 6))):
            piece = pieces[at] if k < 2 or rng.random() < 0.3 else pieces[int(rng.integers(len(pieces)))]
            found = _placed(kind, piece, rng)
            if all(found[0].gap(other) > 0.0 or found[2] != how for other, _, how in placed):
                placed.append(found)
    hung = _hung(pieces, rng)
    said = [*_on(placed, rng), *_under(placed, rng), *_beside(placed, pieces, rng)]
    said += [told for _ in range(2) for told in _under(placed, rng)]
    said += [*_whatever(placed, pieces, rng), *_side_by_side(placed, rng), *_away(placed, pieces, rng)]
    said += [*_below_what_hangs(hung, pieces, rng)]
    said += [told for told in _by_size([thing for thing, _, _ in placed]) if rng.random() < 0.3]
    return scene_of([*pieces, *(thing for thing, _ in hung), *(thing for thing, _, _ in placed)], said, rng)


def _pieces(rng: np.random.Generator) -> list[Body]:
    pieces: list[Body] = []
    kinds = rng.choice([*_FURNITURE], size=int(rng.integers(4, 9))).tolist()
    for kind in kinds:
        for _ in range(_TRIES):
            width, depth, height = scaled(_FURNITURE[kind], rng)
            size = (width, depth, height) if rng.random() < 0.5 else (depth, width, height)
            piece = Body(kind, None, (rng.uniform(0.5, 7.0), rng.uniform(-3.5, 3.5), height / 2), size)
            if all(piece.gap(other) > 0.5 for other in pieces):
                pieces.append(piece)
                break
    return pieces


def _placed(kind: str, piece: Body, rng: np.random.Generator) -> tuple[Body, Body | None, str]:
    """A thing somewhere at a piece, or nowhere near it."""
    size = scaled(_THINGS[kind], rng)
    draw = rng.random()
    inside = [max(0.0, (piece.size[k] - size[k]) / 2) for k in (0, 1)]
    x, y = (piece.middle[k] + rng.uniform(-inside[k], inside[k]) for k in (0, 1))
    if kind in _ON_FLOOR and piece.kind in _OPEN_BELOW and draw < 0.3:
        return Body(kind, None, (x, y, size[2] / 2), size), piece, "under"
    if kind not in ("chair", "stool") and draw < 0.75:
        top = piece.middle[2] + piece.size[2] / 2
        if piece.kind == "shelf" and size[2] < 0.25 * piece.size[2]:
            top *= float(rng.choice(_SHELVES))
        return Body(kind, None, (x, y, top + size[2] / 2), size), piece, "on"
    away = rng.uniform(0.05, 0.35)
    side, sign = int(rng.integers(2)), float(rng.choice([-1.0, 1.0]))
    at = [x, y]
    at[side] = piece.middle[side] + sign * ((piece.size[side] + size[side]) / 2 + away)
    return Body(kind, None, (at[0], at[1], size[2] / 2), size), piece, "by"


def _on(placed: Sequence[tuple[Body, Body | None, str]], rng: np.random.Generator) -> Iterator[tuple[str, list[Body]]]:
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


def _by_size(things: Sequence[Body]) -> Iterator[tuple[str, list[Body]]]:
    """The tallest of a kind, and the shortest, where they are so by a tenth."""
    for kind in sorted({thing.kind for thing in things}):
        alike = sorted((thing for thing in things if thing.kind == kind), key=lambda thing: thing.size[2])
        words = _HIGH if len(alike) > 1 else ()
        for most, least in words:
            if alike[-1].size[2] > 1.1 * alike[-2].size[2]:
                yield f"{most} {kind}", alike[-1:]
            if alike[1].size[2] > 1.1 * alike[0].size[2]:
                yield f"{least} {kind}", alike[:1]


def _under(
    placed: Sequence[tuple[Body, Body | None, str]], rng: np.random.Generator
) -> Iterator[tuple[str, list[Body]]]:
    for thing, piece, how in placed:
        alike = [at.kind for other, at, where in placed if other.kind == thing.kind and where == "under" and at]
        if how == "under" and piece is not None and alike.count(piece.kind) == 1:
            yield f"{thing.kind} {rng.choice(('under', 'underneath', 'below'))} the {piece.kind}", [thing]


def _beside(
    placed: Sequence[tuple[Body, Body | None, str]], pieces: Sequence[Body], rng: np.random.Generator
) -> Iterator[tuple[str, list[Body]]]:
    """A thing that is close to the side of a piece, where no other of its kind is anywhere near one of that name."""
    for thing, piece, how in placed:
        if how != "by" or piece is None:
            continue
        named = [other for other in pieces if other.kind == piece.kind]
        others = [other for other, _, _ in placed if other.kind == thing.kind and other is not thing]
        if thing.gap(piece) < _CLOSE and all(other.gap(at) > _APART for other in others for at in named):
            yield f"{thing.kind} {rng.choice(BY)} the {piece.kind}", [thing]


def _whatever(
    placed: Sequence[tuple[Body, Body | None, str]], pieces: Sequence[Body], rng: np.random.Generator
) -> Iterator[tuple[str, list[Body]]]:
    """The one thing, whatever it is, on or under the one piece of a name."""
    for piece in pieces:
        for how, words in _WHEREVER:
            there = [thing for thing, at, where in placed if at is piece and where == how]
            if len(there) == 1 and sum(other.kind == piece.kind for other in pieces) == 1:
                yield f"{rng.choice(THING)} {rng.choice(words)} the {piece.kind}", there


def _side_by_side(
    placed: Sequence[tuple[Body, Body | None, str]], rng: np.random.Generator
) -> Iterator[tuple[str, list[Body]]]:
    """Of two things on one piece the one, by the other, where no other of its kind is anywhere near such a one."""
    on = [(thing, at) for thing, at, how in placed if how == "on"]
    for thing, piece in on:
        for mark, at in on:
            if at is not piece or mark.kind == thing.kind or not thing.gap(mark) < _CLOSE:
                continue
            marks = [other for other, _, _ in placed if other.kind == mark.kind]
            others = [other for other, _, _ in placed if other.kind == thing.kind and other is not thing]
            if others and all(other.gap(one) > _APART for other in others for one in marks):
                yield f"{thing.kind} {rng.choice(BY)} the {mark.kind}", [thing]


def _away(
    placed: Sequence[tuple[Body, Body | None, str]], pieces: Sequence[Body], rng: np.random.Generator
) -> Iterator[tuple[str, list[Body]]]:
    """The only thing of a kind that is not at a piece of some name."""
    for kind in sorted({thing.kind for thing, _, _ in placed}):
        alike = [thing for thing, _, _ in placed if thing.kind == kind]
        for name in sorted({piece.kind for piece in pieces}):
            marks = [piece for piece in pieces if piece.kind == name]
            gaps = [min(thing.gap(mark) for mark in marks) for thing in alike]
            far = [thing for thing, gap in zip(alike, gaps, strict=True) if gap > _APART]
            if len(far) == 1 and len(alike) > 1 and sum(gap < _CLOSE for gap in gaps) == len(alike) - 1:
                yield f"{kind} {rng.choice(_AWAY)} the {name}{'s' * (len(marks) > 1)}", far


def _hung(pieces: Sequence[Body], rng: np.random.Generator) -> list[tuple[Body, Body]]:
    """Things on the wall behind two pieces, and the pieces."""
    kind = str(rng.choice([*_HUNG]))
    width, high = _HUNG[kind]
    found = []
    for piece in pieces[: int(rng.integers(0, 3))]:
        side, sign = int(rng.integers(2)), float(rng.choice([-1.0, 1.0]))
        at = [*piece.middle[:2], rng.uniform(1.3, 1.8)]
        at[side] += sign * piece.size[side] / 2
        size = (0.04, width, high) if side == 0 else (width, 0.04, high)
        found.append((Body(kind, None, (at[0], at[1], at[2]), size), piece))
    return found


def _below_what_hangs(
    hung: Sequence[tuple[Body, Body]], pieces: Sequence[Body], rng: np.random.Generator
) -> Iterator[tuple[str, list[Body]]]:
    """What hangs above a piece, and the piece below it."""
    for thing, piece in hung:
        if sum(other.kind == piece.kind for other in pieces) == 1 and len(hung) > 1:
            yield f"{thing.kind} {rng.choice(('above', 'over'))} the {piece.kind}", [thing]
        if sum(other.kind == piece.kind for other in pieces) > 1 and len(hung) == 1:
            yield f"{piece.kind} {rng.choice(('under', 'below', 'beneath'))} the {thing.kind}", [piece]
