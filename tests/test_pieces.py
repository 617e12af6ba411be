"""People told of in pieces, things called by names alone, and of several the one that is picked."""

from __future__ import annotations

from typing import Final

import pytest
from asked import meant

from dcg_torch.evaluation.episodes import EpisodeObject
from dcg_torch.interpretation.telegrams import as_one_phrase
from dcg_torch.language import default_parser
from dcg_torch.language.parser import target_phrase
from dcg_torch.names.attributes import attribute_evidence
from dcg_torch.types import Percept

MEN: Final[tuple[tuple[str, bool, bool, bool, str, str], ...]] = (  # name, glasses, beard, hat, hair
    ("ada", False, False, True, "brown", "female"),
    ("ben", True, True, False, "black", "male"),
    ("cid", False, True, False, "brown", "male"),
    ("dan", True, False, False, "bald", "male"),
    ("eve", True, False, False, "brown", "female"),
    ("fred", False, True, False, "black", "male"),
)
SHOPS: Final = (("lidl", 0.3, 0.6), ("aldi", 0.3, 0.0), ("ikea", 0.3, -0.6), ("zara", 1.0, 0.5), ("rewe", 1.0, -0.5))
SPOTS: Final = (  # number, from the left, from the top, radius, gray
    ("0", 0.2, 0.25, 0.10, 190),
    ("1", 0.3, 0.12, 0.10, 60),
    ("2", 0.5, 0.45, 0.06, 190),
    ("3", 0.6, 0.50, 0.06, 60),
    ("4", 0.85, 0.60, 0.12, 120),
    ("5", 0.4, 0.90, 0.13, 190),
)


def _men() -> list[Percept]:
    rows = [
        {"id": n, "type": "person", "position": [2.0, 0.8 - 0.4 * (k % 3), 1.0 - 0.4 * (k // 3)], "color": None}
        | {"glasses": glasses, "beard": beard, "hat": hat, "hairColour": hair, "gender": gender}
        for k, (n, glasses, beard, hat, hair, gender) in enumerate(MEN)
    ]
    objects = [EpisodeObject.model_validate(row) for row in rows]
    return [Percept(o.id, o.type, None, (2.0, *o.position[1:]), None, o.attributes) for o in objects]


def _spots() -> list[Percept]:
    return [
        Percept(n, "dot", None, (3.0 - 2.0 * y, 1.0 - 2.0 * x, 0.0), size=(r,) * 3, rgb=(g,) * 3)
        for n, x, y, r, g in SPOTS
    ]


@pytest.mark.parametrize(
    ("text", "who"),
    [
        ("bearded, no glasses, black hair", {"fred"}),
        ("brown hair, beard", {"cid"}),
        ("no beard, no hat, male", {"dan"}),
        ("a woman. has glasses. no hat", {"eve"}),
        ("she's got brown hair and doesn't wear glasses", {"ada"}),
        ("has black hair and wears specs", {"ben"}),
        ("glasses but no beard, female", {"eve"}),
        ("the face at the bottom left", {"dan"}),
        ("picture of the bald man", {"dan"}),
    ],
)
def test_who_is_told_of_in_pieces(text: str, who: set[str]) -> None:
    assert meant(text, _men(), looked=True) == who


@pytest.mark.parametrize(
    "text",
    [
        "the man with the red cap, next to the blonde",
        "take the cup, then the plate",
        "glasses",
        "the old man",
        "black and white tie, old",
    ],
)
def test_what_is_told_otherwise_stays(text: str) -> None:
    assert as_one_phrase(text) == text


def test_a_value_of_several_words_says_each() -> None:
    long_black = {"hair: long black hair"}
    assert attribute_evidence(("with long hair",), long_black) == ("attribute: equal",)
    assert attribute_evidence(("with short hair",), long_black) == ("attribute: contrary",)


@pytest.mark.parametrize(
    ("text", "which"),
    [
        ("the block between lidl and ikea", {"aldi"}),
        ("take the logo in the bottom right corner", {"ikea"}),
        ("right of zara", {"rewe"}),
        ("the lidl block", {"lidl"}),
    ],
)
def test_what_is_called_by_names_alone_is_a_block(text: str, which: set[str]) -> None:
    shops = [Percept(n, n, None, (1.0 + x, y, 0.05), (0.15,) * 3) for n, x, y in SHOPS]
    assert meant(text, shops, looked=True) == which


def test_a_block_is_missing_among_kinds_of_things() -> None:
    things = [Percept(n, n, None, (1.0, 0.4 * k, 0.0)) for k, n in enumerate(("cup", "spoon", "lamp", "book"))]
    assert meant("the block left of the cup", things, looked=True) == set()


@pytest.mark.parametrize(("text", "letter"), [("the red a", "1"), ("the a to the right of the o", "3")])
def test_a_is_a_letter_where_letters_are(text: str, letter: str) -> None:
    tiles = [("0", "o", "blue"), ("1", "a", "red"), ("2", "t", "blue"), ("3", "a", "blue")]
    at = {"0": (1.2, 0.0), "1": (1.6, 0.4), "2": (1.6, 0.0), "3": (1.2, -0.4)}
    percepts = [
        Percept(n, "tile", c, (*at[n], 0.0), (0.1,) * 3, frozenset({f"letter: {ch.upper()}"})) for n, ch, c in tiles
    ]
    assert meant(text, percepts, looked=True) == {letter}


@pytest.mark.parametrize(
    ("text", "which"),
    [
        ("the biggest", {"5"}),
        ("the second largest dot", {"4"}),
        ("the two biggest dots", {"4", "5"}),
        ("the two dots in the upper left", {"0", "1"}),
        ("the dot at the bottom left", {"5"}),
        ("two dots upper left, the higher", {"1"}),
        ("the lower of the two dots in the upper left", {"0"}),
        ("two same size dots in the upper left, lighter one", {"0"}),
        ("of the two tiny dots the darker", {"3"}),
        ("the darker one of the close pair", {"3"}),
        ("There is a big light dot at the bottom and a tiny black one in the middle. Take the black one.", {"3"}),
    ],
)
def test_of_several_one_is_picked(text: str, which: set[str]) -> None:
    assert meant(text, _spots(), looked=True) == which


@pytest.mark.parametrize(
    ("text", "relation"),
    [
        ("a cup with a plate down and to its right", "southeast of"),
        ("a cup with a plate up and to the left of it", "northwest of"),
        ("a cup with a plate to its left and slightly below", "southwest of"),
    ],
)
def test_on_a_slant(text: str, relation: str) -> None:
    tree = default_parser().parse(text).tree
    assert tree is not None
    plate = target_phrase(tree).children[0].children[0]
    assert (plate.phrase.noun, plate.children[0].phrase.words) == ("plate", (relation,))


@pytest.mark.parametrize(
    ("text", "noun", "words"),
    [
        ("There is a big red cup with a tiny lid on it. Select the big one.", "cup", {"big"}),
        ("I have a dark mug and a pale bowl. Give me the pale one.", "bowl", {"pale"}),
        ("three black dots forming a triangle, the biggest", "dot", {"biggest", "of 3"}),
    ],
)
def test_what_is_named_again_by_its_looks(text: str, noun: str, words: set[str]) -> None:
    tree = default_parser().parse(text).tree
    assert tree is not None
    phrase = target_phrase(tree).phrase
    assert (phrase.noun, set(phrase.words)) == (noun, words)
