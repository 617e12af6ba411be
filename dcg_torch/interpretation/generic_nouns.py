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

_ANY, _TOYS, _OUTLINES = (listed(of) for of in ("whatever there is", "toy of any shape", "outline of a toy"))
_THING, _SEVERAL = "thing", 2


def by_generic_nouns(tree: ParseTree, said: Words, world: WorldModel) -> ParseTree:
    """A tree in which nouns that may be said of whatever there is are one noun.

    A block is anything among toys of which no class is called so, and of which some are called by their outline.

    Args:
        said: the words of the tree.
    """
    if said.nouns.isdisjoint(_ANY | _TOYS) or any(type_.startswith(OPAQUE) for type_ in world.classes):
        return tree
    names = [normalise(type_).split(" ") for type_ in named_classes(world)]
    toys = _TOYS if len({name[-1] for name in names} & _OUTLINES) >= _SEVERAL else frozenset[str]()
    return _of_things(tree, (_ANY | toys).difference(*names))


def _of_things(tree: ParseTree, generic: frozenset[str]) -> ParseTree:
    phrase, children = tree.phrase, tuple(_of_things(child, generic) for child in tree.children)
    if phrase.kind is PhraseKind.NOUN and phrase.noun in generic:
        phrase = replace(phrase, noun=_THING)
    return ParseTree(phrase, children)
