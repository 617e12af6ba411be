"""What the words of a noun phrase say of extents among what the rest of it describes, and what it counts there.

Extents say how wide, long, thin or flat things are: "the widest box", "the second thinnest of the books". Nothing of it
is learned.
"""

from __future__ import annotations

import math
from collections.abc import Collection
from dataclasses import replace

import numpy as np

from dcg_torch.grounding.counting import behind
from dcg_torch.grounding.encoding import WorldEncoder
from dcg_torch.grounding.line_counts import counted_on_line
from dcg_torch.interpretation.dimensions import dimensions, measure
from dcg_torch.names.vocabulary import ORDINALS
from dcg_torch.scene.bodies import bulk
from dcg_torch.types import NOT, Object, Phrase
from dcg_torch.types.arrays import Bools, Floats

_EVEN = 0.04
"""Logarithms of measures that differ by less are even."""
_NOT_THE = 6.0
"""Nats that the largest loses where something is called not the largest."""
_BY_DEGREE = 5.0
"""Nats that the narrowest loses where a thing is called wide; less by the square of how far it is from the widest."""
_LIKE = {"wider": "largest", "widest": "largest"}
"""What is said much like a word, where no extents are known: of groups."""
_BULKY = {"biggest": 1.0, "largest": 1.0, "smallest": -1.0}
"""Words for what has the most of its whole size, or the least."""


def of_extents(
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
    counted, log = counted_on_line(phrase, told, among, encoder, anchored=anchored)
    compared, of_extents = _by_extents(phrase, words, among, encoder)
    denied, of_denied = _not_the_most(phrase.words, among, encoder)
    taken = counted | compared | denied
    kept = tuple(_LIKE.get(w, w) if w in words else w for w in phrase.words if w not in taken)
    return (phrase if kept == phrase.words else replace(phrase, words=kept)), log + of_extents + of_denied


def _by_extents(phrase: Phrase, words: Collection[str], among: Bools, encoder: WorldEncoder) -> tuple[set[str], Floats]:
    """Those of some words that measure extents by which things differ, and the log-factor of each thing."""
    taken, log = set[str](), np.zeros(len(among))
    place = next((ORDINALS[word] for word in phrase.words if word in ORDINALS), 1), phrase.count or 1
    for word in words:
        values = np.array([math.nan if (v := _measure(o, word)) is None else v for o in encoder.all])
        compared = among & ~encoder.layout.place & encoder.perceived
        known = compared & np.isfinite(values)
        some = word in _BULKY and bool((compared & ~known).any())  # weights were learned for what has no extents
        if some or known.sum() < 2 or np.ptp(values[known]) <= _EVEN:
            continue
        ranked = word.endswith(("er", "est"))
        loss = behind(values[known], *place, even=_EVEN) if ranked else _by_degree(values[known])
        log[known] -= loss
        log[~known] -= 0.0 if word in _BULKY else loss.max()  # what is large is often said of more than one kind
        taken |= {word, *(ORDINALS if ranked else ())}
    return taken, log


def _by_degree(values: Floats) -> Floats:
    off: Floats = (values.max() - values) / np.ptp(values)
    return _BY_DEGREE * off**2


def _not_the_most(words: Collection[str], among: Bools, encoder: WorldEncoder) -> tuple[set[str], Floats]:
    """Those of some words that deny an end, "not the widest", and the log-factor of each thing."""
    taken, log = set[str](), np.zeros(len(among))
    for word in words:
        most = word.removeprefix(f"{NOT} ")
        if most != word and most.endswith("est") and (most in dimensions() or most in _BULKY):
            values = np.array([-math.inf if (v := _measure(o, most)) is None else v for o in encoder.all])
            log[among & (values >= values[among].max(initial=-math.inf) - _EVEN)] -= _NOT_THE
            taken.add(word)
    return taken, log


def _measure(thing: Object, word: str) -> float | None:
    """How much a thing has of what a word says; None where its size is unknown."""
    if word not in _BULKY:
        return measure(thing, word)
    return None if thing.size is None or not bulk(thing.size) > 0.0 else _BULKY[word] * math.log(bulk(thing.size))
