"""Bodies as binary glTF 2.0, for the page's 3-D scene.

Conventions: metres, z up, as everywhere here; glTF itself has y up, but the scene adds a file's vertices as they are.
"""

from __future__ import annotations

import json
import struct
from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

RGB = tuple[float, float, float]
_FLOAT, _INTEGER = 5126, 5125  # component types of the format
_LINES, _TRIANGLES = 1, 4  # what indices join
_JSON, _BINARY = 0x4E4F534A, 0x004E4942  # chunk types


class Shape:
    """One mesh in one colour: vertices and normals (n, 3), the colour in [0, 1] as on the screen.

    `indices` of vertices are triangles (m, 3), or the ends of lines (m, 2).
    """

    def __init__(self, vertices: NDArray[Any], normals: NDArray[Any], indices: NDArray[Any], color: RGB) -> None:
        self.vertices = np.asarray(vertices, dtype="<f4")
        self.normals = np.asarray(normals, dtype="<f4")
        self.mode = _LINES if np.shape(indices)[1] == 2 else _TRIANGLES
        self.indices = np.asarray(indices, dtype="<u4").reshape(-1)
        self.color = color


def glb(shapes: Sequence[Shape]) -> bytes:
    """The shapes as one file."""
    blob = b""
    views: list[dict[str, Any]] = []
    accessors: list[dict[str, Any]] = []
    primitives = []

    def add(values: NDArray[Any], component: int, kind: str, **more: Any) -> int:
        nonlocal blob
        views.append({"buffer": 0, "byteOffset": len(blob), "byteLength": values.nbytes})
        blob += values.tobytes()
        accessors.append({"bufferView": len(views) - 1, "componentType": component, "count": len(values), "type": kind})
        accessors[-1].update(more)
        return len(accessors) - 1

    for number, shape in enumerate(shapes):
        bounds = {"min": shape.vertices.min(axis=0).tolist(), "max": shape.vertices.max(axis=0).tolist()}
        attributes = {
            "POSITION": add(shape.vertices, _FLOAT, "VEC3", **bounds),
            "NORMAL": add(shape.normals, _FLOAT, "VEC3"),
        }
        indices = add(shape.indices, _INTEGER, "SCALAR")
        primitives.append({"attributes": attributes, "indices": indices, "material": number, "mode": shape.mode})
    document = {
        "asset": {"version": "2.0"},
        "scene": 0,
        "scenes": [{"nodes": [0]}],
        "nodes": [{"mesh": 0}],
        "meshes": [{"primitives": primitives}],
        "materials": [_material(shape.color) for shape in shapes],
        "buffers": [{"byteLength": len(blob)}],
        "bufferViews": views,
        "accessors": accessors,
    }
    chunks = _chunk(_JSON, json.dumps(document).encode(), b" ") + _chunk(_BINARY, blob, b"\0")
    return struct.pack("<4sII", b"glTF", 2, 12 + len(chunks)) + chunks


def _material(color: RGB) -> dict[str, Any]:
    linear = [c / 12.92 if c <= 0.04045 else ((c + 0.055) / 1.055) ** 2.4 for c in color]
    return {"pbrMetallicRoughness": {"baseColorFactor": [*linear, 1.0], "metallicFactor": 0, "roughnessFactor": 0.8}}


def _chunk(kind: int, content: bytes, filler: bytes) -> bytes:
    content += filler * (-len(content) % 4)
    return struct.pack("<II", len(content), kind) + content
