"""Train on episodes, ground others, count: what the figures are, and what must not leak. All episodes are made up."""

from __future__ import annotations

from collections.abc import Collection
from dataclasses import dataclass

import numpy as np
import pytest
from episode_making import COLORS, episode

from dcg_torch.evaluation import protocol
from dcg_torch.evaluation.episodes import Episode, EpisodeError
from dcg_torch.evaluation.protocol import Answer, Seconds, Training, answers, train
from dcg_torch.evaluation.splits import split_folds, split_halves
from dcg_torch.evaluation.summary import summarise
from dcg_torch.grounding.features import PAPER, Group
from dcg_torch.grounding.graph import FactorGraph
from dcg_torch.grounding.solution import target_of
from dcg_torch.language import Parser
from dcg_torch.learning.word_posterior import WordPosterior
from dcg_torch.model import GroundingModel, TrainingSet, Variant
from dcg_torch.scene.workspace import Workspace
from dcg_torch.types import WorldModel

RELATIONS = Variant(groups=PAPER | {Group.OPEN, Group.RELATION}, hypothetical=False, l2=0.2)


def made(k: int, rng: np.random.Generator, noun: str, type_: str, color: str, word: str | None = None) -> Episode:
    return Episode.model_validate(episode(k, rng, noun, type_, color, word))


def untaught(training: TrainingSet) -> GroundingModel:
    """The learner with a posterior, and relations."""
    return GroundingModel.trained(training, RELATIONS, WordPosterior.start(training))


@dataclass(frozen=True)
class Unread:
    """A command without a reading."""

    text: str = ""
    tree: None = None
    readings: tuple[()] = ()
    problem: str = "made up"
    noun: None = None
    color: None = None


def unread(text: str, vocabulary: Collection[str] = ()) -> Unread:
    return Unread(text)


def made_up_answers(n: int, file: str = "one") -> list[Answer]:
    """Answers without solutions: what is tested with them counts them."""
    rng = np.random.default_rng(0)
    types = [("cube", "prism")[k % 5 > 2] for k in range(n)]
    return [
        Answer(file, made(k, rng, "cube", t, "red"), Unread(), None, "known", "plain", 1, Seconds(0.001, 0.002))
        for k, t in enumerate(types)
    ]


def judged(monkeypatch: pytest.MonkeyPatch, found: list[Answer], right: list[bool]) -> None:
    """Let the answers be right or wrong as given."""
    verdict = {id(a): r for a, r in zip(found, right, strict=True)}
    monkeypatch.setattr(Answer, "correct", property(lambda self: verdict[id(self)]))


@pytest.mark.parametrize(("learn", "looked_at"), [(False, ["e0", "e2"]), (True, ["e0", "e1", "e2"])])
def test_a_scene_is_looked_at_once_for_the_commands_in_a_row_in_it(
    training: TrainingSet, monkeypatch: pytest.MonkeyPatch, learn: bool, looked_at: list[str]
) -> None:
    """And again when what was learned meanwhile makes a type known that is there."""
    rng, looks, look = np.random.default_rng(0), list[str](), protocol.test_world

    def noted(model: GroundingModel, one: Episode, where: Workspace) -> WorldModel:
        looks.append(one.id)
        return look(model, one, where)

    monkeypatch.setattr(protocol, "test_world", noted)
    first = made(0, rng, "prism", "prism", "red")
    said = [first, first.model_copy(update={"id": "e1"}), made(2, rng, "cube", "cube", "red")]
    found = list(answers(untaught(training), said, Parser().parse, learn=learn))
    assert looks == looked_at
    assert found[0].predicted == found[1].predicted


def test_halves_are_those_of_the_file(monkeypatch: pytest.MonkeyPatch) -> None:
    found = made_up_answers(10)
    found = [found[k] for k in (0, 1, 2, 5, 6, 3, 7, 8, 4, 9)]  # five cubes; a prism, a cube and three prisms
    judged(monkeypatch, found, [True, True, False, False, False, True, False, False, False, True])
    kinds = summarise(found, 1.0)["by_kind"]
    assert kinds["first half"] == {"n": 5, "accuracy": 0.4}
    assert kinds["second half"] == {"n": 5, "accuracy": 0.4}
    assert kinds["cube, first half"] == {"n": 5, "accuracy": 0.4}
    assert kinds["cube, second half"] == {"n": 1, "accuracy": 0.0}
    assert kinds["prism, second half"] == {"n": 4, "accuracy": 0.5}
    assert "prism, first half" not in kinds


def test_figures_by_file(monkeypatch: pytest.MonkeyPatch) -> None:
    found = [*made_up_answers(4, "one"), *made_up_answers(6, "other")]
    judged(monkeypatch, found, [True, True, True, False, *[False] * 6])
    figures = summarise(found, 1.0)
    assert {name: (of["n"], of["accuracy"]) for name, of in figures["by_file"].items()} == {
        "one": (4, 0.75),
        "other": (6, 0.0),
    }
    assert (figures["n"], figures["accuracy"]) == (10, 0.3)
    low, high = figures["ci95"]
    assert 0.0 < low < 0.3 < high < 1.0


def test_what_was_not_read_has_no_answer_and_a_line(training: TrainingSet) -> None:
    rng = np.random.default_rng(0)
    (answer,) = answers(untaught(training), [made(0, rng, "cube", "cube", "red")], unread, file="one", learn=True)
    record = answer.record()
    assert (record["predicted"], record["correct"], record["problem"]) == ([], False, "made up")
    assert (record["file"], record["cause"]) == ("one", "no phrase")
    assert summarise([answer], 0.0)["no_answer"] == 1


def test_a_clear_command_is_answered_with_the_probability_of_its_noun_phrase(
    parser: Parser, training: TrainingSet
) -> None:
    """Verb and preposition are taught to be about the object meant: no belief leaks to the twenty others."""
    rng = np.random.default_rng(2)
    model = untaught(training)
    corpus = [made(k, rng, "cube", "cube", COLORS[k % 3]) for k in range(120)]
    assert train(model, [corpus], parser.parse, Training(rounds=1)) > 0.0
    row = made(0, rng, "cube", "cube", "red")
    more = [{"id": f"x{k}", "type": "prism", "color": "teal", "position": [k, 9.0]} for k in range(20)]
    asked = Episode.model_validate({**row.model_dump(), "objects": [*row.model_dump()["objects"], *more]})
    (answer,) = answers(model, [asked], parser.parse)
    assert answer.solution is not None
    assert answer.solution.tree is not None
    noun = target_of(answer.solution.tree)
    assert noun is not None
    alone = FactorGraph(noun, answer.solution.world).solve(model.features, model.factor).probabilities["o0"]
    assert answer.correct
    assert answer.probability == pytest.approx(alone, abs=0.05)


@pytest.mark.parametrize("learn", [False, True])
def test_nothing_is_taught_by_reading_the_target_of_a_test(parser: Parser, training: TrainingSet, learn: bool) -> None:
    """With other targets, what comes after them is answered alike; with other commands, it is not where it learns."""
    rng = np.random.default_rng(4)
    corpus = [made(k, rng, "cube", "cube", COLORS[k % 3]) for k in range(12)]
    test = [made(k, rng, "pyramid", "prism", COLORS[k % 3]) for k in range(6)]
    others = [e.model_copy(update={"target": (e.objects[-1].id,)}) for e in test]
    silent = [e.model_copy(update={"text": e.text.replace("pyramid", "cube")}) for e in test]
    asked = made(9, rng, "pyramid", "prism", "red")
    last = []
    for episodes in (test, others, silent):
        model = untaught(training)
        train(model, [corpus], parser.parse, Training(["cube"], rounds=1))
        *_, answer = answers(model, [*episodes, asked], parser.parse, learn=learn)
        assert answer.solution is not None
        last.append(dict(answer.solution.probabilities))
    assert last[0] == last[1]
    assert (last[0] != last[2]) is learn


def test_a_known_type_is_what_the_training_keeps() -> None:
    rng = np.random.default_rng(0)
    corpus = [made(k, rng, t, t, c) for k, (t, c) in enumerate([("cube", "red"), ("prism", "red"), ("cube", "teal")])]
    assert [e.id for e in Training(["cube"]).kept(corpus)] == ["e0", "e2"]
    assert [e.id for e in Training(known_colors=["red"]).kept(corpus)] == ["e0", "e1"]
    assert Training().kept(corpus) == corpus


def test_no_group_is_in_two_folds() -> None:
    rng = np.random.default_rng(0)
    episodes = [made(k, rng, "cube", "cube", "red").model_copy(update={"group": str(k % 7)}) for k in range(30)]
    parts = split_folds(episodes, 3, np.random.default_rng(0))
    groups = [{e.group for e in part} for part in parts]
    assert sum(map(len, parts)) == 30
    assert sum(map(len, groups)) == len(set().union(*groups))
    with pytest.raises(EpisodeError, match="are of 7 groups; ask for fewer"):
        split_folds(episodes, 8, np.random.default_rng(0))
    with pytest.raises(EpisodeError, match="are of 1 group; ask for fewer"):
        split_folds(episodes[:1], 2, np.random.default_rng(0))


def test_a_group_is_in_the_same_half_alone_or_with_others() -> None:
    rng = np.random.default_rng(0)
    episodes = [made(k, rng, "cube", "cube", "red").model_copy(update={"group": str(k % 40)}) for k in range(120)]
    split = split_halves({"a": episodes, "b": episodes[:60]})
    taught, tested = ({e.group for e in part["a"]} for part in (split.train, split.test))
    assert not taught & tested
    assert taught | tested == {str(k) for k in range(40)}
    assert 10 <= len(taught) <= 30  # a fair coin falls outside once in 500 times
    assert {e.group for e in split.train["b"]} == taught  # the first 60 have every group
    assert split_halves({"b": episodes[:60]}).test["b"] == split.test["b"]
    with pytest.raises(EpisodeError, match="needs more groups"):
        split_halves({"one": episodes[:1]})


@pytest.mark.parametrize(
    ("unheard", "landmark", "known", "attribute", "meaning"),
    [
        ("wedge", ("prism", "teal"), "sphere", "noun", "prism"),
        ("crimson sphere", ("sphere", "teal"), "green sphere", "color", "teal"),
    ],
)
def test_nouns_and_colours_of_landmarks_are_learned_from_a_corpus(
    parser: Parser,
    training: TrainingSet,
    unheard: str,
    landmark: tuple[str, str],
    known: str,
    attribute: str,
    meaning: str,
) -> None:
    """ "The red cube next to the wedge": nobody ever means a wedge; commands of our own.

    A red cube stands by a landmark that has no name yet, another by a green sphere, a third by nothing.
    """
    rng = np.random.default_rng(7)
    corpus = [made(100 + k, rng, "cube", "cube", COLORS[k % 2]) for k in range(30)]
    corpus += [_board(k, rng, (known, unheard)[k % 2], landmark, named=k % 2 == 0) for k in range(40)]
    model = untaught(training)
    before = [a.correct for a in answers(model, corpus[30:], parser.parse)]
    train(model, [corpus], parser.parse, Training(["cube", "sphere"], ["red", "green"], rounds=3))
    assert isinstance(model.learner, WordPosterior)
    beliefs = model.learner.nouns if attribute == "noun" else model.learner.colors
    word = unheard.split()[0]
    assert word in beliefs.heard  # it is learned as in commands, not settled
    assert beliefs.posterior.best(word)[0] == meaning
    assert beliefs.posterior.best(word)[1] > 0.8
    asked = [_board(k, rng, unheard, landmark, named=False) for k in range(20)]
    assert sum(a.correct for a in answers(model, asked, parser.parse)) >= 18
    assert sum(before) < 30


def _board(k: int, rng: np.random.Generator, said: str, landmark: tuple[str, str], *, named: bool) -> Episode:
    """Three red cubes: one by the landmark, one by a green sphere, one by itself. `named`: the second is meant."""
    spots = rng.permutation([(1.0, 1.0), (5.0, 1.0), (1.0, 6.0)]) + rng.uniform(0.0, 0.4, size=(3, 2))
    (px, py), (sx, sy), (ax, ay) = spots.tolist()
    things = [
        ("by it", "cube", "red", (px, py)),
        ("it", *landmark, (px + 1.0, py)),
        ("by the sphere", "cube", "red", (sx, sy)),
        ("sphere", "sphere", "green", (sx + 1.0, sy)),
        ("alone", "cube", "red", (ax, ay)),
    ]
    names = ("id", "type", "color", "position")
    objects = [dict(zip(names, things[j], strict=True)) for j in rng.permutation(len(things)).tolist()]
    return Episode.model_validate(
        {
            "id": f"b{k}",
            "text": f"take the red cube next to the {said}",
            "robot": {"x": -2, "y": 3, "yaw": 0},
            "objects": objects,
            "target": ["by the sphere" if named else "by it"],
        }
    )
