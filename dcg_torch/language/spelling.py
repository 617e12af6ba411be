"""Spelling: a word that is no English word becomes the known word it was meant to be, or stays as it is.

Only words that the robot knows, colours and words of commands are offered as corrections, and a word that
exists is never changed: "brick" is no misspelt "block".
"""

from __future__ import annotations

import functools
from collections.abc import Callable, Collection, Sequence

import numpy as np

SHORTEST, LONGEST = 4, 20  # letters of a word that may be mended: three could be anything, twenty are a cat on the keys


def edits(a: str, b: str, limit: int) -> int:
    """Edits that turn `a` into `b`: insert, delete, replace, swap neighbours; `limit + 1` if there are more."""
    if abs(len(a) - len(b)) > limit:
        return limit + 1
    before: list[int] = []
    row = list(range(len(b) + 1))
    for i, x in enumerate(a, start=1):
        last, before, row = before, row, [i]
        for j, y in enumerate(b, start=1):
            cost = min(before[j] + 1, row[-1] + 1, before[j - 1] + (x != y))
            if i > 1 and j > 1 and x == b[j - 2] and a[i - 2] == y:
                cost = min(cost, last[j - 2] + 1)
            row.append(cost)
        if min(row) > limit:
            return limit + 1
    return min(row[-1], limit + 1)


def _letters(word: str) -> int:
    """The letters of a word as bits; letters beyond a to z share them, which can only make words seem nearer."""
    return functools.reduce(lambda bits, letter: bits | 1 << (ord(letter) & 31), word, 0)


class Speller:
    """Mends words towards groups of known words, the likelier group first; words that `is_english` stay.

    >>> Speller([{"pyramid", "cube"}], lambda word: word == "cub").correct("pyramind")
    'pyramid'
    """

    def __init__(self, groups: Sequence[Collection[str]], is_english: Callable[[str], bool]) -> None:
        self._is_english = is_english
        self._known = frozenset().union(*groups)
        # The words of commands are many: the short ones are too near one another to choose from.
        self._words = [
            (word, rank)
            for rank, group in enumerate(groups)
            for word in sorted(group)
            if len(word) >= SHORTEST + (rank > 0)
        ]
        self._lengths = np.array([len(word) for word, _ in self._words], dtype=np.int64)
        self._letters = np.array([_letters(word) for word, _ in self._words], dtype=np.uint32)

    def correct(self, word: str) -> str:
        """The known word that `word` misspells, or `word` itself.

        One edit is allowed, two where both words have seven letters or more. Among equally near words the earlier
        group wins, then the one with the same first letter; a tie leaves the word alone.
        """
        if not SHORTEST <= len(word) <= LONGEST or not word.isalpha() or word in self._known:
            return word
        if self._is_english(word):
            return word
        limits = np.where(np.minimum(self._lengths, len(word)) >= 7, 2, 1)
        letters = np.uint32(_letters(word))
        # An edit adds at most one letter and takes at most one away: cheaper to see than the table of edits.
        near = (
            (np.abs(self._lengths - len(word)) <= limits)
            & (np.bitwise_count(letters & ~self._letters) <= limits)
            & (np.bitwise_count(self._letters & ~letters) <= limits)
        )
        best: list[tuple[int, int, bool, str]] = []
        for at in np.flatnonzero(near):
            candidate, rank = self._words[at]
            distance = edits(word, candidate, int(limits[at]))
            if distance <= limits[at]:
                best.append((distance, rank, candidate[0] != word[0], candidate))
        best.sort()
        if not best or (len(best) > 1 and best[0][:3] == best[1][:3]):
            return word
        return best[0][3]
