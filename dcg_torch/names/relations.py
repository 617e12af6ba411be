"""Words for how things stand to places and to one another, by what they are asked for (`data/relations.yaml`)."""

from __future__ import annotations

import functools

from dcg_torch.names.normal_form import read_data


@functools.cache
def listed(name: str) -> frozenset[str]:
    """The words of a list.

    Raises:
        KeyError: there is none of that name.

    >>> sorted(listed("inside"))
    ['in', 'inside', 'into']
    """
    return frozenset(word.strip() for word in _lists()[name].split(";"))


@functools.cache
def _lists() -> dict[str, str]:
    return read_data("relations.yaml")
