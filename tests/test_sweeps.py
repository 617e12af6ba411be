"""A sweep that was interrupted goes on when the same command is given, under each launcher that is installed."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest

SWEEP = ("-m", "model=dcg,dcg_upup", "simulator=fake", "trials=6", "iterations=2", "speaker=canonical", "workers=1")
QUIET = ("figures=false", "tensorboard=false")
JOBLIB = ("hydra/launcher=joblib", "hydra.launcher.n_jobs=2")


def command(directory: Path, *more: str) -> list[str]:
    return [sys.executable, "-m", "dcg_torch", *SWEEP, *QUIET, *more, f"hydra.sweep.dir={directory}"]


def rows(directory: Path) -> dict[str, bytes]:
    """The rows of each run."""
    return {path.parent.name: path.read_bytes() for path in sorted(directory.glob("*/iterations.jsonl"))}


@pytest.fixture(scope="module")
def undisturbed(tmp_path_factory: pytest.TempPathFactory) -> dict[str, bytes]:
    directory = tmp_path_factory.mktemp("undisturbed") / "sweep"
    subprocess.run(command(directory), check=True, capture_output=True)
    return rows(directory)


@pytest.mark.slow
@pytest.mark.parametrize(
    ("launcher", "number"),
    [
        pytest.param(JOBLIB, signal.SIGTERM, id="joblib"),
        pytest.param(JOBLIB, signal.SIGKILL, id="joblib, without a warning"),
    ],
)
def test_a_sweep_goes_on(
    launcher: tuple[str, ...], number: signal.Signals, undisturbed: dict[str, bytes], tmp_path: Path
) -> None:
    pytest.importorskip("hydra_plugins.hydra_joblib_launcher", reason="the extra sweep is not installed")
    typed = command(tmp_path / "sweep", *launcher)
    process = subprocess.Popen(typed, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True)
    until = time.monotonic() + 90.0
    while not list(tmp_path.glob("sweep/*/trials/*.jsonl")) and process.poll() is None and time.monotonic() < until:
        time.sleep(0.02)
    os.kill(process.pid, number)  # the launcher alone, as a scheduler does it
    _, err = process.communicate(timeout=60.0)
    if number == signal.SIGTERM:
        assert process.returncode == 143
        assert f"the same command with hydra.sweep.dir={tmp_path / 'sweep'} goes on from here" in err
    assert "Traceback" not in err
    assert rows(tmp_path / "sweep") != undisturbed
    done = subprocess.run(typed, check=False, capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    assert rows(tmp_path / "sweep") == undisturbed
