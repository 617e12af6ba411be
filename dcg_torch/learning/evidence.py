"""What a command says of one of its words apart from that word: P(object | the command without it).

"The zorp behind the blue cube" teaches "zorp" from what stands behind the blue cube, and "the cube next to the zorp"
from what stands next to the cube meant. The factor graph says it, with the word in question left out of its phrase,
so that what is believed of it already is not taken for evidence; nothing else decides. It is one function for the
nouns and the colours of targets and of landmarks.
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Callable, Iterable, Iterator, Mapping
from dataclasses import dataclass, replace
from typing import Literal

import numpy as np

from dcg_torch.grounding.hypotheses import ModifierFactor
from dcg_torch.grounding.solution import Solution
from dcg_torch.names.palette import named_rgb
from dcg_torch.types import Object, ParseTree, Phrase, PhraseKind, WorldModel

Ground = Callable[[ParseTree, WorldModel], Solution]
"""Grounds a tree of factors in a world."""
Attribute = Literal["noun", "color"]
IsOpen = Callable[[Attribute, str], bool]
"""Whether a word has anything left to be learned."""

_NEGLIGIBLE = 0.02
"""Objects that are meant with less probability say nothing of landmarks."""


@dataclass(frozen=True, slots=True)
class WordEvidence:
    """How well the things of the world fit a command without one of its words.

    Attributes:
        attribute: what the word is.
        word: as said.
        fits: id of a perceived object -> its share of what may be meant: of a target, its odds where none is above 1,
            else relative to the best; of a landmark, its probability.
        phrase: of the word.
        landmark: is it a landmark's?
    """

    attribute: Attribute
    word: str
    fits: Mapping[str, float]
    phrase: Phrase
    landmark: bool

    def by(self, value: Mapping[str, str | None]) -> dict[str, float]:
        """Summed over the objects of one type, or of one colour: `value` says which, by id."""
        total: defaultdict[str, float] = defaultdict(float)
        for id_, fit in self.fits.items():
            if (of := value[id_]) is not None:
                total[of] += fit
        return dict(total)


def told_by_look(word: str, there: Iterable[Object]) -> bool:
    """Is a colour word about what things look like, whatever their colours are called?

    Where things show their look, a word that has a place among colours tells shades, not what others call them: who
    calls a patch "sky blue" does not say that blue things are, and that cyan ones are not.

    Args:
        there: the things that it is said among.
    """
    return named_rgb(word) is not None and any(thing.rgb is not None for thing in there)


def evidence(solution: Solution, ground: Ground, is_open: IsOpen) -> Iterator[WordEvidence]:
    """What there is to be learned of every open noun and colour of a command, the target's first."""
    target = solution.target
    if target is None:
        return
    for attribute, word, bare in _without(target.phrase, is_open):
        found = ground(replace(target, phrase=bare), solution.world)
        yield WordEvidence(attribute, word, _relative(found), target.phrase, landmark=False)
    for m, modifier in enumerate(target.children):
        for k, landmark in enumerate(modifier.children):
            for attribute, word, bare in _without(landmark.phrase, is_open):
                changed = _with_child(modifier, k, replace(landmark, phrase=bare))
                found = ground(_with_child(target, m, changed), solution.world)
                nth = sum(child.phrase.kind is PhraseKind.MODIFIER for child in target.children[:m])
                fits = _landmarks(found, found.modifiers[nth], k)
                yield WordEvidence(attribute, word, fits, landmark.phrase, landmark=True)


def _without(phrase: Phrase, is_open: IsOpen) -> Iterator[tuple[Attribute, str, Phrase]]:
    """Every open word of a phrase, and the phrase without it."""
    if phrase.noun is not None and is_open("noun", phrase.noun):
        yield "noun", phrase.noun, replace(phrase, noun=None)
    if phrase.color is not None and is_open("color", phrase.color):
        yield "color", phrase.color, replace(phrase, color=None)


def _with_child(tree: ParseTree, k: int, child: ParseTree) -> ParseTree:
    return replace(tree, children=(*tree.children[:k], child, *tree.children[k + 1 :]))


def _perceived(found: Solution) -> list[str]:
    return [o.id for o in found.world.objects if not o.hypothetical]


def _relative(found: Solution) -> dict[str, float]:
    """The odds of the perceived objects, relative to the best where that is above 1."""
    ids = _perceived(found)
    scale = max((1.0, *(found.odds[i] for i in ids)))
    return {i: found.odds[i] / scale for i in ids}


def _landmarks(found: Solution, factor: ModifierFactor, k: int) -> dict[str, float]:
    """How probable each perceived object is as the k-th landmark of a modifier, over all that may be meant.

    Args:
        factor: of the modifier; it is of the same place in the noun phrase, and its words may be others.
    """
    ids = _perceived(found)
    number = {thing.id: j for j, thing in enumerate(found.world.things)}
    meant = [i for i in ids if found.probabilities[i] >= _NEGLIGIBLE]
    shares = np.array([found.probabilities[i] for i in meant])
    fits = dict.fromkeys(ids, 0.0)
    of_combos = factor.posterior[:, [number[i] for i in meant]] @ shares
    for combo, probability in zip(factor.combos, of_combos.tolist(), strict=True):
        if (id_ := combo[k].child.grounding.object.id) in fits:
            fits[id_] += probability
    return fits
