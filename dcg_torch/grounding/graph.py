"""The factor graph of a command in a world, and the search for phi*.

Eqs. 2, 5 and 7: phi* maximises the product over phrases i and groundings j of Psi(phi_ij | gamma_ij,
lambda_i, Gamma_c_ij, Upsilon). A command means one thing, so phi* is sought among the configurations in which
each phrase corresponds (ACTIVE or INVERTED) to exactly one grounding and is INACTIVE for the others; the
chosen grounding of a child is Gamma_c of its parent. The score of such a configuration is

    sum_i [ sum_j log Psi(phi_ij = 0)  +  log Psi(phi_ij*) - log Psi(phi_ij* = 0) ]

and is found leaf to root: every phrase keeps a beam of its best hypotheses for its parent. With a beam as
wide as there are hypotheses the search is exact. One pass gives the best configuration, the probabilities of
all objects, the runner-up, and the factors of the modifiers.
"""

from __future__ import annotations

import itertools
import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property

import networkx as nx
import numpy as np
from numpy.typing import NDArray

from dcg_torch.grounding.encode import WorldEncoder
from dcg_torch.grounding.features import GROUNDING_OF, FeatureSet, ranking
from dcg_torch.grounding.plain_words import in_group
from dcg_torch.grounding.psi import LogLinearFactor
from dcg_torch.grounding.solution import Hypothesis, ModifierFactor, Solution, target_of
from dcg_torch.types import (
    NOT,
    Child,
    Correspondence,
    Grounding,
    GroundingKind,
    ParseTree,
    PhraseKind,
    WorldModel,
)

Floats = NDArray[np.float64]

_IN_THE_SET = math.log(0.5)
"""A thing is compared where it is described at least half as well as the best."""


@dataclass(frozen=True)
class _Scored:
    """The scores of a phrase that picks.

    Attributes:
        combos: hypotheses of the children, a tuple for each choice of them.
        meant: the correspondences that are not INACTIVE.
        scores: (combos, groundings, meant) log-score of every configuration.
        log_odds: (groundings,) of ACTIVE against INACTIVE, modifiers included; of use for a noun phrase.
        log_fit: (groundings,) log Psi(ACTIVE) by itself, modifiers included.
        compared: (things,) those among which the phrase ranks; None where it does not.
        named: (groundings,) log Psi(ACTIVE) without the modifiers.
    """

    tree: ParseTree
    combos: Sequence[tuple[Hypothesis, ...]]
    meant: Sequence[Correspondence]
    scores: Floats
    log_odds: Floats
    log_fit: Floats
    named: Floats
    modifiers: Sequence[ModifierFactor] = ()
    compared: NDArray[np.bool_] | None = None


class FactorGraph:
    """The correspondence variables and factors of one command in one world.

    Args:
        tree: the command's parse tree; its root is grounded last.
        world: Upsilon.
        encoder: of the world; to be given where it has been used before.
    """

    def __init__(self, tree: ParseTree, world: WorldModel, encoder: WorldEncoder | None = None) -> None:
        self.tree = tree
        self.world = world
        self._encoder = encoder

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

    def solve(self, features: FeatureSet, factor: LogLinearFactor, *, beam: int = 8) -> Solution:
        """Leaf-to-root inference (Alg. 1, line 11), one evaluation of the factor per level of the tree.

        Args:
            beam: hypotheses of a phrase that its parent considers.
        """
        if not self.world.objects:
            return Solution(self.tree, self.world, problem="there is nothing here to mean")
        scored = self._pass(features, factor, beam)
        root, ids = scored[0], [o.id for o in self.world.meanable]
        totals = np.logaddexp.reduce(root.scores, axis=(0, 2))[: len(ids)]
        best = self._best(root, 1)[0]
        noun = next((scored[k] for k in sorted(scored) if scored[k].tree.phrase.kind is PhraseKind.NOUN), None)

        def by_id(values: Floats) -> dict[str, float]:
            return dict(zip(ids, values.tolist(), strict=True))

        return Solution(
            self.tree,
            self.world,
            best,
            by_id(np.exp(totals - np.logaddexp.reduce(totals))),
            {} if noun is None else by_id(np.exp(noun.log_fit)),
            {} if noun is None else by_id(np.exp(np.clip(noun.log_odds, -700.0, 700.0))),
            self._runner_up(root, best),
            () if noun is None else tuple(noun.modifiers),
            None if noun is None else noun.compared,
            1.0 if noun is None else self._named(noun),
        )

    def _named(self, noun: _Scored) -> float:
        """How well the noun phrase names what it names best of all that is there."""
        seen = [j for j, o in enumerate(self.world.meanable) if not o.hypothetical]
        return float(np.exp(noun.named[seen].max())) if seen else 0.0

    def _runner_up(self, root: _Scored, best: Hypothesis) -> Hypothesis | None:
        """The best configuration about another object; None if there is none."""
        rows, things, _ = root.scores.shape
        if root.tree.phrase.kind is PhraseKind.NOUN:
            about = [[thing.id for thing in self.world.things[:things]]] * rows
        else:
            found = [combo[0].meant.id if combo else None for combo in root.combos]
            about = [[i or thing.id for thing in self.world.things[:things]] for i in found]
        other = np.array(about) != best.meant.id
        scores = np.where(other[:, :, None], root.scores, -np.inf)
        if not np.isfinite(scores).any():
            return None
        return self._best(replace(root, scores=scores), 1)[0]

    def _pass(self, features: FeatureSet, factor: LogLinearFactor, beam: int) -> dict[int, _Scored]:
        """From the leaves to the root, number 0: the scores of every phrase but the modifiers."""
        beams: dict[int, list[Hypothesis]] = {}
        modifiers: dict[int, ModifierFactor] = {}
        scored: dict[int, _Scored] = {}
        for level in map(list, nx.topological_generations(self.phrases)):
            below = [list(self.phrases.predecessors(node)) for node in level]
            combos = [list(itertools.product(*(beams[c][:beam] for c in nodes if c in beams))) for nodes in below]
            own = [[modifiers[c] for c in nodes if c in modifiers] for nodes in below]
            encoder = self._encoder or WorldEncoder(features, self.world)
            sets = [
                comparison_set(tree, of, encoder, factor) if ranks(tree) else None
                for tree, of in zip((self.phrases.nodes[node]["tree"] for node in level), own, strict=True)
            ]
            for k, table in enumerate(self._tables(level, combos, sets, encoder, factor)):
                node, tree = level[k], self.phrases.nodes[level[k]]["tree"]
                if tree.phrase.kind is PhraseKind.MODIFIER:
                    modifiers[node] = _modifier(tree, combos[k], table, factor.correspondences)
                    continue
                found = _picked(tree, combos[k], table, own[k], factor.correspondences)
                found = replace(found, compared=sets[k])
                scored[node] = found if self._is_landmark(node) else self._only_objects(found)
                beams[node] = self._best(scored[node], beam)
        return scored

    def _tables(
        self,
        level: Sequence[int],
        combos: Sequence[Sequence[tuple[Hypothesis, ...]]],
        sets: Sequence[NDArray[np.bool_] | None],
        encoder: WorldEncoder,
        factor: LogLinearFactor,
    ) -> list[Floats]:
        """For each phrase of a level (combos, groundings, correspondences) log Psi, from one evaluation of all."""
        trees: list[ParseTree] = [self.phrases.nodes[node]["tree"] for node in level]
        bags = [
            self._encode(tree, of_node, members, encoder)
            for tree, of_node, members in zip(trees, combos, sets, strict=True)
        ]
        width = max(bag.shape[2] for bag in bags)
        rows = [np.pad(b, ((0, 0), (0, 0), (0, width - b.shape[2])), constant_values=-1) for b in bags]
        phrase = np.repeat(np.arange(len(level)), [r.shape[0] * r.shape[1] for r in rows])
        language = encoder.features.encode_phrases([tree.phrase for tree in trees])
        flat = np.concatenate([r.reshape(-1, width) for r in rows])
        log_psi = factor.log_psi(language, flat, phrase).numpy()
        return [log_psi[phrase == k].reshape(*r.shape[:2], -1) for k, r in enumerate(rows)]

    def _is_landmark(self, node: int) -> bool:
        """Only a landmark may be a place: what a command is about is an object."""
        above = (self.phrases.nodes[up]["tree"].phrase.kind for up in self.phrases.successors(node))
        return PhraseKind.MODIFIER in above

    def _only_objects(self, found: _Scored) -> _Scored:
        """Without places, without the objects that the speaker has ruled out, and groups where one thing is meant."""
        meanable = len(self.world.meanable)
        scores, odds, fit = found.scores[:, :meanable], found.log_odds[:meanable], found.log_fit[:meanable]
        meant, noun = self.world.meant, target_of(self.tree)
        single = noun is not None and not noun.phrase.plural and not in_group(noun.phrase)
        out = np.array(
            [bool(o.members and single) or not (meant is None or o.id in meant) for o in self.world.meanable]
        )
        if out.any():
            scores = np.where(out[None, :, None], -np.inf, scores)
            odds, fit = np.where(out, -np.inf, odds), np.where(out, -np.inf, fit)
        return replace(found, scores=scores, log_odds=odds, log_fit=fit)

    def _encode(
        self,
        tree: ParseTree,
        combos: Sequence[tuple[Hypothesis, ...]],
        members: NDArray[np.bool_] | None,
        encoder: WorldEncoder,
    ) -> NDArray[np.int64]:
        """(len(combos), groundings, k) bag of a phrase's factors."""
        kind = GROUNDING_OF[tree.phrase.kind]
        if kind is GroundingKind.OBJECT:
            return encoder.ranked(tree.phrase, members)[None]
        if kind is GroundingKind.PLACED:
            number = encoder.number
            landmarks = [tuple(number[h.child.grounding.object.id] for h in combo) for combo in combos]
            return encoder.placed(landmarks, ranking(tree.phrase))
        return encoder.features.encode_groundings(kind, self.world, [[h.child for h in combo] for combo in combos])

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


def ranks(tree: ParseTree) -> bool:
    """Is it a noun phrase with words that may rank?"""
    return tree.phrase.kind is PhraseKind.NOUN and ranking(tree.phrase) is not None


def comparison_set(
    tree: ParseTree, modifiers: Sequence[ModifierFactor], encoder: WorldEncoder, factor: LogLinearFactor
) -> NDArray[np.bool_]:
    """(things,) what a noun phrase describes apart from its ranks: as well as half of what it describes best.

    Args:
        modifiers: the factors of its modifiers.
    """
    phrase = replace(tree.phrase, words=())
    language, bag = encoder.features.encode_phrases([phrase]), encoder.things(phrase)
    log_psi = factor.log_psi(language, bag, np.zeros(len(bag), dtype=np.int64)).numpy()
    fit: Floats = log_psi[:, factor.correspondences.index(Correspondence.ACTIVE)]
    for modifier in modifiers:
        fit = fit + modifier.log_psi
    objects = np.array([not o.hypothetical for o in encoder.world.things])
    fit = np.where(objects, fit, -np.inf)
    found: NDArray[np.bool_] = fit >= fit.max() + _IN_THE_SET
    return found


def _modifier(
    tree: ParseTree,
    combos: Sequence[tuple[Hypothesis, ...]],
    table: Floats,
    correspondences: Sequence[Correspondence],
) -> ModifierFactor:
    """The factor of a modifier, from its log Psi under every choice of landmarks."""
    asserted = Correspondence.INACTIVE if NOT in tree.phrase.words else Correspondence.ACTIVE
    scores = np.array([sum(h.log_score for h in combo) for combo in combos])
    mixture = table[:, :, correspondences.index(asserted)] + (scores - np.logaddexp.reduce(scores))[:, None]
    return ModifierFactor(tree, combos, mixture)


def _picked(
    tree: ParseTree,
    combos: Sequence[tuple[Hypothesis, ...]],
    table: Floats,
    modifiers: Sequence[ModifierFactor],
    correspondences: Sequence[Correspondence],
) -> _Scored:
    """The scores of a phrase that picks one grounding, from its log Psi and its modifiers."""
    meant = [c for c in correspondences if c is not Correspondence.INACTIVE]
    if tree.phrase.kind is PhraseKind.NOUN:
        meant = [Correspondence.ACTIVE]  # the opposite of an object is no object
    inactive = table[:, :, correspondences.index(Correspondence.INACTIVE)]
    active = table[0, :, correspondences.index(Correspondence.ACTIVE)]
    scores = np.array([sum(h.log_score for h in combo) for combo in combos])
    # Summed exactly, so that the order of the objects changes no bit and equal things keep equal scores.
    base = (np.array([math.fsum(row) for row in inactive]) + scores)[:, None]
    placed = np.zeros(table.shape[1])
    for modifier in modifiers:
        base = base + modifier.log_psi
        placed = placed + modifier.log_psi
    log_odds = [base + table[:, :, correspondences.index(phi)] - inactive for phi in meant]
    return _Scored(
        tree,
        combos,
        meant,
        np.stack(log_odds, axis=2),
        active - inactive[0] + placed,
        active + placed,
        active,
        modifiers,
    )
