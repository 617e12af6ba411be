"""Adverbs that say where a thing is for the one who is spoken to: "the chair straight ahead", "the one behind"."""

from __future__ import annotations

from dataclasses import replace

from dcg_torch.names.vocabulary import (
    ADVERBS,
    BEARINGS,
    BESIDE_WHOM,
    LATERAL,
    NEAREST,
    ORDINALS,
    PLACE_WORDS,
    RANKING,
    is_superlative,
)
from dcg_torch.types import ParseTree, Phrase, PhraseKind

_YOU = ParseTree(Phrase(PhraseKind.NOUN, "you", (), "you"))


def with_egocentric_places(tree: ParseTree, *, among: bool) -> ParseTree:
    """A tree in which such words are places: "in front of you", "behind you".

    Args:
        among: does the robot stand among the things? Else nothing is behind it, and "in front" is a side of theirs.
    """
    children = tuple(_of_place(with_egocentric_places(child, among=among), among) for child in tree.children)
    phrase = tree.phrase
    if _counts_from_you(phrase, children):
        children = (*children, _place("", NEAREST))
    said = [word for word in phrase.words if word in ADVERBS and (among or word not in BEARINGS)]
    if phrase.kind is not PhraseKind.NOUN or not said or phrase.noun is None:
        return tree if children == tree.children else replace(tree, children=children)
    places = tuple(_place(word, ADVERBS[word]) for word in said)
    kept = tuple(word for word in phrase.words if word not in said)
    return ParseTree(replace(phrase, words=kept), (*children, *places))


def _of_place(place: ParseTree, among: bool) -> ParseTree:
    """ "In front", "at your back", where the robot stands among the things."""
    if not among or place.phrase.kind is not PhraseKind.PREPOSITION or len(place.children) != 1:
        return place
    side = place.children[0]
    beside = BESIDE_WHOM.get(place.phrase.words[0])
    if beside is not None and _is_you(side.phrase):  # "left of the robot" is on its left
        whose = ParseTree(Phrase(PhraseKind.NOUN, f"your {beside}", ("your",), beside))
        return ParseTree(replace(place.phrase, words=("on", *place.phrase.words[1:])), (whose,))
    own = side.phrase.words == ("your",)
    bare = place.phrase.words[:1] == ("in",) and side.phrase.text == side.phrase.noun and not side.phrase.words
    if side.children or side.phrase.noun not in BEARINGS or not (own or bare):
        return place
    return _place(place.phrase.text, BEARINGS[side.phrase.noun])


def _counts_from_you(phrase: Phrase, places: tuple[ParseTree, ...]) -> bool:
    """ "The second chair on your left": counted from you, where nothing else is said to count from."""
    ordinals = [word for word in phrase.words if word in ORDINALS]
    ranked = any(is_superlative(word) or word.startswith("from ") for word in phrase.words)
    placed = [(p.phrase.words[0], p.children[0].phrase) for p in places if p.phrase.words and p.children]
    if len(ordinals) != 1 or ranked or any(name in RANKING for name, _ in placed):
        return False
    return any(_is_your_side(side) or (name in BEARINGS.values() and _is_you(side)) for name, side in placed)


def _is_your_side(phrase: Phrase) -> bool:
    return phrase.noun in LATERAL and phrase.words == ("your",)


def _is_you(phrase: Phrase) -> bool:
    return PLACE_WORDS.get(phrase.noun or "", ("", None))[0] == "robot" and phrase.color is None and not phrase.words


def _place(text: str, relation: str) -> ParseTree:
    return ParseTree(Phrase(PhraseKind.PREPOSITION, text, (relation,)), (_YOU,))
