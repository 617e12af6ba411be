"""What one sentence tells of what another names, what is left out or denied, bare desks, and what orders nothing.

Scenes and commands are ours.
"""

from __future__ import annotations

import pytest
from asked import grounded

from dcg_torch import Percept, Pose

LOFT = [  # one bed and one stove; several stools and bags, of which one each is by them; two desks, one bare
    Percept("bed", "bed", None, (2.0, 2.0, 0.3), size=(2.0, 1.6, 0.6)),
    Percept("stove", "stove", None, (6.0, -2.0, 0.45), size=(0.6, 0.6, 0.9)),
    Percept("stool by the bed", "stool", "green", (2.0, 3.3, 0.25), size=(0.3, 0.3, 0.5)),
    Percept("stool by the stove", "stool", "white", (6.0, -2.8, 0.25), size=(0.3, 0.3, 0.5)),
    Percept("bag by the bed", "backpack", "black", (3.4, 2.0, 0.2), size=(0.3, 0.3, 0.4)),
    Percept("bag by the stove", "backpack", "black", (5.2, -2.0, 0.2), size=(0.3, 0.3, 0.4)),
    Percept("laden desk", "desk", None, (4.5, 0.5, 0.37), size=(1.2, 0.6, 0.74)),
    Percept("bare desk", "desk", None, (7.5, 1.5, 0.37), size=(1.2, 0.6, 0.74)),
    Percept("clock", "clock", None, (4.6, 0.5, 0.79), size=(0.1, 0.1, 0.1)),
]


def meant(text: str) -> set[str]:
    return {o.id for o in grounded(text, LOFT, None).objects}


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("there is a bed. the stool is next to it.", "stool by the bed"),
        ("there is a stove. the bag is beside it", "bag by the stove"),
        ("you will see a stove. there is a stool next to it.", "stool by the stove"),
        ("there is a stool. the bed is next to it.", "stool by the bed"),  # here it tells which stool
        ("there is a backpack. there is a stove beside it", "bag by the stove"),
        ("find the bed and then the stool next to it", "stool by the bed"),
        ("a stool sits by the stove. the stool is white.", "stool by the stove"),
        ("the stool that the bed is closest to", "stool by the bed"),
        ("the backpack which the stove is nearest to", "bag by the stove"),
    ],
)
def test_the_one_that_had_to_be_told(text: str, expected: str) -> None:
    assert meant(text) == {expected}


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("ignore the bag by the bed, take the other", "bag by the stove"),
        ("disregard the stool by the stove and take the other one", "stool by the bed"),
        ("the stool across the room from the bed", "stool by the stove"),
        ("the backpack at the other end of the room from the stove", "bag by the bed"),
        ("the stool which has a green color", "stool by the bed"),
        ("the stool. its color is white.", "stool by the stove"),
    ],
)
def test_the_other_one(text: str, expected: str) -> None:
    assert meant(text) == {expected}


@pytest.mark.parametrize("text", ["the bare desk", "the empty desk", "the desk with nothing on it", "the clear desk"])
def test_a_desk_on_which_nothing_is(text: str) -> None:
    assert meant(text) == {"bare desk"}


@pytest.mark.parametrize("text", ["it's both stools", "it is all the stools", "this is both of the stools"])
def test_it_stands_for_a_set(text: str) -> None:
    assert meant(text) == {"stool by the bed", "stool by the stove"}


def test_who_looks_at_a_door_does_not_stand_in_it() -> None:
    hall = [
        Percept("door", "door", None, (6.0, 0.0, 1.0), size=(0.1, 0.9, 2.0)),
        Percept("north", "stool", None, (3.0, 2.0, 0.25), size=(0.3, 0.3, 0.5)),
        Percept("south", "stool", None, (3.0, -2.0, 0.25), size=(0.3, 0.3, 0.5)),
        Percept("bed", "bed", None, (0.0, 0.0, 0.3), size=(1.6, 2.0, 0.6)),
    ]
    looks = grounded("if you look at the door, the left stool", hall, None)
    stands = grounded("if you look in from the door, the left stool", hall, None)
    assert [o.id for o in looks.objects] == ["north"]
    assert [o.id for o in stands.objects] == ["south"]


DOTS = [  # a picture: x is up, y to the left; two pairs of which the lower is dark, and a small one by itself
    Percept("low left", "dot", None, (0.2, 0.4, 0.0), size=(0.03, 0.03, 0.0), rgb=(20, 20, 20)),
    Percept("over low left", "dot", None, (0.5, 0.42, 0.0), size=(0.08, 0.08, 0.0), rgb=(215, 215, 215)),
    Percept("low right", "dot", None, (0.25, -0.4, 0.0), size=(0.08, 0.08, 0.0), rgb=(120, 120, 120)),
    Percept("over low right", "dot", None, (0.55, -0.38, 0.0), size=(0.08, 0.08, 0.0), rgb=(215, 215, 215)),
    Percept("top", "dot", None, (0.95, 0.0, 0.0), size=(0.03, 0.03, 0.0), rgb=(120, 120, 120)),
]


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("there is a small black dot. mine is the large one above it", "over low left"),
        ("do you see a small black one? the large dot above it", "over low left"),
        ("do you see a big grey dot? the large one above it", "over low right"),
        ("mine is small and black", "low left"),
        ("mine is the small grey one", "top"),
    ],
)
def test_which_dot_is_mine(text: str, expected: str) -> None:
    found = grounded(text, DOTS, Pose(-2.0, 0.0))
    assert [o.id for o in found.objects] == [expected]


BRANDS = [
    Percept(brand, "block", None, at, attributes=frozenset({f"label: {brand}"}))
    for brand, at in {
        "pepsi": (2.9, -0.7, 0.0),
        "shell": (2.7, -0.4, 0.0),
        "esso": (1.3, -0.7, 0.0),
        "toyota": (1.6, 0.9, 0.0),
        "nvidia": (2.1, 0.4, 0.0),
    }.items()
]


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("the block closest to pepsi", "shell"),
        ("the block farthest from pepsi", "toyota"),
        ("the block nearest to the nvidia one", "toyota"),
    ],
)
def test_marks_are_no_places(text: str, expected: str) -> None:
    found = grounded(text, BRANDS)
    assert [o.id for o in found.objects] == [expected]
    assert (found.probability or 0.0) > 0.6


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("bring me the stool, not the green one", "stool by the stove"),
        ("take the stool - the white one", "stool by the stove"),
        ("the stove's neighbouring stool", "stool by the stove"),
    ],
)
def test_said_behind_a_comma(text: str, expected: str) -> None:
    assert meant(text) == {expected}


@pytest.mark.parametrize(
    "text",
    [
        "list all the stools",
        "spell stool",
        "turn left ninety degrees",
        "my sister bought a stool yesterday",
        "nobody likes that clock",
        "I will sit on the stool",
        "can you swim",
        "shall we start",
        "turn up the volume",
        "cancel that",
        "let's talk about the clock",
        "she went to the bed",
    ],
)
def test_what_orders_nothing(text: str) -> None:
    found = grounded(text, LOFT, None)
    assert not found.objects
    assert found.problem is not None


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("I like the green stool, bring it", "stool by the bed"),
        ("I saw a clock on a desk. go there", "clock"),
        ("I will take the clock", "clock"),
        ("can you move to the clock", "clock"),
        ("turn around and get the clock", "clock"),
    ],
)
def test_what_orders_something(text: str, expected: str) -> None:
    assert meant(text) == {expected}


def test_medium_is_a_size_where_things_differ_in_size() -> None:
    row = [(0.03, 20), (0.05, 20), (0.08, 20), (0.05, 215), (0.08, 120)]
    dots = [
        Percept(f"d{k}", "dot", None, (0.3, 0.8 - 0.4 * k, 0.0), size=(wide, wide, 0.0), rgb=(shade, shade, shade))
        for k, (wide, shade) in enumerate(row)
    ]
    assert [o.id for o in grounded("the medium black one", dots, Pose(-2.0, 0.0)).objects] == ["d1"]


ASKED = [
    Percept("left", "sheep", "white", (1.0, 1.0, 0.0)),
    Percept("middle", "sheep", "black", (1.6, 0.0, 0.0)),
    Percept("right", "sheep", "black", (1.2, -1.0, 0.0)),
    Percept("bus", "bus", "red", (2.0, 0.4, 0.0)),
]


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("is it a sheep? yes. is it the rightmost one? no. is it black? yes.", "middle"),
        ("is it a sheep? yes. the leftmost sheep? no. is it next to the bus? yes.", "middle"),
        ("is it a sheep? yes. is it the farthest one? no. is it black? yes.", "right"),
        ("the sheep that is neither leftmost nor rightmost", "middle"),
    ],
)
def test_ends_that_are_denied_are_those_of_all(text: str, expected: str) -> None:
    assert [o.id for o in grounded(text, ASKED).objects] == [expected]
