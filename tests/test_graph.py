"""The factor graph against an enumeration of eqs. 2 to 9, and the manners of its search."""

from __future__ import annotations

import itertools
import math

import networkx as nx
import numpy as np
import pytest
from graphs import best_score, pair_of, seeds, solve
from hypothesis import given, settings
from hypothesis import strategies as st
from making import (
    LEXICON,
    TRAINED,
    VARIANTS,
    command_tree,
    log_psi,
    noun_phrase,
    noun_trees,
    nouns,
    prepositions,
    random_pair,
    trees,
    verb_phrase,
    verbs,
    worlds,
)
from oracle import KIND, Configuration

from dcg_torch.fitting.psi import BINARY, TERNARY
from dcg_torch.grounding.features import Group
from dcg_torch.grounding.graph import FactorGraph
from dcg_torch.grounding.hypotheses import Hypothesis
from dcg_torch.grounding.solution import Solution
from dcg_torch.grounding.thing_values import ByThing
from dcg_torch.types import (
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

both_settings = pytest.mark.parametrize("correspondences", [BINARY, TERNARY], ids=["binary", "ternary"])
each_variant = pytest.mark.parametrize("groups", VARIANTS.values(), ids=VARIANTS.keys())


def configuration(hypothesis: Hypothesis) -> Configuration:
    return Configuration(hypothesis.child, tuple(configuration(h) for h in hypothesis.children))


def meant(chosen: Configuration) -> str:
    """Id of the object of the first noun phrase from the root."""
    if chosen.child.grounding.kind is GroundingKind.OBJECT or not chosen.below:
        return chosen.child.grounding.object.id
    return meant(chosen.below[0])


@st.composite
def child_groundings(draw: st.DrawFn, world: WorldModel) -> tuple[Child, ...]:
    """No, one or two child groundings in a world."""
    return tuple(
        Child(
            Grounding(draw(st.sampled_from(GroundingKind)), draw(st.sampled_from(world.objects))),
            draw(st.sampled_from([Correspondence.ACTIVE, Correspondence.INVERTED])),
        )
        for _ in range(draw(st.integers(0, 2)))
    )


class TestFactors:
    """log Psi of every (phrase, grounding, children) is that of the equations."""

    @both_settings
    @each_variant
    @settings(max_examples=15)
    @given(data=st.data())
    def test_equal_the_equations(
        self, groups: frozenset[Group], correspondences: tuple[Correspondence, ...], data: st.DataObject
    ) -> None:
        pair = pair_of(groups, correspondences, data.draw(seeds))
        world = data.draw(worlds(4))
        phrase: Phrase = data.draw(st.one_of(nouns, verbs, prepositions))
        # In the paper's trees a noun phrase is a leaf.
        children = () if phrase.kind is PhraseKind.NOUN else data.draw(child_groundings(world))
        found = log_psi(pair.features, pair.model, phrase, world, children).tolist()
        for obj, row in zip(world.objects, found, strict=True):
            expected = pair.oracle.log_psi(phrase, Grounding(KIND[phrase.kind], obj), children)
            assert row == pytest.approx([expected[phi] for phi in correspondences], abs=1e-12)

    @settings(max_examples=30)
    @given(groups=st.sets(st.sampled_from(sorted(VARIANTS["dcg_upup_away_color"]))), seed=seeds, data=st.data())
    def test_any_choice_of_groups(self, groups: set[Group], seed: int, data: st.DataObject) -> None:
        pair = pair_of(groups, TERNARY, seed)
        world, phrase = data.draw(worlds(3)), data.draw(nouns)
        for obj, row in zip(world.objects, log_psi(pair.features, pair.model, phrase, world).tolist(), strict=True):
            expected = pair.oracle.log_psi(phrase, Grounding(GroundingKind.OBJECT, obj), ())
            assert row == pytest.approx(list(expected.values()), abs=1e-12)

    def test_by_hand(self) -> None:
        """One feature of weight ln 3: 3 / (1 + 1 + 3) over {-1, 0, 1} (eq. 4), 3 / (1 + 3) over {0, 1} (eq. 6)."""
        cube = WorldModel((Object("a", "cube", True),))
        for correspondences, expected in ((TERNARY, 3 / 5), (BINARY, 3 / 4)):
            pair = pair_of({Group.DCG}, correspondences, 0)
            pair.model.weight.zero_()
            word, kind = pair.features.language["noun: cube"], pair.features.grounding["type: cube"]
            pair.model.weight[correspondences.index(Correspondence.ACTIVE), word, kind] = math.log(3)
            row = log_psi(pair.features, pair.model, noun_phrase("cube"), cube)[0]
            assert math.exp(row[correspondences.index(Correspondence.ACTIVE)]) == pytest.approx(expected)

    @pytest.mark.parametrize(
        ("group", "one", "other"),
        [
            (Group.DCG, Object("a", "cube", True), Object("a", "cone", True)),
            (Group.UNKNOWN, Object("a", "drill", True), Object("a", "drill", False)),
            (Group.HYPOTHETICAL, Object("a", "cube", True), Object("a", "cube", True, hypothetical=True)),
            (Group.COLOR, Object("a", "cube", True, color="red"), Object("a", "cube", True, color="orange")),
        ],
    )
    def test_each_group_tells_one_thing(self, group: Group, one: Object, other: Object) -> None:
        """Eqs. 4, 6, 8, 9: a property matters if and only if its group is on."""
        every = VARIANTS["dcg_upup_away_color"]
        phrase = noun_phrase("cube", "red")
        for groups, matters in ((every, True), (every - {group}, False)):
            pair = pair_of(groups, TERNARY, 7)
            rows = [log_psi(pair.features, pair.model, phrase, WorldModel((o,))) for o in (one, other)]
            assert rows[0].equal(rows[1]) is not matters


class TestExactSearch:
    """With a beam as wide as there are hypotheses, `solve` is the enumeration of all configurations."""

    @both_settings
    @each_variant
    @settings(max_examples=12)
    @given(tree=trees, world=worlds(3), seed=seeds)
    def test_equals_the_enumeration(
        self,
        groups: frozenset[Group],
        correspondences: tuple[Correspondence, ...],
        tree: ParseTree,
        world: WorldModel,
        seed: int,
    ) -> None:
        pair = pair_of(groups, correspondences, seed)
        scores, shares = pair.oracle.solve(tree, world)
        solution = solve(pair, tree, world)
        assert solution.best is not None
        top = max(scores.values())
        assert solution.best.log_score == pytest.approx(top, abs=1e-10)
        assert scores[configuration(solution.best)] == pytest.approx(top, abs=1e-10)
        runners_up = [s for s in scores.values() if s < top - 1e-9]
        if len(runners_up) == len(scores) - 1:  # no tie
            assert configuration(solution.best) == max(scores, key=scores.__getitem__)
        assert dict(solution.probabilities) == pytest.approx(shares, abs=1e-10)
        assert solution.object is not None
        assert solution.probability == solution.probabilities[solution.object.id]

    @settings(max_examples=15)
    @given(tree=trees, world=worlds(3), seed=seeds)
    def test_every_hypothesis_carries_its_own_score(self, tree: ParseTree, world: WorldModel, seed: int) -> None:
        pair = pair_of(VARIANTS["dcg_upup_away_color"], TERNARY, seed)
        best = solve(pair, tree, world).best
        assert best is not None
        for h in best.walk():
            expected = pair.oracle.log_probability(h.tree, world, configuration(h))
            assert h.log_score == pytest.approx(expected, abs=1e-10)

    @settings(max_examples=25)
    @given(tree=trees, world=worlds(3), seed=seeds)
    def test_the_runner_up_is_the_best_about_another_object(
        self, tree: ParseTree, world: WorldModel, seed: int
    ) -> None:
        pair = pair_of(VARIANTS["dcg_upup_away_color"], TERNARY, seed)
        scores, _ = pair.oracle.solve(tree, world)
        solution = solve(pair, tree, world)
        assert solution.best is not None
        others = {c: s for c, s in scores.items() if meant(c) != meant(configuration(solution.best))}
        if not others:
            assert solution.runner_up is None
            return
        assert solution.runner_up is not None
        assert meant(configuration(solution.runner_up)) != meant(configuration(solution.best))
        assert solution.runner_up.log_score == pytest.approx(max(others.values()), abs=1e-10)
        assert scores[configuration(solution.runner_up)] == pytest.approx(max(others.values()), abs=1e-10)

    def test_exactly_one_grounding_for_each_phrase(self) -> None:
        world = WorldModel((Object("a", "cube", True), Object("b", "cone", True)))
        solution = solve(pair_of(VARIANTS["dcg"], TERNARY, 3), command_tree("cube"), world)
        assert solution.best is not None
        kinds = [h.child.grounding.kind for h in solution.best.walk()]
        assert kinds == [GroundingKind.ACTION, GroundingKind.REGION, GroundingKind.OBJECT]
        assert all(h.child.correspondence is not Correspondence.INACTIVE for h in solution.best.walk())


class TestBeam:
    @settings(max_examples=40)
    @given(tree=trees, world=worlds(4), seed=seeds, beam=st.integers(1, 6))
    def test_a_narrow_one_finds_nothing_better(self, tree: ParseTree, world: WorldModel, seed: int, beam: int) -> None:
        pair = pair_of(VARIANTS["dcg_upup_away_color"], TERNARY, seed)
        exact, narrow = solve(pair, tree, world), solve(pair, tree, world, beam)
        assert best_score(narrow) <= best_score(exact)
        assert narrow.best is not None
        expected = pair.oracle.log_probability(tree, world, configuration(narrow.best))
        assert best_score(narrow) == pytest.approx(expected, abs=1e-10)
        assert math.fsum(narrow.probabilities.values()) == pytest.approx(1.0)

    @given(tree=noun_trees, world=worlds(4), seed=seeds)
    def test_a_single_phrase_needs_none(self, tree: ParseTree, world: WorldModel, seed: int) -> None:
        pair = pair_of(VARIANTS["dcg_upup_away_color"], TERNARY, seed)
        exact, narrow = solve(pair, tree, world), solve(pair, tree, world, 1)
        assert (narrow.best, narrow.probabilities) == (exact.best, exact.probabilities)

    def test_the_width_counts(self) -> None:
        """What no hypothesis of the child names, a parent that follows its child takes for improbable."""
        world = WorldModel((Object("a", "cube", True), Object("b", "cone", True)))
        pair = random_pair(VARIANTS["dcg"], BINARY, 0, nouns=LEXICON, colors=(), phrases=TRAINED)
        pair.model.weight.zero_()
        active = pair.model.weight[BINARY.index(Correspondence.ACTIVE)]
        active[pair.features.language["noun: cube"], pair.features.grounding["type: cube"]] = 0.1
        active[pair.features.language["verb: go"], pair.features.grounding["child: object, same, active"]] = 9.0
        tree = ParseTree(verb_phrase("go"), (ParseTree(noun_phrase("cube")),))
        assert 0.5 < solve(pair, tree, world, 2).probabilities["a"] < 0.6
        assert solve(pair, tree, world, 1).probabilities["a"] > 0.99


class TestGraph:
    TREE = command_tree("cube")
    WORLD = WorldModel((Object("a", "cube", True), Object("b", "cone", True)))

    def test_the_parse_tree(self) -> None:
        graph = FactorGraph(self.TREE, self.WORLD).phrases
        order = [graph.nodes[n]["tree"].phrase.kind for n in nx.topological_sort(graph)]
        assert order == [PhraseKind.NOUN, PhraseKind.PREPOSITION, PhraseKind.VERB]

    def test_nothing_to_ground_to(self) -> None:
        solution = solve(pair_of(VARIANTS["dcg"], TERNARY, 0), self.TREE, WorldModel(()))
        assert (solution.best, solution.object, solution.noun, solution.probability) == (None, None, None, None)
        assert not solution.inverted
        assert dict(solution.probabilities) == {}

    def test_the_noun_of_the_object_meant(self) -> None:
        solution = solve(pair_of(VARIANTS["dcg"], TERNARY, 0), self.TREE, self.WORLD)
        assert solution.noun == noun_phrase("cube")


@pytest.mark.parametrize(
    "signs", list(itertools.product([Correspondence.ACTIVE, Correspondence.INVERTED], repeat=2)), ids=str
)
def test_two_inversions_cancel(signs: tuple[Correspondence, Correspondence]) -> None:
    """ "Do not stay away from the cube" is no wish to keep away."""
    world = WorldModel((Object("a", "cube", True),))
    tree = command_tree("cube")
    region, action = signs
    obj = world.objects[0]
    leaf = tree.children[0].children[0]
    best = Hypothesis(leaf, Child(Grounding(GroundingKind.OBJECT, obj)), (), 0.0)
    best = Hypothesis(tree.children[0], Child(Grounding(GroundingKind.REGION, obj), region), (best,), 0.0)
    best = Hypothesis(tree, Child(Grounding(GroundingKind.ACTION, obj), action), (best,), 0.0)
    assert Solution(tree, world, best).inverted is (region != action)


def test_values_by_id_are_a_mapping_of_the_first_things() -> None:
    found = ByThing({"a": 0, "b": 1, "place": 2}, np.array([0.25, 0.75]))
    assert dict(found) == {"a": 0.25, "b": 0.75} == found
    assert len(found) == 2
    assert "place" not in found
    with pytest.raises(KeyError):
        found["place"]


def test_a_mixture_of_values_by_id_is_of_the_same_things_alone() -> None:
    number = {"a": 0, "b": 1, "place": 2}
    one, other = ByThing(number, np.array([0.25, 0.75])), ByThing(number, np.array([1.0, 0.0]))
    mixed = ByThing.mixture([one, other], [0.5, 0.5])
    assert mixed is not None
    assert dict(mixed) == {"a": 0.625, "b": 0.375}
    assert repr(one) == "{'a': 0.25, 'b': 0.75}"
    assert ByThing.mixture([one, ByThing({"a": 0, "c": 1}, np.array([1.0, 0.0]))], [0.5, 0.5]) is None
    assert ByThing.mixture([one, {"a": 1.0, "b": 0.0}], [0.5, 0.5]) is None
