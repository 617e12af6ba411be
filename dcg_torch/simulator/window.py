"""PyBullet's own window: no panels, the arena in the middle, the robot's field of view on the floor."""

from __future__ import annotations

import contextlib
import math
from collections.abc import Iterator

import numpy as np

from dcg_torch.simulator.bodies import footprint
from dcg_torch.simulator.camera import Camera
from dcg_torch.simulator.engine import pybullet
from dcg_torch.simulator.view import View, direction
from dcg_torch.world.files import World

OPTIONS = (
    "--width=1100 --height=760 --background_color_red=0.88 --background_color_green=0.88 --background_color_blue=0.86"
)
"""For `pybullet.connect`."""

_FAN = 3.0  # metres of the field of view that are drawn
_DOWN = math.radians(48.0)  # of the window's camera, below the horizon
_BLUE, _INK = (0.2, 0.45, 0.85), (0.15, 0.15, 0.17)
_PANELS = (
    pybullet.COV_ENABLE_GUI,
    pybullet.COV_ENABLE_KEYBOARD_SHORTCUTS,
    pybullet.COV_ENABLE_RGB_BUFFER_PREVIEW,
    pybullet.COV_ENABLE_DEPTH_BUFFER_PREVIEW,
    pybullet.COV_ENABLE_SEGMENTATION_MARK_PREVIEW,
)


class Window:
    """The window of a physics client that was connected with one."""

    def __init__(self, client: int) -> None:
        self._client = client
        self._text = -1
        self._place = (0.0, 0.0, 0.0)
        for panel in _PANELS:
            self._switch(panel, on=False)

    def _switch(self, what: int, *, on: bool) -> None:
        pybullet.configureDebugVisualizer(what, int(on), physicsClientId=self._client)

    @contextlib.contextmanager
    def still(self) -> Iterator[None]:
        """Draw nothing meanwhile: a world is there at once, and much sooner."""
        self._switch(pybullet.COV_ENABLE_RENDERING, on=False)
        try:
            yield
        finally:
            self._switch(pybullet.COV_ENABLE_RENDERING, on=True)

    def show(self, world: World, robot: int, camera: Camera) -> None:
        """Look at a world from behind and above its robot, and draw on the floor what the robot's camera covers."""
        self._text = -1
        places = np.array([(world.robot.x, world.robot.y), *(o.position for o in world.objects)])
        middle = (places.min(axis=0) + places.max(axis=0)) / 2
        radius = np.linalg.norm(places - middle, axis=1).max() + max(footprint(o.type) for o in world.objects)
        distance = max(3.0, 1.6 * float(radius))
        pybullet.resetDebugVisualizerCamera(
            distance,
            math.degrees(world.robot.yaw) - 90.0,  # at 0 it looks along +y
            -math.degrees(_DOWN),
            [*middle.tolist(), 0.0],
            physicsClientId=self._client,
        )
        view = View(np.zeros(3), direction(world.robot.yaw, _DOWN), 1.0, (1, 1))
        right, up = view.axes
        self._place = tuple((np.array([*middle, 0.0]) + distance * (0.44 * up - 0.72 * right)).tolist())
        # the window gives a link one colour, whatever the robot's description says
        pybullet.changeVisualShape(robot, -1, rgbaColor=[*_INK, 1.0], physicsClientId=self._client)
        half = camera.field_of_view / 2
        ends = [[_FAN * math.cos(side), _FAN * math.sin(side), 0.01] for side in np.linspace(-half, half, 9)]
        start = [camera.forward, 0.0, 0.01]
        for a, b in zip([start, *ends], [*ends, start], strict=True):
            pybullet.addUserDebugLine(
                a, b, _BLUE, lineWidth=3, parentObjectUniqueId=robot, physicsClientId=self._client
            )

    def say(self, text: str) -> None:
        """Write a line over the arena, in place of the last one."""
        if self._text >= 0:
            pybullet.removeUserDebugItem(self._text, physicsClientId=self._client)
        self._text = pybullet.addUserDebugText(
            text, self._place, textColorRGB=_INK, textSize=1.6, physicsClientId=self._client
        )
