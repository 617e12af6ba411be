"""What is meant lies where the way leads that is told before it is named."""

from __future__ import annotations

import math

import pytest
from asked import grounded, standing

from dcg_torch.interpretation.ways import way_of
from dcg_torch.types import Pose

HOME = standing(
    ("left sink", "sink", None, 2.0, 3.0),
    ("right sink", "sink", None, 2.0, -3.0),
    ("left mug", "mug", None, 2.1, 3.1),
    ("right mug", "mug", None, 2.1, -3.1),
)
BOTH = ("left mug", "right mug")


@pytest.mark.parametrize(
    ("text", "degrees"),
    [
        ("turn right and walk to ", -90.0),
        ("turn around, walk forward, ", 180.0),
        ("go straight to ", 0.0),
        ("turn 180 degrees and face ", 180.0),
        ("make a left, go on, then hang a left again and go to ", 90.0 + math.degrees(math.atan2(1.5, 1.0))),
        ("turn left, walk on, then turn right and walk to ", math.degrees(math.atan2(1.0, 1.5))),
        ("turn right turn right and walk to ", 180.0),
        ("head to the counter left of ", None),
        ("walk around the table to ", None),
        ("take the left cup on the right of ", None),
        ("", None),
    ],
)
def test_turns_and_steps_are_walked_on_paper(text: str, degrees: float | None) -> None:
    way = way_of(text)
    assert way is None if degrees is None else way is not None
    if way is not None and degrees is not None:
        assert math.cos(way - math.radians(degrees)) == pytest.approx(1.0)


@pytest.mark.parametrize("side", ["left", "right"])
@pytest.mark.parametrize("text", ["turn {} and walk to the sink. pick up the mug.", "turn {}, then grab the mug"])
def test_the_thing_where_the_way_leads_is_meant(side: str, text: str) -> None:
    probabilities = grounded(text.format(side), HOME, looked=True).probabilities
    meant, other = sorted(BOTH, key=lambda id_: not id_.startswith(side))
    assert probabilities[meant] > 5.0 * probabilities[other]


@pytest.mark.parametrize("yaw", [0.0, math.pi])
def test_sides_are_the_robots_own(yaw: float) -> None:
    probabilities = grounded("turn left, go to the sink and pick up the mug", HOME, Pose(2.0, 0.0, yaw)).probabilities
    meant, other = BOTH if yaw == 0.0 else reversed(BOTH)
    assert probabilities[meant] > 5.0 * probabilities[other]


@pytest.mark.parametrize(
    ("text", "robot"),
    [
        ("pick up the mug, then turn left", Pose(0.0, 0.0)),  # that is said of what comes after
        ("walk to the sink and pick up the mug", Pose(0.0, 0.0)),
        ("turn left and pick up the mug", None),  # nobody knows whose left
    ],
)
def test_all_else_tells_no_way(text: str, robot: Pose | None) -> None:
    probabilities = grounded(text, HOME, robot, looked=True).probabilities
    assert probabilities["left mug"] == pytest.approx(probabilities["right mug"], rel=0.05)
