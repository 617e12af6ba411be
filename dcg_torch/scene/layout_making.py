"""A world laid out: where its things are for who looks, as the arrays of a `Layout`."""

from __future__ import annotations

import functools
import math

import numpy as np

from dcg_torch.scene.bodies import Bodies, bodies, points
from dcg_torch.scene.layout import DIRECTION, EDGES, GROUND, HEADINGS, OF_SPEAKER, Layout
from dcg_torch.scene.order import TIE
from dcg_torch.scene.outlooks import outlooks
from dcg_torch.scene.upright_pictures import before_it, laid_flat
from dcg_torch.types import Object, Pose, WorldModel
from dcg_torch.types.arrays import Floats, Ints
from dcg_torch.types.geometry import positions, to_robot_frame

_ROBOT = "robot"


def layout(world: WorldModel) -> Layout:
    """The arrays of a world's things."""
    things = world.things
    n, robot = len(things), world.robot or Pose(0.0, 0.0)
    viewer = world.viewer or robot
    objects, placed = len(world.objects), n - len(world.places)
    position, on_floor = _as_seen(world, viewer)
    half = np.zeros((n, 2))
    half[placed:] = [(0.0, 0.0) if place.size is None else place.size[:2] for place in world.places] or 0.0
    half /= 2 * world.unit
    members = _members(world) if world.groups else {}
    if members:
        _of_groups(members, position, half)
    numbers = np.arange(n)
    place, group = numbers >= placed, (numbers >= objects) & (numbers < placed)
    middle = _middle(position[:objects, :2])
    none, types = [False] * placed, [place.type for place in world.places]
    direction, ground, edge = (
        np.array([*none, *[type_ in of for type_ in types]], dtype=np.bool_) for of in ((DIRECTION,), (GROUND,), EDGES)
    )
    speaker = None if world.speaker is None else _foot(world.speaker, viewer, world.unit)
    own = np.zeros(2) if world.viewer is None else _foot(robot, viewer, world.unit)
    if not on_floor and objects:
        own = before_it(position[:objects])[:2]
    heading = _headings(things, position, middle, None if world.viewer is None else robot.yaw - viewer.yaw)
    sized = bodies(world.objects, position[:, 2], viewer.yaw, world.unit) if on_floor else None
    return Layout(
        things,
        position,
        half,
        heading,
        group,
        place,
        direction,
        ground,
        edge,
        members,
        middle,
        own,
        speaker,
        sized,
        picture=not on_floor,
        outlook=_outlook(world, position, sized) if on_floor else None,
    )


def _outlook(world: WorldModel, position: Floats, sized: Bodies | None) -> Floats | None:
    """(n,) from where each thing is looked at in a room; see `outlooks`.

    Where a robot stands in the middle of the room that is so of what is at a wall, and NaN for all else.
    """
    classes = len({o.type for o in world.objects if not o.hypothetical})
    if world.viewer is not None:
        return None
    if world.robot is None:
        own = None if sized is None else sized.first(len(world.objects))  # places may be those of other rooms, too
        found = None if own is None else outlooks(position, own, classes, world.unit)
        return None if found is None else np.pad(found, (0, len(position) - len(found)))
    seen = position[: len(world.objects), :2]
    seen = seen[np.isfinite(seen).all(axis=1)]
    if not len(seen) or (seen.min(axis=0) >= 0.0).any() or (seen.max(axis=0) <= 0.0).any():
        return None
    at = positions(world.objects) / world.unit  # walls are along the axes of the world
    own = bodies(world.objects, at[:, 2], 0.0, world.unit) or points(len(at))
    found = outlooks(at, own, classes, world.unit, at_walls=True)
    if found is None:
        return None
    return np.pad(found - world.robot.yaw, (0, len(position) - len(found)), constant_values=math.nan)


def _as_seen(world: WorldModel, viewer: Pose) -> tuple[Floats, bool]:
    """(n, 3) where things are in the viewer's frame, in units, a picture laid flat; and is there no picture?"""
    position = positions(world.things)
    position[:, :2] = to_robot_frame(viewer, position[:, :2])
    seen = position[: len(world.objects)]
    flat = laid_flat(seen)
    position[: len(world.objects)] = flat
    if flat is not seen:
        position[[j for j in range(len(seen), len(position)) if world.things[j].type == _ROBOT]] = before_it(flat)
    position /= world.unit
    return position, flat is seen


def _foot(pose: Pose, viewer: Pose, unit: float) -> Floats:
    """(2,) where somebody stands in the viewer's frame, in units."""
    found: Floats = to_robot_frame(viewer, np.array([[pose.x, pose.y]]))[0] / unit
    return found


def _members(world: WorldModel) -> dict[int, Ints]:
    number = {o.id: j for j, o in enumerate(world.things)}
    first = len(world.objects)
    return {first + g: np.array([number[m] for m in o.members], dtype=np.int64) for g, o in enumerate(world.groups)}


def _of_groups(members: dict[int, Ints], position: Floats, half: Floats) -> None:
    """Where groups are, the mean of their members, and how far they reach; in place."""
    group, inside = list(members), np.concatenate(list(members.values()))
    counts = np.array([len(of) for of in members.values()])
    starts, own = np.cumsum(counts) - counts, position[inside]
    which = np.repeat(np.arange(len(group)), counts)
    total = [np.bincount(which, axis) for axis in own.T]  # member after member: the same bits every time
    position[group] = np.transpose(total / counts)
    reach = np.maximum.reduceat(own[:, :2], starts, axis=0) - np.minimum.reduceat(own[:, :2], starts, axis=0)
    half[group] = reach / 2


def _middle(seen: Floats) -> Floats:
    """(2,) the mean of where the objects are that are somewhere."""
    there = np.isfinite(seen).all(axis=1)
    middle: Floats = seen[there].sum(axis=0) / max(1, np.count_nonzero(there))
    return middle


def _headings(things: tuple[Object, ...], position: Floats, middle: Floats, turned: float | None) -> Floats:
    """Where the side of each place is; the speaker is taken to look at the middle of the objects.

    Args:
        turned: the angle from where another viewer looks to where the robot does; None: the robot is the viewer.
    """
    out = np.full((len(things), 2), math.nan)
    for j, thing in [(j, thing) for j, thing in enumerate(things) if thing.attributes and not thing.members]:
        if (side := _side(thing.attributes)) is None:
            continue
        x, y = side
        if OF_SPEAKER in thing.attributes:
            view = middle - position[j, :2] if turned is None else np.array([math.cos(turned), math.sin(turned)])
            ahead = view / max(float(np.hypot(*view)), TIE)
            out[j] = x * ahead + y * np.array([-ahead[1], ahead[0]])
        else:
            out[j] = x, y
    return out


@functools.lru_cache(maxsize=1024)
def _side(attributes: frozenset[str]) -> tuple[float, float] | None:
    """The direction of a side in the frame of who looks; None for what has none."""
    sides = [HEADINGS[a] for a in sorted(attributes) if a in HEADINGS]
    if not sides:
        return None
    x, y = np.sum(sides, axis=0) / math.sqrt(len(sides))
    return float(x), float(y)
