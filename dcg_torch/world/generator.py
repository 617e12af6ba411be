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
from typing import Final

import numpy as np

from dcg_torch.world.files import RobotStart, World, WorldObject

TYPES: Final = ("cube", "sphere", "cylinder", "fire hydrant", "drill", "mailbox", "door handle", "traffic cone")
COLORS: Final = ("red", "green", "blue")
HALF_WIDTH: Final = 4.0  # m

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
    if min(spacing, robot_spacing) < 0.0 or (half_width is not None and half_width <= 0.0):
        raise ValueError(
            f"distances must not be negative: half_width {half_width}, spacing {spacing}, robot_spacing {robot_spacing}"
        )
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
