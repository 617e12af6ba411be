"""What has been learned about single words since the training: the evidence, and the soft labels that follow from it.

The log-likelihoods are those of `meaning.beliefs`; `lexical` says where they come from.
"""

from __future__ import annotations

import math
from collections.abc import Collection, Iterable, Mapping
from dataclasses import dataclass, field, replace

from dcg_torch.grounding.features import FeatureSet
from dcg_torch.learning.beliefs import Beliefs, Evidence, Prior
from dcg_torch.learning.soft_labels import NEVER_HEARD, Pair
from dcg_torch.types import Object, Phrase, PhraseKind

_SLIP = 0.1
"""Share of commands in which the rest of a command is taken to mean another object than it does."""
_AGREEING, _AGREED = 3, 0.8
"""A word of the corpus is settled by as many lessons that agree, if they are this share of all that had it."""


@dataclass(frozen=True)
class Words:
    """What has been learned about words since the corpus.

    Attributes:
        nouns: the evidence about nouns and types.
        colors: the same about words for colours and the colours of percepts.
        taught_colors: words for colours that the training taught, and what they name.
        taught_types: types known from the training, with or without a name.
        color_words: words for colours that have been learned, and what they name.
    """

    nouns: Beliefs = field(default_factory=lambda: Beliefs(Prior(slip=_SLIP)))
    colors: Beliefs = field(default_factory=lambda: Beliefs(Prior(slip=_SLIP)))
    taught_colors: Mapping[str, str] = field(default_factory=dict)
    taught_types: tuple[str, ...] = ()
    color_words: Mapping[str, str] = field(default_factory=dict)

    def taught(
        self,
        types: Iterable[str],
        nouns: Mapping[str, Mapping[str, int]],
        colors: Mapping[str, Mapping[str, int]],
    ) -> Words:
        """With what a corpus taught: see `lexical.LexicalModel.taught`."""
        settled, of_colors, of_nouns = dict(self.taught_colors), self.colors, self.nouns
        for word, values in colors.items():
            if _sure(values):
                settled[word] = max(values, key=lambda v: values[v])
            elif word not in settled:
                of_colors = _weighed(of_colors, word, values)
        for word, values in nouns.items():
            if not _sure(values):
                of_nouns = _weighed(of_nouns, word, values)
        met = tuple(dict.fromkeys((*self.taught_types, *types)))
        return replace(self, nouns=of_nouns, colors=of_colors, taught_types=met, taught_colors=settled)

    def settled(self, named: Mapping[str, str]) -> Words:
        """With these nouns, and the taught words for colours, beyond doubt."""
        nouns, colors = self.nouns, self.colors
        if named != nouns.settled:
            nouns = replace(nouns, settled=dict(named)).meet(named.values())
        if self.taught_colors != colors.settled:
            colors = replace(colors, settled=dict(self.taught_colors)).meet(self.taught_colors.values())
        return replace(self, nouns=nouns, colors=colors)


def _sure(lessons: Mapping[str, int]) -> bool:
    """Do enough lessons agree on what a word names?"""
    return max(lessons.values()) >= max(_AGREEING, _AGREED * sum(lessons.values()))


def _weighed(beliefs: Beliefs, word: str, lessons: Mapping[str, int]) -> Beliefs:
    """The beliefs with lessons about a word, each of which showed what was meant."""
    for meaning, count in lessons.items():
        for _ in range(count):
            beliefs = beliefs.weigh(Evidence(word, {meaning: 1.0}))
    return beliefs


def soft_labels(words: Words, features: FeatureSet, known_types: Collection[str]) -> list[Pair]:
    """The posterior as soft labels: of every learned word, and of one that was never heard."""
    return [*_noun_pairs(words, features, known_types), *_color_pairs(words, features, known_types)]


def _noun_pairs(words: Words, features: FeatureSet, known_types: Collection[str]) -> list[Pair]:
    """Every noun with a thing of every known type, and with one of a type that has no name yet."""
    nouns, known = words.nouns, known_types
    table, new = nouns.said_of()
    types = nouns.posterior.types
    at = [k for k, t in enumerate(types) if t in known]
    strange = [k for k, t in enumerate(types) if t not in known and t not in set(nouns.settled.values())]
    rows = [(w, row) for w, row in zip(nouns.posterior.words, table, strict=True) if w in nouns.heard]
    rows = [(w, row) for w, row in rows if features.knows_noun(w)]
    pairs = []
    for word, row in (*rows, (NEVER_HEARD, new)):
        phrase = Phrase(PhraseKind.NOUN, word, noun=word)
        pairs += [Pair(phrase, Object(types[k], types[k], known=True), float(row[k])) for k in at]
        pairs.append(Pair(phrase, Object("strange", None, known=False), float(row[strange].max())))
    return pairs


def _color_pairs(words: Words, features: FeatureSet, known_types: Collection[str]) -> list[Pair]:
    """Every word for a colour with every colour that has a name, and with one that has none."""
    colors, column = words.colors, features.grounding
    table, new = colors.said_of()
    values = colors.posterior.types
    at = [k for k, c in enumerate(values) if f"color: {c}" in column]
    strange = [k for k in range(len(values)) if k not in at]
    rows = [(w, row) for w, row in zip(colors.posterior.words, table, strict=True) if w in words.color_words]
    pairs = []
    for word, row in (*rows, (NEVER_HEARD, new)):
        phrase = Phrase(PhraseKind.NOUN, word, color=word)
        for k, value in (*((k, values[k]) for k in at), (max(strange, key=lambda k: row[k]), NEVER_HEARD)):
            thing = Object(f"{value} thing", next(iter(known_types), None), known=True, color=value)
            pairs.append(Pair(phrase, thing, float(row[k])))
    return pairs


def apart(one: list[Pair], other: list[Pair]) -> float:
    """The largest difference between the probabilities of two lists of soft labels; infinite if they list others."""
    if [(p.phrase, p.object) for p in one] != [(p.phrase, p.object) for p in other]:
        return math.inf
    return max((abs(p.odds / (1 + p.odds) - q.odds / (1 + q.odds)) for p, q in zip(one, other, strict=True)), default=0)
