"""What an ordinal or a number counts along a line: "the second last from the right", "the third jar", "door 3".

Nothing of it is learned but what "second from the left" says by itself. A group counts its own.
"""

from __future__ import annotations

from collections.abc import Collection

import numpy as np

from dcg_torch.grounding.counting import EVEN, WAYS, behind, start_of_line
from dcg_torch.grounding.encoding import WorldEncoder
from dcg_torch.names.vocabulary import ORDINALS, cardinal, is_superlative
from dcg_torch.types import Phrase
from dcg_torch.types.arrays import Bools, Floats

_LAST = "last"
_ALONE = 2.0
"""So many times more where no words of the phrase are left that say the same."""
_LINE, _STRAIGHT = 3, 0.25
"""Things at least that make a line, and how wide it is at most for its length."""
_ALONG = {f"from the {side}": way for side, way in WAYS.items()}
_DEEP = {"from the back", "from the front"}
"""From where things are counted -> the direction of the first; in the depth only in a picture, as up and down."""


def counted_on_line(
    phrase: Phrase, told: Collection[str], among: Bools, encoder: WorldEncoder, *, anchored: bool
) -> tuple[frozenset[str], Floats]:
    """What a noun phrase counts among what the rest of it describes.

    Args:
        told: words that attributes answer.
        among: (things,) what the rest of the phrase describes.
        anchored: may a landmark say from where it counts, "the first drawer left of the stove"?

    Returns:
        The words that are taken up by it, and the log-factor of each thing.
    """
    log = _by_place(phrase, told, among, encoder, anchored)
    if log is None:
        return frozenset(), np.zeros(len(among))
    in_line = _ALONG.keys().isdisjoint(phrase.words)
    if not in_line and (_LAST not in phrase.words or ORDINALS.keys().isdisjoint(phrase.words)):
        return frozenset(), log
    # "The second last from the right" is no second from the right, of which weights were learned.
    return frozenset({_LAST, *ORDINALS, *_ALONG, *_number(phrase, told)}), _ALONE * log


def _by_place(
    phrase: Phrase, told: Collection[str], among: Bools, encoder: WorldEncoder, anchored: bool
) -> Floats | None:
    """(things,) log-factor by the place among what the rest describes; None where nothing is counted so."""
    where, last = encoder.layout, _LAST in phrase.words
    numbers = [ORDINALS[word] for word in phrase.words if word in ORDINALS] or [1] * last
    sides = [_ALONG[word] for word in phrase.words if word in _ALONG and (where.picture or word not in _DEEP)]
    called = {} if numbers else _number(phrase, told)
    if not (numbers or called):
        return None
    there = where.solid & np.isfinite(where.position).all(axis=1)
    at = np.flatnonzero(among & there)
    kind = there & (np.bincount(encoder.type_number[at], minlength=len(among))[encoder.type_number] > 0)
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
