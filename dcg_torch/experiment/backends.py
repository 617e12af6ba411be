"""Trials over joblib's backends: loky's processes, a Ray cluster, a Dask cluster.

The cluster is the one that RAY_ADDRESS or DASK_SCHEDULER_ADDRESS names; without one it is started on this machine and
ended with the run. Nothing but files comes of a task, so all that these libraries carry is its number and its error.
"""

from __future__ import annotations

import contextlib
import logging
import os
import threading
import traceback
from collections.abc import Callable, Iterator, Sequence
from importlib.util import find_spec
from pathlib import Path
from typing import Any, TypeVar

from dcg_torch.experiment.pool import TICK, WorkerKilledError, cores, leave_with_parent, portable, workers_folder
from dcg_torch.settings import Backend, SettingsError
from dcg_torch.storage.atomic_files import remove

T = TypeVar("T")

_NEEDED = {
    Backend.loky: (("joblib",), "sweep"),
    Backend.ray: (("joblib", "ray"), "ray"),
    Backend.dask: (("joblib", "distributed"), "dask"),
}
"""The packages of a backend, and our extra that draws them in."""
_ADDRESS = {Backend.ray: "RAY_ADDRESS", Backend.dask: "DASK_SCHEDULER_ADDRESS"}


def require_backend(backend: Backend) -> None:
    """See that what a backend needs is installed.

    Raises:
        SettingsError: it is not.
    """
    packages, extra = _NEEDED.get(backend, ((), ""))
    for package in packages:
        if find_spec(package) is None:
            raise SettingsError(
                f"backend={backend} needs {package}, which is not installed; pip install -e '.[{extra}]', "
                "or take backend=fork"
            )


def work_off_joblib(
    work: Callable[[T], object], tasks: Sequence[T], workers: int, backend: Backend, tick: Callable[[], None]
) -> None:
    """Do `work` for every task over a backend of joblib, here or on other machines.

    Args:
        work: what can be pickled; its result is thrown away. It may be done twice for a task, even at the same time:
            a cluster gives the tasks of a node that it has lost to another.
        tasks: handed out in this order.
        workers: how many at a time; 0: as many as the cluster has.
        backend: other than `fork`.
        tick: called about four times a second meanwhile, by another thread, never twice at the same time.

    Raises:
        WorkerKilledError: a process was killed, or a cluster is out of reach.
        Exception: what `work` or `tick` raised.
    """
    from joblib import Parallel, delayed, parallel_config

    with _cluster(backend, workers), _ticking(tick), parallel_config(backend=str(backend)):
        calls = (delayed(_caught)(work, task, near=backend is Backend.loky) for task in tasks)
        try:
            results = Parallel(n_jobs=workers or -1, batch_size=1)(calls)
        except Exception as error:
            raise _of_the_cluster(error, backend) from error
        except KeyboardInterrupt:
            remove_shared_memory(os.getpid())  # a signal to the group ends whoever would do it
            raise
    for failed, told in results:
        if failed is not None:
            raise failed from RuntimeError(f"in a worker process:\n{told}")


def remove_shared_memory(process: int) -> None:
    """Remove what joblib keeps in shared memory, and the workers' socket, of a process that hands out no more tasks."""
    for pattern in (f"sem.loky-{process}-*", f"joblib_memmapping_folder_{process}_*"):
        for left in Path("/dev/shm").glob(pattern):
            remove(left)
    if workers_folder(process).exists():
        remove(workers_folder(process))


def _caught(work: Callable[[T], object], task: T, *, near: bool) -> tuple[Exception | None, str]:
    """The error of a task as a value: each backend wraps what is raised in its own way.

    Args:
        near: the process that hands out the tasks is this one's parent.
    """
    if near:
        leave_with_parent()
    try:
        work(task)
    except Exception as error:
        return portable(error), traceback.format_exc()
    return None, ""


def _of_the_cluster(error: Exception, backend: Backend) -> Exception:
    """One line of what a backend raises by itself: a lost worker in most cases."""
    said = " ".join(str(error).split())[:200]
    return WorkerKilledError(
        f"backend={backend}: a worker was lost ({type(error).__name__}: {said}); "
        "the same command in the same folder goes on from here"
    )


@contextlib.contextmanager
def _ticking(tick: Callable[[], None]) -> Iterator[None]:
    """Call `tick` in a thread now and then; what it raised is raised at the end."""
    ended, failed = threading.Event(), list[BaseException]()

    def run() -> None:
        try:
            while not ended.wait(TICK):
                tick()
        except BaseException as error:
            failed.append(error)

    thread = threading.Thread(target=run, daemon=True)
    thread.start()
    try:
        yield
    finally:
        ended.set()
        thread.join()
    if failed:
        raise failed[0]


@contextlib.contextmanager
def _cluster(backend: Backend, workers: int) -> Iterator[None]:
    """A backend, ready to be used; what was started for it is ended."""
    started = {Backend.ray: _ray, Backend.dask: _dask}.get(backend, lambda _: contextlib.nullcontext())
    address = os.environ.get(_ADDRESS.get(backend, ""))
    try:
        context = started(0 if address else workers or cores())
        context.__enter__()
    except (OSError, RuntimeError, TimeoutError, ValueError) as error:
        said = " ".join(str(error).split())[:200]
        where = f"{_ADDRESS[backend]}={address}" if address else "on this machine"
        raise WorkerKilledError(
            f"backend={backend}: no cluster {where} ({said}); mend it, or take backend=fork"
        ) from error
    try:
        yield
    finally:
        context.__exit__(None, None, None)


@contextlib.contextmanager
def _ray(workers: int) -> Iterator[None]:
    """Ray with so many workers on this machine; 0: the cluster that RAY_ADDRESS names."""
    os.environ.setdefault("RAY_USAGE_STATS_ENABLED", "0")  # it would tell its makers of every run
    import ray
    from ray.util.joblib import register_ray

    register_ray()
    logging.getLogger("ray").setLevel(logging.ERROR)
    own: dict[str, Any] = {"num_cpus": workers, "include_dashboard": False} if workers else {}
    ray.init(configure_logging=False, log_to_driver=False, **own)
    try:
        yield
    finally:
        ray.shutdown()


@contextlib.contextmanager
def _dask(workers: int) -> Iterator[None]:
    """Dask with so many processes of one thread on this machine; 0: the scheduler that its configuration names."""
    from distributed import Client, LocalCluster

    logging.getLogger("distributed").setLevel(logging.CRITICAL)
    if not workers:
        with Client():
            yield
        return
    with LocalCluster(n_workers=workers, threads_per_worker=1, dashboard_address=None) as cluster, Client(cluster):
        yield


__all__ = ["remove_shared_memory", "require_backend", "work_off_joblib"]
