"""Spelling: a word that is no English word becomes the known word it was meant to be, or stays as it is.

Only words that the robot knows, colours and words of commands are offered as corrections, and a word that
exists is never changed: "brick" is no misspelt "block".
"""

from __future__ import annotations

from collections.abc import Collection, Iterable, Sequence


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
    return row[-1]


def correct(word: str, candidates: Iterable[Collection[str]], english: Collection[str]) -> str:
    """The candidate that `word` misspells, or `word` itself.

    `candidates` are groups of known words, the more likely group first. One edit is allowed, two where both words
    have seven letters or more; words of three letters and words in `english` stay. Among equally near candidates
    the earlier group wins, then the one with the same first letter; a tie leaves the word alone.
    """
    if len(word) <= 3 or not word.isalpha() or word in english or word.removesuffix("s") in english:
        return word
    groups: Sequence[Collection[str]] = list(candidates)
    if any(word in group for group in groups):
        return word
    best: list[tuple[tuple[int, int, bool], str]] = []
    for rank, group in enumerate(groups):
        for candidate in group:
            if len(candidate) <= 3 and not (len(word) == 4 and rank < 2):
                continue
            limit = 2 if len(word) >= 7 and len(candidate) >= 7 else 1
            distance = edits(word, candidate, limit)
            if distance <= limit:
                best.append(((distance, rank, candidate[0] != word[0]), candidate))
    if not best:
        return word
    best.sort()
    if len(best) > 1 and best[0][0] == best[1][0] and best[0][1] != best[1][1]:
        return word
    return best[0][1]
