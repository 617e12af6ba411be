"""What a noun phrase measures or counts among what the rest of it describes. Nothing of it is learned.

Extents say how wide, long, thin or flat things are: "the widest box", "the second thinnest of the books". Places say
which is the second, or the second last, from a side.
"""

from __future__ import annotations

import math
from collections.abc import Collection
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from dcg_torch.grounding.encode import WorldEncoder
from dcg_torch.interpretation.dimensions import dimensions, measure
from dcg_torch.names.vocabulary import NUMBER_WORDS, ORDINALS, is_superlative
from dcg_torch.scene.bodies import bulk
from dcg_torch.types import NOT, Object, Phrase

Floats = NDArray[np.float64]
Bools = NDArray[np.bool_]

_EVEN = 0.04
"""Logarithms of measures that differ by less are even."""
_BY_PLACE = 3.0
"""Nats for each place by which a thing stays behind "the second widest"."""
_COUNTED_ALONE = 2.0
"""So many times more where no words of the phrase are left that say the same."""
_BY_DEGREE = 5.0
"""Nats that the narrowest loses where a thing is called wide; less by the square of how far it is from the widest."""
_LIKE = {"wider": "largest", "widest": "largest"}
"""What is said much like a word, where no extents are known: of groups."""


def measured(
    phrase: Phrase, told: Collection[str], among: Bools, encoder: WorldEncoder, *, anchored: bool = False
) -> tuple[Phrase, Floats]:
    """What the words of a noun phrase that measure or count things say of each.

    Args:
        told: words that attributes answer.
        among: (things,) what the rest of the phrase describes.
        anchored: may a landmark say from where it counts, "the first drawer left of the stove"?

    Returns:
        The phrase without the words that are taken up, and the log-factor of each thing.
    """
    words = [word for word in phrase.words if (word in dimensions() or word in _BULKY) and word not in told]
    counted, taken = _counted_along(phrase, told, among, encoder, anchored), set[str]()
    log = np.zeros(len(among)) if counted is None else counted
    number = next((ORDINALS[word] for word in phrase.words if word in ORDINALS), None)
    in_line = counted is not None and _ALONG.keys().isdisjoint(phrase.words)
    if in_line or (counted is not None and number is not None and "last" in phrase.words):
        # "The second last from the right" is no second from the right, of which weights were learned.
        taken |= {"last", *ORDINALS, *_ALONG, *_number(phrase, told)}
        log *= _COUNTED_ALONE
    for word in words:
        values = np.array([math.nan if (v := _measure(o, word)) is None else v for o in encoder.all])
        compared = among & ~encoder.layout.place & encoder.perceived
        known = compared & np.isfinite(values)
        some = word in _BULKY and bool((compared & ~known).any())  # weights were learned for what has no extents
        if some or known.sum() < 2 or np.ptp(values[known]) <= _EVEN:
            continue
        ranked = word.endswith(("er", "est"))
        loss = behind(values[known], number or 1, phrase.count or 1) if ranked else _by_degree(values[known])
        log[known] -= loss
        log[~known] -= 0.0 if word in _BULKY else loss.max()  # what is large is often said of more than one kind
        taken |= {word, *(ORDINALS if ranked else ())}
    for word in phrase.words:
        most = word.removeprefix(f"{NOT} ")
        if most != word and most.endswith("est") and (most in dimensions() or most in _BULKY):
            values = np.array([-math.inf if (v := _measure(o, most)) is None else v for o in encoder.all])
            log[among & (values >= values[among].max(initial=-math.inf) - _EVEN)] -= 2.0 * _BY_PLACE
            taken.add(word)
    kept = tuple(_LIKE.get(w, w) if w in words else w for w in phrase.words if w not in taken)
    return (phrase if kept == phrase.words else replace(phrase, words=kept)), log


_BULKY = {"biggest": 1.0, "largest": 1.0, "smallest": -1.0}
"""Words for what has the most of its whole size, or the least."""


def _measure(thing: Object, word: str) -> float | None:
    """How much a thing has of what a word says; None where its size is unknown."""
    if word not in _BULKY:
        return measure(thing, word)
    return None if thing.size is None or not bulk(thing.size) > 0.0 else _BULKY[word] * math.log(bulk(thing.size))


def _counted_along(
    phrase: Phrase, told: Collection[str], among: Bools, encoder: WorldEncoder, anchored: bool
) -> Floats | None:
    """(things,) log-factor of "the second (to last) from the left", by the place among what the rest describes.

    None where nothing is counted so, and in a group, which counts its own.
    """
    where, last = encoder.layout, "last" in phrase.words
    numbers = [ORDINALS[word] for word in phrase.words if word in ORDINALS] or [1] * last
    sides = [_ALONG[word] for word in phrase.words if word in _ALONG and (where.picture or word not in _DEEP)]
    called = {} if numbers else _number(phrase, told)
    if not (numbers or called):
        return None
    there = where.solid & np.isfinite(where.position).all(axis=1)
    at = np.flatnonzero(among & there)
    kind = there & np.isin(encoder.type_number, encoder.type_number[at])
    first = None if sides or anchored else _first_in_line(phrase, where.position[kind], picture=where.picture)
    sides = sides if first is None else [first]
    numbers = numbers if first is None else numbers or list(called.values())
    if not len(numbers) == len(sides) == 1 or len(at) < numbers[0] or (phrase.among == "row" and first is None):
        return None
    along = where.position[at, :2] @ np.array(sides[0])
    lost = behind(-along if last else along, numbers[0], phrase.count or 1)
    log = np.full(len(among), 0.0 if first is None else -lost.max())  # no place is the first of a line
    log[at] = -lost
    return log


def _number(phrase: Phrase, told: Collection[str]) -> dict[str, int]:
    """The number that one thing is called by, if no attribute answers it: "door 3", "lane two"."""
    if phrase.plural or phrase.count is not None:
        return {}
    numbers = {w: int(w) if w.isdecimal() else NUMBER_WORDS.get(w, 0) for w in phrase.words if w not in told}
    return {word: number for word, number in numbers.items() if number > 0}


def _first_in_line(phrase: Phrase, position: Floats, *, picture: bool) -> tuple[float, float] | None:
    """Towards the first of things in a line that are counted from nowhere; None where they stand in no line.

    A queue begins at its near end, a column of a picture at its top. What stands side by side is read from the left.

    Args:
        position: (things, 3) of all that are of the kind of what is counted, as who looks sees them.
    """
    if len(position) < _LINE or any(word.startswith("from ") or is_superlative(word) for word in phrase.words):
        return None
    for axis, first in ((0, _TOP_FIRST if picture else _NEAR_FIRST), (1, _LEFT_FIRST)):
        along, across = position[:, axis], position[:, 1 - axis]
        if np.ptp(across) < _STRAIGHT * np.ptp(along) and np.diff(np.sort(along)).min() > _EVEN:
            return first
    return None


_LINE, _STRAIGHT = 3, 0.25
"""Things at least that make a line, and how wide it is at most for its length."""
_NEAR_FIRST, _TOP_FIRST, _LEFT_FIRST = (-1.0, 0.0), (1.0, 0.0), (0.0, 1.0)
_DEEP = {"from the back": (1.0, 0.0), "from the front": (-1.0, 0.0)}
_ALONG = {"from the left": (0.0, 1.0), "from the right": (0.0, -1.0), **_DEEP}
"""From where things are counted -> the direction of the first, as who looks sees it; up and down in a picture."""


def behind(values: Floats, number: int, count: int, *, even: float = _EVEN, nats: float = _BY_PLACE) -> Floats:
    """What is lost by the places from the most: the first `count` of them, or the one with a number, lose nothing.

    Args:
        even: values that differ by less are of one place.
        nats: lost for each place.
    """
    ahead: Floats = (values[None, :] > values[:, None] + even).sum(axis=1).astype(np.float64)
    return nats * (np.abs(ahead + 1 - number) if number > 1 else np.maximum(0.0, ahead + 1 - count))


def _by_degree(values: Floats) -> Floats:
    off: Floats = (values.max() - values) / np.ptp(values)
    return _BY_DEGREE * off**2
