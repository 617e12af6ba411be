"""Paths among round obstacles: plane geometry, no physics.

The planner is a visibility graph (Lozano-Perez and Wesley 1979) whose corners are points on rings just outside the
obstacles; networkx finds the shortest way through it. A point that moves along a path keeps outside every circle,
so the circles must already be as wide as the object, the robot and a margin together.

Conventions: lengths in metres; points are (n, 2) float64 arrays; a path is (k, 2) with k >= 2, its first row the
start. None means that there is no way.
"""

from __future__ import annotations

import bisect
import itertools
import math
from collections.abc import Sequence
from dataclasses import dataclass, replace

import networkx as nx
import numpy as np
from numpy.typing import NDArray

Points = NDArray[np.float64]

_RING = 16  # corners round an obstacle: no turn of more than 22.5 degrees at one of them
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
    centres = np.array([(c.x, c.y) for c in circles], dtype=np.float64).reshape(-1, 2)
    radii = np.array([c.radius for c in circles], dtype=np.float64)
    along = (ends - starts)[:, None, :]
    to_centre = centres[None, :, :] - starts[:, None, :]
    squared = np.maximum((along**2).sum(-1), 1e-18)  # a segment may be a point
    nearest = np.clip((to_centre * along).sum(-1) / squared, 0.0, 1.0)
    distance: Points = np.linalg.norm(to_centre - nearest[:, :, None] * along, axis=-1) - radii
    return distance


def is_clear(path: Points, circles: Sequence[Circle]) -> bool:
    """Whether the whole path stays outside every circle."""
    return bool((clearance(path[:-1], path[1:], circles) >= -_SLACK).all())


def length(path: Points) -> float:
    """Of the whole path, in metres."""
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
    """The shortest path from `start` to any of the `goals` outside all obstacles.

    An obstacle that contains `start` shrinks until it doesn't. Obstacles enter the graph only once they are in the
    way, so that a far object costs nothing; all are checked.
    """
    obstacles = shrink_to_reach(obstacles, start)
    goals = goals[(clearance(goals, goals, obstacles) >= -_SLACK).all(axis=1)]
    if not len(goals):
        return None
    # the nearest goal in a straight line, if nothing is in between: nothing can be shorter
    nearest = goals[np.argmin(np.linalg.norm(goals - start, axis=1))]
    straight = np.array([start, nearest])
    if is_clear(straight, obstacles):
        return straight
    active: set[int] = set()
    path: Points | None = straight
    while path is not None:
        blocking = set(np.flatnonzero((clearance(path[:-1], path[1:], obstacles) < -_SLACK).any(axis=0)).tolist())
        if not blocking:
            return path
        active |= blocking
        path = _through(start, goals, [obstacles[i] for i in sorted(active)])
    # the rings of the others may still lead round
    return _through(start, goals, obstacles)


def _through(start: tuple[float, float], goals: Points, obstacles: Sequence[Circle]) -> Points | None:
    """Shortest path in the visibility graph of these obstacles alone."""
    # a chord between neighbouring corners touches the circle when they are this much outside
    corners = np.concatenate(
        [ring(replace(c, radius=(c.radius + 10 * _SLACK) / math.cos(math.pi / _RING))) for c in obstacles]
    )
    corners = corners[(clearance(corners, corners, obstacles) >= -_SLACK).all(axis=1)]
    points = np.concatenate([np.array([start]), goals, corners])
    first, second = np.triu_indices(len(points), k=1)
    # two goals are never joined: a path ends at the first it meets
    useful = (first == 0) | (second > len(goals))
    first, second = first[useful], second[useful]
    visible = (clearance(points[first], points[second], obstacles) >= -_SLACK).all(axis=1)
    first, second = first[visible], second[visible]
    graph = nx.Graph()
    graph.add_nodes_from(range(len(points)))
    lengths = np.linalg.norm(points[first] - points[second], axis=1)
    graph.add_weighted_edges_from(zip(first.tolist(), second.tolist(), lengths.tolist(), strict=True))
    end = -1  # a node beyond all goals, at no cost
    graph.add_weighted_edges_from((goal, end, 0.0) for goal in range(1, 1 + len(goals)))
    try:
        nodes = nx.dijkstra_path(graph, 0, end)
    except nx.NetworkXNoPath:
        return None
    path: Points = points[nodes[:-1]]
    return path


def approach(
    start: tuple[float, float], target: Circle, obstacles: Sequence[Circle], *, reach: float = 0.47
) -> Points | None:
    """A path to `reach` metres from the middle of `target`, outside it and all other obstacles.

    `target.radius` counts as at most `reach`. A start that is near enough already gives a path of no length.
    """
    if target.distance(*start) <= reach:
        return np.array([start, start], dtype=np.float64)
    own = replace(target, radius=min(target.radius, reach - 0.01))
    goals = ring(replace(target, radius=reach), 32, towards=start)
    return shortest_path(start, goals, [*obstacles, own])


def retreat(
    start: tuple[float, float], target: Circle, obstacles: Sequence[Circle], *, distance: float = 1.6, gain: float = 0.3
) -> Points | None:
    """A path that ends at least `distance` from the middle of `target`, and `gain` farther than it began.

    Where the nearest such ring is full of obstacles, wider ones are tried, up to three metres more.
    """
    least = max(distance, target.distance(*start) + gain)
    for extra in itertools.chain([0.0], np.arange(0.5, 3.1, 0.5)):
        goals = ring(replace(target, radius=least + float(extra)), 48, towards=start)
        path = shortest_path(start, goals, [*obstacles, target])
        if path is not None:
            return path
    return None


class Track:
    """A path with the place reached on it, measured in metres along it."""

    def __init__(self, path: Points) -> None:
        steps = np.linalg.norm(np.diff(path, axis=0), axis=1)
        # plain floats: one short path is asked thousands of times
        corners = path[np.concatenate([[True], steps > 1e-9])]
        self._corners: list[tuple[float, float]] = [(float(x), float(y)) for x, y in corners]
        self._at = [0.0, *np.cumsum(steps[steps > 1e-9]).tolist()]
        self.length: float = self._at[-1]
        self._reached = 0.0

    def progress(self, x: float, y: float, *, window: float = 0.5) -> float:
        """The place on the path nearest to (x, y), at most `window` metres on from the last one; never back."""
        best, found = math.inf, self._reached
        pieces = zip(itertools.pairwise(self._corners), itertools.pairwise(self._at), strict=True)
        for (a, b), (begin, end) in pieces:
            low, high = max(begin, self._reached), min(end, self._reached + window)
            if low > high:
                continue
            ux, uy = (b[0] - a[0]) / (end - begin), (b[1] - a[1]) / (end - begin)
            place = min(max(begin + (x - a[0]) * ux + (y - a[1]) * uy, low), high)
            distance = math.hypot(a[0] + (place - begin) * ux - x, a[1] + (place - begin) * uy - y)
            if distance < best:
                best, found = distance, place
        self._reached = found
        return found

    def point(self, place: float) -> tuple[float, float]:
        """The point `place` metres along; beyond the end, straight on."""
        if self.length == 0.0:
            return self._corners[0]
        piece = min(bisect.bisect_right(self._at, place), len(self._at) - 1)
        (a, b), begin, end = self._corners[piece - 1 : piece + 1], self._at[piece - 1], self._at[piece]
        part = (place - begin) / (end - begin)
        return a[0] + part * (b[0] - a[0]), a[1] + part * (b[1] - a[1])

    def rest(self, place: float) -> Points:
        """The path from `place` on, as (k, 2)."""
        later = [corner for corner, at in zip(self._corners, self._at, strict=True) if at > place]
        return np.array([self.point(place), *(later or [self._corners[-1]])], dtype=np.float64)
