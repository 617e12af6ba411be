"""Blocks of a stack in plain words: "the second block from the ground"."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

from dcg_torch.names.vocabulary import GROUP_WORDS, INSIDE, ORDINALS, PLACE_WORDS
from dcg_torch.types import ParseTree, PhraseKind


def from_the_ground(tree: ParseTree) -> ParseTree:
    """A noun phrase in which "the second from the ground" is the second from the bottom."""
    phrase = tree.phrase
    if phrase.kind is not PhraseKind.NOUN or ORDINALS.keys().isdisjoint(phrase.words):
        return tree
    ground = next((c for c in tree.children if c.phrase.words[:1] == ("from",) and _is_ground(c)), None)
    if ground is None:
        return tree
    kept = tuple(c for c in tree.children if c is not ground)
    return ParseTree(replace(phrase, words=(*phrase.words, "from the bottom")), (*kept, *ground.children[0].children))


def levels_of_stack(words: Sequence[str], children: Sequence[ParseTree]) -> tuple[str, ...]:
    """The words of a noun phrase whose object is in a stack: the bottom one is the lowest, and not the nearest."""
    if "bottom" not in words:
        return tuple(words)
    places = (c for c in children if c.phrase.words[:1] and c.phrase.words[0] in INSIDE and len(c.children) == 1)
    named = (w for c in places for w in (c.children[0].phrase.noun or "", *c.children[0].phrase.words))
    if not any(GROUP_WORDS.get(word, ())[:1] == ("stack",) for word in named):
        return tuple(words)
    return tuple("lowest" if word == "bottom" else word for word in words)


def _is_ground(place: ParseTree) -> bool:
    phrase = place.children[0].phrase if len(place.children) == 1 else place.phrase
    return PLACE_WORDS.get(phrase.noun or "", ("", None))[0] == "ground" and not phrase.words
