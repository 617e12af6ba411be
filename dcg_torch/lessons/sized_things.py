"""Things that say how large they are, and the scenes that they make: what lessons in rooms and on tables share."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from dcg_torch.lessons.arrangements import Scene, Told
from dcg_torch.scene.workspace import Workspace
from dcg_torch.types import Percept, Pose

_BEGIN = ("take the", "pick up the", "the", "find the", "bring me the", "choose the", "go to the", "get the")
BY = ("next to", "beside", "by", "near", "close to")
THING = ("thing", "object", "thing", "item")
"""Ways to say that a thing is meant, that it is beside another, and whatever it is."""


@dataclass(frozen=True)
class Body:
    """A thing, its middle and its extents."""

    kind: str
    color: str | None
    middle: tuple[float, float, float]
    size: tuple[float, float, float]

    def gap(self, other: Body) -> float:
        """Metres between the footprints, 0 where they share floor."""
        apart = [abs(self.middle[k] - other.middle[k]) - (self.size[k] + other.size[k]) / 2 for k in (0, 1)]
        return math.hypot(max(0.0, apart[0]), max(0.0, apart[1]))

    @property
    def name(self) -> str:
        """What it is called, its colour first."""
        return f"{self.color} {self.kind}" if self.color else self.kind


def scaled(size: Sequence[float], rng: np.random.Generator) -> tuple[float, float, float]:
    """Extents that differ a little, height and floor each by itself."""
    by, high = rng.uniform(0.85, 1.15), rng.uniform(0.85, 1.15)
    return (by * size[0], by * size[1], by * high * size[2])


def scene_of(bodies: Sequence[Body], said: Sequence[tuple[str, list[Body]]], rng: np.random.Generator) -> Scene:
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
    return Scene(tuple(percepts), Pose(0.0, 0.0), Workspace.of(percepts), tuple(told))
