"""Hypotheses of what phrases ground to. A search weighs many, as numbers: one is made out when it is asked for."""

from __future__ import annotations

import itertools
import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import NamedTuple, TypeVar

import numpy as np

from dcg_torch.types import Child, Correspondence, Grounding, GroundingKind, Object, ParseTree, PhraseKind
from dcg_torch.types.arrays import Bools, Floats, Ints

T = TypeVar("T")


class Hypothesis(NamedTuple):
    """One grounding of a phrase, with the hypotheses of its children that it rests on.

    `log_score` is the log-probability of the whole configuration at and below this phrase.
    """

    tree: ParseTree
    child: Child
    children: tuple[Hypothesis, ...]
    log_score: float

    @property
    def factor_children(self) -> tuple[Child, ...]:
        """Gamma_c of this phrase's factor: a noun phrase's modifiers have factors of their own instead."""
        return () if self.child.grounding.kind is GroundingKind.OBJECT else tuple(h.child for h in self.children)

    @property
    def meant(self) -> Object:
        """The object that the noun phrase of the action means, or where there is none, that of the action."""
        return (self._noun or self).child.grounding.object

    @property
    def _noun(self) -> Hypothesis | None:
        """That of the first noun phrase, parents first."""
        if self.tree.phrase.kind is PhraseKind.NOUN:
            return self
        return next((noun for child in self.children if (noun := child._noun) is not None), None)

    def walk(self) -> list[Hypothesis]:
        """This hypothesis and those below, parents first."""
        return [self, *(h for child in self.children for h in child.walk())]


class Combos:
    """Choices of one hypothesis for each child of a phrase; those of the last child vary first.

    Args:
        beams: the hypotheses of each child.
        picks: of each choice the place in each beam; None: all that there are.
    """

    def __init__(self, beams: Sequence[Beam], picks: Sequence[tuple[int, ...]] | None = None) -> None:
        self.beams = tuple(beams)
        self._given = picks

    @cached_property
    def picks(self) -> Sequence[tuple[int, ...]]:
        """The place in each beam that a choice takes, for every choice."""
        return self._of_each([range(len(beam)) for beam in self.beams])

    @cached_property
    def things(self) -> Sequence[tuple[int, ...]]:
        """The numbers of the things that a choice's hypotheses are about, for every choice."""
        return self._of_each([beam.things for beam in self.beams])

    @cached_property
    def log_scores(self) -> Floats:
        """(choices,) the sum of the log-scores of each choice's hypotheses."""
        columns = [beam.log_scores for beam in self.beams]
        if len(columns) == 1 and self._given is None:
            return np.array(columns[0], dtype=np.float64)
        return np.array(list(map(sum, self._of_each(columns))), dtype=np.float64)

    def _of_each(self, columns: Sequence[Sequence[T]]) -> Sequence[tuple[T, ...]]:
        if self._given is None:
            return list(itertools.product(*columns))
        return [tuple([column[k] for column, k in zip(columns, pick, strict=True)]) for pick in self._given]

    def __len__(self) -> int:
        return math.prod(map(len, self.beams)) if self._given is None else len(self._given)

    def __getitem__(self, number: int) -> tuple[Hypothesis, ...]:
        return tuple([beam[k] for beam, k in zip(self.beams, self.picks[number], strict=True)])

    def __iter__(self) -> Iterator[tuple[Hypothesis, ...]]:
        return map(self.__getitem__, range(len(self)))


NOTHING_BELOW = Combos(())
"""The one choice that there is without children."""


class Highest(NamedTuple):
    """The best configurations of a phrase, the best first.

    Attributes:
        combos: the numbers of the choices of child hypotheses.
        things: the numbers of the things that they are about.
        correspondences: how the phrase corresponds to these.
        log_scores: of all at and below the phrase.
    """

    combos: Sequence[int]
    things: Sequence[int]
    correspondences: Sequence[Correspondence]
    log_scores: Sequence[float]


class Beam:
    """The best hypotheses of a phrase, the best first.

    Args:
        tree: the phrase with all below it.
        kind: what it grounds to.
        all_things: of the world.
        below: the choices of child hypotheses.
        modifiers: of a noun phrase.
        highest: which are the best.
    """

    def __init__(
        self,
        tree: ParseTree,
        kind: GroundingKind,
        all_things: Sequence[Object],
        below: Combos,
        modifiers: Sequence[ModifierFactor],
        highest: Highest,
    ) -> None:
        self.tree, self.kind = tree, kind
        self._combos, self.things, self.correspondences, self.log_scores = highest
        self._all, self._below, self._modifiers = all_things, below, modifiers
        self._made: dict[int, Hypothesis] = {}

    @cached_property
    def meant(self) -> Sequence[int]:
        """The number of the thing that each one's noun phrase means, see `Hypothesis.meant`."""
        if self.tree.phrase.kind is PhraseKind.NOUN:
            return self.things
        for k, beam in enumerate(self._below.beams):
            if beam.has_noun:
                return [beam.meant[self._below.picks[combo][k]] for combo in self._combos]
        return self.things

    @property
    def has_noun(self) -> bool:
        """Is there a noun phrase?"""
        return self.tree.phrase.kind is PhraseKind.NOUN or any(beam.has_noun for beam in self._below.beams)

    def __len__(self) -> int:
        return len(self.things)

    def __getitem__(self, number: int) -> Hypothesis:
        found = self._made.get(number)
        if found is None:
            j = self.things[number]
            child = Child(Grounding(self.kind, self._all[j]), self.correspondences[number])
            modified = [modifier.hypothesis(j, self._all[j]) for modifier in self._modifiers]
            below = (*self._below[self._combos[number]], *modified)
            found = self._made[number] = Hypothesis(self.tree, child, below, self.log_scores[number])
        return found


SLIP = 0.02
"""Share of modifiers that say nothing."""


@dataclass(frozen=True)
class ModifierFactor:
    """A modifier's factors, for every thing that its noun phrase may mean.

    A modifier describes, it does not pick: many things may stand next to a cube. So of its correspondences only
    that of the object meant is asserted, and the landmark is summed over:

        Psi(object) = sum over landmarks of p(landmark) Psi(ACTIVE | object, landmark)

    with INACTIVE in the place of ACTIVE where the modifier is negated ("not on the cube").

    People differ about what "beside" is, and some words are not known, so that no modifier says all: with a
    probability `SLIP` it says nothing.

    Attributes:
        combos: hypotheses of the landmarks; one for each child.
        mixture: (combos, things) the logarithm of the summands.
        log_prior: (combos,) log p(landmarks).
        compared: (things,) those among which it ranks; None: all of a kind.
        of_each: is it to each of a combo's landmarks ("behind the two cones"), not to both at once ("between")?
    """

    tree: ParseTree
    combos: Combos
    mixture: Floats
    log_prior: Floats
    compared: Bools | None = None
    of_each: bool = False

    @cached_property
    def _log_sum(self) -> Floats:
        total: Floats = np.logaddexp.reduce(self.mixture, axis=0)
        return total

    @cached_property
    def log_psi(self) -> Floats:
        """(things,) log Psi(thing)."""
        return np.logaddexp(math.log1p(-SLIP) + self._log_sum, math.log(SLIP))

    @cached_property
    def _likeliest(self) -> Ints:
        """(things,) the likeliest combo of each."""
        best: Ints = self.mixture.argmax(axis=0)
        return best

    @property
    def posterior(self) -> Floats:
        """(combos, things) p(landmarks | thing): what the modifier rests on if that thing is meant."""
        return np.exp(self.mixture - self._log_sum)

    def hypothesis(self, j: int, thing: Object, combo: int | None = None) -> Hypothesis:
        """The hypothesis that the thing j stands so, to its best landmarks or to those of a given combo."""
        best = int(self._likeliest[j]) if combo is None else combo
        child = Child(Grounding(GroundingKind.PLACED, thing))
        return Hypothesis(self.tree, child, self.combos[best], float(self.log_psi[j]))
