"""How far from a thing another is said to be, or which way: "within a meter of the door", "at your two o'clock"."""

from __future__ import annotations

import functools
import math
import re
from typing import NamedTuple

from dcg_torch.names.normal_form import read_data
from dcg_torch.names.vocabulary import cardinal
from dcg_torch.types import Phrase

_SHARE = 0.3
"""Share of a distance by which "about two metres" may be off."""


_HOURS, _TURNED = 12, re.compile(r"turned (\w+) of")
"""The hours of a clock, and how a parser writes a direction by the hour."""


def said_turn(phrase: Phrase) -> float | None:
    """The angle that "at your two o'clock" states, in radians to the left of straight ahead; None where none is."""
    found = _TURNED.fullmatch(phrase.text)
    if found is None:
        return None
    hour = found[1]
    number = cardinal(hour) or _patterns()[1].get(hour, _HOURS)
    return -2.0 * math.pi * (number % _HOURS) / _HOURS


class Apart(NamedTuple):
    """Distances in metres; `about` is the one that is said, None where only bounds are."""

    least: float
    most: float
    about: float | None = None


@functools.cache
def _patterns() -> tuple[re.Pattern[str], dict[str, float], dict[str, float]]:
    """Of a distance, the numbers that words are, and the metres of units."""
    data = read_data("distances.yaml")
    number = "|".join(sorted(data["numbers"], key=len, reverse=True))
    many = rf"(?:\d+(?: ?[.,] ?\d+)?(?: and a half)?|{number})"
    bound = rf"(?:(?P<most>{data['at_most']})|(?P<least>{data['at_least']})|between (?P<low>{many}) and|[a-z ]+?)"
    unit = "|".join(sorted(data["units"], key=len, reverse=True))
    pattern = re.compile(rf"(?:{bound} )??(?P<many>{many}) (?:of )?(?:an? )?(?P<unit>{unit})\b.*")
    return pattern, data["numbers"], data["units"]


def said_apart(phrase: Phrase) -> Apart | None:
    """The distance that the text of a prepositional phrase states; None where it states none."""
    return _read(phrase.text)


@functools.lru_cache(maxsize=1024)
def _read(text: str) -> Apart | None:
    """
    >>> _read("no more than 2 meters from"), _read("between one and three metres from")
    (Apart(least=0.0, most=2.0, about=None), Apart(least=1.0, most=3.0, about=None))
    >>> _read("about half a meter from").about, _read("next to")
    (0.5, None)
    """
    pattern, numbers, units = _patterns()
    found = pattern.fullmatch(text)
    if found is None:
        return None
    unit = units[found["unit"]]
    far = unit * _number(found["many"], numbers)
    if found["low"] is not None:
        return Apart(unit * _number(found["low"], numbers), far)
    if found["most"] is not None:
        return Apart(0.0, far)
    return (
        Apart(far, float("inf"))
        if found["least"] is not None
        else Apart(far * (1.0 - _SHARE), far * (1.0 + _SHARE), far)
    )


def _number(text: str, numbers: dict[str, float]) -> float:
    whole, half, _ = text.partition(" and a half")
    return (
        float(numbers[text]) if text in numbers else float(whole.replace(" ", "").replace(",", ".")) + 0.5 * bool(half)
    )
