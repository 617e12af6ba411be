"""What lies near what: things over, under and beside others, and what stands in one stack.

Pairs are found with every distance written out where things are few, and with a tree where they are many, so that ten
thousand things need no table of all pairs.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from dcg_torch.types.arrays import Bools, Floats, Ints

LEVEL, SAME_POINT = 0.01, 0.1
"""Units of height within which things stand on one level, and of floor within which two of these are in one place."""
SAME_SPOT = 0.6
"""Units between two feet, seen from above, within which one thing is over the other."""
ONE_LEVEL = 1.2
"""Units of height within which the upper one rests on the lower one."""
RESTS = 0.25
"""Units between the foot of one thing and the top of another beyond which the one does not rest on the other."""
NEXT = 1.6
"""Units within which things are neighbours."""

_FEW = 256
"""Things up to which all distances are written out."""
_PAIRS = 1 << 20
"""About how many pairs are held at once where things are many."""
_SLACK = 1e-9
"""Share by which the tree looks too far: the bound itself is held against the same distance however it was found."""


@dataclass(frozen=True)
class Neighbours:
    """Which of n objects that stand somewhere lie on, under and beside others.

    Attributes:
        covered: (n,) does something rest on it?
        resting: (n,) does it rest on something?
        beside: (n,) has it a neighbour?
        stacked: (n,) is another on its spot?
        colors: number of a stacked thing -> the numbers of the colours on its spot, its own apart, ascending.
    """

    covered: Bools
    resting: Bools
    beside: Bools
    stacked: Bools
    colors: dict[int, tuple[int, ...]]


def neighbours(
    position: Floats, color: Ints, half: Floats | None = None, heights: tuple[Floats, Floats] | None = None
) -> Neighbours:
    """Who lies on, under and beside whom.

    Args:
        position: (n, 3) in units of the world; NaN where a thing stands nowhere.
        color: (n,) the number of its colour, -1 for none.
        half: (n, 2) half extents in x and y, NaN where they are not known: small things side by side are no stack.
        heights: (n,) those of the lower and the upper ends, NaN where not known: a desk does not rest on the bin below.
    """
    n = len(position)
    covered, resting, beside, stacked = (np.zeros(n, dtype=np.bool_) for _ in range(4))
    found: list[Ints] = []
    most = int(color.max(initial=0)) + 1
    there = np.flatnonzero(np.isfinite(position).all(axis=1))
    for one, other, apart in _pairs(position[there, :2], NEXT):
        i, j = there[one], there[other]
        beside[i] = True
        spot = apart < SAME_SPOT
        if half is None:  # two that stand on one level are beside one another, however close
            spot &= (np.abs(position[i, 2] - position[j, 2]) > LEVEL) | (apart <= SAME_POINT)
        else:
            offset = np.abs(position[i, :2] - position[j, :2])
            with np.errstate(invalid="ignore"):
                spot &= ~(offset >= half[i] + half[j]).any(axis=1)
        if not spot.any():
            continue
        i, j = i[spot], j[spot]
        stacked[i] = True
        up = position[i, 2] - position[j, 2]
        over = (up > LEVEL) & (up <= ONE_LEVEL)
        if heights is not None:
            with np.errstate(invalid="ignore"):
                over &= ~(np.abs(heights[0][i] - heights[1][j]) > RESTS)
        resting[i[over]] = True
        covered[j[over & _covers(i, j, half)]] = True
        colored = color[j] >= 0
        found.append(i[colored] * most + color[j[colored]])
    colors: dict[int, tuple[int, ...]] = {}
    codes = np.concatenate(found) if found else np.zeros(0, dtype=np.int64)
    for code in sorted(set(codes.tolist())) if len(codes) <= _FEW else np.unique(codes).tolist():
        k, c = divmod(code, most)
        colors[k] = (*colors.get(k, ()), c)
    return Neighbours(covered, resting, beside, stacked, colors)


def _covers(i: Ints, j: Ints, half: Floats | None) -> Bools:
    """(pairs,) whether the upper thing covers the lower one. A small thing on a large one does not: a lamp on a table.

    Args:
        i, j: (pairs,) numbers of the upper and the lower things.
        half: (n, 2) half extents; None where nobody knows any, and then all that lies on a thing covers it.
    """
    if half is None:
        return np.ones(len(i), dtype=np.bool_)
    with np.errstate(invalid="ignore"):
        small = half[i].prod(axis=1) < _COVERS * half[j].prod(axis=1)
    return np.asarray(~small)


_COVERS = 0.3
"""A thing is covered by what takes up at least so much of its floor."""


def _pairs(points: Floats, bound: float) -> Iterator[tuple[Ints, Ints, Floats]]:
    """Numbers of two different points (m, 2) that are closer than a bound, both ways round, and how far apart."""
    if len(points) <= _FEW:
        x, y = (own[:, None] - own[None, :] for own in points.T)
        apart = np.hypot(x, y)
        near = apart < bound
        near.flat[:: len(points) + 1] = False
        i, j = near.nonzero()
        yield i, j, apart[i, j]
        return
    from scipy.spatial import cKDTree  # here: few worlds are so large

    tree = cKDTree(points, balanced_tree=False)
    reach = bound * (1.0 + _SLACK)
    if _most_pairs(points, reach) <= 2 * _PAIRS or tree.count_neighbors(tree, reach) <= 2 * _PAIRS:
        found = tree.query_pairs(reach, output_type="ndarray").astype(np.int64)
        yield _close(points, np.concatenate([found[:, 0], found[:, 1]]), found[:, ::-1].T.reshape(-1), bound)
        return
    around = np.cumsum(tree.query_ball_point(points, reach, return_length=True)) // _PAIRS
    for chunk in np.split(np.arange(len(points)), np.flatnonzero(np.diff(around)) + 1):
        found = cKDTree(points[chunk]).sparse_distance_matrix(tree, reach, output_type="ndarray")
        i, j = chunk[found["i"]], found["j"].astype(np.int64)
        yield _close(points, i[i != j], j[i != j], bound)


def _most_pairs(points: Floats, bound: float) -> int:
    """As many pairs as there can be, by how many points are in each square as wide as the bound and those around it."""
    row, column = np.floor((points - points.min(axis=0)) / bound).T
    with np.errstate(over="ignore", invalid="ignore"):  # squares that share a number only make it more
        _, counts = np.unique(row * (column.max() + 1.0) + column, return_counts=True)
    return 9 * int((counts**2).sum())


def _close(points: Floats, i: Ints, j: Ints, bound: float) -> tuple[Ints, Ints, Floats]:
    offset = points[i] - points[j]
    apart = np.hypot(offset[:, 0], offset[:, 1])
    near = apart < bound
    return i[near], j[near], apart[near]


def nearest(points: Floats, count: int) -> tuple[Floats, Ints]:
    """(m, count) how far the nearest of (m, 3) points are from each, itself among them, and which these are."""
    if len(points) <= _FEW:
        x, y, z = (own[:, None] - own[None, :] for own in points.T)
        square = x * x + y * y + z * z
        order = square.argsort(axis=1, kind="stable")[:, :count]
        return np.sqrt(np.take_along_axis(square, order, axis=1)), order
    from scipy.spatial import cKDTree  # here: few worlds are so large

    away, number = cKDTree(points).query(points, k=count)
    return away.reshape(len(points), -1), number.reshape(len(points), -1)


def nearest_other(position: Floats) -> Floats:
    """(n,) how far the nearest other thing is from each of (n, 3) positions; NaN where there is none."""
    found = np.full(len(position), np.nan)
    there = np.flatnonzero(np.isfinite(position).all(axis=1))
    if len(there) < 2:
        return found
    points = position[there]
    if len(there) <= _FEW:
        x, y, z = (own[:, None] - own[None, :] for own in points.T)
        apart = x * x + y * y + z * z
        apart.flat[:: len(points) + 1] = np.inf
        found[there] = np.sqrt(apart.min(axis=1))
        return found
    from scipy.spatial import cKDTree  # here: few worlds are so large

    found[there] = cKDTree(points).query(points, k=2)[0][:, 1]
    return found
