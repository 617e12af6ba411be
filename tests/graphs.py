"""Random models for the tests of the factor graph, and its solutions with a beam that leaves nothing out."""

from __future__ import annotations

from collections.abc import Iterable

from hypothesis import strategies as st
from making import LEXICON, SHADES, TRAINED, Pair, random_pair

from dcg_torch.grounding.features import Group
from dcg_torch.grounding.graph import FactorGraph
from dcg_torch.grounding.solution import Solution
from dcg_torch.types import Correspondence, ParseTree, WorldModel

EVERYTHING = 10**6
seeds = st.integers(0, 2**32)


def pair_of(groups: Iterable[Group], correspondences: tuple[Correspondence, ...], seed: int) -> Pair:
    return random_pair(frozenset(groups), correspondences, seed, nouns=LEXICON, colors=SHADES, phrases=TRAINED)


def solve(pair: Pair, tree: ParseTree, world: WorldModel, beam: int = EVERYTHING) -> Solution:
    return FactorGraph(tree, world).solve(pair.features, pair.model, beam=beam)


def best_score(solution: Solution) -> float:
    assert solution.best is not None
    return solution.best.log_score
