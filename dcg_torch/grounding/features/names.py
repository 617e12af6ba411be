"""The names of features: which fire for the words of a phrase, which meet, and what is always there."""

from __future__ import annotations

import enum
from collections.abc import Iterator
from dataclasses import dataclass

from dcg_torch import scene
from dcg_torch.grounding.features.name_facts import said_features
from dcg_torch.names.keys import OF_KEY
from dcg_torch.names.vocabulary import GROUP_WORDS, NTH, ORDINALS, TOGETHER, counted
from dcg_torch.types import (
    LOOKED_ROUND,
    NOT,
    Correspondence,
    GroundingKind,
    Phrase,
    PhraseKind,
)


class Group(enum.StrEnum):
    """The feature groups; the first four are the paper's."""

    DCG = "dcg"
    UNKNOWN = "unknown"
    HYPOTHETICAL = "hypothetical"
    COLOR = "color"
    RELATION = "relation"
    NAMES = "names"  # the names of classes, colours and attributes are evidence for words
    OPEN = "open"  # what has never been heard or met has columns too, and so has a look all round


# The family of a feature is what stands before the colon of its name. A language family meets these grounding
# families; all other pairs are no features and keep a weight of zero.
PAIRS: dict[str, frozenset[str]] = {
    "kind": frozenset({"kind", "known", "hypothetical", "child"}),
    "verb": frozenset({"kind", "child"}),
    "preposition": frozenset({"kind", "child"}),
    "modifier": frozenset({"kind", "relation"}),
    "word": frozenset({"rank", "state", "part", "stack color", "group color"}),
    "context": frozenset({"kind", "state", "relation"}),
    "landmark": frozenset({"kind"}),  # what states landmarks are in is chance, which a corpus has plenty of
    "noun": frozenset({"type", "part"}),
    "noun stated": frozenset({"said name", "said kind"}),
    "noun known": frozenset({"known", "hypothetical", "place"}),  # an unheard noun names a thing, hardly a place
    "color": frozenset({"color", "group color"}),
    "color stated": frozenset({"kind", "known", "hypothetical", "color", "said color"}),
    "words stated": frozenset({"said attribute"}),
    "look stated": frozenset({"said look"}),
}

PAPER = frozenset({Group.DCG, Group.UNKNOWN, Group.HYPOTHETICAL, Group.COLOR})
"""The feature groups of the paper's fullest model, DCG-UPUP-Away with colour."""

GROUNDING_OF = {
    PhraseKind.VERB: GroundingKind.ACTION,
    PhraseKind.PREPOSITION: GroundingKind.REGION,
    PhraseKind.NOUN: GroundingKind.OBJECT,
    PhraseKind.MODIFIER: GroundingKind.PLACED,
}

Feature = tuple[Group, str]


def child_feature(kind: GroundingKind, correspondence: Correspondence, same: bool) -> Feature:
    """The relation of a grounding to one child grounding: of which kind, how it corresponds, same object?"""
    return Group.DCG, f"child: {kind}, {'same' if same else 'other'}, {correspondence.name.lower()}"


def fixed_groundings() -> Iterator[Feature]:
    """The grounding features that exist whatever has been learned."""
    for kind in GroundingKind:
        yield Group.DCG, f"kind: {kind}"
        for correspondence in (Correspondence.ACTIVE, Correspondence.INVERTED):
            for same in (True, False):
                yield child_feature(kind, correspondence, same)
    yield Group.UNKNOWN, "known: yes"
    yield Group.UNKNOWN, "known: no"
    yield Group.COLOR, "color: unknown"
    yield Group.HYPOTHETICAL, "hypothetical: yes"
    for name in (*scene.RELATION_NAMES, *scene.STATES, *scene.RANKS):
        yield Group.RELATION, name
    for name in said_features():
        yield Group.NAMES, name
    yield Group.RELATION, "kind: place"
    yield Group.RELATION, "place: yes"
    yield Group.RELATION, "kind: group"
    yield Group.OPEN, f"hypothetical: {LOOKED_ROUND}"
    yield Group.OPEN, "type: (unmet)"


def fixed_languages() -> Iterator[Feature]:
    """The language features that exist whatever has been learned."""
    for kind in PhraseKind:
        yield Group.DCG, f"kind: {kind}"
    yield Group.UNKNOWN, "noun known: yes"
    yield Group.UNKNOWN, "noun known: no"
    yield Group.COLOR, "color: unknown"
    yield Group.COLOR, "color stated: yes"
    yield Group.OPEN, "noun: (unheard)"
    for name in ("noun", "words", "look"):
        yield Group.NAMES, f"{name} stated: yes"


@dataclass(frozen=True, slots=True)
class Ranking:
    """What a phrase counts: the nth (`ordinal`) or the first few (`count`) among those that it speaks of (`among`)."""

    among: str
    ordinal: int | None = None
    count: int | None = None


def ranking(phrase: Phrase) -> Ranking | None:
    """What a noun phrase or a modifier counts; None for a noun phrase without a word that could mean a rank."""
    if phrase.kind is PhraseKind.NOUN and all(OF_KEY in word for word in phrase.words):
        return None
    ordinal = next((ORDINALS[word] for word in phrase.words if word in ORDINALS), None) or counted(phrase.words, NTH)
    return Ranking(phrase.among or "all", ordinal, phrase.count)


def scene_features(phrase: Phrase) -> Iterator[Feature]:
    """The language features of a phrase's plain words in the kind of scene that it is said in."""
    if not phrase.scene:
        return
    of = "word" if phrase.kind is PhraseKind.NOUN else str(phrase.kind)
    if phrase.kind in (PhraseKind.NOUN, PhraseKind.MODIFIER):
        for word in phrase.words:
            if word != NOT and OF_KEY not in word and not word.startswith((TOGETHER, NTH)):
                yield Group.RELATION, f"{of}: {word}, scene {phrase.scene}"


def picked_from(phrase: Phrase) -> int | None:
    """How many those are that a noun phrase picks from: "the middle one of the five"; None where it does not say."""
    if not GROUP_WORDS.keys().isdisjoint({phrase.noun, *phrase.words}):
        return None
    return counted(phrase.words)


def word_features(phrase: Phrase) -> Iterator[Feature]:
    """The language features of a phrase's plain words; a noun's and a colour's depend on what is known.

    Words of a noun phrase also fire together ("second from the left"), and modifiers and such words together with
    the context: what they compare the object with.
    """
    is_noun = phrase.kind is PhraseKind.NOUN
    words = [word for word in phrase.words if word != NOT or phrase.kind is not PhraseKind.MODIFIER]
    words = [word for word in words if OF_KEY not in word]  # each by itself says nothing of others like it
    if is_noun and picked_from(phrase) is not None:
        words = [word for word in words if not word.startswith("of ")]
    words = [word for word in words if not word.startswith((TOGETHER, NTH))]  # which these are, is measured
    for word in words:
        yield (Group.RELATION, f"word: {word}") if is_noun else (Group.DCG, f"{phrase.kind}: {word}")
    if is_noun and len(words) > 1:
        yield Group.RELATION, f"word: {' '.join(words)}"
    for context in phrase.context:
        yield Group.RELATION, context if context.startswith("landmark: ") else f"context: {context}"
        if not is_noun:
            for word in words:
                yield Group.RELATION, f"{phrase.kind}: {word}, {context}"
