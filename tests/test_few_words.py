"""Few words by which people tell each other of dots, people and blocks with marks. Commands that we wrote."""

from __future__ import annotations

from typing import Any

import pytest
from asked import shipped

from dcg_torch.evaluation.episodes import Episode
from dcg_torch.evaluation.protocol import answers
from dcg_torch.interpretation.people import of_people
from dcg_torch.language import default_parser
from dcg_torch.names.colors import looks_like
from dcg_torch.types import Percept

Thing = dict[str, Any]
GRAYS = {"black": 20, "dark grey": 80, "grey": 138, "light grey": 204}


def _meant(text: str, things: list[Thing]) -> set[str]:
    robot = {"x": -0.2, "y": 0.0, "yaw": 0.0}
    episode = Episode.model_validate({"id": "a", "text": text, "objects": things, "target": [], "robot": robot})
    (answer,) = answers(shipped(), [episode], default_parser().parse)
    return set(answer.predicted)


def _dots(upright: bool, *dots: tuple[str, float, float, float, str]) -> list[Thing]:
    """Of (id, to the right, up, size, gray)."""
    return [
        {"id": name, "type": "dot", "size": size, "rgb": [GRAYS[gray]] * 3}
        | {"position": [2.0, -right, 1.2 + up] if upright else [1.2 + up, -right, 0.0]}
        for name, right, up, size, gray in dots
    ]


ROW = (
    ("l", -0.5, 0.2, 0.11, "grey"),
    ("m", -0.3, 0.2, 0.06, "light grey"),
    ("r", -0.1, 0.2, 0.12, "black"),
    ("a", 0.7, 0.8, 0.2, "dark grey"),
    ("b", 0.75, -0.35, 0.06, "black"),
    ("c", -0.8, -0.9, 0.21, "black"),
    ("d", 0.1, -0.8, 0.12, "grey"),
)


@pytest.mark.parametrize("upright", [True, False])
@pytest.mark.parametrize(
    ("text", "ids"),
    [
        ("the row of three", "l m r"),
        ("line of three dots, the one in the middle", "m"),
        ("three in a row: the left one", "l"),
        ("three in a row, second from the left", "m"),
        ("row of three that gets darker to the right, the darkest", "r"),
        ("the darkest one in the line of three", "r"),
        ("do you see the three dots in a row? pick the smallest", "m"),
    ],
)
def test_a_row_is_what_is_plainly_one(text: str, ids: str, upright: bool) -> None:
    assert _meant(text, _dots(upright, *ROW)) == set(ids.split())


SIZES = (
    ("b1", -0.7, 0.6, 0.2, "grey"),
    ("b2", 0.6, 0.5, 0.21, "dark grey"),
    ("b3", 0.1, -0.7, 0.2, "light grey"),
    ("m1", -0.2, 0.1, 0.12, "black"),
    ("s1", 0.7, -0.4, 0.06, "black"),
    ("s2", -0.8, -0.5, 0.055, "light grey"),
    ("s3", 0.15, 0.75, 0.06, "grey"),
)


@pytest.mark.parametrize("upright", [True, False])
@pytest.mark.parametrize(
    ("text", "ids"),
    [
        ("there are three large dots. the darkest one", "b2"),
        ("of the three big ones the lightest", "b3"),
        ("the darkest of the three large ones", "b2"),
        ("the leftmost large one", "b1"),
        ("the smallest dot that isn't light grey", "s1 s3"),
        ("the biggest dot that isn't dark grey", "b1 b3"),
        ("two black ones, the bigger one", "m1"),
        ("of the two black ones the smaller", "s1"),
    ],
)
def test_what_is_compared_among_those_that_are_described(text: str, ids: str, upright: bool) -> None:
    found = _meant(text, _dots(upright, *SIZES))
    assert found
    assert found <= set(ids.split())


@pytest.mark.parametrize("upright", [True, False])
@pytest.mark.parametrize(
    ("text", "ids"),
    [
        ("a big black one with a small grey one to its left: the small one", "s"),
        ("large black dot, small grey dot to the left of it. pick the small one", "s"),
        ("the loneliest dot", "z"),
        ("furthest down", "z"),
        ("the one that is bigger than all the others", "x"),
    ],
)
def test_one_beside_another_and_one_by_itself(text: str, ids: str, upright: bool) -> None:
    dots = _dots(
        upright,
        ("x", 0.3, 0.5, 0.22, "black"),
        ("s", 0.08, 0.5, 0.06, "grey"),
        ("t", 0.6, 0.3, 0.06, "grey"),
        ("u", 0.0, 0.1, 0.12, "light grey"),
        ("v", 0.4, 0.0, 0.12, "dark grey"),
        ("z", -0.9, -0.9, 0.12, "grey"),
    )
    assert _meant(text, dots) == {ids}


def test_a_look_has_one_word_for_a_gray() -> None:
    names = ("black", "dark gray", "gray", "light gray", "white")
    for level, own in zip((15, 80, 138, 205, 252), names, strict=True):
        assert [name for name in names if looks_like(name, (level,) * 3)] == [own]
    assert looks_like("red", (210, 30, 30))
    assert not looks_like("quorb", (210, 30, 30))


def _people(bald: str) -> list[Thing]:
    """Two rows of three; of the last nobody has hair, told as an unusual value of `hair`."""
    told = (
        ("female", "blond", "yes", "no", "no", "no", "yes"),
        ("male", "dark", "no", "yes", "yes", "no", "no"),
        ("male", "dark", "no", "no", "no", "yes", "no"),
        ("female", "dark", "no", "no", "no", "yes", "no"),
        ("male", "grey", "yes", "yes", "no", "no", "yes"),
        ("male", bald, "yes", "no", "no", "no", "no"),
    )
    keys = ("gender", "hair", "glasses", "beard", "tie", "hat", "smiling")
    return [
        {"id": str(k), "type": "portrait", "position": [2.0, 0.5 - 0.5 * (k % 3), 1.6 - 0.6 * (k // 3)]}
        | dict(zip(keys, own, strict=True))
        for k, own in enumerate(told)
    ]


@pytest.mark.parametrize("bald", ["bald", "none"])
@pytest.mark.parametrize(
    ("text", "ids"),
    [
        ("she is smiling", "0"),
        ("she's wearing a hat", "3"),
        ("he has a beard, but he doesn't wear glasses", "1"),
        ("the guy with neither tie nor glasses", "2"),
        ("no beard, glasses, no smile", "5"),
        ("man with no hair", "5"),
        ("no hair and glasses", "5"),
        ("all those with glasses", "0 4 5"),
        ("everybody except the men", "0 3"),
        ("there are two men with beards. I mean the one without glasses", "1"),
        ("of the two bearded men the one with glasses", "4"),
        ("the person to the right of the man with the tie", "2"),
        ("the woman who is not smiling", "3"),
        ("see the man with the tie? the person to his left", "0"),
        ("does he have a beard and glasses? then that's him", "4"),
    ],
)
def test_people_in_few_words(text: str, ids: str, bald: str) -> None:
    assert _meant(text, _people(bald)) == set(ids.split())


def test_where_nobody_is_shown_texts_stay_as_they_are() -> None:
    mug = Percept("a", "mug", "red", (1.0, 0.0, 0.0), attributes=frozenset({"state: full"}))
    assert of_people("she is smiling", [mug]) == "she is smiling"
    assert of_people("no lid, glasses", []) == "no lid, glasses"


def _blocks(style: str, *marks: str) -> list[Thing]:
    places = [(0.6, 0.6), (0.7, -0.1), (0.8, -0.7), (1.3, 0.4), (1.4, -0.4), (1.9, 0.2)]
    things = []
    for mark, (x, y) in zip(marks, places, strict=False):
        thing: Thing = {"id": mark, "type": "block", "position": [x, y, 0.075], "size": 0.15}
        things.append(thing | ({"type": f"{mark} block"} if style == "class" else {style: mark}))
    return things


LOGOS = ("Adidas", "Esso", "Heineken", "Starbucks", "Target", "UPS")
NUMBERS = ("2", "3", "5", "8", "9", "11")


@pytest.mark.parametrize("style", ["logo", "label", "class"])
@pytest.mark.parametrize(
    ("text", "ids"),
    [
        ("above the Starbucks block you put the Heineken one", "Heineken"),
        ("in between Esso and UPS goes Adidas", "Adidas"),
        ("left of Target is where UPS should go", "UPS"),
        ("beside Esso I want Starbucks", "Starbucks"),
        ("Adidas is supposed to be right of Esso", "Adidas"),
        ("with the Target block, form a row with Esso and UPS", "Target"),
        ("Look for UPS. It should go to the right of Esso.", "UPS"),
        ("Pepsi should be left of Esso", ""),
        ("pick up Nvidia", ""),
        ("put the block closest to Esso on top of UPS", "Heineken"),
        ("the block next to UPS", "Starbucks"),
    ],
)
def test_blocks_with_logos(text: str, ids: str, style: str) -> None:
    assert _meant(text, _blocks(style, *LOGOS)) == set(ids.split())


@pytest.mark.parametrize("style", ["digit", "label", "class"])
@pytest.mark.parametrize(
    ("text", "ids"),
    [
        ("Place 15 next to 2", ""),
        ("move seven between 3 and 5", ""),
        ("both 8 and 11", "8 11"),
        ("line 8 up with 2", "8"),
        ("between 3 and 5 put number 9", "9"),
        ("block 3 two spaces to the left", "3"),
    ],
)
def test_blocks_with_numbers(text: str, ids: str, style: str) -> None:
    assert _meant(text, _blocks(style, *NUMBERS)) == set(ids.split())


@pytest.mark.parametrize("style", ["logo", "class"])
@pytest.mark.parametrize(
    ("text", "id_"),
    [
        ("the block Esso is standing on", "Adidas"),
        ("what Esso is on", "Adidas"),
        ("the block under Esso", "Adidas"),
        ("take the block off Adidas", "Esso"),
        ("the block that stands on Adidas", "Esso"),
        ("the block on Adidas", "Esso"),
    ],
)
def test_what_bears_a_block_and_what_stands_on_it(text: str, id_: str, style: str) -> None:
    things = _blocks(style, *LOGOS)
    things[1]["position"] = [*things[0]["position"][:2], 0.225]
    assert _meant(text, things) == {id_}
