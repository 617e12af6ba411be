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

from dcg_torch.grounding.counting import EVEN, WAYS, behind, start_of_line
from dcg_torch.grounding.encode import WorldEncoder
from dcg_torch.interpretation.dimensions import dimensions, measure
from dcg_torch.names.vocabulary import ORDINALS, cardinal, is_superlative
from dcg_torch.scene.bodies import bulk
from dcg_torch.types import NOT, Object, Phrase

Floats = NDArray[np.float64]
Bools = NDArray[np.bool_]

_EVEN = 0.04
"""Logarithms of measures that differ by less are even."""
_NOT_THE = 6.0
"""Nats that the largest loses where something is called not the largest."""
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
    words = [word for word in phrase.words if word in dimensions() and word not in told]
    counted, taken = _counted_along(phrase, told, among, encoder, anchored), set[str]()
    log = np.zeros(len(among)) if counted is None else counted
    number = next((ORDINALS[word] for word in phrase.words if word in ORDINALS), None)
    in_line = counted is not None and _ALONG.keys().isdisjoint(phrase.words)
    if in_line or (counted is not None and number is not None and "last" in phrase.words):
        # "The second last from the right" is no second from the right, of which weights were learned.
        taken |= {"last", *ORDINALS, *_ALONG, *_number(phrase, told)}
        log *= _COUNTED_ALONE
    for word in words:
        values = np.array([math.nan if (v := measure(o, word)) is None else v for o in encoder.all])
        known = among & np.isfinite(values)
        if known.sum() < 2 or np.ptp(values[known]) <= _EVEN:
            continue
        compared = word.endswith(("er", "est"))
        loss = (
            behind(values[known], number or 1, phrase.count or 1, even=_EVEN) if compared else _by_degree(values[known])
        )
        log[known] -= loss
        log[~known] -= loss.max()
        taken |= {word, *(ORDINALS if compared else ())}
    for word in phrase.words:
        most = word.removeprefix(f"{NOT} ")
        if most != word and most.endswith("est") and (most in dimensions() or most in _BULKY):
            sizes = [measure(o, most) if most in dimensions() else _bulk(o, _BULKY[most]) for o in encoder.all]
            values = np.array([-math.inf if size is None else size for size in sizes])
            log[among & (values >= values[among].max(initial=-math.inf) - _EVEN)] -= _NOT_THE
            taken.add(word)
    kept = tuple(_LIKE.get(w, w) if w in words else w for w in phrase.words if w not in taken)
    return (phrase if kept == phrase.words else replace(phrase, words=kept)), log


_BULKY = {"biggest": 1.0, "largest": 1.0, "smallest": -1.0}
"""Words for what has the most of its whole size, or the least."""


def _bulk(thing: Object, sign: float) -> float | None:
    return None if thing.size is None or not bulk(thing.size) > 0.0 else sign * math.log(bulk(thing.size))


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
    numbers = ((word, cardinal(word)) for word in phrase.words if word not in told)
    return {word: number for word, number in numbers if number is not None}


def _first_in_line(phrase: Phrase, position: Floats, *, picture: bool) -> tuple[float, float] | None:
    """Towards the first of things in a line that are counted from nowhere; None where they stand in no line.

    Args:
        position: (things, 3) of all that are of the kind of what is counted, as who looks sees them.
    """
    if len(position) < _LINE or any(word.startswith("from ") or is_superlative(word) for word in phrase.words):
        return None
    side, wide = start_of_line(position, picture=picture)
    apart = np.diff(np.sort(position[:, :2] @ np.array(WAYS[side]))).min()
    return WAYS[side] if wide < _STRAIGHT and apart > EVEN else None


_LINE, _STRAIGHT = 3, 0.25
"""Things at least that make a line, and how wide it is at most for its length."""
_ALONG = {f"from the {side}": way for side, way in WAYS.items()}
_DEEP = {"from the back", "from the front"}
"""From where things are counted -> the direction of the first; in the depth only in a picture, as up and down."""


def _by_degree(values: Floats) -> Floats:
    off: Floats = (values.max() - values) / np.ptp(values)
    return _BY_DEGREE * off**2
