"""Several noun phrases that a command is about: "the leftmost and rightmost cubes", "the cup by the box and the one by
the jar"."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

from dcg_torch.names.palette import region
from dcg_torch.names.vocabulary import OF_TWO, OR, ORDINALS, PLACE_WORDS, is_superlative
from dcg_torch.types import ParseTree, Phrase

_AND, _LAST, _FROM = "and", "last", "from "


def each_meant(nouns: Sequence[ParseTree]) -> list[ParseTree]:
    """The noun phrases of one thing, or of several alike, that joined noun phrases mean."""
    found = [one for noun in nouns for part in own_and_repeated(noun) for one in _each_picked(part)]
    return _counted_alike(found)


def either_color(noun: ParseTree) -> tuple[ParseTree, ...]:
    """ "The red or green cube": the red cube, or the green cube; "all red or green cubes": those and these."""
    phrase = noun.phrase
    others = [word for word in phrase.words if word.startswith(f"{OR} ") or _is_another_color(word, phrase)]
    if not others:
        return (noun,)
    words = tuple(word for word in phrase.words if word not in others)
    again = words if phrase.plural else (*words, OR)
    more = (replace(phrase, color=word.removeprefix(f"{OR} "), words=again) for word in others)
    return (replace(noun, phrase=replace(phrase, words=words)), *(replace(noun, phrase=one) for one in more))


def _is_another_color(word: str, phrase: Phrase) -> bool:
    """ "All the red and green cubes": of several, some are of the one colour and some of the other."""
    several = phrase.plural and phrase.count is None and _AND in phrase.text.split()
    return several and phrase.color is not None and region(word) is not None


def own_and_repeated(noun: ParseTree) -> list[ParseTree]:
    """ "The cup by the box and the cup (or the one) by the jar": the second cup is beside the first, no landmark."""
    for k, place in enumerate(noun.children):
        first, *others = place.children or (noun,)
        others = [] if OF_TWO.issuperset(place.phrase.words[:1]) else others
        again = [
            other for other in others if other.children and _is_named_again(noun.phrase, first.phrase, other.phrase)
        ]
        if again:
            kept = replace(place, children=tuple(child for child in place.children if child not in again))
            own = replace(noun, children=(*noun.children[:k], kept, *noun.children[k + 1 :]))
            return [own, *(_named_as(noun.phrase, other) for other in again)]
    return [noun]


def _is_named_again(head: Phrase, landmark: Phrase, other: Phrase) -> bool:
    """Does a phrase that stands beside a landmark name what the head of both does, and not what the landmark is?"""
    if head.noun is None or landmark.noun in PLACE_WORDS or (other.noun or head.noun) != head.noun:
        return False
    return landmark.noun != head.noun or landmark.color != head.color == (other.color or head.color)


def _named_as(head: Phrase, other: ParseTree) -> ParseTree:
    if other.phrase.noun is not None:
        return other
    return replace(other, phrase=replace(other.phrase, noun=head.noun, color=other.phrase.color or head.color))


def _each_picked(noun: ParseTree) -> list[ParseTree]:
    """ "The leftmost and rightmost cubes": a noun phrase for each that is picked."""
    phrase = noun.phrase
    picks = [word for word in phrase.words if _picks(word)]
    if _AND not in phrase.text.split() or len(picks) < 2:
        return [noun]
    kept = [tuple(word for word in phrase.words if word == pick or word not in picks) for pick in picks]
    return [replace(noun, phrase=replace(phrase, words=words, plural=False, count=None)) for words in kept]


def _picks(word: str) -> bool:
    return is_superlative(word) or word in ORDINALS or word == _LAST


def _counted_alike(nouns: list[ParseTree]) -> list[ParseTree]:
    """ "The first and the third cube from the left": both are counted from there, and each is one."""
    counted = all(any(word in ORDINALS or word == _LAST for word in noun.phrase.words) for noun in nouns)
    start = next((word for noun in nouns[-1:] for word in noun.phrase.words if word.startswith(_FROM)), None)
    if start is None or not counted or len(nouns) < 2:
        return nouns
    return [replace(noun, phrase=_counted(noun.phrase, start)) for noun in nouns]


def _counted(phrase: Phrase, start: str) -> Phrase:
    told = any(word.startswith(_FROM) for word in phrase.words)
    return replace(phrase, words=phrase.words if told else (*phrase.words, start), plural=(phrase.count or 1) > 1)
