"""Which features fire for regions and actions: those that are about nothing that their children are about are alike."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from dcg_torch.types import Child


class Patterns:
    """Which features fire for regions or actions: they differ in which of their children are about the same thing.

    Attributes:
        known: the children and which of them are about the same thing, each different pattern once.
        special: (groundings,) 0 for what no child is about, else a number of its own.
    """

    def __init__(self, groundings: int, number: Mapping[str, int]) -> None:
        self.known: list[tuple[tuple[Child, ...], tuple[bool, ...]]] = []
        self.special = np.zeros(groundings, dtype=np.int64)
        self._number = number
        self._index: dict[tuple[tuple[tuple[str, int], ...], tuple[bool, ...]], int] = {}

    def of(self, children: tuple[Child, ...]) -> tuple[int, dict[int, int]]:
        """The number of the pattern of all that no child is about, and grounding -> number for what one is about."""
        kinds = tuple([(c.grounding.kind._value_, c.correspondence._value_) for c in children])  # hashed quickly
        about = [self._number[c.grounding.object.id] for c in children]
        special = {j: self._of(children, kinds, tuple([j == a for a in about])) for j in about}
        for j in special:
            self.special[j] = j + 1
        return self._of(children, kinds, (False,) * len(about)), special

    def _of(self, children: tuple[Child, ...], kinds: tuple[tuple[str, int], ...], same: tuple[bool, ...]) -> int:
        number = self._index.setdefault((kinds, same), len(self.known))
        if number == len(self.known):
            self.known.append((children, same))
        return number
