"""What can be spoken of in a world beside its objects: the places of a workspace, and groups of objects."""

from __future__ import annotations

import math
from collections.abc import Collection, Sequence
from dataclasses import dataclass, replace
from typing import NamedTuple

import numpy as np

from dcg_torch.scene.groups import groups, lines_of_all
from dcg_torch.scene.neighbours import nearest_other
from dcg_torch.scene.places import Bounds, places, scene_bounds, side_middles
from dcg_torch.types import Object, Percept, WorldModel
from dcg_torch.types.arrays import Floats
from dcg_torch.types.geometry import positions

_CLOSE = 0.5
"""Metres between neighbours below which a scene is no room that one drives about in: a table top, a shelf."""


def spacings(things: Sequence[Object] | Sequence[Percept]) -> Floats:
    """(k,) metres from each thing that stands somewhere to the nearest other; what shares a point is left out."""
    near = nearest_other(positions(things))
    return near[near > 0.0]


def spacing(things: Sequence[Object] | Sequence[Percept]) -> float | None:
    """The median of `spacings`; None where no two things stand apart."""
    near = np.sort(spacings(things))
    return float(near[(len(near) - 1) // 2] + near[len(near) // 2]) / 2.0 if len(near) else None


@dataclass(frozen=True)
class Workspace:
    """What the scenes of one robot have in common.

    Attributes:
        bounds: of its workspace, seen from the robot; None: each scene has its own, those of its objects.
        unit: metres that neighbours are apart: "next to" on a table is no metre.

    Raises:
        ValueError: the unit is no length, or the bounds are not in order.
    """

    bounds: Bounds | None = None
    unit: float = 1.0

    def __post_init__(self) -> None:
        if not 0.0 < self.unit < math.inf:
            raise ValueError(f"unit is {self.unit!r}, not a length in metres")
        if self.bounds is not None and not (self.bounds[0] <= self.bounds[1] and self.bounds[2] <= self.bounds[3]):
            raise ValueError(f"bounds are {self.bounds!r}, not (near, far, right, left) in metres, from low to high")

    @staticmethod
    def of(things: Sequence[Percept], bounds: Bounds | None = None) -> Workspace:
        """The workspace of one scene, whose unit is how far its things are apart."""
        return Workspace(bounds, spacing(things) or 1.0)


def with_places(world: WorldModel, workspace: Workspace | None = None) -> WorldModel:
    """A world with the places that can be spoken of.

    Without a workspace there are no edges, only the robot, the speaker and the directions from them: the world of a
    robot that drives about. Where no robot is known either, the scene is all that there is, and has the edges of what
    is in it. A speaker of whom nothing is known is taken to stand with the robot, and to speak of the robot's left and
    right. The unit is a metre there, or less where things stand closer than in a room.
    """
    if workspace is None and world.robot is None:
        workspace = Workspace(None, spacing(world.objects) or 1.0)
    if workspace is None:
        found = places(None, world.robot, world.speaker)
        if world.speaker is None:
            here = [replace(place, id="place: speaker", type="speaker") for place in found if place.type == "robot"]
            found += tuple(here)
        apart = spacing(world.objects)
        return replace(world, places=found, unit=apart if apart is not None and apart < _CLOSE else 1.0)
    bounds, there = workspace.bounds, [o.position for o in world.objects if o.position is not None]
    if bounds is None and there:
        bounds = scene_bounds(there, world.robot)
    return replace(world, places=places(bounds, world.robot, world.speaker), unit=workspace.unit)


def with_places_of_all(world: WorldModel, kinds: Collection[str]) -> WorldModel:
    """A world without edges with places of these kinds, in the box around what is there.

    One who says "the mug in the corner" sees a corner, and who says "in the middle" the middle of something. Places
    that the world has already stay; a world of which nothing can be spoken stays as it is.
    """
    missing = {*kinds} - {place.type for place in world.places}
    there = [o.position for o in world.objects if o.position is not None]
    if not (missing and world.places and there):
        return world
    found = places(scene_bounds(there, world.robot), world.robot, world.speaker)
    return replace(world, places=(*world.places, *(place for place in found if place.type in missing)))


class Beside(NamedTuple):
    """What some commands speak of beside things and the usual places, and all others would only be confused by.

    Attributes:
        groups: those that objects form.
        lines: of these the rows and the columns of all that is there, too.
        pairs: of these what are two by themselves, too.
        side_middles: of the box around what is there.
    """

    groups: bool = False
    lines: bool = False
    pairs: bool = False
    side_middles: bool = False


def with_all(world: WorldModel, beside: Beside) -> WorldModel:
    """A world with what is spoken of in it, as its viewer sees it."""
    viewer = world.viewer or world.robot
    there = [o.position for o in world.objects if o.position is not None]
    if beside.groups:
        counted = lines_of_all(world.objects, world.unit, viewer) if beside.lines else ()
        found = groups(world.objects, world.unit, viewer, pairs=beside.pairs)
        world = replace(world, groups=(*found, *counted))
    if beside.side_middles and there:
        world = replace(world, places=(*world.places, *side_middles(scene_bounds(there, viewer), viewer)))
    return world
