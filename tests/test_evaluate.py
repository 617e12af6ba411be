"""`python -m dcg_torch.evaluate`: what it refuses, what it leaves behind, what it figures. All episodes are made up."""

from __future__ import annotations

import json
import os
import signal
import subprocess
import sys
import time
from pathlib import Path

import numpy as np
import pytest
from episode_making import COLORS, episode, write
from making import typed

from dcg_torch import load
from dcg_torch.evaluate import main
from dcg_torch.learning.word_posterior import WordPosterior


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
    pytest.param(["halves=true"], ["halves=true", "no test file"], id="halves and a test"),
    pytest.param(["halves=true", "folds=3", "test=null"], ["folds=3", "halves=true"], id="folds and halves"),
    pytest.param(["model.l2=0"], ["model.l2=0", "from 1e-06 to 1e+06"], id="no penalty"),
    pytest.param(["learm=true"], ["learm", "did you mean learn?"], id="misspelt key"),
    pytest.param(["+learm=true"], ["learm", "did you mean learn?"], id="added key"),
    pytest.param(["test=null"], ["test", "no file given"], id="no file"),
    pytest.param(["test=[]"], ["test", "no file given"], id="no files"),
    pytest.param(["test=[3]"], ["test=FILE"], id="no name"),
    pytest.param(["model=bert"], ["model=bert", "open_world"], id="unknown model"),
    pytest.param(["rounds=many"], ["rounds=many: give a whole number"], id="wrong type"),
    pytest.param(["baseline=minilm"], ["give a list in brackets, as in baseline=[minilm]"], id="no list"),
    pytest.param(["train=null", "known_types=[cube]"], ["known_types", "give train=FILE"], id="types of no training"),
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
    status, _, err = run(capsys, f"train={files[0]}", f"hydra.run.dir={tmp_path / 'run'}")
    assert (status, err.count("\n")) == (2, 1)
    assert "test=FILE" in err


@pytest.fixture(scope="module")
def learned(files: tuple[Path, Path], tmp_path_factory: pytest.TempPathFactory) -> tuple[Path, str]:
    """A run with learning, where prisms and their words are unknown: its folder and what it printed."""
    folder = tmp_path_factory.mktemp("learned")
    done = subprocess.run(
        [
            *(sys.executable, "-m", "dcg_torch.evaluate", f"train={files[0]}", f"test={files[1]}", "rounds=2"),
            *("known_types=[cube]", "names=opaque", "learn=true", "explain=e3", f"hydra.run.dir={folder}"),
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
    assert figures["learned"] == {"pyramid": "prism", "prism": "prism"}
    assert figures["by_kind"]["prism, second half"] == {"n": 8, "accuracy": 1.0}
    assert json.loads((folder / "summary.json").read_text()) == {k: v for k, v in figures.items() if k != "run_dir"}
    rows = [json.loads(row) for row in (folder / "predictions.jsonl").read_text().splitlines()]
    assert [row["id"] for row in rows] == [f"e{k}" for k in range(24)]
    keys = {"id", "file", "predicted", "probability", "noun", "color", "target", "correct", "refused", "unread"}
    assert all(keys <= set(row) and row["correct"] == (set(row["predicted"]) == set(row["target"])) for row in rows)
    assert sum(row["correct"] for row in rows) / 24 == figures["accuracy"]
    assert sum(figures["errors"].values()) == sum(not row["correct"] for row in rows)
    for part in ("parse_ms", "ground_ms", "learn_ms"):
        assert 0.0 < figures[part]["median"] <= figures[part]["p95"]
    assert 0.0 <= figures["calibration_error"] <= 1.0
    (of_file,) = figures["by_file"].values()
    assert list(figures["by_file"]) == ["test"]
    assert of_file == {key: figures[key] for key in ("n", "accuracy", "ci95", "calibration_error")}


@pytest.mark.slow
def test_one_decision_is_explained_and_told_from_the_second_best(learned: tuple[Path, str]) -> None:
    _, out = learned
    assert "what moved it, as log-odds" in out
    assert "what told o0 from the second best, o" in out
    assert "noun: pyramid" in out
    assert "\r" not in out  # no progress bar where there is no terminal


@pytest.mark.slow
def test_a_table_has_each_file_and_each_baseline(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """Two cubes that differ in colour: who picks by colour words is right, and so is the model."""
    things = [{"id": c, "type": "cube", "color": c, "position": [2, y, 0]} for c, y in (("red", -1), ("blue", 1))]
    rows = [{"id": c, "text": f"go to the {c} cube", "objects": things, "target": [c]} for c in ("red", "blue")]
    rows.append({**rows[0], "id": "left", "text": "go to the cube on the left", "target": ["red"]})
    paths = [write(tmp_path / "one.jsonl", rows[:1]), write(tmp_path / "three.jsonl", rows)]
    arguments = (f"test=[{paths[0]},{paths[1]}]", "baseline=[overlap]", f"hydra.run.dir={tmp_path / 'run'}")
    status, out, err = run(capsys, *arguments)
    assert status == 0, err
    cells = [
        [cell.strip() for cell in line.strip("│┃").split("┃" if "┃" in line else "│")] for line in out.splitlines()
    ]
    by_name = {row[0]: row for row in cells if len(row) == 6}
    assert by_name["file"] == ["file", "commands", "right", "95 % interval", "calibration error", "overlap"]
    assert by_name["one"][1:3] == ["1", "100.0 %"]
    assert by_name["one"][5] == "100.0 %"
    assert by_name["all"][1] == "4"
    assert by_name["three"][5] in ("66.7 %", "100.0 %")  # it draws one of the two on the left
    figures = json.loads(out.splitlines()[-1])
    assert set(figures["by_file"]) == {"one", "three"}
    assert set(figures["baselines"]["overlap"]["by_file"]) == {"one", "three"}


def test_the_model_of_a_run_can_be_used_elsewhere(learned: tuple[Path, str]) -> None:
    model = load(learned[0] / "model")
    assert isinstance(model.learner, WordPosterior)
    assert {"pyramid", "prism", "cube"} <= set(model.symbols)


@pytest.mark.slow
def test_colours_left_out_of_the_training_are_learned_on_the_way(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """The percepts' teal is never named in the training; the test calls it navy, and names of colours are opaque."""
    rng = np.random.default_rng(1)
    train = [episode(k, rng, "cube", "cube", COLORS[k % 3]) for k in range(30)]
    said = {"red": "red", "green": "green", "teal": "navy"}
    test = [episode(k, rng, "cube", "cube", COLORS[k % 3], said[COLORS[k % 3]]) for k in range(18)]
    paths = [f"{name}={write(tmp_path / name, rows)}" for name, rows in (("train", train), ("test", test))]
    settings = (
        "known_colors=[red,green]",
        "names=opaque",
        "learn=true",
        "rounds=1",
        f"hydra.run.dir={tmp_path / 'run'}",
    )
    status, out, err = run(capsys, *paths, *settings)
    assert status == 0, err
    figures = json.loads(out.splitlines()[-1])
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
