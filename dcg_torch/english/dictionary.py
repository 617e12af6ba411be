"""A dictionary of English and its irregular forms, made from WordNet 3.0 by `tools/english_words.py`."""

from __future__ import annotations

import functools
from collections.abc import Iterable, Iterator, Mapping
from importlib import resources


def read(name: str, room: str = __package__) -> str:
    """The text of a file of a room's `data/`, of this room's if no other is said."""
    return resources.files(room).joinpath("data", name).read_text(encoding="utf-8")


def lines(name: str, room: str = __package__) -> list[str]:
    """The lines of such a file that are neither empty nor comments."""
    return [line for line in read(name, room).splitlines() if line and line[0] != "#"]


@functools.cache
def english() -> Mapping[str, Mapping[str, int]]:
    """A dictionary: word -> {part of speech (n, v, a, r): how often it is that, a power of two}."""
    found = "\t".join(lines("english.tsv")).split("\t")
    return _Dictionary(zip(found[::2], found[1::2], strict=True))


class _Dictionary(Mapping[str, Mapping[str, int]]):
    """A dictionary whose lines are read when their word is looked up: it has tens of thousands."""

    def __init__(self, entries: Iterable[tuple[str, str]]) -> None:
        self._kinds = dict(entries)

    def __getitem__(self, word: str) -> Mapping[str, int]:
        kinds = self._kinds[word]
        return {kinds[i]: int(kinds[i + 1]) for i in range(0, len(kinds), 2)}

    def __contains__(self, word: object) -> bool:
        return word in self._kinds

    def __iter__(self) -> Iterator[str]:
        return iter(self._kinds)

    def __len__(self) -> int:
        return len(self._kinds)


@functools.cache
def irregular() -> Mapping[tuple[str, str], str]:
    """(irregular form, part of speech) -> base form."""
    return {(form, kind): base for form, kind, base in (line.split("\t") for line in lines("irregular.tsv"))}
