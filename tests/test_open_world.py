"""The open-world model: the log-linear probabilities are the posterior's, and whole trials with a fake robot."""

from __future__ import annotations

import functools
import json
from collections.abc import Collection
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import pytest
import torch

from dcg_torch.agent.asking import AskingPolicy
from dcg_torch.agent.explore import LookBefore, Worth
from dcg_torch.model.checkpoint import load, save
from dcg_torch.experiment.trial import run_trial
from dcg_torch.learning.lexicon import lexicon_table, load_lexicon, save_lexicon
from dcg_torch.lessons import initial_training
from dcg_torch.model import GroundingModel, Scene, Variant
from dcg_torch.open_world import Census, OpenWorldModel
from dcg_torch.records import Iteration
from dcg_torch.simulator import FakeRobot
from dcg_torch.speaker import Command, GeneratingSpeaker, draw_trial
from dcg_torch.types import ParseTree, Percept, Phrase, PhraseKind
from dcg_torch.world.generator import COLORS, generate_world

torch.set_num_threads(1)  # the problems are small; more threads only wait for one another


@dataclass(frozen=True)
class Reading:
    tree: ParseTree | None
    problem: str | None
    noun: str | None
    color: str | None


def read(text: str, vocabulary: Collection[str] = ()) -> Reading:
    """Reads "go to the [colour] noun", without the language room."""
    words = text.split(" the ", 1)[1].split()
    color = words.pop(0) if words[0] in (*COLORS, "mauve") else None
    noun = " ".join(words)
    thing = ParseTree(Phrase(PhraseKind.NOUN, noun, noun=noun, color=color))
    to = ParseTree(Phrase(PhraseKind.PREPOSITION, "to", ("to",)), (thing,))
    return Reading(ParseTree(Phrase(PhraseKind.VERB, "go", ("go",)), (to,)), None, noun, color)


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
        model.learn(solution, Scene(percepts, looked=True, source=text))
    seen = {p.id: solution.probabilities[p.id] for p in percepts}
    return {k: p / sum(seen.values()) for k, p in seen.items()}


def expected(model: OpenWorldModel, text: str, percepts: tuple[Percept, ...] = WORLD) -> dict[str, float]:
    """Equation (2) of `meaning.soft`, without a log-linear model."""
    reading = read(text)

    def said(beliefs: object, word: str, type_: str | None) -> float:
        table, new = beliefs.said_of()  # type: ignore[attr-defined]
        posterior = beliefs.posterior  # type: ignore[attr-defined]
        row = table[posterior.words.index(word)] if word in posterior.words else new
        return float(row[posterior.types.index(type_) if type_ in posterior.types else -1])

    assert reading.noun is not None
    odds = {
        p.id: said(model.beliefs, reading.noun, p.type)
        * (1.0 if reading.color is None else said(model.mind.color_beliefs, reading.color, p.color))
        for p in percepts
    }
    return {k: v / sum(odds.values()) for k, v in odds.items()}


@pytest.fixture(scope="module")
def fresh() -> OpenWorldModel:
    return OpenWorldModel.trained(initial_training())


@pytest.fixture
def model() -> OpenWorldModel:
    return OpenWorldModel.trained(initial_training())


def test_the_model_says_what_the_posterior_says(model: OpenWorldModel) -> None:
    commands = ["red drill", "drill", "mailbox", "blue mailbox", "blue cube", "cube", "mauve cube", "red drill"]
    for command in commands:
        text = f"go to the {command}"
        say(model, text)
    for command in commands:
        text = f"go to the {command}"
        assert say(model, text, learn=False) == pytest.approx(expected(model, text), abs=0.02)


def test_an_unheard_word_means_an_unnamed_thing_rather_than_a_named_one(fresh: OpenWorldModel) -> None:
    found = say(fresh, "go to the zorp", learn=False)
    assert found["a"] == pytest.approx(found["b"], abs=0.01)
    assert found["a"] > 5 * found["d"]


def test_what_is_not_there_is_not_there(fresh: OpenWorldModel) -> None:
    tree = read("go to the red sphere").tree
    assert tree is not None
    solution = fresh.ground(tree, fresh.world_model(WORLD, looked=True))
    assert solution.object is not None
    assert solution.object.id == "hypothetical sphere"


def test_a_wrong_belief_fades_and_its_weights_with_it(model: OpenWorldModel) -> None:
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


def test_an_answer_is_evidence(model: OpenWorldModel) -> None:
    tree = read("go to the red zorp").tree
    assert tree is not None
    solution = model.ground(tree, model.world_model(WORLD, looked=True))
    model.learn(solution, Scene(WORLD, looked=True, meant=frozenset({"b"}), certain=True))
    assert model.beliefs.posterior.best("zorp")[0] == "mailbox"
    assert model.beliefs.posterior.best("zorp")[1] > 0.9


def test_forget_and_correct(model: OpenWorldModel) -> None:
    for _ in range(2):
        say(model, "go to the zorp", (thing("a", "drill"),))
    model.correct("zorp", "mailbox")
    assert say(model, "go to the red zorp", learn=False)["b"] > 0.95
    model.forget("zorp")
    assert "zorp" not in model.symbols
    assert say(model, "go to the red zorp", learn=False)["a"] == pytest.approx(0.5, abs=0.05)


def test_without_a_scene_nothing_is_learned(fresh: OpenWorldModel) -> None:
    tree = read("go to the zorp").tree
    assert tree is not None
    assert fresh.learn(fresh.ground(tree, fresh.world_model(WORLD))) is None
    assert "zorp" not in fresh.beliefs.heard


def test_the_census_counts_repeats() -> None:
    census = Census(objects=0.0, cells=1.0, again=0.0, found=1.0)
    counted = census.count([thing("a", "cube"), thing("b", "cube"), thing("c", "cube", "blue")], 9)
    assert counted.rate == pytest.approx(0.3)
    assert counted.repeats == pytest.approx(0.25)


def test_a_saved_model_goes_on_learning(model: OpenWorldModel, tmp_path: Path) -> None:
    say(model, "go to the red zorp")
    save(model, tmp_path)
    again = load(tmp_path)
    assert isinstance(again, OpenWorldModel)
    assert say(again, "go to the drill") == say(model, "go to the drill")
    assert again.beliefs.posterior.of("zorp") == model.beliefs.posterior.of("zorp")


def test_the_lexicon_is_saved_and_printed(model: OpenWorldModel, tmp_path: Path) -> None:
    say(model, "go to the red zorp")
    save_lexicon(model.lexicon(), tmp_path / "l.json")
    assert load_lexicon(tmp_path / "l.json") == model.lexicon()
    assert lexicon_table(model.lexicon()).row_count == 4


def commands(seed: int, n: int = 10) -> list[Command]:
    rng = np.random.default_rng(seed)
    worlds = [generate_world(rng, f"w{k}") for k in range(10)]
    return draw_trial(worlds, GeneratingSpeaker(1.0), n, rng)


def trial(seed: int, asking: AskingPolicy | None = None) -> list[Iteration]:
    model = OpenWorldModel.trained(initial_training(), Variant(beam=12))
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
