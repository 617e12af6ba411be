"""One normal form for the many ways in which one name is written."""

from __future__ import annotations

import functools
import re
from collections.abc import Iterable
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import yaml

DATA = Path(__file__).parent / "data"

# A break stands before a capital that follows a small letter ("coffeeTable"), before the last capital of several that
# a small letter follows ("TVStand"), and between letters and digits ("cube3").
_BREAKS = re.compile(r"(?<=[a-z])(?=[A-Z])|(?<=[A-Z])(?=[A-Z][a-z])|(?<=[A-Za-z])(?=[0-9])|(?<=[0-9])(?=[A-Za-z])")
_PARTICLE = re.compile(r"(?<=[a-z])-(in|on|up|out|off|down|through)\b", re.IGNORECASE)
"""Of a compound that a hyphen makes one word: the head of "check-in counter" does not stand before "in"."""
_APART = re.compile(r"[^\w']+|_+")


def read_data(name: str) -> dict[str, Any]:
    """A data file of this room.

    Args:
        name: without its folder, "spelling.yaml".
    """
    loader = getattr(yaml, "CSafeLoader", yaml.SafeLoader)
    found: dict[str, Any] = yaml.load((DATA / name).read_text(encoding="utf-8"), loader)
    return found


@dataclass(frozen=True)
class _Spelling:
    variants: dict[str, str]
    irregular: dict[str, str]
    singular: frozenset[str]
    glasses_to_wear: frozenset[str]


@functools.cache
def _spelling() -> _Spelling:
    data = read_data("spelling.yaml")
    return _Spelling(
        data["variants"], data["irregular"], frozenset(data["singular"]), frozenset(data["glasses_to_wear"])
    )


@functools.lru_cache(maxsize=8192)
def normalise(name: str) -> str:
    """The normal form of a name: small letters, words apart by one space, American spelling, the head in the singular.

    The head is the last word, or the last before "of": "Bottles_of_wine" becomes "bottle of wine". A name without a
    letter or digit comes back stripped and otherwise as it is. Doing it twice changes nothing.

    >>> normalise("CoffeeTable"), normalise("coffee_tables"), normalise("Light-Grey"), normalise("Walk-in closet")
    ('coffee table', 'coffee table', 'light gray', 'walkin closet')
    """
    if name.isupper():
        name = name.lower()
    name = _PARTICLE.sub(r"\1", name)
    words = [_variant(word) for word in _APART.split(_BREAKS.sub(" ", name).lower()) if word.strip("'")]
    if not words:
        return name.strip()
    head = head_index(words)
    words[head] = _variant(_singular_head(words[: head + 1]))
    return " ".join(words)


def _singular_head(words: list[str]) -> str:
    if len(words) > 1 and words[-1] == "glasses" and words[-2] not in _spelling().glasses_to_wear:
        return "glass"
    return singular(words[-1])


def _variant(word: str) -> str:
    return _spelling().variants.get(word, word)


def head_index(words: list[str] | tuple[str, ...]) -> int:
    """Where the head of a name stands: before the first "of", "for", "with", "in", "on" or number, else at the end."""
    for k, word in enumerate(words):
        if k and (word in ("of", "for", "with", "in", "on", "and") or word.isdigit()):
            return k - 1
    return len(words) - 1


def singular(word: str) -> str:
    """The singular of a noun in small letters; a word that is none is left alone.

    >>> [singular(w) for w in ("knives", "glasses", "boxes", "berries", "bus", "trouser")]
    ['knife', 'glasses', 'box', 'berry', 'bus', 'trousers']
    """
    spelling = _spelling()
    if word in spelling.irregular:
        return spelling.irregular[word]
    if f"{word}s" in spelling.singular:
        return f"{word}s"  # whoever read "trousers" may have made one of it
    if len(word) < 4 or not word.endswith("s") or word in spelling.singular or word.endswith(("ss", "us", "is", "'s")):
        return word
    if word.endswith("ies"):
        return word[:-3] + "y"
    if word.endswith(("shes", "ches", "xes", "sses", "zzes")):
        return word[:-2]
    return word[:-1]


@functools.lru_cache(4096)
def _head(type_: str) -> str:
    return normalise(type_).split()[-1] if normalise(type_) else ""


def heads(types: Iterable[str]) -> frozenset[str]:
    """The last words of the names of classes."""
    return frozenset(map(_head, set(types)))
