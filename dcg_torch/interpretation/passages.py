"""Along a passage: "the second door on the left" is the second that one comes to on that side.

So it is where somebody stands before two lines of such things, one on either side, before a long line beside the way,
or before a street. Elsewhere it is the second from the left end of one line.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from dcg_torch.interpretation.parser_protocol import Words
from dcg_torch.interpretation.scene_kinds import scene_kind
from dcg_torch.names.relations import listed
from dcg_torch.names.vocabulary import BESIDE_THE_WAY, LATERAL, LIKE_RELATION, ORDINALS
from dcg_torch.names.weights import names_one_of
from dcg_torch.types import ParseTree, Phrase, PhraseKind, WorldModel
from dcg_torch.types.arrays import Floats
from dcg_torch.types.geometry import to_robot_frame

_LAST, _FIRST, _TABLE, _LEFT = "last", "first", "table", "left"
_FROM = {f"from the {side}": side for side in LATERAL}
_ON = listed("on a side")
_LEAST, _FEWEST, _STRAIGHT, _LONG = 3, 2, 0.35, 1.5
"""Things at least along a passage, and on one side of a street; shares of its width by which a line may be bent, and
that it is long at least."""


def by_passages(tree: ParseTree, said: Words, world: WorldModel) -> ParseTree:
    """A tree in which what is counted on a side of a passage is counted from who stands before it.

    Args:
        said: the words of the tree.
    """
    counted = _LAST in said.words or not said.words.isdisjoint(ORDINALS)
    if world.robot is None or not counted or _TABLE in scene_kind(world).split(" "):
        return tree
    return _along(tree, world)


def _along(tree: ParseTree, world: WorldModel) -> ParseTree:
    children = tuple(_along(child, world) for child in tree.children)
    phrase = tree.phrase
    number = next((word for word in phrase.words if word in ORDINALS or word == _LAST), None)
    sides = [c for c in children if _is_side(c)]
    side = next((_FROM[word] for word in phrase.words if word in _FROM), None)
    side = side or (sides[0].children[0].phrase.noun if len(sides) == 1 else None)
    if phrase.noun is None or phrase.plural or number is None or side is None:
        return replace(tree, children=children)
    if not _is_passage(phrase.noun, side, world):
        return replace(tree, children=children)
    rank = ("farthest",) if number == _LAST else ("closest",) if number == _FIRST else (number, "closest")
    words = (*rank, *(word for word in phrase.words if word != number and word not in _FROM))
    where = ParseTree(Phrase(PhraseKind.NOUN, f"your {side}", ("your",), side))
    said = (BESIDE_THE_WAY, LIKE_RELATION[BESIDE_THE_WAY])
    place = ParseTree(Phrase(PhraseKind.PREPOSITION, "on", said), (where,))
    return ParseTree(replace(phrase, words=words), (*(c for c in children if c not in sides), place))


def _is_side(place: ParseTree) -> bool:
    """ "On the left", "on your right"."""
    side = place.children[0] if len(place.children) == 1 else place
    on = place.phrase.kind is PhraseKind.PREPOSITION and place.phrase.words[:1] and place.phrase.words[0] in _ON
    return bool(on) and side.phrase.noun in LATERAL and not side.children and {*side.phrase.words} <= {"your"}


def _is_passage(noun: str, side: str, world: WorldModel) -> bool:
    """Are things of a name on a side of a way ahead of the robot?

    It has a way where such things stand in two lines, one on either side, or in one, and where all that is there is
    before it and reaches farther ahead than to its sides, as on a street.
    """
    there = [o for o in world.objects if o.position is not None and not o.hypothetical]
    if world.robot is None or not there:
        return False
    x, y = to_robot_frame(world.robot, np.array([(o.position or ())[:2] for o in there])).T
    named = {type_ for type_ in world.classes if type_ and names_one_of(noun, (type_,))}
    own = np.array([o.type in named for o in there])
    if not own.any():
        return False
    beside = y[own] > 0.0 if side == _LEFT else y[own] < 0.0
    street = x.min() >= 0.0 and np.ptp(x) >= _LONG * np.ptp(y) > 0.0
    if street and beside.sum() >= _FEWEST:
        return True
    return _in_two_lines(x[own], y[own]) or (x[own].min() >= 0.0 and _in_a_line(x[own][beside], y[own][beside]))


def _in_a_line(x: Floats, y: Floats) -> bool:
    off = float(np.abs(y).min(initial=np.inf))
    return len(y) >= _LEAST and bool(np.ptp(y) <= _STRAIGHT * off and np.ptp(x) >= _LONG * off)


def _in_two_lines(x: Floats, y: Floats) -> bool:
    left, right = y[y > 0.0], y[y <= 0.0]
    if len(y) < _LEAST or x.min() < 0.0 or not len(left) or not len(right):
        return False
    wide = float(left.min() - right.max())
    return bool(max(np.ptp(left), np.ptp(right)) <= _STRAIGHT * wide and np.ptp(x) >= _LONG * wide)
