"""The open-world model with relations: they are read, say what a word was said of, and cost the rest nothing."""

from __future__ import annotations

import copy
import math
from pathlib import Path

import numpy as np
import pytest
import torch

from dcg_torch.agent.asking import Question, Reply
from dcg_torch.agent.command import _told
from dcg_torch.agent.explore import LookBefore, compares
from dcg_torch.model.checkpoint import load, save
from dcg_torch.grounding.features import Group
from dcg_torch.grounding.graph import Solution
from dcg_torch.lessons import initial_training
from dcg_torch.lessons.relations import relational_lessons
from dcg_torch.model import Scene, Variant
from dcg_torch.open_world import OpenWorldModel
from dcg_torch.open_world.blocks import Blocks
from dcg_torch.simulator import FakeRobot
from dcg_torch.supervised import teach
from dcg_torch.types import ParseTree, Percept, Phrase, PhraseKind, Pose, WorldModel
from dcg_torch.world.files import World, WorldObject

ROBOT = Pose(0.0, 0.0, 0.0)


@pytest.fixture(scope="module")
def taught() -> OpenWorldModel:
    model = OpenWorldModel.trained(initial_training(), Variant(groups=frozenset(Group), beam=12))
    teach(model, relational_lessons(400), rounds=2)
    model.settle()
    return model


@pytest.fixture
def model(taught: OpenWorldModel) -> OpenWorldModel:
    return copy.deepcopy(taught)


def noun(word: str, color: str | None = None, *modifiers: ParseTree, words: tuple[str, ...] = ()) -> ParseTree:
    return ParseTree(Phrase(PhraseKind.NOUN, word, words, word, color), modifiers)


def pp(word: str, *nouns: ParseTree) -> ParseTree:
    return ParseTree(Phrase(PhraseKind.PREPOSITION, word, (word,)), nouns)


def go_to(thing: ParseTree) -> ParseTree:
    return ParseTree(Phrase(PhraseKind.VERB, "go", ("go",)), (pp("to", thing),))


def seen(*things: tuple[str, str, float, float]) -> tuple[Percept, ...]:
    """Percepts from (colour, type, ahead, to the left); the id is "colour type"."""
    return tuple(Percept(f"{c} {t}", t, c, (x, y, 0.0)) for c, t, x, y in things)


def ground(model: OpenWorldModel, thing: ParseTree, percepts: tuple[Percept, ...]) -> Solution:
    return model.ground(go_to(thing), model.world_model(percepts, ROBOT, looked=True))


def hear(model: OpenWorldModel, thing: ParseTree, percepts: tuple[Percept, ...]) -> None:
    model.learn(ground(model, thing, percepts), Scene(percepts, looked=True))


ROW = seen(
    ("green", "drill", 4.4, 0.2), ("blue", "cube", 3.0, 0.0), ("green", "mailbox", 1.4, -0.2), ("red", "cube", 2.0, 5.0)
)
BEHIND = pp("behind", noun("cube", "blue"))


def test_relations_are_read(taught: OpenWorldModel) -> None:
    for word, meant in (("behind", "green drill"), ("in front of", "green mailbox")):
        solution = ground(taught, noun("thing", None, pp(word, noun("cube", "blue"))), ROW)
        assert solution.object is not None
        assert solution.object.id == meant
        assert not solution.object.hypothetical


def test_sides_are_the_robot_s_wherever_it_stands(taught: OpenWorldModel) -> None:
    """Turned and moved with its world, the robot means the same thing."""
    angle, c = 2.1, complex(math.cos(2.1), math.sin(2.1))
    moved = tuple(
        Percept(p.id, p.type, p.color, (z.real, z.imag, 0.0))
        for p in ROW
        for z in [complex(*p.position[:2]) * c + complex(1.0, -3.0)]
    )
    for place in ("left", "right"):
        thing = noun("thing", None, pp("on", noun(place, words=("your",))))
        one = ground(taught, thing, ROW)
        other = taught.ground(go_to(thing), taught.world_model(moved, Pose(1.0, -3.0, angle), looked=True))
        assert other.probabilities == pytest.approx(one.probabilities, abs=1e-9)
    solution = ground(taught, noun("thing", None, pp("on", noun("left", words=("your",)))), ROW)
    assert solution.object is not None
    assert solution.object.id == "red cube"


def test_a_word_is_learned_from_what_stands_as_the_command_says(model: OpenWorldModel) -> None:
    """Nothing but the relation tells the drill from the mailbox."""
    plain = copy.deepcopy(model)
    hear(plain, noun("zorp"), ROW)
    assert plain.beliefs_of("zorp")["drill"] == pytest.approx(plain.beliefs_of("zorp")["mailbox"])
    hear(model, noun("zorp", None, BEHIND), ROW)
    assert model.beliefs_of("zorp")["drill"] > 0.8
    assert model.beliefs_of("zorp")["drill"] > 10 * model.beliefs_of("zorp")["mailbox"]


TWO = seen(
    ("red", "cube", 3.0, 3.0), ("blue", "cube", 3.0, -3.0), ("green", "drill", 3.0, 4.2), ("green", "sphere", 3.0, -4.2)
)


def test_a_landmark_nobody_has_named_is_rather_the_unnamed_thing(taught: OpenWorldModel) -> None:
    solution = ground(taught, noun("cube", None, pp("next to", noun("zorp"))), TWO)
    assert solution.probabilities["red cube"] > 4 * solution.probabilities["blue cube"]


def test_what_is_believed_of_a_landmark_s_word_is_used(model: OpenWorldModel) -> None:
    model.correct("zorp", "sphere")
    solution = ground(model, noun("cube", None, pp("next to", noun("zorp"))), TWO)
    assert solution.probabilities["blue cube"] > 4 * solution.probabilities["red cube"]


def test_a_landmark_is_heard(model: OpenWorldModel) -> None:
    """ "The red cube next to the zorp": the zorp is what stands there, and is not the one by the blue cube."""
    world = seen(
        ("red", "cube", 3.0, 3.0),
        ("blue", "cube", 3.0, -3.0),
        ("green", "drill", 3.0, 4.2),
        ("green", "mailbox", 3.0, -4.2),
    )
    hear(model, noun("cube", "red", pp("next to", noun("zorp"))), world)
    assert model.beliefs_of("zorp")["drill"] > 3 * model.beliefs_of("zorp")["mailbox"]


def test_places_are_no_words_to_learn(model: OpenWorldModel) -> None:
    hear(model, noun("thing", None, pp("behind", noun("you"))), ROW)
    assert not model.beliefs.heard


def test_a_thing_without_a_noun_may_be_anything(taught: OpenWorldModel) -> None:
    world = seen(("red", "cube", 3.0, 0.0), ("red", "drill", 3.0, 2.0), ("blue", "cube", 3.0, -2.0))
    found = ground(taught, noun("thing", "red"), world).probabilities
    assert found["red cube"] == pytest.approx(found["red drill"], abs=0.03)
    assert found["blue cube"] < 0.05


def test_the_posterior_leaves_what_was_taught_as_it_is(model: OpenWorldModel) -> None:
    """Bit by bit, and the taught block is not in the fit."""
    before, rows = model.factor.weight.clone(), model.factor.weight.shape[1:]
    taught = torch.from_numpy(Blocks.of(model.features).taught)
    hear(model, noun("zorp", "red"), ROW)
    after = model.factor.weight[:, : rows[0], : rows[1]]
    assert torch.equal(after[:, taught], before[:, taught])
    assert not torch.equal(after, before)


def test_a_saved_model_keeps_its_relations(model: OpenWorldModel, tmp_path: Path) -> None:
    save(model, tmp_path)
    again = load(tmp_path)
    assert isinstance(again, OpenWorldModel)
    thing = noun("zorp", None, BEHIND)
    for _ in range(2):
        assert ground(again, thing, ROW).probabilities == ground(model, thing, ROW).probabilities
        hear(model, thing, ROW)
        hear(again, thing, ROW)


def test_lessons_leave_plain_commands_as_they_are(taught: OpenWorldModel) -> None:
    groups = frozenset(Group) - {Group.RELATION}
    without = OpenWorldModel.trained(initial_training(), Variant(groups=groups, beam=12))
    for thing in (noun("cube", "red"), noun("cube"), noun("zorp"), noun("zorp", "green"), noun("sphere")):
        one, other = (ground(m, thing, ROW).probabilities for m in (taught, without))
        assert one == pytest.approx(other, abs=0.01)


def test_blocks_are_apart(taught: OpenWorldModel) -> None:
    """No weight belongs to both, and a word of a robot's own day is in the posterior's."""
    blocks = Blocks.of(taught.features)
    believed = np.zeros(taught.features.shape, dtype=np.bool_)
    believed[np.ix_(blocks.rows, blocks.columns)] = blocks.believed.pairs
    assert not (believed & blocks.taught).any()
    assert taught.features.language["noun: cube"] in blocks.rows
    assert taught.features.language["noun: you"] not in blocks.rows


def look(model: OpenWorldModel, thing: ParseTree) -> bool:
    """Does the robot look all round, with a red cube in view and a blue one behind it?"""
    cubes = (("red", 3.0), ("blue", -4.0))
    robot = FakeRobot()
    robot.load(
        World(name="w", objects=tuple(WorldObject(id=c, type="cube", color=c, position=(x, 0.0)) for c, x in cubes))
    )
    explorer = LookBefore(model.beliefs_of)
    percepts = {p.id: p for p in robot.perceive()}
    while True:
        world = model.world_model(percepts.values(), ROBOT, looked=explorer.looked)
        if not explorer.move(model.ground(go_to(thing), world), tuple(percepts.values()), robot):
            return explorer.looked
        percepts |= {p.id: p for p in robot.perceive()}


def test_what_compares_must_see_all_there_is(taught: OpenWorldModel) -> None:
    assert not look(taught, noun("cube", "red"))
    assert look(taught, noun("cube", "red", words=("farthest",)))
    assert look(taught, noun("cube", "red", pp("next to", noun("sphere"))))
    assert not compares(Solution(go_to(noun("cube")), WorldModel(()), None, {}))


def test_an_answer_rules_out_and_leaves_landmarks(taught: OpenWorldModel) -> None:
    """The mailbox is denied, and is still there to be stood in front of."""
    world = taught.world_model(ROW, ROBOT, looked=True)
    denied = _told(world, Question("?", ("green mailbox", "green drill")), Reply(None))
    assert [o.id for o in denied.objects] == [o.id for o in world.objects]
    tree = go_to(noun("thing", None, pp("behind", noun("mailbox"))))
    found = taught.ground(tree, denied)
    assert found.probabilities["green mailbox"] == found.probabilities["green drill"] == 0.0
    assert found.object is not None
    assert found.object.id == "blue cube"
    assert sum(found.probabilities.values()) == pytest.approx(1.0)
    twice = _told(denied, Question("?", ("blue cube",)), Reply("blue cube"))
    assert taught.ground(tree, twice).probabilities["blue cube"] == 1.0


def test_an_answer_is_evidence_by_a_relation_too(model: OpenWorldModel) -> None:
    thing = noun("zorp", None, BEHIND)
    solution = ground(model, thing, ROW)
    model.learn(solution, Scene(ROW, looked=True, meant=frozenset({"green mailbox"}), certain=True))
    assert model.beliefs_of("zorp")["mailbox"] > 0.9


def test_an_object_is_no_neighbour_of_itself(taught: OpenWorldModel) -> None:
    world = seen(("red", "cube", 3.0, 0.0), ("blue", "cube", 3.0, 1.2), ("green", "sphere", 3.0, -5.0))
    found = ground(taught, noun("cube", None, pp("next to", noun("cube", "red"))), world)
    assert found.object is not None
    assert found.object.id == "blue cube"


def test_the_world_of_a_mobile_robot_has_no_edges(taught: OpenWorldModel) -> None:
    solution = ground(taught, noun("thing", None, pp("behind", noun("me"))), ROW)
    kinds = {place.type for place in solution.world.places}
    assert {"robot", "speaker"} <= kinds
    assert not {"edge", "corner"} & kinds
    plain = ground(taught, noun("cube"), ROW)
    assert set(plain.probabilities) == {o.id for o in plain.world.objects}  # a place is never meant
