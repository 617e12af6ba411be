"""Furniture in rooms: how many stand around it, what is on it, how it is seen, to the shipped model."""

from __future__ import annotations

from collections.abc import Sequence

import pytest
from asked import grounded

from dcg_torch import Percept, Pose

Three = tuple[float, float, float]


def put(id_: str, type_: str, at: Three, size: Three | None = None, color: str | None = None) -> Percept:
    return Percept(id_, type_, color, at, size=size)


def meant(text: str, things: Sequence[Percept], robot: Pose | None = None) -> list[str]:
    return [o.id for o in grounded(text, things, robot).objects]


def stools(name: str, *at: tuple[float, float]) -> list[Percept]:
    return [put(f"{name}{k}", "stool", (x, y, 0.25), (0.3, 0.3, 0.5)) for k, (x, y) in enumerate(at)]


CANTEEN = [
    *(put(f"bench table {n}", "table", (4.0 * n, 0.0, 0.35), (1.6, 0.8, 0.7)) for n in range(3)),
    *stools("a", (-0.6, 0.7), (0.6, 0.7), (-0.6, -0.7), (0.6, -0.7)),
    *stools("b", (4.0, 0.7), (4.0, -0.7)),
    *stools("c", (8.0, 0.7)),
    put("mug", "mug", (4.3, 0.1, 0.75)),  # nobody says how large it is
    put("door", "door", (10.0, 3.0, 1.0), (0.1, 0.9, 2.0)),
]
LOCKERS = [
    *(put(f"locker {n}", "locker", (0.5 * n, 0.0, 0.4), (0.46, 0.5, 0.8)) for n in range(4)),
    put("fan", "fan", (1.0, 0.0, 1.0), (0.3, 0.3, 0.4)),
    put("mat", "mat", (1.0, 2.0, 0.0), (1.0, 0.6, 0.02)),
    put("radio", "radio", (3.0, 2.0, 0.2), (0.3, 0.2, 0.2)),
]
BEDROOM = [
    put("bed", "bed", (4.0, 2.0, 0.3), (1.6, 2.0, 0.6)),  # its head is at the wall in the south
    put("west rack", "magazine rack", (2.9, 1.2, 0.2), (0.3, 0.3, 0.4)),
    put("east rack", "magazine rack", (5.1, 1.2, 0.2), (0.3, 0.3, 0.4)),
    put("wardrobe", "wardrobe", (4.0, 6.7, 1.0), (1.6, 0.6, 2.0)),
    put("window", "window", (0.0, 4.0, 1.5), (0.1, 1.4, 1.2)),
    put("door", "door", (8.0, 5.0, 1.0), (0.1, 0.9, 2.0)),
    put("cushion", "cushion", (4.0, 1.3, 0.7), (0.5, 0.3, 0.15)),
    put("south wall", "wall", (4.0, 0.9, 1.2), (8.0, 0.1, 2.4)),
    put("north wall", "wall", (4.0, 7.05, 1.2), (8.0, 0.1, 2.4)),
]
HALL = [  # levers on the wall to the left of the robot, one ahead
    *(put(f"lever {n}", "lever", (2.0 + n, 3.0, 1.0)) for n in range(4)),
    put("bell", "bell", (8.0, -1.0, 1.0)),
    put("barrel", "barrel", (3.0, -2.0, 0.4)),
]
BRIDGES = [
    put("oak gate", "oak gate", (1.0, 2.0, 0.0)),
    put("iron gate", "iron gate", (4.0, 2.0, 0.0)),
    put("rose garden", "rose garden", (2.0, 5.0, 0.0)),
]


@pytest.mark.parametrize(
    ("text", "id_"),
    [
        ("the table with four stools around it", "bench table 0"),
        ("the table that has two stools around it", "bench table 1"),
        ("the table with one stool", "bench table 2"),
        ("the table with the mug", "bench table 1"),
        ("there is a table. it has a mug on it.", "bench table 1"),
    ],
)
def test_tables_are_told_by_what_stands_around_and_on_them(text: str, id_: str) -> None:
    assert meant(text, CANTEEN) == [id_]


def test_of_lockers_side_by_side_the_one_below_is_under() -> None:
    assert meant("the locker under the fan", LOCKERS) == ["locker 2"]


@pytest.mark.parametrize(
    ("text", "id_"),
    [
        ("if you are lying in bed, the magazine rack to your right", "east rack"),
        ("lying on the bed on your back, the magazine rack on your left", "west rack"),
        ("the magazine rack on the left if you are lying in the bed", "west rack"),
        ("standing at the foot of the bed facing it, the magazine rack on the right", "west rack"),
        ("standing in front of the bed and looking at it, the magazine rack on the left", "east rack"),
    ],
)
def test_sides_are_those_of_who_lies_or_stands_there(text: str, id_: str) -> None:
    assert meant(text, BEDROOM) == [id_]


@pytest.mark.parametrize(
    ("text", "id_"),
    [
        ("pull the leftmost of the levers", "lever 0"),
        ("pull the rightmost lever", "lever 3"),
        ("the second lever from the left", "lever 1"),
    ],
)
def test_left_and_right_on_a_wall_that_leads_away(text: str, id_: str) -> None:
    assert meant(text, HALL, Pose(0.0, 0.0)) == [id_]


@pytest.mark.parametrize(
    ("text", "id_"),
    [
        ("go to the iron one", "iron gate"),
        ("not the iron gate, the oak one", "oak gate"),
        ("the rose one", "rose garden"),
    ],
)
def test_one_is_what_a_class_is_called(text: str, id_: str) -> None:
    assert meant(text, BRIDGES, Pose(0.0, 0.0)) == [id_]


STUDY = [
    *(put(f"desk {n}", "desk", (2.0 * n, 1.0, 0.37), (1.4, 0.7, 0.74)) for n in range(4)),
    *(put(f"swivel chair {n}", "swivel chair", (2.0 * n, 1.9, 0.5), (0.6, 0.6, 1.0)) for n in (0, 1, 3)),
    put("chair", "chair", (3.0, 5.0, 0.45), (0.5, 0.5, 0.9)),
    put("other chair", "chair", (4.5, 5.0, 0.45), (0.5, 0.5, 0.9)),
    *(put(f"window {n}", "window", (1.0 + 3.0 * n, 0.0, 1.7), (1.2, 0.1, 1.0)) for n in range(2)),
    put("door", "door", (3.0, 6.0, 1.0), (0.9, 0.1, 2.0)),
]


@pytest.mark.parametrize(
    ("text", "id_"),
    [
        ("the desk with no chair in front of it", "desk 2"),
        ("the desk without a chair", "desk 2"),
        ("facing the window wall, the desk in the far right corner", "desk 0"),
        ("facing the wall with the windows, the desk on the far left", "desk 3"),
    ],
)
def test_a_study(text: str, id_: str) -> None:
    assert meant(text, STUDY) == [id_]


@pytest.mark.parametrize(
    ("said", "type_"),
    [
        ("the corkboard", "bulletin board"),
        ("the sink cabinet", "bathroom vanity"),
        ("the light fixture", "light"),
        ("the tv console", "tv stand"),
        ("the copy machine", "copier"),
        ("the handrail", "railing"),
    ],
)
def test_names_of_what_is_in_scans(said: str, type_: str) -> None:
    others = [put("crib", "crib", (1.0, 1.0, 0.5)), put("rug", "rug", (2.0, 0.0, 0.0))]
    assert meant(f"go to {said}", [*others, put("one", type_, (3.0, 1.0, 1.0))]) == ["one"]


PANTRY = [
    *(put(f"top {n}", "cupboard", (0.8 * n, 5.0, 1.9), (0.7, 0.35, 0.7)) for n in range(4)),
    *(put(f"base {n}", "cupboard", (0.8 * n, 4.9, 0.45), (0.7, 0.6, 0.9)) for n in range(3)),
    put("oven", "oven", (3.2, 4.9, 0.45), (0.7, 0.65, 0.9)),
    put("bench", "table", (2.0, 1.5, 0.37), (1.4, 0.9, 0.74)),
    put("west stool", "stool", (0.9, 1.5, 0.25), (0.4, 0.4, 0.5)),
    put("east stool", "stool", (3.1, 1.5, 0.25), (0.4, 0.4, 0.5)),
    put("south stool", "stool", (2.0, 0.6, 0.25), (0.4, 0.4, 0.5)),
    put("clock", "clock", (5.5, 2.0, 2.0), (0.05, 0.3, 0.3)),
    put("door", "door", (-0.6, 2.0, 1.0), (0.1, 0.9, 2.0)),
]


@pytest.mark.parametrize(
    ("text", "id_"),
    [
        ("the upper cupboard on the far right", "top 3"),
        ("the top cupboard second from the left", "top 1"),
        ("the rightmost lower cupboard", "base 2"),
        ("facing the oven, the stool on the left side of the table", "west stool"),
        ("facing the oven, the stool to the right of the table", "east stool"),
        ("the smallest stool in the room", "south stool"),
    ],
)
def test_a_pantry(text: str, id_: str) -> None:
    things = [o if o.id != "south stool" else put(o.id, "stool", (2.0, 0.6, 0.2), (0.3, 0.3, 0.4)) for o in PANTRY]
    assert meant(text, things) == [id_]


PASSAGES = [
    put("near bed", "bed", (0.0, 0.0, 0.3), (2.0, 1.4, 0.6)),
    put("far bed", "bed", (0.0, 2.6, 0.3), (2.0, 1.4, 0.6)),
    put("desk", "desk", (2.6, 0.0, 0.4), (1.4, 0.7, 0.75)),
    put("in the narrow gap", "stool", (1.5, 0.0, 0.25), (0.3, 0.3, 0.5)),
    put("in the wide gap", "stool", (1.3, 1.3, 0.25), (0.3, 0.3, 0.5)),
    put("elsewhere", "stool", (-3.0, 1.0, 0.25), (0.3, 0.3, 0.5)),
]


def test_of_two_gaps_the_narrower_is_meant() -> None:
    assert meant("the stool between the bed and the desk", PASSAGES) == ["in the narrow gap"]


SHED = [
    put("broom", "broom", (1.0, 0.0, 0.6), color="yellow"),
    put("wooden spoon", "spoon", (2.0, 1.0, 0.8), color="brown"),
    put("steel spoon", "spoon", (2.0, -1.0, 0.8), color="gray"),
    put("counter", "counter", (2.0, 3.0, 0.5)),
    put("towel", "towel", (3.0, 0.0, 0.8)),
]


@pytest.mark.parametrize(
    ("text", "id_"),
    [
        ("sweep the floor with the broom", "broom"),
        ("stir it with the brown spoon", "wooden spoon"),
        ("wipe the counter with the towel", "counter"),
    ],
)
def test_a_tool_is_meant_where_what_it_is_for_is_not_there(text: str, id_: str) -> None:
    assert meant(text, SHED, Pose(0.0, 0.0)) == [id_]


@pytest.mark.parametrize("text", ["the table with a single stool", "the table that has just a single stool"])
def test_a_single_one_is_one_and_no_more(text: str) -> None:
    assert meant(text, CANTEEN) == ["bench table 2"]
