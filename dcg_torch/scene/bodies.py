"""How large things are where somebody says so: what they cover of the floor, what rests on what, what is beside what.

A bed is no point: a pillow at its end is on it, and a lamp at its end is next to it.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from dcg_torch.types import Object
from dcg_torch.types.arrays import Bools, Floats, Ints

_POINT = 0.5
"""Half extents in units up to which a thing counts as a point: of what is as wide as neighbours are apart."""
_RESTS = 0.12
"""Units between the foot of one thing and the top of another within which the one rests on the other."""
_FOOT = 0.4
"""Share of its height from which on a thing's position is its middle and not its foot."""
_RIM, _BOARD = 0.05, 0.15
"""Metres that what is in a thing may be beyond its rim, and that boards are apart at least."""
_COVERED = 0.2
"""Share of the smaller of two widths that two footprints have to share, so that one is over the other."""


@dataclass(frozen=True)
class Bodies:
    """The extents of n things, lengths in units of the world; NaN where nobody says how large one is.

    Attributes:
        half: (n, 2) half extents in x and y.
        bottom, top: (n,) heights.
    """

    half: Floats
    bottom: Floats
    top: Floats

    @property
    def wide(self) -> Floats:
        """(n, 2) what of the half extents makes it more than a point."""
        wide: Floats = np.nan_to_num(np.maximum(0.0, self.half - _POINT))
        return wide

    def first(self, number: int) -> Bodies:
        """Those of so many of the things, the first ones."""
        return Bodies(self.half[:number], self.bottom[:number], self.top[:number])

    def over(self, first: Ints, offset: Floats) -> tuple[Bools, Bools]:
        """(c, n) things whose footprint shares much with that of a landmark, and those of which it doesn't.

        Args:
            first: (c,) numbers of the landmarks.
            offset: (c, n, 2 or more) from them to each thing.
        """
        one, other = self.half[first][:, None, :], self.half[None]
        reach = one + other - _COVERED * 2.0 * np.minimum(one, other)
        known = np.isfinite(reach).all(axis=2)
        with np.errstate(invalid="ignore"):
            near: Bools = np.abs(offset[..., :2]) < reach
        covers: Bools = known & near[..., 0] & near[..., 1]
        return covers, known & ~covers

    def steps(self, first: Ints, covers: Bools) -> Ints:
        """(c, n) where sizes are known, how far up a thing is: 1 is on the landmark, 2 above it, 0 on a level; so down.

        Of two that stand on one floor and cover each other the smaller and lower one is under the other.
        """
        foot, head = self.bottom[first][:, None], self.top[first][:, None]
        area = self.half.prod(axis=1)
        with np.errstate(invalid="ignore"):
            above, below = self.bottom[None] - head, foot - self.top[None]
            lifted = self.bottom[None] - foot
            least = np.where(covers, -_RESTS, np.where(np.abs(lifted) < _RESTS, np.inf, 0.0))
            step = (above > least).astype(np.int64) + (above > np.maximum(least, _RESTS))
            step -= (below > least).astype(np.int64) + (below > np.maximum(least, _RESTS))
            inside = covers & (step == 0)
            smaller, lower = area[None] < area[first][:, None], self.top[None] < head
            under = (smaller & lower).astype(np.int64) - (~smaller & (self.top[None] > head))
            within = np.where(np.abs(lifted) > _RESTS, np.sign(np.nan_to_num(lifted)), -under)
        out: Ints = np.where(inside, within, step).astype(np.int64)
        return out


def bulk(size: tuple[float, float, float]) -> float:
    """The volume of a thing; of a flat one, as in a picture, the area. NaN stays NaN.

    >>> bulk((0.5, 2.0, 2.0)), bulk((0.0, 0.5, 2.0))
    (2.0, 1.0)
    """
    extents = [extent for extent in size if extent != 0.0]
    return math.prod(extents) if extents else 0.0


def boards(objects: Sequence[Object]) -> dict[str, dict[str, float]]:
    """Id of what has boards, as a rack or a bookcase -> ids of what stands on them, and its height in metres.

    They are told by what stands in it at several heights, not all on the floor that it stands on.
    """
    there = [o for o in objects if o.size is not None and o.position is not None]
    at = np.array([o.position for o in there]).reshape(-1, 3)
    size = np.array([o.size for o in there]).reshape(-1, 3)
    if len(at) and not (at[:, 2] < _FOOT * size[:, 2]).any():
        at[:, 2] -= size[:, 2] / 2.0
    found = {}
    for k in np.flatnonzero((size > (0.0, 0.0, 2.0 * _BOARD)).all(axis=1)).tolist():
        off = at - at[k]
        inside = (np.abs(off[:, :2]) <= size[k, :2] / 2.0 + _RIM).all(axis=1) & (size[:, :2] <= size[k, :2]).all(axis=1)
        inside &= (off[:, 2] > -_RIM) & (off[:, 2] + size[:, 2] / 2.0 < size[k, 2] - _RIM)
        inside[k] = False
        heights = off[inside, 2]
        if len(heights) and heights.max() > _BOARD and np.ptp(heights) > _BOARD:
            found[there[k].id] = {there[j].id: float(at[j, 2]) for j in np.flatnonzero(inside).tolist()}
    return found


def gap(one: Object, other: Object) -> float:
    """Metres between the footprints of two things that stand somewhere, along the axes of the world; 0 where they share
    floor. What has no extents is a point."""
    if one.position is None or other.position is None:
        return math.inf
    half = [sum(0.0 if o.size is None else o.size[k] / 2.0 for o in (one, other)) for k in (0, 1)]
    return math.hypot(*(max(0.0, abs(one.position[k] - other.position[k]) - half[k]) for k in (0, 1)))


def points(number: int) -> Bodies:
    """So many things of which nobody says how large they are."""
    return Bodies(np.full((number, 2), math.nan), np.full(number, math.nan), np.full(number, math.nan))


def bodies(objects: Sequence[Object], height: Floats, turned: float, unit: float) -> Bodies | None:
    """How large things are; None where of none it is known.

    A position may be a thing's foot or its middle. It is the foot if anything would else be half in the floor.

    Args:
        objects: the first of the things.
        height: (n,) of each thing's position, in units.
        turned: the angle by which who looks has turned from the world's x axis, in radians.
    """
    size = np.full((len(height), 3), math.nan)
    for j, thing in enumerate(objects):
        if thing.size is not None and min(thing.size) > 0.0:
            size[j] = thing.size
    if np.isnan(size).all():
        return None
    half = size / 2.0 / unit
    along, across = abs(math.cos(turned)), abs(math.sin(turned))
    flat = half[:, :2] * along + half[:, 1::-1] * across
    with np.errstate(invalid="ignore"):
        on_foot = bool((height < 2.0 * _FOOT * half[:, 2]).any())
    bottom = height if on_foot else height - half[:, 2]
    return Bodies(flat, bottom + 0.0 * half[:, 2], bottom + 2.0 * half[:, 2])
