"""Landmarks that are described where there are several of them, and are not where there is one.

Scenes and commands are ours.
"""

from __future__ import annotations

import pytest
from asked import grounded

from dcg_torch import Percept

CANTEEN = [  # two tables, each with chairs on both of its sides; a door by the one, a window by the other
    Percept("door", "door", None, (0.05, 2.5, 1.0), size=(0.1, 0.9, 2.0)),
    Percept("window", "window", None, (5.95, 2.5, 1.4), size=(0.1, 1.4, 1.0)),
    Percept("sink", "sink", None, (3.0, 4.7, 0.9), size=(0.6, 0.5, 0.3)),
    Percept("oven", "oven", None, (3.0, 0.3, 0.5), size=(0.6, 0.6, 0.9)),
    *(
        Percept(f"{name} table", "table", None, (x, 2.5, 0.35), size=(0.9, 0.9, 0.7))
        for name, x in (("door", 1.4), ("window", 4.6))
    ),
    *(
        Percept(f"{side} chair of the {name} table", "chair", None, (x, y, 0.45), size=(0.4, 0.4, 0.9))
        for name, x in (("door", 1.4), ("window", 4.6))
        for side, y in (("sink", 3.3), ("oven", 1.7))
    ),
]


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("the chair closest to the sink at the table that is closest to the door", "sink chair of the door table"),
        ("at the table near the window, the chair closest to the oven", "oven chair of the window table"),
        (
            "of the chairs around the table next to the door, the one nearest to the oven",
            "oven chair of the door table",
        ),
        (
            "look at the table by the window; of its chairs, pick the one closest to the sink",
            "sink chair of the window table",
        ),
        ("find the table closer to the door. the chair at that table nearest the sink", "sink chair of the door table"),
        ("the table that is by the window", "window table"),
    ],
)
def test_which_table(text: str, expected: str) -> None:
    assert [o.id for o in grounded(text, CANTEEN, None).objects] == [expected]


def test_the_only_table_needs_no_description() -> None:
    """What is said behind it is said of the thing: the table is where all stands."""
    board = [
        Percept("near", "cube", "red", (0.6, 0.0, 0.05), size=(0.1, 0.1, 0.1)),
        Percept("far", "cube", "red", (1.4, 0.0, 0.05), size=(0.1, 0.1, 0.1)),
        Percept("ball", "sphere", "blue", (1.5, 0.1, 0.05), size=(0.1, 0.1, 0.1)),
    ]
    assert [o.id for o in grounded("the red cube on the table that is next to the ball", board).objects] == ["far"]


@pytest.mark.parametrize(
    "text", ["the chair in the middle of the sink and the oven", "in the center of the oven and the sink"]
)
def test_the_middle_of_two_things_is_between_them(text: str) -> None:
    things = [*CANTEEN[:4], Percept("amid", "chair", None, (3.0, 2.5, 0.45), size=(0.4, 0.4, 0.9)), *CANTEEN[6:]]
    assert [o.id for o in grounded(text, things, None).objects] == ["amid"]
