"""Triangle meshes made in code: boxes, lathed profiles, extruded outlines. Numpy only.

Every mesh is closed, wound counter-clockwise seen from outside, and has one unit normal per vertex that points
outwards; vertices are repeated along sharp edges, so that a renderer that interpolates normals keeps them sharp.
Lengths are metres, z is up, x is the front.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from dcg_torch.types.arrays import Floats, Ints

Point2 = tuple[float, float]
Point3 = tuple[float, float, float]

SEGMENTS = 28  # round enough in a picture of 640 x 480, few enough to load in a millisecond
CREASE = math.radians(40.0)  # sharper bends of an outline stay sharp edges


@dataclass(frozen=True, slots=True, eq=False)
class Mesh:
    """`vertices` and `normals` (n, 3), `triangles` (m, 3) of indices into them."""

    vertices: Floats
    normals: Floats
    triangles: Ints

    def moved(self, x: float = 0.0, y: float = 0.0, z: float = 0.0) -> Mesh:
        """The same mesh, shifted."""
        return Mesh(self.vertices + np.array([x, y, z]), self.normals, self.triangles)

    def pointing(self, direction: Point3) -> Mesh:
        """The same mesh, turned about the origin so that its +z axis points along `direction`."""
        up = np.asarray(direction, dtype=float)
        up = up / np.linalg.norm(up)
        helper = np.array([0.0, 0.0, 1.0]) if abs(up[2]) < 0.9 else np.array([1.0, 0.0, 0.0])
        side = np.cross(helper, up)
        side /= np.linalg.norm(side)
        return self._turned(np.stack([side, np.cross(up, side), up]))

    def turned(self, angle: float) -> Mesh:
        """The same mesh, turned about the z axis by `angle` radians, to the left seen from above."""
        c, s = math.cos(angle), math.sin(angle)
        return self._turned(np.array([[c, s, 0.0], [-s, c, 0.0], [0.0, 0.0, 1.0]]))

    def upright(self) -> Mesh:
        """The same mesh, turned so that its y points up and its z towards -y: an outline seen from the right side."""
        return self._turned(np.array([[1.0, 0.0, 0.0], [0.0, 0.0, 1.0], [0.0, -1.0, 0.0]]))

    def lying(self) -> Mesh:
        """The same mesh, turned so that its z points to the front, its x to the left and its y up."""
        return self._turned(np.array([[0.0, 1.0, 0.0], [0.0, 0.0, 1.0], [1.0, 0.0, 0.0]]))

    def _turned(self, images: Floats) -> Mesh:
        """`images` (3, 3): in its rows, what x, y and z become."""
        return Mesh(self.vertices @ images, self.normals @ images, self.triangles)


def merged(meshes: Sequence[Mesh]) -> Mesh:
    """All meshes as one."""
    offsets = np.cumsum([0, *(len(mesh.vertices) for mesh in meshes[:-1])])
    return Mesh(
        np.concatenate([mesh.vertices for mesh in meshes]),
        np.concatenate([mesh.normals for mesh in meshes]),
        np.concatenate([mesh.triangles + offset for mesh, offset in zip(meshes, offsets, strict=True)]),
    )


def box(x: float, y: float, z: float) -> Mesh:
    """A box of these full lengths, standing on z = 0 with its middle over the origin."""
    return extruded([(-x / 2, -y / 2), (x / 2, -y / 2), (x / 2, y / 2), (-x / 2, y / 2)], z)


def lathed(profile: Sequence[Point2], segments: int = SEGMENTS) -> Mesh:
    """The solid that a profile of (radius, height) points makes when it turns about the z axis.

    The profile runs from bottom to top; an end that is not on the axis is closed by a flat disc.
    """
    points = [*profile]
    if points[0][0] > 0:
        points.insert(0, (0.0, points[0][1]))
    if points[-1][0] > 0:
        points.append((0.0, points[-1][1]))
    ring = np.array(points)
    starts, ends, start_normals, end_normals = _edges(ring)
    angles = np.linspace(0.0, 2.0 * math.pi, segments, endpoint=False)
    directions = np.stack([np.cos(angles), np.sin(angles)], axis=1)

    def turned(flat: Floats) -> Floats:
        """(k, 2) points or normals of the profile -> (k, segments, 3)."""
        around = flat[:, None, :1] * directions[None]
        up = np.broadcast_to(flat[:, None, 1:], (*around.shape[:2], 1))
        return np.concatenate([around, up], axis=2)

    return _bands(turned(starts), turned(ends), turned(start_normals), turned(end_normals), closed=True)


def extruded(outline: Sequence[Point2], height: float) -> Mesh:
    """A prism over z = 0 .. `height` whose base is `outline`: counter-clockwise, and all seen from its middle."""
    ring = np.array([*outline, outline[0]])
    starts, ends, start_normals, end_normals = _edges(ring, closed=True)
    levels = np.array([0.0, height])

    def lifted(flat: Floats, heights: Floats) -> Floats:
        """(k, 2) -> (k, 2 levels, 3)."""
        plane = np.repeat(flat[:, None, :], 2, axis=1)
        return np.concatenate([plane, np.broadcast_to(heights[None, :, None], (*plane.shape[:2], 1))], axis=2)

    flat = np.zeros(2)
    # from the end of an edge to its start, so that the bands face outwards
    walls = _bands(
        lifted(ends, levels),
        lifted(starts, levels),
        lifted(end_normals, flat),
        lifted(start_normals, flat),
        closed=False,
    )
    corners = np.array(outline, dtype=float)
    count = len(corners)
    fan = np.array([[count, i, (i + 1) % count] for i in range(count)])
    caps = []
    for level, normal, triangles in ((0.0, -1.0, fan[:, ::-1]), (height, 1.0, fan)):
        plane = np.concatenate([corners, corners.mean(axis=0, keepdims=True)])
        vertices = np.concatenate([plane, np.full((count + 1, 1), level)], axis=1)
        caps.append(Mesh(vertices, np.tile([0.0, 0.0, normal], (count + 1, 1)), triangles))
    return merged([walls, *caps])


def arc(center: Point2, radius: float, start: float, end: float, steps: int = 8) -> list[Point2]:
    """Points on a circle from angle `start` to `end` (degrees, both included)."""
    angles = np.radians(np.linspace(start, end, steps + 1))
    return [(center[0] + radius * math.cos(a), center[1] + radius * math.sin(a)) for a in angles]


def rounded_rectangle(x: float, y: float, radius: float) -> list[Point2]:
    """The outline of an x by y rectangle about the origin, with rounded corners."""
    right, top = x / 2 - radius, y / 2 - radius
    corners = (((right, top), 0.0), ((-right, top), 90.0), ((-right, -top), 180.0), ((right, -top), 270.0))
    return [point for center, start in corners for point in arc(center, radius, start, start + 90.0, steps=5)]


def rod(start: Point3, end: Point3, radius: float, segments: int = 16) -> Mesh:
    """A round bar between two points, with rounded ends that reach `radius` beyond them."""
    along = np.subtract(end, start)
    length = float(np.linalg.norm(along))
    profile = [*arc((0.0, 0.0), radius, -90.0, 0.0, 5), *arc((0.0, length), radius, 0.0, 90.0, 5)]
    return lathed(_on_axis(profile), segments).pointing((along[0], along[1], along[2])).moved(*start)


def ball(radius: float, segments: int = SEGMENTS) -> Mesh:
    """A sphere standing on z = 0."""
    return lathed(_on_axis(arc((0.0, radius), radius, -90.0, 90.0, segments // 2)), segments)


def _on_axis(profile: list[Point2]) -> list[Point2]:
    """A profile whose ends are exactly on the axis, where rounding left them a hair off."""
    return [(0.0, profile[0][1]), *profile[1:-1], (0.0, profile[-1][1])]


def _edges(points: Floats, closed: bool = False) -> tuple[Floats, Floats, Floats, Floats]:
    """Starts, ends and outward normals at both, of the edges of a polyline that has its outside on the right.

    Normals of neighbouring edges are averaged where they meet in less than `CREASE`.
    """
    starts, ends = points[:-1], points[1:]
    along = ends - starts
    lengths = np.linalg.norm(along, axis=1)
    starts, ends, along = starts[lengths > 0], ends[lengths > 0], along[lengths > 0]
    normals = np.stack([along[:, 1], -along[:, 0]], axis=1) / lengths[lengths > 0, None]
    following = np.roll(normals, -1, axis=0)
    smooth = np.einsum("ij,ij->i", normals, following) > math.cos(CREASE)
    if not closed:
        smooth[-1] = False
    middle = normals + following
    middle /= np.maximum(np.linalg.norm(middle, axis=1, keepdims=True), 1e-12)
    end_normals = np.where(smooth[:, None], middle, normals)
    start_normals = np.where(np.roll(smooth, 1)[:, None], np.roll(middle, 1, axis=0), normals)
    return starts, ends, start_normals, end_normals


def _bands(low: Floats, high: Floats, low_normals: Floats, high_normals: Floats, *, closed: bool) -> Mesh:
    """One strip of quads per row between `low` and `high`, both (k, s, 3); `closed` joins the last to the first."""
    rows, columns, _ = low.shape
    vertices = np.stack([low, high], axis=1).reshape(-1, 3)
    normals = np.stack([low_normals, high_normals], axis=1).reshape(-1, 3)
    here = np.arange(columns if closed else columns - 1)
    there = (here + 1) % columns
    quad = np.concatenate(
        [np.stack([here, there, there + columns], 1), np.stack([here, there + columns, here + columns], 1)]
    )
    triangles = (quad[None] + (np.arange(rows) * 2 * columns)[:, None, None]).reshape(-1, 3)
    corners = vertices[triangles]
    area = np.linalg.norm(np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]), axis=1)
    return Mesh(vertices, normals, triangles[area > 1e-12])  # a point on the axis makes triangles without area
