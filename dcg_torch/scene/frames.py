"""Whose eyes a scene is seen with: "on the right" may be the robot's right or that of the speaker who faces it."""

from __future__ import annotations

import math
from collections.abc import Collection
from dataclasses import replace

import numpy as np

from dcg_torch.scene.layout import OF_ROBOT, OF_SPEAKER
from dcg_torch.scene.layout_making import layout
from dcg_torch.scene.places import places, scene_bounds
from dcg_torch.types import Object, Pose, WorldModel
from dcg_torch.types.geometry import wrap_angle

_ALIKE = math.pi / 4
"""Views that differ by less than this name the same sides."""
_QUARTERS = ("far side", "left side", "near side", "right side")
"""The sides of who looks, each a quarter turn to the left of the one before."""
_OTHER = {OF_ROBOT: OF_SPEAKER, OF_SPEAKER: OF_ROBOT}


def seen_by_speaker(world: WorldModel) -> WorldModel | None:
    """The world in which sides that nobody owns are the speaker's; None where they are the robot's as well.

    The speaker is taken to look at the middle of the objects, and changes places with the robot: what was the robot's
    left is the speaker's. So "your" and "my" change places too, in what is grounded there (`grounding.frames`).
    """
    middle = _middle(world)
    if world.speaker is None or world.robot is None or middle is None:
        return None
    x, y = middle
    if math.hypot(x - world.speaker.x, y - world.speaker.y) < 1e-9:
        return None
    viewer = Pose(world.speaker.x, world.speaker.y, math.atan2(y - world.speaker.y, x - world.speaker.x))
    turned = wrap_angle(world.robot.yaw - viewer.yaw)
    if abs(turned) < _ALIKE:
        return None
    return _turned(world, viewer)


def seen_facing(world: WorldModel, thing: Object, *, away: bool = False) -> WorldModel | None:
    """The world as who stands in the middle of it and faces a thing sees it; None where that can't be told.

    Args:
        away: has the viewer the back to the thing, and looks from there to the middle?
    """
    middle = _middle(world)
    if middle is None or thing.position is None:
        return None
    among = world.robot is not None and not away and _is_among(world.robot, world)
    x, y = (world.robot.x, world.robot.y) if among and world.robot is not None else middle
    ahead = (thing.position[0] - x, thing.position[1] - y)
    if math.hypot(*ahead) < world.unit / 2.0:
        return None
    yaw = _square_to(thing, world, _straight_at(thing, ahead))
    if away:
        return _standing(world, Pose(*thing.position[:2], wrap_angle(yaw + math.pi)))
    viewer = Pose(x, y, yaw) if among else _at_the_other_wall(world, Pose(x, y, yaw))
    turned = _turned(world, viewer)
    return replace(turned, places=_bordered_anew(turned.places, world, viewer))


def _at_the_other_wall(world: WorldModel, viewer: Pose) -> Pose:
    """Where nobody knows where somebody stands, all is before them, and nothing has its sides the other way round."""
    ahead = np.array([math.cos(viewer.yaw), math.sin(viewer.yaw)])
    there = [o.position[:2] for o in world.objects if o.position is not None]
    back = min(0.0, float(((np.array(there) - (viewer.x, viewer.y)) @ ahead).min()) - world.unit)
    return Pose(viewer.x + back * float(ahead[0]), viewer.y + back * float(ahead[1]), viewer.yaw)


def seen_before(world: WorldModel, ids: Collection[str]) -> WorldModel | None:
    """The world as who stands before some things sees it, in a room where nobody knows who stands where.

    Args:
        ids: of two things or more.

    Returns:
        None where most of them are not looked at from one side, and where somebody is known to look.
    """
    middle = _middle(world)
    outlook = layout(world).outlook if world.robot is None and world.viewer is None else None
    angles = [] if outlook is None else [float(a) for o, a in zip(world.objects, outlook, strict=False) if o.id in ids]
    if middle is None or len(angles) < 2:
        return None
    alike = [[a for a in angles if abs(wrap_angle(a - one)) < _ALIKE] for one in angles]
    most = max(alike, key=len)
    if len(most) < 2 or 2 * len(most) <= len(angles):
        return None
    viewer = Pose(*middle, math.atan2(sum(map(math.sin, most)), sum(map(math.cos, most))))
    turned = _turned(world, viewer)
    return replace(turned, places=_bordered_anew(turned.places, world, viewer))


def _standing(world: WorldModel, at: Pose) -> WorldModel:
    """The world as if the robot stood somewhere, and had its own left and right there."""
    there = [o.position for o in world.objects if o.position is not None]
    edges = any(place.type in _OF_A_BOX for place in world.places)
    return replace(world, robot=at, viewer=None, places=places(scene_bounds(there, at) if edges else None, at, None))


def _bordered_anew(found: tuple[Object, ...], world: WorldModel, viewer: Pose) -> tuple[Object, ...]:
    """Places with the edges of a box around the objects that is as the viewer looks: a room's own walls may be aslant,
    and who stands at a slant has no wall on the left."""
    there = [o.position for o in world.objects if o.position is not None]
    others = tuple(place for place in found if place.type not in _OF_A_BOX)
    if len(others) == len(found) or not there:
        return found
    boxed = places(scene_bounds(there, viewer), viewer, None)
    return (*(place for place in boxed if place.type in _OF_A_BOX), *others)


_OF_A_BOX = frozenset({"edge", "corner", "middle"})
"""The places that a box around all objects has."""


def _straight_at(thing: Object, ahead: tuple[float, float]) -> float:
    """The heading of who faces a thing: straight at what hangs flat on a wall, a window or a whiteboard."""
    deep, wide = (1.0, 1.0) if thing.size is None else thing.size[:2]
    if _FLAT * deep < wide and ahead[0]:
        return 0.0 if ahead[0] > 0.0 else math.pi
    if _FLAT * wide < deep and ahead[1]:
        return math.copysign(math.pi / 2.0, ahead[1])
    return math.atan2(ahead[1], ahead[0])


def _square_to(thing: Object, world: WorldModel, yaw: float) -> float:
    """Who faces a stove faces the wall behind it, where nobody knows who stands where; `yaw` is straight at it."""
    outlook = layout(world).outlook if world.robot is None else None
    number = next((j for j, o in enumerate(world.objects) if o.id == thing.id), None)
    if outlook is None or number is None:
        return yaw
    seen = float(outlook[number])
    return seen if abs(wrap_angle(seen - yaw)) < _SLANTED else yaw


_SLANTED = math.radians(80.0)
"""Up to which a thing that stands at a wall may be aslant from the middle of the room."""
_FLAT = 4.0
"""How many times as wide as deep a thing is that hangs flat on a wall."""


def _middle(world: WorldModel) -> tuple[float, float] | None:
    there = [o.position[:2] for o in world.objects if o.position is not None]
    if not there:
        return None
    x, y = np.mean(there, axis=0).tolist()
    return x, y


def _is_among(robot: Pose, world: WorldModel) -> bool:
    """Whether a robot stands in the room, with things on all sides of it."""
    there = np.array([o.position[:2] for o in world.objects if o.position is not None]) - (robot.x, robot.y)
    return bool((there.min(axis=0) < -world.unit).all() and (there.max(axis=0) > world.unit).all())


def _turned(world: WorldModel, viewer: Pose) -> WorldModel:
    yaw = 0.0 if world.robot is None else world.robot.yaw
    quarters = round(wrap_angle(yaw - viewer.yaw) / (math.pi / 2)) % 4
    return replace(world, viewer=viewer, places=tuple(_named(place, quarters) for place in world.places))


def _named(place: Object, quarters: int) -> Object:
    """A place with the names of its sides to a viewer from whom the robot's view is turned by so many quarters."""
    if owner := place.attributes & _OTHER.keys():
        return replace(place, attributes=place.attributes - owner | {_OTHER[one] for one in owner})
    sides = {_QUARTERS[(_QUARTERS.index(a) + quarters) % 4] if a in _QUARTERS else a for a in place.attributes}
    return replace(place, attributes=frozenset(sides))
