"""What is on a part of a counter is where that part is, as who stands before the wall sees it."""

from __future__ import annotations

import math

import pytest
from asked import grounded, standing

from dcg_torch.types import Percept, Pose

WALLS = standing(
    ("door", "door", None, -3.0, 0.0),
    ("window", "window", None, 0.0, -3.0),
    ("shelf", "shelf", None, 3.0, 2.8),
    ("bin", "trash can", None, -2.5, -2.8),
    ("table", "dining table", None, 0.5, 1.0),
    ("chair", "chair", None, 0.5, 1.8),
    ("fridge", "fridge", None, -2.9, 2.5),
)
KITCHEN = [
    *WALLS,
    *standing(("counter", "counter top", None, 3.0, 0.0), ("stove", "stove", None, 3.0, 0.1)),
    Percept("left mug", "mug", None, (2.9, 1.0, 0.9)),
    Percept("right mug", "mug", None, (2.9, -1.0, 0.9)),
    Percept("far mug", "mug", None, (-2.9, -1.5, 0.9)),
    Percept("other counter", "counter top", None, (-3.0, -1.4, 0.8)),
]
TEXTS = [
    "pick up the mug {} of the stove",
    "pick up the mug on the counter to the {} of the stove",
    "go to the counter to the {} of the stove. pick up the mug.",
]


@pytest.mark.parametrize("yaw", [0.0, math.pi / 2.0, math.pi, -2.0])
@pytest.mark.parametrize("side", ["left", "right"])
@pytest.mark.parametrize("text", TEXTS)
def test_sides_of_what_is_at_a_wall_are_those_of_who_stands_before_it(text: str, side: str, yaw: float) -> None:
    """The stove is at the wall that is high in x: who stands before it has what is high in y on the left."""
    solution = grounded(text.format(side), KITCHEN, Pose(-0.5, 0.0, yaw), looked=True)
    assert [o.id for o in solution.objects] == [f"{side} mug"]


@pytest.mark.parametrize("side", ["left", "right"])
def test_the_robots_own_sides_stay_its_own(side: str) -> None:
    there, back = (
        [o.id for o in grounded(f"pick up the mug on your {side}", KITCHEN[:-2], Pose(0.0, 0.0, yaw)).objects]
        for yaw in (0.0, math.pi)
    )
    assert there == [f"{side} mug"]
    assert back == [f"{'right' if side == 'left' else 'left'} mug"]


def test_a_part_of_a_counter_is_told_by_what_is_near_it() -> None:
    toaster = Percept("toaster", "toaster", None, (2.9, -1.3, 0.9))
    solution = grounded("take the mug from the counter next to the toaster", [*KITCHEN, toaster], Pose(0.0, 0.0))
    assert [o.id for o in solution.objects] == ["right mug"]
