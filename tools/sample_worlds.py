"""Make a set of worlds by the paper's rules that is a fair sample of them; the project's `worlds` are such a set.

python tools/sample_worlds.py DIRECTORY
"""

from __future__ import annotations

import math
import sys
from collections import Counter
from collections.abc import Sequence
from pathlib import Path
from typing import Final

import numpy as np

from dcg_torch.types.geometry import FIELD_OF_VIEW, bearing
from dcg_torch.world.files import World
from dcg_torch.world.generator import TYPES, generate_world
from dcg_torch.world.writing import yaml_lines

OBJECT_RADIUS: Final = 0.17  # m, of an ordinary object seen from above


def share_out_of_view(worlds: Sequence[World], view: float = FIELD_OF_VIEW, radius: float = 0.0) -> float:
    """Share of all objects that are wholly outside the robot's first view, `view` radians wide; hiding not counted.

    Objects are discs of `radius` metres about their feet; with 0 the feet alone count.
    """
    outside = []
    for world in worlds:
        for item in world.objects:
            distance = math.dist(item.position, (world.robot.x, world.robot.y))
            off = abs(bearing(world.start, *item.position))
            outside.append(off - math.asin(min(1.0, radius / distance)) > view / 2)
    return sum(outside) / len(outside)


def generate_worlds(seed: int, count: int) -> list[World]:
    """`count` worlds world_00, world_01, ... by the paper's rules, all from one seed."""
    streams = np.random.default_rng(seed).spawn(count)
    return [generate_world(rng, f"world_{index:02d}") for index, rng in enumerate(streams)]


def representative_seed(count: int = 10, tries: int = 10_000) -> int:
    """The first seed whose worlds are a fair sample of the paper's rules, as a small fixed set should be.

    Each of the eight types occurs 3 to 7 times in ten worlds (4.6 are expected), there are 3.4 to 4.2 objects a world
    (3.7 are expected), and 86 to 88 % of them are outside the first view (the paper: 87 %), both by their feet and as
    a whole, so that the share hardly depends on how much of an object a camera must see.

    Raises:
        ValueError: none of the first `tries` seeds is one.
    """
    for seed in range(tries):
        worlds = generate_worlds(seed, count)
        occurring = Counter(o.type for world in worlds for o in world.objects)
        if (
            all(0.3 * count <= occurring[type] <= 0.7 * count for type in TYPES)
            and 3.4 * count <= occurring.total() <= 4.2 * count
            and all(0.86 <= share_out_of_view(worlds, radius=r) <= 0.88 for r in (0.0, OBJECT_RADIUS))
        ):
            return seed
    raise ValueError(f"none of the seeds 0 to {tries - 1} gives {count} representative worlds")


def write_worlds(directory: Path, seed: int | None = None, count: int = 10) -> list[Path]:
    """Write `generate_worlds(seed, count)` as YAML files that say in their head how they were made.

    `seed` None takes `representative_seed(count)`.

    Raises:
        FileExistsError: a file is there already; it may hold commands that people wrote, so it is left as it is.
    """
    chosen = representative_seed(count) if seed is None else seed
    head = [f"# Made by tools/sample_worlds.py, write_worlds(directory, seed={chosen}, count={count})."]
    if seed is None:
        head += [
            "# The seed is representative_seed(): the first one for which each of the eight types occurs 0.3 to 0.7",
            "# times a world, a world holds 3.4 to 4.2 objects on average, and 86 to 88 % of the objects are",
            "# outside the robot's first view of 57 degrees, both by their feet and as a whole.",
        ]
    head += ["# Metres and radians; `position` is the foot of an object, `yaw` where its front points."]
    directory.mkdir(parents=True, exist_ok=True)
    paths = []
    for world in generate_worlds(chosen, count):
        path = directory / f"{world.name}.yaml"
        with path.open("x", encoding="utf-8") as file:
            file.write("\n".join([*head, *yaml_lines(world)]) + "\n")
        paths.append(path)
    return paths


if __name__ == "__main__":
    write_worlds(Path(sys.argv[1]))
