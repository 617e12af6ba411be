"""Is there a way among round obstacles, and a rough one: a power diagram, in time and memory n log n of the obstacles.

The power diagram (Aurenhammer 1987, "Power diagrams: properties, algorithms and applications") gives every obstacle
the ground that is nearest to it by distance^2 - radius^2. A point that is free can be moved away from its obstacle to
the edges of the diagram without meeting any, so two places are connected exactly if they are by the free parts of
those edges. The start and the goals are sites of radius 0; their cells are convex and free throughout.

The diagram is the dual of the lower convex hull of the sites lifted to (x, y, x^2 + y^2 - radius^2), which is Qhull's.

Conventions: metres; points are (n, 2) float64 arrays.
"""

from __future__ import annotations

import itertools
import math
from dataclasses import dataclass

import numpy as np
from scipy.sparse import coo_array
from scipy.sparse.csgraph import dijkstra
from scipy.spatial import ConvexHull

from dcg_torch.types.arrays import Ints, Points
from dcg_torch.types.geometry import segments_clear

_FRAME = 24  # sites on a circle about all others, so that there is a way round the outside
_ROOM = 2.0  # metres between the outermost obstacle and that circle
_ROUNDING = 2e-6  # metres that obstacles are narrowed by, so that a start or goal on a rim is outside
_STEPS = (0.4, 0.2, 0.1, 0.1)  # metres between the points that a way is tightened by, in turn
_WINDOW = 24  # a straight line joins points that are at most so many apart
_NO_LENGTH = 1e-9  # metres; an edge of length 0 would be none in a sparse graph


@dataclass(frozen=True)
class _Diagram:
    """The corners of the cells (m, 2), the three sites of each (m, 3), and pairs of neighbouring corners (k, 2)."""

    corners: Points
    sites: Ints
    edges: Ints
    beside: Ints
    """(k,) one of the two sites that an edge lies between."""


def roadmap_path(start: Points, goals: Points, centres: Points, radii: Points) -> Points | None:
    """A way from `start` to one of the goals that keeps away from obstacles, or None if there is none.

    Args:
        start: (2,), outside every obstacle.
        goals: (g, 2), likewise.
        centres, radii: (n, 2) and (n,), of the obstacles.

    Returns:
        (k, 2); all of it is outside every obstacle, but for a rounding of some micrometres.
    """
    n, g = len(centres), len(goals)
    sites = np.concatenate([centres, start[None], goals])
    width = np.concatenate([np.maximum(radii - _ROUNDING, 0.0), np.zeros(1 + g)])
    diagram = _power_diagram(*_framed(sites, width))
    first, second = diagram.edges.T
    ends = diagram.corners[first], diagram.corners[second]
    obstacle = diagram.beside < n
    free = np.ones(len(first), dtype=np.bool_)
    beside = diagram.beside[obstacle]
    free[obstacle] = _distances(ends[0][obstacle], ends[1][obstacle], centres[beside]) >= width[beside]
    # the start and the goals are joined to the corners of their own cells
    corner, column = np.nonzero((diagram.sites >= n) & (diagram.sites <= n + g))
    place = diagram.sites[corner, column] - n
    m = len(diagram.corners)
    heads, tails = np.concatenate([first[free], corner]), np.concatenate([second[free], m + place])
    points = np.concatenate([diagram.corners, start[None], goals])
    nodes = shortest(points, heads, tails, m, np.arange(m + 1, m + 1 + g))
    return None if nodes is None else points[nodes]


def _framed(sites: Points, radii: Points) -> tuple[Points, Points]:
    """The sites and those of the frame."""
    middle = (sites.min(axis=0) + sites.max(axis=0)) / 2
    reach = float((np.linalg.norm(sites - middle, axis=1) + radii).max()) + _ROOM
    angles = np.arange(_FRAME) * (2.0 * np.pi / _FRAME)
    frame = middle + reach / np.cos(np.pi / _FRAME) * np.stack([np.cos(angles), np.sin(angles)], axis=1)
    return np.concatenate([sites, frame]), np.concatenate([radii, np.zeros(_FRAME)])


def _power_diagram(sites: Points, radii: Points) -> _Diagram:
    """Of at least four sites that are not all on a line."""
    middle = sites.mean(axis=0)  # about the origin, where squares lose the fewest digits
    x, y = (sites - middle).T
    hull = ConvexHull(np.stack([x, y, x**2 + y**2 - radii**2], axis=1))
    lower = hull.equations[:, 2] < -1e-12
    triangles = hull.simplices[lower].astype(np.int64)
    normal = hull.equations[lower, :3]
    corners = middle - normal[:, :2] / (2.0 * normal[:, 2:])
    # each edge of two triangles is an edge of the diagram between their corners
    sides = np.sort(np.concatenate([triangles[:, [0, 1]], triangles[:, [1, 2]], triangles[:, [2, 0]]]), axis=1)
    owner = np.tile(np.arange(len(triangles)), 3)
    order = np.lexsort((sides[:, 1], sides[:, 0]))
    sides, owner = sides[order], owner[order]
    same = np.flatnonzero((sides[:-1] == sides[1:]).all(axis=1))
    return _Diagram(corners, triangles, np.stack([owner[same], owner[same + 1]], axis=1), sides[same, 0])


def _distances(starts: Points, ends: Points, points: Points) -> Points:
    """How near each segment comes to its own point, (k,)."""
    along, to_point = ends - starts, points - starts
    foot = np.clip((to_point * along).sum(1) / np.maximum((along**2).sum(1), 1e-18), 0.0, 1.0)
    distance: Points = np.linalg.norm(to_point - foot[:, None] * along, axis=1)
    return distance


def shortest(points: Points, heads: Ints, tails: Ints, start: int, goals: Ints) -> list[int] | None:
    """The nodes of the shortest path from `start` to the nearest of the goals, in an undirected graph."""
    lengths = np.linalg.norm(points[heads] - points[tails], axis=1) + _NO_LENGTH
    graph = coo_array((lengths, (heads, tails)), shape=(len(points), len(points))).tocsr()
    distance, before = dijkstra(graph, directed=False, indices=start, return_predecessors=True)
    goal = int(goals[distance[goals].argmin()])
    if not np.isfinite(distance[goal]):
        return None
    nodes = [goal]
    while nodes[-1] != start:
        nodes.append(int(before[nodes[-1]]))
    return nodes[::-1]


def tightened(path: Points, centres: Points, radii: Points) -> Points:
    """A short way in place of a rough one: by straight lines between points of it, several times over.

    Args:
        path: (k, 2).
        centres, radii: (n, 2) and (n,), of obstacles that the path keeps outside of.
    """
    for step in _STEPS:
        points = _resampled(path, step)
        count = len(points)
        heads, tails = np.triu_indices(count, k=1)
        near = tails - heads <= _WINDOW
        heads, tails = heads[near], tails[near]
        free = (tails == heads + 1) | segments_clear(points[heads], points[tails], centres, radii)
        nodes = shortest(points, heads[free], tails[free], 0, np.array([count - 1]))
        path = path if nodes is None else points[nodes]  # neighbours are joined, so there is one
    return path


def _resampled(path: Points, step: float) -> Points:
    """The path with further points on it, none farther than `step` metres from the next."""
    pieces = []
    for a, b in itertools.pairwise(path):
        count = max(1, math.ceil(float(np.linalg.norm(b - a)) / step))
        pieces.append(a + np.arange(count)[:, None] / count * (b - a))
    points: Points = np.concatenate([*pieces, path[-1:]])
    return points
