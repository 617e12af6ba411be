"""The command line: one line and exit status 2 for wrong input, going on after an interruption, sweeps."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest
from making import typed

from dcg_torch.cli.console import make_console
from dcg_torch.cli.run import main
from dcg_torch.experiment.folder import ITERATIONS, PARTS, TIMINGS, part_of
from dcg_torch.experiment.pool import WorkerKilledError
from dcg_torch.report.__main__ import main as report
from dcg_torch.report.runs import varied_settings

QUICK = ("simulator=fake", "workers=1", "trials=2", "iterations=2", "speaker=canonical", "figures=false")
PLAIN = (*QUICK, "tensorboard=false")

WRONG = [
    pytest.param(["trils=3"], ["trils", "did you mean trials?"], id="misspelt key"),
    pytest.param(["simulator.giu=true"], ["simulator.giu", "did you mean simulator.gui?"], id="misspelt nested key"),
    pytest.param(["+trils=3"], ["trils", "did you mean trials?"], id="added key"),
    pytest.param(["trials=many"], ["trials=many: give a whole number"], id="wrong type"),
    pytest.param(["color_rate=" + "9" * 400], ["color_rate: a number of hundreds of digits"], id="no end of digits"),
    pytest.param(["animate=[[1]]"], ["animate", "[1]"], id="a list within a list"),
    pytest.param(["figures=maybe"], ["figures=maybe: give true or false"], id="no truth value"),
    pytest.param(["model.l2=x"], ["model.l2=x: give a number"], id="no number"),
    pytest.param(["animate=0"], ["give a list in brackets, as in animate=[0]"], id="no list"),
    pytest.param(["name=[a]"], ["name=[a]: give a text"], id="no text"),
    pytest.param(["simulator=fake", "model.open_world=3"], ["as in model.open_world.NAME=VALUE"], id="no group"),
    pytest.param(["model.groups=[colour]"], ["model.groups", "colour", "dcg, unknown"], id="unknown feature group"),
    pytest.param(["experiment=papre"], ["experiment=papre", "paper"], id="unknown experiment"),
    pytest.param(["model=bert"], ["model=bert", "dcg_upup_away"], id="unknown model"),
    pytest.param(["speaker=parrot"], ["speaker=parrot", "canonical, written"], id="unknown speaker"),
    pytest.param(["trials=0"], ["trials=0", "from 1 to"], id="value out of range"),
    pytest.param(["color_rate=2"], ["color_rate=2", "from 0 to 1"], id="share out of range"),
    pytest.param(["iterations=90000"], ["iterations=90000", "ask for fewer"], id="too few commands"),
    pytest.param(["worlds=no/such/place"], ["no/such/place", "no such directory"], id="no world files"),
    pytest.param(["worlds=pyproject.toml"], ["pyproject.toml: a file", "name the folder"], id="a file of worlds"),
    pytest.param(["name=${nothing}"], ["name", "nothing"], id="broken interpolation"),
    pytest.param(["trials"], ["trials", "KEY=VALUE"], id="no value"),
    pytest.param(["+=0"], ["+=0", "KEY=VALUE"], id="no key"),
    pytest.param(["model=true"], ["model=True", "choose from dcg, "], id="model a truth value"),
    pytest.param(["model=[dcg,1]"], ["model=list of 2", "choose from dcg, "], id="several models"),
    pytest.param(["~model"], ["model=null", "choose from dcg, "], id="no model"),
    pytest.param(["experiment=null"], ["experiment=null", "paper"], id="experiment null"),
    pytest.param(["hydra/launcher=3"], ["hydra/launcher=3", "give the name"], id="launcher a number"),
    pytest.param(["seed=0,1"], ["seed=0,1: several values", "seed=[0,1]", "-m makes"], id="several values"),
    pytest.param(["seed=0,1", "seed=2"], ["seed=0,1 and seed=2", "once"], id="swept and given"),
    pytest.param(["--trials=3"], ["--trials=3", "KEY=VALUE"], id="dashes"),
]


def run(capsys: pytest.CaptureFixture[str], *arguments: str) -> tuple[int, str, str]:
    """`python -m dcg_torch` in this process: exit status, what it printed, its complaints."""
    return typed(capsys, main, "dcg_torch", *arguments)


def contents(directory: Path) -> dict[str, bytes]:
    return {str(p.relative_to(directory)): p.read_bytes() for p in sorted(directory.rglob("*")) if p.is_file()}


# A sweep goes other ways where Hydra parses, where it composes, and where the settings and the worlds are checked.
OF_SWEEPS = (
    "misspelt key",
    "wrong type",
    "unknown model",
    "value out of range",
    "no world files",
    "no value",
    "no key",
    "swept and given",
)


@pytest.mark.parametrize(
    ("wrong", "said", "mode"),
    [pytest.param(*p.values, [], id=f"run, {p.id}") for p in WRONG]
    + [pytest.param(*p.values, ["-m"], id=f"sweep, {p.id}") for p in WRONG if p.id in OF_SWEEPS],
)
def test_wrong_input_is_one_line(
    wrong: list[str], said: list[str], mode: list[str], tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    folders = [f"hydra.run.dir={tmp_path / 'run'}", f"hydra.sweep.dir={tmp_path / 'sweep'}"]
    status, out, err = run(capsys, *mode, *PLAIN, *wrong, *folders)
    assert status == 2
    assert err.startswith("dcg_torch: ")
    assert err.count("\n") == 1
    assert all(part in err for part in said), err
    assert out == ""
    assert not (tmp_path / "run").exists()


def test_broken_world_file_is_named(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    (tmp_path / "bad.yaml").write_text("name: bad\nobjects: [{id: a, type: cube, color: red, position: [1]}]\n")
    status, _, err = run(capsys, *PLAIN, f"worlds={tmp_path}", f"hydra.run.dir={tmp_path / 'run'}")
    assert status == 2
    assert err.count("\n") == 1
    assert "bad.yaml: objects.0.position" in err


def test_help_shows_commands_groups_and_settings(capsys: pytest.CaptureFixture[str]) -> None:
    status, out, _ = run(capsys, "--help")
    assert status == 0
    for part in ("usage: python -m dcg_torch", "experiment=paper", "experiment: ", "color_rate=1.0 ", "Exit status"):
        assert part in out


def test_tables_are_wide_outside_a_terminal() -> None:
    assert make_console().width >= 120


def test_the_folder_of_another_experiment_is_left_alone(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    folder = f"hydra.run.dir={tmp_path / 'run'}"
    assert run(capsys, *PLAIN, folder)[0] == 0
    before = contents(tmp_path / "run")
    status, _, err = run(capsys, *PLAIN, "seed=7", folder)
    assert status == 2
    assert err.count("\n") == 1
    assert "seed=0" in err
    assert "hydra.run.dir" in err
    assert contents(tmp_path / "run") == before
    assert {".hydra/config.yaml", ".hydra/overrides.yaml", "summary.json", "iterations.jsonl"} <= before.keys()


def test_a_line_cut_short_is_done_again(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    whole, cut = tmp_path / "whole", tmp_path / "cut"
    for directory in (whole, cut):
        assert run(capsys, *PLAIN, f"hydra.run.dir={directory}")[0] == 0
    rows = (whole / ITERATIONS).read_bytes()
    assert (cut / ITERATIONS).read_bytes() == rows
    part = part_of(cut, 1)
    part.write_bytes(part.read_bytes()[:-40])
    (cut / ITERATIONS).write_bytes(rows[: len(rows) // 2])
    (cut / TIMINGS).unlink()
    assert run(capsys, *PLAIN, f"hydra.run.dir={cut}")[0] == 0
    assert (cut / ITERATIONS).read_bytes() == rows
    assert len((cut / TIMINGS).read_text().splitlines()) == len(rows.splitlines())
    assert contents(cut / "model") == contents(whole / "model")


def test_a_finished_run_is_reported_again_with_its_own_wall_time(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    tables = []
    for _ in range(2):
        status, out, _ = run(capsys, *PLAIN, f"hydra.run.dir={tmp_path}")
        assert status == 0
        tables.append(out[out.index("This run") :])
    before = contents(tmp_path)
    assert tables[0] == tables[1]
    assert run(capsys, *PLAIN, f"hydra.run.dir={tmp_path}")[0] == 0
    assert contents(tmp_path) == before


def test_a_worker_that_is_killed_is_one_line(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    def killed(*_: object) -> object:
        raise WorkerKilledError("a worker process was killed")

    monkeypatch.setattr("dcg_torch.experiment.worker.run_one", killed)
    status, _, err = run(capsys, *PLAIN, f"hydra.run.dir={tmp_path}")
    assert status == 2
    assert err == "dcg_torch: a worker process was killed\n"


@pytest.mark.slow
def test_a_sweep_has_a_folder_and_curves_for_each_run(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    status, out, err = run(capsys, "-m", *QUICK, "model=dcg,dcg_upup", "seed=0,1", f"hydra.sweep.dir={tmp_path}")
    assert status == 0, err
    folders = sorted(p.name for p in tmp_path.iterdir() if p.is_dir())
    assert folders == ["model=dcg,seed=0", "model=dcg,seed=1", "model=dcg_upup,seed=0", "model=dcg_upup,seed=1"]
    for name in folders:
        assert len(list((tmp_path / name).glob("events.out.tfevents*"))) == 1
        model, seed = (part.partition("=")[2] for part in name.split(","))
        assert varied_settings(tmp_path / name) == {"model": model, "seed": int(seed)}
        assert f"model={name.split(',')[0].removeprefix('model=')} {name.split(',')[1]}" in out
    assert (tmp_path / "comparison.png").stat().st_size > 10_000
    assert report([str(tmp_path)]) == 0
    assert "model=dcg_upup seed=1" in capsys.readouterr().out


@pytest.mark.slow
def test_the_ablation_compares_the_four_variants(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    small = ("simulator=fake", "workers=1", "trials=2", "iterations=2", "figures=false", "tensorboard=false")
    status, out, err = run(capsys, "experiment=ablation", *small, f"hydra.sweep.dir={tmp_path}")
    assert status == 0, err
    variants = ["dcg", "dcg_upup", "dcg_upup_away", "dcg_upup_away_color"]
    assert sorted(p.name for p in tmp_path.iterdir() if p.is_dir()) == [f"model={v}" for v in variants]
    compared = out[out.index("Configurations compared") : out.index("Differences on")]
    assert [line.split()[0] for line in compared.splitlines() if line.strip().startswith("dcg")] == variants


LONGER = ("simulator=fake", "trials=30", "iterations=4", "speaker=canonical", "figures=false", "tensorboard=false")


def start(directory: Path) -> subprocess.Popen[str]:
    """An experiment in a process group of its own, which takes Ctrl-C as from a terminal."""
    return subprocess.Popen(
        [sys.executable, "-m", "dcg_torch", *LONGER, "workers=2", f"hydra.run.dir={directory}"],
        stdout=subprocess.DEVNULL,
        stderr=subprocess.PIPE,
        text=True,
        start_new_session=True,
        # a shell starts jobs in the background with SIGINT ignored, and so may whatever runs these tests
        preexec_fn=lambda: signal.signal(signal.SIGINT, signal.default_int_handler),
    )


def await_rows(directory: Path, count: int, process: subprocess.Popen[str], seconds: float = 120.0) -> None:
    rows, until = directory / ITERATIONS, time.monotonic() + seconds
    while not rows.exists() or rows.read_text().count("\n") < count:
        assert process.poll() is None, "it ended before it could be interrupted"
        assert time.monotonic() < until, "no rows came"
        time.sleep(0.02)


def alive(group: int) -> list[str]:
    """The processes of a group that have not ended."""
    found = []
    for stat in Path("/proc").glob("[0-9]*/stat"):
        try:
            fields = stat.read_text().rpartition(")")[2].split()
        except OSError:
            continue
        if int(fields[2]) == group and fields[0] not in "ZX":
            found.append(stat.parent.name)
    return found


def await_end(group: int, seconds: float = 20.0) -> None:
    until = time.monotonic() + seconds
    while alive(group):
        assert time.monotonic() < until, "workers outlive the run"
        time.sleep(0.05)


@pytest.mark.slow
@pytest.mark.skipif(not Path("/proc/self/stat").exists(), reason="looks for left-over processes in /proc")
def test_a_run_killed_and_then_interrupted_goes_on_to_the_same_bytes(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    directory, whole = tmp_path / "run", tmp_path / "whole"
    killed = start(directory)
    await_rows(directory, 3, killed)
    killed.kill()
    killed.communicate(timeout=60)
    await_end(killed.pid)
    done = (directory / ITERATIONS).read_text().count("\n")

    interrupted = start(directory)
    await_rows(directory, done + 5, interrupted)
    os.killpg(interrupted.pid, signal.SIGINT)
    _, err = interrupted.communicate(timeout=60)
    assert interrupted.returncode == 130
    assert f"hydra.run.dir={directory} goes on" in err
    assert "Traceback" not in err
    await_end(interrupted.pid)

    # In this process and one after another, where the others had two workers.
    assert run(capsys, *LONGER, "workers=1", f"hydra.run.dir={whole}")[0] == 0
    assert len(list((directory / PARTS).iterdir())) >= 2
    assert contents(directory).get(ITERATIONS) != contents(whole)[ITERATIONS]
    assert run(capsys, *LONGER, "workers=1", f"hydra.run.dir={directory}")[0] == 0
    assert contents(directory)[ITERATIONS] == contents(whole)[ITERATIONS]
    assert contents(directory / "model") == contents(whole / "model")
