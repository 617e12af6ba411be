"""What a command was grounded to, with the alternatives that were weighed: frozen values."""

from __future__ import annotations

import functools
import math
from collections.abc import Mapping
from dataclasses import dataclass, field, replace

from dcg_torch.grounding.hypotheses import Hypothesis, ModifierFactor
from dcg_torch.names.vocabulary import ANY, FEW, GROUP_LIKE, HALF, SO_MANY
from dcg_torch.types import Object, ParseTree, Phrase, PhraseKind, WorldModel
from dcg_torch.types.arrays import Bools

_AS_WELL = 0.5
"""An object is one of several that are meant if it is described at least half as well as the best."""


_LIKELY = 0.2
"""Share of the best object's probability from which another is one of several: what all fit well, this tells apart."""
_EXCLUDED = 1e-3
"""An object so much less probable than the best is no further one of a number: it has another look."""
_EXCLUDED_OF_ANOTHER_TYPE = 0.1
"""The same of another type: a count never takes what the noun excludes, however little a noun that is new excludes."""


_MISCOUNTED = 0.4
"""The probability that those are meant that are there, if there are fewer than are counted."""


@dataclass(frozen=True)
class Solution:
    """phi* and gamma* of a command, with the alternatives that were weighed.

    Attributes:
        best: the most probable configuration, None where the world offers nothing to ground to.
        probabilities: object or group id -> probability that the command is about it; sums to 1.
        fits: object or group id -> probability that the noun phrase describes it, whatever else it describes.
        odds: object or group id -> odds, by the noun phrase alone, that it is the one described.
        runner_up: the best configuration whose noun phrase means another object than the best one's.
        modifiers: the factors of the modifiers of the noun phrase meant.
        compared: (things,) those among which the noun phrase ranks; None where it does not.
        named: how well the noun phrase, without its modifiers, names what it names best of what is there: from 0 to 1.
        further: of the other noun phrases that the command joins to the first ("the cube and the cone").
        problem: why nothing was grounded, one sentence; None where something was.
        speakers_frame: the probability that sides are the speaker's; None where they are the robot's as well.
    """

    tree: ParseTree | None
    world: WorldModel
    best: Hypothesis | None = None
    probabilities: Mapping[str, float] = field(default_factory=dict)
    fits: Mapping[str, float] = field(default_factory=dict)
    odds: Mapping[str, float] = field(default_factory=dict)
    runner_up: Hypothesis | None = None
    modifiers: tuple[ModifierFactor, ...] = field(default=(), compare=False)
    compared: Bools | None = field(default=None, compare=False)
    named: float = 0.0
    further: tuple[Solution, ...] = ()
    problem: str | None = None
    speakers_frame: float | None = None

    def __repr__(self) -> str:
        """What is meant, in one line: the world and all that was weighed would fill pages."""
        if self.problem is not None:
            return f"Solution(problem={self.problem!r})"
        return f"Solution(objects={[o.id for o in self.objects]}, probability={self.probability:.3f})"

    @property
    def object(self) -> Object | None:
        """gamma*: the object the command is about."""
        return None if self.best is None else self.best.child.grounding.object

    @property
    def objects(self) -> tuple[Object, ...]:
        """What the command is about: one object, the members of a group, or several objects.

        A phrase in the plural means as many as it counts, or else all that it describes about as well as the best.
        """
        found = dict.fromkeys((*self._meant(), *(o for solution in self.further for o in solution.objects)))
        return tuple(found)

    def _meant(self) -> tuple[Object, ...]:
        noun = self.noun
        if self.object is None or noun is None:
            return ()
        if self.object.members:
            members = set(self.object.members)
            return tuple(o for o in self.world.objects if o.id in members)
        if self.object.hypothetical or (not noun.plural and (noun.count or 1) == 1):
            return (self.object,)
        if noun.count is not None:
            best, *_ = ranked = self._ranked
            counted = [o for o in ranked if o.hypothetical or not self._is_excluded(o, best)][: noun.count]
            return tuple(o for o in counted if not o.hypothetical)  # what is not there may be likelier than what is
        found = self._described
        if HALF in noun.words:
            return found[: (len(found) + 1) // 2]
        return found[: min((FEW[word] for word in noun.words if word in FEW), default=None)]

    @property
    def _ranked(self) -> list[Object]:
        """All that may be there, the likeliest first."""
        return sorted(self.world.objects, key=lambda o: -self.probabilities[o.id])

    def _is_excluded(self, other: Object, best: Object) -> bool:
        """Is it too unlikely beside the best to be a further one of a number?  What is of its type may be less so."""
        same = other.type == best.type
        # What another reading means is none of the number: its fit is of this one.
        if not same and self.fits and self.fits[other.id] < _EXCLUDED_OF_ANOTHER_TYPE * self.fits[best.id]:
            return True
        least = _EXCLUDED if same else _EXCLUDED_OF_ANOTHER_TYPE
        return self.probabilities[other.id] < least * self.probabilities[best.id]

    @property
    def _described(self) -> tuple[Object, ...]:
        """What is described about as well as the likeliest thing; what nothing fits well is told apart by the odds."""
        ranked = [o for o in self._ranked if not o.hypothetical]
        fits = self.fits if self.fits[ranked[0].id] >= _AS_WELL else self.odds
        least, likely = _AS_WELL * fits[ranked[0].id], _LIKELY * self.probabilities[ranked[0].id]
        return tuple(o for o in ranked if fits[o.id] >= least and self.probabilities[o.id] >= likely)

    @property
    def _whichever(self) -> bool:
        """Is any of those meant that are described: "one of the cubes", "any two cubes"?"""
        noun = self.noun
        if noun is None or not self.fits or not GROUP_LIKE.isdisjoint(noun.words):
            return False
        if HALF in noun.words or not FEW.keys().isdisjoint(noun.words):
            return True
        number, of, _ = noun.text.partition(" of ")
        return number.partition(" ")[0] == ANY or bool(of and (number in SO_MANY or number.isdecimal()))

    @property
    def noun(self) -> Phrase | None:
        """The noun phrase of the object meant."""
        return None if (node := self.target) is None else node.phrase

    @property
    def target(self) -> ParseTree | None:
        """The noun phrase of the object meant, with all that describes it."""
        return None if self.tree is None or self.best is None else target_of(self.tree)

    @property
    def inverted(self) -> bool:
        """Does the command ask to keep away from the object?  Two inversions cancel ("do not stay away from ...")."""
        if self.best is None:
            return False
        signs = [h.child.correspondence for h in self.best.walk() if h.tree.phrase.kind is not PhraseKind.NOUN]
        return math.prod(signs) < 0

    @property
    def probability(self) -> float | None:
        """The grounding's probability, None if there is none; of several objects, that they and no others are meant."""
        if self.object is None:
            return None
        meant, noun = self._meant(), self.noun
        if self.object.hypothetical or self.object.members:
            own = self.probabilities[self.object.id]
        elif self._whichever:
            own = sum(self.probabilities[o.id] for o in self._described)
        elif len(meant) < 2:
            own = self.probabilities[self.object.id]
        else:
            own = self._probability_of_set({o.id for o in meant})
        if (
            noun is not None
            and len(meant) < (noun.count or 0)
            and not (self.object.members or self.object.hypothetical)
        ):
            own *= _MISCOUNTED
        return math.prod((own, *(solution.probability or 0.0 for solution in self.further)))

    def _probability_of_set(self, inside: set[str]) -> float:
        """That just these are meant: that things there are, and the least likely of them before the likeliest other.

        What people describe, they describe together: whether one is meant hangs on whether the others are. So it is as
        likely that all are as that the least likely is.
        """
        unseen = {o.id for o in self.world.objects if o.hypothetical}
        absent = sum(p for i, p in self.probabilities.items() if i in unseen)
        least = min(self.probabilities[i] for i in inside)
        other = max((p for i, p in self.probabilities.items() if i not in inside | unseen), default=0.0)
        return (1.0 - absent) * least / (least + other)


@functools.lru_cache(maxsize=1024)
def target_of(tree: ParseTree) -> ParseTree | None:
    """The noun phrase of the object meant: the first of the tree, from the root; None if there is none."""
    return next((node for node in tree.walk() if node.phrase.kind is PhraseKind.NOUN), None)


def with_target(tree: ParseTree, other: ParseTree) -> ParseTree:
    """A tree about another noun phrase in the place of the one that `target_of` finds.

    It is found by its place: equal trees may have been met, and a node that is kept of one is none of another.
    """
    if tree.phrase.kind is PhraseKind.NOUN:
        return other
    at = next((k for k, child in enumerate(tree.children) if target_of(child) is not None), None)
    if at is None:
        return tree
    children = (*tree.children[:at], with_target(tree.children[at], other), *tree.children[at + 1 :])
    return replace(tree, children=children)
