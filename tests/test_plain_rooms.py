"""Plain commands in rooms: sides of the room, what reaches how high, what is farther off than another."""

from __future__ import annotations

import pytest
from asked import grounded

from dcg_torch.types import Percept

STOOLS = [  # stools in a row across a room, and its far wall
    Percept("wall", "wall", None, (7.0, 0.0, 0.0), (0.1, 8.0, 2.5)),
    *(Percept(f"s{k}", "stool", None, (4.0, 2.4 - 1.2 * k, 0.0), (0.4, 0.4, 0.5)) for k in range(5)),
]
VASES = [  # in no order of height
    Percept("low", "vase", "red", (2.0, 0.9, 0.0), (0.1, 0.1, 0.2)),
    Percept("high", "vase", "red", (2.4, 0.3, 0.0), (0.1, 0.1, 0.6)),
    Percept("lower", "vase", "blue", (3.0, -0.3, 0.0), (0.1, 0.1, 0.3)),
    Percept("higher", "vase", "green", (3.6, -0.9, 0.0), (0.1, 0.1, 0.45)),
]
QUEUE = [Percept(f"p{k}", "person", None, (1.5 + 0.9 * k, -0.4, 0.0), (0.4, 0.4, 1.7)) for k in (2, 0, 4, 1, 3)]
FLOATING = [  # of one height each, at three levels
    Percept(f"b{k}", "balloon", None, (2.0, 0.5 - 0.5 * k, (1.0, 0.2, 0.6)[k]), (0.2, 0.2, 0.2)) for k in range(3)
]


def _meant(text: str, things: list[Percept]) -> list[str]:
    return [o.id for o in grounded(text, things).objects]


@pytest.mark.parametrize(
    ("text", "things", "id_"),
    [
        ("the stool in the middle of the room", STOOLS, "s2"),
        ("take the stool in the center of the room", STOOLS, "s2"),
        ("the stool on the left side of the room", STOOLS, "s0"),
        ("the stool on the right side of the room", STOOLS, "s4"),
        ("the highest vase", VASES, "high"),
        ("the lowest vase", VASES, "low"),
        ("the second tallest vase", VASES, "higher"),
        ("the second shortest vase", VASES, "lower"),
        ("the red vase that is not the tallest", VASES, "low"),
        ("the vase farther away than the blue one", VASES, "higher"),
        ("the vase that is closer than the red one which is tall", VASES, "low"),
        ("the last person", QUEUE, "p4"),
        ("the second person in the queue", QUEUE, "p1"),
        ("go to the last person in line", QUEUE, "p4"),
        ("the second to last person in the queue", QUEUE, "p3"),
        ("the highest balloon", FLOATING, "b0"),
        ("the lowest balloon", FLOATING, "b1"),
    ],
)
def test_what_is_meant(text: str, things: list[Percept], id_: str) -> None:
    assert _meant(text, things) == [id_]


def test_each_of_two_things_is_in_its_own_room() -> None:
    radios = [
        Percept(f"{room} radio", "radio", None, (1.0 + 4.0 * k, 0.5, 0.0), None, frozenset({f"room: {room}"}))
        for k, room in enumerate(("kitchen", "bedroom", "bathroom"))
    ]
    found = _meant("bring the radio in the kitchen and the radio in the bathroom", radios)
    assert sorted(found) == ["bathroom radio", "kitchen radio"]
