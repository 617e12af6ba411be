"""Worlds for robots in physics, and what is seen in them."""

from __future__ import annotations

import math

from dcg_torch.simulator import SimulatedRobot
from dcg_torch.simulator.bodies import extent
from dcg_torch.types import Percept
from dcg_torch.types.geometry import FIELD_OF_VIEW
from dcg_torch.world.files import RobotStart, World, WorldObject

HALF_VIEW = FIELD_OF_VIEW / 2


def world(*objects: tuple[str, str, float, float], start: tuple[float, float, float] = (0.0, 0.0, 0.0)) -> World:
    """Objects as (id, type, x, y)."""
    return World(
        name="test",
        robot=RobotStart(x=start[0], y=start[1], yaw=start[2]),
        objects=tuple(WorldObject(id=id_, type=type_, color="red", position=(x, y)) for id_, type_, x, y in objects),
    )


def everything(of: World) -> list[Percept]:
    """What a robot that has seen all of the world knows."""
    return [Percept(o.id, o.type, o.color, (*o.position, 0.0), extent(o.type)) for o in of.objects]


def seen(robot: SimulatedRobot, of: World) -> list[str]:
    robot.load(of)
    return [percept.id for percept in robot.perceive()]


def distance(robot: SimulatedRobot, of: World, id_: str) -> float:
    (position,) = [o.position for o in of.objects if o.id == id_]
    return math.dist((robot.pose.x, robot.pose.y), position)


# perceiving
