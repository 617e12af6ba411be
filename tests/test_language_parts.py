"""Spelling and colours."""

from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from dcg_torch.english.spelling import Speller
from dcg_torch.language import parse_command
from dcg_torch.language.colors import COLOR_NAMES, match_color, normal_color
from dcg_torch.language.lexicon import REWRITES
from dcg_torch.language.tokens import tokens


@given(word=st.text("abcde", min_size=1, max_size=9))
def test_english_and_known_words_stay(word: str) -> None:
    assert Speller([{"abcde"}], lambda found: found == word).correct(word) == word
    assert Speller([{"abcde", word}], lambda _: False).correct(word) == word


@pytest.mark.parametrize(
    ("word", "mended"),
    [("pyramind", "pyramid"), ("pirymid", "pyramid"), ("blcok", "block"), ("qube", "cube"), ("cbe", "cbe"),
     ("brick", "brick"), ("zzzzz", "zzzzz")],
)  # fmt: skip
def test_correct(word: str, mended: str) -> None:
    assert Speller([{"pyramid", "block", "cube"}], lambda found: found == "brick").correct(word) == mended


def test_ties_are_left_alone_and_earlier_groups_win() -> None:
    assert Speller([{"cart", "cast"}], lambda _: False).correct("cakt") == "cakt"
    assert Speller([{"corner"}, {"horner"}], lambda _: False).correct("korner") == "corner"


@pytest.mark.parametrize(
    ("text", "color", "length"),
    [
        ("red cube", "red", 1), ("grey cube", "gray", 1), ("light blue block", "light blue", 2),
        ("dark grey brick", "dark gray", 2), ("sky blue pyramid", "sky blue", 2), ("navy blue box", "navy blue", 2),
        ("blue green tower", "blue", 1), ("bright sky blue", "bright sky blue", 3), ("red coloured cube", "red", 2),
        ("very dark green", "very dark green", 3), ("light cube", None, 0), ("brick wall", None, 0), ("", None, 0),
    ],
)  # fmt: skip
def test_match_color(text: str, color: str | None, length: int) -> None:
    assert match_color(text.split(), 0) == (None if color is None else (color, length))


@pytest.mark.parametrize(
    ("said", "plain"),
    [
        ("the 2nd cup", "the second cup"),
        ("the 12th cup", "the 12th cup"),
        ("the cup at about seven o'clock", "the cup in the bottom left corner"),
        ("the cup, 12 o'clock", "the cup, at the top"),
        ("the room where we usually cook", "the kitchen"),
        ("the lamp where I brush my teeth", "the lamp in the bathroom"),
        ("something I can measure the shelf with", "the measuring thing"),
        ("a place to sit down on", "the seat"),
        ("something cold to drink", "the cold drink"),
        ("the man w/o a hat", "the man without a hat"),
        ("the man w/ a hat", "the man with a hat"),
        ("is it red? no. is it a cup? yes", "it is not red. it is a cup."),
        ("start at the bowl and go 3 to the left", "take the third one left of the bowl"),
        ("the one two to the left of the bowl", "the second one left of the bowl"),
        ("third tile from the left, second from the bottom",
         "the one in the third column from the left in the second row from the bottom"),
        ("get hold of the cup, plz", "take the cup, please"),
    ],
)  # fmt: skip
def test_what_stands_for_what(said: str, plain: str) -> None:
    assert tokens(said) == tokens(plain)


def test_all_rewrites_are_patterns_though_few_commands_ask_for_one() -> None:
    assert all(row.pattern.pattern == row.old for row in REWRITES.rows)


def test_color_names_are_normal_and_many() -> None:
    assert len(COLOR_NAMES) > 900
    assert all(normal_color(name) == name for name in COLOR_NAMES)


def test_many_small_words_are_read_in_one_pass() -> None:
    parse = parse_command("so " * 190 + "go to the cube")
    assert parse.noun == "cube"
