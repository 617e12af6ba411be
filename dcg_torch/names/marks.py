"""Marks: what is written or printed on things, by which they are called: logos, digits, letters, parts of class names.

A mark is a value of an attribute whose key says nothing of how a thing looks, stands or is made ("brand: Shell",
"digit: 7", "shape: T"), or what tells the classes of a scene apart where all have one head ("shell block", "block_7").
"""

from __future__ import annotations

import functools
import re
from collections import Counter
from collections.abc import Collection, Iterable, Iterator, Sequence
from dataclasses import dataclass
from typing import Any, Final

from rapidfuzz.distance import OSA

from dcg_torch.names.attribute_values import describes
from dcg_torch.names.evidence import evidence, unheard_of
from dcg_torch.names.keys import OF_KEY, attribute_key
from dcg_torch.names.normal_form import normalise, read_data, singular
from dcg_torch.names.palette import color_words, region
from dcg_torch.names.rooms import room_keys, room_named
from dcg_torch.names.vocabulary import SIDED, SYNONYMS

WORD: Final = re.compile(r"\d+(?:\.\d+|[^\W\d_]+)?|[^\W\d_]+(?:'[^\W\d_]+)?")
"""A word of a text or of a name: letters, or a number with its unit."""
MARK_WORDS: Final = 4  # words at most of a text that are one mark
_SPELT, _LONG = 5, 8  # letters from which one slip, and two, may be in a name
OF_CLASS: Final = "class"
"""The key of marks that are parts of the names of classes."""
_PART = 3  # letters of a part of a mark
_BOARD = 3  # classes at least that are told apart by marks
_MOST, _SOME = 0.8, 0.3  # share of them that have a word in common, or of those that are no words but names
_SHAPE = "shape"
_SHAPED = frozenset({"piece", "shape", "pentomino", "tetromino"})  # whose letters tell how they are shaped
_SAME = frozenset({"kind: everyday", "kind: same"})


@functools.cache
def mark_words() -> dict[str, Any]:
    """The lists of `data/marks.yaml`: sets of words, the numbers and the shapes."""
    data = read_data("marks.yaml")
    return {name: frozenset(value.split()) if isinstance(value, str) else value for name, value in data.items()}


@dataclass(frozen=True, slots=True)
class Mark:
    """What a text calls some things by.

    Attributes:
        word: what it says of their attributes, as "brand: shell"; None if it is part of the name of a class.
        classes: the names of these classes.
        short: was a number or a letter said?
        plural: are several of them spoken of: "crosses"?
    """

    word: str | None
    classes: tuple[str, ...] = ()
    short: bool = False
    plural: bool = False


@dataclass(frozen=True)
class Marks:
    """The marks of a scene, and what the things that bear them are called.

    Attributes:
        whole: how a mark may be written, without spaces -> its key and value.
        parts: a word of a mark of several -> the marks.
        full: a mark -> its words.
        spelt: the same with the "s" at their ends.
        heads: the last words of the classes.
        keys: those of attributes that are marks.
    """

    whole: dict[str, frozenset[tuple[str, str]]]
    parts: dict[str, frozenset[tuple[str, str]]]
    full: dict[tuple[str, str], str]
    spelt: frozenset[str]
    heads: frozenset[str]
    keys: tuple[str, ...]

    def named(self, words: Sequence[str]) -> Mark | None:
        """The mark that words (in small letters) name together; None if they name none."""
        last = words[-1].replace("'", "")
        several = last.endswith("s") and "".join([*words[:-1], last]).replace("'", "") not in self.spelt
        found = self.whole.get(solid_name(words)) or self.whole.get(solid_name([*words[:-1], _one(last)]))
        if found is None and len(words) == 1 and words[0] not in mark_words()["common"]:
            found = self.parts.get(solid_name(words)) or self._nearly(last)
            several = False
        return None if found is None else _mark(found, _is_short(words), several)

    def missing(self, word: str) -> Mark | None:
        """The mark that a word names where others of its kind are there, numbers or names, and it is not."""
        number = solid_name([word])
        alike = sum(name.isdecimal() == number.isdecimal() for name in self.full.values())
        if alike < max(_BOARD, _MOST * len(self.full)):
            return None
        key = self.keys[0] if self.keys else OF_CLASS
        return Mark(f"{key}{OF_KEY}{number if number.isdecimal() else word}", (), number.isdecimal())

    def _nearly(self, word: str) -> frozenset[tuple[str, str]] | None:
        """What a word means that is no name there: another name of one, or one with a slip."""
        if not word.isalpha() or len(word) < _PART or singular(word) in self.heads:
            return None
        if unheard_of(word):
            names = {name for name in (*self.whole, *self.parts) if misspells(word, name)}
            return frozenset(one for n in names for one in self.whole.get(n, self.parts.get(n, frozenset()))) or None
        return frozenset(one for one, name in self.full.items() if _means(word, name)) or None


def _one(word: str) -> str:
    """ "cross" of "crosses", "t" of "ts"; "is" and "as" are no letters."""
    return word[0] if len(word) == 2 and word[1] == "s" and word[0] not in "aiu" else singular(word)


def _is_short(words: Sequence[str]) -> bool:
    """Are these a number or a letter?"""
    numbers = mark_words()["numbers"]
    return all(word.isdecimal() or word in numbers for word in words) or len(words[0]) == len(words) == 1


def _mark(found: Collection[tuple[str, str]], short: bool, plural: bool) -> Mark:
    classes = tuple(sorted(value for key, value in found if not key))
    keys = sorted({key for key, _ in found if key})
    if classes or not keys:
        return Mark(None, classes, short, plural)
    values = sorted(value for key, value in found if key == keys[0])
    return Mark(f"{keys[0]}{OF_KEY}{'|'.join(values)}", (), short, plural)


@functools.lru_cache(4096)
def _means(word: str, name: str) -> bool:
    """Whether a word is another name of a mark that is a name of several words: "coke" of Coca Cola."""
    return " " in name and not _SAME.isdisjoint(evidence(word, name))


def misspells(word: str, name: str) -> bool:
    """Whether a word is a name but for a letter, of long ones two."""
    shorter = min(len(word), len(name))
    return shorter >= _SPELT and OSA.distance(word, name, score_cutoff=2) <= 1 + (shorter >= _LONG)


def solid_name(words: Sequence[str]) -> str:
    """Words as one, numbers as digits, "007" as 7: by this they are compared."""
    numbers = mark_words()["numbers"]
    told = [str(numbers.get(word, word)).replace("'", "") for word in words]
    told = [str(int(word)) if word.isdecimal() else word for word in told]
    if len(words) == 2 and words[0] in numbers and words[1] in numbers:
        tens, ones = numbers[words[0]], numbers[words[1]]
        told = [str(tens + ones)] if tens >= 20 and 0 < ones < 10 else told  # "twenty one"
    joined = "".join(told)
    return joined.removesuffix("s") if len(joined) > _PART else joined


def words_of(name: str) -> list[str]:
    """The words of a name or a text in small letters, numbers behind letters apart: "block_7" is block and 7."""
    return [word.lower() for word in WORD.findall(name)]


def marks_of(things: Iterable[tuple[str | None, frozenset[str]]]) -> Marks | None:
    """The marks of things, each with its class and attributes; None where there are none.

    >>> found = marks_of([("block", frozenset({"brand: Shell"})), ("block", frozenset({"brand: Coca Cola"}))])
    >>> found.named(["coke"]).word, found.named(["block"])
    ('brand: coca cola', None)
    """
    return _marks_of(frozenset(things))


@functools.lru_cache(256)
def _marks_of(things: frozenset[tuple[str | None, frozenset[str]]]) -> Marks | None:
    types = sorted({type_ for type_, _ in things if type_})
    given = {(a.partition(":")[0], a.partition(":")[2].strip()) for _, of in things for a in of if ":" in a}
    values = {(attribute_key(key), normalise(value), value) for key, value in _values(given)}
    apart, head = _told_apart(types)
    whole: dict[str, set[tuple[str, str]]] = {}
    parts: dict[str, set[tuple[str, str]]] = {}
    heads = frozenset(singular(words[-1]) for words in map(_nouns, types) if words)
    if apart:
        heads = frozenset({singular(head)}) if head else mark_words()["carriers"]
    names = [((key, value), words_of(raw)) for key, value, raw in values]
    names += [(("", type_), words) for type_, words in apart.items()]
    for one, words in names:
        whole.setdefault(solid_name(words), set()).add(one)
        if len(words) > 1 and _OF not in words:
            for word in words:
                if len(word) >= _PART and word not in mark_words()["common"] and singular(word) not in heads:
                    parts.setdefault(solid_name([word]), set()).add(one)
    for solid, meant in _shapes(names, heads).items():
        whole.setdefault(solid, meant)
    if not names:
        return None
    full = {one: " ".join(words) for one, words in names}
    spelt = {"".join(words).replace("'", "") for _, words in names}
    spelt |= {str(name).replace(" ", "") for group in mark_words()["shapes"] for name in group}
    freeze = {name: frozenset(meant) for name, meant in whole.items()}
    keys = tuple(sorted({key for (key, _), _ in names if key}))
    return Marks(freeze, {name: frozenset(meant) for name, meant in parts.items()}, full, frozenset(spelt), heads, keys)


def _values(given: Collection[tuple[str, str]]) -> Iterator[tuple[str, str]]:
    """The keys and values of attributes that are names: neither looks nor yes or no, and no numbers among other values.

    Where half of the values of a key are basic colours, they are looks. Names of rooms are places, and so are sides.
    """
    rooms = {room_named(value) for key, value in given if key in room_keys()} - {None}
    for key in sorted({key for key, _ in given}):
        values = sorted(value for of, value in given if of == key and room_named(value) not in rooms)
        numbers = [value for value in values if value.isdecimal()]
        if any(value not in "01" for value in numbers):
            yield from ((key, value) for value in numbers)
        others = [value for value in values if value not in numbers and 0 < len(words_of(value)) <= MARK_WORDS]
        others = [value for value in others if SYNONYMS.get(value.lower(), value.lower()) not in _SIDES]
        colors = [value for value in others if normalise(value).split(" ")[-1] in color_words().basic]
        if 2 * len(colors) < len(others):
            suits = mark_words()["suits"]  # the key is that of what people wear as well
            yield from ((key, v) for v in others if v.lower() in suits or not describes(attribute_key(key), v))


_SIDES = SIDED | {"middle"}


_OF = "of"


def _nouns(type_: str) -> list[str]:
    return [word for word in words_of(type_) if not (word.isdecimal() or word == _OF)]


def _shared(types: Sequence[str]) -> str:
    """The word that most classes of several words have in common, empty where there is none."""
    found = Counter(word for type_ in types if len(words_of(type_)) > 1 for word in set(_nouns(type_)))
    most = max(found.values(), default=0)
    last = Counter(_nouns(type_)[-1] for type_ in types if _nouns(type_))
    return max((word for word, times in found.items() if times == most), key=lambda w: (last[w], w), default="")


def _told_apart(types: Sequence[str]) -> tuple[dict[str, list[str]], str]:
    """Class -> what tells it from the others, where they are things of one kind with names: "shell block", "7".

    Also the word that they have in common, if they have one.
    """
    if sum(_OF in words_of(type_) for type_ in types) >= max(_BOARD, _MOST * len(types)):
        return {type_: words_of(type_) for type_ in types}, ""  # "two of spades"
    head = _shared(types)
    named = {type_: [word for word in words_of(type_) if word != head] for type_ in types}
    board = {type_: words for type_, words in named.items() if words and head in words_of(type_)}
    colors = [words for words in board.values() if region(" ".join(words)) is not None]
    if len(board) >= max(_BOARD, _MOST * len(types)) and len(colors) < 0.5 * len(board):
        return board, head
    strange = [type_ for type_ in types if len(type_) == 1 or all(map(is_strange, words_of(type_)))]
    return {type_: words_of(type_) for type_ in types if len(strange) >= max(_BOARD, _SOME * len(types))}, ""


@functools.lru_cache(256)
def kinds_of(types: frozenset[str]) -> dict[str, str]:
    """Class -> what kind of thing it is, where four of five classes or more are of one kind and told apart by marks.

    >>> kinds_of(frozenset({"shell block", "bmw block", "esso block", "ups block", "table"}))["bmw block"]
    'block'
    """
    board, head = _told_apart(sorted(types))
    return dict.fromkeys(board, head) if head else {}


def is_strange(word: str) -> bool:
    """Is it a number or a word that nobody knows?"""
    return word.isdecimal() or unheard_of(word)


def _may_be_shape(key: str, heads: Collection[str]) -> bool:
    """Shapes are values of a key that says so, parts of the names of classes, "T piece", or letters of such pieces."""
    return not key or _SHAPE in key.split(" ") or (key == "letter" and not _SHAPED.isdisjoint(heads))


def _shapes(
    names: Sequence[tuple[tuple[str, str], Sequence[str]]], heads: Collection[str]
) -> dict[str, set[tuple[str, str]]]:
    """Other names of the shapes that are there, as people call them."""
    found: dict[str, set[tuple[str, str]]] = {}
    for group in mark_words()["shapes"]:
        meant = {one for one, words in names if _may_be_shape(one[0], heads) and " ".join(words) in group}
        for name in group if meant else ():
            found.setdefault(solid_name(str(name).split()), set()).update(meant)
    return found
