"""Where a thing is for a robot that stands among the things: adverbs and sides of its own. Scenes that we wrote."""

from __future__ import annotations

import cmath
import math
import random

import pytest
from asked import grounded, shipped

from dcg_torch.types import Percept, Pose

SIDES = {"ahead": 0.0, "left": 90.0, "behind": 180.0, "right": -90.0}


def _scene(seed: int) -> tuple[Pose, list[Percept]]:
    """A chair on each side of the robot, within 25 degrees of its middle, and boxes anywhere."""
    rng = random.Random(seed)
    robot = Pose(rng.uniform(-2.0, 2.0), rng.uniform(-2.0, 2.0), rng.uniform(-3.0, 3.0))
    things = []
    for side, middle in SIDES.items():
        spot = cmath.rect(rng.uniform(2.0, 5.0), robot.yaw + math.radians(middle + rng.uniform(-25.0, 25.0)))
        things.append(Percept(side, "chair", "brown", (robot.x + spot.real, robot.y + spot.imag, 0.0)))
    boxes = [(rng.uniform(-8.0, 8.0), rng.uniform(-8.0, 8.0), 0.0) for _ in range(4)]
    return robot, things + [Percept(f"b{k}", "box", "blue", place) for k, place in enumerate(boxes)]


@pytest.mark.parametrize(
    ("text", "side"),
    [
        ("go to the chair behind", "behind"),
        ("take the chair at your back", "behind"),
        ("drive to the chair straight ahead", "ahead"),
        ("the chair in front", "ahead"),
        ("take the chair that you are facing", "ahead"),
        ("go to the chair left of you", "left"),
        ("the chair to the right of you", "right"),
    ],
)
def test_sides_of_a_robot_among_the_things(text: str, side: str) -> None:
    right = 0
    for seed in range(10):
        robot, things = _scene(seed)
        right += [o.id for o in grounded(text, things, robot).objects] == [side]
    assert right >= 8  # by chance 2.5 are


def test_in_front_of_a_robot_at_a_table_is_the_tables_own_side() -> None:
    things = [
        Percept(f"c{k}", "cup", "red", (x, y, 0.0)) for k, (x, y) in enumerate([(0.4, 0.1), (0.9, 0.0), (0.7, -0.3)])
    ]
    world = shipped().world_model(things, robot=Pose(0.0, 0.0))
    assert [o.id for o in shipped().ground("take the cup at the front", world).objects] == ["c0"]


@pytest.mark.parametrize(
    "text", ["the barrel on your left", "go to the barrel left of the robot", "the barrel left of you"]
)
def test_the_nearest_on_a_side_is_meant_where_the_robot_stands_among_things(text: str) -> None:
    right = 0
    for seed in range(10):
        rng = random.Random(seed)
        robot = Pose(rng.uniform(-2.0, 2.0), rng.uniform(-2.0, 2.0), rng.uniform(-3.0, 3.0))
        at = {"near": (2.0, 80.0), "far": (6.0, 95.0), "ahead": (1.5, 5.0), "right": (1.5, -85.0), "back": (3.0, 175.0)}
        things = []
        for name, (away, angle) in at.items():
            spot = cmath.rect(away, robot.yaw + math.radians(angle + rng.uniform(-15.0, 15.0)))
            things.append(Percept(name, "barrel", "green", (robot.x + spot.real, robot.y + spot.imag, 0.0)))
        right += [o.id for o in grounded(text, things, robot).objects] == ["near"]
    assert right >= 9  # the one farthest to the left was taken


def test_the_left_of_a_robot_outside_is_a_side_of_the_scene() -> None:
    things = [Percept(f"j{k}", "jar", "red", (1.5, y, 0.0)) for k, y in enumerate([0.9, 0.3, -0.4, -0.9])]
    world = shipped().world_model(things, robot=Pose(0.0, 0.0))
    assert [o.id for o in shipped().ground("the jar on your left", world).objects] == ["j0"]


def test_what_ranks_among_all_in_front_is_not_the_nearest_in_front() -> None:
    spots = {"a": (5.0, 2.5), "b": (4.0, 0.1), "c": (4.5, -2.0), "back": (-4.0, 3.0)}
    things = [Percept(name, "trolley", "grey", (*spot, 0.0)) for name, spot in spots.items()]
    world = shipped().world_model(things, robot=Pose(0.0, 0.0), looked=True)
    for text, meant in (("the leftmost trolley in front of the robot", "a"), ("the trolley in front of you", "b")):
        assert [o.id for o in shipped().ground(text, world).objects] == [meant]


def test_all_on_a_side_and_those_that_are_counted_there() -> None:
    """Behind, before and beside a robot that is turned."""
    robot, things = Pose(2.0, -1.0, 2.1), list[Percept]()
    spots = {
        "l1": (1.5, 85.0),
        "l2": (3.0, 95.0),
        "ahead": (2.0, 4.0),
        "right": (2.5, -90.0),
        "back1": (1.4, 180.0),
        "back2": (3.1, 172.0),
    }
    for name, (away, angle) in spots.items():
        spot = cmath.rect(away, robot.yaw + math.radians(angle))
        things.append(Percept(name, "barrel", "green", (robot.x + spot.real, robot.y + spot.imag, 0.0)))
    world = shipped().world_model(things, robot=robot, looked=True)
    for text, meant in (
        ("the barrels on your left", {"l1", "l2"}),
        ("all barrels to your left", {"l1", "l2"}),
        ("the closest barrel on your left", {"l1"}),
        ("the second barrel on your left", {"l2"}),
        ("the second barrel behind you", {"back2"}),
        ("the barrels behind you", {"back1", "back2"}),
        ("turn to the barrel at your back", {"back1"}),
    ):
        assert {o.id for o in shipped().ground(text, world).objects} == meant, text
