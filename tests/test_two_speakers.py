"""What two people say in turns, as one of them would say it alone; and what is meant by it, with the shipped model."""

from __future__ import annotations

import pytest
from asked import meant

from dcg_torch import Percept
from dcg_torch.interpretation.turns import in_one_voice

GARAGE = [
    Percept("near crate", "crate", "red", (2.0, 1.0, 0.2)),
    Percept("far crate", "crate", "red", (5.0, -1.0, 0.2)),
    Percept("blue crate", "crate", "blue", (3.5, -2.0, 0.2)),
    Percept("pump", "pump", "black", (2.2, 1.5, 0.2)),
    Percept("kettle", "kettle", "gray", (5.2, -1.5, 0.2)),
    Percept("shelf", "shelf", None, (6.0, 2.0, 1.0)),
    Percept("rope on shelf", "rope", None, (6.0, 2.0, 1.4)),
    Percept("rope on floor", "rope", None, (3.0, 2.5, 0.0)),
]


@pytest.mark.parametrize(
    ("text", "told"),
    [
        ("Anna: where is the rope? Ben: hm. Anna: where is it? Ben: under the shelf", "it is under the shelf."),
        ("X: get the rope. Y: the one on the floor? X: yes please", "get the rope. the one on the floor."),
        ("X: get the rope. Y: next to the pump? X: yep", "get the rope. the one next to the pump."),
        ("X: get the rope. Y: the one on the floor? X: nope", "get the rope. not on the floor."),
        ("chief: fetch a lid. aide: which lid? chief: the one by the kettle", "the lid by the kettle."),
        ("X: open the crate. Y: the red or the blue crate? X: the blue", "open the crate. the blue crate."),
        ("X: take the pump. Y: done. X: great. now take the kettle", "take the kettle."),
        ("X: paint the crate. Y: i see two. X: use the one near the door", "paint the crate. the one near the door."),
        ("X: take the pump. Y: ok. X: never mind that. bring the kettle", "bring the kettle."),
        ("Y: i can't find the rope. X: check the shelf", "the rope near the shelf."),
        ("get me a cup. this one? no. the one on the left? yes", "get me a cup. the one on the left."),
        ("lift the black box. not that one. the one in the corner.", "lift the black box. the one in the corner."),
        (
            "X: take the rope. Y: on the low shelf? X: no, the shelf by the door",
            "take the rope. on the shelf by the door.",
        ),
        ("open the hatch. left or right? left please.", "open the hatch. the left one."),
        ("grab the rope by the pump. thanks, now get the long one", "get the long rope."),
        ("open the red one near the pump. great, now the blue one", "the blue one."),
        ("lift the pump. good. now the crate behind it", "lift the crate behind the pump."),
        ("lift the pump\nno not that\nthe crate", "the crate."),
        ("X: get the pump\nY: ok", "get the pump."),
    ],
)
def test_turns_are_told_by_one(text: str, told: str) -> None:
    assert in_one_voice(text) == told


@pytest.mark.parametrize(
    "text",
    [
        "take the red crate next to the pump",
        "''theacanhave" * 60,  # as many ways to pair the marks as would take years to try
        "' '," * 90,
        "take two things: the rope and the pump",
        "the crate: the red one",
        "lift the pump.\nThen put it on the shelf.",
        "turn right, then right again to face the shelf",
        "it's 12:30, take the rope",
        "row: 2, column: 4",
        "color: red, shape: round",
    ],
)
def test_what_one_says_alone_stays_as_it_is(text: str) -> None:
    assert in_one_voice(text) == text


@pytest.mark.parametrize(
    ("text", "id_"),
    [
        ("guide: bring the red crate. helper: next to the pump? guide: yes", "near crate"),
        ("guide: bring the red crate. helper: the one next to the pump? guide: no, the other one", "far crate"),
        ("guide: we need the rope. helper: where is the rope? guide: on the shelf", "rope on shelf"),
        ("guide: get the rope. helper: i see one on the floor. guide: perfect, grab that", "rope on floor"),
        ("guide: take the pump. helper: taken. guide: thanks. now the crate by the kettle", "far crate"),
        ("helper: which crate? guide: the blue one", "blue crate"),
    ],
)
def test_the_last_turn_decides(text: str, id_: str) -> None:
    assert meant(text, GARAGE) == {id_}


@pytest.mark.parametrize(
    ("text", "id_"),
    [
        ("go past the pump to the kettle. there's a crate, pick it up", "far crate"),
        ("i'll take the blue crate. you get the pump", "pump"),
        ("you take the kettle, i will get the rope on the shelf", "kettle"),
        ("get the other red, the one by the kettle", "far crate"),
    ],
)
def test_who_does_what_and_where_one_is_sent_first(text: str, id_: str) -> None:
    assert meant(text, GARAGE) == {id_}


@pytest.mark.parametrize(
    ("text", "told"),
    [
        ("Y: the red pump or the black pump? X: the latter", "the black pump."),
        ("X: get a rope. Y: I see one on the shelf and one on the floor. X: the second one.",
         "get a rope. the one on the floor."),
        ("Y: Which crate do you want, the red one or the blue one? X: the first", "the red crate."),
        ("X: get a bucket. Y: tin or plastic? X: tin", "get a bucket. the one made of tin."),
        ("X: the rope. Y: which one? X: not the one on the shelf", "the rope. it is not the one on the shelf."),
        ("X: which crate? Y: not the blue one. X: then the red one? Y: right", "not the blue crate. the red one."),
        ("X: the pump. Y: The black pump? X: no. Y: the tall one? X: no, the wide one by the door. Y: got it",
         "the pump. not The black pump. the wide one by the door."),
    ],
)  # fmt: skip
def test_which_of_those_that_are_offered(text: str, told: str) -> None:
    assert in_one_voice(text) == told


@pytest.mark.parametrize(
    ("text", "ids"),
    [
        ("X: which crate do we use? Y: the red one is broken, use the blue. X: fine", {"blue crate"}),
        ("X: is there a rope? Y: which one? X: not the one on the shelf. The other one.", {"rope on floor"}),
        ("There are two ropes, its the one on the shelf", {"rope on shelf"}),
        ("There are three crates. It's the blue one.", {"blue crate"}),
    ],
)
def test_what_is_left_open_is_told_by_what_was_named(text: str, ids: set[str]) -> None:
    assert meant(text, GARAGE, looked=True) == ids
