"""Keys with values, which tell of an object beside its class, colour, place and size, as its attributes.

An attribute is a text: "held" of what is so, "glasses: no" of what is not, "material: wood" of a key with a value.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Final

from dcg_torch.names.attributes import OF_KEY, counts

_NUMBERED: Final = frozenset({"number", "digit", "label", "mark", "text", "name", "letter", "logo", "sign", "symbol"})
"""Keys whose numbers are names: "block 7"."""


def attributes_of(further: Mapping[str, object]) -> frozenset[str]:
    """The attributes that keys and values come to.

    Of numbers 1 and 0 are true and false ("hasBeard"), but for keys that count ("row") or whose numbers are names;
    what is neither text nor true or false says nothing.
    """
    named = {
        f"{key}{OF_KEY}{value}" for key, value in further.items() if isinstance(value, str) or _is_number(key, value)
    }
    truths = {key: bool(value) for key, value in further.items() if _is_truth(key, value)}
    return frozenset(named | {key if true else f"{key}{OF_KEY}no" for key, true in truths.items()})


def is_used(key: str, value: object) -> bool:
    """Does a key with this value say something, or is it plainly empty?"""
    return isinstance(value, (str, type(None))) or _is_truth(key, value) or _is_number(key, value)


def _is_truth(key: str, value: object) -> bool:
    whole = isinstance(value, int) and value in (0, 1) and key not in _NUMBERED
    return isinstance(value, bool) or (whole and not counts(key))


def _is_number(key: str, value: object) -> bool:
    return isinstance(value, int) and not isinstance(value, bool) and key in _NUMBERED
