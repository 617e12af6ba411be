"""Which features fire for regions and actions: those that are about nothing that their children are about are alike."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from dcg_torch.grounding.tables import Pattern
from dcg_torch.types import Child

_Kinds = tuple[tuple[str, int], ...]


@dataclass
class Patterns:
    """Which features fire for regions or actions: they differ in which of their children are about the same thing.

    Attributes:
        number: id of a thing -> its number.
        known: each different pattern once, in the order of their numbers, with children that are such.
    """

    number: Mapping[str, int]
    known: dict[Pattern, tuple[Child, ...]] = field(default_factory=dict)
    _index: dict[Pattern, int] = field(default_factory=dict)
    _single: dict[_Kinds, tuple[int, int]] = field(default_factory=dict)

    def of(self, children: tuple[Child, ...]) -> tuple[int, dict[int, int]]:
        """The number of the pattern of all that no child is about, and grounding -> number for what one is about."""
        kinds = tuple([(c.grounding.kind._value_, c.correspondence._value_) for c in children])  # hashed quickly
        about = [self.number[c.grounding.object.id] for c in children]
        if len(children) == 1:  # as nearly all have
            other, same = self._single.get(kinds) or self._of_one(children, kinds)
            return other, {about[0]: same}
        special = {j: self._of(children, (kinds, tuple([j == a for a in about]))) for j in about}
        return self._of(children, (kinds, (False,) * len(about))), special

    def _of_one(self, children: tuple[Child, ...], kinds: _Kinds) -> tuple[int, int]:
        found = self._single[kinds] = self._of(children, (kinds, (False,))), self._of(children, (kinds, (True,)))
        return found

    def _of(self, children: tuple[Child, ...], pattern: Pattern) -> int:
        number = self._index.get(pattern)
        if number is None:
            number = self._index[pattern] = len(self.known)
            self.known[pattern] = children
        return number


def spread(found: Sequence[tuple[int, dict[int, int]]], groundings: int) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
    """What `Patterns.of` found of several choices of children, as arrays.

    Returns:
        (choices, groundings) the numbers of the patterns, and (groundings,) 0 for what no child is about, else a number
        of its own.
    """
    which = np.empty((len(found), groundings), dtype=np.int64)
    which[:] = np.array([rest for rest, _ in found])[:, None]
    code = np.zeros(groundings, dtype=np.int64)
    rows = [row for row, (_, special) in enumerate(found) for _ in special]
    columns = [j for _, special in found for j in special]
    which[rows, columns] = [number for _, special in found for number in special.values()]
    code[columns] = [j + 1 for j in columns]
    return which, code
