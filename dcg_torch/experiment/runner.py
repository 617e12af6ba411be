"""An experiment: trials in parallel, journalled so that an interrupted run can go on.

What a trial needs (torch, spaCy, PyBullet) is imported by `worker`, in the processes that run trials; here it would
only delay their start.

Every trial writes a line to `trials/NNNN.jsonl` as each of its commands ends, and is independent of all others:
its random numbers come from (seed, trial) alone. `iterations.jsonl` and `timings.jsonl` are these lines in the
order of the trials, so the same seed gives the same bytes for any number of workers.
"""

from __future__ import annotations

import contextlib
import json
import os
import signal
import threading
from collections.abc import Callable, Iterator, Sequence
from concurrent.futures.process import BrokenProcessPool
from dataclasses import asdict
from multiprocessing import resource_tracker as mp_tracker
from pathlib import Path

from joblib import Parallel, delayed
from joblib.externals.loky.backend import resource_tracker as loky_tracker

from dcg_torch.experiment.plan import trial_commands
from dcg_torch.records import Iteration, Timing
from dcg_torch.report.summary import flatten
from dcg_torch.settings import ModelSettings, Settings

ITERATIONS, TIMINGS, MODEL = "iterations.jsonl", "timings.jsonl", "model"
PARTS, _FINGERPRINT = "trials", "settings.json"
# What may differ between a run and its continuation: it changes no byte of a trial.
_FREE = ("name", "trials", "workers", "animate", "figures", "tensorboard", "screenshots")


class RunFolderError(ValueError):
    """A run folder that cannot be gone on with; the message is one line."""


class WorkerKilledError(RuntimeError):
    """A process that ran trials was killed from outside; the message is one line."""


def user_errors() -> tuple[type[Exception], ...]:
    """What is raised when the user's input is wrong: each has a message of one line."""
    from dcg_torch.experiment.worker import TRIAL_ERRORS

    return (RunFolderError, *TRIAL_ERRORS)


def part_of(directory: Path, trial: int) -> Path:
    """The file of a trial's own lines."""
    return directory / PARTS / f"{trial:04d}.jsonl"


def animation_of(directory: Path, trial: int) -> Path:
    """The file of a trial's animation."""
    return directory / "animations" / f"trial_{trial:04d}.gif"


def lexicon_of(directory: Path, trial: int) -> Path:
    """The file of what a trial's robot believes of words in the end; only some models have beliefs."""
    return directory / "lexicon" / f"{trial:04d}.json"


def _lines(path: Path) -> list[str]:
    """The whole lines of a file; one that was cut off does not count."""
    return path.read_text(encoding="utf-8").split("\n")[:-1]


def _whole_lines(path: Path) -> list[tuple[str, str]]:
    """The (iteration, timing) lines of a part."""
    if not path.exists():
        return []
    return [(left, right) for left, _, right in (line.partition("\t") for line in _lines(path)) if right]


class Journal:
    """The lines of all trials, appended to `iterations.jsonl` and `timings.jsonl` in the order of the trials.

    Args:
        directory: the run folder.
        trials: how many there are to be.
        iterations: of a trial.
    """

    def __init__(self, directory: Path, trials: int, iterations: int) -> None:
        self._directory, self._trials, self._iterations = directory, trials, iterations
        self._at = (0, 0)
        self._lock = threading.Lock()
        for name in (ITERATIONS, TIMINGS):
            (directory / name).write_bytes(b"")

    def advance(self) -> list[Iteration]:
        """Append what has been finished since; returns the new rows in order."""
        with self._lock:
            new: list[tuple[str, str]] = []
            trial, done = self._at
            while trial < self._trials:
                lines = _whole_lines(part_of(self._directory, trial))
                new += lines[done:]
                done = len(lines)
                if done < self._iterations:
                    break
                trial, done = trial + 1, 0
            self._at = trial, done
            for name, column in ((ITERATIONS, 0), (TIMINGS, 1)):
                with (self._directory / name).open("a", encoding="utf-8") as file:
                    file.writelines(line[column] + "\n" for line in new)
            return [Iteration.model_validate_json(line[0]) for line in new]


def read_run(directory: Path) -> tuple[list[Iteration], list[Timing]]:
    """The rows and times of a run folder."""
    rows, timings = (_lines(directory / name) for name in (ITERATIONS, TIMINGS))
    return [Iteration.model_validate_json(x) for x in rows], [Timing.model_validate_json(x) for x in timings]


def _fingerprint(settings: Settings) -> str:
    kept = {k: v for k, v in asdict(settings).items() if k not in _FREE}
    return json.dumps(kept, indent=2, sort_keys=True) + "\n"


def check_folder(settings: Settings, directory: Path) -> None:
    """See that a run folder is new or belongs to these settings, and that there is what they ask for.

    Nothing is written.

    Raises:
        RunFolderError: the folder holds another experiment.
        SettingsError, WorldFileError, SpeakerError: there is not what the settings ask for.
    """
    mark = directory / _FINGERPRINT
    if mark.exists() and (held := mark.read_text(encoding="utf-8")) != _fingerprint(settings):
        raise RunFolderError(
            f"{directory} holds a run with other settings ({_difference(held, _fingerprint(settings))}); "
            "give hydra.run.dir another folder"
        )
    trial_commands(settings, 0)
    if settings.simulator.gui:
        from dcg_torch.simulator.client import require_display

        require_display()
    if not set(settings.model.groups) <= set(ModelSettings().groups):  # the default's exist: no need to look
        from dcg_torch.experiment.worker import variant

        variant(settings.model)


def _difference(held: str, wanted: str) -> str:
    """The settings in which two fingerprints differ, as they are in the first: "seed=0, model.l2=0.05"."""
    try:
        old, new = flatten(json.loads(held)), flatten(json.loads(wanted))
    except (ValueError, AttributeError):
        return f"its {_FINGERPRINT} is not readable"
    return ", ".join(f"{key}={old.get(key)}" for key in {**old, **new} if old.get(key) != new.get(key))


def prepare(settings: Settings, directory: Path) -> list[int]:
    """Make the run folder, or go on with the one that `check_folder` found good; the trials that are yet to run."""
    (directory / PARTS).mkdir(parents=True, exist_ok=True)
    mark = directory / _FINGERPRINT
    part = mark.with_suffix(".part")
    part.write_text(_fingerprint(settings), encoding="utf-8")
    os.replace(part, mark)
    open_trials = [t for t in range(settings.trials) if len(_whole_lines(part_of(directory, t))) < settings.iterations]
    # a trial is run again for an animation that is not there: its lines come out the same
    undrawn = [t for t in dict.fromkeys(settings.animate) if not animation_of(directory, t).exists()]
    open_trials += [t for t in undrawn if t not in open_trials]
    last = settings.trials - 1
    if not (directory / MODEL).is_dir() and last not in open_trials:
        open_trials.append(last)
    for trial in open_trials:
        part_of(directory, trial).unlink(missing_ok=True)
    return open_trials


def run(settings: Settings, directory: Path, progress: Callable[[Sequence[Iteration]], None]) -> int:
    """Run the trials that are not finished yet, each over the cores; how many these were.

    Args:
        settings: checked ones.
        directory: the run folder; a rerun with the same settings goes on with what is there.
        progress: called now and then with the rows that are new, in order; first with those of an earlier run.

    Raises:
        RunFolderError: the folder holds another experiment.
        WorldFileError, SpeakerError: there is not what the settings ask for; found before anything runs.
        WorkerKilledError: a worker was killed from outside.
    """
    check_folder(settings, directory)
    open_trials = prepare(settings, directory)
    journal = Journal(directory, settings.trials, settings.iterations)
    progress(journal.advance())
    workers = min(settings.workers or os.cpu_count() or 1, max(1, len(open_trials)))
    if settings.simulator.gui:
        workers = 1  # one window to look at
    with _ticking(lambda: progress(journal.advance())):
        jobs = (delayed(_run_trial)(settings, trial, directory, os.getpid()) for trial in open_trials)
        try:
            with _interrupts_wait():
                results = Parallel(n_jobs=workers, return_as="generator_unordered", batch_size=1)(jobs)
            for _ in results:
                pass
        except BrokenProcessPool:
            raise WorkerKilledError(
                "a worker process was killed, perhaps for want of memory (then try workers=1); "
                f"the same command with hydra.run.dir={directory} goes on from here"
            ) from None
    return len(open_trials)


def _run_trial(settings: Settings, trial: int, directory: Path, parent: int) -> None:
    """Run a trial, mostly in another process; nothing but the journal comes back."""
    from dcg_torch.experiment.worker import end_with, run_one

    if os.getpid() != parent:
        end_with(parent)
    run_one(settings, trial, directory)


@contextlib.contextmanager
def _interrupts_wait() -> Iterator[None]:
    """Hold back Ctrl-C until the end; the processes that are started meanwhile never hear of it.

    They are in the terminal's group, and one that is still importing would print a traceback. This process ends them.
    """
    for tracker in (mp_tracker, loky_tracker):  # at their own start these let interrupts through again
        tracker.ensure_running()
    before = signal.pthread_sigmask(signal.SIG_BLOCK, {signal.SIGINT})
    try:
        yield
    finally:
        signal.pthread_sigmask(signal.SIG_SETMASK, before)


@contextlib.contextmanager
def _ticking(work: Callable[[], None], seconds: float = 0.25) -> Iterator[None]:
    """Do `work` every so often in the background, and once more at the end."""
    over = threading.Event()

    def tick() -> None:
        while not over.wait(seconds):
            work()

    thread = threading.Thread(target=tick, daemon=True)
    thread.start()
    try:
        yield
    finally:
        over.set()
        thread.join()
        work()
