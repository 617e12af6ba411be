"""Clusters of single linkage: what is closer to one another than to anything else alike."""

from __future__ import annotations

from collections.abc import Iterable

import numpy as np

from dcg_torch.scene.neighbours import SAME_SPOT
from dcg_torch.types.arrays import Floats, Ints

_LEAST = 3
"""Spots that a cluster is on."""
_SPREAD = 2.4
"""The farthest neighbours in a group are at most so many times as far apart as the nearest."""
_APART = 1.25
"""A group's nearest neighbour is at least so many times as far as its members are from one another."""
_FEW = 40
"""Things up to which all distances are sorted."""


def clusters(points: Floats, code: Ints, *, pairs: bool = False) -> Iterable[list[int]]:
    """The clusters of single linkage, on at least `_LEAST` spots, that are closer together than to anything else.

    Those of each class by itself.

    Args:
        pairs: with any two that are each other's nearest, too.
    """
    n = len(points)
    merges = _single_linkage(points[:, :2], code)
    members: list[list[int]] = [[k] for k in range(n)]
    spots = [1] * n  # how many places seen from above a cluster is at
    first = [np.inf] * n  # the distance at which the first two of a cluster come together
    ends = [np.inf] * (n + len(merges))  # the distance at which a cluster becomes part of a larger one
    for one, other, distance in merges:
        ends[one] = ends[other] = distance
        first.append(min(first[one], first[other], max(distance, SAME_SPOT)))
        spots.append(spots[one] + spots[other] - (distance < SAME_SPOT))
        members.append(members[one] + members[other])
    for k, (_, _, distance) in enumerate(merges, start=n):
        last = max(distance, SAME_SPOT)
        if pairs and len(members[k]) == 2 and spots[k] == 2:
            yield members[k]
        if last <= _SPREAD * first[k] and ends[k] >= _APART * last and spots[k] >= _LEAST:
            yield members[k]


def _single_linkage(points: Floats, code: Ints) -> list[tuple[int, int, float]]:
    """Which two clusters come together at which distance, the n points being the first ones."""
    n = len(points)
    if code[-1] == 0 and n > _FEW:
        from scipy.cluster.hierarchy import linkage  # here: few commands speak of groups, and it takes a while

        return [(int(one), int(other), distance) for one, other, distance, _ in linkage(points, "single").tolist()]
    every = np.arange(n)
    i, j = ((code[:, None] == code) & (every[:, None] < every)).nonzero()
    x, y = (own[i] - own[j] for own in points.T)
    apart = np.sqrt(x * x + y * y)
    order = np.argsort(apart, kind="stable")
    cluster, members, found = list(range(n)), [[k] for k in range(n)], list[tuple[int, int, float]]()
    last = 2 * n - len(set(code.tolist())) - 1  # then each class is one
    for one, other, distance in zip(i[order].tolist(), j[order].tolist(), apart[order].tolist(), strict=True):
        left, right = cluster[one], cluster[other]
        if left == right:
            continue
        joined, number = members[left] + members[right], len(members)
        members.append(joined)
        for k in joined:
            cluster[k] = number
        found.append((left, right, distance))
        if number == last:
            break
    return found
