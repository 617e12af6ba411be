"""Generated lessons on a cluttered table: things of a few colours that stand at uneven distances, told apart by what is
next to them, before and behind them, above and below them as who looks down on the table says it.

Definitions by this project, no human data. A description is given where it fits one thing and no other nearly.
"""

from __future__ import annotations

import itertools
import math
from collections.abc import Callable, Iterator, Sequence

import numpy as np

from dcg_torch.lessons.arrangements import COLORS, KINDS, Scene, Told
from dcg_torch.lessons.selections import NUMBERS, ORDINALS, thing
from dcg_torch.scene.places import scene_bounds
from dcg_torch.scene.workspace import Workspace
from dcg_torch.types import Percept, Pose

_SEAT = Pose(-4.0, 0.0)
_TABLE = Workspace(scene_bounds([(0.0, -3.5), (7.0, 3.5)], _SEAT))
_LEAST, _TRIES = 0.65, 400
"""How far things are apart at least, units; how often a place is looked for."""
_ASKED = 6
"""Things of a scene of which something is said."""
_TOUCHING, _NEXT, _NEAR = 1.1, 1.5, 2.6
"""How far things are that touch, stand next to one another, are before one another."""
_CLEAR = 1.35
"""The next one that a description could mean is so many times as far."""
_WAYS = {
    "behind": (1.0, 0.0),
    "in front of": (-1.0, 0.0),
    "above": (1.0, 0.0),
    "below": (-1.0, 0.0),
    "left of": (0.0, 1.0),
    "right of": (0.0, -1.0),
}
"""On a table that is seen from one side "above" is farther away, where nothing stands on anything."""
_SAID = {
    "behind": ("behind", "directly behind", "just behind", "beyond"),
    "in front of": ("in front of", "directly in front of", "just in front of", "right before"),
    "above": ("above", "directly above", "just above", "over"),
    "below": ("below", "directly below", "under", "underneath"),
    "left of": ("to the left of", "left of", "immediately to the left of"),
    "right of": ("to the right of", "right of", "directly to the right of"),
}
_BESIDE = ("next to", "right next to", "beside", "by", "near", "close to")
_TOUCH = ("touching", "that touches", "that is touching", "in contact with", "adjacent to")
_AHEAD, _ASIDE = math.radians(35), math.radians(60)
"""How far off its way a thing may be that is "behind"; how far off others may not be."""


def clutter_scene(rng: np.random.Generator) -> Scene:
    """Things of one kind, and perhaps of another, scattered over a table."""
    kind, other = map(str, rng.permutation(KINDS)[:2])
    share = float(rng.choice([0.0, 0.0, 0.3]))
    points: list[np.ndarray[tuple[int], np.dtype[np.float64]]] = []
    wanted = int(rng.integers(9, 17))
    for _ in range(_TRIES):
        at = np.array([rng.uniform(0.0, 7.0), rng.uniform(-3.5, 3.5)])
        if points and rng.random() < 0.6:  # things stand in clumps
            turn, away = rng.uniform(0.0, math.tau), rng.uniform(_LEAST, 1.3)
            at = points[int(rng.integers(len(points)))] + away * np.array([math.cos(turn), math.sin(turn)])
        if all(np.hypot(*(at - p)) >= _LEAST for p in points):
            points.append(at)
        if len(points) == wanted:
            break
    objects = [
        thing(f"o{k}", other if rng.random() < share else kind, rng, (float(p[0]), float(p[1])))
        for k, p in enumerate(points)
    ]
    some = [objects[k] for k in rng.permutation(len(objects))[:_ASKED].tolist()]
    said = [told for one in some for told in _about(one, objects, rng)]
    said += 2 * list(_middles(kind, objects, rng))
    rng.shuffle(said)
    return Scene(tuple(objects), _SEAT, _TABLE, tuple(said))


def _about(one: Percept, objects: Sequence[Percept], rng: np.random.Generator) -> Iterator[Told]:
    """What tells a thing apart from those of its kind and colour."""
    alike = [o for o in objects if _name(o) == _name(one)]
    if len(alike) < 2:
        return
    head, only = f"go to the {_name(one)}", frozenset({one.id})
    for mark, text, near in _marks(objects, one):
        others = [o for o in alike if o.id != mark.id]
        if others and _first(one, others, lambda o, mark=mark: _apart(o, mark)):  # type: ignore[misc]
            if _apart(one, mark) < _TOUCHING and near:
                yield f"{head} {rng.choice(_TOUCH)} {text}", only
            if _apart(one, mark) < _NEXT:
                yield f"{head} {rng.choice(_BESIDE)} {text}", only
        for way in rng.permutation(list(_WAYS))[:2].tolist():
            if _is_there(one, mark, way, _AHEAD) and not any(
                _is_there(o, mark, way, _ASIDE) and _apart(o, mark) < _CLEAR * _apart(one, mark)
                for o in alike
                if o is not one
            ):
                yield f"{head} {rng.choice(_SAID[way])} {text}", only
    yield from _by_two(one, alike, objects, head, rng)
    yield from _ranked(one, alike, head, rng)


def _by_two(
    one: Percept, alike: Sequence[Percept], objects: Sequence[Percept], head: str, rng: np.random.Generator
) -> Iterator[Told]:
    """What stands so to two things of a name, or to two of different names, and no other of its name does."""
    only, others = frozenset({one.id}), [o for o in alike if o is not one]
    names = [name for name in dict.fromkeys(map(_name, objects)) if name != _name(one)]

    def marks(o: Percept, name: str, fits: Callable[[Percept, Percept], bool]) -> int:
        return sum(fits(o, mark) for mark in objects if mark is not o and _name(mark) == name)

    def near(o: Percept, mark: Percept) -> bool:
        return _apart(o, mark) < (_NEXT if o is one else _CLEAR * _NEXT)

    for name in names:
        if marks(one, name, near) >= 2 and all(marks(o, name, near) < 2 for o in others):
            yield f"{head} {rng.choice(_BESIDE + _TOUCH[:2])} two {name}s", only
        for way in _WAYS:

            def there(o: Percept, mark: Percept, way: str = way) -> bool:
                return _is_there(o, mark, way, _AHEAD if o is one else _ASIDE, 2.0 * _NEAR)

            if marks(one, name, there) >= 2 and all(marks(o, name, there) < 2 for o in others):
                number = "the two" if sum(_name(o) == name for o in objects) == 2 else "two"
                yield f"{head} {rng.choice(_SAID[way])} {number} {name}s", only
    for first, second in itertools.pairwise(names):
        both = [o for o in alike if marks(o, first, near) and marks(o, second, near)]
        if both == [one]:
            yield f"{head} {rng.choice(_BESIDE + _TOUCH[:2])} a {first} and a {second}", only


def _marks(objects: Sequence[Percept], one: Percept) -> Iterator[tuple[Percept, str, bool]]:
    """What a thing can be told by: the single thing of a name, or the nearest, the leftmost ... of several."""
    for name in dict.fromkeys(map(_name, objects)):
        of_name = [o for o in objects if _name(o) == name]
        others = [o for o in of_name if o is not one]
        if name != _name(one) and others:
            mark = min(others, key=lambda o: _apart(o, one))
            yield mark, f"the {name}" if len(of_name) == 1 else f"a {name}", True
        for words, value in _ENDS.items():
            if len(of_name) > 1:
                mark = min(of_name, key=value)
                if mark is not one and _first(mark, of_name, lambda o, value=value: 5.0 + value(o), 0.4):  # type: ignore[misc]
                    yield mark, f"the {words.format(name)}", False


_ENDS: dict[str, Callable[[Percept], float]] = {
    "{} closest to you": lambda o: math.dist(o.position[:2], (_SEAT.x, _SEAT.y)),
    "{} farthest from you": lambda o: -math.dist(o.position[:2], (_SEAT.x, _SEAT.y)),
    "leftmost {}": lambda o: -o.position[1],
    "rightmost {}": lambda o: o.position[1],
}


def _ranked(one: Percept, alike: Sequence[Percept], head: str, rng: np.random.Generator) -> Iterator[Told]:
    """How near it is to who looks, of all of its name and of those on its side."""
    only, name = frozenset({one.id}), _name(one)
    half = [o for o in alike if o.position[1] * one.position[1] > 0.0 and abs(o.position[1]) > 0.8]
    side = "left" if one.position[1] > 0.0 else "right"
    where = str(rng.choice((f"on the {side}", f"on your {side}", f"on the {side} side of the table")))
    for among, place in ((alike, ""), (half, f" {where}")):
        order = sorted(among, key=_ENDS["{} closest to you"])
        if one not in order or len(order) < 2 or not _clear_in(order, one):
            continue
        k = order.index(one)
        if k == 0:
            yield f"{head} closest to you{place}", only
            yield f"go to the nearest {name}{place}", only
        if k == len(order) - 1:
            yield f"{head} farthest from you{place}", only
        if 0 < k < 4:
            yield f"go to the {ORDINALS[k]} closest {name} to you{place}", only
            yield f"go to the {ORDINALS[k]} closest {name}{place}", only
            yield f"{head}{place} that is {ORDINALS[k]} closest to you", only


def _middles(kind: str, objects: Sequence[Percept], rng: np.random.Generator) -> Iterator[Told]:
    """The one in the middle of so many that are on one side, or that all are."""
    for color in COLORS:
        alike = [o for o in objects if _name(o) == f"{color} {kind}"]
        for side, way in (("", 0.0), ("left", 1.0), ("right", -1.0)):
            several = [o for o in alike if not way or o.position[1] * way > 0.0]
            if not 3 <= len(several) < 8 or (way and len(several) == len(alike)):
                continue
            middle = np.array([o.position[:2] for o in several]).mean(axis=0)
            order = sorted(several, key=lambda o: math.dist(o.position[:2], middle))
            off = [math.dist(o.position[:2], middle) for o in order[:2]]
            if off[1] < off[0] + 0.5:
                continue
            number, only = NUMBERS[len(several)], frozenset({order[0].id})
            where = "" if not side else f" {rng.choice(('on', 'on', 'to'))} your {side}"
            yield f"go to the {color} {kind} in the middle of the {number} {color} {kind}s{where}", only
            yield f"there are {number} {color} {kind}s{where} . go to the one in the middle", only
            yield f"of the {number} {color} {kind}s{where} , go to the middle one", only


def _clear_in(order: Sequence[Percept], one: Percept) -> bool:
    value = [_ENDS["{} closest to you"](o) for o in order]
    k = order.index(one)
    return all(abs(value[k] - value[j]) > 0.25 for j in (k - 1, k + 1) if 0 <= j < len(value))


def _first(
    one: Percept, others: Sequence[Percept], value: Callable[[Percept], float], margin: float | None = None
) -> bool:
    """Is it the one of least value, and clearly so?"""
    rest = [value(o) for o in others if o is not one]
    own = value(one)
    return all(v >= (_CLEAR * own if margin is None else own + margin) for v in rest)


def _is_there(one: Percept, mark: Percept, way: str, slack: float, reach: float = _NEAR) -> bool:
    """Is it that way from the landmark, and near?"""
    x, y = one.position[0] - mark.position[0], one.position[1] - mark.position[1]
    away = math.hypot(x, y)
    along = (x * _WAYS[way][0] + y * _WAYS[way][1]) / max(away, 1e-9)
    return 0.0 < away < reach and along > math.cos(slack)


def _apart(one: Percept, other: Percept) -> float:
    return math.dist(one.position[:2], other.position[:2])


def _name(one: Percept) -> str:
    return f"{one.color} {one.type}"
