"""Processes that work off a list of tasks, and leave nothing behind however they end.

Plain pipes, no shared memory: joblib and `concurrent.futures` keep semaphores there, which stay when a whole group of
processes is killed.
"""

from __future__ import annotations

import atexit
import contextlib
import functools
import multiprocessing
import os
import pickle
import queue
import shutil
import signal
import tempfile
import threading
import time
import traceback
from collections import deque
from collections.abc import Callable, Generator, Iterator, Sequence
from multiprocessing import forkserver, resource_tracker, util
from multiprocessing.connection import Connection, wait
from multiprocessing.context import ForkServerContext, SpawnContext
from multiprocessing.process import BaseProcess
from pathlib import Path
from typing import TYPE_CHECKING, Any, TypeVar

from dcg_torch.storage.errors import UserError

if TYPE_CHECKING:  # it takes a while to load, and `prepare` is to be called before
    from dcg_torch.settings import Settings

T = TypeVar("T")

_PRELOADED = ("dcg_torch.__main__", "dcg_torch.experiment.preloads")
"""Modules that are imported once, for all processes."""
TICK = 0.25
"""Seconds after which `work_off` speaks up even if no task has ended."""


class WorkerKilledError(UserError):
    """A process that worked off tasks was killed from outside; the message is one line."""


def may_start_processes() -> bool:
    """Whether this process is one that a user started; one that a launcher of sweeps made works alone."""
    return multiprocessing.current_process().name == "MainProcess"


def works_alone(settings: Settings) -> bool:
    """Whether the settings ask for no other process: one trial, one worker, or a window, of which there is one."""
    return settings.trials < 2 or settings.workers == 1 or settings.simulator.gui


@functools.cache
def leave_with_parent() -> None:
    """End this process within a second of its parent's death, even in the middle of a task.

    For processes that joblib starts: they would work on for minutes after whoever asked for it was killed.
    """
    parent = os.getppid()

    def watch() -> None:
        while os.getppid() == parent:
            time.sleep(TICK)
        os._exit(1)

    threading.Thread(target=watch, daemon=True).start()


def cores() -> int:
    """How many this process may use: under Slurm those of the job, not those of the machine."""
    return len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1


def prepare() -> None:
    """Start the process that workers are forked from, and go on at once: it takes seconds to import what they need.

    It ends with this process, whether it was of use or not. Nothing is started where there is but one core.
    """
    if not may_start_processes() or cores() < 2 or "forkserver" not in multiprocessing.get_all_start_methods():
        return
    with _interrupts_wait():
        _context()
        forkserver.ensure_running()
    atexit.register(_end_forkserver)


def _end_forkserver() -> None:
    """It would notice its parent's end once it has imported all; what reads its output need not wait for that."""
    pid = getattr(forkserver._forkserver, "_forkserver_pid", None)
    if pid is not None:
        with contextlib.suppress(OSError):
            os.kill(pid, signal.SIGTERM)


def work_off(
    work: Callable[[T], object], tasks: Sequence[T], workers: int, *, bare: bool = False
) -> Generator[list[T]]:
    """Do `work` for every task, each in one of several new processes; a script needs `if __name__ == "__main__"`.

    Args:
        work: what can be pickled; its result is thrown away.
        tasks: handed out in this order, the next one to a process when a value is asked for after its last.
        workers: how many processes, at the most.
        bare: processes that have imported nothing, and are there while what the others are forked from still imports.

    Yields:
        The tasks that ended since, about four times a second; mostly none, and none when the first have begun.

    Raises:
        WorkerKilledError: a process was killed.
        Exception: what `work` raised.
    """
    if not may_start_processes():
        for task in tasks:
            work(task)
            yield [task]
        return
    yield from _work_off(work, tasks, workers, bare)


def _work_off(work: Callable[[T], object], tasks: Sequence[T], workers: int, bare: bool) -> Generator[list[T]]:
    waiting = deque(tasks)
    links: dict[Connection, BaseProcess] = {}
    try:
        with _interrupts_wait():
            for _ in range(min(workers, len(tasks))):
                link, process = _start(work, bare)
                links[link] = process
                _send(link, waiting.popleft())
        yield []
        busy = set(links)
        while busy:
            ended: list[T] = []
            for link in busy.intersection(wait(list(busy), TICK)):
                ended.append(_receive(link))
                if waiting:
                    _send(link, waiting.popleft())
                else:
                    busy.discard(link)
            yield ended
    finally:
        for link in links:
            link.close()  # which ends its process
        for process in links.values():
            process.join(timeout=2.0)
            process.kill()
            process.join()


_LONGEST = 50
"""Bytes of a folder in which a socket's path fits: multiprocessing adds a folder and a name to ours."""


def _context() -> ForkServerContext | SpawnContext:
    """Of new processes: forked from one that has imported what a trial needs, where there is such a thing."""
    if "forkserver" not in multiprocessing.get_all_start_methods():
        return multiprocessing.get_context("spawn")
    context = multiprocessing.get_context("forkserver")
    context.set_forkserver_preload(list(_PRELOADED))
    _keep_sockets_in(workers_folder(os.getpid()))
    return context


def workers_folder(process: int) -> Path:
    """Where a process keeps the socket by which it starts workers: named, so that what a kill leaves can be removed.

    A socket's path has at most about a hundred bytes, so this may not be in the folder for temporary files.
    """
    kept = Path(tempfile.gettempdir())
    return (kept if len(os.fsencode(kept)) <= _LONGEST else Path("/tmp")) / f"dcg_torch-{process}"


def _keep_sockets_in(folder: Path) -> None:
    """Let multiprocessing put its files into a folder that ends with this process; nothing if it stands already."""
    try:
        folder.mkdir(mode=0o700)
    except OSError:
        return
    before, tempfile.tempdir = tempfile.tempdir, str(folder)
    try:
        util.get_temp_dir()
    finally:
        tempfile.tempdir = before
    util.Finalize(None, shutil.rmtree, args=(folder, True), exitpriority=-200)  # after what multiprocessing removes


def _start(work: Callable[[T], object], bare: bool) -> tuple[Connection, BaseProcess]:
    context = multiprocessing.get_context("spawn") if bare else _context()
    ours, theirs = context.Pipe()
    process = context.Process(target=_serve, args=(theirs, work), daemon=True)
    try:
        process.start()
    except (EOFError, ConnectionError):  # of the process that workers are forked from
        raise _killed() from None
    theirs.close()
    return ours, process


def _killed() -> WorkerKilledError:
    return WorkerKilledError(
        "a worker process was killed, perhaps for want of memory (then try workers=1); "
        "the same command in the same folder goes on from here"
    )


def _send(link: Connection, task: object) -> None:
    try:
        link.send(task)
    except OSError:
        raise _killed() from None


def _receive(link: Connection) -> Any:
    try:
        task, error, told = link.recv()
    except (EOFError, OSError):
        raise _killed() from None
    if error is not None:
        raise error from RuntimeError(f"in a worker process:\n{told}")
    return task


def _serve(link: Connection, work: Callable[[T], object]) -> None:
    """What a process does: one task after another, until its parent closes the pipe, or is gone."""
    tasks: queue.SimpleQueue[T] = queue.SimpleQueue()
    threading.Thread(target=_listen, args=(link, tasks), daemon=True).start()
    while True:
        task = tasks.get()
        try:
            work(task)
            link.send((task, None, ""))
        except Exception as error:
            link.send((task, portable(error), traceback.format_exc()))


def _listen(link: Connection, tasks: queue.SimpleQueue[T]) -> None:
    with contextlib.suppress(EOFError, OSError):
        while True:
            tasks.put(link.recv())
    os._exit(1)  # even in the middle of a task: whoever asked for it is gone


def portable(error: Exception) -> Exception:
    """The error, if it comes through a pipe as it is."""
    try:
        pickle.loads(pickle.dumps(error))
    except Exception:
        return RuntimeError(f"{type(error).__name__}: {error}")
    return error


@contextlib.contextmanager
def _interrupts_wait() -> Iterator[None]:
    """Hold back Ctrl-C until the end; the processes that are started meanwhile never hear of it.

    They are in the terminal's group, and one that is still importing would print a traceback. This process ends them.
    """
    resource_tracker.ensure_running()  # at its own start it lets interrupts through again
    before = signal.pthread_sigmask(signal.SIG_BLOCK, {signal.SIGINT})
    try:
        yield
    finally:
        signal.pthread_sigmask(signal.SIG_SETMASK, before)
