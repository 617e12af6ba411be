"""Equations 2 to 9 by enumeration, in plain Python: what the batched factor graph is compared with.

No arrays and no columns here: a feature is a pair of names, a weight stands in a dict, and the best configuration
is found by writing down all of them. It is slow and meant to be read beside the paper.
"""

from __future__ import annotations

import itertools
import math
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field

from dcg_torch.types import Child, Correspondence, Grounding, GroundingKind, ParseTree, Phrase, PhraseKind, WorldModel

KIND = {
    PhraseKind.VERB: GroundingKind.ACTION,
    PhraseKind.PREPOSITION: GroundingKind.REGION,
    PhraseKind.NOUN: GroundingKind.OBJECT,
}


@dataclass(frozen=True)
class Configuration:
    """One grounding, not INACTIVE, for every phrase of a tree: this one's, and those of the trees below."""

    child: Child
    below: tuple[Configuration, ...]


@dataclass(frozen=True)
class Oracle:
    """What a model knows and weighs.

    `weight` maps (phi, language feature, grounding feature) to mu_f; what is missing weighs nothing.
    """

    groups: frozenset[str]
    correspondences: tuple[Correspondence, ...]
    nouns: frozenset[str]
    types: frozenset[str]
    colors: frozenset[str]
    words: frozenset[tuple[PhraseKind, str]]
    weight: Mapping[tuple[Correspondence, str, str], float]
    _known: dict[object, dict[Correspondence, float]] = field(default_factory=dict, compare=False)

    def language(self, phrase: Phrase) -> set[str]:
        """The language halves of the features that fire for lambda_i."""
        fires = set()
        if "dcg" in self.groups:
            fires.add(f"kind: {phrase.kind}")
            if phrase.kind is not PhraseKind.NOUN:  # what describes a noun but its colour is beyond the paper
                fires |= {f"{phrase.kind}: {word}" for word in phrase.words if (phrase.kind, word) in self.words}
            if phrase.noun in self.nouns:
                fires.add(f"noun: {phrase.noun}")
        # Without F_DCG there are no nouns to know.
        known = "dcg" in self.groups and phrase.noun in self.nouns
        if "unknown" in self.groups and phrase.noun is not None:
            fires.add("noun known: yes" if known else "noun known: no")
        if "color" in self.groups and phrase.color is not None:
            fires |= {"color stated: yes", f"color: {phrase.color if phrase.color in self.colors else 'unknown'}"}
        return fires

    def grounding(self, grounding: Grounding, children: tuple[Child, ...]) -> set[str]:
        """The grounding halves of the features that fire for gamma_ij with Gamma_c_ij."""
        fires, obj = set(), grounding.object
        if "dcg" in self.groups:
            fires.add(f"kind: {grounding.kind}")
            for child in children:
                same = "same" if child.grounding.object.id == obj.id else "other"
                fires.add(f"child: {child.grounding.kind}, {same}, {child.correspondence.name.lower()}")
        if grounding.kind is not GroundingKind.OBJECT:
            return fires
        if "dcg" in self.groups and obj.known and obj.type in self.types:
            fires.add(f"type: {obj.type}")
        if "unknown" in self.groups:
            fires.add("known: yes" if obj.known else "known: no")
        if "hypothetical" in self.groups and obj.hypothetical:
            fires.add("hypothetical: yes")
        if "color" in self.groups and obj.color is not None:
            fires.add(f"color: {obj.color if obj.color in self.colors else 'unknown'}")
        return fires

    def log_psi(self, phrase: Phrase, grounding: Grounding, children: tuple[Child, ...]) -> dict[Correspondence, float]:
        """Eqs. 4, 6, 8 and 9: which of them, is said by the groups and the correspondences."""
        key = (phrase, grounding, children)
        if key not in self._known:
            pairs = list(itertools.product(self.language(phrase), self.grounding(grounding, children)))
            score = {
                phi: math.fsum(self.weight.get((phi, left, right), 0.0) for left, right in pairs)
                for phi in self.correspondences
            }
            total = math.fsum(math.exp(s) for s in score.values())
            self._known[key] = {phi: s - math.log(total) for phi, s in score.items()}
        return self._known[key]

    def configurations(self, tree: ParseTree, world: WorldModel) -> Iterator[Configuration]:
        """Every way to ground each phrase in exactly one thing; the opposite of an object is no object."""
        signs = [phi for phi in self.correspondences if phi != 0]
        if tree.phrase.kind is PhraseKind.NOUN:
            signs = [Correspondence.ACTIVE]
        own = [Child(Grounding(KIND[tree.phrase.kind], o), phi) for o in world.objects for phi in signs]
        below = [list(self.configurations(child, world)) for child in tree.children]
        for combination in itertools.product(*below):
            for child in own:
                yield Configuration(child, combination)

    def log_probability(self, tree: ParseTree, world: WorldModel, chosen: Configuration) -> float:
        """The logarithm of eq. 7's product over phrases i and groundings j."""
        children = tuple(c.child for c in chosen.below)
        terms = []
        for obj in world.objects:
            phi = chosen.child.correspondence if obj.id == chosen.child.grounding.object.id else Correspondence.INACTIVE
            terms.append(self.log_psi(tree.phrase, Grounding(KIND[tree.phrase.kind], obj), children)[phi])
        below = (self.log_probability(t, world, c) for t, c in zip(tree.children, chosen.below, strict=True))
        return math.fsum([*terms, *below])

    def solve(self, tree: ParseTree, world: WorldModel) -> tuple[dict[Configuration, float], dict[str, float]]:
        """The log-probability of every configuration, and the share of each object that the root grounds to."""
        scores = {c: self.log_probability(tree, world, c) for c in self.configurations(tree, world)}
        total = math.fsum(math.exp(s) for s in scores.values())
        shares = {
            o.id: math.fsum(math.exp(s) for c, s in scores.items() if c.child.grounding.object.id == o.id) / total
            for o in world.objects
        }
        return scores, shares
