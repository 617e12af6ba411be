"""Keys with values, which tell of an object beside its class, colour, place and size, as its attributes.

An attribute is a text: "held" of what is so, "glasses: no" of what is not, "material: wood" of a key with a value.
"""

from __future__ import annotations

import functools
from collections.abc import Mapping, Sequence
from typing import Final, TypeGuard

from dcg_torch.names.attribute_values import words_listed
from dcg_torch.names.normal_form import normalise, read_data
from dcg_torch.names.weights import log_odds

OF_KEY = ": "
"""Between key and values, "|" between these, of a word that states just that: "brand: shell", "digit: 7|8"."""
_KEY_ODDS = 1.5
"""Log-odds from which a noun names a key."""
_NUMBERED: Final = frozenset({"number", "digit", "label", "mark", "text", "name", "letter", "logo", "sign", "symbol"})
"""Keys whose numbers are names: "block 7"."""


def attributes_of(further: Mapping[str, object]) -> frozenset[str]:
    """The attributes that keys and values come to.

    Of numbers 1 and 0 are true and false ("hasBeard"), but for keys that count ("row") or whose numbers are names;
    what is neither text nor true or false says nothing. Of texts in a list each is a value of the key.
    """
    named = {
        f"{key}{OF_KEY}{value}"
        for key, values in further.items()
        for value in (values if _is_listed(values) else (values,))
        if isinstance(value, str) or _is_number(key, value)
    }
    truths = {key: bool(value) for key, value in further.items() if _is_truth(key, value)}
    return frozenset(named | {key if true else f"{key}{OF_KEY}no" for key, true in truths.items()})


def is_used(key: str, value: object) -> bool:
    """Does a key with this value say something, or is it plainly empty?"""
    return isinstance(value, (str, type(None))) or _is_truth(key, value) or _is_number(key, value) or _is_listed(value)


@functools.lru_cache(maxsize=4096)
def attribute_key(key: str) -> str:
    """What the key of an attribute names.

    >>> attribute_key("hasBeard"), attribute_key("hair_colour"), attribute_key("orientation")
    ('beard', 'hair', 'orientation')
    """
    words = normalise(key).split(" ")
    while len(words) > 1 and words[0] in ("has", "ha", "is", "with", "wears", "wear", "wearing"):
        words = words[1:]
    found = " ".join(words[:-1] if len(words) > 1 and words[-1] in ("color", "type") else words)
    return str(read_data("values.yaml")["same_key"].get(found, found))


@functools.lru_cache(maxsize=4096)
def counts(key: str) -> bool:
    """Are the values of a key numbers, so that 1 and 0 do not mean yes and no: "row"?"""
    return attribute_key(key) in words_listed("counted")


def is_clothing(key: str) -> bool:
    """Does a key or a noun name what people wear, of which a colour is told: "in black"?"""
    return key in words_listed("clothes")


def is_worn(key: str) -> bool:
    """Are the values of a key what people wear: "wears: red shirt", "jacket: red"?"""
    return key == "wear" or is_clothing(key)


@functools.lru_cache(maxsize=4096)
def named_key(noun: str, keys: frozenset[str]) -> str | None:
    """The key that a noun names: "glasses" for "spectacles"; None if it names none of them.

    Args:
        keys: as `attribute_key` has them.
    """
    near = [key for key in sorted(keys) if log_odds(noun, key) > _KEY_ODDS]
    return max(near, key=lambda key: log_odds(noun, key), default=None)


def _is_listed(value: object) -> TypeGuard[Sequence[str]]:
    """Several values: "wears": ["red shirt", "jeans"]."""
    return isinstance(value, (list, tuple)) and all(isinstance(one, str) for one in value)


def _is_truth(key: str, value: object) -> bool:
    whole = isinstance(value, int) and value in (0, 1) and key not in _NUMBERED
    return isinstance(value, bool) or (whole and not counts(key))


def _is_number(key: str, value: object) -> bool:
    return isinstance(value, int) and not isinstance(value, bool) and key in _NUMBERED
