"""Scenes that are seen as a whole, in few words, and what commands mean in them."""

from __future__ import annotations

import asked

from dcg_torch.scene.workspace import Workspace
from dcg_torch.types import Percept, Pose

HERE = Pose(0.0, 0.0)


def meant(text: str, things: list[Percept], robot: Pose | None = HERE) -> list[str]:
    """The ids of what a command means in a scene that is seen as a whole."""
    return sorted(asked.meant(text, things, robot, looked=True, workspace=Workspace.of(things)))


def thing(
    id_: str, type_: str, x: float, y: float, color: str | None = None, z: float = 0.0, **keys: object
) -> Percept:
    """A thing in metres; `keys` are its attributes, but for `size`, `rgb`."""
    size, rgb = keys.pop("size", None), keys.pop("rgb", None)
    given = frozenset(f"{key}: {value}" for key, value in keys.items())
    return Percept(id_, type_, color, (x, y, z), size=size, rgb=rgb, attributes=given)  # type: ignore[arg-type]
