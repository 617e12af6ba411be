"""A run's trials over joblib's backends, and sweeps by launchers: the same bytes as in sequence, whoever was killed."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
import time
from importlib.util import find_spec
from pathlib import Path

import pytest
from making import typed
from omegaconf import OmegaConf

from dcg_torch.cli.config import launcher_of
from dcg_torch.cli.run import main
from dcg_torch.experiment import runner
from dcg_torch.experiment.backends import require_backend, work_off_joblib
from dcg_torch.experiment.folder import ITERATIONS, PARTS, RunFolderError
from dcg_torch.experiment.outcome import value_of
from dcg_torch.experiment.pool import cores
from dcg_torch.experiment.runner import run
from dcg_torch.report.measures import Measures
from dcg_torch.settings import Backend, Metric, RobotKind, Settings, SettingsError, SimulatorSettings, Speaker
from dcg_torch.storage.errors import UserError

FAKE = ("simulator=fake", "iterations=2", "speaker=canonical", "figures=false", "tensorboard=false")


def settings(backend: Backend, trials: int = 4, workers: int = 2) -> Settings:
    return Settings(
        simulator=SimulatorSettings(kind=RobotKind.fake),
        speaker=Speaker.canonical,
        trials=trials,
        iterations=2,
        workers=workers,
        backend=backend,
    )


def needs(package: str) -> None:
    pytest.importorskip(package, reason=f"{package} is not installed")


def refuse(task: int) -> None:
    if task == 3:
        raise UserError("task 3 is wrong")


def die(task: int) -> None:
    os.kill(os.getpid(), signal.SIGKILL)


def test_a_backend_that_is_not_installed_is_one_line(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("dcg_torch.experiment.backends.find_spec", lambda name: None if name == "ray" else name)
    require_backend(Backend.fork)
    require_backend(Backend.loky)
    with pytest.raises(SettingsError, match=r"backend=ray needs ray.*\[ray\]"):
        require_backend(Backend.ray)


def test_a_cluster_out_of_reach_is_one_line(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    needs("distributed")
    monkeypatch.setenv("DASK_SCHEDULER_ADDRESS", "tcp://127.0.0.1:1")
    monkeypatch.setenv("DASK_DISTRIBUTED__COMM__TIMEOUTS__CONNECT", "1s")
    done = subprocess.run(
        [sys.executable, "-m", "dcg_torch", *FAKE, "trials=3", "backend=dask", f"hydra.run.dir={tmp_path / 'run'}"],
        capture_output=True,
        text=True,
        check=False,
    )
    assert done.returncode == 2
    assert done.stderr.splitlines()[-1].startswith("dcg_torch: backend=dask: no cluster")


@pytest.mark.parametrize("metric", Metric)
def test_every_metric_is_one_of_the_measures(metric: Metric) -> None:
    assert metric in Measures.__dataclass_fields__


def test_the_metric_is_the_share_that_was_right(tmp_path: Path) -> None:
    from dcg_torch.report.measures import measure
    from dcg_torch.report.runs import read_rows

    run(settings(Backend.fork, trials=2, workers=1), tmp_path, lambda _: None)
    rows = read_rows(tmp_path / ITERATIONS)
    assert value_of(measure(rows), Metric.accuracy) == pytest.approx(sum(r.correct for r in rows) / len(rows))


def test_cores_are_those_that_this_process_may_use() -> None:
    if not hasattr(os, "sched_setaffinity"):
        pytest.skip("this system does not tie processes to cores")
    before = os.sched_getaffinity(0)
    try:
        os.sched_setaffinity(0, {min(before)})
        assert cores() == 1
    finally:
        os.sched_setaffinity(0, before)


@pytest.mark.parametrize(
    ("target", "name"),
    [
        ("hydra._internal.core_plugins.basic_launcher.BasicLauncher", "basic"),
        ("hydra_plugins.hydra_joblib_launcher.joblib_launcher.JoblibLauncher", "joblib"),
        ("hydra_plugins.hydra_ray_launcher.ray_launcher.RayLauncher", "ray"),
        ("hydra_plugins.hydra_submitit_launcher.submitit_launcher.SlurmLauncher", "submitit"),
    ],
)
def test_launchers_are_told_apart(target: str, name: str) -> None:
    assert launcher_of(OmegaConf.create({"launcher": {"_target_": target}})) == name


@pytest.mark.parametrize(
    ("wrong", "extra"), [("hydra/launcher=submitit_slurm", "[slurm]"), ("experiment=search", "[optuna]")]
)
def test_a_plugin_that_is_not_installed_is_one_line(
    wrong: str, extra: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    plugin = {"[slurm]": "hydra_submitit_launcher", "[optuna]": "hydra_optuna_sweeper"}[extra]
    if find_spec("hydra_plugins") is not None and find_spec(f"hydra_plugins.{plugin}") is not None:
        pytest.skip(f"{plugin} is installed")
    status, _, err = typed(capsys, main, "dcg_torch", "-m", *FAKE, wrong, f"hydra.sweep.dir={tmp_path / 'sweep'}")
    assert status == 2
    assert err.count("\n") == 1
    assert extra in err


def test_errors_come_through_loky_as_they_are() -> None:
    needs("joblib")
    with pytest.raises(UserError, match=r"^task 3 is wrong$") as error:
        work_off_joblib(refuse, [1, 2, 3, 4], 2, Backend.loky, lambda: None)
    assert "in refuse" in str(error.value.__cause__)


def test_a_worker_of_loky_that_is_killed_is_one_line() -> None:
    needs("joblib")
    with pytest.raises(UserError, match="backend=loky: a worker was lost") as error:
        work_off_joblib(die, [1, 2, 3], 2, Backend.loky, lambda: None)
    assert "\n" not in str(error.value)


def test_what_the_tick_raises_is_raised() -> None:
    needs("joblib")

    def tick() -> None:
        raise OSError(28, "No space left on device")

    with pytest.raises(OSError, match="No space"):
        work_off_joblib(time.sleep, [0.6, 0.6], 2, Backend.loky, tick)


def rows(directory: Path) -> bytes:
    return (directory / ITERATIONS).read_bytes()


@pytest.mark.slow
@pytest.mark.parametrize("backend", [Backend.loky, Backend.ray, Backend.dask])
@pytest.mark.filterwarnings("ignore")  # of these libraries, about themselves
def test_a_backend_gives_the_same_bytes(backend: Backend, tmp_path: Path) -> None:
    for package in ("joblib", {"ray": "ray", "dask": "distributed"}.get(backend, "joblib")):
        needs(package)
    run(settings(Backend.fork, workers=1), tmp_path / "alone", lambda _: None)
    assert run(settings(backend), tmp_path / "many", lambda _: None) == 4
    assert rows(tmp_path / "many") == rows(tmp_path / "alone")
    assert run(settings(Backend.fork), tmp_path / "many", lambda _: None) == 0  # a backend is no other experiment


@pytest.mark.slow
def test_a_run_over_loky_that_is_killed_goes_on(tmp_path: Path) -> None:
    needs("joblib")
    run(settings(Backend.fork, trials=12, workers=1), tmp_path / "alone", lambda _: None)
    command = [sys.executable, "-m", "dcg_torch", *FAKE, "trials=12", "workers=2", "backend=loky"]
    process = subprocess.Popen([*command, f"hydra.run.dir={tmp_path / 'many'}"], stdout=subprocess.DEVNULL)
    until = time.monotonic() + 120.0
    while len(list((tmp_path / "many" / PARTS).glob("[0-9]*.jsonl"))) < 2 and time.monotonic() < until:
        time.sleep(0.02)
    process.kill()
    process.wait()
    before = {path.name for path in (tmp_path / "many" / PARTS).glob("[0-9]*.jsonl")}
    assert 2 <= len(before) < 12
    left = run(settings(Backend.loky, trials=12), tmp_path / "many", lambda _: None)
    assert left <= 12 - len(before)
    assert rows(tmp_path / "many") == rows(tmp_path / "alone")


def test_lines_that_no_node_brings_here_are_missed(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(runner, "work_off_joblib", lambda *_: None)  # as on a node with a disk of its own
    monkeypatch.setattr(runner, "SEEN_WITHIN", 0.0)
    with pytest.raises(RunFolderError, match=r"0000\.jsonl: .* all nodes see"):
        run(settings(Backend.loky), tmp_path, lambda _: None)


def test_what_went_wrong_in_the_jobs_of_a_launcher_is_said(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    from dcg_torch.cli.application import raised_errors

    (tmp_path / "run").mkdir()
    with pytest.raises(UserError, match="full: No space left"), raised_errors(tmp_path / "run"):
        raise OSError(28, "No space left on device", "full")
    assert not (tmp_path / "run").exists()
