"""What the page's objects and its robot look like: the simulator's own bodies."""

from __future__ import annotations

import functools
import math
from pathlib import Path
from xml.etree import ElementTree

import numpy as np

import dcg_torch.simulator
from dcg_torch.apps.talk.gltf import Shape, glb
from dcg_torch.simulator.bodies import Model, Part, extent, footprint, registered, rgb
from dcg_torch.simulator.bodies.looks import model
from dcg_torch.simulator.bodies.meshes import Mesh, box, lathed

_MODELS = Path(dcg_torch.simulator.__file__).parent / "models"
FLOOR = 40
"""Metres of the floor that has lines."""
_PIECE = 4  # metres
_STAND_IN = 0.3  # metres: a cube of this size stands for a type without a body


@functools.lru_cache(maxsize=512)
def object_file(type_: str, color: str) -> bytes:
    """An object of a type and colour as binary glTF; a cube stands for a type that the simulator has no body for."""
    return _file(_model(type_), _color(color))


@functools.cache
def robot_file() -> bytes:
    """The robot as binary glTF, facing x."""
    return _file(_robot(), (0.5, 0.5, 0.5))


@functools.cache
def floor_file() -> bytes:
    """The lines of a square of `FLOOR` metres about the origin, a metre apart, as binary glTF."""
    at = np.arange(-FLOOR / 2, FLOOR / 2 + 1)
    # in short pieces, since some browsers leave out a line that passes the viewer
    pieces = [(a, b, b + _PIECE) for a in at for b in at[:-1:_PIECE]]
    ends = [[(a, b, 0), (a, c, 0), (b, a, 0), (c, a, 0)] for a, b, c in pieces]
    lines = np.array(ends, dtype=float).reshape(-1, 3)
    up = np.tile([0.0, 0.0, 1.0], (len(lines), 1))
    return glb([Shape(lines, up, np.arange(len(lines)).reshape(-1, 2), (0.80, 0.79, 0.77))])


@functools.lru_cache(maxsize=512)
def radius_of(type_: str) -> float:
    """Metres of the floor that an object of this type takes, from its foot."""
    return footprint(type_) if type_ in registered() else _STAND_IN / math.sqrt(2)


@functools.lru_cache(maxsize=512)
def height_of(type_: str) -> float:
    """Metres that an object of this type stands tall."""
    return extent(type_)[2] if type_ in registered() else _STAND_IN


def _color(name: str) -> tuple[float, float, float]:
    try:
        return rgb(name)
    except ValueError:
        return (0.6, 0.6, 0.6)


def _model(type_: str) -> Model:
    if type_ in registered():
        return model(type_)
    return Model((Part(box(_STAND_IN, _STAND_IN, _STAND_IN)),))


def _file(looks: Model, color: tuple[float, float, float]) -> bytes:
    parts = [(part.mesh, color if part.paint is None else part.paint) for part in looks.by_paint()]
    return glb([Shape(mesh.vertices, mesh.normals, mesh.triangles, paint) for mesh, paint in parts])


def _robot() -> Model:
    """The robot of the physics, from the boxes and cylinders of its description; its wheels are hardly seen."""
    root = ElementTree.parse(_MODELS / "robot.urdf").getroot()
    paints = {m.get("name"): _numbers(m.find("color"), "rgba") for m in root.findall("material")}
    parts = []
    for visual in root.findall("link[@name='base']/visual"):
        material = visual.find("material")
        red, green, blue, _ = paints[material.get("name") if material is not None else None]
        mesh = _mesh(visual).moved(*_numbers(visual.find("origin"), "xyz"))
        parts.append(Part(mesh, (red, green, blue)))
    return Model(tuple(parts))


def _mesh(visual: ElementTree.Element) -> Mesh:
    """The box or cylinder of a visual, about its middle."""
    if (shape := visual.find("geometry/box")) is not None:
        x, y, z = _numbers(shape, "size")
        return box(x, y, z).moved(z=-z / 2)
    (radius,), (length,) = (_numbers(visual.find("geometry/cylinder"), name) for name in ("radius", "length"))
    return lathed([(radius, 0.0), (radius, length)]).moved(z=-length / 2)


def _numbers(element: ElementTree.Element | None, attribute: str) -> tuple[float, ...]:
    return tuple(map(float, (element.get(attribute, "0 0 0") if element is not None else "0 0 0").split()))
