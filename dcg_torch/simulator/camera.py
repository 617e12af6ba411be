"""The robot's camera, and the recogniser that names what it shows.

What is in view is read from the rendered segmentation mask: an object is seen when enough of its pixels are,
so that the field of view and occlusion are those of the picture, and none is computed by formula.

Conventions: images are (height, width) or (height, width, 3) arrays, row 0 at the top, column 0 on the left.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import pybullet
from numpy.typing import NDArray

from dcg_torch.simulator.client import Client
from dcg_torch.types import Percept, Pose

NEAR, FAR = 0.02, 30.0
"""Metres between which the camera shows anything."""


@dataclass(frozen=True, slots=True)
class Camera:
    """A pinhole camera on the robot's pole, looking straight ahead.

    `field_of_view` is horizontal, in radians (the paper's robot has 57 degrees). The default picture is wide and
    low, as objects are: it shows the ground from 1.2 m on, and nearer objects from their middle upwards. `height`
    and `forward` (metres) put the lens in front of the model's camera head.
    """

    width: int = 160
    rows: int = 80
    field_of_view: float = math.radians(57.0)
    height: float = 0.305
    forward: float = -0.012

    def pixels(self, client: Client, pose: Pose) -> dict[int, int]:
        """Body number -> count of its visible pixels, seen by a robot at `pose`."""
        eye, towards = self._looking(pose)
        with client.hidden_floor():
            _, mask = _render(client, eye, towards, self.width, self.rows, self.vertical(self.width, self.rows))
        bodies, counts = np.unique(mask, return_counts=True)
        return {int(body): int(count) for body, count in zip(bodies, counts, strict=True) if body >= 0}

    def picture(self, client: Client, pose: Pose, *, width: int = 320, height: int = 180) -> NDArray[np.uint8]:
        """What a robot at `pose` sees, as (height, width, 3) bytes, the same angle across at any size."""
        eye, towards = self._looking(pose)
        return _render(client, eye, towards, width, height, self.vertical(width, height))[0]

    def eye(self, pose: Pose) -> _Point:
        """Where the lens of a robot at `pose` is."""
        ahead, left = math.cos(pose.yaw), math.sin(pose.yaw)
        return (pose.x + self.forward * ahead, pose.y + self.forward * left, self.height)

    def _looking(self, pose: Pose) -> tuple[_Point, _Point]:
        """The lens, and a point straight ahead of it."""
        eye = self.eye(pose)
        return eye, (eye[0] + math.cos(pose.yaw), eye[1] + math.sin(pose.yaw), self.height)

    def vertical(self, width: int, height: int) -> float:
        """The vertical field of view in radians that goes with square pixels in a picture of this size."""
        return 2.0 * math.atan(math.tan(self.field_of_view / 2.0) * height / width)


_Point = tuple[float, float, float]


def view_from(
    client: Client,
    eye: _Point,
    towards: _Point,
    *,
    up: _Point = (0.0, 0.0, 1.0),
    width: int = 320,
    height: int = 240,
    vertical_field_of_view: float = math.radians(50.0),
) -> NDArray[np.uint8]:
    """A picture from anywhere, as (height, width, 3) bytes; give another `up` to look straight down."""
    return _render(client, eye, towards, width, height, vertical_field_of_view, up=up)[0]


def _render(
    client: Client,
    eye: _Point,
    towards: _Point,
    width: int,
    height: int,
    vertical: float,
    *,
    up: _Point = (0.0, 0.0, 1.0),
) -> tuple[NDArray[np.uint8], NDArray[np.int32]]:
    """Colours (height, width, 3) and body numbers (height, width; -1 for the sky)."""
    _, _, colours, _, mask = pybullet.getCameraImage(
        width,
        height,
        pybullet.computeViewMatrix(eye, towards, up),
        pybullet.computeProjectionMatrixFOV(math.degrees(vertical), width / height, NEAR, FAR),
        lightDirection=[2.0, -3.0, 6.0],
        lightAmbientCoeff=0.55,
        lightDiffuseCoeff=0.5,
        lightSpecularCoeff=0.05,
        shadow=0,  # they triple the time, and the renderer's end in the middle of a large floor
        renderer=pybullet.ER_TINY_RENDERER,  # the same pixels with and without a window
        physicsClientId=client.id,
    )
    # pybullet gives arrays or flat tuples, depending on how it was built
    rgb = np.asarray(colours, dtype=np.uint8).reshape(height, width, 4)[:, :, :3]
    return rgb, np.asarray(mask, dtype=np.int32).reshape(height, width)


@dataclass(frozen=True, slots=True)
class Recogniser:
    """How well objects are named; the default is the paper's, perfect.

    Args:
        min_pixels: an object with fewer visible pixels isn't noticed (one of 0.3 m has about 30 at 8 m).
        wrong_class: probability that an object is taken for one of another type.
        missed: probability that an object isn't recognised at all.
        types: the types it knows; a wrong one is drawn evenly from the others.

    Raises:
        ValueError: a probability outside [0, 1], or `wrong_class` above 0 with fewer than two types.
    """

    min_pixels: int = 8
    wrong_class: float = 0.0
    missed: float = 0.0
    types: tuple[str, ...] = ()

    def __post_init__(self) -> None:
        if self.min_pixels < 1:
            raise ValueError(f"min_pixels is {self.min_pixels}; it must be at least 1")
        for name, value in (("wrong_class", self.wrong_class), ("missed", self.missed)):
            if not 0.0 <= value <= 1.0:
                raise ValueError(f"{name} is {value}; a probability lies between 0 and 1")
        if self.wrong_class > 0.0 and len(set(self.types)) < 2:
            raise ValueError(f"wrong_class is {self.wrong_class}, and types={self.types} leaves no wrong type to draw")

    def labels(self, types: Sequence[str], rng: np.random.Generator) -> list[str | None]:
        """What each object of a world, in order, is recognised as while that world lasts; None: never.

        Every object takes the same two numbers and one choice from `rng`, whatever the probabilities, so that
        the same objects are confused at 5 % and at 10 %.
        """
        labels: list[str | None] = []
        for type_ in types:
            miss, wrong, which = rng.random(3)
            others = sorted(set(self.types) - {type_})
            if miss < self.missed:
                labels.append(None)
            elif wrong < self.wrong_class:
                labels.append(others[int(which * len(others))])
            else:
                labels.append(type_)
        return labels


def bearing(pose: Pose, percept: Percept) -> float:
    """The angle in [-pi, pi] from the robot's heading to the object, left positive."""
    angle = math.atan2(percept.position[1] - pose.y, percept.position[0] - pose.x) - pose.yaw
    return math.remainder(angle, math.tau)
