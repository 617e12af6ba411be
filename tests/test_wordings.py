"""Kinds of wording in small scenes: lines that meet, states, corrected places, what is ruled out, who faces what.

We wrote the commands and the scenes.
"""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import pytest

from dcg_torch.evaluation.episodes import read_episodes
from dcg_torch.evaluation.protocol import answers
from dcg_torch.language import parse_command, target_phrase
from dcg_torch.model.core import GroundingModel


def _thing(id_: str, kind: str, x: float, y: float, color: str | None = None, **more: Any) -> dict[str, Any]:
    return {"id": id_, "type": kind, "color": color, "position": [x, y, 0.0], **more}


_TILES = [
    _thing(f"{row}-{column}", "tile", 5.0 - row, 2.0 - column, "red") for row in (1, 2, 3) for column in (1, 2, 3)
]
_LAMPS = [
    _thing("lit", "lamp", 3, 1, state="on"),
    _thing("dark", "lamp", 3, -1, state="off"),
    _thing("c", "chair", 4, 0),
]
_DRAWERS = [_thing("open", "drawer", 3, 1, isOpen=True), _thing("closed", "drawer", 3, -1, isOpen=False)]
_CUPS = [_thing("bowl", "bowl", 3, 0), _thing("left", "cup", 3, 1), _thing("right", "cup", 3, -1),
         _thing("far", "cup", 4, 0)]  # fmt: skip
_BLOCKS = [
    _thing("red", "block", 3, 1, "red"),
    _thing("blue", "block", 3, -1, "blue"),
    _thing("b", "ball", 4, 0, "green"),
]
_TWO = [_thing("left", "cup", 3, 1, "red"), _thing("right", "cup", 3, -1, "red"), _thing("p", "plate", 4, 0, "blue")]
_ROOM = [_thing("bed", "bed", 0, 4, size=[2, 1.5, 0.5]), _thing("a", "lamp", -2, 1), _thing("b", "lamp", 2, 1),
         _thing("couch", "couch", 0, -4, "brown", size=[2, 1, 0.8])]  # fmt: skip
_TABLES = [_thing("with", "table", 3, 2, size=[1.2, 0.8, 0.7]), _thing("chair", "chair", 3, 1.1, size=[0.5, 0.5, 0.9]),
           _thing("without", "table", 3, -2, size=[1.2, 0.8, 0.7])]  # fmt: skip


@pytest.mark.parametrize(
    ("text", "things", "meant"),
    [
        ("the tile in the second column of the third row", _TILES, "3-2"),
        ("take the tile in the second column of the top row", _TILES, "1-2"),
        ("pick the tile in the first row of the third column", _TILES, "1-3"),
        ("the tile in the third row, second column", _TILES, "3-2"),
        ("the second row, third column", _TILES, "2-3"),
        ("the tile in the second row and the third column", _TILES, "2-3"),
        ("go to the tile in row 2 column 3", _TILES, "2-3"),
        ("take row 2 column 3", _TILES, "2-3"),
        ("take the tile, row two, column three", _TILES, "2-3"),
        ("in the second row the third tile", _TILES, "2-3"),
        ("second row, right", _TILES, "2-3"),
        ("the third tile in the second row", _TILES, "2-3"),
        ("the lamp that is off", _LAMPS, "dark"),
        ("take the lamp that's turned on", _LAMPS, "lit"),
        ("the lamp that is not on", _LAMPS, "dark"),
        ("the one that is off", _LAMPS, "dark"),
        ("the open drawer", _DRAWERS, "open"),
        ("take the drawer that is closed", _DRAWERS, "closed"),
        ("the drawer which is not open", _DRAWERS, "closed"),
        ("the drawer that isn't shut", _DRAWERS, "open"),
        ("take the cup left of the bowl, no, right of it", _CUPS, "right"),
        ("the cup right of the bowl, no wait, left of it", _CUPS, "left"),
        ("go to the cup to the right of the bowl, no, behind it", _CUPS, "far"),
        ("take the cup to the left of the bowl, sorry, to the right", _CUPS, "right"),
        ("take the red one, sorry, I mean the blue one", _BLOCKS, "blue"),
        ("take the block but not the red one", _BLOCKS, "blue"),
        ("a block other than the red one", _BLOCKS, "blue"),
        ("pick up a block, any but the blue one", _BLOCKS, "red"),
        ("not the one on the left, the other one", _TWO, "right"),
        ("take the cup, not the one on the left, the other one", _TWO, "right"),
        ("not the left cup, the other one", _TWO, "right"),
        ("the cup other than the one on the right", _TWO, "left"),
        ("facing the bed, take the lamp on your left", _ROOM, "a"),
        ("facing the big brown couch, take the lamp on your right", _ROOM, "a"),
        ("when you look at the brown couch, take the lamp on your left", _ROOM, "b"),
        ("the lamp to your left as you face the brown couch", _ROOM, "b"),
        ("if you are facing the bed, the lamp on the right", _ROOM, "b"),
        ("turn to the bed and take the lamp on your left", _ROOM, "a"),
        ("turn to the couch and take the lamp on your left", _ROOM, "b"),
        ("face the couch and take the lamp on the right", _ROOM, "a"),
        ("the table with the chair", _TABLES, "with"),
        ("the table without a chair", _TABLES, "without"),
    ],
)
def test_what_is_meant(
    model: GroundingModel, tmp_path: Path, text: str, things: list[dict[str, Any]], meant: str
) -> None:
    row = {"id": "1", "text": text, "robot": {"x": 0, "y": 0, "yaw": 0}, "objects": things, "target": [meant]}
    (tmp_path / "scene.jsonl").write_text(json.dumps(row) + "\n")
    (answer,) = answers(model, read_episodes(tmp_path / "scene.jsonl"), parse_command, file="scene")
    assert answer.predicted == (meant,)


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("take the red block, not the blue one", ()),  # what is red is not blue
        ("the black block but not the big black one", ("not big",)),
        ("the blue cone, not orange", ("not orange",)),
    ],
)
def test_what_is_ruled_out_and_says_more(text: str, words: tuple[str, ...]) -> None:
    (reading, *_) = parse_command(text).readings
    assert target_phrase(reading.tree).phrase.words == words


def test_readings_of_one_command_leave_those_of_the_next_as_they_are() -> None:
    before = parse_command("the cone next to the cube").readings
    for text in ("not the red one", "not purple, nor the left one", "not the cube"):
        parse_command(text)
    assert parse_command("the cone next to the cube").readings == before


def test_rows_of_blocks_are_no_lines() -> None:
    phrase = target_phrase(parse_command("the last block in the row of five blocks").readings[0].tree)
    (place,) = phrase.children
    assert place.children[0].phrase.noun == "block"
    assert set(place.children[0].phrase.words) >= {"row", "of 5"}


@pytest.mark.parametrize(
    ("text", "noun", "words"),
    [
        ("the box that is open", "box", {"open"}),
        ("move the block that is parallel to me", "block", {"parallel"}),
        ("the second from the left blue block", "block", {"second", "from the left"}),
        ("the secondmost right green block", "block", {"second", "from the right"}),
        ("the third most left chair", "chair", {"third", "from the left"}),
    ],
)
def test_states_and_ranks_in_other_places(text: str, noun: str, words: set[str]) -> None:
    tree = parse_command(text).tree
    assert tree is not None
    phrase = target_phrase(tree).phrase
    assert (phrase.noun, set(phrase.words)) == (noun, words)


def test_those_that_stand_together_are_next_to_each_other() -> None:
    tree = parse_command("the two sheep standing together").tree
    assert tree is not None
    assert [child.phrase.words for child in target_phrase(tree).children] == [("next to",)]
