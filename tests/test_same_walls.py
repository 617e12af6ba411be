"""What is at the wall of another thing, or at the wall opposite: "the clock on the same wall as the stove"."""

from __future__ import annotations

import math

import pytest
from seen_whole import meant

from dcg_torch.interpretation.same_walls import AT_WALL_OF, log_at_wall_of
from dcg_torch.types import Object, Percept

_ROOM = [  # 6 m x 5 m, north is y
    Percept("north clock", "clock", None, (1.0, 4.97, 2.0), size=(0.4, 0.06, 0.4)),
    Percept("east clock", "clock", None, (5.97, 4.6, 2.0), size=(0.06, 0.4, 0.4)),  # near the corner
    Percept("south clock", "clock", None, (4.0, 0.03, 2.0), size=(0.4, 0.06, 0.4)),
    Percept("stove", "stove", None, (3.0, 4.7, 0.5), size=(0.6, 0.6, 1.0)),
    Percept("door", "door", None, (5.95, 1.0, 1.0), size=(0.1, 0.9, 2.0)),
    Percept("table", "table", None, (3.0, 2.0, 0.4), size=(1.0, 1.0, 0.8)),
    Percept("west stool", "stool", None, (0.2, 2.0, 0.3), size=(0.4, 0.4, 0.6)),
    Percept("east stool", "stool", None, (5.8, 2.5, 0.3), size=(0.4, 0.4, 0.6)),
]


@pytest.mark.parametrize(
    ("text", "id_"),
    [
        ("the clock on the same wall as the stove", "north clock"),
        ("the clock that is on the same wall as the door", "east clock"),
        ("the clock on the opposite wall from the stove", "south clock"),
        ("the stool along the wall opposite the door", "west stool"),
        ("the stool against the same wall as the door", "east stool"),
        ("this is a clock. it is high up, on the same wall as the door.", "east clock"),
    ],
)
def test_walls_are_told_by_what_is_at_them(text: str, id_: str) -> None:
    assert meant(text, _ROOM, robot=None) == [id_]


@pytest.mark.parametrize("name", sorted(AT_WALL_OF))
def test_nothing_follows_where_the_landmark_is_at_no_wall(name: str) -> None:
    objects = [Object(p.id, p.type, known=True, position=p.position, size=p.size) for p in _ROOM]
    of_table, of_door = log_at_wall_of(name, objects, [(5,), (4,)]).tolist()
    assert of_table == pytest.approx([math.log(0.5)] * len(objects))
    assert max(of_door) == pytest.approx(math.log(0.98))
    assert of_door[4] == pytest.approx(math.log(0.02))  # nothing is at its own wall
