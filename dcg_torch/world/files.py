"""World files: what stands where, and the commands that were written for it."""

from __future__ import annotations

from collections import Counter
from pathlib import Path
from typing import Annotated

from pydantic import Field, ValidationError, model_validator

from dcg_torch.storage.errors import UserError
from dcg_torch.storage.untrusted_files import Strict, problem_of, read_yaml, shown
from dcg_torch.types import Pose

REACH_OF_A_WORLD = 1_000.0
"""Metres from the origin within which everything stands."""

Metres = Annotated[float, Field(strict=True, ge=-REACH_OF_A_WORLD, le=REACH_OF_A_WORLD)]
Radians = Annotated[float, Field(strict=True, ge=-1_000.0, le=1_000.0)]
Name = Annotated[str, Field(strict=True, min_length=1, max_length=100, pattern=r"\S")]
# Pictures are named by the world and the object.
FileName = Annotated[str, Field(strict=True, min_length=1, max_length=80, pattern=r"^[^/\x00-\x1f.][^/\x00-\x1f]*$")]
Text = Annotated[str, Field(strict=True, min_length=1, max_length=1_000)]


class WorldObject(Strict):
    """One object: `position` is its foot (x, y) in metres, `yaw` its heading in radians."""

    id: FileName
    type: Name
    color: Name
    position: tuple[Metres, Metres]
    yaw: Radians = 0.0


class WrittenCommand(Strict):
    """A command that was written for a world, the id of the object it means, and what it says of that object.

    `noun` is the noun as said, in the singular; `color` the stated colour, or null. `away`:
    the command is to keep away from the object.
    """

    text: Text
    target: FileName
    noun: Name
    color: Name | None = None
    away: bool = Field(False, strict=True)


class RobotStart(Strict):
    """Where the robot starts, metres and radians."""

    x: Metres = 0.0
    y: Metres = 0.0
    yaw: Radians = 0.0


class World(Strict):
    """A world file. Ids are unique and every command's target exists.

    `relational` are commands in which noun and colour alone do not say what is meant.
    """

    name: FileName
    robot: RobotStart = RobotStart()
    objects: Annotated[tuple[WorldObject, ...], Field(min_length=1)]
    commands: tuple[WrittenCommand, ...] = ()
    relational: tuple[WrittenCommand, ...] = ()

    @model_validator(mode="after")
    def _consistent(self) -> World:
        ids = Counter(o.id for o in self.objects)
        repeated = [name for name, times in ids.items() if times > 1]
        if repeated:
            raise ValueError(f"object ids repeat: {shown(repeated[0])}; give each object its own")
        for command in (*self.commands, *self.relational):
            if command.target not in ids:
                raise ValueError(
                    f"the command {shown(command.text)} means {shown(command.target)}, which is no object of this world"
                )
        return self

    @property
    def start(self) -> Pose:
        """The robot's start pose."""
        return Pose(self.robot.x, self.robot.y, self.robot.yaw)


class WorldFileError(UserError):
    """A world file that is missing or not valid; the message is one line."""


def load_world(path: Path) -> World:
    """Read one YAML world file.

    Raises:
        WorldFileError: the file is absent, not YAML, or not a valid world.
    """
    try:
        return World.model_validate(read_yaml(path, "world file", WorldFileError))
    except ValidationError as error:
        raise WorldFileError(f"{path}: {problem_of(error, World)}") from None


def load_worlds(directory: Path) -> list[World]:
    """Read every `*.yaml` in a directory, sorted by the worlds' names.

    Raises:
        WorldFileError: no such directory, no world file in it, one that is not valid, or a name used twice.
    """
    try:
        paths = sorted(directory.glob("*.yaml")) if directory.is_dir() else None
    except (OSError, RuntimeError) as error:
        said = getattr(error, "strerror", None) or "its links lead in a circle"
        raise WorldFileError(f"{directory}: cannot be read: {said}") from None
    if paths is None and directory.is_file():
        raise WorldFileError(f"{directory}: a file, and no directory of world files; name the folder that it is in")
    if paths is None:
        raise WorldFileError(f"{directory}: no such directory of world files")
    if not paths:
        raise WorldFileError(f"{directory}: holds no world file (*.yaml)")
    found: dict[str, Path] = {}
    worlds = []
    for path in paths:
        world = load_world(path)
        if world.name in found:
            raise WorldFileError(
                f"{path}: the name {shown(world.name)} is taken by {found[world.name]}; give it another"
            )
        found[world.name] = path
        worlds.append(world)
    return sorted(worlds, key=lambda world: world.name)
