"""Generated lessons on groups: uneven rows across and along, clusters, told apart by number, side and lie; and picks
from one of them ("the third cube from the left in the row of seven cubes").

Definitions by this project, no human data.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np

from dcg_torch.lessons.arrangements import KINDS, Scene, Told
from dcg_torch.lessons.selections import NUMBERS, ORDINALS, thing
from dcg_torch.types import Percept, Pose

_SITES = {
    "front": (6.0, 0.0),
    "left": (0.5, 11.0),
    "right": (0.5, -11.0),
    "far left": (15.0, 10.0),
    "far right": (15.0, -10.0),
}
"""Where a formation's middle is, metres; the robot stands at the origin."""
_SIDES = {
    "front": ("in front of the robot", "in front of you"),
    "left": ("on the left", "on your left", "to the left of the robot", "on the left side of the robot"),
    "right": ("on the right", "on your right", "to the right of you", "at the right side of the robot"),
}
_LIE = {"across": ("horizontal row", "horizontal line"), "along": ("vertical column", "vertical line", "column")}
_ROW, _CLUSTER = ("row", "line"), ("group", "cluster", "bunch")


@dataclass(frozen=True)
class _Formation:
    """Things of one kind that stand together; a row's from the left, or from the nearest."""

    site: str
    shape: str
    things: tuple[Percept, ...]

    @property
    def ids(self) -> tuple[str, ...]:
        """Of its things, in their order."""
        return tuple(o.id for o in self.things)


def formation_scene(rng: np.random.Generator) -> Scene:
    """Two or three formations of one kind, and single things of another."""
    kind, other = map(str, rng.permutation(KINDS)[:2])
    sites = rng.permutation(list(_SITES))[: int(rng.integers(2, 4))].tolist()
    found = [_formation(kind, site, rng) for site in sites]
    singles = [
        thing(f"other {k}", other, rng, (float(rng.uniform(2.0, 9.0)), float(rng.uniform(-2.0, 2.0)))) for k in range(2)
    ]
    said = [told for one in found for told in _about(kind, one, found, rng)]
    objects = (*(o for one in found for o in one.things), *singles)
    return Scene(tuple(rng.permutation(np.array(objects, dtype=object))), Pose(0.0, 0.0), None, tuple(said))


def _formation(kind: str, site: str, rng: np.random.Generator) -> _Formation:
    shape = str(rng.choice(["across", "along", "cluster"]))
    number, step = int(rng.integers(3, 8)), float(rng.uniform(0.8, 1.1))
    middle = np.array(_SITES[site]) + rng.uniform(-0.4, 0.4, 2)
    if shape == "cluster":
        angles = math.tau * np.arange(number) / number + rng.uniform(0.0, 1.0)
        points = middle + 0.9 * step * np.column_stack([np.cos(angles), np.sin(angles)]) * max(1.0, number / 5)
    else:
        reach = np.concatenate([[0.0], np.cumsum(step * rng.uniform(0.7, 1.5, number - 1))])
        way = np.array([0.0, -1.0]) if shape == "across" else np.array([1.0, 0.0])
        aside = way[::-1] * rng.uniform(-0.06, 0.06, (number, 1))
        points = middle + (reach - reach[-1] / 2)[:, None] * way + aside
    named = [thing(f"{site} {k}", kind, rng, (float(x), float(y))) for k, (x, y) in enumerate(points)]
    return _Formation(site, shape, tuple(named))


def _about(kind: str, one: _Formation, found: Sequence[_Formation], rng: np.random.Generator) -> Iterator[Told]:
    """What is true of one formation alone, as a whole and of its members."""
    words = [str(rng.choice(_CLUSTER if one.shape == "cluster" else _ROW))]
    rivals = [o for o in found if o is not one and (o.shape == "cluster") == (one.shape == "cluster")]
    names: list[str] = []
    if not rivals:
        names += [f"{words[0]} of {kind}s", f"{words[0]} of {NUMBERS[len(one.things)]} {kind}s"]
    if all(len(o.things) != len(one.things) for o in rivals):
        names.append(f"{words[0]} of {NUMBERS[len(one.things)]} {kind}s")
    if one.shape != "cluster" and all(o.shape != one.shape for o in rivals):
        names += [f"{lie} of {kind}s" for lie in _LIE[one.shape]]
    if one.site in _SIDES and not any(one.site in o.site for o in rivals):
        where = str(rng.choice(_SIDES[one.site]))
        names += [f"{words[0]} of {kind}s {where}", f"{words[0]} of {NUMBERS[len(one.things)]} {kind}s {where}"]
    for name in names:
        yield f"go to the {name}", frozenset(one.ids)
        if one.shape != "cluster":
            yield from _picks(kind, name, one)


def _picks(kind: str, name: str, row: _Formation) -> Iterator[Told]:
    """Ways to pick from a row."""
    ids = row.ids
    if len(ids) % 2:
        yield f"go to the middle {kind} in the {name}", frozenset({ids[len(ids) // 2]})
    if row.shape == "along":
        for near, far in (("nearest", "farthest"), ("closest", "furthest")):
            yield f"go to the {near} {kind} in the {name}", frozenset({ids[0]})
            yield f"go to the {far} {kind} in the {name}", frozenset({ids[-1]})
        yield f"go to the two {kind}s nearest you in the {name}", frozenset(ids[:2])
        return
    for side, order in (("left", ids), ("right", ids[::-1])):
        yield f"go to the {side}most {kind} in the {name}", frozenset({order[0]})
        yield f"go to the {kind} farthest to the {side} in the {name}", frozenset({order[0]})
        yield f"go to the {side} {kind} in the {name}", frozenset({order[0]})
        for k, ordinal in enumerate(ORDINALS[: len(order)]):
            yield f"go to the {ordinal} {kind} from the {side} in the {name}", frozenset({order[k]})
