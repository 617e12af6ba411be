"""The landmark that bears or holds another thing: "the cup on the table with the lamp on it", "on the same table as the
lamp". Nothing stands on a cup, if nobody says so: it is the table that has the lamp on it."""

from __future__ import annotations

import itertools
from dataclasses import replace

from dcg_torch.interpretation.parser_protocol import Words
from dcg_torch.names.relations import listed
from dcg_torch.names.vocabulary import GROUP_WORDS, SIDED
from dcg_torch.types import ParseTree, Phrase, PhraseKind, WorldModel

_WITH, _SAME, _AS = "with", "same", "as"


def by_bearers(tree: ParseTree, said: Words, _: WorldModel) -> ParseTree:
    """A tree in which what bears or holds a thing is said of the landmark that does.

    Args:
        said: the words of the tree.
    """
    return _by_bearers(tree) if {_WITH, _AS} & said.words else tree


def _by_bearers(tree: ParseTree) -> ParseTree:
    children = [_by_bearers(child) for child in tree.children]
    for k, (place, after) in enumerate(itertools.pairwise(children)):
        borne = _borne(place, after, tree.phrase)
        if tree.phrase.kind is PhraseKind.NOUN and borne is not None:
            bearer = place.children[0]
            words = tuple(word for word in bearer.phrase.words if word != _SAME)
            if bearer.phrase.noun in GROUP_WORDS and (number := borne.children[0].phrase.count) is not None:
                words, borne = (*words, f"of {number}"), None  # "in the row with five mugs"
            more = () if borne is None else (borne,)
            bearer = ParseTree(replace(bearer.phrase, words=words), (*bearer.children, *more))
            return replace(tree, children=(*children[:k], replace(place, children=(bearer,)), *children[k + 2 :]))
    return replace(tree, children=tuple(children))


def _borne(place: ParseTree, after: ParseTree, head: Phrase) -> ParseTree | None:
    """What is said of the landmark of a place by what comes after: "with the lamp on it"; None where nothing is."""
    if not _is_place(place) or not _is_place(after) or place.phrase.words[0] not in listed("on a thing"):
        return None
    bearer, other = place.children[0].phrase, after.children[0]
    if after.phrase.words[0] == _AS and _SAME in bearer.words and not other.children:
        it = ParseTree(Phrase(PhraseKind.NOUN, "it"))
        on_it = ParseTree(replace(place.phrase, text=place.phrase.words[0]), (it,))
        return ParseTree(Phrase(PhraseKind.PREPOSITION, _WITH, (_WITH,)), (replace(other, children=(on_it,)),))
    again = after.phrase.words[0] == _WITH and head.noun is not None and other.phrase.noun == head.noun
    if again and bearer.noun is not None and bearer.noun not in SIDED:
        return after  # no cup is with two cups: it is the table that is
    if after.phrase.words[0] != _WITH or len(other.children) != 1 or not _is_place(other.children[0]):
        return None
    on_it = other.children[0]
    said = on_it.children[0].phrase
    same = on_it.phrase.words[0] in listed("on a thing") and said.text == "it" and said.noun is None
    return after if same and bearer.noun is not None else None


def _is_place(tree: ParseTree) -> bool:
    return tree.phrase.kind is PhraseKind.PREPOSITION and len(tree.children) == 1 and bool(tree.phrase.words)
