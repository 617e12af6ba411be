"""Colour words: an open vocabulary, the CSS4 and XKCD names of `data/colors.txt`.

`match_color` reads the longest colour at a place in a list of words. A compound is one colour when a shade word or a
word that is no basic colour leads it ("dark blue", "sky blue"); two basic colours side by side ("blue green tower")
are two colours of one thing.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Final

from dcg_torch.english.dictionary import lines
from dcg_torch.language.lexicon import COLOR_SPELLINGS, SETS

_LONGEST = 3  # words of a colour's name beside its shades


def normal_color(name: str) -> str:
    """The normal form of a colour name: lower case, one space between words, American "gray".

    >>> normal_color("Light Grey")
    'light gray'
    """
    return " ".join(COLOR_SPELLINGS.get(word, word) for word in name.lower().replace("-", " ").split())


COLOR_NAMES: Final = frozenset(lines("colors.txt", __package__)) - SETS["color_things"] | SETS["basic_colors"]
"""Every colour name in normal form, of one word or several."""
SINGLE_COLORS: Final = frozenset(name for name in COLOR_NAMES if " " not in name) - SETS["shades"]
"""The colour names of one word."""
_LAST: Final = SINGLE_COLORS | COLOR_SPELLINGS.keys()
"""Words that can end the name of a colour."""


def match_color(words: Sequence[str], start: int) -> tuple[str, int] | None:
    """The colour that begins at `words[start]` and the index behind it, or None.

    "dark sky blue" is one colour; a closing "coloured" belongs to the colour.
    """
    stop = next((i for i in range(start, len(words)) if words[i] not in SETS["shades"]), len(words))
    for end in (k + 1 for k in range(min(stop + _LONGEST, len(words)) - 1, stop - 1, -1) if words[k] in _LAST):
        parts = normal_color(" ".join(words[stop:end])).split(" ")
        one = len(parts) == 1 or parts[0] not in SETS["basic_colors"]
        if one and parts[-1] in SINGLE_COLORS and " ".join(parts) in COLOR_NAMES:
            name = normal_color(" ".join(words[start:end]))
            return name, end + (end < len(words) and words[end] in SETS["color_fillers"])
    return None
