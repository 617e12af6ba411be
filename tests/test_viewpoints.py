"""From where a side is meant: "if you look at the windows it's the chair on the left", with and without a comma."""

from __future__ import annotations

import pytest
from seen_whole import meant

from dcg_torch import Percept, parse

_FACED, _LEFT_BEHIND = "facing", "facing from"


@pytest.mark.parametrize(
    ("text", "noun", "how", "seen"),
    [
        ("if you look at the shelves it's the crate on the left", "crate", _FACED, "shelf"),
        ("when facing the couch choose the lamp on the right", "lamp", _FACED, "couch"),
        ("facing the stove you want the pot on the left", "pot", _FACED, "stove"),
        ("Face the dresser. It's the vase on the right.", "vase", _FACED, "dresser"),
        ("when you're looking into the mirror, the tap on the right", "tap", _FACED, "mirror"),
        ("looking out the window, the plant on the left", "plant", _FACED, "window"),
        ("facing the foot of the bed, the lamp on the right", "lamp", _FACED, "bed"),
        ("facing the headboard, the lamp on the right", "lamp", _FACED, "bed"),
        ("if you were to sit at the desk, it would be the drawer on the right", "drawer", _FACED, "desk"),
        ("pretend you are in the bed, the rug on the left", "rug", _LEFT_BEHIND, "bed"),
        ("as you come in the door it is the hook on the right", "hook", _LEFT_BEHIND, "door"),
        ("standing at the door looking in, it's the bin on your left", "bin", _LEFT_BEHIND, "door"),
        ("if you stand with your back against the stove, the left crate", "crate", _LEFT_BEHIND, "stove"),
        ("when you lie in the bed, cushion on your left", "cushion", _LEFT_BEHIND, "bed"),
        ("if you are lying in the bed by the stove, the cushion on your left", "cushion", _LEFT_BEHIND, "bed"),
        ("as you enter the room through the door it is the first bunk on the right", "bunk", _LEFT_BEHIND, "door"),
    ],
)
def test_a_viewpoint_is_no_part_of_what_is_meant(text: str, noun: str, how: str, seen: str) -> None:
    tree = parse(text).readings[0].tree
    assert tree.children[0].phrase.noun == noun
    views = [child for child in tree.children if child.phrase.words[:1] == (how,)]
    assert [view.children[0].phrase.noun for view in views] == [seen]
    assert not any(node.phrase.noun == seen for node in tree.children[0].walk())


@pytest.mark.parametrize("text", ["go to the table it is on the left", "look at the cup it is on the left"])
def test_orders_have_no_viewpoint(text: str) -> None:
    tree = parse(text).readings[0].tree
    assert not any(node.phrase.words[:1] == (_FACED,) for node in tree.walk())


_ROOM = [  # north is y: who faces the shelves has the west on the left, who faces the door the north
    *(
        Percept(f"{n} crate", "crate", None, (x, 2.0, 0.3), size=(0.5, 0.5, 0.6))
        for n, x in (("west", 2.0), ("east", 4.0))
    ),
    *(Percept(f"shelf {n}", "shelf", None, (1.5 + n, 4.8, 1.0), size=(0.9, 0.3, 2.0)) for n in range(3)),
    Percept("door", "door", None, (5.95, 2.5, 1.0), size=(0.1, 0.9, 2.0)),
    Percept("stove", "stove", None, (3.0, 0.3, 0.5), size=(0.6, 0.6, 0.9)),
    Percept("lamp", "lamp", None, (0.3, 2.5, 0.8), size=(0.3, 0.3, 1.6)),
    Percept("mug", "mug", None, (1.0, 0.2, 0.1), size=(0.1, 0.1, 0.1)),
]


@pytest.mark.parametrize(
    ("text", "id_"),
    [
        ("if you look at the shelves it's the crate on the left", "west crate"),
        ("with your back to the shelves choose the crate on the left", "east crate"),
        ("face the stove. it's the crate on the left", "east crate"),
    ],
)
def test_sides_are_those_of_the_viewpoint(text: str, id_: str) -> None:
    assert meant(text, _ROOM, robot=None) == [id_]


@pytest.mark.parametrize(
    ("text", "relations"),
    [
        ("the stool with its back to the window", ["near"]),
        ("a sofa whose back is against the wall", ["touching"]),
        ("the crate by itself near the stove, has a jar on it", ["near", "with"]),
    ],
)
def test_backs_and_what_is_told_behind_a_comma(text: str, relations: list[str]) -> None:
    tree = parse(text).readings[0].tree
    assert [child.phrase.words[0] for child in tree.children[0].children] == relations
