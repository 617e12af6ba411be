"""What can be spoken of beside the objects: places.

A place is never meant itself: corners, edges, the middle, the ground, the robot, the speaker, and the sides of the
latter two ("on your left").
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from dcg_torch.names.vocabulary import SIDE_MIDDLE
from dcg_torch.scene.layout import DIRECTION, GROUND, HEADINGS
from dcg_torch.scene.upright_pictures import laid_flat
from dcg_torch.types import Object, Pose
from dcg_torch.types.geometry import from_robot_frame, to_robot_frame

Bounds = tuple[float, float, float, float]
"""(near, far, right, left) of a workspace, seen from the robot, metres."""


def scene_bounds(positions: Sequence[Sequence[float]], robot: Pose | None) -> Bounds:
    """The bounding box of the positions of a scene; of an upright picture as it is laid flat."""
    points = np.array([(*p, 0.0)[:3] for p in positions], dtype=np.float64)
    points[:, :2] = to_robot_frame(robot or Pose(0.0, 0.0), points[:, :2])
    points = laid_flat(points)
    low, high = points.min(axis=0), points.max(axis=0)
    return float(low[0]), float(high[0]), float(low[1]), float(high[1])


def places(bounds: Bounds | None, robot: Pose | None, speaker: Pose | None) -> tuple[Object, ...]:
    """The places that can be spoken of.

    Args:
        bounds: of the workspace; None: it has no edges.
        robot: "you" to the speaker.
        speaker: "me".
    """
    origin = robot or Pose(0.0, 0.0)
    found: list[Object] = []

    def add(kind: str, x: float, y: float, sides: Sequence[str] = (), size: tuple[float, float] = (0.0, 0.0)) -> None:
        found.append(_place(kind, from_robot_frame(origin, x, y), sides, size))

    if bounds is not None:
        near, far, right, left = bounds
        mid_x, mid_y, deep, wide = (near + far) / 2, (right + left) / 2, far - near, left - right
        for x, ahead in ((near, "near side"), (far, "far side")):
            add("edge", x, mid_y, (ahead,), (0.0, wide))
            for y, side in ((right, "right side"), (left, "left side")):
                add("corner", x, y, (ahead, side))
        for y, side in ((right, "right side"), (left, "left side")):
            add("edge", mid_x, y, (side,), (deep, 0.0))
        add("middle", mid_x, mid_y)
    add(GROUND, 0.0, 0.0)
    for kind, pose in (("robot", robot), ("speaker", speaker)):
        if pose is not None:
            x, y = map(float, to_robot_frame(origin, np.array([[pose.x, pose.y]]))[0])
            add(kind, x, y)
            for side in HEADINGS:
                add(DIRECTION, x, y, (side, f"of {kind}"))
    return tuple(found)


def side_middles(box: Bounds, viewer: Pose | None) -> tuple[Object, ...]:
    """The middles of the sides of a box around what is there, which "the top middle" is one of.

    Args:
        box: as the viewer sees it.
        viewer: whose left and right they have.
    """
    near, far, right, left = box
    deep, wide = (near + far) / 2, (right + left) / 2
    spots = {"near side": (near, wide), "far side": (far, wide), "right side": (deep, right), "left side": (deep, left)}
    origin = viewer or Pose(0.0, 0.0)
    return tuple(_place(SIDE_MIDDLE, from_robot_frame(origin, *spot), (side,)) for side, spot in spots.items())


def _place(kind: str, at: tuple[float, float], sides: Sequence[str], size: tuple[float, float] = (0.0, 0.0)) -> Object:
    name = " ".join(("place:", *sides, kind))
    return Object(name, kind, known=True, position=(*at, 0.0), size=(*size, 0.0), attributes=frozenset(sides))
