"""What is more or less so than its landmark: "bigger than the box", "taller than the lamp", "darker than the cube"."""

from __future__ import annotations

import functools
import math
from collections.abc import Callable, Sequence
from dataclasses import replace

import numpy as np

from dcg_torch.interpretation.dimensions import dimensions, measure
from dcg_torch.names.palette import lab
from dcg_torch.names.vocabulary import THAN
from dcg_torch.scene.bodies import bulk
from dcg_torch.types import NOT, Object, ParseTree, PhraseKind, Pose
from dcg_torch.types.arrays import Floats

_SURE = 0.98
"""Probability that a thing is more so than another, where what is known of them says so."""
_OPEN = 0.5
_EVEN = 0.04
"""Logarithms of lengths, and shares of the whole scale of lightness, up to which two things are even."""


def _size(thing: Object) -> float | None:
    return None if thing.size is None or not bulk(thing.size) > 0.0 else math.log(bulk(thing.size)) / 3.0


def _height(thing: Object) -> float | None:
    return None if thing.size is None or not thing.size[2] > 0.0 else math.log(thing.size[2])


def _lightness(thing: Object) -> float | None:
    return None if thing.rgb is None else float(lab(np.array([thing.rgb], dtype=np.float64))[0, 0]) / 100.0


def _away(viewer: Pose, thing: Object) -> float | None:
    if thing.position is None:
        return None
    return math.log(max(_EVEN, math.hypot(thing.position[0] - viewer.x, thing.position[1] - viewer.y)))


_MORE: dict[str, tuple[Callable[[Object], float | None], float]] = {
    **dict.fromkeys(("bigger", "larger", "greater"), (_size, 1.0)),
    **dict.fromkeys(("smaller", "littler", "tinier"), (_size, -1.0)),
    **dict.fromkeys(("taller",), (_height, 1.0)),
    **dict.fromkeys(("shorter",), (_height, -1.0)),
    **dict.fromkeys(("lighter", "brighter", "paler"), (_lightness, 1.0)),
    **dict.fromkeys(("darker",), (_lightness, -1.0)),
    **{word: (functools.partial(measure, word=word), 1.0) for word in dimensions() if word.endswith("er")},
}
"""Words that compare: what is measured, and whether more of it is meant or less."""
_AWAY = {"farther": 1.0, "further": 1.0, "closer": -1.0, "nearer": -1.0}
"""Words that compare how far things are from who looks, and whether far is meant or near."""
COMPARING = frozenset({*_MORE, *_AWAY})
"""Words that compare two things."""
MORE_THAN = frozenset(f"{word} {THAN}" for word in (*_MORE, *_AWAY))


def compared_with(tree: ParseTree) -> ParseTree:
    """A noun phrase in which "bigger" and "than the box" are one modifier."""
    phrase = tree.phrase
    word = next((word for word in phrase.words if word.removeprefix(f"{NOT} ") in {*_MORE, *_AWAY}), None)
    if phrase.kind is not PhraseKind.NOUN or word is None:
        return tree
    for k, place in enumerate(tree.children):
        if place.phrase.words[:1] == (THAN,):
            more = replace(place, phrase=replace(place.phrase, words=(f"{word} {THAN}", *place.phrase.words[1:])))
            kept = replace(phrase, words=tuple(other for other in phrase.words if other != word))
            return compared_with(ParseTree(kept, (*tree.children[:k], more, *tree.children[k + 1 :])))
    return tree


def compared_twice(tree: ParseTree) -> ParseTree:
    """ "Bigger than the red one and smaller than the blue one": "smaller" is said of what is bigger."""
    thans = [c for c in tree.children if c.phrase.words[:1] == (THAN,) and len(c.children) == 1]
    if tree.phrase.kind is not PhraseKind.NOUN or len(thans) < 2:
        return tree
    marks = [place.children[0] for place in thans[:-1]]
    again = tuple(word for mark in marks for word in mark.phrase.words if word in COMPARING)
    told = {id(place): replace(place, children=(_without(place.children[0], again),)) for place in thans[:-1]}
    phrase = replace(tree.phrase, words=(*tree.phrase.words, *again))
    return ParseTree(phrase, tuple(told.get(id(child), child) for child in tree.children))


def _without(tree: ParseTree, words: Sequence[str]) -> ParseTree:
    return replace(tree, phrase=replace(tree.phrase, words=tuple(w for w in tree.phrase.words if w not in words)))


def log_more(
    name: str, things: Sequence[Object], landmarks: Sequence[tuple[int, ...]], *, denied: bool, viewer: Pose | None
) -> Floats:
    """(landmarks, things) the logarithm of the probability that a thing is more so than a landmark.

    Args:
        name: one of `MORE_THAN`.
        landmarks: numbers of things; the first of each is the landmark.
        denied: that it is not.
        viewer: who looks; None: from the origin.
    """
    word = name.removesuffix(f" {THAN}")
    measure, sign = _MORE.get(word) or (functools.partial(_away, viewer or Pose(0.0, 0.0)), _AWAY[word])
    values = np.array([math.nan if (value := measure(thing)) is None else sign * value for thing in things])
    ahead = values[None, :] - values[[of[0] for of in landmarks], None]
    found = np.where(np.isnan(ahead), _OPEN, np.where(ahead > _EVEN, _SURE, 1.0 - _SURE))
    log: Floats = np.log(1.0 - found if denied else found)
    return log
