"""Generated lessons on a table with many small things close together, some on others, some in a bowl.

Like the other generated lessons they are definitions by this project and no human data.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence

import numpy as np

from dcg_torch.lessons.arrangements import COLORS, Scene
from dcg_torch.lessons.sized_things import BY, THING, Body, scaled, scene_of

_SMALL = {
    **{"cup": (0.08, 0.08, 0.1), "box": (0.28, 0.28, 0.18), "ball": (0.08, 0.08, 0.08), "cube": (0.09, 0.09, 0.09)},
    **{"bowl": (0.2, 0.2, 0.08), "hammer": (0.28, 0.12, 0.04), "fork": (0.18, 0.03, 0.02), "can": (0.07, 0.07, 0.11)},
    **{"bottle": (0.07, 0.07, 0.25), "plate": (0.24, 0.24, 0.03), "jar": (0.1, 0.1, 0.14), "book": (0.2, 0.15, 0.04)},
}
_RARE = 3
"""How often what can seldom be said counts among what could be said."""


def table_top_scene(rng: np.random.Generator) -> Scene:
    """A table with many small things close together, some of them on others, and things that are elsewhere."""
    table = Body("table", None, (1.3, 0.0, 0.375), (1.1, 2.0, 0.75))
    kinds = [str(kind) for kind in rng.choice([*_SMALL], size=int(rng.integers(3, 5)), replace=False)]
    kinds += ["bowl"] if rng.random() < 0.5 else []
    top: list[Body] = []
    for _ in range(int(rng.integers(7, 14))):
        kind = kinds[int(rng.integers(len(kinds)))]
        size = scaled(_SMALL[kind], rng)
        reach = [(table.size[k] - size[k]) / 2 for k in (0, 1)]
        x, y = table.middle[0] + rng.uniform(-reach[0], reach[0]), rng.uniform(-reach[1], reach[1])
        thing = Body(kind, str(rng.choice(COLORS)), (x, y, 0.75 + size[2] / 2), size)
        if all(thing.gap(other) > 0.02 for other in top):
            top.append(thing)
    stacked: list[tuple[Body, Body]] = []
    for below in top[:2]:
        kind = str(rng.choice(["cup", "cube", "ball", "can"]))
        size = _SMALL[kind]
        if below.size[0] > size[0] * 0.9 and below.size[1] > size[1] * 0.9:
            height = below.middle[2] + (below.size[2] + size[2]) / 2
            stacked.append((Body(kind, str(rng.choice(COLORS)), (*below.middle[:2], height), size), below))
    inside = [pair for below in top[2:] if below.kind == "bowl" for pair in _in_it(below, rng)]
    things = [*top, *(thing for thing, _ in stacked), *(thing for thing, _ in inside)]
    floor = [
        Body("stool", None, (0.2, 1.5, 0.3), (0.35, 0.35, 0.6)),
        Body("shelf", None, (2.5, 0.5, 1), (0.4, 1.6, 2)),
    ]
    said = [*_close(top, rng), *_stacked(stacked, things, rng), *_RARE * [*_inside(inside, things, rng)]]
    return scene_of([table, *floor, *things], said, rng)


def _close(top: Sequence[Body], rng: np.random.Generator) -> Iterator[tuple[str, list[Body]]]:
    """Of the small things of a kind the one that is close to another thing."""
    for mark in top:
        if sum(other.name == mark.name for other in top) > 1:
            continue
        for kind in sorted({thing.kind for thing in top} - {mark.kind}):
            gaps = sorted((thing.gap(mark), k) for k, thing in enumerate(top) if thing.kind == kind)
            if len(gaps) > 1 and gaps[0][0] < 0.2 and gaps[1][0] > max(0.3, 2.5 * gaps[0][0]):
                yield f"{kind} {rng.choice(BY)} the {mark.name}", [top[gaps[0][1]]]


def _stacked(
    stacked: Sequence[tuple[Body, Body]], things: Sequence[Body], rng: np.random.Generator
) -> Iterator[tuple[str, list[Body]]]:
    for thing, below in stacked:
        unique = sum(other.name == below.name for other in things) == 1
        if unique and sum(other.kind == thing.kind for other in things) > 1:
            yield f"{thing.kind} {rng.choice(('on', 'on top of'))} the {below.name}", [thing]


def _in_it(bowl: Body, rng: np.random.Generator) -> Iterator[tuple[Body, Body]]:
    """Something small that lies in a bowl."""
    kind = str(rng.choice(["ball", "cube", "fork", "can"]))
    size = _SMALL[kind]
    foot = bowl.middle[2] - bowl.size[2] / 2 + 0.02
    yield Body(kind, str(rng.choice(COLORS)), (*bowl.middle[:2], foot + size[2] / 2), size), bowl


def _inside(
    inside: Sequence[tuple[Body, Body]], things: Sequence[Body], rng: np.random.Generator
) -> Iterator[tuple[str, list[Body]]]:
    """What lies in a bowl, by its kind where there are others, or as a thing."""
    for thing, bowl in inside:
        if sum(other.name == bowl.name for other in things) == 1:
            kind = thing.kind if sum(other.kind == thing.kind for other in things) > 1 else str(rng.choice(THING))
            word = rng.choice(("in", "in", "inside", "that is in"))
            yield f"{rng.choice((kind, str(rng.choice(THING))))} {word} the {bowl.name}", [thing]
