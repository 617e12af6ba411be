"""Groups of several colours: "the red and blue tower" has these, all of them and no others.

What a word for a colour says of one thing is learned, whoever says it. What it says of a group of which more than one
colour is said is counted: each colour that is said is one of its things', and each of its things is of one of them.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from dcg_torch.grounding.encoding import WorldEncoder
from dcg_torch.grounding.tables import Tables
from dcg_torch.interpretation.plain_words import in_group
from dcg_torch.names.palette import named_rgb
from dcg_torch.scene.groups import STACK
from dcg_torch.types import Correspondence, Phrase
from dcg_torch.types.arrays import Floats, Ints

_ANOTHER = -5.0
"""The most that a group loses for a thing of another colour, or for a colour that none of its things has, in nats."""


def _told_colors(phrase: Phrase) -> tuple[str, ...]:
    """The colours of which a phrase says that a group has them; none where it says one alone."""
    if phrase.color is None or not in_group(phrase):
        return ()
    further = tuple(word for word in phrase.words if named_rgb(word) is not None)
    return (phrase.color, *further) if further else ()


def without_colors(phrase: Phrase) -> Phrase:
    """The phrase without the colours of a group."""
    told = _told_colors(phrase)
    return replace(phrase, color=None, words=tuple(w for w in phrase.words if w not in told)) if told else phrase


def of_colors(phrase: Phrase, encoder: WorldEncoder, tables: Tables) -> Floats:
    """(things,) log-factor of the colours that a phrase says of a group; 0 where it says no more than one."""
    told = _told_colors(phrase)
    if not told or not encoder.perceived.any():
        return np.zeros(len(encoder.all))
    bare = replace(phrase, noun=None, words=(), look=(), plural=False, count=None)
    active = tables.factor.correspondences.index(Correspondence.ACTIVE)
    fit = np.array([tables.unranked(encoder, replace(bare, color=word))[active] for word in told])
    fit = np.maximum(fit - fit[:, encoder.perceived].max(axis=1, keepdims=True), _ANOTHER)
    return np.array([max(_of(fit[:, some]) for some in _taken_for(j, encoder)) for j in range(len(encoder.all))])


def _of(fit: Floats) -> float:
    """Of the colours (colors, members) of some things: each colour is there, and each thing is of one of them."""
    return float(fit.max(axis=1).sum() + fit.max(axis=0).min())


def _taken_for(thing: int, encoder: WorldEncoder) -> list[Ints]:
    """The things that a group may be: all, and of a stack those under its top: "the ball on the red and blue tower"."""
    members = encoder.layout.members.get(thing)
    if members is None:
        return [np.array([thing])]
    if STACK not in encoder.all[thing].attributes or len(members) < 3:
        return [members]
    return [members, np.delete(members, encoder.layout.position[members, 2].argmax())]
