"""Random worlds by the paper's rules (Section V-A): each type in each colour is there with probability 0.15.

The paper says no more than "randomized locations"; what this generator adds to it:

* an empty world is drawn again, a world of one object is kept;
* objects stand at least `spacing` apart and `robot_spacing` from the robot, so that it can pass between them and
  hits none at the start; they lie uniformly in a square about the origin, under any heading;
* the robot starts at a uniform place in the inner half of that square and looks in a uniform direction. The middle
  of an object is then outside a view of 57 degrees with probability 1 - 57/360 = 84.2 %, wherever it stands, and
  all of the object a little less often (the paper reports 87 % for its ten worlds; ours were chosen to match).
"""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Sequence
from pathlib import Path
from typing import Final

import numpy as np

from dcg_torch.types.geometry import FIELD_OF_VIEW, bearing
from dcg_torch.world.files import RobotStart, World, WorldObject
from dcg_torch.world.writing import yaml_lines

TYPES: Final = ("cube", "sphere", "cylinder", "fire hydrant", "drill", "mailbox", "door handle", "traffic cone")
COLORS: Final = ("red", "green", "blue")
HALF_WIDTH: Final = 4.0  # m
OBJECT_RADIUS: Final = 0.17  # m, of an ordinary object seen from above

_DRAWS = 1_000  # of the set of objects, until it is not empty
_RESTARTS = 20  # of a placement that got stuck
_DARTS = 200  # places tried for one object before starting over
_FILL = 0.42  # share of the square that discs of diameter `spacing` may take; random placing jams at about 0.55


def generate_world(
    rng: np.random.Generator,
    name: str,
    *,
    types: Sequence[str] = TYPES,
    colors: Sequence[str] = COLORS,
    probability: float = 0.15,
    half_width: float | None = None,
    spacing: float = 1.1,
    robot_spacing: float = 1.2,
) -> World:
    """A random world of at least one object, at most one of each type and colour.

    Args:
        rng: the only source of randomness; one state gives one world.
        name: the world's name.
        types: nouns; an object's id is its colour and type, joined by underscores.
        colors: colour names.
        probability: of each (type, colour), in (0, 1].
        half_width: half the side of the square that the objects' feet are in, metres; None takes 4 m, or more when
            the objects drawn would not fit easily.
        spacing: least distance between the feet of two objects, metres.
        robot_spacing: least distance between the robot's start and a foot, metres.

    Raises:
        ValueError: an argument is out of range, no draw was other than empty, or the objects do not fit into a
            square of `half_width` (after a bounded number of tries).
    """
    _check_request(types, colors, probability)
    _check_distances(half_width, spacing, robot_spacing)
    chosen = _draw_objects(rng, types, colors, probability)
    width = _sufficient_half_width(len(chosen), spacing, robot_spacing) if half_width is None else half_width
    robot, feet = _place(rng, len(chosen), width, spacing, robot_spacing)
    yaws = rng.uniform(-math.pi, math.pi, size=len(chosen) + 1)
    return World(
        name=name,
        robot=RobotStart(x=_rounded(robot[0]), y=_rounded(robot[1]), yaw=_rounded(yaws[0])),
        objects=tuple(map(_object_at, chosen, feet, yaws[1:])),
    )


def _object_at(pair: tuple[str, str], foot: np.ndarray, yaw: float) -> WorldObject:
    type, color = pair
    return WorldObject(
        id=f"{color}_{type}".replace(" ", "_"),
        type=type,
        color=color,
        position=(_rounded(foot[0]), _rounded(foot[1])),
        yaw=_rounded(yaw),
    )


def _check_distances(half_width: float | None, spacing: float, robot_spacing: float) -> None:
    """See that none is negative.

    Raises:
        ValueError: one is.
    """
    if spacing < 0.0 or robot_spacing < 0.0 or (half_width is not None and half_width <= 0.0):
        raise ValueError(
            f"distances must not be negative: half_width {half_width}, spacing {spacing}, robot_spacing {robot_spacing}"
        )


def _check_request(types: Sequence[str], colors: Sequence[str], probability: float) -> None:
    """See that there is something to draw from.

    Raises:
        ValueError: there is not.
    """
    if not types or not colors:
        raise ValueError("a world needs at least one type and one colour")
    for what, names in (("type", types), ("colour", colors)):
        if repeated := [name for name, times in Counter(names).items() if times > 1]:
            raise ValueError(f"{what} {repeated[0]!r} is given more than once")
    if not 0.0 < probability <= 1.0:
        raise ValueError(f"probability {probability} of an object is not in (0, 1]")


def _draw_objects(
    rng: np.random.Generator, types: Sequence[str], colors: Sequence[str], probability: float
) -> list[tuple[str, str]]:
    pairs = [(type, color) for type in types for color in colors]
    for _ in range(_DRAWS):
        present = rng.random(len(pairs)) < probability
        if present.any():
            return [pair for pair, there in zip(pairs, present, strict=True) if there]
    raise ValueError(f"{_DRAWS} draws gave no object at all; raise the probability {probability}")


def _sufficient_half_width(count: int, spacing: float, robot_spacing: float) -> float:
    """HALF_WIDTH, or what leaves the discs about `count` objects and the robot a share of _FILL."""
    area = math.pi * (count * (spacing / 2) ** 2 + (robot_spacing - spacing / 2) ** 2)
    return max(HALF_WIDTH, math.ceil(5.0 * math.sqrt(area / _FILL)) / 10.0)


def _place(
    rng: np.random.Generator, count: int, half_width: float, spacing: float, robot_spacing: float
) -> tuple[np.ndarray, np.ndarray]:
    """The robot's (2,) and the objects' (count, 2) places, dart by dart.

    Distances are kept a millimetre longer, so that rounding the coordinates does not undercut them.
    """
    for _ in range(_RESTARTS):
        robot = rng.uniform(-half_width / 2, half_width / 2, size=2)
        feet = np.empty((count, 2))
        for placed in range(count):
            darts = rng.uniform(-half_width, half_width, size=(_DARTS, 2))
            free = np.linalg.norm(darts - robot, axis=1) >= robot_spacing + 1e-3
            gaps = np.linalg.norm(darts[:, None] - feet[None, :placed], axis=2)
            free &= (gaps >= spacing + 1e-3).all(axis=1)
            if not free.any():
                break
            feet[placed] = darts[int(free.argmax())]
        else:
            return robot, feet
    raise ValueError(
        f"{count} objects {spacing} m apart and {robot_spacing} m from the robot do not fit into a square of "
        f"half_width {half_width} m; raise half_width, leave it out, or lower the spacing"
    )


def _rounded(value: float) -> float:
    """To a tenth of a millimetre, so that world files stay readable and equal the worlds they were written from."""
    return round(float(value), 4)


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
    head = [f"# Made by dcg_torch.world.generator.write_worlds(directory, seed={chosen}, count={count})."]
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
