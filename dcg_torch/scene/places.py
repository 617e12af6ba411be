"""What can be spoken of beside the objects: places, and groups of objects.

A place is never meant itself: corners, edges, the middle, the ground, the robot, the speaker, and the sides of the
latter two ("on your left"). A group is: "the row of barrels" means all its members.
"""

from __future__ import annotations

import itertools
from collections.abc import Iterable, Sequence

import numpy as np

from dcg_torch.geometry import from_robot_frame, to_robot_frame
from dcg_torch.scene.layout import DIRECTION, GROUND, HEADINGS, Bools, Floats
from dcg_torch.scene.neighbours import NEXT, SAME_SPOT
from dcg_torch.types import Object, Pose

Bounds = tuple[float, float, float, float]
"""(near, far, right, left) of a workspace, seen from the robot, metres."""

ROW, STACK, CLUSTER = "row", "stack", "cluster"
_UNEVEN = 0.6
"""How far the next of a row may stand from where it is due, as a share of the step."""
_STEP = 2.0
"""Neighbours in a row are at most so many times as far apart as the nearest ones."""
_LEAST = 3
"""Members of a row or cluster; a stack has two."""
_CHUNK = 1024
"""Steps that are looked at together."""
_MOST = 12
"""Groups of one kind that are kept: the largest."""


def scene_bounds(positions: Sequence[Sequence[float]], robot: Pose | None) -> Bounds:
    """The bounding box of positions."""
    points = to_robot_frame(robot or Pose(0.0, 0.0), np.array([p[:2] for p in positions], dtype=np.float64))
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
        where = (*from_robot_frame(origin, x, y), 0.0)
        name = " ".join(("place:", *sides, kind))
        found.append(Object(name, kind, known=True, position=where, size=(*size, 0.0), attributes=frozenset(sides)))

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


def groups(objects: Sequence[Object], unit: float = 1.0) -> tuple[Object, ...]:
    """The groups that objects form: rows of evenly spaced ones, stacks, and clusters of neighbours.

    They are looked for among all objects, among those of one type, and among those of one type and colour. A group
    has the type and the colour that its members share, and says what it is and how many they are in its attributes.

    Args:
        objects: those without a position are in no group.
        unit: metres in a unit of length, see `layout`.
    """
    there = [o for o in objects if o.position is not None]
    if len(there) < 2:
        return ()
    position = np.array([o.position for o in there]).reshape(-1, 3) / unit
    alike: dict[tuple[str | None, ...], list[int]] = {(): list(range(len(there)))}
    for j, o in enumerate(there):
        alike.setdefault((o.type,), []).append(j)
        alike.setdefault((o.type, o.color), []).append(j)
    found: dict[str, dict[frozenset[int], None]] = {ROW: {}, STACK: {}, CLUSTER: {}}
    for among in alike.values():
        found[ROW] |= dict.fromkeys(_rows(position, among))
        found[CLUSTER] |= dict.fromkeys(_clusters(position, among))
    found[STACK] = dict.fromkeys(_stacks(position))
    return tuple(
        _group(kind, [there[j] for j in sorted(members)])
        for kind, of_kind in found.items()
        for members in itertools.islice(sorted(of_kind, key=lambda m: (-len(m), sorted(m))), _MOST)
    )


def _group(kind: str, members: Sequence[Object]) -> Object:
    ids = tuple(o.id for o in members)
    types, colors = {o.type for o in members}, {o.color for o in members}
    one_type = next(iter(types)) if len(types) == 1 else None
    return Object(
        id=f"{kind}: {' '.join(ids)}",
        type=one_type,
        known=one_type is not None and all(o.known for o in members),
        color=next(iter(colors)) if len(colors) == 1 else None,
        position=members[0].position,
        attributes=frozenset({kind, f"of {len(members)}"}),
        members=ids,
    )


def _rows(position: Floats, among: Sequence[int]) -> Iterable[frozenset[int]]:
    """Maximal runs of at least `_LEAST` in a straight line on one level, one step apart."""
    if len(among) < _LEAST:
        return
    points = position[list(among)]
    offset = points[None, :, :] - points[:, None, :]  # i -> j
    distance = np.hypot(offset[..., 0], offset[..., 1])
    level = np.abs(offset[..., 2]) < SAME_SPOT
    apart = np.where(level & (distance > SAME_SPOT), distance, np.inf)
    nearest = apart.min(axis=1)
    steps = np.argwhere(apart < _STEP * np.minimum(nearest[:, None], nearest[None, :]) + 1e-6)
    follow: dict[tuple[int, int], int] = {}  # (i, j) -> the one after j
    for part in np.split(steps, range(_CHUNK, len(steps), _CHUNK)):
        i, j = part.T
        miss = np.linalg.norm(points[None] - (points[j] + offset[i, j])[:, None], axis=2)
        best = miss.argmin(axis=1)
        due = miss[np.arange(len(part)), best] < _UNEVEN * apart[i, j]
        follow.update(zip(map(tuple, part[due].tolist()), best[due].tolist(), strict=True))
    for i, j in follow:
        if (j, i) in follow:
            continue  # this is not an end of the row
        run = [i, j]
        while (after := follow.get((run[-2], run[-1]))) is not None and after not in run:
            run.append(after)
        if run[0] < run[-1]:
            yield frozenset(among[k] for k in run)


def _clusters(position: Floats, among: Sequence[int]) -> Iterable[frozenset[int]]:
    """Connected neighbours on at least `_LEAST` spots."""
    if len(among) < _LEAST:
        return
    points = position[list(among), :2]
    offset = points[None] - points[:, None]
    apart = np.hypot(offset[..., 0], offset[..., 1])
    for members in _components(apart < NEXT):
        if len(members) < _LEAST:
            continue
        spots = _components(apart[np.ix_(members, members)] < SAME_SPOT)
        if len(list(spots)) >= _LEAST:
            yield frozenset(among[k] for k in members)


def _stacks(position: Floats) -> Iterable[frozenset[int]]:
    """Things over one another."""
    over = np.linalg.norm(position[None, :, :2] - position[:, None, :2], axis=2) < SAME_SPOT
    higher = np.abs(position[None, :, 2] - position[:, None, 2]) > 0.01
    for members in _components(over & higher):
        if len(members) >= 2:
            yield frozenset(members)


def _components(joined: Bools) -> Iterable[list[int]]:
    neighbours = [row.nonzero()[0].tolist() for row in joined]
    left = set(range(len(joined)))
    while left:
        front, members = [left.pop()], list[int]()
        while front:
            k = front.pop()
            members.append(k)
            new = [m for m in neighbours[k] if m in left]
            left.difference_update(new)
            front += new
        yield sorted(members)
