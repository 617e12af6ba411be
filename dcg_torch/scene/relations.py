"""How things stand to landmarks: above, beside, at which distance and on which side, closest to it of those alike.

Relations are families of values, of which at most one fires: to one landmark, or to two of them ("between").
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import TypeAlias

import numpy as np
from numpy.typing import NDArray

from dcg_torch.scene.layout import NEAREST, Layout
from dcg_torch.scene.neighbours import LEVEL, ONE_LEVEL, SAME_POINT, SAME_SPOT
from dcg_torch.scene.order import TIE, Alike, counted
from dcg_torch.scene.order import before as lower
from dcg_torch.scene.relation_names import DISTANCES, FRAMES, ORDERS, RELATIONS, VERTICAL
from dcg_torch.scene.row_cache import KeptRows
from dcg_torch.scene.views import views
from dcg_torch.types.arrays import Bools, Floats, Ints

_Over: TypeAlias = tuple[Bools, Bools] | None
"""See `Bodies.over`; None where of nothing it is known how large it is."""
_STARTS = np.cumsum([0, *map(len, RELATIONS.values())][:-1], dtype=np.int16)[:, None, None]
_COMPARED = [list(RELATIONS).index(order) for order in ORDERS]
_BETWEEN = list(RELATIONS).index("between")


class Relations:
    """The relation features of all things to landmarks. What is worked out of each is kept: in `standing`, `_standing`.

    Args:
        where: the things.
    """

    def __init__(self, where: Layout) -> None:
        self._where = where
        self.standing = KeptRows(lambda first: _standing(where, first), len(where.things))
        self._ordered: dict[str, KeptRows] = {}

    def to(
        self,
        landmarks: Sequence[Sequence[int]],
        among: str,
        members: Bools | None = None,
        ordinal: int | None = None,
        count: int | None = None,
    ) -> NDArray[np.int16]:
        """The features of every thing to every tuple of landmarks.

        Args:
            landmarks: c tuples of thing numbers, all as long; all but "between" is to the first of each.
            among: which of `SETS` "the closest" is one of.
            members: (n,) the things that it is one of, instead of such a set.
            ordinal: the place that is asked for, beyond those that are told apart: it stands for the last of them.
            count: how many are meant, the first of them together: "the two closest to the cone".

        Returns:
            (families, c, n) indices into `RELATION_NAMES`, -1 where no value of a family fires.
        """
        first = [of[0] for of in landmarks]
        found = self.standing.of(first)[0].copy()
        if members is None and ordinal is None and count is None:
            if among not in self._ordered:
                alike = self._where.alike(among)
                self._ordered[among] = KeptRows(lambda new: (self._orders(new, alike),), len(alike.code))
            (found[_COMPARED],) = self._ordered[among].of(first)
        else:
            kept = None if members is None else Alike.by(np.where(members & ~self._where.place, 0, -1))
            found[_COMPARED] = self._orders(np.array(first), kept or self._where.alike(among), ordinal, count)
        if landmarks and len(landmarks[0]) > 1:
            found[_BETWEEN] = between(self._where, landmarks)
        return found

    def _orders(self, first: Ints, alike: Alike, ordinal: int | None = None, count: int | None = None) -> Ints:
        _, distance, may = self.standing.of(first.tolist())
        return _orders(self._where, first, (distance, may), alike, ordinal, count)


def _standing(where: Layout, first: Ints) -> tuple[NDArray[np.int16], Floats, Bools]:
    """How things stand to c landmarks, whatever they are compared with.

    Returns:
        (families, c, n) indices into `RELATION_NAMES`, (c, n) how far they are from it, and which of them may be the
        closest or the farthest.
    """
    position, place = where.position, where.place[first][:, None]
    x, y, up = position.T[:, None, :] - position[first].T[:, :, None]  # (c, n) each
    touches, offset = None, (x, y)
    over = None if where.bodies is None else where.bodies.over(first, np.stack([x, y], axis=2))
    if where.wide is not None:
        half = where.half[first][:, None, :] + where.wide[first][:, None, :] + where.wide[None]
        x, y = (np.sign(v) * np.maximum(np.abs(v) - half[..., k], 0.0) for k, v in enumerate((x, y)))
        touches = (x == 0.0) & (y == 0.0)
    distance = np.hypot(x, y)
    itself = first[:, None] == np.arange(len(position))[None, :]
    exists = np.isfinite(distance) & ~itself
    # A line of the whole scene has everything near it: a thing is in it or not.
    alone = exists & ~where.line[first][:, None] if where.members else exists
    near = _nearness(where, distance, (np.abs(up) <= LEVEL) & (distance > SAME_POINT), place, over)
    steps = _BOUNDS.searchsorted(np.where(exists, near, 0.0))
    found = {
        "distance": np.where(alone & ~place, steps, -1),
        "vertical": _vertical(where, first, near, up, exists, over),
        "itself": (itself & ~place) - 1,
    }
    aside = exists & (near >= SAME_SPOT)
    if place.any():
        point = ~(where.direction | where.ground)[first][:, None]
        aside &= point & ~where.edge[first][:, None]  # an edge or a corner has no sides
        found["place distance"] = np.where(exists & place & point, steps, -1)
        found |= _headed(where, first, exists)
    if touches is not None:  # what touches is still on a side
        x, y = (np.where(touches, to, v) for to, v in zip(offset, (x, y), strict=True))
    found |= _sides(where, first, x, y, aside)
    if where.group[first].any():
        found |= _members(where, first)
    out = np.full((len(RELATIONS), *distance.shape), -1, dtype=np.int16)
    for of_family, family in zip(out, RELATIONS, strict=True):
        if family in found:
            of_family[:] = found[family]
    out += _STARTS * (out >= 0)
    return out, distance, alone


def _nearness(where: Layout, distance: Floats, level: Bools, place: Bools, over: _Over) -> Floats:
    """(c, n) the distance by which things are near: none of what is over or under, some of what is beside."""
    near = distance
    if over is None:  # two that stand on one level are not on one spot, however close
        near = np.where(level & ~place & where.solid[None], np.maximum(near, _BESIDE_IT), near)
    else:
        covers, apart = over
        near = np.where(apart, np.maximum(distance, _BESIDE_IT), distance)
        near = np.where(covers, np.minimum(near, 0.0), near)
    if where.picture:
        near = np.where(place | ~where.solid[None], near, np.maximum(near, _BESIDE_IT))
    return near


_BOUNDS = np.array(DISTANCES)
_VERTICAL = np.array(
    [
        [VERTICAL.index(name) for name in names]
        for names in (
            ("below", "below", "level", "above", "above"),
            ("lower under", "right under", "level", "on top", "higher over"),
        )
    ]
)
"""Values of "vertical" for what is not on the landmark's spot and what is, from far below to far above."""
_UP = np.array([*np.nextafter([-ONE_LEVEL, -LEVEL], -np.inf), LEVEL, ONE_LEVEL])
"""Heights from which on things are one step less far below, or farther above; a thing just at a bound is nearer."""

_BESIDE_IT = 0.7
"""Units at least between things that are known to cover no part of one another."""


def _vertical(where: Layout, first: Ints, distance: Floats, up: Floats, exists: Bools, over: _Over) -> Ints:
    """(c, n) which of `VERTICAL`, by heights, or by feet and tops where these are known."""
    step = _UP.searchsorted(up)  # 2 is on a level
    if where.bodies is not None and over is not None:
        covers, apart = over
        step = np.where(covers | apart, where.bodies.steps(first, covers) + 2, step)
    value = _VERTICAL[(distance < SAME_SPOT).astype(np.int64), np.minimum(step, 4)]
    if where.ground[first].any():
        on_ground = np.where(where.resting, VERTICAL.index("higher over"), VERTICAL.index("on top"))[None]
        value = np.where(where.ground[first][:, None], on_ground, value)
    out: Ints = np.where(exists & (where.solid | where.ground)[first][:, None], value, -1)
    return out


def _sides(where: Layout, first: Ints, x: Floats, y: Floats, sided: Bools) -> dict[str, Ints]:
    """On which side of the landmark, by the three frames."""
    bearing = np.arctan2(y, x)
    looks, seen = views(where, first, sided)
    found = dict(zip(FRAMES, np.where(seen, _sector(bearing - looks[:, :, None], seen), -1), strict=False))
    along, across = (sided & (np.abs(v) < SAME_SPOT) for v in (x, y))
    found["line"] = np.where(along, 0, np.where(across, 1, -1))
    return found


def _sector(angle: Floats, kept: Bools) -> Ints:
    """Which of the eight `SECTORS`, as seen by who looks along angle 0; any for what is not kept."""
    return np.rint(np.where(kept, angle, 0.0) / (math.pi / 4)).astype(np.int64) & 7


def _orders(
    where: Layout, first: Ints, measured: tuple[Floats, Bools], alike: Alike, ordinal: int | None, count: int | None
) -> Ints:
    """(2, c, n) indices of the closest and the farthest of those alike; in a direction, of the farthest that way.

    Args:
        measured: (c, n) how far things are from the landmarks, and which of them may be the closest.
        ordinal, count: see `Relations.to`.
    """
    distance, exists = measured
    value = distance
    towards = where.direction[first].nonzero()[0]
    if len(towards):
        value = distance.copy()
        value[towards] = -_ahead(where, first[towards])
    signed = np.where(exists, np.array([value, -value]), math.inf)
    most = max(NEAREST + (count or 1) - 1, ordinal or 0)
    before = counted(lower(signed.reshape(-1, value.shape[1]), alike, most).reshape(signed.shape), count)
    if ordinal is not None and ordinal > NEAREST:
        before = np.where(before == ordinal - 1, NEAREST - 1, np.where(before == NEAREST - 1, NEAREST, before))
    compared = exists & (alike.code >= 0) & (before < NEAREST)
    out: Ints = np.where(compared, before + _STARTS[_COMPARED], -1)
    return out


def _ahead(where: Layout, first: Ints) -> Floats:
    """(c, n) how far a thing is in the direction of each place that has one."""
    (x, y), (along, across) = _offset(where, first), where.heading[first].T[:, :, None]
    ahead: Floats = x * along + y * across
    return ahead


def _offset(where: Layout, first: Ints) -> Floats:
    """(2, c, n) from each landmark to every thing, along x and y."""
    position = where.position[:, :2]
    offset: Floats = position.T[:, None, :] - position[first].T[:, :, None]
    return offset


def _headed(where: Layout, first: Ints, exists: Bools) -> dict[str, Ints]:
    """To places that have a side: how far that way a thing is, and whether it is in that part of the scene."""
    found = {family: np.full(exists.shape, -1, dtype=np.int64) for family in ("direction", "part")}
    row = np.isfinite(where.heading[first, 0]).nonzero()[0]
    direction = where.direction[first]
    towards, sided = row[direction[row]], row[~direction[row]]
    if len(towards):
        x, y = _offset(where, first[towards])
        with np.errstate(invalid="ignore"):
            cosine = _ahead(where, first[towards]) / np.maximum(np.hypot(x, y), TIE)
            slant = _SLANTS.searchsorted(np.arccos(np.minimum(np.maximum(cosine, -1.0), 1.0)))
        found["direction"][towards] = np.where(exists[towards], slant, -1)
    if len(sided):
        found["part"][sided] = np.where(exists[sided], _part(where, where.heading[first[sided]][:, None, :]), -1)
    return found


_SLANTS = np.array((math.pi / 6, math.pi / 3, math.pi / 2))
"""Bounds of the angles between where a thing is and a direction."""


def _part(where: Layout, heading: Floats) -> Ints:
    """0 for a thing that is beyond the middle of the objects on every side that the place is at, else 1."""
    with np.errstate(invalid="ignore"):
        sides = np.sign(np.where(np.abs(heading) > TIE, heading, 0.0))
        beyond = (where.position[None, :, :2] - where.middle) * sides > TIE
        inside = (beyond | (sides == 0.0)).all(axis=2)
    return np.where(inside, 0, 1)


def _members(where: Layout, first: Ints) -> dict[str, Ints]:
    """To a group: is a thing in it, on top of it, at its end or in the middle?"""
    shape = (len(first), len(where.things))
    found = {family: np.full(shape, -1, dtype=np.int64) for family in ("member", "member top", "member place")}
    row = np.flatnonzero(where.group[first])
    members = [where.members[g] for g in first[row].tolist()]
    found["member"][row] = 1
    counts, inside = np.array([len(of) for of in members]), np.concatenate(members)
    starts, row, group = np.cumsum(counts) - counts, np.repeat(row, counts), np.repeat(first[row], counts)
    found["member"][row, inside] = 0
    height = where.position[inside, 2]
    found["member top"][row, inside] = height <= np.repeat(np.maximum.reduceat(height, starts), counts) - TIE
    reach = np.linalg.norm(where.position[inside] - where.position[group], axis=1)
    least, most = (np.repeat(of.reduceat(reach, starts), counts) for of in (np.minimum, np.maximum))
    end, middle = reach > most - 0.25, reach < np.minimum(0.25, least + TIE)
    found["member place"][row, inside] = np.where(middle, 1, np.where(end, 0, 2))
    return found


def between(where: Layout, landmarks: Sequence[Sequence[int]]) -> NDArray[np.int16]:
    """Is a thing between the first two landmarks: over their line, and not off to the side?

    Returns:
        (c, n) indices into `RELATION_NAMES`, -1 where there are no two.
    """
    position = where.position
    pairs = np.array([(of[0], of[1] if len(of) > 1 else of[0]) for of in landmarks], dtype=np.int64)
    start, span = position[pairs[:, 0], :2], position[pairs[:, 1], :2] - position[pairs[:, 0], :2]
    length = np.hypot(*span.T)
    offset = position[None, :, :2] - start[:, None, :]  # (c, n, 2)
    with np.errstate(invalid="ignore", divide="ignore"):
        along = np.einsum("cnd,cd->cn", offset, span) / length[:, None] ** 2
        aside = np.abs(offset[..., 1] * span[:, None, 0] - offset[..., 0] * span[:, None, 1]) / length[:, None]
        inside = (along > 0.05) & (along < 0.95) & (aside < np.maximum(SAME_SPOT, 0.35 * length)[:, None])
        apart = (pairs[:, 0] != pairs[:, 1]) & np.isfinite(length) & (length >= TIE)
    numbers = np.arange(len(position))
    end = (numbers[None] == pairs[:, :1]) | (numbers[None] == pairs[:, 1:])
    value = _STARTS[_BETWEEN] + np.where(inside, 0, 1)
    out: NDArray[np.int16] = np.where(apart[:, None] & ~end & np.isfinite(along), value, -1).astype(np.int16)
    return out
