"""The robot's camera.

What is in view is read from the rendered segmentation mask: an object is seen when enough of its pixels are, so that
the field of view and occlusion are those of the picture, and none is computed by formula.
"""

from __future__ import annotations

import math
from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np

from dcg_torch.simulator.client import Client
from dcg_torch.simulator.view import Pixels, View, direction
from dcg_torch.types import Pose
from dcg_torch.types.geometry import FIELD_OF_VIEW, bearing, from_robot_frame

NEAR, FAR = 0.02, 30.0
"""Metres between which the camera shows anything."""
_EDGE = 0.02  # radians beyond the picture's edge in which nothing is ruled out: three pixels


@dataclass(frozen=True, slots=True)
class Camera:
    """A pinhole camera on the robot's pole, looking straight ahead.

    `field_of_view` is horizontal, in radians. The default picture is wide and low, as objects are: it shows the ground
    from 1.2 m on, and nearer objects from their middle upwards. `height` and `forward` (metres) put the lens in front
    of the model's camera head.
    """

    width: int = 160
    rows: int = 80
    field_of_view: float = FIELD_OF_VIEW
    height: float = 0.305
    forward: float = -0.012

    def view(self, pose: Pose, size: tuple[int, int] | None = None) -> View:
        """What a robot at `pose` looks through; the same angle across at any (width, height) in pixels."""
        width, height = size = size or (self.width, self.rows)
        vertical = 2.0 * math.atan(math.tan(self.field_of_view / 2.0) * height / width)
        return View(np.array(self.eye(pose)), direction(pose.yaw, 0.0), vertical, size, NEAR, FAR)

    def pixels(self, client: Client, pose: Pose, hidden: Iterable[int] = ()) -> dict[int, int]:
        """Body number -> count of its visible pixels, seen by a robot at `pose`.

        Args:
            hidden: bodies that are not drawn. Those that are not `in_reach` take half of the time, and show nothing.
        """
        with client.hidden([client.floor, *hidden]):
            mask = self.view(pose).mask(client)
        counts = np.bincount(mask.ravel() + 1)[1:]
        return {int(body): int(counts[body]) for body in np.flatnonzero(counts)}

    def in_reach(self, pose: Pose, place: tuple[float, float], radius: float) -> bool:
        """Whether what stands at `place`, nowhere wider than `radius` metres, may show; if not, it surely doesn't."""
        x, y, _ = self.eye(pose)
        distance = math.dist((x, y), place)
        if distance <= radius:
            return True
        aside = abs(bearing(Pose(x, y, pose.yaw), *place))
        return aside <= self.field_of_view / 2.0 + math.asin(radius / distance) + _EDGE

    def picture(self, client: Client, pose: Pose, *, width: int = 320, height: int = 180) -> Pixels:
        """What a robot at `pose` sees, as (height, width, 3) bytes."""
        return self.view(pose, (width, height)).render(client)[0]

    def eye(self, pose: Pose) -> tuple[float, float, float]:
        """Where the lens of a robot at `pose` is."""
        return (*from_robot_frame(pose, self.forward, 0.0), self.height)
