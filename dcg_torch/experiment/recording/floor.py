"""The left panel: the world from above and behind the robot's start, with what the robot sees, means and did."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Final

import numpy as np
from PIL import Image, ImageChops, ImageDraw

from dcg_torch.experiment.recording import paint
from dcg_torch.experiment.recording.recorder import RecordedCommand
from dcg_torch.experiment.recording.wording import label
from dcg_torch.simulator.bodies import extent, footprint
from dcg_torch.simulator.camera import Camera
from dcg_torch.simulator.stage import ROBOT_HEIGHT, ROBOT_RADIUS, Stage
from dcg_torch.simulator.view import Box, circle, sector
from dcg_torch.types import Pose
from dcg_torch.types.arrays import Points

_OVERSAMPLING: Final = 2
_DOWN: Final = math.radians(50.0)
_FAN: Final = 4.5  # metres of the field of view that are drawn
_VIEW: Final = (120, 175, 255)


class FloorPanel:
    """Draws one command; what doesn't move is rendered once.

    Args:
        stage: the command's world.
        camera: whose field of view is drawn.
        size: (width, height) in pixels.
    """

    def __init__(self, stage: Stage, recorded: RecordedCommand, camera: Camera, size: tuple[int, int]) -> None:
        self._stage, self._recorded, self._camera = stage, recorded, camera
        places = [moment.pose for moment in recorded.moments]
        self._view = stage.overview((size[0] * _OVERSAMPLING, size[1] * _OVERSAMPLING), _DOWN, places)
        stage.put(None)
        image, mask = stage.render(self._view)
        self._still = Image.fromarray(image)
        self._bare = Image.fromarray((mask == stage.floor).astype(np.uint8) * 255)

    def draw(self, at: int) -> Image.Image:
        """The panel at a moment of the command."""
        moment = self._recorded.moments[at]
        image, floor = self._with_robot(moment.pose)
        robot = circle((moment.pose.x, moment.pose.y), ROBOT_RADIUS)
        self._stain(image, floor, [self._sector(moment.pose)], _VIEW, 95)
        self._stain(image, floor, [robot], (0, 0, 0), 50)
        way = np.array([(m.pose.x, m.pose.y, 0.0) for m in self._recorded.moments[: at + 1]])
        self._stain(image, floor, [way], paint.WAY, line=7)
        self._ring(image, floor, at)
        small = image.reduce(_OVERSAMPLING)
        self._write(small, at)
        return small

    def _with_robot(self, pose: Pose) -> tuple[Image.Image, Image.Image]:
        """The picture with the robot standing at `pose`, and the mask of the floor that is visible."""
        self._stage.put(pose)
        left, top, right, bottom = box = self._around(pose)
        part, bodies = self._view.render(self._stage.client, box)
        robot = Image.fromarray((bodies == self._stage.robot).astype(np.uint8) * 255)
        image, floor = self._still.copy(), self._bare.copy()
        image.paste(Image.fromarray(part), (left, top), robot)
        floor.paste(0, (left, top, right, bottom), robot)
        return image, floor

    def _around(self, pose: Pose) -> Box:
        """The pixels that the robot may take at `pose`."""
        ring = circle((pose.x, pose.y), ROBOT_RADIUS * 1.1)
        corners = self._view.project(np.concatenate([ring, ring + np.array([0.0, 0.0, 1.05 * ROBOT_HEIGHT])]))
        (left, top), (right, bottom) = (
            np.floor(corners.min(axis=0)).astype(int),
            np.ceil(corners.max(axis=0)).astype(int),
        )
        width, height = self._view.size
        return max(0, int(left)), max(0, int(top)), min(width, int(right)), min(height, int(bottom))

    def _sector(self, pose: Pose) -> Points:
        half = self._camera.field_of_view / 2
        x, y, _ = self._camera.eye(pose)
        rim = sector((x, y), _FAN, pose.yaw - half, pose.yaw + half)
        return np.concatenate([[[x, y, 0.0]], rim])

    def _stain(
        self,
        image: Image.Image,
        floor: Image.Image,
        shapes: Sequence[Points],
        color: paint.RGB,
        strength: int = 255,
        line: int = 0,
    ) -> None:
        """Colour what is between the shapes on the floor, or a line along them; `strength` 255 covers the floor."""
        outlines = [self._view.project(shape) for shape in shapes]
        every = np.concatenate(outlines)
        size = np.array(image.size)
        low = np.clip(np.floor(every.min(axis=0)) - line, 0, size).astype(int)
        high = np.clip(np.ceil(every.max(axis=0)) + line + 1, 0, size).astype(int)
        if (low >= high).any():
            return
        left, top, right, bottom = box = (int(low[0]), int(low[1]), int(high[0]), int(high[1]))
        layer = Image.new("L", (right - left, bottom - top))
        draw = ImageDraw.Draw(layer)
        for k, outline in enumerate(outlines):
            points = [(float(x), float(y)) for x, y in outline - low]
            if line:
                draw.line(points, fill=strength, width=line, joint="curve")
            else:
                draw.polygon(points, fill=0 if k % 2 else strength)
        image.paste(color, (left, top), ImageChops.darker(layer, floor.crop(box)))

    def _ring(self, image: Image.Image, floor: Image.Image, at: int) -> None:
        """Round the object that the command is taken to mean; green or red in the end."""
        moment = self._recorded.moments[at]
        solution = self._recorded.looks[moment.looks - 1].solution if moment.looks else None
        if solution is None or solution.object is None or solution.object.hypothetical:
            return
        color = paint.CHOICE
        if at == len(self._recorded.moments) - 1 and not solution.inverted:
            color = paint.RIGHT if self._recorded.row.correct else paint.WRONG
        (item,) = [o for o in self._stage.world.objects if o.id == solution.object.id]
        radius = footprint(item.type)
        for wider, filled in ((0.025, paint.RIM), (0.0, color)):
            rings = [circle(item.position, r) for r in (radius + 0.19 + wider, radius + 0.09 - wider)]
            self._stain(image, floor, rings, filled)

    def _write(self, image: Image.Image, at: int) -> None:
        """Names at the objects, an arrow over the one that was meant, the robot's guess over the robot."""
        draw = ImageDraw.Draw(image)
        moment = self._recorded.moments[at]
        look = self._recorded.looks[moment.looks - 1] if moment.looks else None
        letters = paint.font(12)
        for item in self._stage.world.objects:
            text, seen = label(item, look)
            lines = text.splitlines()
            rim = self._view.project(circle(item.position, footprint(item.type) + 0.2)) / _OVERSAMPLING
            foot, below = float(rim[:, 0].mean()), min(float(rim[:, 1].max()), image.height - 15 * len(lines) - 7)
            for k, line in enumerate(lines):
                half = letters.getlength(line) / 2 + 4
                x = min(max(foot, half), image.width - half)
                draw.text(
                    (x, below + 9 + 15 * k),
                    line,
                    font=letters,
                    anchor="mm",
                    fill=paint.INK if seen else paint.GREY,
                    stroke_width=2,
                    stroke_fill=paint.PAPER,
                )
            (above,) = self._view.project(np.array([[*item.position, extent(item.type)[2]]])) / _OVERSAMPLING
            if item.id == self._recorded.row.target:
                paint.chip(draw, above[0], above[1] - 4, "meant", paint.MEANT, paint.PAPER)
        guess = look.solution.object if look else None
        if guess is not None and guess.hypothetical:
            x, y = self._view.project(np.array([[moment.pose.x, moment.pose.y, ROBOT_HEIGHT]]))[0] / _OVERSAMPLING
            name = guess.type if guess.known else "unknown thing"
            paint.chip(draw, x, y - 3, f"{name}: where?", paint.CHOICE, paint.INK)
