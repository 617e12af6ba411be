"""What a modifier does to a noun phrase, by its tree: it ranks from a landmark, picks a side, or names a place."""

from __future__ import annotations

from dataclasses import replace

from dcg_torch.interpretation.plain_words import in_group
from dcg_torch.names.colors import comparing_words
from dcg_torch.names.relations import listed
from dcg_torch.names.vocabulary import INSIDE, OF_OUTLINE, SIDED, WITHIN, counted, is_superlative, ranks_from_landmark
from dcg_torch.types import ParseTree, PhraseKind

_MOST_COUNTED = 3
"""Landmarks up to which those of "behind the two cones" are told apart."""


def ranks_from(tree: ParseTree) -> bool:
    """Is it a modifier by which things are ranked from a landmark: "second closest to"?"""
    return ranks_from_landmark(tree.phrase.words[0])


def tells_which_few(noun: ParseTree) -> list[ParseTree]:
    """Modifiers that say which few a phrase picks from: "in the corner" of "two dots in the corner, the higher one".

    Where nothing else picks, they do: "of the two dots the one on the left".
    """
    several = counted(noun.phrase.words)
    placed = [c for c in noun.children if c.phrase.kind is PhraseKind.MODIFIER and (ranks_from(c) or picks_a_side(c))]
    # "In the corner" are all of them, and not the first above all.
    said = [replace(c, phrase=replace(c.phrase, plural=True, count=several)) for c in placed if c.phrase.text]
    compares = any(map(is_superlative, noun.phrase.words)) or bool(comparing_words(noun.phrase.look))
    return said if compares or len(said) < len(placed) else []


def picks_a_side(tree: ParseTree) -> bool:
    """Is it a modifier that picks by a side: "(of the two cubes) the one on the left"?"""
    return tree.phrase.words[0] != WITHIN and len(tree.children) == 1 and tree.children[0].phrase.noun in SIDED


def is_in_a_group(tree: ParseTree) -> bool:
    """Does a modifier say of which group a thing is one: "in the row"?"""
    return tree.phrase.words[0] in INSIDE and len(tree.children) == 1 and in_group(tree.children[0].phrase)


def is_to_a_place(tree: ParseTree, *, sized: bool = False) -> bool:
    """Does a modifier say in which part of the scene, or of a table, a thing is? What stands by one is a vaguer set.

    Args:
        sized: is it known how large things are, so that what is on a thing is told from what is beside it?
    """
    name = tree.phrase.words[0]
    return "to a thing" not in tree.phrase.context or name in OF_OUTLINE or (sized and name in _ON_IT)


_ON_IT = listed("on a thing")


def counted_landmark(tree: ParseTree) -> int:
    """How many landmarks a modifier is to, each by itself ("behind the two cones"); 0 for all others."""
    count = tree.children[0].phrase.count if len(tree.children) == 1 else None
    return count if count is not None and 2 <= count <= _MOST_COUNTED else 0
