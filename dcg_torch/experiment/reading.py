"""Reads each text once: people say the same in many trials, in which the robot knows different words."""

from __future__ import annotations

import functools
from collections.abc import Collection, Hashable

from dcg_torch.english.forms import singular
from dcg_torch.language import Parse, default_parser
from dcg_torch.language.parser import MAX_CHARACTERS, MAX_WORDS
from dcg_torch.language.tokens import mend, names, normal_noun, tokens

_MOST_PARSES = 4096
_PARSES: dict[tuple[str, Hashable], Parse] = {}


def parse_once(text: str, words: Collection[str]) -> Parse:
    """`Parser.parse`, of a text and words that are alike once."""
    key = (text, bearing(text, words))
    found = _PARSES.get(key)
    if found is None:
        if len(_PARSES) >= _MOST_PARSES:
            _PARSES.clear()
        found = _PARSES[key] = default_parser().parse(text, words)
    return found


def bearing(text: str, vocabulary: Collection[str]) -> Hashable:
    """What of a vocabulary bears on how a text is read: where it is equal, `Parser.parse` says the same of the text.

    That is how misspelt words are mended, and the nouns that the text may speak of.
    """
    if len(text) > MAX_CHARACTERS:
        return text, frozenset()  # it is refused, whatever is known
    known, (words, named) = frozenset(normal_noun(noun) for noun in vocabulary), _written(text)
    mended = mend(words, known | named) if len(words) <= MAX_WORDS else list(words)
    said = {form for word in (*words, *mended) for form in (word, singular(word))}
    return tuple(mended), frozenset(noun for noun in known if said.issuperset(noun.split()))


@functools.lru_cache(maxsize=1024)
def _written(text: str) -> tuple[tuple[str, ...], frozenset[str]]:
    """The words of a text, and those that are written like names."""
    return tuple(tokens(text)), names(text)
