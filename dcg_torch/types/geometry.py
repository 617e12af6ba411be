"""Plane geometry that several rooms share: the robot's frame, its field of view, segments among points.

Conventions: metres and radians, seen from above. In the robot's frame x is ahead and y to the left; a bearing is the
angle from the heading, left positive, in [-pi, pi]. Points are (n, 2) float64 arrays.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from itertools import chain

import numpy as np

from dcg_torch.types import Object, Percept, Pose
from dcg_torch.types.arrays import Bools, Floats

FIELD_OF_VIEW = math.radians(57.0)
"""Width of the robot's view: the Kinect, which is the paper's camera."""
NEXT_TO = 2.5
"""Metres between two feet within which people are taken to say that one thing stands next to the other."""


def positions(objects: Sequence[Object] | Sequence[Percept]) -> Floats:
    """(n, 3) where objects are; NaN where they are nowhere."""
    places = [_NOWHERE if o.position is None else o.position for o in objects]
    return np.fromiter(chain.from_iterable(places), np.float64, 3 * len(places)).reshape(-1, 3)


_NOWHERE = (math.nan,) * 3


def wrap_angle(angle: float) -> float:
    """The same direction as an angle in [-pi, pi] radians."""
    return math.remainder(angle, math.tau)


def wrap_angles(angles: Floats) -> Floats:
    """The same directions, of any shape, as angles in [-pi, pi) radians."""
    wrapped: Floats = (angles + math.pi) % math.tau - math.pi
    return wrapped


def to_robot_frame(robot: Pose, points: Floats) -> Floats:
    """World points (n, 2) in the robot's frame."""
    c, s = math.cos(robot.yaw), math.sin(robot.yaw)
    moved = points - np.array([robot.x, robot.y])
    seen: Floats = moved @ np.array([[c, -s], [s, c]])
    return seen


def from_robot_frame(robot: Pose, ahead: float, left: float) -> tuple[float, float]:
    """The world position of a point so far ahead of the robot and to its left."""
    c, s = math.cos(robot.yaw), math.sin(robot.yaw)
    return robot.x + c * ahead - s * left, robot.y + s * ahead + c * left


def bearing(robot: Pose, x: float, y: float) -> float:
    """The angle from the robot's heading to the world point (x, y)."""
    return wrap_angle(math.atan2(y - robot.y, x - robot.x) - robot.yaw)


def in_field_of_view(robot: Pose, x: float, y: float, view: float = FIELD_OF_VIEW) -> bool:
    """Whether the world point (x, y) is in a view of this width, radians."""
    return abs(bearing(robot, x, y)) < view / 2


def segment_distances(starts: Floats, ends: Floats, points: Floats) -> tuple[Floats, Floats]:
    """How near each of m segments comes to each of n points.

    Args:
        starts, ends: (m, 2); a segment may be a single point.
        points: (n, 2).

    Returns:
        The distances (m, n), and where on the line the point's foot is (m, n): 0 at the start, 1 at the end, outside
        [0, 1] beyond them.
    """
    along = (ends - starts)[:, None, :]
    to_point = points[None, :, :] - starts[:, None, :]
    squared = np.maximum((along**2).sum(-1), 1e-18)
    foot: Floats = (to_point * along).sum(-1) / squared
    distance: Floats = np.linalg.norm(to_point - np.clip(foot, 0.0, 1.0)[:, :, None] * along, axis=-1)
    return distance, foot


def segments_clear(starts: Floats, ends: Floats, centres: Floats, radii: Floats) -> Bools:
    """(m,) which segments stay outside every disc; worked through in pieces, so that memory stays small.

    Args:
        starts, ends: (m, 2).
        centres, radii: (n, 2) and (n,), of the discs.
    """
    clear = np.ones(len(starts), dtype=np.bool_)
    piece = max(1, min(_SEGMENTS, _PAIRS // max(1, len(centres))))
    for at in range(0, len(starts), piece):
        a, b = starts[at : at + piece], ends[at : at + piece]
        low, high = np.minimum(a, b).min(axis=0), np.maximum(a, b).max(axis=0)
        # only the discs that meet the box about these segments: neighbours in the list are mostly neighbours in place
        near = (np.abs(centres - (low + high) / 2) <= (high - low) / 2 + radii[:, None]).all(axis=1)
        distance, _ = segment_distances(a, b, centres[near])
        clear[at : at + piece] = (distance >= radii[near]).all(axis=1)
    return clear


_SEGMENTS, _PAIRS = 256, 50_000  # segments, and pairs of a segment and a disc, that are computed at a time
