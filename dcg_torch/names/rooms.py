"""Rooms: what people call them, and what tells that one is there (`data/rooms.yaml`)."""

from __future__ import annotations

import functools
from typing import Any

from dcg_torch.names.evidence import evidence
from dcg_torch.names.normal_form import normalise, read_data

_SAME = frozenset({"kind: everyday"})


@functools.cache
def _rooms() -> dict[str, Any]:
    return read_data("rooms.yaml")


@functools.cache
def _named() -> dict[str, str]:
    return {normalise(name): room for room, of in _rooms()["rooms"].items() for name in (room, *of["names"])}


@functools.cache
def within_words() -> frozenset[str]:
    """Prepositions by which something is in a room."""
    return frozenset(_rooms()["within"].split())


@functools.cache
def room_keys() -> frozenset[str]:
    """Keys that say where a thing is."""
    return frozenset(normalise(key) for key in _rooms()["keys"].split())


@functools.lru_cache(maxsize=4096)
def room_named(noun: str) -> str | None:
    """The room that a noun names, which may have a number ("bedroom 2"); None for what names none.

    >>> room_named("kids' room"), room_named("guest bedroom"), room_named("sofa")
    ('kids room', 'bedroom', None)
    """
    plain = normalise(noun.replace("'s", "").replace("'", ""))
    words = plain.rstrip("0123456789 ").split(" ")
    return next((found for k in range(len(words)) if (found := _named().get(" ".join(words[k:]))) is not None), None)


@functools.lru_cache(maxsize=4096)
def told_rooms(class_name: str) -> tuple[tuple[str, float], ...]:
    """The rooms that a thing of some class tells of, and how surely."""
    found = []
    for room, of in _rooms()["rooms"].items():
        told = [float(weight) for thing, weight in of["things"].items() if _is_such(thing, class_name)]
        if told:
            found.append((room, max(told)))
    return tuple(found)


def _is_such(thing: str, class_name: str) -> bool:
    """Whether a class has the name of a thing of the list: "bed" is no "dog bed"."""
    form, *kind = evidence(thing, class_name)
    return form == "name: equal" or not _SAME.isdisjoint(kind)
