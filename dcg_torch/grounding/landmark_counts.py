"""What an ordinal counts away from a landmark: "the second cabinet to the left of the stove", "the last tree behind".

What is learned of a side says how likely a single thing there is meant: the nearest above all. The second is measured.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from dcg_torch.grounding.counting import behind
from dcg_torch.grounding.encoding import WorldEncoder
from dcg_torch.grounding.hypotheses import ModifierFactor
from dcg_torch.grounding.measured_relations import ON_A_SIDE
from dcg_torch.interpretation.plain_words import COUNTED_FROM
from dcg_torch.names.relations import listed
from dcg_torch.names.vocabulary import ORDINALS, is_superlative
from dcg_torch.types import Phrase
from dcg_torch.types.arrays import Floats

_ALIKE = 0.7
"""Nats by which what is counted may be described less well than the best, apart from where it is."""
_TWICE = 2.0
"""The place counts against what is learned of the side as well."""
_AMONG = listed("counted among")


def is_anchored(modifiers: Sequence[ModifierFactor]) -> bool:
    """May a landmark say from where things are counted?"""
    return any(m.tree.phrase.words[0] not in _AMONG for m in modifiers)


def counted_from_landmark(
    phrase: Phrase, modifiers: Sequence[ModifierFactor], fit: Floats, encoder: WorldEncoder
) -> tuple[Phrase, Floats]:
    """What the ordinal of a noun phrase says of things on a side of one landmark.

    Args:
        modifiers: those of the phrase.
        fit: (things,) log-factor of all but the ranks; -inf of what is not there.

    Returns:
        The phrase without the words that are taken up, and the log-factor of each thing.
    """
    nothing = phrase, np.zeros(len(fit))
    anchors = [m for m in modifiers if m.tree.phrase.words[0] not in _AMONG]
    last = "last" in phrase.words
    numbers = [ORDINALS[word] for word in phrase.words if word in ORDINALS] or [1] * last
    if len(anchors) != 1 or len(numbers) != 1 or len(anchors[0].combos.beams) != 1:
        return nothing
    anchor, where = anchors[0], encoder.layout
    name, *more = anchor.tree.phrase.words
    if more or name not in ON_A_SIDE:
        return nothing
    way, start = np.array(ON_A_SIDE[name]), COUNTED_FROM.get(name)
    if any((w.startswith("from ") and w != start) or is_superlative(w) for w in phrase.words):
        return nothing
    landmark = anchor.combos.things[int(anchor.log_prior.argmax())][0]
    off = where.position - where.position[landmark]
    rest = fit - anchor.log_psi
    there = where.solid & np.isfinite(off).all(axis=1) & encoder.perceived & (rest >= rest.max() - _ALIKE)
    at = np.flatnonzero(there & (off[:, :2] @ way > np.abs(off[:, :2] @ way[::-1])))  # rather there than across
    if len(at) < max(2, *numbers):
        return nothing
    log = np.zeros(len(fit))
    away = np.hypot(*off[at, :2].T)
    log[at] = -_TWICE * behind(away if last else -away, numbers[0], phrase.count or 1)
    return replace(phrase, words=tuple(w for w in phrase.words if w not in {*ORDINALS, "last", start})), log
