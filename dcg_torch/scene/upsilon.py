"""Upsilon, the world model: what is perceived, and what may be there unseen (Alg. 1, lines 8 and 9)."""

from __future__ import annotations

import math
from collections.abc import Collection, Iterable
from dataclasses import replace

from dcg_torch.scene.percepts import checked, checked_pose
from dcg_torch.types import Object, Percept, Pose, WorldModel

HYPOTHETICAL_UNKNOWN = "hypothetical unknown"
_MANY = 1000
"""Objects up to which they are put in order."""


def perceive_objects(
    percepts: Iterable[Percept], known_types: Collection[str], *, unknown: bool = True
) -> list[Object]:
    """The perceived part of Upsilon: KP, and UP if `unknown` (line 8).

    An object is unknown if no object of its class is among `known_types` (Section III-A).
    """
    seen = (
        Object(
            id=p.id,
            type=p.type,
            known=p.type in known_types,
            color=p.color,
            position=p.position,
            size=p.size,
            attributes=frozenset(p.attributes),
            rgb=p.rgb,
        )
        for p in checked(percepts)
    )
    return [o for o in seen if o.known or unknown]


def nearest_first(world: WorldModel) -> WorldModel:
    """The world with what is perceived in the order of its distance to the robot, or to the origin.

    Recognisers give objects in any order, and the first of equals is taken. More than `_MANY` objects keep their order:
    ten thousand that are gone through in another order than they were made in take half as long again.
    """
    if len(world.objects) > _MANY:
        return world
    x, y = (0.0, 0.0) if world.robot is None else (world.robot.x, world.robot.y)

    def how_far(thing: Object) -> tuple[float, tuple[float, ...], str]:
        at = thing.position
        return math.inf if at is None else math.hypot(at[0] - x, at[1] - y), at or (), thing.id

    seen = sorted((o for o in world.objects if not o.hypothetical), key=how_far)
    return replace(world, objects=(*seen, *(o for o in world.objects if o.hypothetical)))


def with_known(world: WorldModel, known_types: Collection[str]) -> WorldModel:
    """A world with every object known or not as it is by now: one from before a lesson will do.

    Raises:
        TypeError: it is no world, but percepts, say.
    """
    if not isinstance(world, WorldModel):
        raise TypeError(f"a world is what world_model() makes of percepts, not {world!r:.60}")
    known = set(known_types)
    if all(was == (type_ in known) for type_, was in {(o.type, o.known) for o in world.objects}):
        return world
    return replace(world, objects=tuple(replace(o, known=o.type in known) for o in world.objects))


def hypothesize_objects(
    known_types: Iterable[str], attributes: frozenset[str] = frozenset(), taken: Collection[str] = ()
) -> list[Object]:
    """KH and UH: an unseen instance of every known type, and one of an unknown type (line 9, Section III-C).

    Args:
        attributes: what they all have.
        taken: ids of perceived objects, which no hypothetical one gets.
    """
    known = [
        Object(id=_free(f"hypothetical {t}", taken), type=t, known=True, hypothetical=True, attributes=attributes)
        for t in known_types
    ]
    unknown = _free(HYPOTHETICAL_UNKNOWN, taken)
    return [*known, Object(id=unknown, type=None, known=False, hypothetical=True, attributes=attributes)]


def _free(id_: str, taken: Collection[str]) -> str:
    """The id, or one with stars behind it: a real object may be called what the robot calls its guesses."""
    while id_ in taken:
        id_ += "*"
    return id_


def world_model(
    percepts: Iterable[Percept],
    known_types: Collection[str],
    *,
    unknown: bool = True,
    hypothetical: bool = True,
    robot: Pose | None = None,
    speaker: Pose | None = None,
    unseen: frozenset[str] = frozenset(),
) -> WorldModel:
    """Upsilon of a model variant: DCG has neither unknown nor hypothetical objects, DCG-UPUP no hypothetical.

    Args:
        unseen: attributes that the hypothetical objects have.
    """
    objects = perceive_objects(percepts, known_types, unknown=unknown)
    if hypothetical:
        objects += hypothesize_objects(known_types, unseen, {o.id for o in objects})
    return WorldModel(tuple(objects), checked_pose(robot, "robot"), checked_pose(speaker, "speaker"))
