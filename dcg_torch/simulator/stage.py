"""A world set up to be looked at: the objects on a tiled floor, and the robot, which stands where it is put."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Final

import numpy as np
from PIL import Image, ImageDraw, ImageFilter

from dcg_torch.simulator.bodies import add_model, add_object, extent, footprint
from dcg_torch.simulator.client import Client, Closing
from dcg_torch.simulator.engine import pybullet
from dcg_torch.simulator.tiles import TILES, paint_floor, tiled
from dcg_torch.simulator.view import Pixels, View, circle, direction, fitting_view
from dcg_torch.simulator.wheels import add_robot
from dcg_torch.types import Pose
from dcg_torch.types.arrays import Bools, Ints, Points
from dcg_torch.world.files import World

ROBOT_RADIUS, ROBOT_HEIGHT = 0.2, 0.4  # metres that a picture should leave it
_AROUND: Final = 14  # metres of floor about the outermost object
_FIELD_OF_VIEW: Final = math.radians(18.0)  # vertical; narrow, so that upright things stay upright at the edges


class Stage(Closing):
    """One world in a physics client of its own; no physics runs. Close it, or use it in a `with` statement.

    Args:
        world: what stands on the floor.

    Raises:
        ValueError: an object of a type or colour that the simulator doesn't have.
    """

    def __init__(self, world: World) -> None:
        self.world = world
        self.client = Client()
        try:
            places = [o.position for o in world.objects] + [(world.robot.x, world.robot.y)]
            self._reach = math.ceil(max(abs(c) for place in places for c in place)) + _AROUND
            self.floor = add_model(self.client.id, tiled(self._reach), TILES[0], (0.0, 0.0))
            self.bodies = {o.id: add_object(self.client.id, o.type, o.color, o.position, o.yaw) for o in world.objects}
            self.robot = add_robot(self.client.id, world.start)
        except BaseException:
            self.close()
            raise

    def close(self) -> None:
        """Let go of the client; a second call does nothing."""
        self.client.close()

    def put(self, pose: Pose | None) -> None:
        """Stand the robot at `pose`, or out of every picture."""
        x, y = (pose.x, pose.y) if pose else (1e4, 1e4)
        turn = pybullet.getQuaternionFromEuler([0.0, 0.0, pose.yaw if pose else 0.0])
        pybullet.resetBasePositionAndOrientation(self.robot, [x, y, 0.0], turn, physicsClientId=self.client.id)

    def overview(self, size: tuple[int, int], down: float, places: Sequence[Pose] = ()) -> View:
        """A camera behind the robot's start and above it, looking `down` radians below the horizon.

        It has every object in the picture, the start, and the robot at `places`.
        """
        corners = [_corners(o.position, footprint(o.type), extent(o.type)[2]) for o in self.world.objects]
        corners += [_corners((p.x, p.y), ROBOT_RADIUS, ROBOT_HEIGHT) for p in (self.world.start, *places)]
        return fitting_view(np.concatenate(corners), direction(self.world.start.yaw, down), _FIELD_OF_VIEW, size)

    def render(self, view: View) -> tuple[Pixels, Ints]:
        """Colours (h, w, 3) with the objects' shadows on the floor, and body ids (h, w)."""
        image, mask = self.unshaded(view)
        spots = [circle(o.position, 0.8 * footprint(o.type) + 0.03) for o in self.world.objects]
        return shaded(image, mask == self.floor, view, spots), mask

    def unshaded(self, view: View) -> tuple[Pixels, Ints]:
        """The same without shadows."""
        with self.client.hidden([self.floor]):
            image, mask = view.render(self.client)
        paint_floor(view, image, mask, self.floor, self._reach)
        return image, mask


def shaded(image: Pixels, floor: Bools, view: View, spots: Sequence[Points]) -> Pixels:
    """The picture with soft shadows where things touch the floor, without which they seem to float."""
    shade = Image.new("L", view.size)
    draw = ImageDraw.Draw(shade)
    for spot in spots:
        draw.polygon(view.outline(spot), fill=150)
    if (box := shade.getbbox()) is None:
        return image
    blur = view.size[1] / 160
    beyond = math.ceil(4 * blur)  # where nothing is left of it
    left, top = max(0, box[0] - beyond), max(0, box[1] - beyond)
    right, bottom = min(view.size[0], box[2] + beyond), min(view.size[1], box[3] + beyond)
    soft = np.asarray(shade.crop((left, top, right, bottom)).filter(ImageFilter.GaussianBlur(blur)), dtype=float) / 255
    part = np.s_[top:bottom, left:right]
    dark = np.nonzero((soft > 0.0) & floor[part])  # few pixels
    image = image.copy()
    image[part][dark] = (image[part][dark] * (1.0 - soft[dark])[:, None]).astype(np.uint8)
    return image


def _corners(position: tuple[float, float], radius: float, height: float) -> Points:
    x, y = position
    return np.array([[x + a * radius, y + b * radius, z] for a in (-1, 1) for b in (-1, 1) for z in (0.0, height)])
