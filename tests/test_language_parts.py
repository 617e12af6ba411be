"""Spelling and colours, without spaCy."""

from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from dcg_torch.language.colors import color_names, match_color, normal_color
from dcg_torch.language.spelling import Speller, edits

_WORD = st.text("abc", max_size=6)


def slow_edits(a: str, b: str) -> int:
    """The definition of the optimal string alignment distance, without a table."""
    if not a or not b:
        return len(a) + len(b)
    best = min(slow_edits(a[1:], b) + 1, slow_edits(a, b[1:]) + 1, slow_edits(a[1:], b[1:]) + (a[0] != b[0]))
    if len(a) > 1 and len(b) > 1 and a[0] == b[1] and a[1] == b[0]:
        best = min(best, slow_edits(a[2:], b[2:]) + 1)
    return best


@given(a=_WORD, b=_WORD, limit=st.integers(0, 3))
def test_edits_agree_with_their_definition(a: str, b: str, limit: int) -> None:
    assert edits(a, b, limit) == min(slow_edits(a, b), limit + 1)


@given(word=st.text("abcde", min_size=1, max_size=9))
def test_english_and_known_words_stay(word: str) -> None:
    assert Speller([{"abcde"}], english={word}).correct(word) == word
    assert Speller([{"abcde", word}], english=set()).correct(word) == word


@pytest.mark.parametrize(
    ("word", "mended"),
    [("pyramind", "pyramid"), ("pirymid", "pyramid"), ("blcok", "block"), ("qube", "cube"), ("cbe", "cbe"),
     ("brick", "brick"), ("zzzzz", "zzzzz")],
)  # fmt: skip
def test_correct(word: str, mended: str) -> None:
    assert Speller([{"pyramid", "block", "cube"}], english={"brick"}).correct(word) == mended


def test_ties_are_left_alone_and_earlier_groups_win() -> None:
    assert Speller([{"cart", "cast"}], english=set()).correct("cakt") == "cakt"
    assert Speller([{"corner"}, {"horner"}], english=set()).correct("korner") == "corner"


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


def test_color_names_are_normal_and_many() -> None:
    assert len(color_names()) > 900
    assert all(normal_color(name) == name for name in color_names())
