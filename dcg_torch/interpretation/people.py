"""Descriptions of people in few words, as they are read: "she's wearing glasses", "no beard, glasses, tie".

A parser knows nothing of what is there, and takes "she is smiling" for something that is told and orders nothing. Where
things carry what people have (`glasses`, `beard`), that is how somebody says who is meant.
"""

from __future__ import annotations

import functools
import re
from collections.abc import Iterable
from typing import Final

from dcg_torch.interpretation.telegrams import as_one_phrase
from dcg_torch.names.keys import attribute_key
from dcg_torch.names.normal_form import read_data
from dcg_torch.types import LOOKED_ROUND, Object, Percept

OF_PEOPLE: Final = frozenset(
    {"gender", "age", "hair", "beard", "mustache", "glasses", "hat", "tie", "suit", "smiling", "bald"}
)
"""Keys that people have: where things carry two of them "the chap" is one of these, whatever their class is called."""


def shows_people(things: Iterable[Object | Percept]) -> bool:
    """Do things carry at least two of the keys that people have?"""
    keys = {attribute_key(a.partition(":")[0]) for thing in things for a in thing.attributes if a != LOOKED_ROUND}
    return len(keys & OF_PEOPLE) > 1


def of_people(text: str, things: Iterable[Object | Percept]) -> str:
    """A text in which what is said of somebody names what he has, where things show people; else as it is."""
    return _plain(as_one_phrase(text)) if shows_people(things) else text


@functools.lru_cache(maxsize=1024)
def _plain(text: str) -> str:
    for old, new in _patterns():
        text = old.sub(new, text)
    return text


@functools.cache
def _patterns() -> tuple[tuple[re.Pattern[str], str], ...]:
    data = read_data("people.yaml")
    parts = {name: str(value) for name, value in data["parts"].items()}

    def filled(pattern: str) -> str:
        return re.sub(r"<([A-Z]+)>", lambda part: parts[part.group(1)], pattern)

    return tuple((re.compile(filled(old), re.IGNORECASE), new) for old, new in data["rewrite"])
