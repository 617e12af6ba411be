"""Pictures of whole worlds with one object highlighted, to ask people how they would name it (as the paper's Fig. 5).

The camera stands behind the robot and above it, so that left and right in the picture are the robot's own. The
highlighted object has a ring on the floor, an outline and an arrow above it, and is shown once more in a close-up.
"""

from __future__ import annotations

import contextlib
import itertools
import math
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Final

import numpy as np
import pybullet
from numpy.typing import NDArray
from PIL import Image, ImageDraw, ImageFilter

from dcg_torch.simulator.bodies import Model, Part, add_model, add_object, extent, footprint
from dcg_torch.simulator.bodies.meshes import Mesh, merged
from dcg_torch.symbols import Pose
from dcg_torch.world.files import World, WorldObject

Pixels = NDArray[np.uint8]
AddRobot = Callable[[int, Pose], int]

_ROBOT: Final = Path(__file__).parent / "models" / "robot.urdf"
HIGHLIGHT: Final = (255, 196, 0)
_RIM: Final = (60, 40, 0)  # a dark edge that keeps the highlight visible on a light floor
_HAZE: Final = (225, 225, 220)  # where the floor ends
_OVERSAMPLING: Final = 2
_ELEVATION: Final = math.radians(36.0)
_FIELD_OF_VIEW: Final = math.radians(18.0)  # vertical; narrow, so that upright things stay upright at the edges
_NEAREST: Final = 8.0  # m, of the camera to the nearest object


def world_screenshot(
    world: World, highlight: str | None = None, size: tuple[int, int] = (640, 480), add_robot: AddRobot | None = None
) -> Pixels:
    """The world as a person would be shown it, uint8 of shape (height, width, 3).

    Args:
        world: what to show.
        highlight: id of the object to point at, or None for the bare world.
        size: (width, height) in pixels.
        add_robot: puts a robot into the client at a pose and returns its body; None takes the one that drives.

    Raises:
        ValueError: `highlight` is no object of this world, or one of its types has no body.
    """
    with _rendered(world, size, add_robot) as scene:
        return scene.picture(highlight)


def save_pair_screenshots(
    worlds: Sequence[World], directory: Path, size: tuple[int, int] = (640, 480), add_robot: AddRobot | None = None
) -> list[Path]:
    """Write `<world>-<object id>.png` for every object of every world; a world is rendered once for all of its own."""
    directory.mkdir(parents=True, exist_ok=True)
    paths = []
    for world in worlds:
        with _rendered(world, size, add_robot) as scene:
            for item in world.objects:
                path = directory / f"{world.name}-{item.id}.png"
                Image.fromarray(scene.picture(item.id)).save(path)
                paths.append(path)
    return paths


@dataclass(frozen=True, slots=True)
class _View:
    """A camera at `eye` that looks along `forward`; `size` (width, height) in pixels, `fov` vertical in radians."""

    eye: np.ndarray
    forward: np.ndarray
    fov: float
    size: tuple[int, int]
    near: float = 0.1

    @property
    def axes(self) -> tuple[np.ndarray, np.ndarray]:
        """Unit vectors to the right and upwards in the picture."""
        right = np.cross(self.forward, [0.0, 0.0, 1.0])
        right = right / np.linalg.norm(right)
        return right, np.cross(right, self.forward)

    def project(self, points: np.ndarray) -> np.ndarray:
        """World points (n, 3) to pixels (n, 2), x to the right and y down."""
        right, up = self.axes
        offset = points - self.eye
        scale = self.size[1] / 2 / math.tan(self.fov / 2) / (offset @ self.forward)
        return np.stack([self.size[0] / 2 + scale * (offset @ right), self.size[1] / 2 - scale * (offset @ up)], axis=1)

    def render(self, client: int) -> tuple[Pixels, NDArray[np.int64]]:
        """Colours (h, w, 3) and body ids (h, w), -1 where there is nothing."""
        width, height = self.size
        right, up = self.axes
        light = up - 0.6 * right - 0.9 * self.forward  # over the left shoulder
        _, _, colors, _, bodies = pybullet.getCameraImage(
            width,
            height,
            pybullet.computeViewMatrix(self.eye.tolist(), (self.eye + self.forward).tolist(), [0.0, 0.0, 1.0]),
            pybullet.computeProjectionMatrixFOV(math.degrees(self.fov), width / height, self.near, 60.0),
            lightDirection=light.tolist(),
            lightAmbientCoeff=0.55,
            lightDiffuseCoeff=0.5,
            lightSpecularCoeff=0.05,
            shadow=0,  # the renderer's own end in the middle of a floor this large
            renderer=pybullet.ER_TINY_RENDERER,
            physicsClientId=client,
        )
        image = np.array(colors, dtype=np.uint8).reshape(height, width, 4)[..., :3]
        return image, np.asarray(bodies, dtype=np.int64).reshape(height, width)


def _fitting_view(points: np.ndarray, forward: np.ndarray, fov: float, size: tuple[int, int]) -> _View:
    """The nearest camera with this direction that has all points (n, 3) within the middle 86 % of the picture.

    In camera coordinates (a right, b up, c forward) a point is inside when |a - x| <= t (c - z): the largest z
    has a closed form, and so have the x and y in the middle of what is then left.
    """
    right, up = _View(np.zeros(3), forward, fov, size).axes
    depth = points @ forward
    tangents = 0.86 * math.tan(fov / 2) * np.array([size[0] / size[1], 1.0])
    across = [points @ axis for axis in (right, up)]
    low = [(a - t * depth).max() for a, t in zip(across, tangents, strict=True)]
    high = [(a + t * depth).min() for a, t in zip(across, tangents, strict=True)]
    limits = [(h - w) / (2 * t) for w, h, t in zip(low, high, tangents, strict=True)]
    z = min(*limits, depth.min() - _NEAREST)
    x, y = ((w + h) / 2 for w, h in zip(low, high, strict=True))  # z drops out of the middle
    return _View(x * right + y * up + z * forward, forward, fov, size)


class _Scene:
    """One world in one client, rendered once; `picture` adds the highlight of one object."""

    def __init__(self, client: int, world: World, size: tuple[int, int], add_robot: AddRobot) -> None:
        self._client = client
        self._world = world
        self._size = (size[0] * _OVERSAMPLING, size[1] * _OVERSAMPLING)
        self._floor = add_model(client, _floor(world), (0.89, 0.89, 0.87), (0.0, 0.0))
        self._bodies = {o.id: add_object(client, o.type, o.color, o.position, o.yaw) for o in world.objects}
        add_robot(client, world.start)
        yaw = world.start.yaw
        forward = np.array(
            [math.cos(_ELEVATION) * math.cos(yaw), math.cos(_ELEVATION) * math.sin(yaw), -math.sin(_ELEVATION)]
        )
        corners = [_corners(o.position, footprint(o.type), extent(o.type)[2]) for o in world.objects]
        corners.append(_corners((world.start.x, world.start.y), 0.2, 0.4))
        self._view = _fitting_view(np.concatenate(corners), forward, _FIELD_OF_VIEW, self._size)
        self._image, self._mask = self._view.render(client)
        self._image[self._mask < 0] = _HAZE
        self._ground(world)

    def _ground(self, world: World) -> None:
        """Soft shadows where things touch the floor, without which they seem to float."""
        shade = Image.new("L", self._size)
        draw = ImageDraw.Draw(shade)
        for position, radius in (
            *((o.position, footprint(o.type)) for o in world.objects),
            ((world.start.x, world.start.y), 0.19),
        ):
            draw.polygon(self._circle(position, 0.8 * radius + 0.03), fill=150)
        soft = np.asarray(shade.filter(ImageFilter.GaussianBlur(self._size[1] / 160)), dtype=float) / 255
        dark = 1.0 - soft * (self._mask == self._floor)
        self._image = (self._image * dark[..., None]).astype(np.uint8)

    def picture(self, highlight: str | None) -> Pixels:
        image = Image.fromarray(self._image)
        if highlight is not None:
            found = [o for o in self._world.objects if o.id == highlight]
            if not found:
                raise ValueError(
                    f"world {self._world.name!r} has no object {highlight!r} to highlight; "
                    f"it has {', '.join(self._bodies)}"
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
        on_floor = Image.fromarray(((self._mask == self._floor) | (self._mask < 0)).astype(np.uint8) * 255)
        for layer, color in ((rim, _RIM), (ring, HIGHLIGHT)):
            image.paste(color, mask=Image.composite(layer, Image.new("L", image.size), on_floor))
        self._outline(image, item, unit)
        self._arrow(image, item, unit)
        self._close_up(image, item, unit)
        return image

    def _outline(self, image: Image.Image, item: WorldObject, unit: float) -> None:
        width = 2 * round(unit) + 1
        shape = Image.fromarray((self._mask == self._bodies[item.id]).astype(np.uint8) * 255)
        place = shape.getbbox()
        if place is None:  # hidden altogether
            return
        left, top, right, bottom = place
        around = (left - width, top - width, right + width, bottom + width)
        inner = shape.crop(around)
        outer = inner.filter(ImageFilter.MaxFilter(width))
        image.paste(HIGHLIGHT, around[:2], Image.composite(Image.new("L", inner.size), outer, inner))

    def _circle(self, position: tuple[float, float], radius: float) -> list[tuple[float, float]]:
        angles = np.linspace(0.0, math.tau, 73)
        points = np.stack([np.cos(angles) * radius, np.sin(angles) * radius, np.zeros_like(angles)], axis=1)
        return [(x, y) for x, y in self._view.project(points + np.array([*position, 0.0]))]

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
        shown = (self._mask >= 0) & (self._mask != self._floor)
        kept_free = [*self._arrow_outline(item, unit), *self._circle(item.position, footprint(item.type) + 0.24)]

        def hidden(place: tuple[int, int]) -> tuple[bool, int]:
            x, y = place
            covers = any(x <= a <= x + framed and y <= b <= y + framed for a, b in kept_free)
            return covers, int(shown[y : y + framed, x : x + framed].sum())

        x, y = min(places, key=hidden)
        picture, mask = self._near_view(item, side).render(self._client)
        picture[mask < 0] = _HAZE
        ImageDraw.Draw(image).rectangle((x, y, x + framed - 1, y + framed - 1), fill=HIGHLIGHT)
        image.paste(Image.fromarray(picture), (x + margin, y + margin))

    def _near_view(self, item: WorldObject, side: int) -> _View:
        """From about where the main camera is, but never straight at the front, a side or the back."""
        from_camera = math.atan2(*(self._view.eye[:2] - np.array(item.position))[::-1])
        oblique = [item.yaw + sign * turn for sign in (1, -1) for turn in (math.radians(50), math.radians(125))]
        azimuth = min(oblique, key=lambda angle: abs(math.remainder(angle - from_camera, math.tau)))
        down = math.radians(22.0)
        forward = -np.array([math.cos(down) * math.cos(azimuth), math.cos(down) * math.sin(azimuth), math.sin(down)])
        middle = np.array([*item.position, extent(item.type)[2] / 2])
        distance = 1.9
        # what stands before the object is cut away by the near plane
        return _View(middle - distance * forward, forward, math.radians(24.0), (side, side), near=distance - 0.45)


@contextlib.contextmanager
def _rendered(world: World, size: tuple[int, int], add_robot: AddRobot | None) -> Iterator[_Scene]:
    client = pybullet.connect(pybullet.DIRECT)
    try:
        yield _Scene(client, world, size, add_robot or _robot)
    finally:
        pybullet.disconnect(client)


def _corners(position: tuple[float, float], radius: float, height: float) -> np.ndarray:
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
    return Model((Part(merged(tiles[0])), Part(merged(tiles[1]), (0.85, 0.85, 0.83))))


def _robot(client: int, pose: Pose) -> int:
    turn = pybullet.getQuaternionFromEuler([0.0, 0.0, pose.yaw])
    return int(pybullet.loadURDF(str(_ROBOT), [pose.x, pose.y, 0.0], turn, physicsClientId=client))
