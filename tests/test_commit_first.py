"""Algorithm 1, lines 16 to 25: what the paper's learner takes from an outcome, and what it must not teach."""

from __future__ import annotations

from collections.abc import Callable

import pytest
import torch
from making import KNOWN, NOVEL, chosen, command_tree, log_psi, memory, noun_phrase, saw

from dcg_torch.grounding.features import Group
from dcg_torch.grounding.solution import Solution
from dcg_torch.language import Parser
from dcg_torch.learning.commit_first import (
    contrasts,
    new_symbol,
    replace_unknown,
    unsupervised_training,
    with_meant,
)
from dcg_torch.learning.labelling import described_alike, labelled
from dcg_torch.model import GroundingModel, Learned, TrainingSet, Variant
from dcg_torch.scene.upsilon import HYPOTHETICAL_UNKNOWN
from dcg_torch.types import (
    Child,
    Correspondence,
    Example,
    Grounding,
    GroundingKind,
    Object,
    ParseTree,
    PhraseKind,
    Symbol,
    WorldModel,
)

ACTIVE, INACTIVE, INVERTED = Correspondence.ACTIVE, Correspondence.INACTIVE, Correspondence.INVERTED
Pupil = Callable[[], GroundingModel]


def labels_of(example: Example) -> dict[str, Correspondence | None]:
    return dict(zip((o.id for o in example.world.objects), example.correspondences, strict=True))


class TestLine16:
    """T_u: the command's phrases, labelled by the outcome."""

    def test_every_phrase_with_its_grounding(self, trained: GroundingModel) -> None:
        world = saw(trained, "red cube", "blue sphere")
        solution = trained.ground(command_tree("cube", "red"), world)
        examples = unsupervised_training(solution)
        assert [e.phrase.kind for e in examples] == [PhraseKind.VERB, PhraseKind.PREPOSITION, PhraseKind.NOUN]
        assert all(labels_of(e)["0 red cube"] is ACTIVE for e in examples)
        assert all(e.world == world for e in examples)
        verb, preposition, noun = examples
        assert [c.grounding.kind for c in verb.children] == [GroundingKind.REGION]
        assert [c.grounding.kind for c in preposition.children] == [GroundingKind.OBJECT]
        assert noun.children == ()

    def test_what_was_not_meant_is_a_negative(self, trained: GroundingModel) -> None:
        solution = trained.ground(command_tree("cube", "red"), saw(trained, "red cube", "blue cube", "blue sphere"))
        labels = labels_of(unsupervised_training(solution)[-1])
        assert labels["1 blue cube"] is INACTIVE
        assert labels["2 blue sphere"] is INACTIVE
        assert labels["hypothetical sphere"] is INACTIVE
        assert labels[HYPOTHETICAL_UNKNOWN] is INACTIVE

    def test_what_was_meant_is_known_of_all_examples_however_they_came(self, trained: GroundingModel) -> None:
        """A learner that has heard them one after another asks for the contrasts of one that has them all at once."""
        model = trained.copy()
        for noun, things in (("cube", ("red cube", "blue box")), ("dax", ("red drill",)), ("cube", ("blue cube",))):
            model.learn(model.ground(command_tree(noun), saw(model, *things)))
        learner = memory(model)
        assert "dax" in learner.symbols
        anew = contrasts(with_meant({}, learner.examples), learner.symbols)
        found = learner.soft_labels(model.features)
        assert [(s.phrases, s.objects) for s in found] == [(s.phrases, s.objects) for s in anew]
        assert all((s.inactive == other.inactive).all() for s, other in zip(found, anew, strict=True))

    def test_what_is_described_as_well_is_neither(self, trained: GroundingModel) -> None:
        solution = trained.ground(command_tree("cube"), saw(trained, "red cube", "blue cube"))
        labels = labels_of(unsupervised_training(solution)[-1])
        assert (labels["0 red cube"], labels["1 blue cube"]) == (ACTIVE, None)
        assert labels["hypothetical cube"] is None

    def test_nothing_to_ground_to_teaches_nothing(self, trained: GroundingModel) -> None:
        empty = WorldModel(())
        assert unsupervised_training(Solution(command_tree("cube"), empty)) == []

    def test_an_inverted_grounding_is_labelled_so(self, trained: GroundingModel) -> None:
        tree = command_tree("cube", "red", verb=("stay",), preposition="away from")
        examples = unsupervised_training(trained.ground(tree, saw(trained, "red cube", "blue sphere")))
        signs = {e.phrase.kind: labels_of(e)["0 red cube"] for e in examples}
        assert signs == {PhraseKind.VERB: ACTIVE, PhraseKind.PREPOSITION: INVERTED, PhraseKind.NOUN: ACTIVE}

    @pytest.mark.parametrize(
        ("color", "one", "other", "alike"),
        [
            (None, "red cube", "blue cube", True),
            ("red", "red cube", "blue cube", False),
            ("red", "red cube", "red cube", True),
            (None, "red cube", "red sphere", False),
        ],
    )
    def test_described_alike(
        self, trained: GroundingModel, color: str | None, one: str, other: str, alike: bool
    ) -> None:
        a, b = saw(trained, one, other).objects[:2]
        assert described_alike(noun_phrase("cube", color), a, b) is alike

    def test_a_hypothetical_is_not_described_like_a_perceived_one(self, trained: GroundingModel) -> None:
        objects = saw(trained, "red cube").objects
        unseen = next(o for o in objects if o.id == "hypothetical cube")
        assert not described_alike(noun_phrase("cube"), unseen, objects[0])

    def test_in_a_hand_made_example_the_unseen_one_is_a_negative(self, trained: GroundingModel) -> None:
        """There it teaches the preference for what is in view."""
        world = saw(trained, "red cube")
        meant = Child(Grounding(GroundingKind.OBJECT, world.objects[0]))
        assert labels_of(labelled(noun_phrase("cube"), meant, (), world))["hypothetical cube"] is INACTIVE


class TestLines17And18:
    """gamma': only an unknown noun that met a perceived object of unknown type."""

    def lesson(
        self, model: GroundingModel, noun: str | None, about: str, color: str | None = None
    ) -> tuple[Symbol | None, str | None]:
        """What is learned if the object named were the one that the noun was grounded to, or why nothing is."""
        world = saw(model, "red cube", "blue drill")
        obj = next(o for o in world.objects if o.id == about)
        solution = model.ground(ParseTree(noun_phrase(noun, color)), WorldModel((obj,)))
        assert solution.object == obj
        return new_symbol(solution, model.symbols)

    def test_line_17_unknown_noun_and_unknown_object(self, trained: GroundingModel) -> None:
        assert self.lesson(trained, "gizmo", "1 blue drill") == (Symbol("gizmo", "drill", "blue", None), None)

    @pytest.mark.parametrize(
        ("noun", "about", "reason"),
        [
            ("cube", "1 blue drill", "'cube' is known already"),
            ("gizmo", "0 red cube", "the object meant is of a known type, 'cube'"),
            ("gizmo", HYPOTHETICAL_UNKNOWN, "what is meant has not been seen"),
            ("gizmo", "hypothetical cube", "what is meant has not been seen"),
            (None, "1 blue drill", "the command names no noun"),
        ],
    )
    def test_line_17_what_teaches_no_symbol_has_a_reason(
        self, trained: GroundingModel, noun: str | None, about: str, reason: str
    ) -> None:
        assert self.lesson(trained, noun, about) == (None, reason)

    def test_line_17_nothing_grounded_no_symbol(self, trained: GroundingModel) -> None:
        symbol, reason = new_symbol(Solution(command_tree("gizmo"), WorldModel(())), trained.symbols)
        assert symbol is None
        assert reason is not None
        assert "not grounded" in reason

    def test_line_17_a_stale_solution_teaches_no_second_word(self, pupil: Pupil) -> None:
        """Grounded before the thing was named by another word."""
        model = pupil()
        world = saw(model, "red cube", "blue drill")
        one, other = (model.ground(command_tree(word), world) for word in ("gizmo", "gadget"))
        assert model.learn(one).symbol == Symbol("gizmo", "drill", "blue", None)
        assert model.learn(other).reason == "the object meant is of a known type, 'drill'"
        assert "gadget" not in model.symbols

    def test_line_18_the_symbol_keeps_word_type_and_colors(self, trained: GroundingModel) -> None:
        assert self.lesson(trained, "gizmo", "1 blue drill", "azure")[0] == Symbol("gizmo", "drill", "blue", "azure")


@pytest.fixture(scope="module")
def taught(pupil: Pupil) -> GroundingModel:
    """It has heard "the azure gizmo" of a teal drill."""
    model = pupil()
    learned = model.learn(model.ground(command_tree("gizmo", "azure"), saw(model, "red cube", "teal drill")))
    assert learned == Learned(Symbol("gizmo", "drill", "teal", "azure"))
    return model


class TestLines19To22:
    """The symbol enters M.Gamma and M.F."""

    def test_line_19_gamma(self, taught: GroundingModel) -> None:
        assert taught.known_types == (*KNOWN, "drill")
        assert taught.symbols["gizmo"].type == "drill"

    def test_line_20_f_word(self, taught: GroundingModel, trained: GroundingModel) -> None:
        assert taught.features.knows_noun("gizmo")
        assert not trained.features.knows_noun("gizmo")

    def test_line_21_f_color(self, taught: GroundingModel) -> None:
        drill = Object("a", "drill", True, color="teal")
        assert "color: teal" in taught.features.object_names(drill)
        assert "color: azure" in taught.features.language_names(noun_phrase("cube", "azure"))

    def test_line_22_f_obj(self, taught: GroundingModel) -> None:
        assert "type: drill" in taught.features.object_names(Object("a", "drill", True))

    def test_growth_leaves_old_probabilities_to_the_bit(self, trained: GroundingModel, pupil: Pupil) -> None:
        """Of all that neither the new word nor the new type nor its colours occur in; before the retraining."""
        model = pupil()
        world = saw(model, "red cube", "green sphere", "blue cylinder")
        phrases = [noun_phrase("cube", "red"), noun_phrase("sphere"), noun_phrase("wug", "blue"), noun_phrase(None)]
        before = [log_psi(model.features, model.factor, p, world) for p in phrases]
        for noun in NOVEL:
            model.features = model.features.grow(Symbol(noun, noun, "teal", "teal"))
            model.factor.grow(model.features.pairs)
            for phrase, old in zip(phrases, before, strict=True):
                assert torch.equal(log_psi(model.features, model.factor, phrase, world), old)


class TestLine23InTheModel:
    """What a lesson makes known is renewed in all of T."""

    def test_of_the_whole_training_set(self, pupil: Pupil) -> None:
        """A drill that was passed over in an earlier command is a known thing in that example from now on."""
        model = pupil()
        model.learn(model.ground(command_tree("cube"), saw(model, "red cube", "blue drill")))
        model.learn(model.ground(command_tree("drill"), saw(model, "blue drill")))
        drills = [o for e in memory(model).examples for o in e.world.objects if o.type == "drill"]
        assert drills
        assert all(o.known for o in drills)

    def test_no_lesson_erases_what_unknown_means(self, pupil: Pupil, training: TrainingSet) -> None:
        """The nouns and types that teach it are invented, so they stay as they were."""
        model = pupil()
        for noun in NOVEL:
            model.learn(model.ground(command_tree(noun), saw(model, f"red {noun}")))
        assert memory(model).examples[: len(training.examples)] == training.examples
        assert chosen(model, command_tree("blork"), saw(model, "red cube", "red blork", "red drill")).type == "blork"


class TestLines24And25:
    def test_line_24_the_lesson_is_added(self, pupil: Pupil) -> None:
        model = pupil()
        before = memory(model).examples
        solution = model.ground(command_tree("drill"), saw(model, "red cube", "blue drill"))
        model.learn(solution)
        assert memory(model).examples[: len(before)] == before
        lesson = replace_unknown(unsupervised_training(solution), model.known_types)
        assert memory(model).examples[len(before) :] == tuple(lesson)

    def test_line_24_without_a_new_symbol_too(self, pupil: Pupil) -> None:
        model = pupil()
        before = len(memory(model).examples)
        learned = model.learn(model.ground(command_tree("cube"), saw(model, "red cube")))
        assert (learned.symbol, learned.reason) == (None, "'cube' is known already")
        assert len(memory(model).examples) == before + 3

    def test_line_25_retrained_on_all(self, pupil: Pupil) -> None:
        model = pupil()
        start, columns = model.fitted, model.features.shape
        model.learn(model.ground(command_tree("drill"), saw(model, "blue drill")))
        assert model.fitted is not None
        assert model.fitted is not start
        assert model.fitted.status == "converged"
        assert model.factor.weight.shape[1:] == model.features.shape > columns
        column = model.features.language["noun: drill"], model.features.grounding["type: drill"]
        assert model.factor.weight[:, column[0], column[1]].abs().max() > 0.1

    def test_the_learned_word_finds_the_learned_thing(self, pupil: Pupil) -> None:
        model = pupil()
        model.learn(model.ground(command_tree("drill", "blue"), saw(model, "red cube", "blue drill")))
        world = saw(model, "blue mailbox", "red cube", "red drill")
        assert chosen(model, command_tree("drill"), world).id == "2 red drill"
        assert chosen(model, command_tree("drill"), saw(model, "blue mailbox", "red cube")).id == "hypothetical drill"

    def test_the_next_unknown_word_is_no_longer_the_old_thing(self, pupil: Pupil) -> None:
        """The crate of the laboratory demonstration is not the cone (Section IV-D)."""
        model = pupil()
        model.learn(model.ground(command_tree("cone"), saw(model, "orange cone")))
        assert chosen(model, command_tree("crate"), saw(model, "orange cone")).id == HYPOTHETICAL_UNKNOWN
        assert chosen(model, command_tree("crate"), saw(model, "orange cone", "brown crate")).type == "crate"

    def test_a_noun_of_two_words_is_one_symbol(self, pupil: Pupil, parser: Parser) -> None:
        model = pupil()
        tree = parser.parse("please drive to the red fire hydrant", model.symbols).tree
        assert tree is not None
        learned = model.learn(model.ground(tree, saw(model, "red cube", "red fire hydrant")))
        assert learned.symbol == Symbol("fire hydrant", "fire hydrant", "red", "red")
        assert model.features.knows_noun("fire hydrant")
        assert not model.features.knows_noun("hydrant")
        assert not model.features.knows_noun("fire")

    def test_a_variant_that_does_not_learn(self, training: TrainingSet) -> None:
        model = GroundingModel.trained(training, Variant(groups=frozenset({Group.DCG}), learns=False))
        before, weight = memory(model).examples, model.factor.weight.clone()
        learned = model.learn(model.ground(command_tree("cube"), saw(model, "red cube")))
        assert learned == Learned(reason="this variant does not learn")
        assert memory(model).examples == before
        assert torch.equal(model.factor.weight, weight)

    def test_one_outcome_one_model(self, pupil: Pupil) -> None:
        """The same lessons give the same bits."""
        ends = []
        for model in (pupil(), pupil()):
            for noun in ("drill", "mailbox"):
                model.learn(model.ground(command_tree(noun), saw(model, f"red {noun}", "blue cube")))
            ends.append(model.factor.weight)
        assert torch.equal(*ends)

    def test_a_lesson_is_outweighed_by_no_color(self, pupil: Pupil) -> None:
        """Learned from a red one, "drill" means drills of any colour, and nothing else that is red."""
        model = pupil()
        model.learn(model.ground(command_tree("drill", "red"), saw(model, "red drill")))
        assert chosen(model, command_tree("drill"), saw(model, "red cube", "red mailbox", "blue drill")).type == "drill"
