"""A camera that stands anywhere: what it shows, where points come to lie in its picture, where it has to stand.

Conventions: points are (n, 3) in metres in the world frame; pixels are (n, 2), x to the right and y down from the
upper left corner.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any, Final

import numpy as np
from numpy.typing import NDArray

from dcg_torch.simulator.client import Client
from dcg_torch.simulator.engine import pybullet
from dcg_torch.types.arrays import Ints, Points

Pixels = NDArray[np.uint8]
Box = tuple[int, int, int, int]  # left, top, right, bottom in pixels, the last two not included

HAZE: Final = (225, 225, 220)  # where the floor ends
_AMBIENT, _DIFFUSE, _SPECULAR = 0.55, 0.5, 0.05  # of the light, as shares of a paint
_NEAREST: Final = 8.0  # metres from a fitted camera to the nearest point
_FILLED: Final = 0.86  # share of the picture's width and height that the points may take


@dataclass(frozen=True, slots=True)
class View:
    """A camera at `eye` that looks along `forward`; `size` (width, height) in pixels, `fov` vertical in radians.

    Only what is `near` to `far` metres away is shown.
    """

    eye: Points
    forward: Points
    fov: float
    size: tuple[int, int]
    near: float = 0.1
    far: float = 60.0

    @property
    def axes(self) -> tuple[Points, Points]:
        """Unit vectors to the right and upwards in the picture."""
        right = np.cross(self.forward, [0.0, 0.0, 1.0])
        right = right / np.linalg.norm(right)
        return right, np.cross(right, self.forward)

    def project(self, points: Points) -> Points:
        """World points (n, 3) to pixels (n, 2)."""
        right, up = self.axes
        offset = points - self.eye
        scale = self.size[1] / 2 / math.tan(self.fov / 2) / (offset @ self.forward)
        return np.stack([self.size[0] / 2 + scale * (offset @ right), self.size[1] / 2 - scale * (offset @ up)], axis=1)

    def outline(self, points: Points) -> list[tuple[float, float]]:
        """World points (n, 3) as the pixels that a drawing takes."""
        return [(float(x), float(y)) for x, y in self.project(points)]

    def render(self, client: Client, box: Box | None = None) -> tuple[Pixels, Ints]:
        """Colours (h, w, 3) and body ids (h, w), -1 where there is nothing; of the whole picture or a part of it.

        Shadows are left out: they triple the time, and the renderer's end in the middle of a large floor.
        """
        colors, mask = self._shot(client, box or (0, 0, *self.size), self._light.tolist())
        image = np.array(colors, dtype=np.uint8).reshape(*mask.shape, 4)[..., :3]
        np.copyto(image, np.array(HAZE, dtype=np.uint8), where=(mask < 0)[..., None])
        return image, mask

    def lit(self, paint: tuple[float, float, float], normal: tuple[float, float, float]) -> list[int]:
        """What `render` makes of a paint (each part in [0, 1]) on a face with this unit normal, in bytes."""
        light = self._light / np.linalg.norm(self._light)
        along = float(light @ normal)
        mirrored = max(0.0, 2.0 * along * normal[2] - float(light[2]))
        share = _AMBIENT + _DIFFUSE * max(0.0, along) + _SPECULAR * mirrored**2
        return [min(255, int(share * int(255 * part))) for part in paint]

    @property
    def _light(self) -> Points:
        """Where it comes from: over the left shoulder."""
        right, up = self.axes
        return up - 0.6 * right - 0.9 * self.forward

    def mask(self, client: Client) -> Ints:
        """Body ids (h, w), -1 where there is nothing: those of `render`, for less time."""
        return self._shot(client, (0, 0, *self.size), [0.0, 0.0, 1.0])[1]

    def _shot(self, client: Client, box: Box, light: list[float]) -> tuple[Any, Ints]:
        """Colours as PyBullet gives them, and body ids (h, w); `light` is where it comes from."""
        width, height = self.size
        left, top, right, bottom = box
        pixel = 2 * self.near * math.tan(self.fov / 2) / height  # on the near plane, metres
        across, down = right - left, bottom - top
        _, _, colors, _, bodies = pybullet.getCameraImage(
            across,
            down,
            pybullet.computeViewMatrix(self.eye.tolist(), (self.eye + self.forward).tolist(), [0.0, 0.0, 1.0]),
            pybullet.computeProjectionMatrix(
                (left - width / 2) * pixel,
                (right - width / 2) * pixel,
                (height / 2 - bottom) * pixel,
                (height / 2 - top) * pixel,
                self.near,
                self.far,
            ),
            lightDirection=light,
            lightAmbientCoeff=_AMBIENT,
            lightDiffuseCoeff=_DIFFUSE,
            lightSpecularCoeff=_SPECULAR,
            shadow=0,
            renderer=pybullet.ER_TINY_RENDERER,  # the same pixels with and without a window
            physicsClientId=client.id,
        )
        return colors, np.asarray(bodies, dtype=np.int64).reshape(down, across)


def fitting_view(points: Points, forward: Points, fov: float, size: tuple[int, int]) -> View:
    """The nearest camera with this direction that has all points (n, 3) within the middle 86 % of the picture.

    In camera coordinates (a right, b up, c forward) a point is inside when |a - x| <= t (c - z): the largest z
    has a closed form, and so have the x and y in the middle of what is then left.
    """
    right, up = View(np.zeros(3), forward, fov, size).axes
    depth = points @ forward
    tangents = _FILLED * math.tan(fov / 2) * np.array([size[0] / size[1], 1.0])
    across = [points @ axis for axis in (right, up)]
    low = [(a - t * depth).max() for a, t in zip(across, tangents, strict=True)]
    high = [(a + t * depth).min() for a, t in zip(across, tangents, strict=True)]
    limits = [(h - w) / (2 * t) for w, h, t in zip(low, high, tangents, strict=True)]
    z = min(*limits, depth.min() - _NEAREST)
    x, y = ((w + h) / 2 for w, h in zip(low, high, strict=True))  # z drops out of the middle
    return View(x * right + y * up + z * forward, forward, fov, size)


def direction(yaw: float, down: float) -> Points:
    """(3,) the unit vector of a camera that looks along `yaw` and `down` radians below the horizon."""
    return np.array([math.cos(down) * math.cos(yaw), math.cos(down) * math.sin(yaw), -math.sin(down)])


def circle(position: tuple[float, float], radius: float) -> Points:
    """A closed circle on the floor as points (n, 3)."""
    return sector(position, radius, 0.0, math.tau)


def sector(position: tuple[float, float], radius: float, start: float, end: float) -> Points:
    """An arc on the floor about `position` from angle `start` to `end` (radians, both included) as points (n, 3)."""
    angles = np.linspace(start, end, max(3, round(abs(end - start) / math.radians(5.0)) + 1))
    x, y = position[0] + radius * np.cos(angles), position[1] + radius * np.sin(angles)
    return np.stack([x, y, np.zeros_like(angles)], axis=1)
