"""Nouns that say nothing of what a thing is: "the red shape", "the piece on the left", "a block" that may be a star.

They mean the same as "thing", of which a model knows that it may be said of whatever there is.
"""

from __future__ import annotations

from dataclasses import replace

from dcg_torch.interpretation.parser_protocol import Words
from dcg_torch.interpretation.room_parts import named_classes
from dcg_torch.names.normal_form import normalise
from dcg_torch.names.relations import listed
from dcg_torch.types import OPAQUE, ParseTree, PhraseKind, WorldModel

_ANY = listed("whatever there is")
_OF_SORTS = [
    (listed("toy of any shape"), listed("outline of a toy")),
    (listed("card of any suit"), listed("suit of a card")),
]
"""Nouns that may be said of all things of a sort, and words of the names of such things."""
_THING, _SEVERAL = "thing", 2


def by_generic_nouns(tree: ParseTree, said: Words, world: WorldModel) -> ParseTree:
    """A tree in which nouns that may be said of whatever there is are one noun.

    A block is anything among toys of which no class is called so, and of which some are called by their outline; so is
    a card among cards that are called by their suit.

    Args:
        said: the words of the tree.
    """
    spoken = said.nouns.intersection(_ANY.union(*(nouns for nouns, _ in _OF_SORTS)))
    if not spoken or any(type_.startswith(OPAQUE) for type_ in world.classes):
        return tree
    names = [normalise(type_).split(" ") for type_ in named_classes(world)]
    sorts = [nouns for nouns, of in _OF_SORTS if sum(not of.isdisjoint(name) for name in names) >= _SEVERAL]
    return _of_things(tree, _ANY.union(*sorts).difference(*names))


def _of_things(tree: ParseTree, generic: frozenset[str]) -> ParseTree:
    phrase, children = tree.phrase, tuple(_of_things(child, generic) for child in tree.children)
    if phrase.kind is PhraseKind.NOUN and phrase.noun in generic:
        phrase = replace(phrase, noun=_THING)
    return ParseTree(phrase, children)
