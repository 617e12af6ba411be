"""Words -> tagged tokens, in several ways: the likeliest paths through what each word and phrase may be.

A path's log-weight is the sum of the weights of its tokens and of each tag after the one before (`data/grammar.yaml`).
The best paths are found exactly, from left to right: of what may follow only a beginning's last tag counts.
"""

from __future__ import annotations

import itertools
from collections import defaultdict
from collections.abc import Collection, Mapping, Sequence
from operator import itemgetter
from typing import Final, NamedTuple, TypeAlias

from dcg_torch.english.forms import singular
from dcg_torch.language import lexicon as lx
from dcg_torch.language.candidates import candidates, is_plain_noun
from dcg_torch.language.colors import match_color, normal_color

_NEGLIGIBLE = 4.0  # log-weight below the best path's of paths that are not looked for
_LONGEST = 4  # words of a compound
_DOUBTFUL = -0.6  # log-weight of a noun that being known makes surer
START, END = "START", "END"
_AFTER: Final = {
    before: {tag: float(row.get(tag, row["default"])) for tag in (*lx.GRAMMAR["tags"], END)}
    for before, row in lx.GRAMMAR["transitions"].items()
}


class Token(NamedTuple):
    """Words `start` to `stop` of a command as one: their tag, their text and what they mean in normal form."""

    start: int
    stop: int
    tag: str
    text: str
    value: tuple[str, ...] = ()


BEHIND: Final = Token(0, 0, "", "")
"""What stands behind the last token."""


class Path(NamedTuple):
    """Tokens that cover a command, and their log-weight."""

    tokens: tuple[Token, ...]
    weight: float


_Start: TypeAlias = tuple[float, tuple[Token, ...]]
"""The tokens of the beginning of a command, and their log-weight."""


def paths(words: Sequence[str], vocabulary: Collection[str], names: Collection[str], k: int) -> list[Path]:
    """The `k` likeliest ways to tag a command, the likeliest first.

    `vocabulary` holds nouns that are known, `names` words that are written like names, which have no plural.
    """
    # starts[i][tag]: beginnings that end before word i with a token of that tag.
    starts: list[defaultdict[str, list[_Start]]] = [defaultdict(list) for _ in range(len(words) + 1)]
    starts[0][START] = [(0.0, ())]
    for i, edges in enumerate(map(_Lattice(words, vocabulary, names).at, range(len(words)))):
        best: dict[str, list[_Start]] = {}
        for token, weight in edges if starts[i] else ():
            if token.tag not in best:
                best[token.tag] = _best(starts[i], token.tag, k)
            starts[token.stop][token.tag] += [(score + weight, (*path, token)) for score, path in best[token.tag]]
    whole = _best(starts[-1], END, k)
    return [Path(path, weight) for weight, path in whole if weight >= whole[0][0] - _NEGLIGIBLE]


def _best(starts: Mapping[str, list[_Start]], tag: str, k: int) -> list[_Start]:
    """The `k` likeliest beginnings before a token of a tag."""
    # Rounded, so that equal ones are equal, and stay as they come.
    ends = [(round(score + _AFTER[last][tag], 6), path) for last, several in starts.items() for score, path in several]
    return sorted(ends, key=itemgetter(0), reverse=True)[:k]


class _Lattice:
    """Every token that may begin at each word."""

    def __init__(self, words: Sequence[str], vocabulary: Collection[str], names: Collection[str]) -> None:
        self.words, self.names = words, names
        self.known = {noun for noun in vocabulary if " " not in noun}
        self.compounds = {tuple(noun.split()) for noun in vocabulary if " " in noun}
        self.joined = " ".join(words)
        self.offsets = [0, *itertools.accumulate(len(word) + 1 for word in words)]

    def at(self, i: int) -> list[tuple[Token, float]]:
        """The tokens that begin at a word, with their log-weights."""
        word = self.words[i]
        out = [(Token(i, i + 1, tag, word, self._value(tag, word)), weight) for tag, weight in candidates(word)]
        if (".", *self.words)[i] in lx.SETS["before_orders"] and (*self.words, ".", ".")[i + 1] in lx.SETS["articles"]:
            out = [(token, weight + lx.GRAMMAR["first_verb"] * (token.tag == "V")) for token, weight in out]
        doubtful = all(token.tag != "N" or weight < _DOUBTFUL for token, weight in out)
        if doubtful and not self.known.isdisjoint((word, singular(word))) and is_plain_noun(word):
            out.append((Token(i, i + 1, "N", word, self._value("N", word)), lx.GRAMMAR["known_noun"]))
        found = match_color(self.words, i)
        if found is not None and found[1] > i + 1:
            text = " ".join(self.words[i : found[1]])
            out.append((Token(i, found[1], "COL", text, (found[0],)), lx.GRAMMAR["long_color"]))
        out += self._patterns(i) + self._compounds(i)
        return out or [(Token(i, i + 1, "ADV", word, (word,)), 0.0)]

    def _value(self, tag: str, word: str) -> tuple[str, ...]:
        if tag == "N":
            return (word if word in self.names else singular(word),)
        return (normal_color(word),) if tag == "COL" else (lx.NORMAL.get(word, word),)

    def _patterns(self, i: int) -> list[tuple[Token, float]]:
        """Prepositions, how a thing stands, numbers that are names, ordinals of several words."""
        out: list[tuple[Token, float]] = []
        for raw, value, tags in lx.match_tokens(self.joined, self.offsets[i]):
            long = float(lx.GRAMMAR["long_preposition"]) if "P" in tags and " " in raw else 0.0
            out += [(Token(i, i + raw.count(" ") + 1, tag, raw, value), weight + long) for tag, weight in tags.items()]
            if long and self.words[i] in lx.PLACING["single"]:
                out.append((Token(i, i + 1, "P", self.words[i], (self.words[i],)), lx.GRAMMAR["short_preposition"]))
        return out

    def _compounds(self, i: int) -> list[tuple[Token, float]]:
        for length in range(min(_LONGEST, len(self.words) - i), 1, -1):
            spoken = tuple(self.words[i : i + length])
            name = (*spoken[:-1], singular(spoken[-1]))
            if not (self.compounds.isdisjoint((name, spoken)) and lx.COMPOUNDS.isdisjoint((name, spoken))):
                tags = lx.GRAMMAR["compound"].items()
                return [(Token(i, i + length, tag, " ".join(spoken), name), weight) for tag, weight in tags]
        return []
