"""Landmarks: what can't be one, and what follows for a command whose landmark is not there."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np

from dcg_torch.grounding.encoding import WorldEncoder
from dcg_torch.grounding.phrase_scores import Scored
from dcg_torch.interpretation.plain_words import in_group
from dcg_torch.names.everyday_names import is_everyday
from dcg_torch.names.evidence import is_generic
from dcg_torch.names.keys import OF_KEY
from dcg_torch.names.relations import listed
from dcg_torch.names.rooms import room_named
from dcg_torch.types import NOT, ParseTree, Phrase, PhraseKind
from dcg_torch.types.arrays import Floats, Ints

_NAMES_ONE = math.log(0.5)
"""Log Psi from which a noun phrase names a thing that is there."""
_HAVING = listed("has or consists of")
"""Prepositions before what a thing has or consists of, which need not be a thing of its own."""
_NOT_THERE = 0.25
"""Probability at most that nothing is meant where a landmark is named that nobody has seen: people also stand things to
parts of things, and to what no recogniser tells."""
_ALIKE = math.log(0.5)
"""Log-odds that things named as well as one another differ by at most."""

APART, _FARTHEST = 0.5, 8.0
"""Each unit that two landmarks are farther apart takes so much from their log-score, up to a number of units: people
speak of two things at once that stand together."""


def only_named(tree: ParseTree, found: Scored, encoder: WorldEncoder) -> Scored:
    """Without what a landmark in the singular is not: "the green block" is no cluster, "the green one" no place."""
    phrase, named = tree.phrase, found.named
    meanable = len(encoder.world.objects) + len(encoder.world.groups)
    shade = phrase.color == phrase.text  # "closest to blue" is not beside a blue thing
    told = (phrase.color is not None and not shade) or any(OF_KEY in word for word in phrase.words)
    if told and (phrase.noun is None or is_generic(phrase.noun)):
        found.scores[:, meanable:] = -np.inf
    if named is None or phrase.noun is None or phrase.plural or (phrase.count or 1) > 1 or in_group(phrase):
        return found
    seen = named[: len(encoder.world.objects)][encoder.perceived[: len(encoder.world.objects)]]
    if not encoder.world.groups or seen.max(initial=-np.inf) < _NAMES_ONE:
        return found
    group = np.array([bool(o.members) for o in encoder.all], dtype=np.bool_)
    return found._replace(scores=np.where(group[None, :, None], -np.inf, found.scores))


def landmarks_of(tree: ParseTree) -> tuple[Phrase, ...]:
    """The names of things that a noun phrase says its object stands to: no places, rooms, parts, and nothing denied."""
    if tree.phrase.noun is None:  # "the yellow object next to the lamp" may be anything
        return ()
    places = (c for c in tree.children if c.phrase.kind is PhraseKind.MODIFIER and _is_to_a_thing(c.phrase))
    found = (landmark.phrase for place in places for landmark in place.children)
    return tuple(Phrase(PhraseKind.NOUN, "", noun=phrase.noun) for phrase in found if _is_thing(phrase.noun))


def _is_to_a_thing(phrase: Phrase) -> bool:
    return NOT not in phrase.words and phrase.words[0] not in _HAVING and "to a thing" in phrase.context


def _is_thing(noun: str | None) -> bool:
    """Does a noun name a thing that a recogniser would tell, if it were there?"""
    return noun is not None and is_everyday(noun) and not is_generic(noun) and room_named(noun) is None


def without_landmarks(log_odds: float, of_each: Sequence[float], found: Scored, encoder: WorldEncoder) -> float:
    """The log-odds that nothing there is meant, where landmarks may not be there: "the mug next to the kettle".

    Where only one thing has the name and the colour that are said, it is meant whatever it stands beside. Of n that are
    alike a landmark that is not there picks none: it leaves the share 1 - 1 / n to what is not there.

    Args:
        log_odds: by name and colour.
        of_each: the log-odds that each of the landmarks is not there; those that rather are say nothing.
    """
    there = encoder.perceived[: found.scores.shape[1]]
    if max(of_each, default=-1.0) < 0.0 or found.named is None:
        return log_odds
    named = np.where(there, found.named[: len(there)], -np.inf)
    alike = int((named >= named.max() + _ALIKE).sum())
    doubt = (1.0 - 1.0 / alike) * _NOT_THERE
    left = (1.0 - doubt) / (1.0 + math.exp(log_odds))
    return math.log1p(-left) - math.log(left)


def spread(landmarks: Ints, place: Floats) -> Floats:
    """(combos,) how far the landmarks that are spoken of together are apart, beyond those that are closest, units.

    Args:
        landmarks: (combos, k) numbers of things.
        place: (things, 2).
    """
    at, ordered = place[landmarks], np.sort(landmarks, axis=1)
    apart = np.linalg.norm(at[:, :, None] - at[:, None], axis=3).max(axis=(1, 2))
    once = (ordered[:, 1:] == ordered[:, :-1]).any(axis=1)
    apart = np.where(np.isfinite(apart) & ~once, apart, np.inf)
    near: Floats = np.minimum(apart - apart.min(), _FARTHEST) if np.isfinite(apart.min()) else np.zeros(len(apart))
    return near
