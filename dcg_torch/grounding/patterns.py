"""Which features fire for regions and actions: those that are about nothing that their children are about are alike."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from dcg_torch.grounding.tables import Pattern
from dcg_torch.types import Child

Key = tuple[int, ...]
"""The number of the pattern of all that no child is about, then those of what some child is about."""


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
    _single: dict[tuple[str, int], Key] = field(default_factory=dict)

    def spread(self, choices: Sequence[tuple[Child, ...]]) -> tuple[list[Key], NDArray[np.int64]]:
        """The patterns under several choices of children.

        Returns:
            The patterns that each choice has; and (3, cells) where a child is about a grounding: the choice, the
            grounding, and the number of its pattern. All other groundings of a choice have the first of its patterns.
        """
        if all(len(children) == 1 for children in choices):  # as nearly all have
            about, rows = [self.number[c.grounding.object.id] for (c,) in choices], list(range(len(choices)))
            keys = [self._of_one(children) for children in choices]
            special = [same for _, same in keys]
        else:
            found = [self._of_several(children) for children in choices]
            about, rows = [j for _, of in found for j in of], [row for row, (_, of) in enumerate(found) for _ in of]
            special = [number for _, of in found for number in of.values()]
            keys = [(rest, *of.values()) for rest, of in found]
        return keys, np.array([rows, about, special], dtype=np.int64)

    def _of_one(self, children: tuple[Child, ...]) -> Key:
        kind = children[0].grounding.kind._value_, children[0].correspondence._value_  # hashed quickly
        found = self._single.get(kind)
        if found is None:
            rest, same = (self._of(children, ((kind,), (about,))) for about in (False, True))
            found = self._single[kind] = (rest, same)
        return found

    def _of_several(self, children: tuple[Child, ...]) -> tuple[int, dict[int, int]]:
        """The number of the pattern of all that no child is about, and grounding -> number for what one is about."""
        kinds = tuple([(c.grounding.kind._value_, c.correspondence._value_) for c in children])
        about = [self.number[c.grounding.object.id] for c in children]
        special = {j: self._of(children, (kinds, tuple([j == a for a in about]))) for j in about}
        return self._of(children, (kinds, (False,) * len(about))), special

    def _of(self, children: tuple[Child, ...], pattern: Pattern) -> int:
        number = self._index.get(pattern)
        if number is None:
            number = self._index[pattern] = len(self.known)
            self.known[pattern] = children
        return number
