"""Ends and sides of things that have extents: "the chair at the head of the table", "on the window side of the bed".

Where nothing that is there is called an end or a side, it is a part of what it belongs to. So "at the end of the table"
is a relation of its own to the table, and "on the side of the bed closest to the window" is one to the bed and the
window together. How things stand so is measured (`grounding.outlines`).
"""

from __future__ import annotations

import functools
import re
from collections.abc import Iterator, Sequence
from dataclasses import replace

from dcg_torch.interpretation.parser_protocol import Words
from dcg_torch.names.relations import listed
from dcg_torch.names.vocabulary import AT_END, AWAY_FROM, FARTHEST, PLACE_WORDS, SIDED, TOWARDS
from dcg_torch.names.weights import names_one_of
from dcg_torch.types import NOT, OPAQUE, ParseTree, Phrase, PhraseKind, WorldModel

_ENDS = listed("ends of a thing")
_END_OF = re.compile(r"\b(?:end|ends|head|foot) of$")
_AN_END = re.compile(r"^(?:the |its |one |either )?(?:end|head|foot) of ")
_SAID = re.compile(r"\b(?:ends?|head|foot|side) of\b")
_SIDE_OF = re.compile(r"\bside of$")
_SIDE = " side"
_AT = listed("at an end of a thing")
_BESIDE, _APART = listed("on the side towards"), listed("on the side away from")
_ACROSS, _NEAR = listed("across"), listed("on this side")
_SAYING = _ENDS | {"side"}


def by_faces(tree: ParseTree, said: Words, world: WorldModel) -> ParseTree:
    """A tree in which ends and sides of things are relations to these.

    Args:
        said: the words of the tree.
    """
    sides = not said.nouns.isdisjoint(_SAYING) or any(noun.endswith(_SIDE) for noun in said.nouns)
    if not sides and not _speaks_of_ends(tree):
        return tree
    sized = frozenset({o.type for o in world.objects if o.type and o.size is not None})
    types = frozenset(type_ for type_ in sized if not type_.startswith(OPAQUE))
    if world.robot is not None and types:
        tree = _seen(tree, types)
    return _faced(tree, types) if types else tree


@functools.lru_cache(maxsize=1024)
def _speaks_of_ends(tree: ParseTree) -> bool:
    return any(_SAID.search(node.phrase.text) for node in tree.walk())


def _seen(tree: ParseTree, types: frozenset[str]) -> ParseTree:
    """A tree in which the far side of a thing is the one away from you, and its left side the one on the left."""
    children = tuple(_seen(child, types) for child in tree.children)
    started = any(c.phrase.words[:1] == ("from",) and _is_a_name(c, types) for c in children)  # "from the door"
    if tree.phrase.kind is PhraseKind.NOUN and not started:
        children = tuple(one for child in children for one in _on_a_seen_side(child, types))
    return tree if children == tree.children else ParseTree(tree.phrase, children)


def _on_a_seen_side(place: ParseTree, types: frozenset[str]) -> tuple[ParseTree, ...]:
    """ "On the far side of the bed", "on the left side of the bed"; a place as it was where it is no such side."""
    side = place.children[0] if len(place.children) == 1 else place
    named = side.phrase.text.endswith(_SIDE) and place.phrase.words[:1] and place.phrase.words[0] in _AT
    whole, others = _whole(side, types) if named else (None, ())
    if whole is None or any(c.phrase.words[:1] == ("from",) for c in (*whole.children, *others)):
        return (place,)
    if side.phrase.noun in SIDED and not side.phrase.words:
        return (_related(place, TOWARDS, whole, ParseTree(side.phrase)), *others)
    if side.phrase.noun != "side" or len(side.phrase.words) != 1:
        return (place,)
    relation = AWAY_FROM if side.phrase.words[0] in _ACROSS else TOWARDS
    if relation == TOWARDS and side.phrase.words[0] not in _NEAR:
        return (place,)
    return (_related(place, relation, whole, ParseTree(Phrase(PhraseKind.NOUN, "", (), "you"))), *others)


def _faced(tree: ParseTree, types: frozenset[str]) -> ParseTree:
    children = tuple(_faced(child, types) for child in tree.children)
    if tree.phrase.kind is PhraseKind.NOUN:
        children = tuple(_places(children, types))
    return tree if children == tree.children else ParseTree(tree.phrase, children)


def _places(children: Sequence[ParseTree], types: frozenset[str]) -> Iterator[ParseTree]:
    """What stands in the place of the modifiers of a noun phrase."""
    taken = -1
    for k, place in enumerate(children):
        if k == taken:
            continue
        if place.phrase.kind is not PhraseKind.PREPOSITION or len(place.children) != 1:
            yield place
            continue
        after = children[k + 1] if k + 1 < len(children) else None
        found = _at_an_end(place, types)
        if found is None:
            found, uses = _on_a_side(place, after, types)
            taken = k + 1 if uses else -1
        yield from (place,) if found is None else found


def _at_an_end(place: ParseTree, types: frozenset[str]) -> tuple[ParseTree, ...] | None:
    """ "At the end of the table", "at the end of the table that is closest to the door"."""
    end = place.children[0]
    words = place.phrase.words[:1]
    whole: ParseTree | None = end
    others: tuple[ParseTree, ...] = ()
    if words and words[0] in _AT and end.phrase.noun in _ENDS and not end.phrase.words:
        whole, others = _whole(end, types)
    elif not (_END_OF.search(place.phrase.text) or (_AN_END.match(end.phrase.text) and words and words[0] in _AT)):
        return None
    if whole is None or not _is_there(whole.phrase, types):
        return None
    return (_related(place, AT_END, whole), *others, *_beside(whole, types))


def _on_a_side(
    place: ParseTree, after: ParseTree | None, types: frozenset[str]
) -> tuple[tuple[ParseTree, ...] | None, bool]:
    """ "On the window side of the table", "on the side of it closest to the door", "on the other side from it".

    Returns:
        What stands in the place of it, or None; and is what comes after it a part of it?
    """
    landmark = place.children[0]
    if _SIDE_OF.search(place.phrase.text) and _is_there(landmark.phrase, types):
        return _told_by(place, landmark, after, types)
    side = landmark.phrase
    if not place.phrase.words or place.phrase.words[0] not in _AT or side.noun is None:
        return None, False
    if side.noun.endswith(_SIDE):
        return _on_its_side(place, side.noun.removesuffix(_SIDE), types), False
    if side.noun == "side" and _ACROSS.intersection(side.words):
        return _across(place, after, types)
    if side.noun == "side" and not side.words and (whole := _whole(landmark, types)[0]) is not None:
        return _told_by(place, whole, after, types)
    return None, False


def _told_by(
    place: ParseTree, whole: ParseTree, after: ParseTree | None, types: frozenset[str]
) -> tuple[tuple[ParseTree, ...] | None, bool]:
    """ "On the side of the table closest to the door", "... away from the door"; as `_on_a_side`."""
    for start in filter(None, (after, *whole.children)):
        relation = _way(start, types)
        if relation is not None:
            return (_related(place, relation, whole, start.children[0]),), start is after
    return None, False


def _on_its_side(place: ParseTree, name: str, types: frozenset[str]) -> tuple[ParseTree, ...] | None:
    """ "On the window side", of the table or of all."""
    side = place.children[0]
    if not names_one_of(name, types) or side.phrase.words:
        return None
    whole, others = _whole(side, types)
    facing = ParseTree(Phrase(PhraseKind.NOUN, name, (), name))
    if whole is None:
        return (ParseTree(replace(place.phrase, words=("closest to",)), (facing,)),)
    return (_related(place, TOWARDS, whole, facing), *others, *_beside(whole, types))


def _across(
    place: ParseTree, after: ParseTree | None, types: frozenset[str]
) -> tuple[tuple[ParseTree, ...] | None, bool]:
    """ "On the other side of the table from the door"; as `_on_a_side`."""
    whole, others = _whole(place.children[0], types)
    inside = next((c for c in (whole.children if whole else ()) if c.phrase.words[:1] == ("from",)), None)
    start = inside or after
    if start is None or start.phrase.words[:1] != ("from",) or not _is_a_name(start, types):
        return None, False
    if whole is None:
        return (ParseTree(replace(start.phrase, words=(FARTHEST,)), start.children),), start is after
    bare = replace(whole, children=tuple(c for c in whole.children if c is not inside))
    return (_related(place, AWAY_FROM, bare, start.children[0]), *others), start is after


def _beside(landmark: ParseTree, types: frozenset[str]) -> tuple[ParseTree, ...]:
    """What a landmark is beside: what is at its end or side is so too, whichever of them was meant."""
    return tuple(child for child in landmark.children if _is_beside(child, types))


def _whole(part: ParseTree, types: frozenset[str]) -> tuple[ParseTree | None, tuple[ParseTree, ...]]:
    """What an end or a side belongs to, and what else is said of it."""
    of = [c for c in part.children if c.phrase.words[:1] == ("of",) and len(c.children) == 1]
    if len(of) != 1 or not _is_there(of[0].children[0].phrase, types):
        return None, ()
    return of[0].children[0], tuple(child for child in part.children if child is not of[0])


def _is_there(phrase: Phrase, types: frozenset[str]) -> bool:
    """Does a noun phrase name a thing that has extents?"""
    return phrase.noun is not None and not phrase.plural and names_one_of(phrase.noun, types)


def _is_a_name(place: ParseTree, types: frozenset[str]) -> bool:
    noun = place.children[0].phrase.noun if len(place.children) == 1 else None
    return noun is not None and (noun in PLACE_WORDS or names_one_of(noun, types))


def _is_beside(place: ParseTree, types: frozenset[str]) -> bool:
    return _way(place, types) == TOWARDS


def _way(place: ParseTree, types: frozenset[str]) -> str | None:
    """Does a place tell a side by what is towards it, or away from it?"""
    words = place.phrase.words
    if not words or NOT in words or not _is_a_name(place, types):
        return None
    return TOWARDS if words[0] in _BESIDE else AWAY_FROM if words[0] in _APART else None


def _related(place: ParseTree, name: str, *landmarks: ParseTree) -> ParseTree:
    return ParseTree(replace(place.phrase, words=(name, *place.phrase.words[1:])), landmarks)
