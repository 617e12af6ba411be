"""Pictures of whole worlds with one object highlighted, to ask people how they would name it (as the paper's Fig. 5).

The camera stands behind the robot and above it, so that left and right in the picture are the robot's own. The
highlighted object has a ring on the floor, an outline and an arrow above it, and is shown once more in a close-up.
"""

from __future__ import annotations

import itertools
import math
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import Final

import numpy as np
from PIL import Image, ImageDraw, ImageFilter

from dcg_torch.simulator.bodies import extent, footprint
from dcg_torch.simulator.stage import Stage
from dcg_torch.simulator.view import Pixels, View, circle, direction
from dcg_torch.world.files import World, WorldObject

HIGHLIGHT: Final = (255, 196, 0)
_RIM: Final = (60, 40, 0)  # a dark edge that keeps the highlight visible on a light floor
_OVERSAMPLING: Final = 2
_ELEVATION: Final = math.radians(36.0)


def world_screenshot(world: World, highlight: str | None = None, size: tuple[int, int] = (640, 480)) -> Pixels:
    """The world as a person would be shown it, uint8 of shape (height, width, 3).

    Args:
        world: what to show.
        highlight: id of the object to point at, or None for the bare world.
        size: (width, height) in pixels.

    Raises:
        ValueError: `highlight` is no object of this world, or one of its types has no body.
    """
    with Stage(world) as stage:
        return _Screenshot(stage, size).picture(highlight)


def save_pair_screenshots(worlds: Sequence[World], directory: Path, size: tuple[int, int] = (640, 480)) -> list[Path]:
    """Write `<world>-<object id>.png` for every object of every world; a world is rendered once for all of its own."""
    directory.mkdir(parents=True, exist_ok=True)
    paths = []
    for world in worlds:
        for highlight, picture in pair_pictures(world, size):
            path = directory / f"{world.name}-{highlight}.png"
            Image.fromarray(picture).save(path)
            paths.append(path)
    return paths


def pair_pictures(world: World, size: tuple[int, int] = (640, 480)) -> Iterator[tuple[str, Pixels]]:
    """(object id, picture with it highlighted) for every object of a world, which is rendered once.

    Raises:
        ValueError: one of its types has no body.
    """
    with Stage(world) as stage:
        shot = _Screenshot(stage, size)
        for item in world.objects:
            yield item.id, shot.picture(item.id)


class _Screenshot:
    """One world, rendered once; `picture` adds the highlight of one object."""

    def __init__(self, stage: Stage, size: tuple[int, int]) -> None:
        self._stage = stage
        self._size = (size[0] * _OVERSAMPLING, size[1] * _OVERSAMPLING)
        self._view = stage.overview(self._size, _ELEVATION)
        self._image, self._mask = stage.render(self._view)

    def picture(self, highlight: str | None) -> Pixels:
        image = Image.fromarray(self._image)
        if highlight is not None:
            found = [o for o in self._stage.world.objects if o.id == highlight]
            if not found:
                raise ValueError(
                    f"world {self._stage.world.name!r} has no object {highlight!r} to highlight; "
                    f"it has {', '.join(self._stage.bodies)}"
                )
            image = self._pointed_at(image, found[0])
        return np.asarray(image.reduce(_OVERSAMPLING))

    def _pointed_at(self, image: Image.Image, item: WorldObject) -> Image.Image:
        unit = self._size[1] / 240  # line width
        radius = footprint(item.type)
        ring = Image.new("L", image.size)
        rim = Image.new("L", image.size)
        for layer, grow in ((rim, 0.02), (ring, 0.0)):
            draw = ImageDraw.Draw(layer)
            draw.polygon(self._circle(item.position, radius + 0.22 + grow), fill=255)
            draw.polygon(self._circle(item.position, radius + 0.12 - grow), fill=0)
        on_floor = Image.fromarray(((self._mask == self._stage.floor) | (self._mask < 0)).astype(np.uint8) * 255)
        for layer, color in ((rim, _RIM), (ring, HIGHLIGHT)):
            seen = Image.composite(layer, Image.new("L", image.size), on_floor)
            if (place := seen.getbbox()) is not None:  # a small part of the picture
                image.paste(color, place, seen.crop(place))
        self._outline(image, item, unit)
        self._arrow(image, item, unit)
        self._close_up(image, item, unit)
        return image

    def _outline(self, image: Image.Image, item: WorldObject, unit: float) -> None:
        width = 2 * round(unit) + 1
        shape = Image.fromarray((self._mask == self._stage.bodies[item.id]).astype(np.uint8) * 255)
        place = shape.getbbox()
        if place is None:  # hidden altogether
            return
        left, top, right, bottom = place
        around = (left - width, top - width, right + width, bottom + width)
        inner = shape.crop(around)
        outer = inner.filter(ImageFilter.MaxFilter(width))
        image.paste(HIGHLIGHT, around[:2], Image.composite(Image.new("L", inner.size), outer, inner))

    def _circle(self, position: tuple[float, float], radius: float) -> list[tuple[float, float]]:
        return self._view.outline(circle(position, radius))

    def _arrow(self, image: Image.Image, item: WorldObject, unit: float) -> None:
        points = self._arrow_outline(item, unit)
        draw = ImageDraw.Draw(image)
        draw.polygon(points, fill=HIGHLIGHT)
        draw.line([*points, points[0], points[1]], fill=_RIM, width=max(1, round(unit * 0.8)), joint="curve")

    def _arrow_outline(self, item: WorldObject, unit: float) -> list[tuple[float, float]]:
        ((x, y),) = self._view.project(np.array([[*item.position, extent(item.type)[2] + 0.08]]))
        outline = [(0, 0), (-7, -10), (-3, -10), (-3, -24), (3, -24), (3, -10), (7, -10)]
        return [(float(x + unit * a), float(y + unit * b)) for a, b in outline]

    def _close_up(self, image: Image.Image, item: WorldObject, unit: float) -> None:
        """Paste the object, seen from nearer, at the border where it hides least; a corner if one is free."""
        width, height = image.size
        side = round(0.30 * height)
        margin = round(2 * unit)
        framed = side + 2 * margin
        steps = (0.0, 1.0, 0.5, 0.25, 0.75)
        places = [
            (round(a * (width - framed)), round(b * (height - framed)))
            for a, b in sorted(itertools.product(steps, steps), key=lambda ab: sum(c not in (0.0, 1.0) for c in ab))
            if a in (0.0, 1.0) or b in (0.0, 1.0)
        ]
        shown = (self._mask >= 0) & (self._mask != self._stage.floor)
        kept_free = [*self._arrow_outline(item, unit), *self._circle(item.position, footprint(item.type) + 0.24)]

        def hidden(place: tuple[int, int]) -> tuple[bool, int]:
            x, y = place
            covers = any(x <= a <= x + framed and y <= b <= y + framed for a, b in kept_free)
            return covers, int(shown[y : y + framed, x : x + framed].sum())

        x, y = min(places, key=hidden)
        picture, _ = self._stage.unshaded(self._near_view(item, side))
        ImageDraw.Draw(image).rectangle((x, y, x + framed - 1, y + framed - 1), fill=HIGHLIGHT)
        image.paste(Image.fromarray(picture), (x + margin, y + margin))

    def _near_view(self, item: WorldObject, side: int) -> View:
        """From about where the main camera is, but never straight at the front, a side or the back."""
        from_camera = math.atan2(*(self._view.eye[:2] - np.array(item.position))[::-1])
        oblique = [item.yaw + sign * turn for sign in (1, -1) for turn in (math.radians(50), math.radians(125))]
        azimuth = min(oblique, key=lambda angle: abs(math.remainder(angle - from_camera, math.tau)))
        return _near(item, azimuth, side)


def _near(item: WorldObject, azimuth: float, side: int) -> View:
    """A square view of one object, from the side `azimuth` (radians) and a little above."""
    forward = direction(azimuth + math.pi, math.radians(22.0))
    middle = np.array([*item.position, extent(item.type)[2] / 2])
    distance = 1.9
    # what stands before the object is cut away by the near plane
    return View(middle - distance * forward, forward, math.radians(24.0), (side, side), near=distance - 0.45)
