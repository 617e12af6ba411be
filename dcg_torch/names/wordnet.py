"""Which nouns are synonyms and which are kinds of which: a table made from WordNet 3.0 (`data/WORDNET_LICENSE`)."""

from __future__ import annotations

import bisect
import functools
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

TABLE = Path(__file__).parent / "data" / "nouns.npz"
"""Made by `tools/noun_table.py`."""


class Nouns:
    """Nouns for things, their senses in the order of frequency, and what each sense is a kind of.

    A synset is a number; it has no meaning outside one table.

    Args:
        path: the table.

    Raises:
        FileNotFoundError: it is not there.
    """

    def __init__(self, path: Path = TABLE) -> None:
        with np.load(path, allow_pickle=False) as arrays:
            self._lemmas: bytes = arrays["lemmas"].tobytes()
            self._senses = arrays["senses"]
            self._kinds = arrays["kinds"]
            self._sizes = np.bincount(self._kinds, minlength=len(arrays["kinds_of"]))
            starts = np.flatnonzero(arrays["lemmas"] == ord("\n")) + 1
            self._starts = np.concatenate([[0], starts, [len(self._lemmas) + 1]])
            self._sense_at = np.concatenate([[0], np.cumsum(arrays["senses_of"], dtype=np.int64)])
            self._kind_at = np.concatenate([[0], np.cumsum(arrays["kinds_of"], dtype=np.int64)])

    def __len__(self) -> int:
        return len(self._starts) - 1

    def __contains__(self, noun: object) -> bool:
        return isinstance(noun, str) and self._find(noun) is not None

    def _find(self, noun: str) -> int | None:
        sought = noun.encode()
        k = bisect.bisect_left(range(len(self)), sought, key=self._lemma)
        return k if k < len(self) and self._lemma(k) == sought else None

    def _lemma(self, k: int) -> bytes:
        return self._lemmas[self._starts[k] : self._starts[k + 1] - 1]

    def senses(self, noun: str, most: int = 4) -> tuple[int, ...]:
        """The synsets of a noun (lower case, words apart by one space), the commonest first; () for a strange noun."""
        k = self._find(noun)
        if k is None:
            return ()
        return tuple(self._senses[self._sense_at[k] : self._sense_at[k + 1]][:most].tolist())

    def kinds(self, synset: int) -> tuple[int, ...]:
        """The synsets that this one is directly a kind of."""
        return tuple(self._kinds[self._kind_at[synset] : self._kind_at[synset + 1]].tolist())

    def ancestors(self, synset: int, steps: int) -> dict[int, int]:
        """What a synset is a kind of, itself with it: synset -> the fewest steps there, at most `steps`."""
        found, level = {synset: 0}, [synset]
        for step in range(1, steps + 1):
            level = [kind for one in level for kind in self.kinds(one) if kind not in found]
            found |= dict.fromkeys(level, step)
        return found

    def names(self, synset: int) -> tuple[str, ...]:
        """The nouns that have this synset as a sense, in alphabetical order."""
        first, last = np.searchsorted(self._senses, [synset, synset + 1], sorter=self._by_sense)
        at = np.searchsorted(self._sense_at, np.sort(self._by_sense[first:last]), side="right") - 1
        return tuple(self._lemma(k).decode() for k in at.tolist())

    @functools.cached_property
    def _by_sense(self) -> NDArray[np.int64]:
        return np.argsort(self._senses, kind="stable")

    def size(self, synset: int) -> int:
        """How many synsets are directly a kind of this one."""
        return int(self._sizes[synset])


@functools.cache
def nouns() -> Nouns:
    """The table that comes along, read at the first call."""
    return Nouns()
