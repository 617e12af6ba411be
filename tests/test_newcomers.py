"""What people say in scanned rooms, of shapes and at home. Scenes and commands are ours."""

from __future__ import annotations

import math

import pytest
from seen_whole import HERE, meant, thing

from dcg_torch.names.weights import log_odds
from dcg_torch.types import Percept, Pose

SHAPES = [
    thing("big", "tile", 0.8, 0.3, "orange", shape="triangle", size=(0.25, 0.25, 0.02)),
    thing("small", "tile", 0.5, -0.3, "orange", shape="triangle", size=(0.1, 0.1, 0.02)),
    thing("oval", "tile", 0.3, 0.1, "white", shape="oval", size=(0.15, 0.15, 0.02)),
    thing("square", "tile", 0.2, -0.2, "black", shape="square", size=(0.15, 0.15, 0.02)),
]
ROUND = [
    thing("far", "circle", 0.9, 0.1, "pink"),
    thing("near", "circle", 0.2, 0.2, "pink"),
    thing("far box", "square", 0.8, -0.3, "grey"),
    thing("near box", "square", 0.1, -0.1, "grey"),
]
PAINTED = [
    thing("dark", "brick", 0.8, 0.3, "green", rgb=(10, 80, 20), size=(0.1, 0.1, 0.1)),
    thing("pale", "brick", 0.5, 0.1, "green", rgb=(150, 235, 150), size=(0.1, 0.1, 0.1)),
    thing("can", "cylinder", 0.3, -0.3, "green", rgb=(20, 120, 30), size=(0.1, 0.1, 0.1)),
    *(
        thing(f"sun{k}", "brick", 0.2, 0.3 - 0.5 * k, "yellow", rgb=(240, 230, 30), size=(0.1, 0.1, 0.1))
        for k in (0, 1)
    ),
]
SALOON = [
    thing("door", "door", 0.05, 1.0, z=1.0, size=(0.1, 0.9, 2.0)),
    thing("near left", "stool", 1.5, 2.6, z=0.4, size=(0.4, 0.4, 0.8)),
    thing("near right", "stool", 2.0, 0.3, z=0.4, size=(0.4, 0.4, 0.8)),
    thing("stage", "piano", 6.9, 2.5, z=0.6, size=(0.6, 1.5, 1.2)),
    thing("bar n", "table", 4.0, 4.2, z=0.4, size=(1.2, 0.8, 0.8)),
    thing("bar s", "table", 4.0, 0.8, z=0.4, size=(1.2, 0.8, 0.8)),
    *(thing(f"lamp{k}", "lamp", 1.0 + 2.5 * k, 4.9, z=2.0, size=(0.3, 0.2, 0.3)) for k in range(3)),
    thing("rug", "rug", 3.5, 2.5, z=0.01, size=(2.0, 1.5, 0.02)),
    thing("clock", "clock", 3.5, 0.03, z=2.2, size=(0.4, 0.05, 0.4)),
]
ALCOVE = [
    thing("settee", "couch", 3.0, 0.5, z=0.4, size=(2.2, 0.9, 0.8)),
    thing("east cushion", "cushion", 3.7, 0.45, z=0.7, size=(0.4, 0.3, 0.3)),
    thing("west cushion", "cushion", 2.3, 0.45, z=0.7, size=(0.4, 0.3, 0.3)),
    thing("west cabinet", "cabinet", 2.0, 4.75, z=0.5, size=(0.8, 0.5, 1.0)),
    thing("middle cabinet", "cabinet", 3.2, 4.75, z=0.5, size=(0.8, 0.5, 1.0)),
    thing("east cabinet", "cabinet", 4.4, 4.75, z=0.5, size=(0.8, 0.5, 1.0)),
    thing("vase", "vase", 4.4, 4.75, z=1.15, size=(0.2, 0.2, 0.3)),
    thing("south drape", "curtain", 0.05, 1.5, z=1.2, size=(0.1, 0.3, 2.2)),
    thing("north drape", "curtain", 0.05, 3.5, z=1.2, size=(0.1, 0.3, 2.2)),
    thing("rug", "rug", 3.0, 2.5, z=0.01, size=(2.0, 1.5, 0.02)),
    thing("hook", "coat rack", 5.95, 2.5, z=1.5, size=(0.1, 0.8, 0.3)),
]
HOUSE = [
    *(thing(name, name, x, y, size=(4.0, 4.0, 2.6)) for name, x, y in [("kitchen", 2.0, 2.0), ("bedroom", 2.0, 6.0)]),
    thing("scarf", "scarf", 1.0, 6.5),
    thing("ladle", "ladle", 1.5, 2.5),
    thing("guest", "person", 2.5, 6.5, gender="female"),
    thing("tray", "tray", 3.0, 1.5),
    *(thing(f"crate{k}", "crate", 8.0, 6.0 - 2.0 * k) for k in range(5)),
    thing("hedge", "hedge", 9.0, 2.0, size=(0.5, 10.0, 1.0)),
    thing("barrow", "wheelbarrow", 12.0, 2.0),
]
GIFTS = [
    thing("agnes", "person", 2.0, 1.0, name="Agnes"),
    thing("bert", "person", 2.0, -1.0, name="Bert"),
    thing("lemon", "lemon", 1.0, 0.4),
    thing("jug", "jug", 1.0, -0.4),
]
YARD = [
    thing("by the well", "barrel", 2.0, 1.0, "brown"),
    thing("far off", "barrel", 2.0, -2.0, "brown"),
    thing("white", "barrel", 3.0, -1.0, "white"),
    thing("well", "well", 2.5, 1.6),
    thing("rhombus", "piece", 1.0, 0.0, "white", shape="rhombus"),
    thing("trapezoid", "piece", 1.0, 0.5, "white", shape="trapezoid"),
]

SAID: dict[str, tuple[list[Percept], Pose | None, list[tuple[str, str]]]] = {
    "a noun that is the value of a key is not what the key names": (
        SHAPES,
        HERE,
        [("the large orange triangle", "big"), ("small triangle", "small"), ("the white oval", "oval")],
    ),
    "a shape that is a verb as well": (
        ROUND,
        HERE,
        [
            ("circle at the bottom", "near"),
            ("circle all the way at the top", "far"),
            ("topmost square", "far box"),
            ("bottom square", "near box"),
        ],
    ),
    "what is taken back keeps its colour": (
        PAINTED,
        HERE,
        [
            ("the green brick no the lighter one", "pale"),
            ("the green brick wait no, the lighter brick", "pale"),
            ("the green one, not the brick but the cylinder", "can"),
            ("slide the light green brick between the two yellow ones", "pale"),
        ],
    ),
    "in a room the sides are of who is told to stand there": (
        SALOON,
        None,
        [
            ("if you stand at the door looking in, the stool on your left", "near left"),
            ("when you walk in through the door, the stool to your right", "near right"),
            ("coming in through the door, the table on the left", "bar n"),
            ("when you enter through the door the stool is on your right", "near right"),
            ("the table on the right when you walk in", "bar s"),
            ("the lamp across the room from the piano", "lamp0"),
            ("facing the piano, the table on the right", "bar s"),
            ("facing the piano, this is the table on your left", "bar n"),
            ("standing at the door facing the piano, the table on the right", "bar s"),
        ],
    ),
    "where nobody stands the sides are of who stands before the things": (
        ALCOVE,
        None,
        [
            ("the left cushion on the sofa", "east cushion"),
            ("the cushion on the right", "west cushion"),
            ("the cushion on the left side of the sofa", "east cushion"),
            ("the cushion on the right of the sofa", "west cushion"),
            ("the leftmost cabinet", "west cabinet"),
            ("the second cabinet from the left", "middle cabinet"),
            ("the vase on the right cabinet", "vase"),
            ("the curtain on the left", "south drape"),
        ],
    ),
    "at home": (
        HOUSE,
        Pose(4.0, 4.0, math.pi),
        [
            ("look for the woman in the bedroom and follow her", "guest"),
            ("give him the tray", "tray"),
            ("bring her the scarf", "scarf"),
            ("polish up the ladle", "ladle"),
            ("hand me the ladle, it's standing on the tray", "ladle"),
            ("it's time for the scarf", "scarf"),
            ("the row of crates by the hedge, third one", "crate2"),
            ("the row of crates along the hedge: the middle one", "crate2"),
        ],
    ),
    "who gets a thing is not what is brought": (
        GIFTS,
        HERE,
        [
            ("bring Agnes a lemon", "lemon"),
            ("offer Bert the jug", "jug"),
            ("follow Agnes", "agnes"),
            ("take Bert to the lemon", "bert"),
        ],
    ),
    "words that are hardly heard": (
        YARD,
        HERE,
        [
            ("the barrel nearest the well", "by the well"),
            ("the well", "well"),
            ("ehm the barrel that isnt brown", "white"),
            ("the diamond", "rhombus"),
            ("white trapezium", "trapezoid"),
        ],
    ),
}
"""What holds -> a scene, where the robot stands, commands and what they mean."""


@pytest.mark.parametrize(
    ("things", "robot", "text", "id_"),
    [
        pytest.param(things, robot, text, id_, id=f"{what}: {text}")
        for what, (things, robot, said) in SAID.items()
        for text, id_ in said
    ],
)
def test_what_newcomers_mean(things: list[Percept], robot: Pose | None, text: str, id_: str) -> None:
    assert meant(text, things, robot) == [id_]


def test_who_is_known_to_look_keeps_the_own_sides() -> None:
    from_the_north = Pose(3.0, 6.0, -math.pi / 2.0)
    assert meant("the leftmost cabinet", ALCOVE, from_the_north) == ["east cabinet"]
    assert meant("the cushion on the left of the sofa", ALCOVE, from_the_north) == ["east cushion"]
    assert meant("the cushion on the right side of the sofa", ALCOVE, from_the_north) == ["west cushion"]


def test_what_is_told_of_a_thing_by_and_has() -> None:
    things = [
        thing("plain", "kettle", 1.0, 0.5, "white"),
        thing("meant", "kettle", 1.0, -0.5, "white"),
        thing("ladle", "ladle", 1.1, -0.6, "black"),
        thing("pot", "pot", 1.4, 0.0, "black"),
    ]
    text = "the kettle is on the counter. it is white and has a ladle next to it"
    assert meant(text, things) == ["meant"]


def test_what_is_closest_is_one_of_all_that_the_name_of_a_kind_names() -> None:
    things = [
        thing("lemon", "lemon", 1.0, 0.9),
        thing("plum", "plum", 1.0, 0.3),
        thing("far plum", "plum", 1.0, -0.8),
        thing("jug", "jug", 1.0, 0.0),
        thing("fork", "fork", 1.0, 0.1),
    ]
    assert meant("the fruit closest to the jug", things) == ["plum"]
    assert meant("the fruit farthest from the jug", things) == ["lemon"]


def test_a_roll_of_it_is_it() -> None:
    assert log_odds("toilet paper roll", "toilet paper") > 0.0 > log_odds("toilet paper roll", "towel")
