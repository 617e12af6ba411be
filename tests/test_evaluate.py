"""`python -m dcg_torch.evaluate`: what it refuses, what it leaves behind, what it figures. All episodes are made up."""

from __future__ import annotations

import json
import os
import signal
import subprocess
import sys
import time
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from making import typed

from dcg_torch import load
from dcg_torch.agent.command import Parse
from dcg_torch.evaluate import main
from dcg_torch.evaluation.episodes import Episode
from dcg_torch.evaluation.protocol import Answer, Evaluation, Seconds, calibration_error, summarise
from dcg_torch.grounding.features import Group
from dcg_torch.grounding.graph import FactorGraph
from dcg_torch.language import Parser
from dcg_torch.lexical import LexicalModel
from dcg_torch.model import TrainingSet, Variant

COLORS = ("red", "green", "teal")


def episode(k: int, rng: np.random.Generator, noun: str, type_: str, color: str, word: str | None = None) -> Any:
    """One object of the type and colour, and others that differ in both; in every second episode, in one of them."""
    other = "cube" if type_ == "prism" else "prism"
    things = [(type_, color), *((other, c) for c in COLORS if c != color)]
    things += [(other, color), *((type_, c) for c in COLORS if c != color)] if k % 2 else []
    places = rng.uniform(1.0, 8.0, size=(len(things), 2)).round(2).tolist()
    objects = [
        {"id": f"o{j}", "type": t, "color": c, "position": [x, y]}
        for j, ((t, c), (x, y)) in enumerate(zip(things, places, strict=True))
    ]
    text = f"pick up the {word or color} {noun}"
    return {"id": f"e{k}", "text": text, "robot": {"x": 0, "y": 0, "yaw": 0}, "objects": objects, "target": ["o0"]}


def write(path: Path, rows: Sequence[Any]) -> Path:
    path.write_text("".join(json.dumps(row) + "\n" for row in rows), encoding="utf-8")
    return path


@pytest.fixture(scope="module")
def files(tmp_path_factory: pytest.TempPathFactory) -> tuple[Path, Path]:
    """Cubes and prisms to train on; a test that calls them by names never heard in the training of cubes."""
    rng = np.random.default_rng(0)
    folder = tmp_path_factory.mktemp("episodes")
    kinds = [("cube", "cube"), ("prism", "prism")]
    train = [episode(k, rng, *kinds[k % 2], COLORS[k % 3]) for k in range(30)]
    names = [("pyramid", "prism"), ("cube", "cube"), ("prism", "prism")]
    test = [episode(k, rng, *names[k % 3], COLORS[(k // 2) % 3]) for k in range(24)]
    return write(folder / "train.jsonl", train), write(folder / "test.jsonl", test)


def run(capsys: pytest.CaptureFixture[str], *arguments: str) -> tuple[int, str, str]:
    """The command in this process: exit status, what it printed, its complaints."""
    return typed(capsys, main, "dcg_torch.evaluate", *arguments)


WRONG = [
    pytest.param(["known_types=[cub]"], ["known_types", "'cub'", "cube, prism"], id="type of no episode"),
    pytest.param(["known_types=[]"], ["known_types", "cube, prism"], id="no type"),
    pytest.param(["known_colors=[mauve]"], ["known_colors", "'mauve'", "green, red, teal"], id="colour of no episode"),
    pytest.param(["explain=nobody"], ["explain=nobody", "no test episode", "e0"], id="unknown episode"),
    pytest.param(["rounds=0"], ["rounds=0", "from 1 to"], id="no rounds"),
    pytest.param(["folds=3"], ["folds=3", "no test file"], id="folds and a test"),
    pytest.param(["model.l2=0"], ["model.l2=0", "above 0"], id="no penalty"),
    pytest.param(["learm=true"], ["learm", "did you mean learn?"], id="misspelt key"),
    pytest.param(["+learm=true"], ["learm", "did you mean learn?"], id="added key"),
    pytest.param(["train=null"], ["train"], id="no file"),
    pytest.param(["model=bert"], ["model=bert", "relations"], id="unknown model"),
    pytest.param(["rounds=many"], ["rounds=many", "Integer"], id="wrong type"),
]


@pytest.mark.parametrize(("wrong", "said"), WRONG)
def test_a_wrong_setting_is_one_line_and_leaves_nothing(
    files: tuple[Path, Path], wrong: list[str], said: list[str], tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    folder = tmp_path / "run"
    status, out, err = run(capsys, f"train={files[0]}", f"test={files[1]}", f"hydra.run.dir={folder}", *wrong)
    assert (status, out) == (2, "")
    assert err.count("\n") == 1
    assert all(part in err for part in said), err
    assert not folder.exists()


def test_a_broken_file_is_one_line_that_names_the_line(
    files: tuple[Path, Path], tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    broken = tmp_path / "broken.jsonl"
    broken.write_text(files[1].read_text() + '{"id": "x", "text": "go", "objects": [], "target": ["a"]}\n')
    status, out, err = run(capsys, f"train={files[0]}", f"test={broken}", f"hydra.run.dir={tmp_path / 'run'}")
    assert (status, out, err.count("\n")) == (2, "", 1)
    assert f"{broken}, line 25: objects: " in err
    assert not (tmp_path / "run").exists()
    for arguments, says in (([f"train={files[0]}"], "test=FILE"), ([], "train")):
        status, _, err = run(capsys, *arguments, f"hydra.run.dir={tmp_path / 'run'}")
        assert (status, err.count("\n")) == (2, 1)
        assert says in err


@pytest.fixture(scope="module")
def learned(files: tuple[Path, Path], tmp_path_factory: pytest.TempPathFactory) -> tuple[Path, str]:
    """A run with learning, where prisms and their words are unknown: its folder and what it printed."""
    folder = tmp_path_factory.mktemp("learned")
    done = subprocess.run(
        [
            *(sys.executable, "-m", "dcg_torch.evaluate", f"train={files[0]}", f"test={files[1]}", "rounds=2"),
            *("known_types=[cube]", "learn=true", "explain=e3", "baseline=true", f"hydra.run.dir={folder}"),
        ],
        capture_output=True,
        text=True,
        check=False,
        cwd=Path(__file__).parent.parent,
    )
    assert done.returncode == 0, done.stderr
    return folder, done.stdout


@pytest.mark.slow
def test_the_words_for_an_unknown_type_are_learned_on_the_way(learned: tuple[Path, str]) -> None:
    folder, out = learned
    figures = json.loads(out.splitlines()[-1])
    contract = {"n", "accuracy", "ci95", "no_answer", "train_seconds", "seconds_per_command", "by_kind", "run_dir"}
    assert contract <= set(figures)
    assert figures["run_dir"] == str(folder)
    assert figures["learned"]["nouns"] == {"pyramid": "prism", "prism": "prism"}
    assert figures["by_kind"]["prism, second half"] == {"n": 8, "accuracy": 1.0}
    assert json.loads((folder / "summary.json").read_text()) == {k: v for k, v in figures.items() if k != "run_dir"}
    rows = [json.loads(row) for row in (folder / "predictions.jsonl").read_text().splitlines()]
    assert [row["id"] for row in rows] == [f"e{k}" for k in range(24)]
    keys = {"id", "predicted", "probability", "noun", "color", "target", "correct"}
    assert all(keys <= set(row) and row["correct"] == (set(row["predicted"]) == set(row["target"])) for row in rows)
    assert sum(row["correct"] for row in rows) / 24 == figures["accuracy"]
    assert sum(figures["errors"].values()) == sum(not row["correct"] for row in rows)
    for part in ("parse_ms", "ground_ms", "learn_ms"):
        assert 0.0 < figures[part]["median"] <= figures[part]["p95"]
    assert 0.0 <= figures["calibration_error"] <= 1.0
    assert 0.0 <= figures["baseline_accuracy"] <= 1.0


@pytest.mark.slow
def test_one_decision_is_explained_and_told_from_the_second_best(learned: tuple[Path, str]) -> None:
    _, out = learned
    assert "what moved it, as log-odds" in out
    assert "what told o0 from the second best, o" in out
    assert "noun: pyramid" in out
    assert "\r" not in out  # no progress bar where there is no terminal


@pytest.mark.slow
def test_the_model_of_a_run_can_be_used_elsewhere(learned: tuple[Path, str]) -> None:
    model = load(learned[0] / "model")
    assert isinstance(model, LexicalModel)
    assert {"pyramid", "prism", "cube"} <= set(model.symbols)


@pytest.mark.slow
def test_colours_left_out_of_the_training_are_learned_on_the_way(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """The percepts' teal is never named in the training; the test calls it navy."""
    rng = np.random.default_rng(1)
    train = [episode(k, rng, "cube", "cube", COLORS[k % 3]) for k in range(30)]
    said = {"red": "red", "green": "green", "teal": "navy"}
    test = [episode(k, rng, "cube", "cube", COLORS[k % 3], said[COLORS[k % 3]]) for k in range(18)]
    paths = [f"{name}={write(tmp_path / name, rows)}" for name, rows in (("train", train), ("test", test))]
    settings = ("known_colors=[red,green]", "learn=true", "rounds=1", f"hydra.run.dir={tmp_path / 'run'}")
    status, out, err = run(capsys, *paths, *settings)
    assert status == 0, err
    figures = json.loads(out.splitlines()[-1])
    assert figures["learned"]["colors"] == {"navy": "teal"}
    assert figures["by_kind"]["color teal, second half"]["accuracy"] == 1.0


@pytest.mark.slow
def test_an_interrupted_run_leaves_no_whole_looking_file(files: tuple[Path, Path], tmp_path: Path) -> None:
    """Nor those of the run before it in the same folder."""
    folder = tmp_path / "run"
    folder.mkdir()
    (folder / "predictions.jsonl").write_text("old\n")
    (folder / "summary.json").write_text("{}\n")
    rows = [json.loads(row) for row in files[0].read_text().splitlines()]
    many = write(tmp_path / "many.jsonl", [{**row, "id": f"{row['id']} {k}"} for k in range(40) for row in rows])
    process = subprocess.Popen(
        [sys.executable, "-m", "dcg_torch.evaluate", f"train={many}", f"test={many}", f"hydra.run.dir={folder}"],
        stdout=subprocess.DEVNULL,
        stderr=subprocess.PIPE,
        text=True,
        cwd=Path(__file__).parent.parent,
        start_new_session=True,
        preexec_fn=lambda: signal.signal(signal.SIGINT, signal.default_int_handler),
    )
    until = time.monotonic() + 120.0
    while not (folder / "predictions.jsonl.part").exists():
        assert process.poll() is None
        assert time.monotonic() < until
        time.sleep(0.02)
    os.kill(process.pid, signal.SIGINT)
    _, err = process.communicate(timeout=60)
    assert process.returncode == 130
    assert "Traceback" not in err
    assert not (folder / "predictions.jsonl").exists()
    assert not (folder / "summary.json").exists()


class _Read:
    """A reading without a tree."""

    tree = None
    problem = "made up"
    noun = None
    color = None


def answers(rng: np.random.Generator, n: int) -> list[Answer]:
    """Answers without solutions: what is tested here counts them."""
    read: Parse = _Read()
    made = [Episode.model_validate(episode(k, rng, "cube", ("cube", "prism")[k % 5 > 2], "red")) for k in range(n)]
    return [Answer(e, read, None, "known", "plain", 1, Seconds(0.001, 0.002)) for e in made]


def test_halves_are_those_of_the_file(monkeypatch: pytest.MonkeyPatch) -> None:
    found = answers(np.random.default_rng(0), 10)
    found = [found[k] for k in (0, 1, 2, 5, 6, 3, 7, 8, 4, 9)]  # cubes first, prisms but one in the second half
    right = {id(found[k]) for k in (0, 1, 5)}
    monkeypatch.setattr(Answer, "correct", property(lambda self: id(self) in right))
    kinds = summarise(found, 1.0)["by_kind"]
    halves = {name: [k for k, a in enumerate(found) if a.episode.objects[0].type == name] for name in ("cube", "prism")}
    for name, at in halves.items():
        for which, inside in (("first half", range(5)), ("second half", range(5, 10))):
            own = [k for k in at if k in inside]
            if own:
                share = sum(id(found[k]) in right for k in own) / len(own)
                assert kinds[f"{name}, {which}"] == {"n": len(own), "accuracy": share}
            else:
                assert f"{name}, {which}" not in kinds
    assert kinds["first half"]["n"] == kinds["second half"]["n"] == 5


def test_the_calibration_error_is_that_of_its_definition(monkeypatch: pytest.MonkeyPatch) -> None:
    rng = np.random.default_rng(3)
    found = answers(rng, 200)
    told = {id(a): (float(rng.random()), bool(rng.random() < 0.5)) for a in found}
    told[id(found[0])] = (1.0, True)  # belongs to the last bin
    monkeypatch.setattr(Answer, "probability", property(lambda self: told[id(self)][0]))
    monkeypatch.setattr(Answer, "correct", property(lambda self: told[id(self)][1]))
    expected = 0.0
    for k in range(10):
        inside = [v for v in told.values() if k / 10 <= v[0] < (k + 1) / 10 or (k == 9 and v[0] == 1.0)]
        if inside:
            gap = abs(sum(p for p, _ in inside) / len(inside) - sum(r for _, r in inside) / len(inside))
            expected += len(inside) / len(found) * gap
    assert calibration_error(found) == pytest.approx(expected, abs=1e-12)


def test_a_clear_command_is_answered_with_the_probability_of_its_noun_phrase(
    parser: Parser, training: TrainingSet
) -> None:
    """Verb and preposition are taught to be about the object meant: no belief leaks to the twenty others."""
    rng = np.random.default_rng(2)
    train = [Episode.model_validate(episode(k, rng, "cube", "cube", COLORS[k % 3])) for k in range(120)]
    variant = Variant(groups=frozenset(Group) - {Group.OPEN}, hypothetical=False, l2=0.2, synonyms=0.8)
    evaluation = Evaluation(train, training, variant, parser.parse, rounds=1)
    row = episode(0, rng, "cube", "cube", "red")
    more = [{"id": f"x{k}", "type": "prism", "color": "teal", "position": [k, 9.0]} for k in range(20)]
    asked = Episode.model_validate({**row, "objects": [*row["objects"], *more]})
    (answer,) = evaluation.answers([asked])
    assert answer.solution is not None
    (verb,) = [answer.solution.tree]
    noun = FactorGraph(verb.children[0], answer.solution.world)
    alone = noun.solve(evaluation.model.features, evaluation.model.factor).probabilities["o0"]
    assert answer.correct
    assert answer.probability == pytest.approx(alone, abs=0.05)
