"""What a type of object looks like, before it has a colour and a place; and the registry of types."""

from __future__ import annotations

import functools
from collections.abc import Callable
from dataclasses import dataclass
from typing import Final

import numpy as np

from dcg_torch.simulator.bodies.meshes import Mesh, merged

RGB = tuple[float, float, float]

WHITE: Final[RGB] = (0.96, 0.96, 0.96)
LIGHT_GRAY: Final[RGB] = (0.75, 0.76, 0.78)
GRAY: Final[RGB] = (0.5, 0.51, 0.53)
DARK_GRAY: Final[RGB] = (0.24, 0.25, 0.27)
BLACK: Final[RGB] = (0.1, 0.1, 0.11)


@dataclass(frozen=True, slots=True, eq=False)
class Part:
    """A mesh and its paint: None is the colour that the object is said to have."""

    mesh: Mesh
    paint: RGB | None = None


@dataclass(frozen=True, slots=True, eq=False)
class Model:
    """A type's looks: parts in the object's frame, foot on z = 0, front along +x.

    `round_hull` chooses the collision shape: an upright cylinder around everything, or the bounding box.
    """

    parts: tuple[Part, ...]
    round_hull: bool = False

    @property
    @functools.cache  # noqa: B019 - models are few, and kept anyway
    def bounds(self) -> tuple[np.ndarray, np.ndarray]:
        """Lowest and highest corner of the bounding box, (3,) each, in metres."""
        vertices = np.concatenate([part.mesh.vertices for part in self.parts])
        return vertices.min(axis=0), vertices.max(axis=0)

    @property
    @functools.cache  # noqa: B019
    def radius(self) -> float:
        """The radius in metres of the smallest upright cylinder about the foot that holds every part."""
        return float(max(np.hypot(*part.mesh.vertices[:, :2].T).max() for part in self.parts))

    def by_paint(self) -> list[Part]:
        """The parts with all meshes of one paint merged, the stated colour first."""
        paints = [None, *dict.fromkeys(part.paint for part in self.parts if part.paint is not None)]
        groups = [([part.mesh for part in self.parts if part.paint == paint], paint) for paint in paints]
        return [Part(merged(meshes), paint) for meshes, paint in groups if meshes]


Builder = Callable[[], Model]
_BUILDERS: dict[str, Builder] = {}


def register(type: str) -> Callable[[Builder], Builder]:
    """Decorator: the function builds the looks of this type, a natural noun such as "fire hydrant".

    The builder runs once, when the type is first used.

    Raises:
        ValueError: the type is registered already.
    """

    def add(builder: Builder) -> Builder:
        if type in _BUILDERS:
            raise ValueError(f"object type {type!r} is registered already; choose another name")
        _BUILDERS[type] = builder
        return builder

    return add


def registered() -> tuple[str, ...]:
    """Every type that has a builder, in the order of registration."""
    return tuple(_BUILDERS)


@functools.cache
def model(type: str) -> Model:
    """The looks of a type.

    Raises:
        ValueError: nothing is registered under this name.
    """
    if type not in _BUILDERS:
        raise ValueError(
            f"no body for object type {type!r}; known types: {', '.join(_BUILDERS)} "
            "(dcg_torch.simulator.bodies.register adds one)"
        )
    return _BUILDERS[type]()
