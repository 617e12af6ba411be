"""Walls that are no things of a room: "the cabinet against the wall", "the left wall", "the freestanding shelf".

Where nobody lists the walls, the things at the edges of a room tell where these are. A noun phrase gets a word
("at a wall: yes"), which is compared with where each thing stands (`with_walls`).
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import replace

from dcg_torch.interpretation.parser_protocol import Words
from dcg_torch.interpretation.room_parts import named_classes, told_of_walls, walls_of
from dcg_torch.names.attributes import NOT_
from dcg_torch.names.normal_form import normalise
from dcg_torch.names.relations import listed
from dcg_torch.names.vocabulary import AT_WALL, PLACE_WORDS
from dcg_torch.types import ParseTree, Phrase, PhraseKind, WorldModel
from dcg_torch.types.arrays import Floats

_WALLS, _AT, _OFF, _FREE = (listed(of) for of in ("wall of a room", "at a wall", "off a wall", "free of walls"))
_YES, _NO = f"{AT_WALL}yes", f"{AT_WALL}no"
_STANDS, _CLEAR = 0.3, 0.6
"""Metres of a gap up to which a thing stands at a wall, and above which it stands at none."""


def by_walls(tree: ParseTree, said: Words, world: WorldModel) -> ParseTree:
    """A tree in which walls that are no things are sides ("the left wall"), or words of what stands at any of them.

    Args:
        said: the words of the tree.
    """
    walls = said.nouns & _WALLS
    if not walls and said.words.isdisjoint(_FREE):
        return tree
    if any(normalise(type_).split(" ")[-1] in _WALLS for type_ in named_classes(world)):
        return tree
    tree = _of_sides(tree)
    return tree if walls_of(world) is None else _told(tree)


def _of_sides(tree: ParseTree) -> ParseTree:
    phrase, children = tree.phrase, tuple(map(_of_sides, tree.children))
    sides = [word for word in phrase.words if word in PLACE_WORDS] if phrase.noun in _WALLS else []
    if len(sides) == 1:
        phrase = replace(phrase, noun=sides[0], words=tuple(word for word in phrase.words if word != sides[0]))
    return ParseTree(phrase, children)


def _told(tree: ParseTree) -> ParseTree:
    children = tuple(map(_told, tree.children))
    phrase = tree.phrase
    if phrase.kind is not PhraseKind.NOUN:
        return replace(tree, children=children)
    words = [_NO if word in _FREE else word for word in phrase.words]
    words += [word for child in children if (word := _stands_at(child)) is not None]
    kept = tuple(child for child in children if _stands_at(child) is None)
    return ParseTree(replace(phrase, words=tuple(dict.fromkeys(words))), kept)


def _stands_at(place: ParseTree) -> str | None:
    """ "Against the wall", "not along a wall", "away from the walls"; None for any other place."""
    if place.phrase.kind is not PhraseKind.PREPOSITION or len(place.children) != 1 or not place.phrase.words:
        return None
    wall, name = place.children[0], place.phrase.words[0]
    said: Phrase = wall.phrase
    if said.noun not in _WALLS or said.words or said.color or wall.children:
        return None
    if name.removeprefix(NOT_) in _AT:
        return _NO if name.startswith(NOT_) else _YES
    return _NO if name in _OFF else None


def with_walls(world: WorldModel, trees: Iterable[ParseTree]) -> WorldModel:
    """The world whose things are told to stand at a wall or at none, if a tree speaks of that."""
    return told_of_walls(world, trees, AT_WALL, _at_wall)


def _at_wall(gaps: Floats) -> str | None:
    return _YES if gaps.min() <= _STANDS else _NO if gaps.min() > _CLEAR else None
