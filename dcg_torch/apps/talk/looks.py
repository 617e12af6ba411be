"""What the page's objects and its robot look like: the simulator's own bodies."""

from __future__ import annotations

import functools
import json
import math
from pathlib import Path
from typing import Any
from xml.etree import ElementTree

import numpy as np

import dcg_torch.simulator
from dcg_torch.simulator.bodies import Model, Part, registered, rgb
from dcg_torch.simulator.bodies.colors import RGB
from dcg_torch.simulator.bodies.looks import model
from dcg_torch.simulator.bodies.meshes import Mesh, box, lathed
from dcg_torch.types.geometry import FIELD_OF_VIEW

_MODELS = Path(dcg_torch.simulator.__file__).parent / "models"
_FAN = 4.0  # metres of the field of view that are drawn
_STAND_IN = 0.3  # metres: a cube of this size stands for a type without a body


@functools.lru_cache(maxsize=512)
def object_looks(type_: str, color: str) -> str:
    """An object of a type and colour, as `body.js` reads it; a cube stands for a type that has no body."""
    return json.dumps(_parts(_model(type_), _color(color)))


@functools.cache
def robot_looks() -> str:
    """The robot, facing x, with its field of view on the floor before it."""
    edge = [FIELD_OF_VIEW * (k / 16 - 0.5) for k in range(17)]
    fan = np.array([(0.0, 0.0, 0.004), *((_FAN * math.cos(a), _FAN * math.sin(a), 0.004) for a in edge)])
    mesh = Mesh(fan, np.tile([0.0, 0.0, 1.0], (len(fan), 1)), np.array([(0, k, k + 1) for k in range(1, len(edge))]))
    return json.dumps([*_parts(_robot(), (0.5, 0.5, 0.5)), _part(mesh, (0.31, 0.56, 1.0), 0.28)])


def radius_of(type_: str) -> float:
    """Metres of the floor that an object of this type takes, from its foot."""
    return _model(type_).radius


def height_of(type_: str) -> float:
    """Metres that an object of this type stands tall."""
    return float(_model(type_).bounds[1][2])


def _color(name: str) -> RGB:
    try:
        return rgb(name)
    except ValueError:
        return (0.6, 0.6, 0.6)


@functools.lru_cache(maxsize=512)
def _model(type_: str) -> Model:
    return model(type_) if type_ in registered() else Model((Part(box(_STAND_IN, _STAND_IN, _STAND_IN)),))


def _parts(looks: Model, color: RGB) -> list[dict[str, Any]]:
    return [_part(part.mesh, color if part.paint is None else part.paint) for part in looks.by_paint()]


def _part(mesh: Mesh, color: RGB, opacity: float = 1.0) -> dict[str, Any]:
    """A mesh in one colour; all lists are flat, and lengths have tenths of a millimetre."""
    arrays = {"vertices": mesh.vertices, "normals": mesh.normals, "triangles": mesh.triangles}
    return {name: a.round(4).ravel().tolist() for name, a in arrays.items()} | {"color": color, "opacity": opacity}


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
