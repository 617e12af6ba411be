"""Generated lessons on what a hand can do: it takes what nothing lies on, and puts down what it holds.

So of two red cubes "take the red cube" means the upper one, and "drop the red cube" the one that is held. Definitions
by this project, no human data.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence

import numpy as np

from dcg_torch.lessons.arrangements import COLORS, KINDS, SEAT, TABLE, Scene, Told
from dcg_torch.types import Percept

_TAKING = ("take", "pick up", "grab", "get", "lift", "move", "remove", "pick")
_PUTTING = ("put down", "drop", "release", "place", "put", "set down")
_BETWEEN = ("place", "put", "move")
"""Said of what is to be taken first, and of what is held already."""
_HIGH = 7.0  # metres: where a thing is held


def stack_scene(rng: np.random.Generator) -> Scene:
    """Stacks on a table, perhaps a thing in the hand, and what could be said of things of which there are several."""
    colors = COLORS[: int(rng.integers(2, 4))]
    objects: list[Percept] = []
    for field in rng.permutation(64)[: int(rng.integers(3, 7))].tolist():
        for z in range(int(rng.integers(1, 5))):
            kind = str(rng.choice(KINDS[:2])) if z else KINDS[0]
            objects.append(_percept(len(objects), kind, str(rng.choice(colors)), field, float(z)))
    if rng.random() < 0.6:
        kind, field = str(rng.choice(KINDS[:2])), int(rng.integers(64))
        objects.append(_percept(len(objects), kind, str(rng.choice(colors)), field, _HIGH, held=True))
    return Scene(tuple(objects), SEAT, TABLE, tuple(_said(objects, rng)))


def _percept(number: int, kind: str, color: str, field: int, z: float, *, held: bool = False) -> Percept:
    where = (float(field // 8), float(field % 8), z)
    return Percept(f"o{number}", kind, color, where, attributes=frozenset({"held"} if held else ()))


def _said(objects: Sequence[Percept], rng: np.random.Generator) -> Iterator[Told]:
    """Of each kind and colour of which there are several: which one can be taken, or is held."""
    held = next((o for o in objects if o.attributes), None)
    other = objects[int(rng.integers(len(objects)))]
    for kind, color in dict.fromkeys((o.type, o.color) for o in objects):
        alike = [o for o in objects if (o.type, o.color) == (kind, color)]
        free = [o for o in alike if o is not held and not _covered(o, objects)]
        head = f"{color} {kind}"
        if len(alike) < 2:
            continue
        if len(free) == 1:
            yield f"{rng.choice(_TAKING)} the {head}", frozenset({free[0].id})
            if held is None and (other.type, other.color) != (kind, color):
                goal = f"on the {other.color} {other.type}"
                yield f"{rng.choice(_BETWEEN)} the {head} {goal}", frozenset({free[0].id})
        if held in alike:
            yield f"{rng.choice(_PUTTING)} the {head}", frozenset({o.id for o in alike if o is held})
            if (other.type, other.color) != (kind, color):
                goal = f"on the {other.color} {other.type}"
                yield f"{rng.choice(_BETWEEN)} the {head} {goal}", frozenset({o.id for o in alike if o is held})


def _covered(one: Percept, objects: Sequence[Percept]) -> bool:
    x, y, z = one.position
    return any(o.position == (x, y, z + 1.0) for o in objects)
