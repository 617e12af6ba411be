"""Many patterns over one text: rewrites and the first that fits."""

from __future__ import annotations

import pytest

from dcg_torch.english.patterns import FirstOf, Rewrites


@pytest.mark.parametrize(
    ("rows", "text", "rewritten"),
    [
        ([("colou?r", "hue", ["colo"])], "a colour, a color", "a hue, a hue"),
        ([("colour", "hue", ["colo"]), ("hue", "shade", ["hue"])], "colour", "shade"),  # letters that the first made
        ([("colour", "hue", ["colo"]), ("colour", "shade", ["colo"])], "colour", "hue"),  # ... and that it took away
        ([("a", "b", ["zz"])], "a", "a"),  # it is not looked for where its letters are not
        ([(r"\?$", "!", ["?"])], "it?", "it!"),  # one letter, the last
        ([("^$", "nothing", [])], "", "nothing"),
        ([(r"(\w) (\w)", r"\2 \1", [" "])], "a b", "b a"),
        ([("b", lambda match: match.group().upper(), ["c", "b"])], "abc", "aBc"),  # one of its letters is enough
    ],
)
def test_rewrites(rows: list[tuple[str, str, list[str]]], text: str, rewritten: str) -> None:
    assert Rewrites(rows).applied(text) == rewritten


@pytest.mark.parametrize(
    ("offset", "found"),
    [
        (0, ("on top", 0, "")),
        (3, None),  # "top" alone is none of them
        (7, ("facing left", 2, "left")),
        (19, None),  # "ons" is no whole word
        (23, ("on", 3, "")),
    ],
)
def test_the_first_that_fits_whole_words(offset: int, found: tuple[str, int, str] | None) -> None:
    first = FirstOf(["on top", "facing (?P<way>right)", "(?:facing|to) (?P<way>left|right)", "on"])
    assert first.match("on top facing left ons on", offset) == found
