"""Where a text names the marks of a scene ("the coke one", "block number twelve"), and where it counts or talks."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Final

from dcg_torch.english.forms import parts
from dcg_torch.names.evidence import unheard_of
from dcg_torch.names.keys import OF_KEY, is_worn
from dcg_torch.names.marks import MARK_WORDS, WORD, Mark, Marks, mark_words
from dcg_torch.names.normal_form import normalise, singular
from dcg_torch.names.palette import color_words

_NAME: Final = 2  # letters of a name
_BEFORE_COLOR: Final = frozenset(["a", "an", "the", "all", "dark", "light", "bright"])
_WORN_IN: Final = frozenset(["in", "wearing", "wears", "wear", "with", "has"])
_SHORTENED: Final = ("no", "nr", "num")


@dataclass(frozen=True)
class FoundMark:
    """A mark in a text: from one letter to another, what was said of its class and what it names."""

    start: int
    stop: int
    text: str
    mark: Mark
    noun: str | None
    plural: bool


def find_marks(text: str, marks: Marks) -> list[FoundMark]:
    """The marks that a text names, from left to right, each with the words that belong to it."""
    return _Finder(text, marks).found()


class _Finder:
    """Finds the marks that a text names, with the words that belong to them."""

    def __init__(self, text: str, marks: Marks) -> None:
        self.marks = marks
        self.tokens = list(WORD.finditer(text))
        self.raw = [match.group() for match in self.tokens]
        self.words = [word.lower() for word in self.raw]
        self.text = text

    def found(self) -> list[FoundMark]:
        """From left to right."""
        out: list[FoundMark] = []
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

    def _at(self, i: int) -> tuple[int, int, FoundMark] | None:
        """The mark that begins at a word: the first and the last of the words that belong to it."""
        for n in range(min(MARK_WORDS, len(self.words) - i), 0, -1):
            if self.words[i] == "ones" or (n > 1 and not self._joined(i, i + n)):
                continue
            owned = self.words[i + n - 1].endswith("'s")
            mark = self.marks.named(self.words[i : i + n])
            if mark is None and owned:
                mark = self.marks.named([*self.words[i : i + n - 1], self.words[i + n - 1][:-2]])
            other = self._is_place(i, n) or self._is_verb(i, n) or self._is_own_color(i, n, mark)
            if mark is not None and not other and (not mark.short or self._is_name(i, i + n)):
                return self._extended(i, i + n, mark, owned)
        missing = self.marks.missing(self.words[i]) if self._may_be_missing(i) else None
        return None if missing is None else self._extended(i, i + 1, missing, False)

    def _may_be_missing(self, i: int) -> bool:
        """Is a word a name that none there bears: "15" where there are 14, "Pepsi" among other logos?"""
        word, lists = self.words[i], mark_words()
        if word.isdecimal() or word in lists["numbers"]:
            return word != "ones" and self._is_name(i, i + 1)
        plain = word in self.marks.heads | lists["carriers"] | lists["common"] | lists["before"] | lists["after"]
        titles = sum(raw[0].isupper() for raw in self.raw)
        if (
            plain
            or len(word) < _NAME
            or not word.isalpha()
            or not self.raw[i][0].isupper()
            or 2 * titles > len(self.raw) > 3
        ):
            return False
        begins = i == 0 or not set(".,;:!?").isdisjoint(self.text[self.tokens[i - 1].end() : self.tokens[i].start()])
        if begins and self.word(i + 1) in lists["moves"] and "n" in parts(word):
            return True
        return (unheard_of(word) and not parts(word)) or (not begins and self.words[i - 1] not in ("the", "to", "of"))

    def _is_place(self, i: int, n: int) -> bool:
        """Is it a place and no shape: "in the corner", "the top right corner"?"""
        lists, before = mark_words(), self.word(i - 1)
        if n > 1 or self.words[i] not in lists["places"]:
            return False
        return before in lists["sides"] or (before == "the" and self.word(i - 2) in lists["before_place"])

    def _is_own_color(self, i: int, n: int, mark: Mark | None) -> bool:
        """Is it the colour of a thing and not of what somebody wears: "the red car", but "in red", "wearing red"?"""
        if n > 1 or mark is None or mark.word is None or normalise(self.words[i]) not in color_words().basic:
            return False
        before = next((word for word in reversed(self.words[:i]) if word not in _BEFORE_COLOR), "")
        return is_worn(mark.word.partition(OF_KEY)[0]) and before not in _WORN_IN

    def _is_verb(self, i: int, n: int) -> bool:
        """Is it the verb of an order: "mark the pepsi block", "will you ..."; not in "Target to the left"?"""
        lists, before, after = mark_words(), self.word(i - 1), self.word(i + n)
        stops = set(self.text[self.tokens[i - 1].end() : self.tokens[i].start()]) if i else set(".")
        begins = not stops.isdisjoint(".,;:!?") or before in lists["before_verb"]
        begins = begins or (before == "to" and self.word(i - 2) in lists["before_infinitive"])
        followed = after in lists["before_noun"] or (bool(after) and self.marks.named([after]) is not None)
        return n == 1 and begins and followed and self._joined(i, i + 2) and "v" in parts(self.words[i])

    def _joined(self, start: int, stop: int) -> bool:
        """Are words apart by spaces or hyphens alone?"""
        ends = zip(self.tokens[start : stop - 1], self.tokens[start + 1 : stop], strict=True)
        return all(
            set(self.text[one.end() : other.start()]) <= set(" -_'#" + "." * (one.group().lower() in _SHORTENED))
            for one, other in ends
        )

    def _is_name(self, i: int, stop: int) -> bool:
        """Is a number or a letter a name here, and no count and no word of its own?"""
        lists, before, after = mark_words(), self.word(i - 1), self.word(stop)
        if (
            self.words[i] == "ones"
            or (before in lists["lines"] and not (before == "line" and after == "up"))
            or (before in lists["before"] and self.word(i - 2) in lists["lines"])
        ):
            return False
        if i == 0 and self.words[i].isalpha() and len(self.words[i]) > 1 and after in lists["ways"]:
            return False
        introduced = before in lists["before"] or singular(before) in self.marks.heads or self._hashed(i)
        if introduced and not (before in self.marks.heads and after in lists["units"]):
            return self._joined(i - 1, i + 1) if before else True
        if self.words[i].isalpha() and len(self.words[i]) == 1:
            return self._is_letter(i)
        plural = singular(after) != after and singular(after) in self.marks.heads
        suited = after == "of" and self.marks.named([self.word(stop + 1)]) is not None  # "the nine of spades"
        if (
            (after in lists["units"] and not suited)
            or plural
            or (before in lists["counted_after"] and not (before == "both" and after == "and"))
        ):
            return False
        if self.words[i] == "one":
            ends = after not in self.marks.heads | lists["after"] or not after
            return ends and (i == 0 or before in lists["before_one"])
        counted = before in ("the", "this", "that", "only", "single") and self.words[i] in ("two", "three", "four")
        told_before = "." in self.text[: self.tokens[i].start()]  # "there are three cubes. take the three"
        counted = counted and not suited and (bool(after) or told_before)
        return self.raw[i].isdecimal() or not counted or after in self.marks.heads

    def _hashed(self, i: int) -> bool:
        start = self.tokens[i].start()
        return start > 0 and self.text[start - 1] == "#"

    def _is_letter(self, i: int) -> bool:
        """Is a letter by itself a name, and neither an article nor the speaker?"""
        word, before, after = self.words[i], self.word(i - 1), self.word(i + 1)
        if word == "a":
            ends = not after or self.tokens[i].end() != self.tokens[i + 1].start() - 1  # "the red a, please"
            capital = self.raw[i] == "A" and not self.text.isupper()
            return bool(before) and (capital or ends or before == "the")
        if word == "i":
            return (
                bool(before)
                and after not in mark_words()["speaker_after"]
                and before not in mark_words()["speaker_before"]
            )
        return True

    def _extended(self, i: int, stop: int, mark: Mark, owned: bool) -> tuple[int, int, FoundMark]:
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
        return first, stop, FoundMark(0, 0, " ".join(self.raw[first:stop]), mark, noun, plural)

    def _links(self, at: int, owned: bool) -> bool:
        """Is a word the "beer" of "the stella beer sign", or the "bird" of "twitter's bird cube"?"""
        word, after = self.words[at], self.word(at + 1)
        ends = mark_words()["linked"] | (self.marks.heads if owned else frozenset())
        plain = len(word) > 2 and word not in mark_words()["before_one"] | mark_words()["common"]
        return plain and after in ends and self._joined(at, at + 2) and self.marks.named([word]) is None
