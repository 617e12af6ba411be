"""Spelling: a word that is no English word becomes the known word it was meant to be, or stays as it is.

Only words that the robot knows, colours and words of commands are offered as corrections, and a word that
exists is never changed: "brick" is no misspelt "block".
"""

from __future__ import annotations

from collections.abc import Callable, Collection, Sequence

from rapidfuzz import process
from rapidfuzz.distance import OSA

SHORTEST, LONGEST = 4, 20  # letters of a word that may be mended: three could be anything, twenty are a cat on the keys
_LONG = 7  # letters of words that may be two edits apart


class Speller:
    """Mends words towards groups of known words, the likelier group first; words that `is_english` stay.

    >>> Speller([{"pyramid", "cube"}], lambda word: word == "cub").correct("pyramind")
    'pyramid'
    """

    def __init__(self, groups: Sequence[Collection[str]], is_english: Callable[[str], bool]) -> None:
        self._is_english = is_english
        # The words of commands are many: the short ones are too near one another to choose from.
        self._rank = {
            word: rank
            for rank, group in reversed(list(enumerate(groups)))
            for word in sorted(group)
            if len(word) >= SHORTEST + (rank > 0)
        }
        self._words = list(self._rank)

    def correct(self, word: str) -> str:
        """The known word that `word` misspells, or `word` itself.

        One edit is allowed (insert, delete, replace, swap neighbours), two where both words have seven letters or
        more. Among equally near words the earlier group wins, then the one with the same first letter; a tie leaves
        the word alone.
        """
        fits = SHORTEST <= len(word) <= LONGEST and word.isalpha() and word not in self._rank
        if not fits or self._is_english(word):
            return word
        near = process.extract(word, self._words, scorer=OSA.distance, score_cutoff=2, limit=None)
        best = sorted(
            (distance, self._rank[found], found[0] != word[0], found)
            for found, distance, _ in near
            if distance < 2 or min(len(found), len(word)) >= _LONG
        )
        if not best or (len(best) > 1 and best[0][:3] == best[1][:3]):
            return word
        return str(best[0][3])
