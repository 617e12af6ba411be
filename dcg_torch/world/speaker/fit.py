"""How well the objects about a robot fit some words: "behind the cube", "on your left", "farthest from you".

No human data is behind this: these are definitions by this project.

Conventions: all is seen from the robot, x ahead, y to its left, metres. "Behind", "left of" a thing are along the
robot's line of sight to the thing; "on your left" and "behind you" are sectors about the robot. Arrays are (n,), one
entry an object.
"""

from __future__ import annotations

import functools
import math
from dataclasses import dataclass

import numpy as np

from dcg_torch.types.arrays import Bools, Floats
from dcg_torch.types.geometry import NEXT_TO, to_robot_frame, wrap_angles
from dcg_torch.world.files import World

DIRECTIONS = {"behind": 0.0, "in front of": math.pi, "to the left of": math.pi / 2, "to the right of": -math.pi / 2}
"""Preposition -> angle from the robot's line of sight to the landmark."""
NEARNESS = {"next to": NEXT_TO, "beside": NEXT_TO, "near": 3.0, "close to": 3.0, "by": NEXT_TO}
"""Preposition -> metres from the landmark, at the most."""
ABOUT_ROBOT = {
    **{("behind", "you"): math.pi, ("in front of", "you"): 0.0, ("ahead of", "you"): 0.0},
    **{("on", "your left"): math.pi / 2, ("on", "your right"): -math.pi / 2},
    **{("on", "the left"): math.pi / 2, ("on", "the right"): -math.pi / 2},
}
"""Preposition and noun -> bearing of the middle of the sector."""


@dataclass(frozen=True)
class Surroundings:
    """The objects of a world as they are spoken of, n of them.

    Attributes:
        types, colors: of every object.
        position: (n, 2), seen from the robot.
        size: (n,) anything that grows with the size; None: all are of a size.
    """

    types: tuple[str, ...]
    colors: tuple[str, ...]
    position: Floats
    size: Floats | None = None

    @classmethod
    def of(cls, world: World, size: Floats | None = None) -> Surroundings:
        """A world as it is seen from the robot's start."""
        objects = world.objects
        position = to_robot_frame(world.start, np.array([o.position for o in objects], dtype=np.float64))
        return cls(tuple(o.type for o in objects), tuple(o.color for o in objects), position, size)

    @functools.cached_property
    def distance(self) -> Floats:
        """(n,) metres from the robot."""
        distance: Floats = np.hypot(*self.position.T)
        return distance

    @functools.cached_property
    def bearing(self) -> Floats:
        """(n,) from the robot's heading, left positive."""
        bearing: Floats = np.arctan2(self.position[:, 1], self.position[:, 0])
        return bearing

    def fitting(self, kind: str | None, color: str | None) -> Bools:
        """(n,) which objects are of this type and colour; None: any."""
        return np.array(
            [
                (kind is None or t == kind) and (color is None or c == color)
                for t, c in zip(self.types, self.colors, strict=True)
            ]
        )


@dataclass(frozen=True)
class Fit:
    """How every object fits some words.

    Attributes:
        value: the object of least value is meant.
        well: which objects fit well.
        loosely: which might be said to fit.
        margin: by how much the value of the one meant must be below that of the others.
    """

    value: Floats
    well: Bools
    loosely: Bools
    margin: float

    def best(self, among: Bools) -> int | None:
        """The object of least value among those that fit well, if all that might fit are worse by the margin."""
        well, loosely = self.well & among, self.loosely & among
        if not well.any():
            return None
        best = int(np.where(well, self.value, np.inf).argmin())
        rivals = (well | loosely) & (np.arange(len(self.value)) != best)
        return best if (self.value[rivals] - self.value[best] >= self.margin).all() else None


def from_landmark(around: Surroundings, relation: str, j: int) -> Fit:
    """How every object stands to the object j by a preposition; itself stands in no relation."""
    offset = around.position - around.position[j]
    distance = np.hypot(*offset.T)
    other = np.arange(len(distance)) != j
    if relation in DIRECTIONS:
        ahead = around.bearing[j] + DIRECTIONS[relation]
        turn = np.abs(wrap_angles(np.arctan2(offset[:, 1], offset[:, 0]) - ahead))
        well = other & (turn <= math.radians(45)) & (distance <= 3.5)
        return Fit(distance, well, other & (turn <= math.radians(70)) & (distance <= 4.5), 0.5)
    if relation in NEARNESS:
        return Fit(distance, other & (distance <= NEARNESS[relation]), other, 0.6)
    if relation == "far from":
        return Fit(-distance, other & (distance >= 3.5), other, 1.0)
    return Fit(-distance if relation == "farthest from" else distance, other, other, 0.4)


def by_distance(around: Surroundings, *, farthest: bool) -> Fit:
    """The closest to the robot, or the farthest from it."""
    everything = np.ones(len(around.types), dtype=np.bool_)
    return Fit(-around.distance if farthest else around.distance, everything, everything, 0.4)


def about_robot(around: Surroundings, word: str, place: str) -> Fit:
    """Behind, ahead, on one side; "on the left" may also be the leftmost of those that one could speak of."""
    angle = ABOUT_ROBOT[word, place]
    turn = np.abs(wrap_angles(around.bearing - angle))
    well = turn <= math.radians(50)
    if place in ("the left", "the right"):
        return Fit(-np.sign(angle) * around.position[:, 1], well, np.ones(len(turn), dtype=np.bool_), 1.0)
    return Fit(turn, well, turn <= math.radians(70), math.radians(40))


def between(around: Surroundings, i: int, j: int) -> Fit:
    """Between the objects i and j."""
    a, b = around.position[i], around.position[j]
    length = float(np.hypot(*(b - a)))
    along = (around.position - a) @ (b - a) / length
    aside = np.abs((around.position - a) @ np.array([a[1] - b[1], b[0] - a[0]])) / length
    free = ~np.isin(np.arange(len(along)), [i, j])
    well = free & (along > 0.5) & (along < length - 0.5) & (aside < max(0.5, 0.25 * length))
    loosely = free & (along > 0.0) & (along < length) & (aside < 0.5 * length)
    return Fit(np.zeros(len(along)), well, loosely, 1.0)


def behind_on_side(around: Surroundings, side: str) -> Fit:
    """ "Behind you on the left"."""
    left = around.bearing if side == "the left" else -around.bearing
    well = (left >= math.radians(110)) & (left <= math.radians(160))
    loosely = (left >= math.radians(80)) | (left <= math.radians(-170))
    return Fit(np.zeros(len(left)), well, loosely, 1.0)
