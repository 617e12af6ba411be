"""Generated lessons on the middle of a table: which of several things lies there. Definitions by this project, no human
data.

A thing is said to be in the middle where it lies near it and all others of its kind lie clearly farther off, on any
side: other lessons have so few middles that the side on which a thing lies would by chance say as much as how far off.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence

import numpy as np

from dcg_torch.lessons.arranged import COLORS, KINDS, Scene, Told
from dcg_torch.scene.places import scene_bounds
from dcg_torch.scene.workspace import Workspace
from dcg_torch.types import Percept, Pose

_NEAR = 0.3
"""Share of the way to the nearest edge within which a thing is in the middle."""
_CLEARER = 1.6
"""How many times as far off the next one is at least."""
_APART = 0.5
"""Metres at least between two things."""
_VERBS = ("take", "pick up", "grab", "go to")
_WHERE = (
    *("in the middle", "in the center", "in the middle of the table", "in the center of the table"),
    *("closest to the middle", "closest to the center of the table", "near the middle", "near the center of the table"),
)


def middle_scene(rng: np.random.Generator) -> Scene:
    """Six to fifteen things of one or two kinds on a table, the robot at its near edge."""
    deep, wide = float(rng.uniform(4.0, 8.0)), float(rng.uniform(4.0, 9.0))
    kinds = rng.permutation(KINDS)[: int(rng.integers(1, 3))]
    colors = rng.permutation(COLORS)[: int(rng.integers(1, 4))]
    points = _points(rng, int(rng.integers(6, 16)), (deep, wide))
    things = [
        Percept(f"o{k}", str(rng.choice(kinds)), str(rng.choice(colors)), (x, y, 0.0))
        for k, (x, y) in enumerate(points)
    ]
    unit = float(np.median([min(math.dist(p, q) for q in points if q is not p) for p in points]))
    seat = Pose(-float(rng.uniform(0.5, 2.0)), 0.0)
    table = Workspace(scene_bounds([(0.0, -wide / 2), (deep, wide / 2)], seat), unit)
    said = tuple(_in_the_middle(things, (deep, wide), str(rng.choice(_VERBS))))
    return Scene(tuple(things), seat, table, said)


def _in_the_middle(things: Sequence[Percept], size: tuple[float, float], verb: str) -> Iterator[Told]:
    """All ways to tell of a kind, and of a kind and colour, which one is in the middle."""
    heads = {f"{o.color} {o.type}": (o.type, o.color) for o in things} | {o.type: (o.type, None) for o in things}
    for head, (type_, color) in heads.items():
        alike = [o for o in things if o.type == type_ and color in (None, o.color)]
        off = sorted((math.dist(o.position[:2], (size[0] / 2, 0.0)), o.id) for o in alike)
        if len(off) < 2 or off[0][0] > _NEAR * min(size) / 2 or off[1][0] < _CLEARER * off[0][0] + _APART:
            continue
        yield from ((f"{verb} the {head} {where}", frozenset({off[0][1]})) for where in _WHERE)


def _points(rng: np.random.Generator, number: int, size: tuple[float, float]) -> list[tuple[float, float]]:
    """Places on a table that are apart; the first near its middle."""
    found = [(size[0] / 2 + float(rng.uniform(-0.5, 0.5)), float(rng.uniform(-0.5, 0.5)))]
    while len(found) < number:
        point = float(rng.uniform(0.0, size[0])), float(rng.uniform(-size[1] / 2, size[1] / 2))
        if all(math.dist(point, other) > _APART for other in found):
            found.append(point)
    return found
