"""Landmarks that are of the kind of what is meant: "the toilet between the other two", "the cup left of the other"."""

from __future__ import annotations

from dataclasses import replace

from dcg_torch.interpretation.spoken import Words
from dcg_torch.types import ParseTree, Phrase, PhraseKind, WorldModel

_OTHER = "other"


def by_others(tree: ParseTree, said: Words, _: WorldModel) -> ParseTree:
    """A tree in which "the other two" have the noun of what stands to them.

    Args:
        said: the words of the tree.
    """
    return _named(tree) if _OTHER in said.words or _OTHER in said.nouns else tree


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
    return phrase.kind is PhraseKind.NOUN and other
