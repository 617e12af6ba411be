"""Walls that are no things of a room: "the cabinet against the wall", "the left wall", "the freestanding shelf".

Where nobody lists the walls, the things at the edges of a room tell where these are. A noun phrase gets a word
("at a wall: yes"), which is compared with where each thing stands (`with_walls`). "On the same wall as the door" and
"on the wall opposite the door" are words of that wall, where one door is there.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import replace

import numpy as np

from dcg_torch.interpretation.parser_protocol import Words
from dcg_torch.interpretation.room_parts import gaps_to_walls, named_classes, room_walls, told_of_walls
from dcg_torch.names.attributes import NOT_
from dcg_torch.names.normal_form import normalise
from dcg_torch.names.relations import listed
from dcg_torch.names.vocabulary import AT_WALL, OF_WALL, PLACE_WORDS
from dcg_torch.names.weights import names_one_of
from dcg_torch.types import ParseTree, Phrase, PhraseKind, WorldModel

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
    if (around := room_walls(world)) is None:
        return tree
    return _told(_of_one_wall(tree, world, around) if walls else tree)


def _of_one_wall(tree: ParseTree, world: WorldModel, around: np.ndarray) -> ParseTree:
    """A tree in which "on the same wall as the door", of the only door, is a word of what is at that wall.

    Args:
        around: of `room_walls`.
    """
    children = tuple(_of_one_wall(child, world, around) for child in tree.children)
    walls = [child for child in children if len(child.children) == 1 and child.children[0].phrase.noun in _WALLS]
    if tree.phrase.kind is not PhraseKind.NOUN or len(walls) != 1 or walls[0].phrase.words[:1] != ("on",):
        return ParseTree(tree.phrase, children)
    wall = walls[0].children[0]
    marks = [child for child in (*children, *wall.children) if child is not walls[0] and len(child.children) == 1]
    for mark in marks:
        said = {*wall.phrase.words, *mark.phrase.words}
        if wall.phrase.color is None and said in _RELATED and (ends := _walls_of(mark.children[0], world, around)):
            at = [_NAMED[row if said == _SAME else 1 - row][column] for row, column in ends]
            words = (*tree.phrase.words, *(f"{OF_WALL}{name}" for name in at))
            kept = tuple(child for child in children if child is not walls[0] and child is not mark)
            return ParseTree(replace(tree.phrase, words=words), kept)
    return ParseTree(tree.phrase, children)


_SAME, _OPPOSITE = {"same", "as"}, "opposite"
_RELATED = (_SAME, {_OPPOSITE}, *({_OPPOSITE, of} for of in ("from", "of", "to")))
"""What is said of a wall and before the landmark."""
_NAMED = (("west", "south"), ("east", "north"))
"""The walls at the least and the greatest x and y."""


def _walls_of(landmark: ParseTree, world: WorldModel, around: np.ndarray) -> list[tuple[int, int]]:
    """At which wall the only thing of a name is; none where there are several, or it is in a corner or at none."""
    noun, bare = landmark.phrase.noun, not (landmark.children or landmark.phrase.words or landmark.phrase.color)
    named = [o for o in world.objects if noun and bare and o.type and names_one_of(noun, (o.type,))]
    gaps = gaps_to_walls(named[0], around) if len(named) == 1 else None
    ends = [] if gaps is None else [(int(row), int(column)) for row, column in np.argwhere(gaps <= _STANDS)]
    return ends if len(ends) == 1 else []


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
    """The world whose things are told at which walls they stand, or at none, if a tree speaks of that."""
    trees = list(trees)
    return told_of_walls(told_of_walls(world, trees, AT_WALL, _at_wall), trees, OF_WALL, _at_which)


def _at_wall(gaps: np.ndarray) -> Sequence[str]:
    return [_YES] if gaps.min() <= _STANDS else [_NO] if gaps.min() > _CLEAR else []


def _at_which(gaps: np.ndarray) -> Sequence[str]:
    return [f"{OF_WALL}{_NAMED[row][column]}" for row, column in np.argwhere(gaps <= _STANDS)]
