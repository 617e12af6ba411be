"""World files: what stands where, and the commands that were written for it."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import yaml
from pydantic import BaseModel, ConfigDict, Field, ValidationError, model_validator

from dcg_torch.types import Pose


class _Strict(BaseModel):
    model_config = ConfigDict(frozen=True, extra="forbid", allow_inf_nan=False)


class WorldObject(_Strict):
    """One object: `position` is its foot (x, y) in metres, `yaw` its heading in radians."""

    id: str = Field(min_length=1)
    type: str = Field(min_length=1)
    color: str = Field(min_length=1)
    position: tuple[float, float]
    yaw: float = 0.0


class WrittenCommand(_Strict):
    """A command that was written for a world, the id of the object it means, and what it says of that object.

    `noun` is the noun as said, in the singular; `color` the stated colour, or null.
    """

    text: str = Field(min_length=1)
    target: str
    noun: str = Field(min_length=1)
    color: str | None = None


class RobotStart(_Strict):
    """Where the robot starts, metres and radians."""

    x: float = 0.0
    y: float = 0.0
    yaw: float = 0.0


class World(_Strict):
    """A world file. Ids are unique and every command's target exists.

    `relational` are commands in which noun and colour alone do not say what is meant.
    """

    name: str = Field(min_length=1)
    robot: RobotStart = RobotStart()
    objects: Annotated[tuple[WorldObject, ...], Field(min_length=1)]
    commands: tuple[WrittenCommand, ...] = ()
    relational: tuple[WrittenCommand, ...] = ()

    @model_validator(mode="after")
    def _consistent(self) -> World:
        ids = [o.id for o in self.objects]
        if len(set(ids)) != len(ids):
            raise ValueError(f"object ids repeat: {sorted({i for i in ids if ids.count(i) > 1})}")
        for command in (*self.commands, *self.relational):
            if command.target not in ids:
                raise ValueError(f"command {command.text!r} means {command.target!r}, which is no object of this world")
        return self

    @property
    def start(self) -> Pose:
        """The robot's start pose."""
        return Pose(self.robot.x, self.robot.y, self.robot.yaw)


class WorldFileError(ValueError):
    """A world file that is missing or not valid; the message is one line."""


def load_world(path: Path) -> World:
    """Read one YAML world file.

    Raises:
        WorldFileError: the file is absent, not YAML, or not a valid world.
    """
    try:
        raw = yaml.safe_load(path.read_text(encoding="utf-8"))
        return World.model_validate(raw)
    except FileNotFoundError:
        raise WorldFileError(f"{path}: no such world file") from None
    except (UnicodeDecodeError, yaml.YAMLError) as error:
        raise WorldFileError(f"{path}: not readable as YAML: {' '.join(str(error).split())}") from None
    except ValidationError as error:
        first = error.errors()[0]
        where = ".".join(str(part) for part in first["loc"]) or "the file"
        raise WorldFileError(f"{path}: {where}: {first['msg']}") from None


def load_worlds(directory: Path) -> list[World]:
    """Read every `*.yaml` in a directory, sorted by the worlds' names.

    Raises:
        WorldFileError: no such directory, no world file in it, one that is not valid, or a name used twice.
    """
    if not directory.is_dir():
        raise WorldFileError(f"{directory}: no such directory of world files")
    paths = sorted(directory.glob("*.yaml"))
    if not paths:
        raise WorldFileError(f"{directory}: holds no world file (*.yaml)")
    found: dict[str, Path] = {}
    worlds = []
    for path in paths:
        world = load_world(path)
        if world.name in found:
            raise WorldFileError(f"{path}: the name {world.name!r} is taken by {found[world.name]}; give it another")
        found[world.name] = path
        worlds.append(world)
    return sorted(worlds, key=lambda world: world.name)
