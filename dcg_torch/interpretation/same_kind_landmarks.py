"""Landmarks that are of the kind of what is meant: "the toilet between the other two", "the cup left of the other".

So is "the tall one" of "the bottle next to the tall one", where nothing else is said of what kind it is.
"""

from __future__ import annotations

from dataclasses import replace

from dcg_torch.interpretation.parser_protocol import Words
from dcg_torch.names.normal_form import singular
from dcg_torch.names.vocabulary import ORDINALS, is_superlative
from dcg_torch.types import ParseTree, Phrase, PhraseKind, WorldModel

_OTHER, _ONE = "other", "one"


def by_same_kind(tree: ParseTree, said: Words, _: WorldModel) -> ParseTree:
    """A tree in which "the other two" and "the last one" have the noun of what stands to them.

    Args:
        said: the words of the tree.
    """
    picked = any(map(_picks, said.words))
    return _named(tree) if picked or _OTHER in said.words or _OTHER in said.nouns else tree


def _named(tree: ParseTree) -> ParseTree:
    children = tuple(_named(child) for child in tree.children)
    noun = tree.phrase.noun
    if tree.phrase.kind is PhraseKind.NOUN and noun is not None:
        children = tuple(_to_others(child, noun) for child in children)
    return replace(tree, children=children)


def _to_others(place: ParseTree, noun: str) -> ParseTree:
    if place.phrase.kind is not PhraseKind.PREPOSITION or not any(_is_bare(c.phrase) for c in place.children):
        return place
    landmarks = (replace(c, phrase=replace(c.phrase, noun=noun)) if _is_bare(c.phrase) else c for c in place.children)
    return replace(place, children=tuple(landmarks))


def _is_bare(phrase: Phrase) -> bool:
    other = phrase.noun == _OTHER or (phrase.noun is None and _OTHER in phrase.words)
    one = phrase.noun is None and phrase.color is None and singular(phrase.text.split(" ")[-1]) == _ONE
    return phrase.kind is PhraseKind.NOUN and (other or (one and any(map(_picks, phrase.words))))


def _picks(word: str) -> bool:
    """Does a word pick from several of a kind: "the last one", "the tallest one"?"""
    return word in ORDINALS or is_superlative(word) or word == "last"
