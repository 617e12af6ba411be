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
from dcg_torch.names.vocabulary import ORDINALS, is_superlative
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
    phrase: Phrase, told: Collection[str], among: Bools, encoder: WorldEncoder, *, placed: bool = False
) -> tuple[Phrase, Floats]:
    """What the words of a noun phrase that measure or count things say of each.

    Args:
        told: words that attributes answer.
        among: (things,) what the rest of the phrase describes.
        placed: is it said where these are? Then they are vaguely told, and may be a part of a row.

    Returns:
        The phrase without the words that are taken up, and the log-factor of each thing.
    """
    words = [word for word in phrase.words if word in dimensions() and word not in told]
    counted, taken = _counted_along(phrase, among, encoder, placed=placed), set[str]()
    log = np.zeros(len(among)) if counted is None else counted
    number = next((ORDINALS[word] for word in phrase.words if word in ORDINALS), None)
    queue = counted is not None and _ALONG.keys().isdisjoint(phrase.words)
    if queue or (counted is not None and number is not None and "last" in phrase.words):
        # "The second last from the right" is no second from the right, of which weights were learned.
        taken |= {"last", *ORDINALS, *_ALONG}
        log *= _COUNTED_ALONE
    for word in words:
        values = np.array([math.nan if (v := measure(o, word)) is None else v for o in encoder.all])
        known = among & np.isfinite(values)
        if known.sum() < 2 or np.ptp(values[known]) <= _EVEN:
            continue
        compared = word.endswith(("er", "est"))
        loss = _behind(values[known], number or 1, phrase.count or 1) if compared else _by_degree(values[known])
        log[known] -= loss
        log[~known] -= loss.max()
        taken |= {word, *(ORDINALS if compared else ())}
    for word in phrase.words:
        most = word.removeprefix(f"{NOT} ")
        if most != word and most.endswith("est") and (most in dimensions() or most in _BULKY):
            sizes = [measure(o, most) if most in dimensions() else _bulk(o, _BULKY[most]) for o in encoder.all]
            values = np.array([-math.inf if size is None else size for size in sizes])
            log[among & (values >= values[among].max(initial=-math.inf) - _EVEN)] -= 2.0 * _BY_PLACE
            taken.add(word)
    kept = tuple(_LIKE.get(w, w) if w in words else w for w in phrase.words if w not in taken)
    return (phrase if kept == phrase.words else replace(phrase, words=kept)), log


_BULKY = {"biggest": 1.0, "largest": 1.0, "smallest": -1.0}
"""Words for what has the most of its whole size, or the least."""


def _bulk(thing: Object, sign: float) -> float | None:
    return None if thing.size is None or not bulk(thing.size) > 0.0 else sign * math.log(bulk(thing.size))


def _counted_along(phrase: Phrase, among: Bools, encoder: WorldEncoder, *, placed: bool) -> Floats | None:
    """(things,) log-factor of "the second (to last) from the left", by the place among what the rest describes.

    None where nothing is counted so, and in a group, which counts its own.
    """
    where, last = encoder.layout, "last" in phrase.words
    numbers = [ORDINALS[word] for word in phrase.words if word in ORDINALS] or [1] * last
    sides = [_ALONG[word] for word in phrase.words if word in _ALONG and (where.picture or word not in _DEEP)]
    at = np.flatnonzero(among & where.solid & np.isfinite(where.position).all(axis=1))
    line = None if sides or where.picture else _line_from(phrase, where.position[at], across=not placed)
    queue = line is not None
    sides = sides if line is None else [line]
    if not len(numbers) == len(sides) == 1 or len(at) < numbers[0] or (phrase.among == "row" and not queue):
        return None
    first = where.position[at, :2] @ np.array(sides[0])
    lost = _behind(-first if last else first, numbers[0], phrase.count or 1)
    log = np.full(len(among), -lost.max() if queue else 0.0)
    log[at] = -lost
    return log


def _line_from(phrase: Phrase, position: Floats, *, across: bool) -> tuple[float, float] | None:
    """The direction of the first of things that stand in a line, as who looks sees it: near, or left.

    Args:
        position: (things, 3) of what is counted, from nowhere in particular; None where they stand in no line.
        across: may the line be one from left to right?
    """
    if len(position) < _QUEUE or any(word.startswith("from ") or is_superlative(word) for word in phrase.words):
        return None
    deep, wide, _ = position.T
    for along, aside, first in ((deep, wide, (-1.0, 0.0)), (wide, deep, (0.0, 1.0)))[: 1 + across]:
        if np.ptp(aside) < _STRAIGHT * np.ptp(along) and np.diff(np.sort(along)).min() > _EVEN:
            return first
    return None


_QUEUE, _STRAIGHT = 3, 0.25
"""Things at least that make a line, and how wide it is at most for its length."""
_DEEP = {"from the back": (1.0, 0.0), "from the front": (-1.0, 0.0)}
_ALONG = {"from the left": (0.0, 1.0), "from the right": (0.0, -1.0), **_DEEP}
"""From where things are counted -> the direction of the first, as who looks sees it; up and down in a picture."""


def _behind(values: Floats, number: int, count: int) -> Floats:
    """What is lost by the places from the most: the first `count` of them, or the one with a number, lose nothing."""
    ahead: Floats = (values[None, :] > values[:, None] + _EVEN).sum(axis=1).astype(np.float64)
    return _BY_PLACE * (np.abs(ahead + 1 - number) if number > 1 else np.maximum(0.0, ahead + 1 - count))


def _by_degree(values: Floats) -> Floats:
    off: Floats = (values.max() - values) / np.ptp(values)
    return _BY_DEGREE * off**2
