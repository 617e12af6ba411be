"""Commands that call things by their marks: "starbucks", "block 7", "the T", "the one with the Target logo".

A parser knows no such names, and takes many of them for verbs, numbers or letters. So each is put as a noun that is
nothing else ("quorba") before a command is read, together with what stands beside it ("the coke one"). In the trees
that come back the noun is what it stood for: a word of its phrase such as "brand: coca cola", beside the class
that was said. Only the marks of the scene are put so: where there are none, a command is read as ever.
"""

from __future__ import annotations

import dataclasses
import functools
import re
from collections.abc import Callable, Collection, Iterable, Sequence
from dataclasses import replace
from typing import Any, Final, TypeVar

from dcg_torch.interpretation.mark_finder import FoundMark, find_marks
from dcg_torch.interpretation.parser_protocol import ParsedCommand
from dcg_torch.interpretation.people import of_people
from dcg_torch.interpretation.turns import in_one_voice
from dcg_torch.names.attributes import attribute_evidence
from dcg_torch.names.color_names import color_evidence
from dcg_torch.names.keys import OF_KEY
from dcg_torch.names.marks import OF_CLASS, Marks, is_strange, mark_words, marks_of, words_of
from dcg_torch.names.normal_form import singular
from dcg_torch.names.relations import listed
from dcg_torch.types import LOOKED_ROUND, NOT, OPAQUE, Object, ParseTree, Percept, Phrase, PhraseKind

_Parsed = TypeVar("_Parsed", bound=ParsedCommand)
_LONGEST: Final = 1000  # characters of a text whose marks are looked for; longer ones are no commands
_STAND_IN: Final = "quorb"
_STAND_INS: Final = tuple(f"{_STAND_IN}{one}{two}" for two in "bcdfgklmnpqrtvw" for one in "abcdefghijklmnopqrstuvwxyz")
"""More than a command has words; with another letter at their ends they might be plurals of one another."""
_BEARING = listed("bears")


def heard(
    parse: Callable[[str, Collection[str]], _Parsed],
    text: str,
    vocabulary: Collection[str],
    things: Iterable[Object | Percept],
) -> _Parsed:
    """What a parser makes of a command in a scene, whose marks it need not know.

    Args:
        parse: reads commands.
        vocabulary: the words that are known.
        things: what is there.
    """
    things = tuple(o for o in things if not (isinstance(o, Object) and o.hypothetical))
    text = of_people(in_one_voice(text), things)
    marks = marks_of((_class(o), frozenset(a for a in o.attributes if a != LOOKED_ROUND)) for o in things)
    if marks is None or len(text) > _LONGEST or _STAND_IN in text.lower():
        return parse(text, vocabulary)
    stood = dict(zip(_STAND_INS, find_marks(text, marks), strict=False))
    several = {stand_in for stand_in, one in stood.items() if sum(_bears(thing, one) for thing in things) > 1}
    spoken = _in_order(_replaced(text, stood), stood, marks.heads, several) if stood else text
    words = [*vocabulary, *stood, *(f"{s}s" for s in stood)] if stood else vocabulary
    read = parse(spoken, words)
    if not all(map(dataclasses.is_dataclass, (read, *read.readings))):
        return parse(text, vocabulary)  # a parser of somebody else, whose trees cannot be put back
    restored: _Parsed = _Restored(marks, stood, things, text).command(read)
    return restored


def _class(thing: Object | Percept) -> str | None:
    return None if thing.type is None or thing.type.startswith(OPAQUE) else thing.type


def _replaced(text: str, stood: dict[str, FoundMark]) -> str:
    parts, at = [], 0
    for stand_in, one in stood.items():
        before = text[at : one.start]
        words = words_of(before)
        bare = not words or re.search(r"[.,;:!?]\s*$", before) or words[-1] in mark_words()["before_one"]
        parts += [before, "the " if bare and not one.plural else "", stand_in, "s" if one.plural else ""]
        at = one.stop
    return "".join([*parts, text[at:]])


@functools.lru_cache(maxsize=256)
def _patterns(name: str, heads: frozenset[str] = frozenset()) -> tuple[tuple[re.Pattern[str], str], ...]:
    """Of `data/marks.yaml`, with what they are replaced by; `heads` are the names of classes."""
    rows = mark_words()["patterns"][name]
    rows = [[rows, ""]] if isinstance(rows, str) else rows
    bearers = "|".join(("one", "thing", *sorted(heads | mark_words()["carriers"])))
    filled = [(old.replace("<M>", rf"{_STAND_IN}\w\w").replace("<HEADS>", bearers), new) for old, new in rows]
    return tuple((re.compile(old, re.IGNORECASE), new) for old, new in filled)


def _bears(thing: Object | Percept, one: FoundMark) -> bool:
    stated = () if one.mark.word is None else (one.mark.word,)
    if stated and attribute_evidence(stated, thing.attributes) != ("attribute: equal",):
        return False
    return bool(stated) or thing.type in one.mark.classes


def _in_order(text: str, stood: dict[str, FoundMark], heads: frozenset[str], several: set[str]) -> str:
    """ "The block with quorba" is quorba, a block; "quorba should be above quorbb" is an order about the first.

    "The quorba to the left of quorbb" is none where `several` things are called so: it says which of them.
    """
    for old, new in _patterns("rewrite"):
        text = old.sub(new, text)

    def borne(match: re.Match[str]) -> str:
        head, stand_in = match.group(1).lower(), match.group(2)
        if _patterns("aligned")[0][0].search(text[: match.start()]):
            return match.group()
        stood[stand_in] = replace(stood[stand_in], noun=head if head in heads else stood[stand_in].noun)
        return stand_in

    text = _patterns("bearing", heads)[0][0].sub(borne, text)

    def moved(match: re.Match[str]) -> str:
        which = match.group().endswith("to ") and not several.isdisjoint(words_of(match.group(3)))
        return match.group() if which else match.expand(r"\1take \2\3 and put it ")

    return _patterns("moved")[0][0].sub(moved, text)


class _Restored:
    """Puts back what stands for marks in what a parser has read."""

    def __init__(
        self, marks: Marks, stood: dict[str, FoundMark], things: Sequence[Object | Percept], text: str
    ) -> None:
        self.marks, self.stood, self.text = marks, stood, text
        self.things = [o for o in things if o.type is not None]
        self.types = {o.type for o in self.things if o.type is not None}

    def command(self, read: Any) -> Any:
        """The command as it was said, and its readings: all dataclasses."""
        readings: tuple[Any, ...] = tuple(dataclasses.replace(r, tree=self.tree(r.tree)) for r in read.readings)
        if all(hasattr(r, "unread") for r in readings):
            readings = tuple(dataclasses.replace(r, unread=tuple(map(self.said, r.unread))) for r in readings)
        return dataclasses.replace(read, text=self.text, readings=readings)

    def tree(self, tree: ParseTree) -> ParseTree:
        """A node and all below it."""
        children = [self.tree(child) for child in tree.children]
        if tree.phrase.kind is not PhraseKind.NOUN:
            spoken = tuple(map(self.said, tree.phrase.words))
            return ParseTree(replace(tree.phrase, text=self.said(tree.phrase.text), words=spoken), tuple(children))
        phrase = self.phrase(tree.phrase)
        own = any(OF_KEY in word for word in phrase.words)
        kept: list[ParseTree] = []
        words: list[str] = []
        for child in children:
            borne = () if own else _borne(child)
            words += borne
            if not borne:
                kept.append(child)
        phrase = replace(phrase, words=tuple(dict.fromkeys((*phrase.words, *words))))
        if self._is_unique(phrase):
            kept = [child for child in kept if child.phrase.kind is not PhraseKind.PREPOSITION]
        return ParseTree(phrase, tuple(kept))

    def said(self, text: str) -> str:
        """A text in which marks stand as they were said."""
        for stand_in, one in self.stood.items():
            text = text.replace(f"{stand_in}s" if one.plural else stand_in, one.text)
        return text

    def of(self, word: str) -> FoundMark | None:
        """The mark that a word stands for."""
        return self.stood.get(word) or self.stood.get(word.removesuffix("s"))

    def marked(self, words: Iterable[str]) -> list[FoundMark]:
        """The marks that some words, which may be several in one, stand for."""
        return [one for word in words for part in word.split(" ") if (one := self.of(part)) is not None]

    def phrase(self, phrase: Phrase) -> Phrase:
        """A noun phrase whose noun and words say what is said of the marks."""
        noun = phrase.noun
        spoken = (noun or "").split(" ")
        denied = [word for word in phrase.words if word.startswith(f"{NOT} ")]
        others = [word for word in phrase.words if word not in denied]
        marked = self.marked([*others, *spoken])
        words = [f"{NOT} {one.mark.word}" for one in self.marked(denied) if one.mark.word]
        words += [one.mark.word for one in marked if one.mark.word]
        plain = tuple(word for word in phrase.words if not self.marked([word]))
        phrase = replace(phrase, words=plain)
        if marked:
            left = [word for word in spoken if self.of(word) is None]
            noun = " ".join(left) or marked[-1].noun
            noun = marked[-1].mark.classes[0] if marked[-1].mark.classes else noun
        elif noun is not None and self._bears_any(noun):
            noun = None
        elif noun is not None:
            number = next(
                (word for word in phrase.words if word.isdecimal() and singular(noun) in self.marks.heads), ""
            )
            phrase = replace(phrase, words=tuple(word for word in plain if word != number))
            noun, strange = self._without_strange_mark(f"{number} {noun}".strip())
            words += strange
        text = self.said(phrase.text)
        return replace(phrase, text=text, noun=noun, words=tuple(dict.fromkeys((*phrase.words, *words))))

    def _bears_any(self, noun: str) -> bool:
        """Is it "the block", "the logo" where the classes are the marks themselves, "shell", "7"? Each is one."""
        bare = self.marks.heads == mark_words()["carriers"]
        return bare and noun in mark_words()["carriers"] | mark_words()["after"] and noun not in self.types

    def _without_strange_mark(self, noun: str) -> tuple[str, list[str]]:
        """Of "pepsi block" where no block has that mark: it is a block, and none that is there."""
        *before, head = noun.split(" ")
        strange = bool(before) and (all(map(is_strange, before)) or self._is_name(before[0]))
        strange = strange and not any({*before} <= {*words_of(type_)} for type_ in self.types)
        if not (strange and singular(head) in self.marks.heads):
            return noun, []
        key = self.marks.keys[0] if self.marks.keys else OF_CLASS
        return head, [f"{key}{OF_KEY}{' '.join(before)}"]

    def _is_name(self, word: str) -> bool:
        return re.search(rf"(?<=[a-z,] ){re.escape(word.capitalize())}\b", self.text) is not None

    def _is_unique(self, phrase: Phrase) -> bool:
        """Does a phrase with a mark name one thing there by its name and its colour alone?"""
        stated = [word for word in phrase.words if OF_KEY in word]
        named = not stated and phrase.noun in self.types and any(one.mark.classes for one in self.stood.values())
        if not stated and not named:
            return False
        return sum(self._is_said(phrase, stated, thing) for thing in self.things) == 1

    def _is_said(self, phrase: Phrase, stated: Sequence[str], thing: Object | Percept) -> bool:
        if stated and attribute_evidence(stated, thing.attributes) != ("attribute: equal",):
            return False
        if not stated and phrase.noun != thing.type:
            return False
        if phrase.color is None or thing.color is None:
            return phrase.color is None
        return bool(
            {"color: equal", "color: same hue", "color: alike"} & set(color_evidence(phrase.color, thing.color))
        )


def _borne(place: ParseTree) -> tuple[str, ...]:
    """The marks that a prepositional phrase says a thing bears: "with the Target logo"."""
    if place.phrase.kind is not PhraseKind.PREPOSITION or place.phrase.words[:1] == ():
        return ()
    if place.phrase.words[0] not in _BEARING or len(place.children) != 1 or place.children[0].phrase.noun is not None:
        return ()
    return tuple(word for word in place.children[0].phrase.words if OF_KEY in word)
