"""The first few along a line: "the two nearest in the column", "the first three of the row", "the last two cups".

What is learned of ranks tells a single thing from all others. The first few of several are told by their places,
measured among what the rest of a noun phrase describes.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from dcg_torch.grounding.encode import WorldEncoder
from dcg_torch.grounding.hypotheses import ModifierFactor
from dcg_torch.grounding.modifiers import picks_a_side, ranks_from
from dcg_torch.interpretation.plain_words import in_group
from dcg_torch.names.vocabulary import ORDINALS, TOGETHER, is_superlative
from dcg_torch.types import Phrase

Floats = NDArray[np.float64]
Bools = NDArray[np.bool_]

_BY_PLACE = 5.0
"""Nats that a thing loses for each place by which it stays behind the few."""
_EVEN = 0.02
"""Units by which places differ that are no one place."""
_FIRST, _LAST = "first", "last"
_WAYS = {"left": (0.0, 1.0), "right": (0.0, -1.0), "back": (1.0, 0.0), "front": (-1.0, 0.0)}
"""Side -> its direction, as who looks sees it."""
_AWAY = {"closest": -1.0, "farthest": 1.0}
"""Words by which things are ranked from the robot, and whether far or near is first."""


def first_few(
    phrase: Phrase, modifiers: Sequence[ModifierFactor], among: Bools, encoder: WorldEncoder
) -> tuple[Phrase, Floats]:
    """What a noun phrase that counts says of things.

    Args:
        modifiers: of the noun phrase; where one of them ranks as well, the place is left to what is learned.
        among: (things,) what the rest of the phrase describes.

    Returns:
        The phrase without the words that are taken up, and the log-factor of each thing.
    """
    log, count = np.zeros(len(among)), phrase.count or 1
    at = np.flatnonzero(among & encoder.layout.solid & np.isfinite(encoder.layout.position).all(axis=1))
    ranked = in_group(phrase) or any(ranks_from(m.tree) or picks_a_side(m.tree) for m in modifiers)
    if not phrase.plural or count < 2 or len(at) <= count or ranked:
        return phrase, log
    words = [w for w in phrase.words if w in ORDINALS or w == _LAST or is_superlative(w) or w.startswith("from ")]
    values = None if any(w.startswith(TOGETHER) for w in phrase.words) else _places(words, at, encoder)
    if values is None:
        return phrase, log
    ahead = (values[None, :] > values[:, None] + _EVEN).sum(axis=1)
    log[:] = -_BY_PLACE * len(at)
    log[at] = -_BY_PLACE * np.maximum(0, ahead + 1 - count)
    return replace(phrase, words=tuple(word for word in phrase.words if word not in words)), log


def _places(words: Sequence[str], at: NDArray[np.int64], encoder: WorldEncoder) -> Floats | None:
    """(at,) the higher, the earlier along what the words name; None where they name nothing that is measured so."""
    where, told = encoder.layout, {*words}
    position = where.position[at, :2]
    along = None
    if len(told) == 1 and (word := words[0]) in _AWAY:
        along = _AWAY[word] * np.hypot(*(position - where.robot).T)
    elif len(told) == 1 and (side := words[0].removesuffix("most")) in _WAYS:
        along = position @ np.array(_WAYS[side])
    elif len(told & {_FIRST, _LAST}) == 1:
        ends = told - {_FIRST, _LAST}
        across, deep = np.ptp(position[:, 1]), np.ptp(position[:, 0])
        start = "left" if across >= deep else "back" if where.picture else "front"
        side = "".join(ends).removeprefix("from the ") if len(ends) == 1 else start
        along = position @ np.array(_WAYS[side]) if len(ends) < 2 and side in _WAYS else None
        if along is not None and _LAST in told:
            along = -along
    return along
