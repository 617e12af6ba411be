"""What is asked: every object of some worlds, each with its picture."""

from __future__ import annotations

import hashlib
import io
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Final

import numpy as np
from PIL import Image

from dcg_torch.apps.collect.settings import TaskSettings
from dcg_torch.simulator.screenshot import pair_pictures
from dcg_torch.storage.atomic_files import write_whole
from dcg_torch.storage.errors import UserError
from dcg_torch.storage.resources import resource
from dcg_torch.storage.untrusted_files import at_home, shown
from dcg_torch.world.files import World, load_world, load_worlds
from dcg_torch.world.generator import generate_world
from dcg_torch.world.writing import yaml_lines

PICTURES, WORLDS = "pictures", "worlds"
SIZE: Final = (800, 600)


class CollectError(UserError):
    """Something that the user has to mend; the message is one line."""


@dataclass(frozen=True)
class Item:
    """One object of one world. The id names the picture and tells nobody what the object is."""

    id: str
    world: str
    object: str

    @property
    def picture(self) -> str:
        """The name of the picture's file."""
        return f"{self.id}.png"


def task_worlds(settings: TaskSettings) -> list[World]:
    """The worlds that are asked about.

    Raises:
        WorldFileError: one is missing or not valid.
    """
    if settings.worlds != "generated":
        return load_worlds(worlds_folder(settings.worlds))
    streams = np.random.default_rng(settings.seed).spawn(settings.count)
    return [generate_world(rng, f"generated_{settings.seed}_{k:02d}") for k, rng in enumerate(streams)]


def worlds_folder(name: str) -> Path:
    """The folder that a setting names."""
    return resource("worlds") if name == "committed" else at_home(name)


def items_of(worlds: Sequence[World]) -> dict[str, Item]:
    """Every object of the worlds, by the id of its item."""
    items = (Item(_id(world.name, o.id), world.name, o.id) for world in worlds for o in world.objects)
    return {item.id: item for item in items}


def _id(world: str, thing: str) -> str:
    return hashlib.blake2b(f"{world}\0{thing}".encode(), digest_size=8).hexdigest()


def prepare(folder: Path, worlds: Sequence[World], say: Callable[[str], object]) -> dict[str, Item]:
    """Write worlds and pictures into a folder, those that are not there; the items.

    Raises:
        CollectError: the folder was begun with another world of the same name, or one cannot be drawn.
    """
    items = items_of(worlds)
    for world in worlds:
        bare = world.model_copy(update={"commands": (), "relational": ()})
        path = folder / WORLDS / f"{world.name}.yaml"
        if path.exists() and load_world(path) != bare:
            raise CollectError(
                f"folder={folder}: was begun with another world called {shown(world.name)}; give another folder"
            )
        if not path.exists():
            write_whole(path, "\n".join(yaml_lines(bare)) + "\n")
    missing = [w for w in worlds if any(not _at(folder, items, w.name, o.id).exists() for o in w.objects)]
    for done, world in enumerate(missing):
        say(f"drawing pictures: world {done + 1} of {len(missing)}")
        _draw(folder, items, world)
    return items


def _draw(folder: Path, items: Mapping[str, Item], world: World) -> None:
    try:
        for thing, picture in pair_pictures(world, SIZE):
            png = io.BytesIO()
            Image.fromarray(picture).quantize(256).save(png, "png", optimize=True)
            write_whole(_at(folder, items, world.name, thing), png.getvalue())
    except UserError:
        raise
    except ValueError as error:  # a type or colour without a body
        raise CollectError(f"world {shown(world.name)} cannot be drawn: {error}") from None


def _at(folder: Path, items: Mapping[str, Item], world: str, thing: str) -> Path:
    return folder / PICTURES / items[_id(world, thing)].picture
