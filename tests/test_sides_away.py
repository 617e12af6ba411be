"""Sides of things told by what is far from them: "the stool on the side of the counter away from the window"."""

from __future__ import annotations

import pytest
from seen_whole import meant

from dcg_torch.types import Percept

_ROOM = [  # a counter along x; the window is beyond it at high y, the door at low x
    Percept("counter", "counter", None, (3.0, 3.0, 0.45), size=(2.4, 0.8, 0.9)),
    *(
        Percept(n, "stool", None, (x, y, 0.3), size=(0.4, 0.4, 0.6))
        for n, x, y in (
            ("window west", 2.4, 3.8),
            ("window east", 3.6, 3.8),
            ("inner west", 2.4, 2.2),
            ("inner east", 3.6, 2.2),
        )
    ),
    Percept("window", "window", None, (3.0, 5.95, 1.5), size=(1.5, 0.1, 1.2)),
    Percept("door", "door", None, (0.05, 3.0, 1.0), size=(0.1, 0.9, 2.0)),
    Percept("lamp", "lamp", None, (0.3, 5.6, 0.8), size=(0.3, 0.3, 1.6)),
    Percept("plant", "plant", None, (5.7, 0.3, 0.5), size=(0.4, 0.4, 1.0)),
]


@pytest.mark.parametrize(
    ("text", "ids"),
    [
        ("the stools on the side of the counter away from the window", ["inner east", "inner west"]),
        ("the stools on the side of the counter farthest from the window", ["inner east", "inner west"]),
        ("the stools on the side of the counter opposite the window", ["inner east", "inner west"]),
        ("the stools on the side of the counter closest to the window", ["window east", "window west"]),
        (
            "The stool is on the side of the counter away from the window. It is the one nearest the door.",
            ["inner west"],
        ),
    ],
)
def test_a_side_is_told_by_what_it_is_away_from(text: str, ids: list[str]) -> None:
    assert meant(text, _ROOM, robot=None) == ids
