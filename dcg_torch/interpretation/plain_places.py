"""Sides, corners and middles of sides of all that is there, in plain words: "the top left cube" is near a corner."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import replace

from dcg_torch.names.relations import listed
from dcg_torch.names.vocabulary import (
    DEGREES,
    INSIDE,
    LATERAL,
    NEAREST,
    OF_TWO,
    ORDINALS,
    OWNERS,
    PLACE_WORDS,
    SIDED,
    SYNONYMS,
    VERTICAL,
    is_superlative,
)
from dcg_torch.types import ParseTree, Phrase, PhraseKind

MIDDLES = listed("middle")
_OF_A_PLACE = {"on top of": ("top", "behind"), "above": ("top", "behind"), "under": ("bottom", "in front of")}
"""Relation to the edge of a place -> the end of it that is meant, and the relation where that is not said."""
_NOT_AT = dict.fromkeys(("not in", "not at", "not on"), "not near")
"""What is in none of the corners is near none: it is not merely no nearest one."""


def is_of_all(place: ParseTree) -> bool:
    """Is a place that of the ground, or of what everything stands on?"""
    noun = place.children[0].phrase.noun if len(place.children) == 1 else None
    return PLACE_WORDS.get(noun or "", ("", None))[0] == "ground"


def side_with_a_middle(words: Sequence[str]) -> str | None:
    """The side in whose middle "the top middle cube" is; None where words speak of none, or of more."""
    side = one_side(words, MIDDLES)
    return side if side is not None and not MIDDLES.isdisjoint(words) else None


def picks_by_place(word: str) -> bool:
    """Does a word of a noun phrase say which of several is meant by its place or its rank?"""
    return word in SIDED or word in ORDINALS or word.startswith(("of ", "from ")) or is_superlative(word)


def side_itself(place: Phrase) -> str | None:
    """The side that "the right", "the right side" and "the top edge" are; None of all else."""
    edges = {word for word, (kind, side) in PLACE_WORDS.items() if kind == "edge" and side is None}
    return one_side([place.noun or "", *place.words], edges)


def one_side(words: Sequence[str], beside: Iterable[str]) -> str | None:
    """The side of which words speak, if they say no other, and nothing else but degrees and some words beside it."""
    sides = [word for word in words if word in SIDED]
    return sides[0] if len(sides) == 1 and {*words} - {*sides} - DEGREES <= {*beside} else None


def ranked_by_distance(words: tuple[str, ...], phrase: Phrase) -> tuple[str, ...]:
    """Words in which "the far chair" is the farthest, "the nearby one" the closest; "far left", "far end" stay."""
    if {*words}.isdisjoint(_RANKED) or phrase.plural or phrase.noun in PLACE_WORDS or phrase.noun in _ENDS:
        return words
    if any(word not in _RANKED and picks_by_place(word) for word in words):
        return words
    return tuple(dict.fromkeys(_RANKED.get(word, word) for word in words))


_RANKED = dict.fromkeys(listed("far by itself"), "farthest") | dict.fromkeys(listed("near by itself"), "closest")
_ENDS = SIDED | listed("ends of a thing") | {"side", "edge"}


def in_one_corner(children: tuple[ParseTree, ...]) -> tuple[ParseTree, ...]:
    """ "On the right in the back" is near one corner."""
    sides = [c for c in children if c.phrase.words[:1] and c.phrase.words[0] in _BESIDE and len(c.children) == 1]
    bare = {c.children[0].phrase.noun: c for c in sides if not (c.children[0].children or c.children[0].phrase.words)}
    lateral, vertical = ([side for side in bare if side in of] for of in (LATERAL, VERTICAL))
    if len(lateral) != 1 or len(vertical) != 1:
        return children
    both = (bare[lateral[0]], bare[vertical[0]])
    return (*(c for c in children if c not in both), near_side((str(vertical[0]), str(lateral[0]))))


_BESIDE = listed("on a side") | {NEAREST}


def over_and_beyond(place: ParseTree) -> tuple[ParseTree, ...]:
    """On a page what is above a thing is behind it, too."""
    name, *others = place.phrase.words or ("",)
    height = "above" if name == "on top of" else name
    side = {"above": "behind", "under": "in front of"}.get(height)
    if side is None:
        return (place,)
    return tuple(replace(place, phrase=replace(place.phrase, words=(said, *others))) for said in (height, side))


def told_sides(words: tuple[str, ...], children: tuple[ParseTree, ...]) -> tuple[str, ...]:
    """The sides by which a thing is told apart: ("top", "left") of "the top left cube", ("bottom",)."""
    lateral = next((word for word in words if word.removesuffix("most") in LATERAL), None)
    vertical = next((word for word in words if word in VERTICAL), None)
    grouped = any(child.phrase.words[0] in INSIDE and not is_of_all(child) for child in children)
    if vertical is None or (grouped and lateral is None):
        return ()
    return (vertical,) if lateral is None else (vertical, lateral)


def of_two_sides(phrase: Phrase) -> bool:
    """Does it speak of two sides at once, which is a corner: "(in) the upper left", "the top right one"?"""
    said = {SYNONYMS.get(word, word).removesuffix("most") for word in (phrase.noun or "", *phrase.words)}
    return not (said.isdisjoint(LATERAL) or said.isdisjoint(VERTICAL))


def near_side(sides: tuple[str, ...]) -> ParseTree:
    """What is at a side, or at the corner of two."""
    sides = tuple(side.removesuffix("most") for side in sides)
    return closest(sides[0]) if len(sides) == 1 else closest("corner", sides)


def closest(noun: str, words: tuple[str, ...] = ()) -> ParseTree:
    """What is closest to a place."""
    return ParseTree(
        Phrase(PhraseKind.PREPOSITION, "", (NEAREST,)), (ParseTree(Phrase(PhraseKind.NOUN, noun, words, noun)),)
    )


def at_a_place(name: str, phrase: Phrase, landmark: ParseTree, text: str) -> tuple[str, Phrase]:
    """A relation to a place of all that is there, and that place: sides, ends, corners, middles of sides.

    Args:
        name: of the relation.
        phrase: the landmark in plain words, as far as they have been found.
        landmark: with all that is said of it.
        text: of the preposition.
    """
    inside = name in listed("on a side of the scene")
    side = None if landmark.children else side_with_a_middle((phrase.noun or "", *phrase.words))
    side = side_itself(phrase) or side if name in OF_TWO else side
    if side is not None and (inside or name in OF_TWO or name == NEAREST):
        name, phrase = NEAREST, replace(phrase, noun=f"{side} middle", words=())
    if phrase.noun in PLACE_WORDS and name in _OF_A_PLACE:
        end, beyond = _OF_A_PLACE[name]
        side = side_itself(phrase)
        if side in LATERAL and end in text:  # "on the top of the left side"
            name, phrase = NEAREST, replace(phrase, noun="corner", words=(end, side))
        elif end not in text:  # "below the upper left corner"
            name = beyond
    if phrase.noun == "end" and not landmark.children and inside and (side := one_side(phrase.words, ())) is not None:
        name, phrase = NEAREST, replace(phrase, noun=side, words=())  # "the mug at the left end" is the leftmost
    if phrase.noun in SIDED:
        sides = tuple(word for word in phrase.words if word not in DEGREES)
        corner = told_sides((*sides, phrase.noun), ())
        if len(corner) == 2 and not set(sides) & OWNERS.keys():
            phrase = replace(phrase, noun="corner", words=corner)
        elif len(sides) < len(phrase.words) and inside:
            name, phrase = NEAREST, replace(phrase, words=sides)
    if phrase.noun in ("corner", "middle", "center") and not landmark.children:
        name = NEAREST if inside else _NOT_AT.get(name, name)
    return name, phrase
