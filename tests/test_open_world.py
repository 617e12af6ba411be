"""The open-world model: the log-linear probabilities are the posterior's, and whole trials with a fake robot."""

from __future__ import annotations

import copy
import functools
import json
from collections.abc import Collection
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from making import Read, command_tree, words_of

from dcg_torch.agent.asking import AskingPolicy
from dcg_torch.agent.explore import LookBefore, Worth
from dcg_torch.experiment.trial import run_trial
from dcg_torch.grounding.features import PAPER, Group
from dcg_torch.learning.beliefs import Beliefs
from dcg_torch.learning.census import Census
from dcg_torch.learning.lexicon import lexicon_table, load_lexicon, save_lexicon
from dcg_torch.learning.word_posterior import Assumptions, WordPosterior
from dcg_torch.lessons import initial_training
from dcg_torch.model import Experience, GroundingModel, Variant
from dcg_torch.model.checkpoint import load, save
from dcg_torch.model.pretrain import train_open_world
from dcg_torch.simulator import FakeRobot
from dcg_torch.storage.records import Iteration
from dcg_torch.types import Object, ParseTree, Percept, Phrase, PhraseKind, Symbol
from dcg_torch.world.generator import COLORS, generate_world
from dcg_torch.world.speaker import Command, GeneratingSpeaker, draw_trial


def open_world() -> GroundingModel:
    """The learner with a posterior, without relations, to which names of classes say nothing."""
    variant = Variant(groups=PAPER | {Group.OPEN}, beam=12)
    return train_open_world(initial_training(), variant, lessons=0, assumed=Assumptions())


def read(text: str, vocabulary: Collection[str] = ()) -> Read:
    """Reads "go to the [colour] noun", without the language room."""
    words = text.split(" the ", 1)[1].split()
    color = words.pop(0) if words[0] in (*COLORS, "mauve") else None
    return Read(command_tree(" ".join(words), color))


def thing(id_: str, type_: str, color: str = "red") -> Percept:
    return Percept(id_, type_, color, (float(len(id_)), 1.0, 0.0))


WORLD = (thing("a", "drill"), thing("b", "mailbox"), thing("c", "mailbox", "blue"), thing("d", "cube", "blue"))


def say(
    model: GroundingModel, text: str, percepts: tuple[Percept, ...] = WORLD, learn: bool = True
) -> dict[str, float]:
    """Ground a command after a look all round, and learn; the probabilities of what was seen, among themselves."""
    tree = read(text).tree
    assert tree is not None
    solution = model.ground(tree, model.world_model(percepts, looked=True))
    if learn:
        model.learn(solution, Experience(looked=True, source=text))
    seen = {p.id: solution.probabilities[p.id] for p in percepts}
    return {k: p / sum(seen.values()) for k, p in seen.items()}


def expected(model: GroundingModel, text: str, percepts: tuple[Percept, ...] = WORLD) -> dict[str, float]:
    """Equation (2) of `soft_labels`, without a log-linear model."""
    reading, words = read(text), words_of(model)

    def said(beliefs: Beliefs, word: str, type_: str | None) -> float:
        table, new = beliefs.said_of
        posterior = beliefs.posterior
        row = table[posterior.words.index(word)] if word in posterior.words else new
        return float(row[-1 if type_ not in posterior.types else posterior.types.index(type_)])

    assert reading.noun is not None
    odds = {
        p.id: said(words.nouns, reading.noun, p.type)
        * (1.0 if reading.color is None else said(words.colors, reading.color, p.color))
        for p in percepts
    }
    return {k: v / sum(odds.values()) for k, v in odds.items()}


@pytest.fixture(scope="module")
def fresh() -> GroundingModel:
    return open_world()


@pytest.fixture
def model(fresh: GroundingModel) -> GroundingModel:
    return copy.deepcopy(fresh)


def test_the_model_says_what_the_posterior_says(model: GroundingModel) -> None:
    commands = ["red drill", "drill", "mailbox", "blue mailbox", "blue cube", "cube", "mauve cube", "red drill"]
    for command in commands:
        text = f"go to the {command}"
        say(model, text)
    for command in commands:
        text = f"go to the {command}"
        assert say(model, text, learn=False) == pytest.approx(expected(model, text), abs=0.02)


def test_an_unheard_word_means_an_unnamed_thing_rather_than_a_named_one(fresh: GroundingModel) -> None:
    found = say(fresh, "go to the zorp", learn=False)
    assert found["a"] == pytest.approx(found["b"], abs=0.01)
    assert found["a"] > 5 * found["d"]


def test_what_is_not_there_is_not_there(fresh: GroundingModel) -> None:
    tree = read("go to the red sphere").tree
    assert tree is not None
    solution = fresh.ground(tree, fresh.world_model(WORLD, looked=True))
    assert solution.object is not None
    assert solution.object.id == "hypothetical sphere"


def test_a_wrong_belief_fades_and_its_weights_with_it(model: GroundingModel) -> None:
    only_drill, only_mailbox = (thing("a", "drill"),), (thing("b", "mailbox"),)
    for _ in range(2):
        say(model, "go to the zorp", only_drill)
    both = (*only_drill, *only_mailbox)
    assert model.symbols["zorp"].type == "drill"
    assert say(model, "go to the zorp", both, learn=False)["a"] > 0.95
    for _ in range(4):
        say(model, "go to the zorp", only_mailbox)
    assert model.symbols["zorp"].type == "mailbox"
    assert say(model, "go to the zorp", both, learn=False)["b"] > 0.95


def test_an_answer_is_evidence(model: GroundingModel) -> None:
    tree = read("go to the red zorp").tree
    assert tree is not None
    world = model.world_model(WORLD, looked=True)
    before = model.beliefs_of("zorp").get("mailbox", 0.0)
    solution = model.ground(tree, replace(world, meant=frozenset({"b"})))
    learned = model.learn(solution, Experience(looked=True, certain=True))
    assert learned.symbol == Symbol("zorp", "mailbox")
    assert before < 0.5
    assert model.beliefs_of("zorp")["mailbox"] > 0.9


def test_forget_and_correct(model: GroundingModel) -> None:
    for _ in range(2):
        say(model, "go to the zorp", (thing("a", "drill"),))
    say(model, "go to the blue cube")  # mailboxes are met
    assert model.symbols["zorp"].type == "drill"
    model.correct("zorp", "mailbox")
    assert model.symbols["zorp"].type == "mailbox"
    assert say(model, "go to the red zorp", learn=False)["b"] > 0.95
    model.forget("zorp")
    assert "zorp" not in model.symbols
    assert say(model, "go to the red zorp", learn=False)["a"] == pytest.approx(0.5, abs=0.05)


def test_without_an_experience_what_may_be_out_of_view_counts(model: GroundingModel) -> None:
    """The robot has not looked round as far as the solution tells: the same words are weaker evidence."""
    tree = read("go to the zorp").tree
    assert tree is not None
    found = {}
    for looked in (False, True):
        one = copy.deepcopy(model)
        percepts = (thing("a", "drill"),)
        one.learn(one.ground(tree, one.world_model(percepts, looked=looked)))
        found[looked] = one.beliefs_of("zorp")["drill"]
    assert model.beliefs_of("zorp").get("drill", 0.0) < found[False] < found[True]


@pytest.mark.parametrize(
    ("text", "reason"),
    [
        ("go to the cube", "'cube' is known already"),
        ("go to the zorp", "'zorp' may be several things"),
    ],
)
def test_what_a_command_does_not_teach_has_a_reason(model: GroundingModel, text: str, reason: str) -> None:
    tree = read(text).tree
    assert tree is not None
    percepts = (thing("a", "drill"), thing("b", "mailbox"), thing("c", "crate"), thing("d", "cube"))
    learned = model.learn(model.ground(tree, model.world_model(percepts, looked=True)), Experience(looked=True))
    assert not learned
    assert learned.reason is not None
    assert learned.reason.startswith(reason)


def test_a_command_that_names_nothing_and_a_repeated_one_teach_nothing_new(model: GroundingModel) -> None:
    noun = ParseTree(Phrase(PhraseKind.NOUN, "red one", color="red"))
    world = model.world_model((thing("a", "drill"),), looked=True)
    assert model.learn(model.ground(noun, world)).reason == "the command names no noun"
    tree = read("go to the zorp").tree
    assert tree is not None
    for _ in range(3):
        first = model.learn(model.ground(tree, world))
        if first:
            break
    assert first.symbol == Symbol("zorp", "drill")
    reason = model.learn(model.ground(tree, world)).reason
    assert reason is not None
    assert reason.startswith("'zorp' is 'drill' with probability")


def test_the_census_counts_repeats() -> None:
    census = Census(objects=0.0, cells=1.0, again=0.0, found=1.0)
    cubes = [Object(k, "cube", True, color=c) for k, c in (("a", "red"), ("b", "red"), ("c", "blue"))]
    counted = census.count(cubes, 9)
    assert counted.rate == pytest.approx(0.3)
    assert counted.repeats == pytest.approx(0.25)


def test_a_saved_model_goes_on_learning(model: GroundingModel, tmp_path: Path) -> None:
    say(model, "go to the red zorp")
    save(model, tmp_path)
    again = load(tmp_path)
    assert isinstance(again.learner, WordPosterior)
    assert say(again, "go to the drill") == say(model, "go to the drill")
    assert again.beliefs_of("zorp") == model.beliefs_of("zorp")


def test_the_lexicon_is_saved_and_printed(model: GroundingModel, tmp_path: Path) -> None:
    say(model, "go to the red zorp")
    save_lexicon(model.lexicon(), tmp_path / "l.json")
    assert load_lexicon(tmp_path / "l.json") == model.lexicon()
    assert lexicon_table(model.lexicon()).row_count == 4


def commands(seed: int, n: int = 10) -> list[Command]:
    rng = np.random.default_rng(seed)
    worlds = [generate_world(rng, f"w{k}") for k in range(10)]
    return draw_trial(worlds, GeneratingSpeaker(1.0), n, rng)


def trial(seed: int, asking: AskingPolicy | None = None) -> list[Iteration]:
    model = open_world()
    worth = Worth(sure=None if asking is None else asking.below)
    rows = run_trial(
        0,
        commands(seed),
        model,
        read,
        FakeRobot(),
        np.random.default_rng(0),
        explorer=functools.partial(LookBefore, model.beliefs_of, worth),
        asking=asking,
    )
    return [row for row, _ in rows]


def test_a_trial_gives_the_same_bytes_twice() -> None:
    one, other = ([r.model_dump_json() for r in trial(3)] for _ in range(2))
    assert one == other
    assert "beliefs" in json.loads(one[-1])


def test_with_questions_it_is_right_and_asks_little() -> None:
    rows = [row for seed in range(2) for row in trial(seed, AskingPolicy(below=0.75))]
    assert all(row.correct for row in rows)
    assert sum(row.asked for row in rows) <= 0.3 * len(rows)
    for row in rows:
        assert row.asked == len(row.dialogue or ())


def test_the_paper_s_model_has_no_beliefs_and_asks_nothing() -> None:
    model = GroundingModel.trained(initial_training())
    rows = [row for row, _ in run_trial(0, commands(0, 4), model, read, FakeRobot(), np.random.default_rng(0))]
    for row in rows:
        assert row.beliefs is None
        assert row.dialogue is None
        assert not {"beliefs", "dialogue"} & json.loads(row.model_dump_json()).keys()
        assert Iteration.model_validate_json(row.model_dump_json()) == row
    assert not any(
        name.startswith(("noun: (", "type: (")) for name in (*model.features.language, *model.features.grounding)
    )
