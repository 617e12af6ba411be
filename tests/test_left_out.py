"""What is left out by its kind ("something red but no cup"), all that is so, things told in turns, and judgements.

Scenes and commands are ours.
"""

from __future__ import annotations

import pytest
from asked import meant, standing

from dcg_torch.language import default_parser, target_phrase

BENCH = (  # id, class, colour, x, y
    ("red tin", "tin", "red", 1.0, 0.6),
    ("blue tin", "tin", "blue", 1.2, 0.2),
    ("red bolt", "bolt", "red", 1.1, -0.2),
    ("blue bolt", "bolt", "blue", 1.4, -0.6),
    ("plate", "plate", "green", 1.6, 0.1),
)


def _meant(text: str, things: tuple[tuple[str, str, str, float, float], ...] = BENCH) -> set[str]:
    return meant(text, standing(*things), looked=True)


@pytest.mark.parametrize(
    ("text", "meant"),
    [
        ("something red but no tin", {"red bolt"}),
        ("bring me something blue, but not a bolt", {"blue tin"}),
        ("the red one, not the tin", {"red bolt"}),
        ("the blue one but not the bolt", {"blue tin"}),
        ("a thing that is no tin and no bolt", {"plate"}),
        ("the thing that is neither a tin nor a bolt", {"plate"}),
        ("the blue thing which is no bolt", {"blue tin"}),
        ("anything blue except tins", {"blue bolt"}),
        ("everything else than the red ones", {"blue tin", "blue bolt", "plate"}),
        ("anything green", {"plate"}),
        ("whatever is red", {"red tin", "red bolt"}),
        ("take whatever is not red", {"blue tin", "blue bolt", "plate"}),
        ("all that is blue", {"blue tin", "blue bolt"}),
        ("whatever is farthest from you", {"plate"}),
        ("the bolt, whatever it is, that is blue", {"blue bolt"}),
        ("the blue tin, not the red one", {"blue tin"}),
        ("not the red tin, the other one", {"blue tin"}),
    ],
)
def test_what_is_left_out_by_its_kind_is_not_meant(text: str, meant: set[str]) -> None:
    assert _meant(text) == meant


@pytest.mark.parametrize(
    ("text", "meant"),
    [
        ("take the cart, not the tea cart", {"cart"}),
        ("a stool. Not a step stool.", {"stool"}),
        ("the stool that is not a step stool", {"stool"}),
    ],
)
def test_a_kind_of_it_is_left_out(text: str, meant: set[str]) -> None:
    things = (
        ("tea cart", "tea cart", "brown", 1.0, 0.6),
        ("cart", "cart", "brown", 1.2, -0.4),
        ("step stool", "step stool", "black", 2.0, 1.0),
        ("stool", "stool", "black", 2.0, -1.0),
    )
    assert _meant(text, things) == meant


def test_two_things_that_a_place_is_not() -> None:
    things = (
        ("rug", "rug", "gray", 1.0, 2.0),
        ("crate", "crate", "gray", 1.0, -2.0),
        ("at rug", "stool", "black", 1.4, 2.0),
        ("at crate", "stool", "black", 1.4, -2.0),
        ("apart", "stool", "black", 4.0, 0.0),
    )
    for text in (
        "the stool that's not by the rug or next to the crate",
        "the stool that is neither by the rug nor by the crate",
        "the stool that is not near the rug and isn't near the crate",
        "the stool that is not the one by the rug or near the crate",
    ):
        assert _meant(text, things) == {"apart"}


def test_a_second_predicate_is_said_of_the_same_thing() -> None:
    tree = default_parser().parse("the vase that is on the shelf by the door and is next to the clock").tree
    assert tree is not None
    vase = tree.children[0]
    assert [(c.phrase.words[0], c.children[0].phrase.noun) for c in vase.children] == [
        ("on", "shelf"),
        ("next to", "clock"),
    ]


@pytest.mark.parametrize(
    "text",
    [
        "thx that was the right one",
        "no, that was the wrong tin",
        "perfect, this was the bolt I wanted",
        "that one was correct",
        "you took the wrong bolt",
        "wrong plate",
        "good choice",
        "well done, that is the tin",
        "thanks for the plate",
        "not that one",
    ],
)
def test_a_judgement_orders_nothing(text: str) -> None:
    assert default_parser().parse(text).refused


@pytest.mark.parametrize(
    ("text", "meant"),
    [
        ("That was the right one. Now take the red bolt.", {"red bolt"}),
        ("that was the wrong one, take the blue tin", {"blue tin"}),
        ("thanks for the tin, now take the plate", {"plate"}),
        ("the plate that was right beside the tins", {"plate"}),
    ],
)
def test_an_order_beside_a_judgement_is_one(text: str, meant: set[str]) -> None:
    assert _meant(text) == meant


@pytest.mark.parametrize(
    ("text", "noun", "color", "words", "places"),
    [
        ("the star shaped cushion", "cushion", None, {"star"}, {}),
        ("a yellow oval shaped tray", "tray", "yellow", {"oval"}, {}),
        ("the piece shaped like a star", "piece", None, set(), {"shape": "star"}),
        ("the most central bolt", "bolt", None, {"middlemost"}, {}),
        ("the bolt closest to the top and left", "bolt", None, set(), {"closest to": "corner"}),
        ("the bolt left of the board center", "bolt", None, set(), {"left of": "center"}),
        ("the bolt all of the way on the right", "bolt", None, set(), {"on": "right"}),
        ("take the vase - tall or short? - the tall one", "vase", None, {"tall"}, {}),
        ("I need a scarf. Green or red? Red please.", "scarf", "red", set(), {}),
        ("Take the pot. Actually no, leave it. Take the green pan instead.", "pan", "green", set(), {}),
        ("there is a tray close to you and one far from you. i want the far one", "tray", None, {"far"}, {}),
        ("the red one next to the blue bin. The left blue bin, I mean.", None, "red", set(), {"next to": "bin"}),
        ("if you are standing at the shelves and facing them, the stool on the right", "stool", None, set(),
         {"on": "right"}),
        ("the man not wearing glasses", "man", None, set(), {"without": "glass"}),
        ("bald man, wears glasses", "man", None, {"bald"}, {"with": "glass"}),
        ("The crate at the door moves north", "crate", None, set(), {"at": "door"}),
    ],
)  # fmt: skip
def test_what_is_said_of_the_thing(
    text: str, noun: str | None, color: str | None, words: set[str], places: dict[str, str]
) -> None:
    tree = default_parser().parse(text).tree
    assert tree is not None
    meant = target_phrase(tree)
    told = {c.phrase.words[0]: c.children[0].phrase.noun for c in meant.children}
    assert (meant.phrase.noun, meant.phrase.color, {*meant.phrase.words}, told) == (noun, color, words, places)
