"""Generated lessons on how tall and how high things are, and on what stands by itself.

"Tall" is said of extents, "high" of where a thing is, and who stands apart has no other near. Definitions by this
project, no human data.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence

import numpy as np

from dcg_torch.lessons.arrangements import COLORS, KINDS, Scene, Told
from dcg_torch.lessons.selections import ORDINALS
from dcg_torch.types import Percept, Pose
from dcg_torch.types.arrays import Floats

_TALL = (("tallest", "shortest"), ("tall", "short"), ("taller", "shorter"))
_HIGH = (("highest", "lowest"), ("higher", "lower"), ("high", "low"))
_ALONE = ("by itself", "on its own", "that is alone", "all by itself")
_HUNG, _RANKED = 0.65, 0.5
"""Shares of scenes with shelves and walls, and of those in which the highest is told and nothing is counted."""
_LEVEL = 0.15
"""Metres by which things differ that are counted from the top."""
_CLEAR = 1.25
"""The next one is so many times as tall or as near at most."""


def height_scene(rng: np.random.Generator) -> Scene:
    """Things of two kinds, of several heights and widths."""
    objects = _scattered(rng)
    heights, widths = rng.permutation(np.geomspace(0.2, 2.5, len(objects))), rng.uniform(0.2, 1.0, len(objects))
    sized = [
        Percept(o.id, o.type, o.color, o.position, (float(w), float(w), float(h)))
        for o, h, w in zip(objects, heights, widths, strict=True)
    ]
    return Scene(tuple(sized), Pose(0.0, 0.0), None, tuple(_ranked(sized, _TALL, lambda o: o.size[2] if o.size else 0)))


def shelf_scene(rng: np.random.Generator) -> Scene:
    """Things at several heights, as on shelves and walls; or all on one level, as in a picture seen from above.

    There the top is what is farthest away.
    """
    objects = _scattered(rng)
    up = 0
    if rng.random() < _HUNG:
        up = 2
        heights = rng.permutation(np.linspace(0.0, 2.2, len(objects))).tolist()
        objects = [Percept(o.id, o.type, o.color, (*o.position[:2], z)) for o, z in zip(objects, heights, strict=True)]
    ranked = rng.random() < _RANKED
    said = _ranked(objects, _HIGH, lambda o: o.position[up] + 1.0)
    said = said if ranked else _from_ends(objects, lambda o: o.position[up])
    return Scene(tuple(objects), Pose(0.0, 0.0), None, tuple(said))


def lonely_scene(rng: np.random.Generator) -> Scene:
    """A clump of things, and one or some that stand apart from it."""
    kind, other = map(str, rng.permutation(KINDS)[:2])
    center = rng.uniform((2.0, -2.0), (5.0, 2.0))
    number = int(rng.integers(3, 7))
    turns = rng.uniform(0.0, 2.0 * np.pi) + np.linspace(0.0, 2.0 * np.pi, number, endpoint=False)
    clump = center + 0.6 * np.column_stack([np.cos(turns), np.sin(turns)]) + rng.uniform(-0.15, 0.15, (number, 2))
    away = rng.uniform(0.0, 2.0 * np.pi)
    far = center + rng.uniform(2.0, 3.5) * np.array([np.cos(away), np.sin(away)])
    points = [*clump, far]
    objects = [_percept(k, kind if k == number or rng.random() < 0.8 else other, rng, p) for k, p in enumerate(points)]
    said = [(f"go to the {kind} {text}", frozenset({objects[-1].id})) for text in _ALONE]
    said += [(f"go to the {word} {kind}", frozenset({objects[-1].id})) for word in ("lonely", "isolated")]
    return Scene(tuple(objects), Pose(0.0, 0.0), None, tuple(said))


def _scattered(rng: np.random.Generator) -> list[Percept]:
    kind, other = map(str, rng.permutation(KINDS)[:2])
    points = rng.uniform((1.5, -4.0), (7.0, 4.0), (int(rng.integers(4, 9)), 2))
    return [_percept(k, kind if k < 3 or rng.random() < 0.6 else other, rng, p) for k, p in enumerate(points)]


def _percept(number: int, kind: str, rng: np.random.Generator, at: Floats) -> Percept:
    return Percept(f"o{number}", kind, str(rng.choice(COLORS)), (float(at[0]), float(at[1]), 0.0))


def _from_ends(objects: Sequence[Percept], value: Callable[[Percept], float]) -> Iterator[Told]:
    """What is counted from the top and from the bottom."""
    for kind in dict.fromkeys(o.type for o in objects):
        up = sorted((o for o in objects if o.type == kind), key=value)
        if len(up) < 2 or min(np.diff([value(o) for o in up])) < _LEVEL:
            continue
        for k, ordinal in enumerate(ORDINALS[: len(up)]):
            yield f"go to the {ordinal} {kind} from the top", frozenset({up[-1 - k].id})
            yield f"go to the {ordinal} {kind} from the bottom", frozenset({up[k].id})


def _ranked(
    objects: Sequence[Percept], words: Sequence[tuple[str, str]], value: Callable[[Percept], float]
) -> Iterator[Told]:
    """What has the most and the least of something among those of a kind, and of a kind and colour."""
    for head in dict.fromkeys(text for o in objects for text in (o.type, f"{o.color} {o.type}")):
        alike = sorted((o for o in objects if head in (o.type, f"{o.color} {o.type}")), key=value)
        if len(alike) < 2:
            continue
        for most, least in words:
            if value(alike[-1]) > _CLEAR * value(alike[-2]):
                yield f"go to the {most} {head}", frozenset({alike[-1].id})
            if value(alike[1]) > _CLEAR * value(alike[0]):
                yield f"go to the {least} {head}", frozenset({alike[0].id})
