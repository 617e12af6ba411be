"""A world set up to be looked at: the objects on a tiled floor, and the robot, which stands where it is put."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Final

import numpy as np
from numpy.typing import NDArray
from PIL import Image, ImageDraw, ImageFilter

from dcg_torch.simulator.base import add_robot
from dcg_torch.simulator.bodies import Model, Part, add_model, add_object, extent, footprint
from dcg_torch.simulator.bodies.meshes import Mesh, merged
from dcg_torch.simulator.client import Client, Closing
from dcg_torch.simulator.engine import pybullet
from dcg_torch.simulator.view import Pixels, Points, View, circle, direction, fitting_view
from dcg_torch.types import Pose
from dcg_torch.world.files import World

ROBOT_RADIUS, ROBOT_HEIGHT = 0.2, 0.4  # metres that a picture should leave it
_TILES: Final = ((0.89, 0.89, 0.87), (0.85, 0.85, 0.83))
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
            self.floor = add_model(self.client.id, _floor(world), _TILES[0], (0.0, 0.0))
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

    def render(self, view: View) -> tuple[Pixels, NDArray[np.int64]]:
        """Colours (h, w, 3) with the objects' shadows on the floor, and body ids (h, w)."""
        image, mask = view.render(self.client)
        spots = [circle(o.position, 0.8 * footprint(o.type) + 0.03) for o in self.world.objects]
        return shaded(image, mask == self.floor, view, spots), mask


def shaded(image: Pixels, floor: NDArray[np.bool_], view: View, spots: Sequence[Points]) -> Pixels:
    """The picture with soft shadows where things touch the floor, without which they seem to float."""
    shade = Image.new("L", view.size)
    draw = ImageDraw.Draw(shade)
    for spot in spots:
        draw.polygon(view.outline(spot), fill=150)
    soft = np.asarray(shade.filter(ImageFilter.GaussianBlur(view.size[1] / 160)), dtype=float) / 255
    return (image * (1.0 - soft * floor)[..., None]).astype(np.uint8)


def _corners(position: tuple[float, float], radius: float, height: float) -> Points:
    x, y = position
    return np.array([[x + a * radius, y + b * radius, z] for a in (-1, 1) for b in (-1, 1) for z in (0.0, height)])


def _floor(world: World) -> Model:
    """Tiles of a metre in two light tones, with their upper side on z = 0, well beyond the objects."""
    reach = math.ceil(max(abs(c) for o in world.objects for c in (*o.position, world.robot.x, world.robot.y))) + 14
    tiles: tuple[list[Mesh], list[Mesh]] = ([], [])
    square = np.array([[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0], [0.0, 1.0, 0.0]])
    up, halves = np.tile([0.0, 0.0, 1.0], (4, 1)), np.array([[0, 1, 2], [0, 2, 3]])
    tile = Mesh(square, up, halves)
    for x in range(-reach, reach):
        for y in range(-reach, reach):
            tiles[(x + y) % 2].append(tile.moved(x, y))
    return Model((Part(merged(tiles[0])), Part(merged(tiles[1]), _TILES[1])))
