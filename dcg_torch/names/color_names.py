"""What the name of an object's colour says about a colour word: named facts, to be weighed elsewhere."""

from __future__ import annotations

import functools
from typing import Final

import numpy as np

from dcg_torch.names.normal_form import normalise
from dcg_torch.names.palette import color_words, region

COLOR_FACTS: Final = (
    "color: equal",  # "grey" said of "gray"
    "color: same hue",  # "light blue" said of "blue"
    "color: alike",  # "turquoise" said of "cyan"
    "color: near",  # "orange" said of "red"
    "color: shades apart",  # "dark blue" said of "light blue"
    "color: far",
    "color: strange",  # nothing tells where one of them is
)
_ALIKE, _NEAR = 22.0, 45.0  # distances in the space of `palette`


@functools.lru_cache(maxsize=16384)
def color_evidence(word: str, name: str) -> tuple[str, ...]:
    """The fact that holds between a colour word and the name that a recogniser gives a colour: one of `COLOR_FACTS`.

    >>> color_evidence("Grey", "gray"), color_evidence("light blue", "blue"), color_evidence("cyan", "turquoise")
    (('color: equal',), ('color: same hue',), ('color: alike',))
    """
    if normalise(word) == normalise(name):
        return ("color: equal",)
    said, named = _color_name(word), _color_name(name)
    if said == named or frozenset((said, named)) in color_words().exchanged:
        return ("color: alike",)
    shades = [_shade(one) for one in (said, named)]
    if said.split(" ")[-1] == named.split(" ")[-1]:
        return ("color: shades apart",) if shades[0] * shades[1] < 0.0 else ("color: same hue",)
    one, other = _region_of(said), _region_of(named)
    if one is None or other is None:
        return ("color: strange",)
    apart = float(np.linalg.norm(np.array(one) - np.array(other)))
    return ("color: alike" if apart < _ALIKE else "color: near" if apart < _NEAR else "color: far",)


def _color_name(name: str) -> str:
    alike = color_words().alike
    return " ".join(alike.get(word, word) for word in normalise(name).split(" ") if word not in ("color", "colored"))


def _shade(name: str) -> float:
    """Is a colour a light one (above 0) or a dark one of its hue?"""
    axes = color_words().axes
    return sum(axes.get(word, {}).get("lightness", 0.0) for word in name.split(" ")[:-1])


def _region_of(name: str) -> tuple[float, float, float] | None:
    first, _, rest = name.partition(" ")
    hue = region(name.split(" ")[-1])
    # "Very dark gray" is farther from gray than "dark gray".
    if first in _VERY and hue is not None and (shade := region(rest)) is not None:
        one, two, three = np.array(shade.mean) + _FARTHER * (np.array(shade.mean) - np.array(hue.mean))
        return float(one), float(two), float(three)
    found = region(name) or hue
    return None if found is None else found.mean


_VERY, _FARTHER = frozenset({"very", "extremely", "really"}), 0.6
"""Words that make a shade more so, and by which share of its way from the hue."""
