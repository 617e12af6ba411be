"""Things of which one is spoken of in the plural: "the pliers on the left", "the leftmost pair of scissors".

What a recogniser calls by a plural is one thing: its class says so, no list of words. Two such are "both" or "all".
"""

from __future__ import annotations

import functools
import re
from dataclasses import replace

from dcg_torch.interpretation.parser_protocol import Words
from dcg_torch.names.normal_form import singular
from dcg_torch.names.vocabulary import NUMBER_WORDS, OR, QUANTIFIERS
from dcg_torch.names.weights import names_one_of
from dcg_torch.types import OPAQUE, ParseTree, Phrase, PhraseKind, WorldModel

_PAIR = "pair"
_SEVERAL = (QUANTIFIERS - {OR}) | NUMBER_WORDS.keys()


def by_plural_nouns(tree: ParseTree, said: Words, world: WorldModel) -> ParseTree:
    """A tree in which such noun phrases speak of one thing.

    Args:
        said: the words of the tree.
    """
    types = [type_ for type_ in world.classes if not type_.startswith(OPAQUE)]
    plural = [type_ for type_ in types if _is_plural(type_)]
    if not plural or not any(names_one_of(noun, plural) for noun in said.nouns):
        return tree
    return _of_one(tree, plural, [type_ for type_ in types if type_ not in plural])


@functools.lru_cache(maxsize=1024)
def _is_plural(name: str) -> bool:
    """Is the name of a class a plural, or one and the same in the plural: "shoes", "pliers"?"""
    last = _last(name)
    return singular(last) != last or (last.endswith("s") and singular(last[:-1]) == last)


def _last(name: str) -> str:
    return re.split(r"[\s_-]", name.lower())[-1]


def _of_one(tree: ParseTree, plural: list[str], others: list[str]) -> ParseTree:
    children = tuple(_of_one(child, plural, others) for child in tree.children)
    phrase = tree.phrase
    if phrase.kind is not PhraseKind.NOUN or phrase.noun is None or not phrase.plural:
        return replace(tree, children=children)
    said = phrase.text.lower().split(" ")
    named = any(_last(type_) in said for type_ in plural if names_one_of(phrase.noun, (type_,)))
    if not (named and _means_one(phrase, said)) or names_one_of(phrase.noun, others):
        return replace(tree, children=children)
    words = tuple(word for word in phrase.words if word != _PAIR)
    places = tuple(_alone(child) for child in children)
    return ParseTree(replace(phrase, plural=False, count=None, words=words), places)


def _alone(place: ParseTree) -> ParseTree:
    """A place of one thing."""
    return replace(place, phrase=replace(place.phrase, plural=False, count=None))


def _means_one(phrase: Phrase, said: list[str]) -> bool:
    of_a_pair = _PAIR in said[1:] and said[said.index(_PAIR) - 1] not in _SEVERAL
    return of_a_pair or (phrase.count is None and _SEVERAL.isdisjoint(said))
