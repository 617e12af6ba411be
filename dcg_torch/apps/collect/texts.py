"""What people write: tidied, compared, and refused where it is empty or copied."""

from __future__ import annotations

import re
import unicodedata
from collections.abc import Collection

EXAMPLE = "Drive over to the white piano."
LONGEST = 300  # characters
_FEWEST_WORDS = 2
_MARKS = re.compile(r"\b(highlighted|yellow ring|ring and arrow|under the arrow)\b")
_WORD = re.compile(r"[^\W_]+(?:['\u2019][^\W_]+)?")


def tidy(text: str) -> str:
    """The text in one line, without control characters and doubled spaces."""
    plain = "".join(" " if unicodedata.category(c)[0] in "CZ" else c for c in unicodedata.normalize("NFC", text))
    return " ".join(plain.split())


def normal(text: str) -> str:
    """What two texts have in common that differ in case, stops and spaces alone."""
    return " ".join(_WORD.findall(unicodedata.normalize("NFKC", text).casefold()))


def empty(text: str) -> str | None:
    """Why a text is no command, for the one who wrote it; None if it may be one."""
    words = normal(text).split()
    if not any(c.isalpha() for c in text):
        return "The box is empty. Please write a command."
    if len(words) < _FEWEST_WORDS:
        return "This is one word. Please write a whole command."
    if len(text) > LONGEST:
        return f"This is too long. Please write at most {LONGEST} characters."
    return None


def copied(text: str, earlier: Collection[str] = ()) -> str | None:
    """Why a text is nobody's own words, for the one who wrote it; None if it may be.

    Args:
        text: what was written.
        earlier: `normal` texts of the same person.
    """
    if normal(text) == normal(EXAMPLE):
        return "This is the example. Please write about the object in this picture, in your own words."
    if _MARKS.search(normal(text)):
        return "The robot does not see the marks in the picture. Please say what the object is."
    if normal(text) in earlier:
        return "You wrote this for an earlier picture. Please use other words this time."
    return None
