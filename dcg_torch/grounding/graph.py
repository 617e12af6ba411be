"""The factor graph of a command in a world, and the search for phi*.

Eqs. 2, 5 and 7: phi* maximises the product over phrases i and groundings j of Psi(phi_ij | gamma_ij,
lambda_i, Gamma_c_ij, Upsilon). A command means one thing, so phi* is sought among the configurations in which
each phrase corresponds (ACTIVE or INVERTED) to exactly one grounding and is INACTIVE for the others; the
chosen grounding of a child is Gamma_c of its parent. The score of such a configuration is

    sum_i [ sum_j log Psi(phi_ij = 0)  +  log Psi(phi_ij*) - log Psi(phi_ij* = 0) ]

and is found leaf to root: every phrase keeps a beam of its best hypotheses for its parent. With a beam as
wide as there are hypotheses the search is exact.
"""

from __future__ import annotations

import itertools
import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property

import networkx as nx
import numpy as np
from numpy.typing import NDArray

from dcg_torch import scene
from dcg_torch.grounding.features import GROUNDING_OF, FeatureSet, ranking
from dcg_torch.grounding.psi import LogLinearFactor
from dcg_torch.types import (
    NOT,
    Child,
    Correspondence,
    Grounding,
    GroundingKind,
    Object,
    ParseTree,
    Phrase,
    PhraseKind,
    WorldModel,
)


@dataclass(frozen=True)
class Hypothesis:
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

    def walk(self) -> list[Hypothesis]:
        """This hypothesis and those below, parents first."""
        return [self, *(h for child in self.children for h in child.walk())]


_AS_WELL = 0.5
"""An object is one of several that are meant if it is described at least so well as the best, in probability."""


@dataclass(frozen=True)
class Solution:
    """phi* and gamma* of a command, with the alternatives that were weighed.

    Attributes:
        best: the most probable configuration, None where the world offers nothing to ground to.
        world: Upsilon, as it was.
        probabilities: object or group id -> probability that the command is about it; sums to 1.
        fits: object or group id -> probability that the noun phrase describes it, whatever else it describes.
        further: of the other noun phrases that the command joins to the first ("the cube and the cone").
    """

    tree: ParseTree
    world: WorldModel
    best: Hypothesis | None
    probabilities: Mapping[str, float]
    fits: Mapping[str, float] = field(default_factory=dict)
    further: tuple[Solution, ...] = ()

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
        if not noun.plural and (noun.count or 1) == 1:
            return (self.object,)
        ranked = sorted(self.world.objects, key=lambda o: -self.probabilities[o.id])
        if noun.count is not None:
            return tuple(ranked[: noun.count])
        least = _AS_WELL * self.fits[ranked[0].id]
        return tuple(o for o in ranked if self.fits[o.id] >= least)

    @property
    def noun(self) -> Phrase | None:
        """The noun phrase of the object meant."""
        walk = [] if self.best is None else self.best.walk()
        return next((h.tree.phrase for h in walk if h.tree.phrase.kind is PhraseKind.NOUN), None)

    @property
    def inverted(self) -> bool:
        """Does the command ask to keep away from the object?  Two inversions cancel ("do not stay away from ...")."""
        if self.best is None:
            return False
        signs = [h.child.correspondence for h in self.best.walk() if h.tree.phrase.kind is not PhraseKind.NOUN]
        return math.prod(signs) < 0

    @property
    def probability(self) -> float | None:
        """Of the grounding, None where there is none; of several objects, that they and no others are meant."""
        if self.object is None:
            return None
        meant = self._meant()
        if len(meant) < 2 or self.object.members:
            own = self.probabilities[self.object.id]
        else:
            inside = {o.id for o in meant}
            own = math.prod(self.fits[o.id] if o.id in inside else 1.0 - self.fits[o.id] for o in self.world.objects)
        return math.prod((own, *(solution.probability or 0.0 for solution in self.further)))


def _meant(hypothesis: Hypothesis) -> Object:
    """The object that the noun phrase of the action means, or where there is none, the action itself."""
    walk = hypothesis.walk()
    return next((h for h in walk if h.tree.phrase.kind is PhraseKind.NOUN), hypothesis).child.grounding.object


class FactorGraph:
    """The correspondence variables and factors of one command in one world.

    Args:
        tree: the command's parse tree; its root is grounded last.
        world: Upsilon.
    """

    def __init__(self, tree: ParseTree, world: WorldModel) -> None:
        self.tree = tree
        self.world = world

    @cached_property
    def phrases(self) -> nx.DiGraph:
        """The parse tree as a graph: node k has its subtree in "tree", edges lead from child to parent."""
        graph = nx.DiGraph()

        def add(tree: ParseTree) -> int:
            node = int(graph.number_of_nodes())
            graph.add_node(node, tree=tree)
            for child in tree.children:
                graph.add_edge(add(child), node)
            return node

        add(self.tree)
        return graph

    def unrolled(self) -> nx.Graph:
        """The bipartite graph of Fig. 4: a variable per (phrase, object), a factor joined to its children's."""
        graph = nx.Graph()
        for node, data in self.phrases.nodes(data=True):
            for obj in self.world.meanable:
                graph.add_node(("factor", node, obj.id), bipartite=1)
                graph.add_node(("phi", node, obj.id), bipartite=0, phrase=data["tree"].phrase)
                graph.add_edge(("factor", node, obj.id), ("phi", node, obj.id))
                for below, other in itertools.product(self.phrases.predecessors(node), self.world.meanable):
                    graph.add_edge(("factor", node, obj.id), ("phi", below, other.id))
        return graph

    def solve(self, features: FeatureSet, model: LogLinearFactor, *, beam: int = 8) -> Solution:
        """Leaf-to-root inference (Alg. 1, line 11), one tensor evaluation per level of the tree.

        Args:
            beam: hypotheses of a phrase that its parent considers.
        """
        if not self.world.objects:
            return Solution(self.tree, self.world, None, {})
        passed = self._pass(features, model, beam)
        root = passed[0]
        meanable = self.world.meanable
        totals = np.logaddexp.reduce(root.scores, axis=(0, 2))[: len(meanable)]
        probabilities = np.exp(totals - np.logaddexp.reduce(totals))
        noun = next((passed[k] for k in sorted(passed) if passed[k].tree.phrase.kind is PhraseKind.NOUN), None)
        return Solution(
            self.tree,
            self.world,
            self._best(root, 1)[0],
            {o.id: float(p) for o, p in zip(meanable, probabilities, strict=True)},
            {} if noun is None else {o.id: float(p) for o, p in zip(meanable, np.exp(noun.log_fit), strict=True)},
        )

    def runner_up(self, features: FeatureSet, model: LogLinearFactor, *, beam: int = 8) -> Hypothesis | None:
        """The best configuration whose noun phrase means another object than the best one's; None if there is none."""
        root = self._pass(features, model, beam)[0] if self.world.objects else None
        ranked = [] if root is None else self._best(root, root.scores.size)
        return next((h for h in ranked if _meant(h) != _meant(ranked[0])), None)

    def modifiers(self, features: FeatureSet, model: LogLinearFactor, *, beam: int = 8) -> Sequence[Placed]:
        """The factors of the modifiers of the root, which must be a noun phrase."""
        return self._pass(features, model, beam)[0].modifiers

    def _pass(self, features: FeatureSet, model: LogLinearFactor, beam: int) -> dict[int, _Scored]:
        """From the leaves to the root, number 0: the scores of every phrase but the modifiers."""
        beams: dict[int, list[Hypothesis]] = {}
        placed: dict[int, Placed] = {}
        scored: dict[int, _Scored] = {}
        for level in _levels(self.phrases):
            for node, of_node in self._score_level(level, beams, placed, features, model, beam).items():
                if isinstance(of_node, Placed):
                    placed[node] = of_node
                else:
                    scored[node] = of_node
                    beams[node] = self._best(of_node, beam)
        return scored

    @cached_property
    def layout(self) -> scene.Layout:
        """Where the things of the world are."""
        return scene.layout(self.world)

    def _score_level(
        self,
        level: Sequence[int],
        beams: Mapping[int, Sequence[Hypothesis]],
        placed: Mapping[int, Placed],
        features: FeatureSet,
        model: LogLinearFactor,
        beam: int,
    ) -> dict[int, _Scored | Placed]:
        """Scores of every configuration of the phrases of one level, from one evaluation of all their factors."""
        trees: list[ParseTree] = [self.phrases.nodes[node]["tree"] for node in level]
        below = [list(self.phrases.predecessors(node)) for node in level]
        combos = [list(itertools.product(*(beams[c][:beam] for c in nodes if c in beams))) for nodes in below]
        bags = [self._encode(tree, of_node, features) for tree, of_node in zip(trees, combos, strict=True)]
        width = max(bag.shape[2] for bag in bags)
        rows = [np.pad(b, ((0, 0), (0, 0), (0, width - b.shape[2])), constant_values=-1) for b in bags]
        flat = np.concatenate([r.reshape(-1, width) for r in rows])
        phrase = np.repeat(np.arange(len(level)), [r.shape[0] * r.shape[1] for r in rows])
        language = features.encode_phrases([tree.phrase for tree in trees])
        log_psi = model.log_psi(language, flat, phrase).numpy()
        out: dict[int, _Scored | Placed] = {}
        for which, node in enumerate(level):
            table = log_psi[phrase == which].reshape(*rows[which].shape[:2], -1)
            kind = trees[which].phrase.kind
            scores = np.array([sum(h.log_score for h in combo) for combo in combos[which]])
            if kind is PhraseKind.MODIFIER:
                negated = NOT in trees[which].phrase.words
                asserted = Correspondence.INACTIVE if negated else Correspondence.ACTIVE
                mixture = table[:, :, model.correspondences.index(asserted)]
                mixture = mixture + (scores - np.logaddexp.reduce(scores))[:, None]
                out[node] = Placed(trees[which], combos[which], mixture)
                continue
            meant = [c for c in model.correspondences if c is not Correspondence.INACTIVE]
            if kind is PhraseKind.NOUN:
                meant = [Correspondence.ACTIVE]  # the opposite of an object is no object
            inactive = table[:, :, model.correspondences.index(Correspondence.INACTIVE)]
            # Summed exactly, so that the order of the objects changes no bit and equal things keep equal scores.
            base = (np.array([math.fsum(row) for row in inactive]) + scores)[:, None]
            modifiers = [placed[c] for c in below[which] if c in placed]
            fit = table[0, :, model.correspondences.index(Correspondence.ACTIVE)]
            for modifier in modifiers:
                base = base + modifier.log_psi
                fit = fit + modifier.log_psi
            log_odds = [base + table[:, :, model.correspondences.index(phi)] - inactive for phi in meant]
            out[node] = _Scored(trees[which], combos[which], meant, np.stack(log_odds, axis=2), fit, modifiers)
        # Only a landmark may be a place: what a command is about is an object.
        for node, of_node in out.items():
            above = [self.phrases.nodes[up]["tree"].phrase.kind for up in self.phrases.successors(node)]
            if isinstance(of_node, _Scored) and PhraseKind.MODIFIER not in above:
                meanable = len(self.world.meanable)
                scores, fit = of_node.scores[:, :meanable], of_node.log_fit[:meanable]
                if self.world.meant is not None:
                    ruled_out = np.array([o.id not in self.world.meant for o in self.world.meanable])
                    scores = np.where(ruled_out[None, :, None], -np.inf, scores)
                    fit = np.where(ruled_out, -np.inf, fit)
                out[node] = replace(of_node, scores=scores, log_fit=fit)
        return out

    def _encode(
        self, tree: ParseTree, combos: Sequence[tuple[Hypothesis, ...]], features: FeatureSet
    ) -> NDArray[np.int64]:
        """(len(combos), groundings, k) bag of a phrase's factors."""
        kind = GROUNDING_OF[tree.phrase.kind]
        if kind is GroundingKind.OBJECT:
            return features.encode_things(self.world, self.layout, ranking(tree.phrase))[None]
        if kind is GroundingKind.PLACED:
            index = {thing.id: j for j, thing in enumerate(self.world.things)}
            landmarks = [[index[h.child.grounding.object.id] for h in combo] for combo in combos]
            return features.encode_placed(self.layout, landmarks, ranking(tree.phrase))
        return features.encode_groundings(kind, self.world, [[h.child for h in combo] for combo in combos])

    def _best(self, scored: _Scored, beam: int) -> list[Hypothesis]:
        """The best configurations of a phrase; equal scores stay in the order of the world's objects."""
        kind = GROUNDING_OF[scored.tree.phrase.kind]
        found = []
        for flat in np.argsort(-scored.scores, axis=None, kind="stable")[:beam]:
            c, j, p = np.unravel_index(flat, scored.scores.shape)
            thing = self.world.things[j]
            child = Child(Grounding(kind, thing), scored.meant[p])
            below = (*scored.combos[c], *(m.hypothesis(int(j), thing) for m in scored.modifiers))
            found.append(Hypothesis(scored.tree, child, below, float(scored.scores[c, j, p])))
        return found


@dataclass(frozen=True)
class _Scored:
    """log-scores (combos of child hypotheses, groundings, correspondences that are not INACTIVE) of a phrase.

    `log_fit` (groundings,) is the logarithm of Psi(ACTIVE) by itself, modifiers included; of use for a noun phrase.
    """

    tree: ParseTree
    combos: Sequence[tuple[Hypothesis, ...]]
    meant: Sequence[Correspondence]
    scores: NDArray[np.float64]
    log_fit: NDArray[np.float64]
    modifiers: Sequence[Placed] = ()


@dataclass(frozen=True)
class Placed:
    """A modifier's factors, for every thing that its noun phrase may mean.

    A modifier describes, it does not pick: many things may stand next to a cube. So of its correspondences only
    that of the object meant is asserted, and the landmark is summed over:

        Psi(object) = sum over landmarks of p(landmark) Psi(ACTIVE | object, landmark)

    with INACTIVE in the place of ACTIVE where the modifier is negated ("not on the cube").

    Attributes:
        combos: hypotheses of the landmarks; one for each child.
        mixture: (combos, things) the logarithm of the summands.
    """

    tree: ParseTree
    combos: Sequence[tuple[Hypothesis, ...]]
    mixture: NDArray[np.float64]

    @cached_property
    def log_psi(self) -> NDArray[np.float64]:
        """(things,) log Psi(thing)."""
        total: NDArray[np.float64] = np.logaddexp.reduce(self.mixture, axis=0)
        return total

    @property
    def posterior(self) -> NDArray[np.float64]:
        """(combos, things) p(landmarks | thing): what the modifier rests on if that thing is meant."""
        return np.exp(self.mixture - self.log_psi)

    def hypothesis(self, j: int, thing: Object, combo: int | None = None) -> Hypothesis:
        """That the thing j stands so, to its best landmarks or to those of a given combo."""
        best = int(self.mixture[:, j].argmax()) if combo is None else combo
        child = Child(Grounding(GroundingKind.PLACED, thing))
        return Hypothesis(self.tree, child, self.combos[best], float(self.log_psi[j]))


def _levels(phrases: nx.DiGraph) -> list[list[int]]:
    """Nodes by height, leaves first: a node's children are all in earlier levels."""
    return [list(level) for level in nx.topological_generations(phrases)]
