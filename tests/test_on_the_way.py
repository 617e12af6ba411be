"""Of two orders the first one's goal is on the way, for a robot that stands somewhere."""

from __future__ import annotations

import pytest
from asked import grounded

from dcg_torch.types import Percept, Pose

THINGS = [
    Percept("bench", "bench", None, (4.0, 2.0, 0.4)),
    Percept("garage", "garage", None, (6.0, -3.0, 1.0)),
    Percept("rake", "rake", None, (4.1, 2.1, 0.9)),
    Percept("other rake", "rake", None, (1.0, -4.0, 0.5)),
    Percept("kettle", "kettle", None, (6.2, -3.1, 1.0)),
]


def likeliest(text: str, robot: Pose | None) -> str:
    probabilities = grounded(text, THINGS, robot, looked=True).probabilities
    return max(probabilities, key=lambda id_: probabilities[id_])


@pytest.mark.parametrize(
    ("text", "thing", "goal"),
    [
        ("walk to the bench and grab the rake", "rake", "bench"),
        ("go to the garage, then bring me the kettle", "kettle", "kettle"),
        ("drive over to the bench and take the rake", "rake", "bench"),
    ],
)
def test_what_is_done_at_the_goal_is_meant_where_somebody_stands(text: str, thing: str, goal: str) -> None:
    assert likeliest(text, Pose(0.0, 0.0)) == thing
    assert likeliest(text, None) == goal


def test_a_single_goal_is_meant() -> None:
    assert likeliest("walk over to the bench", Pose(0.0, 0.0)) == "bench"


def test_a_room_is_meant_where_both_orders_are_said_in_one_breath() -> None:
    assert likeliest("go to the garage and bring me the kettle", Pose(0.0, 0.0)) == "garage"
