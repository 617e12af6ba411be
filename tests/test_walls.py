"""Walls that are no things of a room, who enters it, and what is opposite.

Scenes and commands are ours.
"""

from __future__ import annotations

import pytest
from asked import grounded

from dcg_torch import Percept

HALL = [  # walls are no things: what is at the edges tells where they are
    *(
        Percept(f"lamp {k}", "wall lamp", None, at, size=size)
        for k, (at, size) in enumerate(
            [
                ((0.05, 1.0, 1.8), (0.1, 0.2, 0.3)),
                ((0.05, 3.0, 1.8), (0.1, 0.2, 0.3)),
                ((6.95, 2.0, 1.8), (0.1, 0.2, 0.3)),
                ((3.0, 0.05, 1.8), (0.2, 0.1, 0.3)),
                ((3.0, 4.95, 1.8), (0.2, 0.1, 0.3)),
            ]
        )
    ),
    Percept("door", "door", None, (0.05, 2.0, 1.0), size=(0.1, 0.9, 2.0)),
    Percept("radiator", "radiator", None, (6.9, 3.2, 0.3), size=(0.15, 1.0, 0.6)),
    Percept("shelf at the wall", "bookshelf", None, (5.0, 4.8, 0.9), size=(1.0, 0.35, 1.8)),
    Percept("shelf in the room", "bookshelf", None, (4.0, 2.6, 0.9), size=(1.0, 0.35, 1.8)),
    Percept("north chair", "chair", None, (2.0, 3.6, 0.4), size=(0.45, 0.45, 0.9)),
    Percept("south chair", "chair", None, (2.0, 1.2, 0.4), size=(0.45, 0.45, 0.9)),
    Percept("far chair", "chair", None, (6.4, 2.0, 0.4), size=(0.45, 0.45, 0.9)),
]


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("the bookshelf against the wall", "shelf at the wall"),
        ("the bookshelf that stands along a wall", "shelf at the wall"),
        ("the bookshelf away from the walls", "shelf in the room"),
        ("the freestanding bookshelf", "shelf in the room"),
        ("the bookshelf that is not against the wall", "shelf in the room"),
        ("entering the room, it is the chair on the left", "north chair"),
        ("from the door, the chair on the right", "south chair"),
        ("the chair opposite the door", "far chair"),
        ("the chair across the room from the door", "far chair"),
        ("beside the radiator stands a chair", "far chair"),
        ("not the chair by the radiator and not the chair on the left, the third one", "south chair"),
    ],
)
def test_in_a_hall_without_walls(text: str, expected: str) -> None:
    assert [o.id for o in grounded(text, HALL, None).objects] == [expected]


GALLERY = [  # four walls that are no things, with pictures on three of them, two of these over one another
    Percept("door", "door", None, (0.05, 2.5, 1.0), size=(0.1, 0.9, 2.0)),
    Percept("bench", "bench", None, (3.0, 2.5, 0.25), size=(1.2, 0.4, 0.5)),
    Percept("piano", "piano", None, (3.0, 4.7, 0.6), size=(1.4, 0.6, 1.2)),
    Percept("radiator", "radiator", None, (6.9, 3.5, 0.3), size=(0.12, 1.0, 0.6)),
    Percept("shelf", "bookshelf", None, (2.0, 0.1, 0.3), size=(1.0, 0.12, 0.6)),
    Percept("bin", "trash can", None, (5.0, 1.5, 0.2), size=(0.3, 0.3, 0.4)),
    Percept("door side", "picture", None, (0.03, 1.0, 1.5), size=(0.05, 0.6, 0.5)),
    Percept("far side", "picture", None, (6.97, 1.2, 1.5), size=(0.05, 0.6, 0.5)),
    Percept("upper", "picture", None, (5.5, 4.97, 2.0), size=(0.6, 0.05, 0.5)),
    Percept("lower", "picture", None, (5.5, 4.97, 1.0), size=(0.6, 0.05, 0.5)),
    Percept("plant", "plant", None, (6.5, 4.5, 0.4), size=(0.4, 0.4, 0.8)),
]


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("the picture on the same wall as the door", "door side"),
        ("the picture that shares a wall with the radiator", "far side"),
        ("same wall as door, picture", "door side"),
        ("the picture on the wall opposite the door", "far side"),
        ("the picture nearest to the floor", "lower"),
        ("the picture closest to the ceiling", "upper"),
        ("the picture that is at the bottom", "lower"),
    ],
)
def test_on_which_wall(text: str, expected: str) -> None:
    assert [o.id for o in grounded(text, GALLERY, None).objects] == [expected]
