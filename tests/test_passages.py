"""What is counted on one side of a passage is counted from who stands before it."""

from __future__ import annotations

import math

import pytest
from asked import grounded

from dcg_torch.types import Percept, Pose

STALLS = [
    *(Percept(f"left{k}", "stall", None, (2.0 + 3.0 * k, 1.5, 1.0)) for k in range(4)),
    *(Percept(f"right{k}", "stall", None, (3.0 + 3.0 * k, -1.4, 1.0)) for k in range(3)),
    Percept("fountain", "fountain", None, (14.0, 0.0, 0.5)),
]
ROW = [Percept(f"urn{k}", "urn", None, (3.0, 2.0 - 1.5 * k, 0.5)) for k in range(4)]


def meant(text: str, things: list[Percept], robot: Pose) -> list[str]:
    return [o.id for o in grounded(text, things, robot, looked=True).objects]


@pytest.mark.parametrize(
    ("text", "id_"),
    [
        ("the second stall on the left", "left1"),
        ("go to the third stall on your left", "left2"),
        ("the first stall on the right", "right0"),
        ("take the last stall on your right hand side", "right2"),
        ("the 2nd stall to the right", "right1"),
    ],
)
def test_what_is_counted_along_a_passage(text: str, id_: str) -> None:
    assert meant(text, STALLS, Pose(0.0, 0.0)) == [id_]


def test_from_its_other_end_sides_and_numbers_turn_round() -> None:
    assert meant("the second stall on the left", STALLS, Pose(16.0, 0.0, math.pi)) == ["right1"]
    assert meant("the first stall on the right", STALLS, Pose(16.0, 0.0, math.pi)) == ["left3"]


def test_of_one_row_it_is_counted_from_its_end() -> None:
    assert meant("the second urn from the left", ROW, Pose(0.0, 0.0)) == ["urn1"]
    assert meant("the third urn from the right", ROW, Pose(0.0, 0.0)) == ["urn1"]
