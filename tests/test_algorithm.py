"""Algorithm 1, lines 1 to 15: the model before the first command, and how a command is heard, grounded, acted on."""

from __future__ import annotations

import math
from collections.abc import Callable, Collection

import numpy as np
import pytest
from making import COLORS, KNOWN, NOVEL, Read, SpyRobot, command_tree, percept, read, saw, world_file

from dcg_torch.agent.command import carry_out
from dcg_torch.experiment.trial import run_trial
from dcg_torch.grounding.graph import FactorGraph
from dcg_torch.language import Parser
from dcg_torch.learning.commit_first import CommitFirst
from dcg_torch.model import GroundingModel, TrainingSet, Variant
from dcg_torch.scene.upsilon import HYPOTHETICAL_UNKNOWN, hypothesize_objects, perceive_objects
from dcg_torch.simulator import FakeRobot
from dcg_torch.types import Correspondence, Example, ParseTree, PhraseKind
from dcg_torch.world.files import World
from dcg_torch.world.speaker import Command

ACTIVE = Correspondence.ACTIVE
Pupil = Callable[[], GroundingModel]


def told(model: GroundingModel, text: str, world: World) -> list[str]:
    robot = SpyRobot()
    robot.load(world)
    carry_out(text, model, robot, parse=read, spin_step=math.radians(45))
    return robot.told


class TestLines1To6:
    """The model before the first command."""

    def test_line_2_a_model_of_the_kind_asked_for(self, trained: GroundingModel) -> None:
        assert trained.variant == Variant()
        assert trained.variant.unknown
        assert trained.variant.hypothetical
        assert trained.features.groups == trained.variant.groups

    def test_line_3_the_initial_groundings(self, trained: GroundingModel) -> None:
        assert trained.known_types == KNOWN
        assert {w: s.type for w, s in trained.symbols.items()} == {t: t for t in KNOWN}

    def test_line_4_the_initial_features(self, trained: GroundingModel) -> None:
        assert {n for n in (*KNOWN, *NOVEL, "dax", "wug") if trained.features.knows_noun(n)} == set(KNOWN)
        for color in COLORS:
            assert f"color: {color}" in trained.features.language
            assert f"color: {color}" in trained.features.grounding
        assert {"verb: go", "verb: avoid", "preposition: to", "preposition: away from"} <= set(
            trained.features.language
        )

    def test_line_5_the_initial_training_set(self, trained: GroundingModel, training: TrainingSet) -> None:
        nouns = [e for e in training.examples if e.phrase.kind is PhraseKind.NOUN]
        assert len(nouns) == 53
        assert all(sum(c == ACTIVE for c in e.correspondences) == 1 for e in nouns)
        assert isinstance(trained.learner, CommitFirst)
        assert trained.learner.examples == training.examples

    def test_line_6_trained(self, trained: GroundingModel, training: TrainingSet) -> None:
        assert trained.fitted is not None
        assert trained.fitted.status == "converged"
        right = [
            e
            for e in training.examples
            if e.phrase.kind is PhraseKind.NOUN
            and e.correspondences[[o.id for o in e.world.objects].index(best_of(trained, e))] in (ACTIVE, None)
        ]
        assert len(right) == 53


def best_of(model: GroundingModel, example: Example) -> str:
    solution = FactorGraph(ParseTree(example.phrase), example.world).solve(model.features, model.factor)
    assert solution.object is not None
    return solution.object.id


class TestLines7To15:
    """A command is heard, grounded, and acted on."""

    def test_line_7_command_after_command_with_one_model(self, pupil: Pupil) -> None:
        world = world_file(("red drill", 2.0, 0.0), ("blue mailbox", -2.0, 0.0))
        commands = [
            Command(world, "drill", "drill", None, "red_drill"),
            Command(world, "mailbox", "mailbox", None, "blue_mailbox"),
            Command(world, "drill", "drill", None, "red_drill"),
        ]
        rows = [r for r, _ in run_trial(0, commands, pupil(), read, FakeRobot(), np.random.default_rng(0))]
        assert [(r.iteration, r.grounded, r.kind) for r in rows] == [
            (0, "red_drill", "unknown"),
            (1, "blue_mailbox", "unknown"),
            (2, "red_drill", "learned"),
        ]

    def test_line_8_perceived_objects_are_known_by_gamma(self) -> None:
        found = perceive_objects([percept("red cube"), percept("blue drill")], ["cube", "sphere"])
        assert [(o.type, o.known, o.hypothetical) for o in found] == [("cube", True, False), ("drill", False, False)]

    def test_line_8_after_a_lesson_too(self, pupil: Pupil) -> None:
        model = pupil()
        assert [o.known for o in saw(model, "blue drill").objects][:1] == [False]
        model.learn(model.ground(command_tree("drill"), saw(model, "blue drill")))
        assert [o.known for o in saw(model, "red drill").objects][:1] == [True]

    def test_line_9_one_of_each_known_type_and_an_unknown_one(self) -> None:
        found = hypothesize_objects(["cube", "sphere"])
        assert [(o.type, o.known) for o in found] == [("cube", True), ("sphere", True), (None, False)]
        assert all(o.hypothetical and o.position is None and o.color is None for o in found)
        assert found[-1].id == HYPOTHETICAL_UNKNOWN

    def test_line_9_added_to_what_is_perceived(self, trained: GroundingModel) -> None:
        objects = saw(trained, "red cube", "blue drill").objects
        assert [o.hypothetical for o in objects] == [False] * 2 + [True] * 4

    def test_line_9_grows_with_gamma(self, pupil: Pupil) -> None:
        model = pupil()
        model.learn(model.ground(command_tree("drill"), saw(model, "blue drill")))
        assert [o.type for o in saw(model).objects] == [*KNOWN, "drill", None]

    def test_line_10_the_command_is_read_with_the_words_known(self, pupil: Pupil) -> None:
        model, heard = pupil(), []
        model.learn(model.ground(command_tree("drill"), saw(model, "blue drill")))
        robot = SpyRobot()
        robot.load(world_file(("red cube", 2.0, 0.0)))

        def listen(text: str, vocabulary: Collection[str]) -> Read:
            heard.append((text, list(vocabulary)))
            return read("cube")

        carry_out("to the cube, please", model, robot, parse=listen)
        assert heard == [("to the cube, please", [*KNOWN, "drill"])]

    def test_line_11_the_best_configuration(self, trained: GroundingModel) -> None:
        world = saw(trained, "blue cube", "red cube", "red sphere")
        solution = trained.ground(command_tree("cube", "red"), world)
        assert solution.object == world.objects[1]
        assert solution.probability == max(solution.probabilities.values())
        assert solution.best is not None
        assert [h.child.correspondence for h in solution.best.walk()] == [ACTIVE] * 3

    def test_lines_12_and_13_unseen_is_sought_by_turning(self, trained: GroundingModel) -> None:
        """Right behind the robot: four turns of 45 degrees."""
        found = told(trained, "cube", world_file(("red sphere", 2.0, 0.0), ("red cube", -2.0, 0.0)))
        assert found == ["spin"] * 4 + ["drive to red_cube"]

    def test_line_13_a_full_circle_and_no_more(self, trained: GroundingModel) -> None:
        assert told(trained, "cube", world_file(("red sphere", 2.0, 0.0))) == ["spin"] * 8

    def test_lines_14_and_15_what_is_seen_is_driven_to(self, trained: GroundingModel) -> None:
        assert told(trained, "cube", world_file(("red sphere", 2.0, 0.3), ("red cube", 2.0, 0.0))) == [
            "drive to red_cube"
        ]

    def test_line_15_an_unknown_thing_for_an_unknown_word(self, trained: GroundingModel) -> None:
        assert told(trained, "drill", world_file(("red cube", 2.0, 0.0), ("red drill", 2.0, 0.3))) == [
            "drive to red_drill"
        ]


class TestInverted:
    """ "Stay away from the red cube" keeps the robot away from it."""

    COMMANDS = (
        ("stay away from the red cube", True),
        ("avoid the red cube", True),
        ("do not go to the red cube", True),
        ("keep away from the red cube", True),
        ("go to the red cube", False),
        ("approach the red cube", False),
        ("find the red cube", False),
        ("do not stay away from the red cube", False),
        ("do not approach the red cube", True),
        ("never head towards the red cube", True),
        pytest.param(
            *("do not avoid the red cube", False),
            marks=pytest.mark.xfail(
                strict=True, reason="two words of one verb add up; no feature says that they cancel"
            ),
        ),
    )

    @pytest.mark.parametrize(("text", "inverted"), COMMANDS)
    def test_commands(self, trained: GroundingModel, parser: Parser, text: str, inverted: bool) -> None:
        tree = parser.parse(text, trained.symbols).tree
        assert tree is not None
        solution = trained.ground(tree, saw(trained, "blue cube", "red cube", "green dax"))
        assert solution.object is not None
        assert solution.object.id == "1 red cube"
        assert solution.inverted is inverted

    def test_the_robot_drives_away(self, trained: GroundingModel, parser: Parser) -> None:
        robot = SpyRobot()
        robot.load(world_file(("red cube", 2.0, 0.0), ("blue cube", 2.0, 0.5)))
        outcome = carry_out("stay away from the red cube", trained, robot, parse=parser.parse)
        assert robot.told == ["drive away from red_cube"]
        assert outcome.arrived

    def test_binary_correspondences_know_no_opposite(self, binary: GroundingModel) -> None:
        tree = command_tree("cube", "red", verb=("stay",), preposition="away from")
        assert not binary.ground(tree, saw(binary, "red cube")).inverted
        assert binary.factor.weight.shape[0] == 2
