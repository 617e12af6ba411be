"""Which features fire for regions and actions: those that are about nothing that their children are about are alike."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from dcg_torch.grounding.hypotheses import Beam
from dcg_torch.grounding.tables import Pattern, Tables, exact_sum
from dcg_torch.types import Child, Correspondence, GroundingKind, Phrase
from dcg_torch.types.arrays import Floats


def patterns_of(children: Sequence[Child], about: Sequence[int]) -> list[Pattern]:
    """The pattern of all that no child is about, then that of each thing that some child is about, in their order.

    Args:
        about: the number of the thing that each child is about.
    """
    kinds = tuple([(c.grounding.kind._value_, c.correspondence._value_) for c in children])
    return [(kinds, tuple([j == a for a in about])) for j in (-1, *dict.fromkeys(about))]


class Spread:
    """What all the factors of a region or an action come to, under any choice of its children.

    They are the same in every world of as many things, so that they are kept with the tables.

    Args:
        tables: of the phrases.
        kind: what the phrase grounds to.
        count: of the things that a command may be about.
    """

    def __init__(self, tables: Tables, phrase: Phrase, kind: GroundingKind, count: int) -> None:
        self._tables, self._phrase, self._kind, self._count = tables, phrase, kind, count
        self._kept = tables.spread(phrase, count)

    def of_one(self, children: Beam) -> Floats:
        """(children, 2, meant) what `of` says of each by itself; nearly always it is the same of all."""
        kept = {}
        for k, correspondence in enumerate(children.correspondences):
            if correspondence not in kept:
                kept[correspondence] = self._of_such(correspondence, children, k)
        if len(kept) == 1:
            found: Floats = kept[children.correspondences[0]][None]
        else:
            found = np.array([kept[correspondence] for correspondence in children.correspondences])
        return found

    def _of_such(self, correspondence: Correspondence, children: Beam, k: int) -> Floats:
        key = (children.kind._value_, correspondence._value_)  # hashed quickly
        found = self._kept.get(key)
        return self._looked_up(key, (children[k].child,), (0,)) if found is None else found

    def of(self, children: Sequence[Child], about: Sequence[int]) -> Floats:
        """(1 + k, meant) the log-score of all factors if the one that is not INACTIVE is about none of the k things of
        the children, and if it is about each of them.

        Args:
            about: the number of the thing that each child is about.
        """
        return self._looked_up(tuple(patterns_of(children, about)), children, about)

    def _looked_up(self, key: object, children: Sequence[Child], about: Sequence[int]) -> Floats:
        found = self._kept.get(key)
        if found is None:
            found = self._kept[key] = self._found(children, patterns_of(children, about))
        return found

    def _found(self, children: Sequence[Child], patterns: Sequence[Pattern]) -> Floats:
        table = self._tables.patterns(self._phrase, self._kind, dict.fromkeys(patterns, children))
        correspondences = self._tables.factor.correspondences
        inactive = table[correspondences.index(Correspondence.INACTIVE)]
        own = table[[k for k, c in enumerate(correspondences) if c is not Correspondence.INACTIVE]]
        once = [1] * (len(patterns) - 1)
        total: Floats = (exact_sum(inactive.tolist(), [self._count - len(once), *once]) + own - inactive).T
        return total
