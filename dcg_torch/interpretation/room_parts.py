"""Parts of a room: "the trash can that isn't in the corner", "the corner desk", "the lower shelf".

Which corner is not said, and a thing in any of them is meant. In a room that is no rank: nothing is the nearest to a
corner. So a noun phrase gets a word ("spot: corner"), which is compared with where each thing stands (`with_corners`).
"""

from __future__ import annotations

import itertools
from collections.abc import Callable, Iterable, Sequence
from dataclasses import replace

import numpy as np

from dcg_torch.interpretation.parser_protocol import Words
from dcg_torch.names.attributes import NOT_
from dcg_torch.names.normal_form import normalise
from dcg_torch.names.relations import listed
from dcg_torch.names.vocabulary import LATERAL, PLACE_WORDS, SPOT, TIERS
from dcg_torch.names.weights import names_one_of
from dcg_torch.scene.room_walls import CLASSES, gaps_to_walls, room_walls
from dcg_torch.types import OPAQUE, Object, ParseTree, Phrase, PhraseKind, WorldModel
from dcg_torch.types.arrays import Floats

_ALL = listed("whole of a room")
_CORNER, _ELSEWHERE = f"{SPOT}corner", f"{SPOT}elsewhere"
_WITHIN = listed("in a corner")
_IN, _OUT = 0.7, 1.1
"""Metres from both walls up to which a thing is in a corner, and from one of them above which it is in none."""
_APART = 0.3
"""Metres by which the heights of some things of one name differ at least."""
_AT_END, _FEW_ON_A_PILE = listed("at a side"), 12
"""Prepositions before the top of a pile, and how many flat things one looks for a pile among."""
_FEW = 100
"""Things of one name up to which these are looked for on a rack."""
_HEIGHTS = dict.fromkeys(("top", "upper", "topmost"), "highest")
_HEIGHTS |= dict.fromkeys(("bottom", "lower", "bottommost"), "lowest")

_TALL = {
    **dict.fromkeys(("high", "higher", "highest"), "tallest"),
    **dict.fromkeys(("low", "lower", "lowest"), "shortest"),
}
"""What is said of heights, of things that stand on one level."""
_LEVEL, _TALLER = 0.02, 1.15
"""Metres within which things stand on one level, and how much higher one reaches than another at least."""


def by_heights(tree: ParseTree, said: Words, world: WorldModel) -> ParseTree:
    """A tree in which "the lower shelf", of things at quite other heights in a room or on a rack, is the lowest.

    Args:
        said: the words of the tree.
    """
    if said.words.isdisjoint(_HEIGHTS.keys() | _TALL.keys()) and said.nouns.isdisjoint(_HEIGHTS):
        return tree
    return _of_heights(tree, world)


def _of_heights(tree: ParseTree, world: WorldModel) -> ParseTree:
    phrase, children = tree.phrase, tuple(_of_heights(child, world) for child in tree.children)
    if not _HEIGHTS.keys().isdisjoint(phrase.words) and _stand_apart_in_height(phrase, world):
        phrase = replace(phrase, words=tuple(_HEIGHTS.get(word, word) for word in phrase.words))
    if not _TALL.keys().isdisjoint(phrase.words) and phrase.noun and _reach_up(_called(phrase.noun, world)):
        phrase = replace(phrase, words=tuple(_TALL.get(word, word) for word in phrase.words))
    ends = [child for child in children if _is_on_an_end(child)]
    if len(ends) == 1 and _stand_apart_in_height(phrase, world):
        word = _HEIGHTS[ends[0].children[0].phrase.noun or ""]
        return ParseTree(replace(phrase, words=(*phrase.words, word)), tuple(c for c in children if c is not ends[0]))
    return ParseTree(phrase, children)


def _reach_up(things: Sequence[Object]) -> bool:
    """Do some things stand on one level, and reach to several heights?

    Dots and balls of several sizes don't: one of these is higher where it stands higher, or farther up a page.
    """
    sized = [(o.position[2], o.size[2]) for o in things if o.position and o.size]
    feet = [[z for z, _ in sized], [z - high / 2.0 for z, high in sized]]  # a position is a foot or a middle
    high = [own for _, own in sized]
    level = any(max(z) - min(z) < _LEVEL for z in feet) if sized else False
    round_ = all(o.size is not None and max(o.size) <= _TALLER * min(o.size) for o in things)
    return level and len(sized) == len(things) and max(high) > _TALLER * min(high) and not round_


def _is_on_an_end(place: ParseTree) -> bool:
    """ "(The book) on top"."""
    end = place.children[0] if len(place.children) == 1 else place
    bare = end.phrase.noun in _HEIGHTS and not (end.phrase.words or end.children)
    return bare and place.phrase.kind is PhraseKind.PREPOSITION and place.phrase.words[0] in _AT_END


def _called(noun: str, world: WorldModel) -> list[Object]:
    return [o for o in world.objects if o.position and o.type and names_one_of(noun, (o.type,))]


def _lie_on_one_another(things: Sequence[Object]) -> bool:
    """Do some of a few things, that are low beside what they cover, rest on others of them?"""
    low = [o for o in things if o.position and o.size and o.size[2] < min(o.size[:2])]
    pairs = itertools.permutations(low, 2) if len(low) == len(things) <= _FEW_ON_A_PILE else ()
    return any(_rests_on(above, below) for above, below in pairs)


def _rests_on(above: Object, below: Object) -> bool:
    (x, y, z), (a, b, c) = above.position or (0.0, 0.0, 0.0), below.position or (0.0, 0.0, 0.0)
    size = below.size or (0.0, 0.0, 0.0)
    rise = ((above.size or size)[2] + size[2]) / 2.0
    return abs(x - a) < size[0] / 2.0 and abs(y - b) < size[1] / 2.0 and 0.5 * rise < z - c < 1.5 * rise


def _stand_apart_in_height(phrase: Phrase, world: WorldModel) -> bool:
    noun = phrase.noun
    if noun is None or noun in PLACE_WORDS or {*phrase.words} & LATERAL:
        return False
    named = _called(noun, world)
    if _lie_on_one_another(named):
        return True
    at = [o.position for o in named if o.position]
    lowest, highest = min((z for *_, z in at), default=0.0), max((z for *_, z in at), default=0.0)
    if noun in TIERS or len(world.classes) >= CLASSES or highest - lowest < _APART:
        return highest - lowest >= _APART
    return len(at) <= _FEW and _on_a_rack(np.array(at), world)


def _on_a_rack(at: np.ndarray, world: WorldModel) -> bool:
    """Does a thing, such as a rack, reach over several of the heights at which others are in it?

    Args:
        at: (n, 3) the places of the others.
    """
    sized = [(o.position, o.size) for o in world.objects if o.position is not None and o.size is not None]
    tall = [(*place[:2], max(size[:2]) / 2.0) for place, size in sized if size[2] >= _APART]
    if not tall:
        return False
    racks = np.array(tall)
    inside = (np.abs(racks[:, None, :2] - at[None, :, :2]) <= racks[:, None, 2:]).all(axis=2)
    high, low = (np.where(inside, at[:, 2], end) for end in (-np.inf, np.inf))
    return bool((high.max(axis=1) - low.min(axis=1) >= _APART).any())


def named_classes(world: WorldModel) -> list[str]:
    """The classes that are there, where these are names."""
    return [t for t in world.classes if not t.startswith(OPAQUE)]


def by_corners(tree: ParseTree, said: Words, world: WorldModel) -> ParseTree:
    """A tree in which "in the corner" of a room, whichever it is, is a word of what is there.

    Args:
        said: the words of the tree.
    """
    if not any("corner" in noun for noun in said.nouns) or walls_of(world) is None:
        return tree
    return _told(tree, named_classes(world))


def _told(tree: ParseTree, types: list[str]) -> ParseTree:
    children = tuple(_told(child, types) for child in tree.children)
    phrase = tree.phrase
    if phrase.kind is not PhraseKind.NOUN:
        return replace(tree, children=children)
    places = [child for child in children if _is_any_corner(child)]
    words = [f"{NOT_}{_CORNER}" if c.phrase.words[0].startswith(NOT_) else _CORNER for c in places]
    first, _, thing = (phrase.noun or "").partition(" ")
    if first == "corner" and names_one_of(thing, types) and not any("corner" in normalise(t) for t in types):
        phrase, words = replace(phrase, noun=thing), [*words, _CORNER]
    phrase = replace(phrase, words=tuple(dict.fromkeys((*phrase.words, *words)))) if words else phrase
    return ParseTree(phrase, tuple(child for child in children if child not in places))


def _is_any_corner(place: ParseTree) -> bool:
    landmark = place.children[0] if len(place.children) == 1 else place
    said: Phrase = landmark.phrase
    inside = place.phrase.kind is PhraseKind.PREPOSITION and place.phrase.words[0].removeprefix(NOT_) in _WITHIN
    of_room = all(
        child.phrase.words == ("of",) and child.children[0].phrase.noun in _ALL for child in landmark.children
    )
    return inside and said.noun == "corner" and not said.words and of_room


def with_corners(world: WorldModel, trees: Iterable[ParseTree]) -> WorldModel:
    """The world whose things are told to be in a corner or not, if a tree speaks of the corners of a room."""
    return told_of_walls(world, trees, SPOT, _in_corner)


def _in_corner(gaps: Floats) -> str | None:
    return _CORNER if gaps.max() <= _IN else _ELSEWHERE if gaps.max() > _OUT else None


def told_of_walls(
    world: WorldModel, trees: Iterable[ParseTree], attribute: str, told: Callable[[Floats], str | None]
) -> WorldModel:
    """The world whose things have an attribute by how far they are from the walls of a room, if a tree speaks of it.

    Args:
        attribute: how the attribute begins.
        told: it, from (2,) metres between a thing and the nearer wall along x and along y; None where it is unsure.
    """
    words = {word.removeprefix(NOT_) for tree in trees for node in tree.walk() for word in node.phrase.words}
    if not any(word.startswith(attribute) for word in words) or (walls := walls_of(world)) is None:
        return world
    return replace(world, objects=tuple(_told_of(o, walls, attribute, told) for o in world.objects))


def _told_of(thing: Object, walls: Floats, attribute: str, told: Callable[[Floats], str | None]) -> Object:
    own = {a for a in thing.attributes if not a.startswith(attribute)}
    if thing.position is not None and not thing.hypothetical:
        half = np.zeros((1, 2)) if thing.size is None else np.array([thing.size[:2]]) / 2.0
        gaps = gaps_to_walls(np.array([thing.position[:2]]), half, walls)
        word = told(gaps.reshape(2, 2).min(axis=0))
        own |= {word} if word is not None else set()
    return replace(thing, attributes=frozenset(own))


def walls_of(world: WorldModel) -> Floats | None:
    """`room_walls` of what is there."""
    return room_walls([o for o in world.objects if not o.hypothetical])
