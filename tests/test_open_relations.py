"""The open-world model with relations: they are read, say what a word was said of, and cost the rest nothing."""

from __future__ import annotations

import copy
import math
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from dcg_torch.agent.asking import Question, Reply
from dcg_torch.agent.command import _told
from dcg_torch.agent.explore import LookBefore, compares
from dcg_torch.grounding.features import PAPER, Group
from dcg_torch.grounding.solution import Solution
from dcg_torch.learning.trainable import believed_mask, taught_mask
from dcg_torch.learning.word_posterior import Assumptions, WordPosterior
from dcg_torch.lessons import initial_training
from dcg_torch.lessons.relations import relational_lessons
from dcg_torch.model import Experience, GroundingModel, Variant
from dcg_torch.model.checkpoint import load, save
from dcg_torch.model.pretrain import train_open_world
from dcg_torch.simulator import FakeRobot
from dcg_torch.types import ParseTree, Percept, Phrase, PhraseKind, Pose, WorldModel
from dcg_torch.world.files import World, WorldObject

ROBOT = Pose(0.0, 0.0, 0.0)


@pytest.fixture(scope="module")
def taught() -> GroundingModel:
    variant = Variant(groups=PAPER | {Group.OPEN, Group.RELATION}, beam=12)
    model = train_open_world(initial_training(), variant, lessons=0, assumed=Assumptions())
    model.teach(relational_lessons(1000), relations_only=True, rounds=2)  # as many as the shipped model had
    return model


@pytest.fixture
def model(taught: GroundingModel) -> GroundingModel:
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


def ground(model: GroundingModel, thing: ParseTree, percepts: tuple[Percept, ...]) -> Solution:
    return model.ground(go_to(thing), model.world_model(percepts, ROBOT, looked=True))


def hear(model: GroundingModel, thing: ParseTree, percepts: tuple[Percept, ...]) -> None:
    model.learn(ground(model, thing, percepts), Experience(looked=True))


ROW = seen(
    ("green", "drill", 4.4, 0.2), ("blue", "cube", 3.0, 0.0), ("green", "mailbox", 1.4, -0.2), ("red", "cube", 2.0, 5.0)
)
BEHIND = pp("behind", noun("cube", "blue"))


def test_relations_are_read(taught: GroundingModel) -> None:
    for word, meant in (("behind", "green drill"), ("in front of", "green mailbox")):
        solution = ground(taught, noun("thing", None, pp(word, noun("cube", "blue"))), ROW)
        assert solution.object is not None
        assert solution.object.id == meant
        assert not solution.object.hypothetical


def test_sides_are_the_robot_s_wherever_it_stands(taught: GroundingModel) -> None:
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


def test_a_word_is_learned_from_what_stands_as_the_command_says(model: GroundingModel) -> None:
    """Nothing but the relation tells the drill from the mailbox."""
    plain = copy.deepcopy(model)
    hear(plain, noun("zorp"), ROW)
    assert plain.beliefs_of("zorp")["drill"] == pytest.approx(plain.beliefs_of("zorp")["mailbox"])
    hear(model, noun("zorp", None, BEHIND), ROW)
    assert model.beliefs_of("zorp")["drill"] > 0.8
    assert model.beliefs_of("zorp")["drill"] > 5 * model.beliefs_of("zorp")["mailbox"]


TWO = seen(
    ("red", "cube", 3.0, 3.0), ("blue", "cube", 3.0, -3.0), ("green", "drill", 3.0, 4.2), ("green", "sphere", 3.0, -4.2)
)


def test_a_landmark_nobody_has_named_is_rather_the_unnamed_thing(taught: GroundingModel) -> None:
    solution = ground(taught, noun("cube", None, pp("next to", noun("zorp"))), TWO)
    assert solution.probabilities["red cube"] > 4 * solution.probabilities["blue cube"]


def test_what_is_believed_of_a_landmark_s_word_is_used(model: GroundingModel) -> None:
    model.correct("zorp", "sphere")
    assert model.symbols["zorp"].type == "sphere"
    solution = ground(model, noun("cube", None, pp("next to", noun("zorp"))), TWO)
    assert solution.probabilities["blue cube"] > 4 * solution.probabilities["red cube"]


def test_a_landmark_is_heard(model: GroundingModel) -> None:
    """ "The red cube next to the zorp": the zorp is what stands there, and is not the one by the blue cube."""
    world = seen(
        ("red", "cube", 3.0, 3.0),
        ("blue", "cube", 3.0, -3.0),
        ("green", "drill", 3.0, 4.2),
        ("green", "mailbox", 3.0, -4.2),
    )
    hear(model, noun("cube", "red", pp("next to", noun("zorp"))), world)
    assert model.beliefs_of("zorp")["drill"] > 3 * model.beliefs_of("zorp")["mailbox"]


def test_places_are_no_words_to_learn(model: GroundingModel) -> None:
    hear(model, noun("thing", None, pp("behind", noun("you"))), ROW)
    assert isinstance(model.learner, WordPosterior)
    assert not model.learner.nouns.heard


def test_a_thing_without_a_noun_may_be_anything(taught: GroundingModel) -> None:
    world = seen(("red", "cube", 3.0, 0.0), ("red", "drill", 3.0, 2.0), ("blue", "cube", 3.0, -2.0))
    found = ground(taught, noun("thing", "red"), world).probabilities
    assert found["red cube"] == pytest.approx(found["red drill"], abs=0.03)
    assert found["blue cube"] < 0.05


def test_the_posterior_leaves_what_was_taught_as_it_is(model: GroundingModel) -> None:
    """Bit by bit, and the taught block is not in the fit."""
    before = model.factor.weight.numpy().copy()
    taught = taught_mask(model.features) & ~believed_mask(model.features)
    hear(model, noun("zorp", "red"), ROW)
    rows, columns = taught.shape
    after = model.factor.weight.numpy()[:, :rows, :columns]
    assert np.abs(before[:, taught]).max() > 0.1
    assert (after[:, taught] == before[:, taught]).all()
    assert not (after == before).all()


def test_a_saved_model_keeps_its_relations(model: GroundingModel, tmp_path: Path) -> None:
    save(model, tmp_path)
    again = load(tmp_path)
    assert again.learner == model.learner
    thing = noun("zorp", None, BEHIND)
    for _ in range(2):
        assert ground(again, thing, ROW).probabilities == ground(model, thing, ROW).probabilities
        hear(model, thing, ROW)
        hear(again, thing, ROW)


def test_lessons_leave_plain_commands_as_they_are(taught: GroundingModel) -> None:
    variant = Variant(groups=PAPER | {Group.OPEN}, beam=12)
    without = train_open_world(initial_training(), variant, lessons=0, assumed=Assumptions())
    for thing in (noun("cube", "red"), noun("cube"), noun("zorp"), noun("zorp", "green"), noun("sphere")):
        one, other = (ground(m, thing, ROW).probabilities for m in (taught, without))
        assert one == pytest.approx(other, abs=0.01)


def test_what_is_believed_and_what_is_taught_are_apart(taught: GroundingModel) -> None:
    """No weight of a word of a robot's own day is taught by lessons on relations, nor the other way round."""
    believed, lessons = believed_mask(taught.features), taught_mask(taught.features)
    language, grounding = taught.features.language, taught.features.grounding
    assert believed.any()
    assert lessons.any()
    assert believed[language["noun: cube"], grounding["type: cube"]]
    assert not lessons[language["noun: cube"], grounding["type: cube"]]
    assert not believed[language["noun: you"]].any()
    assert not believed[language["modifier: behind"]].any()
    assert lessons[language["modifier: behind"]].any()
    relation = next(k for name, k in grounding.items() if name.startswith("relation: "))
    assert not believed[:, relation].any()


def look(model: GroundingModel, thing: ParseTree) -> bool:
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


def test_what_compares_must_see_all_there_is(taught: GroundingModel) -> None:
    assert not look(taught, noun("cube", "red"))
    assert look(taught, noun("cube", "red", words=("farthest",)))
    assert look(taught, noun("cube", "red", pp("next to", noun("sphere"))))
    assert not compares(Solution(go_to(noun("cube")), WorldModel(())))


def test_an_answer_rules_out_and_leaves_landmarks(taught: GroundingModel) -> None:
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


def test_an_answer_is_evidence_by_a_relation_too(model: GroundingModel) -> None:
    thing = noun("zorp", None, BEHIND)
    world = model.world_model(ROW, ROBOT, looked=True)
    solution = model.ground(go_to(thing), replace(world, meant=frozenset({"green mailbox"})))
    model.learn(solution, Experience(looked=True, certain=True))
    assert model.beliefs_of("zorp")["mailbox"] > 0.9


def test_an_object_is_no_neighbour_of_itself(taught: GroundingModel) -> None:
    world = seen(("red", "cube", 3.0, 0.0), ("blue", "cube", 3.0, 1.2), ("green", "sphere", 3.0, -5.0))
    found = ground(taught, noun("cube", None, pp("next to", noun("cube", "red"))), world)
    assert found.object is not None
    assert found.object.id == "blue cube"


def test_the_world_of_a_mobile_robot_has_no_edges(taught: GroundingModel) -> None:
    solution = ground(taught, noun("thing", None, pp("behind", noun("me"))), ROW)
    kinds = {place.type for place in solution.world.places}
    assert {"robot", "speaker"} <= kinds
    assert not {"edge", "corner"} & kinds
    plain = ground(taught, noun("cube"), ROW)
    assert set(plain.probabilities) == {o.id for o in plain.world.objects}  # a place is never meant
