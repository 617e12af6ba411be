"""What words for extents measure: wide, long, thin or flat. Nothing of it is learned."""

from __future__ import annotations

import functools
import math
from collections.abc import Callable, Collection
from typing import NamedTuple

from dcg_torch.names.normal_form import read_data
from dcg_torch.types import Object


class Dimension(NamedTuple):
    """What a word measures: the logarithm of a measure of extents, and is more of it meant (1) or less (-1)."""

    measure: Callable[[Collection[float], float], float]
    sign: int


def _footprint(sides: Collection[float], height: float) -> float:
    return math.log(math.prod(sides)) / len(sides)


def _length(sides: Collection[float], height: float) -> float:
    return math.log(max(sides))


def _thickness(sides: Collection[float], height: float) -> float:
    return math.log(min((*sides, height) if height > 0.0 else sides))


def _flatness(sides: Collection[float], height: float) -> float:
    return _footprint(sides, height) - (math.log(height) if height > 0.0 else 0.0)


def _height(sides: Collection[float], height: float) -> float:
    return math.log(height) if height > 0.0 else math.nan


_MEASURES = {
    "footprint": _footprint,
    "length": _length,
    "thickness": _thickness,
    "flatness": _flatness,
    "height": _height,
}


@functools.cache
def dimensions() -> dict[str, Dimension]:
    """Word -> what it measures.

    >>> dimensions()["narrowest"].sign, "biggest" in dimensions()
    (-1, False)
    """
    data = read_data("extents.yaml")
    signs = {"more": 1, "less": -1}
    return {
        word: Dimension(_MEASURES[name], signs[way])
        for name, ways in data.items()
        for way, words in ways.items()
        for word in words
    }


def measure(thing: Object, word: str) -> float | None:
    """How much of what a word says a thing has, as a logarithm; None where its extents are not known."""
    dimension = dimensions()[word]
    sides = [] if thing.size is None else [side for side in thing.size[:2] if side > 0.0]
    return dimension.sign * dimension.measure(sides, thing.size[2]) if sides and thing.size is not None else None
