"""Which weights follow from what is believed of words, and which are taught by lessons on relations.

What nouns and colours mean follows from the learner, anew after every command. What "behind", "leftmost" or "you"
mean is taught by lessons. Hardly a feature is shared: a modifier's factor is about how a thing is placed, a noun's
about what it is, and a noun phrase's describing words and places add features of their own to the latter.
"""

from __future__ import annotations

import functools

import numpy as np

from dcg_torch.grounding.features import FeatureSet
from dcg_torch.names.vocabulary import GROUP_WORDS, PLACE_TYPES, PLACE_WORDS
from dcg_torch.types.arrays import Bools

_TAUGHT_LANGUAGE = frozenset({"modifier", "word", "context", "landmark"})
_TAUGHT_GROUNDING = frozenset({"relation", "state", "part", "rank", "stack color", "group color"})
_GIVEN = frozenset({"said name", "said kind", "said color", "said attribute", "said look"})
"""What names of classes say is known from the start."""
_HANDLED = frozenset({"state: covered", "state: held"})
"""Not that a thing is clear, which tells it from what is not there and says nothing about a hand."""
_PLACES = {f"noun: {word}" for word in (*PLACE_WORDS, *GROUP_WORDS)}
_OF_PLACES = {*(f"type: {kind}" for kind in PLACE_TYPES), "kind: place", "kind: group", "place: yes"}


def believed_mask(features: FeatureSet) -> Bools:
    """(L, G) the weights of nouns, colours, verbs and prepositions."""
    rows = np.array([not _is_taught_language(name) for name in features.language], dtype=np.bool_)
    columns = np.array([not _is_taught_grounding(name) for name in features.grounding], dtype=np.bool_)
    return rows[:, None] & columns[None, :]


def taught_mask(features: FeatureSet) -> Bools:
    """(L, G) what there is to be learned from generated lessons.

    Not what a noun is like by itself, nor how things stand in a context whatever the word: the lessons' worlds are
    random, it would be chance. Of the object of a verb only whether a hand can take it, or holds it.
    """
    names = list(features.grounding)
    of_context = np.array([name in {"kind: placed", "kind: place", "kind: group"} for name in names])
    of_any = np.array([name in {"kind: place", "kind: group", "place: yes"} for name in names])
    of_hand = of_context | np.array([name in _HANDLED for name in names])
    of_word = np.array([name.partition(":")[0] not in _GIVEN for name in names])
    rows = [
        of_hand
        if name.startswith("context: object")
        else of_context
        if name.startswith(("context:", "landmark:"))
        else of_word
        if _is_taught_language(name)
        else of_any
        for name in features.language
    ]
    return np.array(rows, dtype=np.bool_).reshape(features.shape)


def rows_mask(features: FeatureSet, words: frozenset[str]) -> Bools:
    """(L, G) all weights of some nouns and words for colours."""
    named = [name.removeprefix("noun: ").removeprefix("color: ") for name in features.language]
    rows = np.array([name in words for name in named], dtype=np.bool_)
    return np.repeat(rows[:, None], features.shape[1], axis=1)


@functools.lru_cache(maxsize=1 << 14)
def _is_taught_language(name: str) -> bool:
    return name.partition(":")[0] in _TAUGHT_LANGUAGE or name in _PLACES or name == "kind: modifier"


@functools.lru_cache(maxsize=1 << 14)
def _is_taught_grounding(name: str) -> bool:
    return name.partition(":")[0] in _TAUGHT_GROUNDING | _GIVEN or name in _OF_PLACES
