"""Rows and columns of the whole scene, in plain words: "the third row", "the back row of mugs"."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

from dcg_torch.interpretation.parser_protocol import Words
from dcg_torch.interpretation.scene_kinds import is_on_floor
from dcg_torch.names.vocabulary import (
    INSIDE,
    LINE_ACROSS,
    LINE_FROM,
    LINE_OF,
    MIDDLE_LINE,
    ORDINALS,
    PLACE_WORDS,
    READ_FROM,
)
from dcg_torch.scene.grids import grid_of
from dcg_torch.scene.upright_pictures import is_upright
from dcg_torch.types import ParseTree, Phrase, PhraseKind, WorldModel

_SAME_END = {"from the back": "from the top", "from the front": "from the bottom"}


def line_of_all(phrase: Phrase) -> Phrase | None:
    """ "The third row", "the bottom row" is one of the lines of the whole scene; None for a row by itself."""
    line = LINE_OF.get(phrase.noun or "")
    if line is None or phrase.plural or phrase.color is not None:
        return None
    ends, (start, _) = LINE_FROM[line], READ_FROM[line]
    ordinal = next((word for word in phrase.words if word in ORDINALS), None)
    plain = [_SAME_END.get(word, word) for word in phrase.words]
    sides = [ends[w] for w in plain if w in ends] + [w for w in plain if w in ends.values()]
    if ordinal is None and not sides:
        return replace(phrase, noun=line, words=(MIDDLE_LINE,)) if "middle" in phrase.words else None
    number = ORDINALS.get(ordinal or "", 1)
    return replace(phrase, noun=line, words=(f"{number} {sides[0] if sides else start}",))


def lines_from_here(tree: ParseTree, said: Words, world: WorldModel) -> ParseTree:
    """A tree in which "the row closest to you" of several is the front row; on a floor it is the first one, too.

    Args:
        said: the words of the tree.
        world: on a table and on a page rows are counted from the top, as one reads.
    """
    if said.nouns.isdisjoint(_ACROSS):
        return tree
    viewer = world.viewer or world.robot
    several = grid_of([o for o in world.objects if not o.hypothetical], viewer) is not None
    on_floor = is_on_floor(world) and not is_upright(world.objects, viewer)
    return _from_here(tree, several=several, on_floor=on_floor)


def _from_here(tree: ParseTree, *, several: bool, on_floor: bool) -> ParseTree:
    children = tuple(_from_here(child, several=several, on_floor=on_floor) for child in tree.children)
    phrase, here = tree.phrase, [c for c in children if _ranks_from_you(c)] if several else []
    if phrase.noun not in _ACROSS or phrase.plural:
        rows = [c for c in children if len(c.children) == 1 and _is_bare(c.children[0])]
        if len(here) == len(rows) == 1 and children.index(here[0]) == children.index(rows[0]) + 1:
            # "The cup in the row closest to you": which row that is, is said only so.
            row = replace(rows[0], children=(_at_end(rows[0].children[0], here[0]),))
            children = tuple(row if c is rows[0] else c for c in children if c is not here[0])
        return replace(tree, children=children)
    if here:
        return _at_end(replace(tree, children=tuple(c for c in children if c is not here[0])), here[0])
    if on_floor and LINE_FROM[LINE_ACROSS].keys().isdisjoint({*phrase.words} - {"last"}) and not children:
        words = tuple("top" if word == "last" else word for word in phrase.words)
        first = any(w in ORDINALS for w in words) and not any(w.startswith("from ") for w in words)
        phrase = replace(phrase, words=(*words, "from the bottom") if first else words)
    return ParseTree(phrase, children)


def _at_end(row: ParseTree, here: ParseTree) -> ParseTree:
    end = _ENDS_FROM[here.phrase.words[0]]
    return replace(row, phrase=replace(row.phrase, words=(*row.phrase.words, end)))


def _is_bare(tree: ParseTree) -> bool:
    phrase = tree.phrase
    return phrase.noun in _ACROSS and not (phrase.words or phrase.plural or tree.children)


def _ranks_from_you(place: ParseTree) -> bool:
    names = place.phrase.words[:1] and place.phrase.words[0] in _ENDS_FROM and len(place.children) == 1
    return bool(names) and PLACE_WORDS.get(place.children[0].phrase.noun or "", ("",))[0] == "robot"


_ACROSS = frozenset(word for word, line in LINE_OF.items() if line == LINE_ACROSS)
_ENDS_FROM = {"closest to": "bottom", "closer to": "bottom", "farthest from": "top", "farther from": "top"}
"""How a row stands to who looks, and which end of all rows it is then."""


def read_along(words: tuple[str, ...], children: Sequence[ParseTree]) -> tuple[str, ...]:
    """ "The second cube in the third row" is the second from the left."""
    lines = (c.children[0].phrase.noun for c in children if len(c.children) == 1 and c.phrase.words[0] in INSIDE)
    line = next((noun for noun in lines if noun in READ_FROM), None)
    counted = any(word in ORDINALS for word in words) and not any(word.startswith("from ") for word in words)
    if line is None or not counted or len(words) > 1:
        return words
    return (*words, READ_FROM[line][1])


def in_whole_line(tree: ParseTree) -> ParseTree:
    """A command about a line of the scene as one about all that is in it: "the back row", "the left column of mugs"."""
    phrase = tree.phrase
    if phrase.kind is PhraseKind.NOUN:
        named = next((word for word in (phrase.noun, *phrase.words) if word in LINE_OF), None)
        line = None if named is None or tree.children else line_of_all(_bare_line(phrase, named))
        if line is None or named is None:
            return tree
        noun = None if phrase.noun == named else phrase.noun
        inside = ParseTree(Phrase(PhraseKind.PREPOSITION, "in", ("in",)), (ParseTree(line),))
        return ParseTree(replace(phrase, noun=noun, words=(), plural=True, count=None), (inside,))
    if not tree.children:
        return tree
    return ParseTree(phrase, (in_whole_line(tree.children[0]), *tree.children[1:]))


def _bare_line(phrase: Phrase, named: str) -> Phrase:
    words = tuple(word for word in phrase.words if word != named)
    return Phrase(PhraseKind.NOUN, named, words, named)
