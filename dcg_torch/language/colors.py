"""Colour words: an open vocabulary built from the CSS4 and XKCD names that matplotlib ships.

`match_color` reads the longest colour at a place in a list of words. A compound is one colour when a shade word or a
word that is no basic colour leads it ("dark blue", "sky blue"); two basic colours side by side ("blue green tower")
are two colours of one thing.
"""

from __future__ import annotations

import functools
from collections.abc import Sequence

from matplotlib.colors import CSS4_COLORS, XKCD_COLORS

from dcg_torch.language.lexicon import word_set

BASIC = word_set(
    """
    black blue brown cyan gold gray green magenta orange pink purple red silver turquoise violet white yellow
    """
)
SHADES = word_set(
    """
    bright dark darker deep dull faded light lighter medium mid neon pale pastel soft vivid
    """
)

# Listed as colours by CSS4 or XKCD, but people mean the thing or the property when they say the word alone.
_THINGS = word_set(
    """
    adobe algae apple apricot aqua_marine asparagus avocado banana barney bland blood bluegrey booger brick
    bruise burlywood bush butter butterscotch cadetblue camel cement chocolate clay cloud custard dandelion
    darkness desert dirt dust earth eggplant egg evergreen flat fire grape grass greenapple ice jungle kiwi leaf
    leather lemon lichen linen marine melon mint moss mud mushroom mustard oldlace papayawhip pea peach pear
    peru petrol pig pine plum poison poo poop puke pumpkin rain raspberry reef robin rose rouge saddlebrown sand
    seashell sea sepia shamrock shit sick sky slate snot snow spruce squash stone straw strawberry sunflower
    swamp tomato toupe twilight vomit warm water watermelon wheat wine wood
    """
)
_SPELLINGS = {"grey": "gray", "greyish": "grayish", "golden": "gold", "silvery": "silver", "gray": "gray"}
PLURALS = {f"{color}s": color for color in BASIC}
FILLERS = frozenset({"colored", "coloured", "color", "colour"})


def normal_color(name: str) -> str:
    """The normal form of a colour name: lower case, one space between words, American "gray".

    >>> normal_color("Light Grey")
    'light gray'
    """
    return " ".join(_SPELLINGS.get(word, word) for word in name.lower().replace("-", " ").split())


@functools.cache
def color_names() -> frozenset[str]:
    """Every colour name in normal form, of one word or several."""
    listed = {name.removeprefix("xkcd:").replace("/", " ").replace("'", "") for name in XKCD_COLORS} | set(CSS4_COLORS)
    names = {normal_color(name) for name in listed}
    return frozenset(name for name in names if name not in _THINGS) | BASIC


@functools.cache
def single_colors() -> frozenset[str]:
    """The colour names of one word."""
    return frozenset(name for name in color_names() if " " not in name and name not in SHADES)


def match_color(words: Sequence[str], start: int) -> tuple[str, int] | None:
    """The colour that begins at `words[start]` and the index behind it, or None.

    "dark sky blue" is one colour; a closing "coloured" belongs to the colour.
    """
    stop = start
    while stop < len(words) and words[stop] in SHADES:
        stop += 1
    shades = stop - start
    if stop >= len(words):
        return None
    end = 0
    for length in (3, 2):
        part = [_SPELLINGS.get(word, word) for word in words[stop : stop + length]]
        if (
            len(part) == length
            and part[0] not in BASIC
            and part[-1] in single_colors()
            and " ".join(part) in color_names()
        ):
            end = stop + length
            break
    if not end and normal_color(words[stop]) in single_colors():
        end = stop + 1
    if not end:
        return None
    name = normal_color(" ".join(words[stop - shades : end]))
    if end < len(words) and words[end] in FILLERS:
        end += 1
    return name, end
