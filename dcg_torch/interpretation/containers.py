"""What holds a thing is meant where the thing itself is not in the scene: "my keys are in the top drawer".

Nor is what fills a thing or is a part of it: "the bottle with the red liquid" is a red one. And of what something that
is not there is done with, that is meant: "sweep the floor with the broom", "stir it with the spoon".
"""

from __future__ import annotations

import functools
from collections.abc import Collection, Sequence
from dataclasses import replace

from dcg_torch.names.everyday_names import everyday
from dcg_torch.names.normal_form import normalise
from dcg_torch.names.palette import region
from dcg_torch.names.relations import listed
from dcg_torch.names.weights import names_one_of
from dcg_torch.types import OPAQUE, ParseTree, Phrase, PhraseKind, WorldModel

_INSIDE = listed("inside")
_BEARS = listed("has as a verb") - {"be"}
_NOTHING_IN, _EMPTY = "nothing in", "empty"
_WORKED_WITH, _WORKS = listed("worked with"), listed("works")
"""Prepositions before a tool, and what is done with one."""
_OWN = listed("own")
"""First words of what the speaker has and the scene need not."""


def in_what_holds_it(trees: Sequence[ParseTree], world: WorldModel) -> list[ParseTree]:
    """Trees about what holds what is not there, and in which colours behind a noun are colours.

    Args:
        world: the classes of its objects say what is there.
    """
    types = frozenset([o.type for o in world.objects if o.type is not None and not o.hypothetical])
    if not types or any(type_.startswith(OPAQUE) for type_ in types):
        return list(trees)
    colors = frozenset([o.color for o in world.objects if o.color is not None and not o.hypothetical])
    return [_in_what_holds_it(tree, types, colors) for tree in trees]


@functools.lru_cache(maxsize=1024)
def _in_what_holds_it(tree: ParseTree, types: frozenset[str], colors: frozenset[str]) -> ParseTree:
    """The same, from what it depends on of a world: one command is grounded in many worlds with the same classes."""
    return _holder(_tool(_filled(_colored(tree, types), types, colors), types), types)


def _tool(tree: ParseTree, types: Collection[str]) -> ParseTree:
    """The tree of an order about what is not there, or was not named, as one about the tool that it names."""
    if tree.phrase.kind is not PhraseKind.VERB or _WORKS.isdisjoint(tree.phrase.words) or not tree.children:
        return tree
    done, *others = tree.children
    phrase = done.phrase
    unnamed = not (phrase.noun or phrase.color or phrase.words or phrase.text.endswith("one"))
    if phrase.kind is not PhraseKind.NOUN or not (unnamed or (phrase.noun and not names_one_of(phrase.noun, types))):
        return tree
    with_one = [c for c in (*done.children, *others) if c.phrase.words[:1] and c.phrase.words[0] in _WORKED_WITH]
    tools = [t for place in with_one for t in place.children if t.phrase.noun and names_one_of(t.phrase.noun, types)]
    return replace(tree, children=tuple(tools)) if len(tools) == 1 else tree


def _holder(tree: ParseTree, types: Collection[str]) -> ParseTree:
    held = next((child for child in tree.children if child.phrase.kind is PhraseKind.NOUN), None)
    told = bool(tree.phrase.text) and not tree.phrase.words  # "the scissors are in the top drawer"
    if tree.phrase.kind is PhraseKind.NOUN or held is None or not _is_elsewhere(held.phrase, types, told):
        return tree
    places = [c for c in (*held.children, *tree.children) if _is_inside(c) and _is_there(c.children[0].phrase, types)]
    if not places:
        return tree
    further = tuple(c for c in held.children if c is not places[0] and c.phrase.kind is PhraseKind.PREPOSITION)
    holder = places[0].children[0]
    return replace(tree, children=(replace(holder, children=(*holder.children, *further)),))


def _is_inside(place: ParseTree) -> bool:
    inside = place.phrase.kind is PhraseKind.PREPOSITION and place.phrase.words[0] in _INSIDE
    return inside and len(place.children) == 1


def _is_elsewhere(phrase: Phrase, types: Collection[str], told: bool) -> bool:
    """Is a thing named that is none of those there, and that the speaker has or tells of?"""
    first = phrase.text.split(" ")[0]
    owned = told or first in _OWN or not _OWN.isdisjoint(phrase.words) or not phrase.text
    if phrase.noun is None:  # "it is in the box" where all are boxes
        return owned and phrase.color is None and not phrase.words
    return owned and not names_one_of(phrase.noun, types)


def _is_there(phrase: Phrase, types: Collection[str]) -> bool:
    """Does a phrase speak of things that are there?"""
    if phrase.noun is None:
        return phrase.color is not None or bool(phrase.words)
    return names_one_of(phrase.noun, types)


def _colored(tree: ParseTree, types: Collection[str]) -> ParseTree:
    """ "The drawer brown" is a brown drawer, where drawers are."""
    phrase, children = tree.phrase, tuple(_colored(child, types) for child in tree.children)
    noun, _, last = (phrase.noun or "").rpartition(" ")
    behind = bool(noun) and phrase.color is None and region(normalise(last)) is not None
    if behind and names_one_of(noun, types) and not names_one_of(last, types):
        phrase = replace(phrase, noun=noun, color=last)
    return ParseTree(phrase, children)


def _filled(tree: ParseTree, types: Collection[str], colors: Collection[str]) -> ParseTree:
    """A tree in which a thing has the colour of what it is said to have, where that is not there, and is empty where
    nothing is in it.

    Args:
        colors: of what is there; of no others is it said ("the man with the grey beard").
    """
    phrase, children = tree.phrase, tuple(_filled(child, types, colors) for child in tree.children)
    if phrase.kind is not PhraseKind.NOUN:
        return ParseTree(phrase, children)
    if _NOTHING_IN in phrase.words:
        phrase = replace(phrase, words=tuple(_EMPTY if word == _NOTHING_IN else word for word in phrase.words))
    with_color = [c for c in children if {*c.phrase.words[:1]} & _BEARS and len(c.children) == 1]
    fill = with_color[0].children[0].phrase if len(with_color) == 1 else phrase
    worn = fill.noun is None and fill.text == fill.color  # "wearing red"
    if phrase.color or not (fill.color in colors and (fill.noun or worn)) or fill is phrase:
        return ParseTree(phrase, children)
    if fill.noun and names_one_of(fill.noun, types) and fill.noun not in everyday().fillings:
        return ParseTree(phrase, children)
    return ParseTree(replace(phrase, color=fill.color), tuple(c for c in children if c is not with_color[0]))
