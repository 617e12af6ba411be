"""Which way a command leads before it says what is meant: "turn around, walk forward, then go left to the sink".

The turns and steps that are told are walked on paper, each step as long as another. Where that ends lies what is
meant, seen from where the robot stood when it was told.
"""

from __future__ import annotations

import functools
import math
import re

from dcg_torch.names.normal_form import read_data
from dcg_torch.names.vocabulary import LED
from dcg_torch.types import ParseTree, Phrase, PhraseKind

_REACH = 0.5
"""How far what is meant lies ahead of where a way ends, in steps."""
_SIDES = {"left": math.pi / 2.0, "right": -math.pi / 2.0}
_YOU = ParseTree(Phrase(PhraseKind.NOUN, "you", (), "you"))
_LED = re.compile(r"led (\d+) degrees to the (left|right) of")


def led_along(tree: ParseTree, told: ParseTree, text: str) -> ParseTree:
    """A tree whose noun phrase lies where the way leads that a text tells before it names that; else the very tree.

    Args:
        told: the tree as the parser has it: its phrases are those of the text.
        text: as it was said.
    """
    way = way_of(_before(told, text.lower()))
    if way is None:
        return tree
    degrees = round(math.degrees(way))
    phrase = f"led {abs(degrees)} degrees to the {'left' if degrees >= 0 else 'right'} of"
    return _with(tree, ParseTree(Phrase(PhraseKind.PREPOSITION, phrase, (LED,)), (_YOU,)))


def said_way(phrase: Phrase) -> float:
    """The angle that a phrase of `led_along` states, in radians to the left of straight ahead.

    Raises:
        ValueError: it states none.
    """
    found = _LED.fullmatch(phrase.text)
    if found is None:
        raise ValueError(f"no way is said by {phrase.text!r}")
    return math.copysign(math.radians(int(found[1])), _SIDES[found[2]])


def _with(tree: ParseTree, place: ParseTree) -> ParseTree:
    """A tree with a place that its first noun phrase is at."""
    if tree.phrase.kind is PhraseKind.NOUN:
        return ParseTree(tree.phrase, (*tree.children, place))
    for k, child in enumerate(tree.children):
        if any(node.phrase.kind is PhraseKind.NOUN for node in child.walk()):
            changed = (*tree.children[:k], _with(child, place), *tree.children[k + 1 :])
            return ParseTree(tree.phrase, changed)
    return tree


def _before(tree: ParseTree, text: str) -> str:
    """A text up to where the verb of a tree takes its noun phrase; the side that stands before that is none of a way's.

    Where either is not in the text that is empty.
    """
    noun = next((node.phrase.text for node in tree.walk() if node.phrase.kind is PhraseKind.NOUN), "")
    verb = re.search(rf"\b{re.escape(tree.phrase.text.lower())}\b", text) if tree.phrase.text else None
    named = re.compile(rf"\b{re.escape(noun.lower())}\b").search(text, verb.end()) if noun and verb else None
    return text[: named.start()] if named else ""


@functools.lru_cache(maxsize=1024)
def way_of(text: str) -> float | None:
    """The angle at which the end of a way lies, in radians to the left of straight ahead; None where none is told.

    >>> round(math.degrees(way_of("turn around, walk forward, ")))
    180
    >>> round(math.degrees(way_of("go right, then turn left and walk to ")))
    -34
    >>> way_of("take the cup on the right of ")
    """
    heading, x, y, told = 0.0, 0.0, 0.0, False
    turn, again, steps, onward, apart = _patterns()
    for part in apart.split(text):
        at = 0
        for found in (*turn.finditer(part), *(again.finditer(part) if told else ())):
            before = steps.search(part, at, found.start()) is not None
            x, y = (x + before * math.cos(heading), y + before * math.sin(heading))
            side = found.groupdict().get("side")
            heading += math.pi if side is None else _SIDES[side]
            goes = bool(found.groupdict().get("goes"))
            x, y = (x + goes * math.cos(heading), y + goes * math.sin(heading))
            at, told = found.end(), True
        goes = steps.search(part, at) is not None
        x, y = (x + goes * math.cos(heading), y + goes * math.sin(heading))
        told = told or onward.search(part) is not None
    x, y = x + _REACH * math.cos(heading), y + _REACH * math.sin(heading)
    return math.atan2(y, x) if told and math.hypot(x, y) > _REACH / 2.0 else None


@functools.cache
def _patterns() -> tuple[re.Pattern[str], re.Pattern[str], re.Pattern[str], re.Pattern[str], re.Pattern[str]]:
    """What turns, a side by itself behind a turn, what goes, what goes on as it is headed, and what parts a text."""
    data = read_data("ways.yaml")
    side = rf"(?P<side>left|right)\b(?=\s*(?:{data['followed']}))"
    aside = rf"(?:(?P<goes>{data['goes']})|{data['turns']}) (?:{data['between']} )*{side}"
    about = rf"{data['about']}\b(?=\s*(?:{data['followed']}))|turn (?:by )?180\b"
    return (
        re.compile(rf"\b(?:{about}|{aside})"),
        re.compile(rf"^\s*(?:(?:again|another|a|immediately) )*{side}"),
        re.compile(rf"\b{data['steps']}\b"),
        re.compile(rf"\b{data['onward']}\b"),
        re.compile(data["apart"]),
    )
