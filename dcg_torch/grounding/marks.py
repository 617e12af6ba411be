"""Commands that call things by their marks: "starbucks", "block 7", "the T", "the one with the Target logo".

A parser knows no such names, and takes many of them for verbs, numbers or letters. So each is put as a noun that is
nothing else ("quorba") before a command is read, together with what stands beside it ("the coke one"). In the trees
that come back the noun is what it stood for: a word of its phrase such as "brand: coca cola", beside the class
that was said. Only the marks of the scene are put so: where there are none, a command is read as ever.
"""

from __future__ import annotations

import dataclasses
import re
from collections.abc import Collection, Iterable, Sequence
from dataclasses import dataclass, replace
from typing import Any, Final

from dcg_torch.grounding.spoken import CommandParser, ParsedCommand
from dcg_torch.names.attributes import OF_KEY, attribute_evidence, color_evidence
from dcg_torch.names.evidence import unheard_of
from dcg_torch.names.marks import Mark, Marks, mark_words, marks_of
from dcg_torch.names.normal import singular
from dcg_torch.types import LOOKED_ROUND, Object, ParseTree, Percept, Phrase, PhraseKind

_TOKEN: Final = re.compile(r"\d+(?:\.\d+|[^\W\d_]+)?|[^\W\d_]+(?:'[^\W\d_]+)?")
_STAND_INS: Final = tuple(f"quorb{letter}" for letter in "abcdefghijklmnopqrstuvwxyz")
_JOINED: Final = 4
_VERBS = r"(?:(?:should|must|ought to|needs? to|ha(?:s|ve) to|wants? to|shall|will|can|is to|are to)(?: be| go| get| come)?"
_MOVED: Final = re.compile(
    rf"(^|[.!;:] )((?:and |now |ok |okay |then |the |both )*)((?:quorb\w,? (?:and |, ?)?(?:the )?)*quorb\w),? "
    rf"(?:both |all |please )?(?:{_VERBS}|goes|go|moves|belongs?|to\b(?= (?:be|go|the|directly|just))|-+>|=+>|:)(?: be(?= )| go(?= ))?) "
)
_SAYS: Final = re.compile(
    r"\b(?:(?:that|which) (?:says?|reads?|shows?|has|is(?: labell?ed| marked| called)?)|say(?:s|ing)|reading|showing"
    r"|labell?ed|marked|numbered|called|named|in the (?:shape|form) of|shaped (?:like|as)|that looks? like|that s)"
    r"(?: as| with| by)?(?: the| a| an)?(?= (?:quorb\w)\b)"
)
_LINED: Final = re.compile(r"\bline (?:up )?((?:the )?quorb\w)(?: up)? with\b", re.I)
_ALIGNED: Final = re.compile(r"\b(?:line|align|swap|switch|level|even|trade|exchange)\b", re.I)
_OF_CLASS = "class"
"""The key of marks that are parts of the names of classes."""
_BEARING = frozenset({"with", "of", "have"})


@dataclass(frozen=True)
class _Found:
    """A mark in a text: from one letter to another, what was said of its class and what it names."""

    start: int
    stop: int
    text: str
    mark: Mark
    noun: str | None
    plural: bool


def heard(
    parse: CommandParser, text: str, vocabulary: Collection[str], things: Iterable[Object | Percept]
) -> ParsedCommand:
    """What a parser makes of a command in a scene, whose marks it need not know.

    Args:
        parse: reads commands.
        vocabulary: the words that are known.
        things: what is there.
    """
    things = tuple(things)
    marks = marks_of((o.type, frozenset(a for a in o.attributes if a != LOOKED_ROUND)) for o in things)
    if marks is None:
        return parse(text, vocabulary)
    found = _Finder(text, marks).found()[: len(_STAND_INS)]
    stood = {stand_in: one for stand_in, one in zip(_STAND_INS, found, strict=False)}
    spoken = _in_order(_replaced(text, stood), stood, marks.heads) if found else text
    words = [*vocabulary, *stood, *(f"{s}s" for s in stood)] if found else vocabulary
    return _Restored(marks, stood, things, text).command(parse(spoken, words))


def _replaced(text: str, stood: dict[str, _Found]) -> str:
    parts, at = [], 0
    for stand_in, one in stood.items():
        before = text[at : one.start]
        words = _TOKEN.findall(before.lower())
        bare = not words or re.search(r"[.,;:!?]\s*$", before) or words[-1] in mark_words()["before_one"]
        parts += [before, "the " if bare and not one.plural else "", stand_in, "s" if one.plural else ""]
        at = one.stop
    return "".join([*parts, text[at:]])


def _in_order(text: str, stood: dict[str, _Found], heads: frozenset[str]) -> str:
    """ "The block with quorba" is quorba, a block; "quorba should be above quorbb" is an order about the first."""
    text = _LINED.sub(r"put \1 in line with", _SAYS.sub("with", text))
    bearers = "|".join(("one", "thing", *sorted(heads)))
    bearing = re.compile(rf"\b({bearers}) (?:with|bearing|having)(?: the| a| an)? (quorb\w)\b(?: on (?:it|top|them))?", re.I)

    def borne(match: re.Match[str]) -> str:
        head, stand_in = match.group(1).lower(), match.group(2)
        if _ALIGNED.search(text[: match.start()]):
            return match.group()
        stood[stand_in] = replace(stood[stand_in], noun=head if head in heads else stood[stand_in].noun)
        return stand_in

    return _MOVED.sub(r"\1take \2\3 and put it ", bearing.sub(borne, text))


class _Finder:
    """Finds the marks that a text names, with the words that belong to them."""

    def __init__(self, text: str, marks: Marks) -> None:
        self.marks = marks
        self.tokens = list(_TOKEN.finditer(text))
        self.raw = [match.group() for match in self.tokens]
        self.words = [word.lower() for word in self.raw]
        self.text = text

    def found(self) -> list[_Found]:
        """From left to right."""
        out: list[_Found] = []
        i = 0
        while i < len(self.words):
            one = self._at(i)
            if one is None:
                i += 1
                continue
            first, last, of = one
            before = out[-1].stop if out else 0
            while self.tokens[first].start() < before:
                first += 1
            out.append(replace(of, start=self._begin(first, before), stop=self.tokens[last - 1].end()))
            i = last
        return out

    def word(self, i: int) -> str:
        """The i-th, empty outside the text or behind a stop."""
        return self.words[i] if 0 <= i < len(self.words) else ""

    def _begin(self, first: int, before: int) -> int:
        start = self.tokens[first].start()
        return start - 1 if start > before and self.text[start - 1] == "#" else start

    def _at(self, i: int) -> tuple[int, int, _Found] | None:
        """The mark that begins at a word: the first and the last of the words that belong to it."""
        for n in range(min(_JOINED, len(self.words) - i), 0, -1):
            if n > 1 and not self._joined(i, i + n):
                continue
            owned = self.words[i + n - 1].endswith("'s")
            mark = self.marks.named(self.words[i : i + n])
            if mark is None and owned:
                mark = self.marks.named([*self.words[i : i + n - 1], self.words[i + n - 1][:-2]])
            if mark is not None and (not mark.short or self._is_name(i, i + n)):
                return self._extended(i, i + n, mark, owned)
        return None

    def _joined(self, start: int, stop: int) -> bool:
        """Are words apart by spaces or hyphens alone?"""
        ends = zip(self.tokens[start : stop - 1], self.tokens[start + 1 : stop], strict=True)
        return all(set(self.text[one.end() : other.start()]) <= set(" -_'#") for one, other in ends)

    def _is_name(self, i: int, stop: int) -> bool:
        """Is a number or a letter a name here, and no count and no word of its own?"""
        lists, before, after = mark_words(), self.word(i - 1), self.word(stop)
        introduced = before in lists["before"] or singular(before) in self.marks.heads or self._hashed(i)
        if introduced and not (before in self.marks.heads and after in lists["units"]):
            return self._joined(i - 1, i + 1) if before else True
        if self.words[i].isalpha() and len(self.words[i]) == 1:
            return self._is_letter(i)
        plural = singular(after) != after and singular(after) in self.marks.heads
        if after in lists["units"] or after == "of" or plural or before in lists["counted_after"]:
            return False
        if self.words[i] == "one":
            ends = after not in self.marks.heads | lists["after"] or not after
            return ends and (i == 0 or before in lists["before_one"])
        counted = before in ("the", "this", "that", "only", "single") and self.words[i] in ("two", "three", "four")
        return self.raw[i].isdecimal() or not counted or after in self.marks.heads

    def _hashed(self, i: int) -> bool:
        start = self.tokens[i].start()
        return start > 0 and self.text[start - 1] == "#"

    def _is_letter(self, i: int) -> bool:
        """Is a letter by itself a name, and neither an article nor the speaker?"""
        word, before, after = self.words[i], self.word(i - 1), self.word(i + 1)
        if word == "a":
            return self.raw[i] == "A" and bool(before) and not self.text.isupper()
        if word == "i":
            return bool(before) and after not in mark_words()["speaker_after"] and before not in mark_words()["speaker_before"]
        return True

    def _extended(self, i: int, stop: int, mark: Mark, owned: bool) -> tuple[int, int, _Found]:
        """With the class and the words for marks that stand beside a mark."""
        lists, heads = mark_words(), self.marks.heads
        noun: str | None = None
        plural, first = mark.plural, i
        while first > 0 and self._joined(first - 1, first + 1) and not (mark.plural and first < i):
            word = self.words[first - 1]
            if word in lists["before"]:
                first -= 1
            elif singular(word) in heads and noun is None and self.word(stop) not in heads:
                noun, first = singular(word), first - 1
            else:
                break
        while stop < len(self.words) and self._joined(stop - 1, stop + 1):
            word = self.words[stop]
            if word in lists["after"] and not (mark.short and word in ("one", "ones") and self.raw[i].isdecimal()):
                plural = plural or word in ("ones", "logos", "labels", "signs")
                stop += 1
            elif singular(word) in heads and noun is None:
                noun, plural, stop = singular(word), plural or singular(word) != word, stop + 1
            elif self._links(stop, owned):
                stop += 1
            else:
                break
        return first, stop, _Found(0, 0, " ".join(self.raw[first:stop]), mark, noun, plural)

    def _links(self, at: int, owned: bool) -> bool:
        """Is a word the "beer" of "the stella beer sign", or the "bird" of "twitter's bird cube"?"""
        word, after = self.words[at], self.word(at + 1)
        ends = mark_words()["linked"] | (self.marks.heads if owned else frozenset())
        plain = len(word) > 2 and word not in mark_words()["before_one"] | mark_words()["common"]
        return plain and after in ends and self._joined(at, at + 2) and self.marks.named([word]) is None


class _Restored:
    """Puts back what stands for marks in what a parser has read."""

    def __init__(self, marks: Marks, stood: dict[str, _Found], things: Sequence[Object | Percept], text: str) -> None:
        self.marks, self.stood, self.text = marks, stood, text
        self.things = [o for o in things if o.type is not None]
        self.types = {o.type for o in self.things if o.type is not None}

    def command(self, read: ParsedCommand) -> ParsedCommand:
        """The command as it was said, and its readings."""
        readings = [dataclasses.replace(_value(r), tree=self.tree(r.tree)) for r in read.readings]
        kept: dict[str, Any] = {"text": self.text, "readings": tuple(readings)}
        return dataclasses.replace(_value(read), **kept)  # type: ignore[no-any-return]

    def tree(self, tree: ParseTree) -> ParseTree:
        """A node and all below it."""
        children = [self.tree(child) for child in tree.children]
        if tree.phrase.kind is not PhraseKind.NOUN:
            return ParseTree(replace(tree.phrase, text=self.said(tree.phrase.text)), tuple(children))
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
            text = text.replace(stand_in, one.text)
        return text

    def phrase(self, phrase: Phrase) -> Phrase:
        """A noun phrase whose noun and words say what is said of the marks."""
        words: list[str] = []
        noun = phrase.noun
        spoken = (noun or "").split(" ")
        marked = [self.stood[word] for word in spoken if word in self.stood]
        for one in marked:
            words += [one.mark.word] if one.mark.word else []
        if marked:
            left = [word for word in spoken if word not in self.stood]
            noun = " ".join(left) or marked[-1].noun
            noun = marked[-1].mark.classes[0] if marked[-1].mark.classes else noun
        elif noun is not None:
            number = next((word for word in phrase.words if word.isdecimal() and singular(noun) in self.marks.heads), "")
            phrase = replace(phrase, words=tuple(word for word in phrase.words if word != number))
            noun, words = self._without_strange_mark(f"{number} {noun}".strip())
        text = self.said(phrase.text)
        return replace(phrase, text=text, noun=noun, words=tuple(dict.fromkeys((*phrase.words, *words))))

    def _without_strange_mark(self, noun: str) -> tuple[str, list[str]]:
        """Of "pepsi block" where no block has that mark: it is a block, and none that is there."""
        *before, head = noun.split(" ")
        strange = bool(before) and (all(map(_is_strange, before)) or self._is_name(before[0]))
        if not (strange and singular(head) in self.marks.heads):
            return noun, []
        key = self.marks.keys[0] if self.marks.keys else _OF_CLASS
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
        return bool({"color: equal", "color: same hue", "color: alike"} & set(color_evidence(phrase.color, thing.color)))


def _is_strange(word: str) -> bool:
    return word.isdecimal() or unheard_of(word)


def _borne(place: ParseTree) -> tuple[str, ...]:
    """The marks that a prepositional phrase says a thing bears: "with the Target logo"."""
    if place.phrase.kind is not PhraseKind.PREPOSITION or place.phrase.words[:1] == ():
        return ()
    if place.phrase.words[0] not in _BEARING or len(place.children) != 1 or place.children[0].phrase.noun is not None:
        return ()
    return tuple(word for word in place.children[0].phrase.words if OF_KEY in word)


def _value(read: Any) -> Any:
    """What a parser gives is a frozen value."""
    return read
