"""Base forms of English words: what a word may be, the singular of a noun, the base of a verb."""

from __future__ import annotations

import functools
from collections.abc import Mapping
from typing import Final

import yaml

from dcg_torch.english.dictionary import english, irregular, read

_DATA: Final = yaml.safe_load(read("forms.yaml"))
_NOUN_FORMS: Final[Mapping[str, str]] = _DATA["noun_forms"]
_VERB_FORMS: Final[Mapping[str, str]] = _DATA["verb_forms"]
_PLURAL_ENDINGS: Final[list[list[str]]] = _DATA["plural_endings"]
_VERB_ENDINGS: Final[list[list[str]]] = _DATA["verb_endings"]
_MUCH_COMMONER = 3  # in powers of two


def parts(word: str) -> dict[str, int]:
    """Parts of speech that the dictionary has for a word as it stands."""
    return dict(english().get(word, {}))


@functools.lru_cache(4096)
def singular(word: str) -> str:
    """The singular of a noun, known or unknown.

    >>> [singular(word) for word in ("boxes", "zorps", "bus", "shelves", "glass", "people")]
    ['box', 'zorp', 'bus', 'shelf', 'glass', 'person']
    """
    known = english()
    if word in _NOUN_FORMS:
        return _NOUN_FORMS[word]
    base = irregular().get((word, "n"), word)
    if base != word and "n" in known.get(base, {}) and _commoner(base, word):
        return base
    if "n" in known.get(word, {}) and not word.endswith("s"):
        return word
    if word.endswith(("ss", "us", "is")) or len(word) < 4 or not word.endswith(("s", "men")):
        return word
    if known.get(word, {}).get("n", 0) > 3 and "n" not in known.get(word[:-1], {}):
        return word
    for old, new in _PLURAL_ENDINGS:
        stem = word[: len(word) - len(old)] + new
        if word.endswith(old) and "n" in known.get(stem, {}):
            return stem
    if word in known:
        return word
    return word[:-1] if word.endswith("s") else word


def _commoner(base: str, word: str) -> bool:
    """Whether an irregular plural is meant and no noun of its own: "men", but "cola"."""
    known = english()
    return "n" not in known.get(word, {}) or known[base]["n"] > known[word]["n"] + _MUCH_COMMONER


@functools.lru_cache(4096)
def verb(word: str) -> str:
    """The base form of a verb, or the word itself.

    >>> [verb(word) for word in ("going", "picked", "sits", "held", "placing")]
    ['go', 'pick', 'sit', 'hold', 'place']
    """
    if word in _VERB_FORMS:
        return _VERB_FORMS[word]
    known = english()
    if "v" in known.get(word, {}):
        return word
    base = irregular().get((word, "v"))
    if base is not None:
        return base
    for old, new in _VERB_ENDINGS:
        if not word.endswith(old) or len(word) - len(old) < 2:
            continue
        stem = word[: len(word) - len(old)] + new
        if "v" in known.get(stem, {}):
            return stem
        if stem[-1:] == stem[-2:-1] and "v" in known.get(stem[:-1], {}):
            return stem[:-1]
    return word


def is_compared(word: str) -> bool:
    """Whether a word is an adjective's comparative or superlative."""
    if irregular().get((word, "a"), "") in english():
        return True
    for ending in ("er", "est"):
        stem = word.removesuffix(ending)
        stems = {stem, f"{stem}e", stem[:-1], f"{stem[:-1]}y"} if stem != word else set()
        if any("a" in english().get(base, {}) for base in stems):
            return True
    return False
