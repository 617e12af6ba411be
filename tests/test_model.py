"""The model that users import, and what makes its variants differ."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import pytest
import torch
from hypothesis import given
from hypothesis import strategies as st
from making import (
    COLORS,
    KNOWN,
    VARIANTS,
    command_tree,
    memory,
    noun_phrase,
    percept,
    preposition_phrase,
    saw,
    verb_phrase,
)

from dcg_torch.fitting.fit import fit
from dcg_torch.fitting.psi import BINARY, TERNARY, LogLinearFactor
from dcg_torch.grounding.encoding import encode
from dcg_torch.model import GroundingModel, TrainingSet, Variant
from dcg_torch.scene.upsilon import HYPOTHETICAL_UNKNOWN
from dcg_torch.types import Correspondence, ParseTree, PhraseKind, Pose

SETTINGS = {
    "dcg": Variant(VARIANTS["dcg"], unknown=False, hypothetical=False, learns=False),
    "dcg_upup": Variant(VARIANTS["dcg_upup"], hypothetical=False),
    "dcg_upup_away": Variant(VARIANTS["dcg_upup_away"]),
    "dcg_upup_away_color": Variant(VARIANTS["dcg_upup_away_color"]),
}
SEEN = ("blue drill", "red cube", "blue cube")


@pytest.fixture(scope="module")
def variants(training: TrainingSet) -> dict[str, GroundingModel]:
    return {name: GroundingModel.trained(training, variant) for name, variant in SETTINGS.items()}


def grounded(model: GroundingModel, noun: str | None, color: str | None, *seen: str) -> str | None:
    obj = model.ground(command_tree(noun, color), saw(model, *seen)).object
    return None if obj is None else obj.id


class TestVariants:
    def test_what_enters_the_world_model(self, variants: dict[str, GroundingModel]) -> None:
        """Fig. 4: only what is known, then also the unknown, then also what is unseen."""
        ids = {name: [o.id for o in saw(model, *SEEN).objects] for name, model in variants.items()}
        assert ids["dcg"] == ["1 red cube", "2 blue cube"]
        assert ids["dcg_upup"] == ["0 blue drill", "1 red cube", "2 blue cube"]
        unseen = [*(f"hypothetical {t}" for t in KNOWN), HYPOTHETICAL_UNKNOWN]
        assert ids["dcg_upup_away"] == ids["dcg_upup_away_color"] == [*ids["dcg_upup"], *unseen]

    @pytest.mark.parametrize(
        ("name", "drill", "sphere", "blue_cube"),
        [
            ("dcg", "1 red cube", "1 red cube", "1 red cube"),
            ("dcg_upup", "0 blue drill", None, "1 red cube"),
            ("dcg_upup_away", "0 blue drill", "hypothetical sphere", "1 red cube"),
            ("dcg_upup_away_color", "0 blue drill", "hypothetical sphere", "2 blue cube"),
        ],
    )
    def test_what_each_can_do(
        self, variants: dict[str, GroundingModel], name: str, drill: str, sphere: str | None, blue_cube: str
    ) -> None:
        """An unknown word, a known thing that is out of view, a colour; whoever can't takes the first cube."""
        model = variants[name]
        assert grounded(model, "drill", None, *SEEN) == drill
        if sphere is not None:
            assert grounded(model, "sphere", None, *SEEN) == sphere
        assert grounded(model, "cube", "blue", *SEEN) == blue_cube

    def test_only_dcg_learns_nothing(self, training: TrainingSet) -> None:
        for name, variant in SETTINGS.items():
            model = GroundingModel.trained(training, variant)
            learned = model.learn(model.ground(command_tree("drill"), saw(model, *SEEN)))
            assert bool(learned) is (name != "dcg")
            assert (learned.reason is None) is bool(learned)

    def test_examples_of_what_a_variant_does_not_represent_are_left_out(
        self, variants: dict[str, GroundingModel], training: TrainingSet
    ) -> None:
        kept = {name: len(memory(model).examples) for name, model in variants.items()}
        assert kept["dcg"] < kept["dcg_upup"] < kept["dcg_upup_away"] == kept["dcg_upup_away_color"]
        assert kept["dcg_upup_away_color"] == len(training.examples)
        for name in ("dcg", "dcg_upup"):
            objects = [o for e in memory(variants[name]).examples for o in e.world.objects]
            assert not any(o.hypothetical for o in objects)
            assert name != "dcg" or all(o.known for o in objects)
            for e in memory(variants[name]).examples:
                assert len(e.correspondences) == len(e.world.objects)
                assert any(e.correspondences)

    def test_binary_leaves_inverted_out(self, binary: GroundingModel, trained: GroundingModel) -> None:
        assert (binary.factor.correspondences, trained.factor.correspondences) == (BINARY, TERNARY)
        labels = {c for e in memory(binary).examples for c in e.correspondences}
        assert Correspondence.INVERTED not in labels
        assert Correspondence.INVERTED in {c for e in memory(trained).examples for c in e.correspondences}
        assert not any(c.correspondence is Correspondence.INVERTED for e in memory(binary).examples for c in e.children)

    def test_an_empty_world(self, variants: dict[str, GroundingModel]) -> None:
        assert grounded(variants["dcg"], "cube", None) is None
        assert grounded(variants["dcg_upup"], "drill", None) is None
        assert grounded(variants["dcg_upup_away"], "drill", None) == HYPOTHETICAL_UNKNOWN

    def test_a_lesson_of_nothing_changes_nothing(self, training: TrainingSet) -> None:
        model = GroundingModel.trained(training, SETTINGS["dcg_upup"])
        before, weight = memory(model).examples, model.factor.weight.clone()
        learned = model.learn(model.ground(command_tree("cube"), saw(model)))
        assert learned.reason == "there is nothing here to mean"
        assert memory(model).examples == before
        assert torch.equal(model.factor.weight, weight)


class TestTraining:
    def test_the_optimum_depends_on_the_examples_alone(self, pupil: Callable[[], GroundingModel]) -> None:
        """Training anew from zero ends where the warm start of a retraining does."""
        model = pupil()
        model.learn(model.ground(command_tree("drill"), saw(model, *SEEN)))
        warm = model.factor.weight.clone()
        model.factor.set_weight(torch.zeros_like(warm))
        model.train()
        assert model.factor.weight.numpy() == pytest.approx(warm.numpy(), abs=0.02)

    def test_it_fits_again_only_where_something_has_changed(self, pupil: Callable[[], GroundingModel]) -> None:
        model = pupil()
        model.learn(model.ground(command_tree("drill"), saw(model, *SEEN)))
        learned = model.fitted
        assert learned is not None
        weight = model.factor.weight.clone()
        assert model.train() is learned
        assert torch.equal(model.factor.weight, weight)
        model.factor.set_weight(torch.zeros_like(weight))
        assert model.train() is not learned
        assert model.factor.weight.abs().max() > 1.0
        model.learn(model.ground(command_tree("mug"), saw(model, "red mug", *SEEN)))
        assert model.fitted is not learned

    def test_table_rows_are_the_labelled_factors(self, trained: GroundingModel) -> None:
        tables = encode(memory(trained).examples, trained.features, TERNARY)
        labelled = sum(e.weight for e in memory(trained).examples for c in e.correspondences if c is not None)
        assert sum(float(t.count.sum()) for t in tables) == labelled

    def test_a_weight_counts_as_copies(self, trained: GroundingModel) -> None:
        one = memory(trained).examples[0]
        ends = []
        for examples in ([replace(one, weight=3.0)], [one] * 3):
            factor = LogLinearFactor(trained.features.pairs, TERNARY)
            fit(factor, encode(examples, trained.features, TERNARY), l2=0.1)
            ends.append(factor.weight)
        assert torch.equal(*ends)

    def test_nothing_to_train_on(self, trained: GroundingModel) -> None:
        assert encode([], trained.features, TERNARY) == []


class TestGround:
    def test_the_poses_are_kept(self, trained: GroundingModel) -> None:
        world = trained.world_model([percept("red cube")], Pose(1.0, 2.0, 3.0), Pose(4.0, 5.0))
        assert (world.robot, world.speaker) == (Pose(1.0, 2.0, 3.0), Pose(4.0, 5.0))

    def test_only_the_path_to_the_object_meant_is_read(self, trained: GroundingModel) -> None:
        """The paper's features know nothing of landmarks, nor of a second place."""
        world = saw(trained, *SEEN)
        plain = command_tree("cube", "blue")
        landmark = ParseTree(preposition_phrase("behind"), (ParseTree(noun_phrase("drill")),))
        noun = ParseTree(noun_phrase("cube", "blue"), (landmark,))
        rich = ParseTree(verb_phrase("go"), (ParseTree(preposition_phrase("to"), (noun,)), landmark))
        assert dict(trained.ground(rich, world).probabilities) == dict(trained.ground(plain, world).probabilities)

    def test_a_bare_noun_phrase(self, trained: GroundingModel) -> None:
        tree = ParseTree(verb_phrase(), (ParseTree(noun_phrase("cube", "blue")),))
        solution = trained.ground(tree, saw(trained, *SEEN))
        assert solution.object is not None
        assert solution.object.id == "2 blue cube"
        assert not solution.inverted

    def test_a_pronoun_goes_by_its_color(self, trained: GroundingModel) -> None:
        assert grounded(trained, None, "blue", "red sphere", "blue cube") == "1 blue cube"

    @given(seen=st.lists(st.tuples(st.sampled_from(COLORS), st.sampled_from(KNOWN)).map(" ".join), max_size=12))
    def test_probabilities(self, trained: GroundingModel, seen: list[str]) -> None:
        """One for each object, summing to one, the same whenever it is asked."""
        world, tree = saw(trained, *seen), command_tree("cube", "red")
        solution = trained.ground(tree, world)
        assert set(solution.probabilities) == {o.id for o in world.objects}
        assert sum(solution.probabilities.values()) == pytest.approx(1.0)
        assert all(0.0 <= p <= 1.0 for p in solution.probabilities.values())
        again = trained.ground(tree, world)
        assert (again.best, dict(again.probabilities)) == (solution.best, dict(solution.probabilities))

    def test_a_solution_tells_its_phrases(self, trained: GroundingModel) -> None:
        solution = trained.ground(command_tree("cube", "blue"), saw(trained, *SEEN))
        assert solution.best is not None
        assert [h.tree.phrase.kind for h in solution.best.walk()] == [
            PhraseKind.VERB,
            PhraseKind.PREPOSITION,
            PhraseKind.NOUN,
        ]
        assert solution.noun == noun_phrase("cube", "blue")
