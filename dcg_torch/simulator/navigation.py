"""Paths among round obstacles: plane geometry, no physics.

The planner is a visibility graph (Lozano-Perez and Wesley 1979) of the obstacles that are in the way, whose corners are
points on rings just outside them. `roadmap` says whether there is a way at all, and gives one where very many obstacles
are in it. A point that moves along a path keeps outside every circle, so the circles must already be as wide as the
object, the robot and a margin together.

Conventions: lengths in metres; points are (n, 2) float64 arrays; a path is (k, 2) with k >= 2, its first row the
start. None means that there is no way.
"""

from __future__ import annotations

import itertools
import math
from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from dcg_torch.simulator.roadmap import roadmap_path, shortest, tightened
from dcg_torch.types.arrays import Points
from dcg_torch.types.geometry import segment_distances, segments_clear

_RING = 16  # corners round an obstacle: no turn of more than 22.5 degrees at one of them
_IN_THE_WAY = 12  # obstacles in one visibility graph, at the most: it grows as their third power
_REACH = 0.47  # metres from the target's middle at which a drive is planned to end
_LEFT, _GAIN = 1.6, 0.3  # metres from what is left, and metres more than there were
_SLACK = 1e-6  # metres; keeps a path's own corners from counting as inside by rounding


@dataclass(frozen=True, slots=True)
class Circle:
    """Where the moving point must not go; metres."""

    x: float
    y: float
    radius: float

    def distance(self, x: float, y: float) -> float:
        """From the centre to a point."""
        return math.hypot(x - self.x, y - self.y)


def clearance(starts: Points, ends: Points, circles: Sequence[Circle]) -> Points:
    """How far each segment stays outside each circle (negative: inside), as (segments, circles)."""
    centres, radii = _arrays(circles)
    outside: Points = segment_distances(starts, ends, centres)[0] - radii
    return outside


def is_clear(path: Points, circles: Sequence[Circle]) -> bool:
    """Whether the whole path stays outside every circle."""
    return bool((clearance(path[:-1], path[1:], circles) >= -_SLACK).all())


def length(path: Points) -> float:
    """The length of a whole path, in metres."""
    return float(np.linalg.norm(np.diff(path, axis=0), axis=1).sum())


def ring(circle: Circle, count: int = _RING, *, towards: tuple[float, float] | None = None) -> Points:
    """`count` points evenly on the circle, the first on the side of `towards` (or of +x)."""
    first = 0.0 if towards is None else math.atan2(towards[1] - circle.y, towards[0] - circle.x)
    angles = first + np.arange(count) * (math.tau / count)
    return np.stack([circle.x + circle.radius * np.cos(angles), circle.y + circle.radius * np.sin(angles)], axis=1)


def shrink_to_reach(circles: Sequence[Circle], point: tuple[float, float]) -> list[Circle]:
    """The same obstacles, each no wider than leaves `point` outside: where the robot stands, it can stand."""
    return [replace(c, radius=max(0.0, min(c.radius, c.distance(*point) - _SLACK))) for c in circles]


def shortest_path(start: tuple[float, float], goals: Points, obstacles: Sequence[Circle]) -> Points | None:
    """The shortest path from `start` to any of the `goals` outside all obstacles, or nearly so among very many.

    An obstacle that contains `start` shrinks until it doesn't. Obstacles enter the visibility graph only once they
    are in the way, so that a far object costs nothing; all are checked. Where more than `_IN_THE_WAY` are, a way
    through the power diagram is tightened instead, so that time and memory stay n log n in the obstacles.

    Returns:
        (points, 2) from `start` to a goal; None where there is no way.
    """
    obstacles = shrink_to_reach(obstacles, start)
    goals = goals[(clearance(goals, goals, obstacles) >= -_SLACK).all(axis=1)]
    if not len(goals):
        return None
    # the nearest goal in a straight line, if nothing is in between: nothing can be shorter
    nearest = goals[np.argmin(np.linalg.norm(goals - start, axis=1))]
    path = np.array([start, nearest])
    if is_clear(path, obstacles):
        return path
    centres, radii = _arrays(obstacles)
    rough = roadmap_path(np.array(start), goals, centres, radii)
    if rough is None:
        return None
    active: set[int] = set()
    while True:
        active |= set(np.flatnonzero((clearance(path[:-1], path[1:], obstacles) < -_SLACK).any(axis=0)).tolist())
        found = None
        if len(active) <= _IN_THE_WAY:
            found = _through(start, goals, [obstacles[i] for i in sorted(active)])
        if found is None:
            return tightened(rough, centres, radii - _SLACK)
        if is_clear(found, obstacles):
            return found
        path = found


def _through(start: tuple[float, float], goals: Points, obstacles: Sequence[Circle]) -> Points | None:
    """Shortest path in the visibility graph of these obstacles alone."""
    # a chord between neighbouring corners touches the circle when they are this much outside
    corners = np.concatenate(
        [ring(replace(c, radius=(c.radius + 10 * _SLACK) / math.cos(math.pi / _RING))) for c in obstacles]
    )
    centres, radii = _arrays(obstacles)
    corners = corners[segments_clear(corners, corners, centres, radii - _SLACK)]
    points = np.concatenate([np.array([start]), goals, corners])
    first, second = np.triu_indices(len(points), k=1)
    # two goals are never joined: a path ends at the first it meets
    useful = (first == 0) | (second > len(goals))
    first, second = first[useful], second[useful]
    visible = segments_clear(points[first], points[second], centres, radii - _SLACK)
    nodes = shortest(points, first[visible], second[visible], 0, np.arange(1, 1 + len(goals)))
    return None if nodes is None else points[nodes]


def _arrays(obstacles: Sequence[Circle]) -> tuple[Points, Points]:
    """Centres (n, 2) and radii (n,)."""
    centres = np.array([(c.x, c.y) for c in obstacles], dtype=np.float64).reshape(-1, 2)
    return centres, np.array([c.radius for c in obstacles], dtype=np.float64)


def approach(start: tuple[float, float], target: Circle, obstacles: Sequence[Circle]) -> Points | None:
    """A path to `_REACH` metres from the middle of `target`, outside it and all other obstacles.

    `target.radius` counts as at most that. A start that is near enough already gives a path of no length.

    Returns:
        (points, 2), as `shortest_path`.
    """
    if target.distance(*start) <= _REACH:
        return np.array([start, start], dtype=np.float64)
    own = replace(target, radius=min(target.radius, _REACH - 0.01))
    goals = ring(replace(target, radius=_REACH), 32, towards=start)
    return shortest_path(start, goals, [*obstacles, own])


def retreat(start: tuple[float, float], target: Circle, obstacles: Sequence[Circle]) -> Points | None:
    """A path that ends at least `_LEFT` metres from the middle of `target`, and `_GAIN` farther than it began.

    Where the nearest such ring is full of obstacles, wider ones are tried, up to three metres more.

    Returns:
        (points, 2), as `shortest_path`.
    """
    least = max(_LEFT, target.distance(*start) + _GAIN)
    for extra in itertools.chain([0.0], np.arange(0.5, 3.1, 0.5)):
        goals = ring(replace(target, radius=least + float(extra)), 48, towards=start)
        path = shortest_path(start, goals, [*obstacles, target])
        if path is not None:
            return path
    return None
