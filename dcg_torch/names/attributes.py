"""What the attributes of an object say about words: named facts, to be weighed elsewhere."""

from __future__ import annotations

import functools
from collections.abc import Collection, Sequence
from typing import Final

from dcg_torch.names.attribute_values import (
    FREE,
    NONE,
    SOME,
    Value,
    states_value,
    value_meanings,
    values_under,
    words_listed,
)
from dcg_torch.names.color_names import color_evidence
from dcg_torch.names.keys import OF_KEY, attribute_key
from dcg_torch.names.normal_form import normalise, read_data
from dcg_torch.names.palette import region

ATTRIBUTE_FACTS: Final = (
    "attribute: equal",  # "wooden" said of "wooden"
    "attribute: alike",  # "facing left" said of `orientation: left`
    "attribute: contrary",  # "big" said of `size: small`
    "attribute: silent",  # nothing is known of the object in this respect
)
HAS, NOT_ = "with ", "not "
"""How words say that an object has what a key names: "with glasses", "with dark hair", "not with tie"."""


def attribute_evidence(words: Collection[str], attributes: Collection[str]) -> tuple[str, ...]:
    """The facts that hold between words and the attributes of an object.

    >>> attribute_evidence(("big",), {"size: small"}), attribute_evidence(("facing left",), {"orientation: left"})
    (('attribute: contrary',), ('attribute: alike',))

    Args:
        words: adjectives and participles of a noun phrase; those that are no attribute at all say nothing.
        attributes: "orientation: left", or "held" for what is merely true.

    Returns:
        Some of `ATTRIBUTE_FACTS`, each once and in that order. A word that the attributes confirm is not "silent" or
        "contrary" too.
    """
    return _evidence(tuple(words), frozenset(attributes))


@functools.lru_cache(maxsize=16384)
def _evidence(words: tuple[str, ...], attributes: frozenset[str]) -> tuple[str, ...]:
    """Kept: things of a scene differ in few attributes, and are asked about the same words again and again."""
    said = (word if HAS in word or OF_KEY in word else normalise(word) for word in words)
    found = {fact for word in said if (fact := _attribute_fact(word, attributes)) is not None}
    return tuple(fact for fact in ATTRIBUTE_FACTS if fact in found)


@functools.lru_cache(maxsize=16384)
def _attribute_fact(word: str, attributes: frozenset[str]) -> str | None:
    if word.startswith(NOT_):
        found = _attribute_fact(word.removeprefix(NOT_), attributes)
        return _DENIED.get(found or "", found)
    pairs = [_pair(attribute) for attribute in attributes]
    if OF_KEY in word:
        key, _, stated = word.partition(OF_KEY)
        own = {value for of, value in pairs if of == key}
        held = not own.isdisjoint(stated.split("|"))
        return "attribute: equal" if held else "attribute: contrary" if own else "attribute: silent"
    if word.startswith(HAS):
        return _possession_fact(word.removeprefix(HAS), pairs)
    if any(word == value or (word == key and value not in words_listed("absent")) for key, value in pairs):
        return "attribute: equal"
    if any(word == key for key, _ in pairs):
        return "attribute: contrary"
    return _value_fact(word, pairs)


_DENIED = {
    "attribute: equal": "attribute: contrary",
    "attribute: alike": "attribute: contrary",
    "attribute: contrary": "attribute: alike",
}


def _value_fact(word: str, pairs: Sequence[tuple[str, str]]) -> str | None:
    """Of a word that may state a value, whatever the key."""
    meanings, excluded = value_meanings()
    meant = meanings.get(word)
    if meant is None:
        return None
    if word in words_listed("sides"):
        return "attribute: silent"
    true = {one for key, value in pairs for one in _held(key, value)}
    if meant & true:
        return "attribute: alike"
    # What is true under one key excludes the word only if the word can mean nothing else that is consistent.
    contrary = any((one, other) in excluded for one in meant for other in true)
    return "attribute: contrary" if contrary else "attribute: silent"


@functools.lru_cache(maxsize=4096)
def _held(key: str, value: str) -> frozenset[Value]:
    """What the value of a key says. "No" says something of its own key alone: without a beard nobody is bald.

    What is not open is closed.
    """
    meanings, excluded = value_meanings()
    state = {v for v in meanings.get(key, ()) if v[0] in FREE}
    own = {v for v in meanings[normalise(SOME)] if v[0] in key.split(" ")}
    if value in words_listed("absent"):
        none = {v for v in meanings[normalise(NONE)] if v[0] in key.split(" ")}
        return frozenset(none | {other for one, other in excluded if one in state})
    told = frozenset(state) if value in words_listed("present") else values_under(meanings.get(value, frozenset()), key)
    if not own and region(value) is not None and "hair" not in key.split(" "):
        told = frozenset(v for v in told if v[0] != "hair")  # a red shirt makes no redhead
    return told if own and told & meanings[normalise(NONE)] else told | own


def _possession_fact(said: str, pairs: Sequence[tuple[str, str]]) -> str:
    """Of "glasses" or "dark hair" that an object is said to have."""
    named = [(k, v) for k, v in pairs if f" {said}".endswith(f" {k}")]
    if not named:
        return "attribute: silent"
    # Of two values of one key, `hasHair` and `hairColour`, "no" says most, and "yes" less than what it is like.
    bare = words_listed("present")
    key, value = max(named, key=lambda one: (len(one[0]), _is_none(*one), one[1] not in {one[0], *bare}, one))
    like = said.removesuffix(key).strip()
    if not like or _is_none(key, value):
        return "attribute: contrary" if _is_none(key, value) else "attribute: equal"
    if value == key or value in words_listed("present"):  # "the white beard": hair of the face is like that of the head
        whole = read_data("values.yaml")["part_of"].get(key)
        told = [(k, v) for k, v in pairs if k == whole and v not in words_listed("present") | words_listed("absent")]
        return _possession_fact(f"{like} {whole}", told) if told else "attribute: silent"
    *several, _ = parts = value.removesuffix(f" {key}").split(" ")
    if like in (value, *parts):
        return "attribute: equal"
    if several:  # "short hair" of "long black hair"
        facts = {_possession_fact(said, [(key, part)]) for part in parts}
        return "attribute: alike" if facts & {"attribute: equal", "attribute: alike"} else "attribute: contrary"
    value = parts[0]
    fact = _value_fact(like, [(key, value)]) if states_value(like, frozenset({key})) else None
    if fact is None and region(like) is not None:
        near = not {"color: equal", "color: same hue", "color: alike"}.isdisjoint(color_evidence(like, value))
        fact = "attribute: alike" if near else "attribute: contrary"
    return fact or "attribute: silent"


def _is_none(key: str, value: str) -> bool:
    """Does the value of a key say that there is none: "no", or "bald" of `hair`?"""
    meanings, _ = value_meanings()
    none = {one for one in meanings[normalise(NONE)] if one[0] in key.split(" ")}
    return value in words_listed("absent") or not none.isdisjoint(meanings.get(value, ()))


def _pair(attribute: str) -> tuple[str, str]:
    """Key and value in normal form; what is merely true is its own value."""
    key, _, value = attribute.partition(":")
    return attribute_key(key), normalise(value) or attribute_key(key)
