"""Processes that work off tasks: all are done, errors come through, a death is noticed, nothing lives on."""

from __future__ import annotations

import functools
import os
import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest

from dcg_torch.experiment.pool import WorkerKilledError, work_off
from dcg_torch.storage.errors import UserError


def note(directory: Path, task: int) -> None:
    (directory / str(task)).write_text(str(os.getpid()))


def refuse(task: int) -> None:
    raise UserError(f"task {task} is wrong")


def fail(task: int) -> None:
    raise ZeroDivisionError


def die(task: int) -> None:
    os.kill(os.getpid(), signal.SIGKILL)


def test_every_task_is_done_once_in_another_process(tmp_path: Path) -> None:
    done = [task for ended in work_off(functools.partial(note, tmp_path), range(7), 2) for task in ended]
    assert sorted(done) == list(range(7))
    pids = {(tmp_path / str(task)).read_text() for task in range(7)}
    assert str(os.getpid()) not in pids
    assert len(pids) <= 2
    assert not any(Path(f"/proc/{pid}").exists() for pid in pids)


def test_errors_come_through_with_what_the_worker_said() -> None:
    with pytest.raises(UserError, match=r"^task 3 is wrong$") as error:
        list(work_off(refuse, [3], 1))
    assert "in refuse" in str(error.value.__cause__)
    with pytest.raises(ZeroDivisionError):
        list(work_off(fail, [1], 1))


def test_a_worker_that_is_killed_is_noticed() -> None:
    with pytest.raises(WorkerKilledError, match="was killed") as error:
        list(work_off(die, [1, 2, 3], 2))
    assert "\n" not in str(error.value)


@pytest.mark.parametrize("error", [EOFError("unexpected EOF"), ConnectionResetError(), ConnectionRefusedError()])
def test_so_is_the_death_of_the_process_that_workers_are_forked_from(
    error: Exception, monkeypatch: pytest.MonkeyPatch
) -> None:
    def start(_: object) -> None:
        raise error

    monkeypatch.setattr("multiprocessing.process.BaseProcess.start", start)
    with pytest.raises(WorkerKilledError, match="was killed"):
        list(work_off(refuse, [1], 1))


def test_a_worker_that_dies_before_it_has_a_task_is_noticed(monkeypatch: pytest.MonkeyPatch) -> None:
    def send(_: object, task: object) -> None:
        raise BrokenPipeError

    monkeypatch.setattr("multiprocessing.connection.Connection.send", send)
    with pytest.raises(WorkerKilledError, match="was killed"):
        list(work_off(refuse, [1], 1))


def test_nobody_waits_for_a_consumer_who_left(tmp_path: Path) -> None:
    results = work_off(functools.partial(note, tmp_path), range(100), 2)
    next(filter(None, results))
    results.close()
    pids = {path.read_text() for path in tmp_path.iterdir()}
    assert not any(Path(f"/proc/{pid}").exists() for pid in pids if pid)


_PREPARED = """
from multiprocessing import forkserver
from dcg_torch.experiment.pool import prepare
prepare()
print(forkserver._forkserver._forkserver_pid or "")
"""


def test_a_process_that_was_prepared_in_vain_ends_with_its_parent() -> None:
    done = subprocess.run([sys.executable, "-c", _PREPARED], capture_output=True, text=True, check=True, timeout=60)
    assert done.stderr == ""
    pid = done.stdout.strip()
    assert not pid or not Path(f"/proc/{pid}").exists() or "Z" in Path(f"/proc/{pid}/stat").read_text()


def test_a_bare_process_waits_with_its_next_task_until_it_is_asked_for(tmp_path: Path) -> None:
    results = work_off(functools.partial(note, tmp_path), [1, 2], 1, bare=True)
    assert next(results) == []
    until = time.monotonic() + 60.0
    while not (tmp_path / "1").exists() and time.monotonic() < until:
        time.sleep(0.05)
    time.sleep(0.2)
    assert not (tmp_path / "2").exists()
    assert [task for ended in results for task in ended] == [1, 2]
    assert (tmp_path / "1").read_text() == (tmp_path / "2").read_text() != str(os.getpid())
