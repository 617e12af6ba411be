"""The first few along a line: "the two nearest in the column", "the first three of the row", "the last two cups".

What is learned of ranks tells a single thing from all others. The first few of several are told by their places,
measured among what the rest of a noun phrase describes.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from dcg_torch.grounding.counting import WAYS, behind, start_of_line
from dcg_torch.grounding.encoding import WorldEncoder
from dcg_torch.grounding.hypotheses import ModifierFactor
from dcg_torch.grounding.modifiers import picks_a_side, ranks_from
from dcg_torch.interpretation.plain_words import in_group
from dcg_torch.names.vocabulary import FARTHEST, NEAREST, ORDINALS, TOGETHER, is_superlative
from dcg_torch.types import Phrase
from dcg_torch.types.arrays import Bools, Floats, Ints

_BY_PLACE = 5.0
"""Nats that a thing loses for each place by which it stays behind the few."""
_FIRST, _LAST = "first", "last"
_ALIKE = math.log(0.5)
"""Of a thing that is described about as well as the best."""
_FROM_A_THING = {NEAREST: -1.0, FARTHEST: 1.0}
"""Relations by which things are ranked from a landmark, and whether far or near is first."""
_AWAY = {"closest": -1.0, "farthest": 1.0}
"""Words by which things are ranked from the robot, and whether far or near is first."""


def first_few(
    phrase: Phrase, modifiers: Sequence[ModifierFactor], described: tuple[Bools, Floats], encoder: WorldEncoder
) -> tuple[Phrase, Floats]:
    """What a noun phrase that counts says of things.

    Args:
        modifiers: of the noun phrase; the one that ranks from a landmark is measured in the place of what is learned.
        described: (things,) what the rest of the phrase describes, and the log-factor of how well it does.

    Returns:
        The phrase without the words that are taken up, and the log-factor of each thing.
    """
    (among, fit), count = described, phrase.count or 1
    log, ranked = np.zeros(len(among)), [m for m in modifiers if ranks_from(m.tree)]
    own = in_group(phrase) or len(ranked) > 1 or any(picks_a_side(m.tree) for m in modifiers)
    if not phrase.plural or count < 2 or own or any(w.startswith(TOGETHER) for w in phrase.words):
        return phrase, log
    words = [w for w in phrase.words if w in ORDINALS or w == _LAST or is_superlative(w) or w.startswith("from ")]
    if ranked and (words or ranked[0].tree.phrase.words[0] not in _FROM_A_THING):
        return phrase, log
    if ranked:
        fit = fit - ranked[0].log_psi
        among = (fit >= fit.max() + _ALIKE) & encoder.perceived
    at = np.flatnonzero(among & encoder.layout.solid & np.isfinite(encoder.layout.position).all(axis=1))
    if len(at) <= count:
        return phrase, log
    values = _away(ranked[0], at, encoder) if ranked else _places(words, at, encoder)
    if values is None:
        return phrase, log
    log[:] = -_BY_PLACE * len(at)
    log[at] = -behind(values, 1, count, nats=_BY_PLACE)
    if ranked:
        log[at] -= ranked[0].log_psi[at]  # it is measured, and not said twice
    return replace(phrase, words=tuple(word for word in phrase.words if word not in words)), log


def _away(ranked: ModifierFactor, at: Ints, encoder: WorldEncoder) -> Floats | None:
    """(at,) the higher, the earlier from the likeliest landmark of a modifier; None where that is nowhere."""
    position = encoder.layout.position[:, :2]
    landmark = ranked.combos.things[int(ranked.log_prior.argmax())][0]
    away: Floats = _FROM_A_THING[ranked.tree.phrase.words[0]] * np.hypot(*(position[at] - position[landmark]).T)
    return away if len(ranked.combos.beams) == 1 and np.isfinite(away).all() else None


def _places(words: Sequence[str], at: Ints, encoder: WorldEncoder) -> Floats | None:
    """(at,) the higher, the earlier along what the words name; None where they name nothing that is measured so."""
    where, told = encoder.layout, {*words}
    position = where.position[at, :2]
    along = None
    if len(told) == 1 and (word := words[0]) in _AWAY:
        along = _AWAY[word] * np.hypot(*(position - where.robot).T)
    elif len(told) == 1 and (side := words[0].removesuffix("most")) in WAYS:
        along = position @ np.array(WAYS[side])
    elif len(told & {_FIRST, _LAST}) == 1:
        ends = told - {_FIRST, _LAST}
        start, _ = start_of_line(position, picture=where.picture)
        side = "".join(ends).removeprefix("from the ") if len(ends) == 1 else start
        along = position @ np.array(WAYS[side]) if len(ends) < 2 and side in WAYS else None
        if along is not None and _LAST in told:
            along = -along
    return along
