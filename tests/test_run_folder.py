"""A run folder after what may happen to it: damage, a full disk, a second process, a kill. A rerun makes it whole."""

from __future__ import annotations

import errno
import itertools
import json
import os
import shlex
import shutil
import signal
import subprocess
import sys
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest
from hostile import EPISODE
from making import typed

from dcg_torch.cli.run import main
from dcg_torch.experiment.folder import ITERATIONS, MODEL, SETTINGS, TIMINGS, RunFolderError, lexicon_of, part_of
from dcg_torch.experiment.runner import run
from dcg_torch.report import __main__ as report
from dcg_torch.settings import LearnerKind, ModelSettings, RobotKind, Settings, SimulatorSettings, Speaker
from dcg_torch.storage.claim import claim

PLAIN = ("simulator=fake", "workers=1", "trials=2", "iterations=2", "speaker=canonical", "figures=false")
SETTINGS_OF_PLAIN = Settings(
    simulator=SimulatorSettings(kind=RobotKind.fake),
    trials=2,
    iterations=2,
    speaker=Speaker.canonical,
    workers=1,
)


def whole(directory: Path) -> dict[str, bytes]:
    """What a run leaves, without what tells of wall-clock times."""
    return {
        str(p.relative_to(directory)): p.read_bytes() if p.suffix != ".tfevents" and "trials" not in p.parts else b""
        for p in sorted(directory.rglob("*"))
        if p.is_file() and p.name not in (TIMINGS, "summary.json") and ".hydra" not in p.parts
    }


def go_on(directory: Path, settings: Settings = SETTINGS_OF_PLAIN) -> list[str]:
    """Run in a folder; what was said of damage."""
    said: list[str] = []
    run(settings, directory, lambda rows: None, said.append)
    return said


@pytest.fixture(scope="module")
def finished(tmp_path_factory: pytest.TempPathFactory) -> Path:
    directory = tmp_path_factory.mktemp("finished") / "run"
    assert go_on(directory) == []
    return directory


@pytest.fixture
def damaged(finished: Path, tmp_path: Path) -> Path:
    """A copy of the finished run, to be damaged."""
    return Path(shutil.copytree(finished, tmp_path / "run"))


def edit_lines(path: Path, change: Callable[[list[str]], list[str]]) -> None:
    path.write_text("".join(change(path.read_text().splitlines(keepends=True))))


DAMAGE: list[Any] = [
    pytest.param(lambda d: (d / MODEL / "model.json").unlink(), "model", id="no model.json"),
    pytest.param(lambda d: (d / MODEL / "weights.safetensors").write_bytes(b""), "model", id="empty weights"),
    pytest.param(lambda d: shutil.rmtree(d / MODEL), "model", id="no model"),
    pytest.param(
        lambda d: edit_lines(part_of(d, 0), lambda x: [x[0], "garbage\tgarbage\n"]), "line 2 is no record", id="garbage"
    ),
    pytest.param(lambda d: edit_lines(part_of(d, 0), lambda x: x[::-1]), "line 1 is one of another", id="order"),
    pytest.param(lambda d: shutil.copy(part_of(d, 1), part_of(d, 0)), "another trial", id="another trial's"),
    pytest.param(lambda d: edit_lines(part_of(d, 1), lambda x: [*x, x[1]]), "more than 2 lines", id="too many"),
    pytest.param(lambda d: part_of(d, 1).write_bytes(b"\xff\xfe\n"), "not readable", id="binary"),
    pytest.param(lambda d: edit_lines(part_of(d, 1), lambda x: [x[0], x[1][:-9]]), None, id="cut short"),
    pytest.param(lambda d: (d / ITERATIONS).write_bytes(b"\xff"), None, id="binary rows"),
    pytest.param(lambda d: (d / TIMINGS).unlink(), None, id="no times"),
]


@pytest.mark.parametrize(("damage", "says"), DAMAGE)
def test_damage_is_found_said_and_mended(
    damage: Callable[[Path], object], says: str | None, damaged: Path, finished: Path
) -> None:
    damage(damaged)
    said = go_on(damaged)
    assert whole(damaged) == whole(finished)
    assert len(said) == (says is not None)
    assert all(says is not None and says in line and "\n" not in line for line in said)
    assert go_on(damaged) == []


def test_a_lexicon_cut_short_is_made_again(tmp_path: Path) -> None:
    groups = ["dcg", "unknown", "hypothetical", "color", "open"]
    settings = Settings(
        **{**vars(SETTINGS_OF_PLAIN), "model": ModelSettings(groups=groups, learner=LearnerKind.word_posterior)}
    )
    go_on(tmp_path / "run", settings)
    before = whole(tmp_path / "run")
    lexicon = lexicon_of(tmp_path / "run", 0)
    lexicon.write_bytes(lexicon.read_bytes()[:-20])
    (said,) = go_on(tmp_path / "run", settings)
    assert "0000.json: missing or damaged; trial 0 is run again" in said
    assert whole(tmp_path / "run") == before


def test_the_model_is_that_of_the_last_trial_whatever_was_asked_before(damaged: Path, finished: Path) -> None:
    go_on(damaged, Settings(**{**vars(SETTINGS_OF_PLAIN), "trials": 3}))
    assert json.loads((damaged / MODEL / "origin.json").read_text()) == {"trial": 2}
    go_on(damaged)
    part_of(damaged, 2).unlink()
    assert whole(damaged) == whole(finished)


@pytest.mark.parametrize(
    ("damage", "says"),
    [
        pytest.param(lambda d: (d / SETTINGS).write_bytes(b"\xff"), "is not readable", id="settings no text"),
        pytest.param(lambda d: (d / SETTINGS).write_bytes(b"[]"), "is not readable", id="settings a list"),
        pytest.param(lambda d: (d / SETTINGS).unlink(), "but no settings.json", id="no settings"),
        pytest.param(
            lambda d: ((d / SETTINGS).unlink(), (d / SETTINGS).mkdir()), "is a folder", id="settings a folder"
        ),
        pytest.param(
            lambda d: ((d / ITERATIONS).unlink(), (d / ITERATIONS).mkdir()), "is a folder", id="rows a folder"
        ),
    ],
)
def test_a_folder_of_which_nobody_can_say_whose_it_is(
    damage: Callable[[Path], object], says: str, damaged: Path
) -> None:
    damage(damaged)
    before = whole(damaged)
    with pytest.raises(RunFolderError, match=says) as error:
        go_on(damaged)
    assert "\n" not in str(error.value)
    assert whole(damaged) == before


@pytest.mark.parametrize("point", [1, 4, 7, 10])
def test_a_disk_that_is_full_at_any_moment(
    point: int, finished: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """From the `point`-th file on that is brought to the disk or put in its place there is no room."""
    count = itertools.count(1)

    def failing(real: Callable[..., Any]) -> Callable[..., Any]:
        def call(*arguments: Any, **further: Any) -> Any:
            if next(count) >= point:
                raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC), str(arguments[-1]))
            return real(*arguments, **further)

        return call

    with monkeypatch.context() as patch:
        patch.setattr("dcg_torch.storage.atomic_files._to_disk", failing(Path.exists))
        patch.setattr("dcg_torch.storage.atomic_files.os.replace", failing(os.replace))
        patch.setattr("dcg_torch.storage.atomic_files.os.rename", failing(os.rename))
        with pytest.raises(OSError, match="No space left"):
            go_on(tmp_path / "run")
    go_on(tmp_path / "run")
    assert whole(tmp_path / "run") == whole(finished)


@pytest.mark.parametrize(
    ("folder", "says"),
    [
        ("/", "this is / itself"),
        ("", "itself"),
        ("/dev/null", "no folder"),
        ("a_file", "no folder"),
        ("a_file/x", "a_file"),
    ],
)
def test_what_is_no_run_folder_is_one_line(
    folder: str, says: str, tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    (tmp_path / "a_file").touch()
    for key in ("run", "sweep") if folder != "" else ("run",):
        mode = ["-m"] if key == "sweep" else []
        status, out, err = typed(capsys, main, "dcg_torch", *mode, *PLAIN, f"hydra.{key}.dir={folder}")
        assert (status, out, err.count("\n")) == (2, "", 1)
        assert says in err
    assert [p.name for p in tmp_path.iterdir()] == ["a_file"]


@pytest.mark.parametrize("name", [SETTINGS, ITERATIONS, "trials/0000.jsonl", "lexicon/0000.json"])
def test_a_pipe_in_a_run_folder_is_one_line(
    name: str, finished: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """Whoever reads from it would wait for ever."""
    folder = Path(shutil.copytree(finished, tmp_path / "run"))
    (folder / name).unlink(missing_ok=True)
    (folder / name).parent.mkdir(exist_ok=True)
    os.mkfifo(folder / name)
    for program in (main, report.main):
        arguments = [*PLAIN, f"hydra.run.dir={folder}"] if program is main else [str(folder)]
        status, out, err = typed(capsys, program, "dcg_torch", *arguments)
        assert (status, out, err.count("\n")) == (2, "", 1)
        assert f"{name}: this is a pipe; remove it" in err


@pytest.mark.parametrize("to", ["nowhere", "elsewhere"])
def test_a_link_in_the_place_of_a_model_is_replaced(to: str, finished: Path, tmp_path: Path) -> None:
    folder = Path(shutil.copytree(finished, tmp_path / "run"))
    shutil.rmtree(folder / MODEL)
    (tmp_path / "elsewhere").mkdir()
    (folder / MODEL).symlink_to(tmp_path / to)
    go_on(folder)
    assert whole(folder) == whole(finished)
    assert not (folder / MODEL).is_symlink()
    assert not list(folder.glob(".model*"))


def test_a_name_too_long_is_one_line(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    status, out, err = typed(capsys, main, "dcg_torch", *PLAIN, f"hydra.run.dir={tmp_path / ('x' * 300)}")
    assert (status, out, err.count("\n")) == (2, "", 1)
    assert "give" in err


def test_the_second_process_in_a_folder_is_told(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    with claim(tmp_path / "run"):
        status, out, err = typed(capsys, main, "dcg_torch", *PLAIN, f"hydra.run.dir={tmp_path / 'run'}")
        assert (status, out, err.count("\n")) == (2, "", 1)
        assert "another process works in this folder" in err
        assert [p.name for p in (tmp_path / "run").iterdir()] == [".lock"]


def left_behind(temporary: Path, process: int) -> list[str]:
    """What a process has left in its folder for temporary files, and in shared memory under its number."""
    shared = Path("/dev/shm").iterdir() if Path("/dev/shm").is_dir() else ()
    named = [*shared, *Path("/tmp").glob("dcg_torch-*")]  # where the folder for temporary files has too long a path
    return [p.name for p in temporary.iterdir()] + [p.name for p in named if str(process) in p.name]


@pytest.mark.slow
@pytest.mark.parametrize("who", ["group"])
def test_a_kill_leaves_nothing_behind_and_a_rerun_makes_it_whole(who: str, finished: Path, tmp_path: Path) -> None:
    temporary = tmp_path / "temporary"
    temporary.mkdir()
    environment = {**os.environ, "TMPDIR": str(temporary)}
    command = [sys.executable, "-m", "dcg_torch", *PLAIN[2:], "simulator=fake", "workers=2", "tensorboard=false"]
    command.append(f"hydra.run.dir={tmp_path / 'run'}")
    process = subprocess.Popen(
        command, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, start_new_session=True, env=environment
    )
    until = time.monotonic() + 60.0
    while not (tmp_path / "run" / ITERATIONS).exists() and process.poll() is None and time.monotonic() < until:
        time.sleep(0.02)
    if who == "worker":
        for child in Path(f"/proc/{process.pid}/task/{process.pid}/children").read_text().split():
            os.kill(int(child), signal.SIGKILL)
    elif who == "group":
        os.killpg(process.pid, signal.SIGKILL)
    else:
        process.terminate()
    _, err = process.communicate(timeout=60)
    assert b"Traceback" not in err
    assert process.returncode == {"parent": 143, "worker": 2, "group": -9}[who]
    done = subprocess.run(command, capture_output=True, text=True, check=False, env=environment)
    assert done.returncode == 0, done.stderr
    assert whole(tmp_path / "run") == whole(finished)
    assert left_behind(temporary, process.pid) == []


@pytest.mark.slow
def test_a_pipe_that_closes_and_a_full_output_are_one_line(tmp_path: Path) -> None:
    """As in `--help | head -1`, where head has gone before all was said."""
    for output, says in ((None, "standard output was closed"), ("/dev/full", "No space left")):
        if output is None:
            read_end, write_end = os.pipe()
            os.close(read_end)
        else:
            write_end = os.open(output, os.O_WRONLY)
        done = subprocess.run(
            [sys.executable, "-m", "dcg_torch", "--help"],
            stdout=write_end,
            stderr=subprocess.PIPE,
            text=True,
            check=False,
        )
        os.close(write_end)
        assert (done.returncode, done.stderr.count("\n")) == (2, 1), done.stderr
        assert says in done.stderr


@pytest.mark.slow
@pytest.mark.parametrize("module", ["dcg_torch", "dcg_torch.evaluate"])
def test_a_closed_stream_takes_nothing_and_breaks_nothing(module: str, tmp_path: Path) -> None:
    """As in `>&-`: what is opened first would get the number of the stream, and what is printed would go into it."""
    (tmp_path / "e.jsonl").write_text(json.dumps(EPISODE) + "\n")
    given = (*PLAIN, "workers=2") if module == "dcg_torch" else (f"test={tmp_path / 'e.jsonl'}",)
    line = shlex.join([sys.executable, "-m", module, *given, f"hydra.run.dir={tmp_path / 'run'}"])
    done = subprocess.run(["sh", "-c", f"{line} <&- >&-"], stderr=subprocess.PIPE, text=True, check=False)
    assert (done.returncode, done.stderr) == (0, "")
