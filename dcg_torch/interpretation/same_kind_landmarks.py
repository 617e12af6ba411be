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
_INTRODUCED = frozenset({"near", "facing"})
"""What sentences before the one that matters are taken for: where the thing is, and who looks."""
_ONE_OF = frozenset({"a", "an"})


def by_same_kind(tree: ParseTree, said: Words, _: WorldModel) -> ParseTree:
    """A tree in which "the other two" and "the last one" have the noun of what stands to them.

    Args:
        said: the words of the tree.
    """
    picked = any(map(_picks, said.words))
    return _named(tree) if picked or _OTHER in said.words or _OTHER in said.nouns else tree


def by_introduction(tree: ParseTree, said: Words, _: WorldModel) -> ParseTree:
    """ "Look for a cube. Take the cube that ..." speaks of one cube: what is introduced is no landmark.

    Args:
        said: the words of the tree.
    """
    return tree if said.words.isdisjoint(_INTRODUCED) else _introduced(tree)


def _introduced(tree: ParseTree) -> ParseTree:
    phrase, children = tree.phrase, tuple(map(_introduced, tree.children))
    meant = phrase if phrase.kind is PhraseKind.NOUN else children[0].phrase if children else phrase
    children = tuple(c for c in children if not (_INTRODUCED.issuperset(c.phrase.words[:1]) and _is_it(c, meant)))
    return ParseTree(phrase, children)


def _is_it(place: ParseTree, phrase: Phrase) -> bool:
    """Is it what a sentence before named as one of those of which one is meant, and no more of it?"""
    if len(place.phrase.words) != 1 or len(place.children) != 1:
        return False
    first = place.children[0].phrase
    bare = not (first.words or first.plural or place.children[0].children)
    said_before = place.phrase.text == first.text and first.text.split(" ")[0] in _ONE_OF
    return bare and said_before and (first.noun, first.color) == (phrase.noun, phrase.color)


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
