"""Landmarks that are of the kind of what is meant: "the toilet between the other two", "the cup left of the other".

So is "the tallest one" of "the bottle next to the tallest one", where nothing else is said of what kind it is, and
among things of many kinds "the big one", which is the biggest of all there on a board.
"""

from __future__ import annotations

from dataclasses import replace

from dcg_torch.interpretation.parser_protocol import Words
from dcg_torch.names.attribute_values import says_size
from dcg_torch.names.normal_form import singular
from dcg_torch.names.vocabulary import LATERAL, ORDINALS, is_superlative
from dcg_torch.types import ParseTree, Phrase, PhraseKind, WorldModel

_OTHER, _ONE = "other", "one"
_MANY = 6
"""Classes from which on things are of many kinds."""


def by_same_kind(tree: ParseTree, said: Words, world: WorldModel) -> ParseTree:
    """A tree in which "the other two" and "the last one" have the noun of what stands to them.

    Args:
        said: the words of the tree.
    """
    mixed = len(world.classes) >= _MANY
    picked = any(_picks(word, mixed) for word in said.words)
    return _named(tree, mixed) if picked or _OTHER in said.words or _OTHER in said.nouns else tree


def _named(tree: ParseTree, mixed: bool) -> ParseTree:
    children = tuple(_named(child, mixed) for child in tree.children)
    noun = tree.phrase.noun
    if tree.phrase.kind is PhraseKind.NOUN and noun is not None:
        children = tuple(_to_others(child, noun, mixed) for child in children)
    return replace(tree, children=children)


def _to_others(place: ParseTree, noun: str, mixed: bool) -> ParseTree:
    bare = [_is_bare(landmark.phrase, mixed) for landmark in place.children]
    if place.phrase.kind is not PhraseKind.PREPOSITION or not any(bare):
        return place
    landmarks = (
        replace(one, phrase=replace(one.phrase, noun=noun)) if is_bare else one
        for one, is_bare in zip(place.children, bare, strict=True)
    )
    return replace(place, children=tuple(landmarks))


def _is_bare(phrase: Phrase, mixed: bool) -> bool:
    other = phrase.noun == _OTHER or (phrase.noun is None and _OTHER in phrase.words)
    one = phrase.noun is None and phrase.color is None and singular(phrase.text.split(" ")[-1]) == _ONE
    return phrase.kind is PhraseKind.NOUN and (other or (one and any(_picks(word, mixed) for word in phrase.words)))


def _picks(word: str, mixed: bool) -> bool:
    """Does a word pick from several of a kind: "the last one", "the tallest one"; among many kinds "the big one"?"""
    picks = word in ORDINALS or is_superlative(word) or word == "last"
    return picks or (mixed and (says_size(word) or word in LATERAL))
