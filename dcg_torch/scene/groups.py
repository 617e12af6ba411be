"""Groups of objects that people speak of as one: rows, stacks, what lies close together, the lines of a whole scene.

A row is evenly spaced, or it is a group of neighbours that lie along a line. Groups of neighbours are the clusters of
single linkage, at every distance at which one ends: what is closer to one another than to anything else alike. "The
third row" counts through all that is there, as one reads a page: a thing is in one such line across and in one along.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from dataclasses import replace

import numpy as np

from dcg_torch.names.vocabulary import LINE_ACROSS, LINE_ALONG, MIDDLE_LINE
from dcg_torch.scene.clusters import clusters
from dcg_torch.scene.neighbours import LEVEL, SAME_SPOT, nearest_other
from dcg_torch.scene.order import TIE
from dcg_torch.scene.upright_pictures import laid_flat
from dcg_torch.types import Object, Pose
from dcg_torch.types.arrays import Floats, Ints
from dcg_torch.types.geometry import positions, to_robot_frame

ROW, STACK, CLUSTER = "row", "stack", "cluster"
ACROSS, ALONG = "lies across", "lies along"
"""How a row lies for the robot: from its left to its right, or away from it."""
_UNEVEN = 0.6
"""How far the next of an even row may stand from where it is due, as a share of the step."""
_HALFWAY = 0.25
"""How near to the middle of a step another thing stands that the step would leave out, as a share of the step."""
_STEP = 2.0
"""Neighbours in an even row are at most so many times as far apart as the nearest ones."""
_LEAST = 3
"""Members of a row or cluster; a stack has two."""
_MOST = {"row": 12, "stack": 48, "cluster": 12}
"""Groups of each kind that are kept: the largest."""
_ASIDE = 0.2
"""How far from its line a member of a row may stand, as a share of half the row's length."""
_FEW = 40
"""Things up to which all classes are looked at together."""
_CHUNK = 1024
"""Steps that are looked at together."""
_MANY, _NEIGHBOURS = 512, 33
"""Things from which near ones are found with a tree, and how many of them are looked at."""


def groups(
    objects: Sequence[Object], unit: float = 1.0, robot: Pose | None = None, *, pairs: bool = False
) -> tuple[Object, ...]:
    """The groups that objects form.

    They are looked for among all objects, among those of one type, and among those of one type and colour. A group
    has the type and the colour that its members share, a stack the type of those under its top, and says what it is,
    how many they are, and how a row lies, in its attributes.

    Args:
        objects: those without a position are in no group.
        unit: metres in a unit of length, see `layout`.
        robot: for whom a row lies across or along.
        pairs: do two that are each other's nearest form one, too?
    """
    there = [o for o in objects if o.position is not None]
    if len(there) < 2:
        return ()
    position = _seen(there, unit, robot)
    found: dict[str, set[tuple[int, ...]]] = {ROW: set(), STACK: set(_stacks(position)), CLUSTER: set()}
    position = _drawn_apart(position)
    for numbers, code in _compared(there):
        points = position[numbers]
        found[ROW].update(_numbers_of(_even_rows(points, code), numbers))
        found[CLUSTER].update(_numbers_of(clusters(points, code, pairs=pairs), numbers))
    place = position.tolist()
    found[ROW].update(members for members in found[CLUSTER] if in_line([place[j] for j in members]))
    return tuple(
        _group(kind, [there[j] for j in members], [place[j] for j in members])
        for kind, of_kind in found.items()
        for members in sorted(of_kind, key=lambda m: (-len(m), m))[: _MOST[kind]]
    )


def stacks(objects: Sequence[Object], unit: float = 1.0, robot: Pose | None = None) -> list[list[Object]]:
    """The things of each stack, from below; arguments as of `groups`."""
    there = [o for o in objects if o.position is not None]
    heights = [(o.position or (0.0, 0.0, 0.0))[2] for o in there]
    found = _stacks(_seen(there, unit, robot)) if len(there) > 1 else ()
    return [[there[j] for j in sorted(of, key=heights.__getitem__)] for of in found]


def _drawn_apart(position: Floats) -> Floats:
    """Positions (n, 3); where all is on one level none is over another, and the nearest two are drawn apart so far."""
    if np.ptp(position[:, 2]) > TIE:
        return position
    nearest = float(nearest_other(position * (1.0, 1.0, 0.0)).min())
    return position * (1.01 * SAME_SPOT / nearest) if TIE < nearest <= SAME_SPOT else position


def _compared(objects: Sequence[Object]) -> Iterable[tuple[Ints, Ints]]:
    """The numbers of objects and the class of each: one of all, those of one type, those of one type and colour.

    Few are looked at in all classes at once, so that an object is there once for each; many class by class.
    """
    alike: dict[tuple[str | None, ...], list[int]] = {(): list(range(len(objects)))}
    for j, o in enumerate(objects):
        alike.setdefault((o.type,), []).append(j)
        alike.setdefault((o.type, o.color), []).append(j)
    classes = list(dict.fromkeys(tuple(members) for members in alike.values() if len(members) >= _LEAST))
    together = [classes] if len(objects) <= _FEW else [[members] for members in classes]
    for some in filter(None, together):
        numbers = np.array([j for members in some for j in members], dtype=np.int64)
        yield numbers, np.repeat(np.arange(len(some)), [len(members) for members in some])


def _numbers_of(found: Iterable[Sequence[int]], numbers: Ints) -> Iterable[tuple[int, ...]]:
    own = numbers.tolist()
    return (tuple(sorted([own[k] for k in members])) for members in found)


def lines_of_all(objects: Sequence[Object], unit: float = 1.0, robot: Pose | None = None) -> tuple[Object, ...]:
    """The rows and the columns of a whole scene, each with its number from either end in its attributes.

    Of a stack the top alone is counted.
    """
    there = [o for o in objects if o.position is not None]
    if not there:
        return ()
    position = _seen(there, unit, robot)
    top, found = _uncovered(position), []
    for kind, (axis, first, last) in _LINES.items():
        lines = list(_parted(-position[:, axis], top))
        for k, members in enumerate(lines):
            line = _group(kind, [there[j] for j in members], position[members].tolist())
            counted = {f"{k + 1} from the {first}", f"{len(lines) - k} from the {last}"}
            counted |= {MIDDLE_LINE} if 2 * k + 1 == len(lines) else set()
            found.append(replace(line, attributes=line.attributes | counted))
    return tuple(found)


def _seen(objects: Sequence[Object], unit: float, robot: Pose | None) -> Floats:
    """(n, 3) positions in units, as the robot sees them."""
    position = positions(objects)
    position[:, :2] = to_robot_frame(robot or Pose(0.0, 0.0), position[:, :2])
    seen: Floats = laid_flat(position) / unit
    return seen


def _group(kind: str, members: Sequence[Object], position: Sequence[Sequence[float]]) -> Object:
    ids = tuple([o.id for o in members])
    types, colors = {o.type for o in members}, {o.color for o in members}
    if kind == STACK and len(types) > 1:
        types = _types_under_the_top(members, position)
    one_type = next(iter(types)) if len(types) == 1 else None
    attributes = {kind, f"of {len(members)}"}
    if kind == ROW:
        deep, wide, _ = map(_extent, zip(*position, strict=True))
        attributes.add(ACROSS if wide >= deep else ALONG)
    return Object(
        id=f"{kind}: {' '.join(ids)}",
        type=one_type,
        known=one_type is not None and all(o.known for o in members if o.type == one_type),
        color=next(iter(colors)) if len(colors) == 1 else None,
        position=members[0].position,
        attributes=frozenset(attributes),
        members=ids,
    )


def _types_under_the_top(members: Sequence[Object], position: Sequence[Sequence[float]]) -> set[str | None]:
    """Of a stack: the ball on a stack of cubes is none of these; of a ball on one cube neither is a stack."""
    heights = [z for _, _, z in position]
    top = heights.index(max(heights)) if len(members) > 2 else -1
    return {o.type for k, o in enumerate(members) if k != top}


def _extent(values: Sequence[float]) -> float:
    return max(values) - min(values)


def _even_rows(points: Floats, code: Ints) -> Iterable[list[int]]:
    """Maximal runs of at least `_LEAST` of one class in a straight line on one level, one step apart."""
    follow = _next_steps(points, code)
    for i, j in follow:
        if (j, i) in follow:
            continue  # this is not an end of the row
        run = [i, j]
        while (after := follow.get((run[-2], run[-1]))) is not None and after not in run:
            run.append(after)
        if run[0] < run[-1]:
            yield run


def _next_steps(points: Floats, code: Ints) -> dict[tuple[int, int], int]:
    """Which thing stands one more step on, of each step (i, j) between two that are next to each other on a level."""
    i, j = _steps(points, code)
    length = np.hypot(*(points[j] - points[i])[:, :2].T)
    middle, due = (points[i] + points[j]) / 2.0, 2.0 * points[j] - points[i]
    best, away = _nearest_to(points, np.concatenate([middle, due]), code, np.concatenate([code[i], code[i]]))
    inside, miss = away[: len(i)], away[len(i) :]
    kept = (inside > _HALFWAY * length) & (miss < _UNEVEN * length)  # a row leaves out none of its own
    pairs = zip(i[kept].tolist(), j[kept].tolist(), strict=True)
    return dict(zip(pairs, best[len(i) :][kept].tolist(), strict=True))


def _steps(points: Floats, code: Ints) -> tuple[Ints, Ints]:
    """The pairs of things of a class on one level that are about as near to each other as either is to any of it."""
    if len(points) <= _MANY:
        i, j = np.nonzero(code[:, None] == code[None, :])
        x, y, z = (own[j] - own[i] for own in points.T)
        distance = np.hypot(x, y)
        apart = np.where((np.abs(z) < SAME_SPOT) & (distance > SAME_SPOT), distance, np.inf)
        nearest = np.minimum.reduceat(apart, np.searchsorted(i, np.arange(len(points))))
        near = apart < _STEP * np.minimum(nearest[i], nearest[j]) + 1e-6
        return i[near], j[near]
    from scipy.spatial import cKDTree  # here: few worlds are so large

    tree = cKDTree(points[:, :2])
    distance, others = tree.query(points[:, :2], k=min(_NEIGHBOURS, len(points)))
    level = np.abs(points[others, 2] - points[:, None, 2]) < SAME_SPOT
    apart = np.where(level & (distance > SAME_SPOT), distance, np.inf)
    nearest = apart.min(axis=1)
    i, k = np.nonzero(apart < _STEP * np.minimum(nearest[:, None], nearest[others]) + 1e-6)
    return i, others[i, k]


def _nearest_to(points: Floats, places: Floats, code: Ints, wanted: Ints) -> tuple[Ints, Floats]:
    """The thing of a wanted class that is nearest to each of some places, and how far it is from it."""
    if len(points) > _MANY:
        from scipy.spatial import cKDTree  # here: few worlds are so large

        distance, number = cKDTree(points).query(places)
        return number, distance
    found, missed = [], []
    axes = points.T if np.ptp(points[:, 2]) > 0.0 else points.T[:2]
    for start in range(0, len(places) or 1, _CHUNK):
        part = slice(start, start + _CHUNK)
        square = sum((own[None, :] - due[:, None]) ** 2 for own, due in zip(axes, places[part].T, strict=False))
        square[code[None, :] != wanted[part, None]] = np.inf
        found.append(square.argmin(axis=1))
        missed.append(np.sqrt(square[np.arange(len(square)), found[-1]]))
    return np.concatenate(found), np.concatenate(missed)


def in_line(points: Sequence[Sequence[float]]) -> bool:
    """Do points lie along a line on one level? It is the axis along which they are spread most."""
    x, y, z = zip(*points, strict=True)
    if _extent(z) >= SAME_SPOT:
        return False
    middle = sum(x) / len(x), sum(y) / len(y)
    there = [(a - middle[0], b - middle[1]) for a, b in zip(x, y, strict=True)]
    spread = sum([(a - b) * (a + b) for a, b in there])
    angle = math.atan2(2.0 * sum([a * b for a, b in there]), spread) / 2.0
    c, s = math.cos(angle), math.sin(angle)
    along = max([abs(a * c + b * s) for a, b in there])
    aside = max([abs(b * c - a * s) for a, b in there])
    return bool(aside <= _ASIDE * along)


_LINES = {LINE_ACROSS: (0, "top", "bottom"), LINE_ALONG: (1, "left", "right")}
"""Lines -> the axis on which their things have about one value, and from which ends they are counted."""


def _parted(value: Floats, kept: Ints) -> Iterable[list[int]]:
    """Those that are kept, parted where one's value is too far from the mean of those before it."""
    line: list[int] = []
    total = 0.0
    for k in kept[np.argsort(value[kept], kind="stable")].tolist():
        if line and value[k] - total / len(line) > SAME_SPOT:
            yield line
            line, total = [], 0.0
        line.append(k)
        total += float(value[k])
    yield line


def _uncovered(position: Floats) -> Ints:
    """The numbers of things with none over them: of a stack one counts."""
    i, j = _over(position)
    free = np.ones(len(position), dtype=np.bool_)
    free[np.where(position[i, 2] > position[j, 2], j, i)] = False
    return np.flatnonzero(free)


def _stacks(position: Floats) -> Iterable[tuple[int, ...]]:
    """Things over one another."""
    height = position[:, 2].tolist()
    if _extent(height) <= LEVEL:
        return ()
    stack = {j: {j} for j in range(len(position))}
    for i, j in zip(*(numbers.tolist() for numbers in _over(position)), strict=True):
        if stack[i] is not stack[j]:
            stack[i] |= stack[j]
            stack |= dict.fromkeys(stack[j], stack[i])
    return (tuple(sorted(of)) for of in stack.values() if len(of) >= 2)


def _over(position: Floats) -> tuple[Ints, Ints]:
    """The pairs of things of which one is over the other, the lower number first, in the order of their numbers."""
    i, j = _close_pairs(position[:, :2], SAME_SPOT)
    apart = np.abs(position[i, 2] - position[j, 2]) > LEVEL
    return i[apart], j[apart]


def _close_pairs(points: Floats, reach: float) -> tuple[Ints, Ints]:
    """The pairs of points (n, 2) that are less than so far apart, the lower number first, in the order of numbers."""
    if len(points) <= _MANY:
        x, y = (own[None, :] - own[:, None] for own in points.T)
        i, j = np.nonzero(np.sqrt(x * x + y * y) < reach)
        return i[i < j], j[i < j]
    from scipy.spatial import cKDTree  # here: few worlds are so large

    i, j = cKDTree(points).query_pairs(reach, output_type="ndarray").T
    near = np.linalg.norm(points[i] - points[j], axis=1) < reach
    i, j = i[near], j[near]
    order = np.lexsort((j, i))
    return i[order], j[order]
