"""Many patterns over one text, of which few fit: what is rewritten one after another, and the first that fits.

Most patterns are left at little cost: a rewrite where the text lacks the letters that it cannot do without, a row of
`FirstOf` at its first letter.
"""

from __future__ import annotations

import re
from collections import defaultdict
from collections.abc import Callable, Collection, Iterable, Sequence
from dataclasses import dataclass
from functools import cached_property
from operator import add
from typing import TypeAlias

New: TypeAlias = str | Callable[[re.Match[str]], str]
"""What takes the place of a match, as in `re.sub`."""


@dataclass(frozen=True)
class _Rewrite:
    old: str
    new: New
    needs: frozenset[str]

    @cached_property
    def pattern(self) -> re.Pattern[str]:
        """Compiled when a text first asks for it: few commands ask for many."""
        return re.compile(self.old)


class Rewrites:
    """Patterns and what takes the place of their matches, each put to the text that the one before has left.

    Args:
        rows: a pattern, what takes the place of its matches, and letters of which a text has some wherever the pattern
            fits; none: it is put to every text.

    >>> Rewrites([("colou?r", "hue", ["colo"]), (" +", " ", [])]).applied("the  colour")
    'the hue'
    """

    def __init__(self, rows: Iterable[tuple[str, New, Collection[str]]]) -> None:
        self.rows = [_Rewrite(old, new, frozenset(needs or ("",))) for old, new, needs in rows]
        self._begun = defaultdict[str, list[str]](list)  # all letters that are needed, by the first two
        for letters in frozenset[str]().union(*(row.needs for row in self.rows)):
            self._begun[letters[:2]].append(letters)

    def applied(self, text: str) -> str:
        """A text rewritten by all of them, in their order."""
        there = self._there(text)
        for row in self.rows:
            if not there.isdisjoint(row.needs) and row.pattern.search(text):
                text = row.pattern.sub(row.new, text)
                there = self._there(text)
        return text

    def _there(self, text: str) -> set[str]:
        """The letters that a text has of those that are needed."""
        begun = self._begun.keys() & {"", *text, *map(add, text, text[1:])}
        return {letters for start in begun for letters in self._begun[start] if letters in text}


class FirstOf:
    """The first of several patterns that fits whole words at a place. Each may have a group called "way".

    >>> FirstOf(["a (?P<way>red|blue)", "a red one"]).match("a red one", 0)
    ('a red', 0, 'red')
    """

    def __init__(self, patterns: Sequence[str]) -> None:
        ways = (part.replace("<way>", f"<w{i}>") for i, part in enumerate(patterns))
        # The number stands behind what it is of: a row that began with a group could not be left at its first letter.
        self._all = re.compile("|".join(f"(?:{part})(?= |$)(?P<r{i}>)" for i, part in enumerate(ways)))

    def match(self, joined: str, offset: int) -> tuple[str, int, str] | None:
        """The words that fit from a letter of a text on, the pattern's number, and its "way", empty if it has none."""
        match = self._all.match(joined, offset)
        if match is None:
            return None
        number = str(match.lastgroup)[1:]
        way = match[f"w{number}"] if f"w{number}" in self._all.groupindex else None
        return match.group(), int(number), way or ""
