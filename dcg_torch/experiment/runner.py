"""An experiment: trials in parallel, journalled so that an interrupted run can go on.

What a trial needs (torch, the parser, PyBullet) is imported by `worker`, in the processes that run trials; here it
would only delay their start.

Every trial writes a line to `trials/NNNN.jsonl` as each of its commands ends, and is independent of all others:
its random numbers come from (seed, trial) alone. `iterations.jsonl` and `timings.jsonl` are these lines in the
order of the trials, so the same seed gives the same bytes for any number of workers.
"""

from __future__ import annotations

import functools
import os
import time
from collections.abc import Callable, Sequence
from dataclasses import replace
from importlib.util import find_spec
from pathlib import Path

from dcg_torch.experiment.backends import require_backend, work_off_joblib
from dcg_torch.experiment.folder import (
    RunFolderError,
    check_owner,
    mark_as_own,
    open_trials,
    part_of,
    remove_parts,
)
from dcg_torch.experiment.journal import Journal
from dcg_torch.experiment.lessons_note import lessons_note
from dcg_torch.experiment.plan import trial_commands
from dcg_torch.experiment.pool import TICK, cores, may_start_processes, work_off, works_alone
from dcg_torch.settings import Backend, ModelSettings, RobotKind, Settings, SettingsError
from dcg_torch.storage.records import Iteration
from dcg_torch.storage.untrusted_files import at_home

SEEN_WITHIN = 90.0
"""Seconds after which a file that another machine has written should be seen here; NFS remembers for 60."""
Progress = Callable[[Sequence[Iteration]], None]


def check_feasible(settings: Settings) -> None:
    """See that there is what the settings ask for: worlds, commands, training, feature groups, PyBullet, a display.

    Raises:
        UserError: something is not there.
    """
    trial_commands(settings, 0)
    require_backend(settings.backend)
    if settings.simulator.kind is RobotKind.pybullet:
        require_pybullet("simulator=pybullet", "take simulator=fake")
    if settings.screenshots:
        require_pybullet("screenshots=true", "leave them out with screenshots=false")
    if settings.simulator.gui:
        from dcg_torch.simulator.client import require_display

        require_display()
    if settings.training is not None:
        from dcg_torch.lessons import read_training

        read_training(settings.training)
    if not set(settings.model.groups) <= set(ModelSettings().groups):  # the default's exist: no need to look
        from dcg_torch.experiment.factory import variant

        variant(settings.model)


def require_pybullet(asked: str, instead: str) -> None:
    """See that PyBullet is there.

    Raises:
        SettingsError: it is not.
    """
    if find_spec("pybullet") is None:
        raise SettingsError(
            f"{asked} needs PyBullet, which is not installed; pip install pybullet==3.2.7 (Python 3.11 has a "
            f"ready-made one), or {instead}"
        )


def run(settings: Settings, directory: Path, progress: Progress, say: Callable[[str], None] = print) -> int:
    """Run the trials that are not finished yet, each over the cores; how many these were.

    Args:
        settings: checked ones.
        directory: the run folder, claimed by the caller; with the same settings as before it is gone on with.
        progress: called now and then with the rows that are new, in order; first with those of an earlier run.
        say: told, in one line each, of damage that was found, and of what takes long before the first command.

    Raises:
        RunFolderError: the folder holds another experiment.
        UserError: there is not what the settings ask for; found before anything runs.
        WorkerKilledError: a worker was killed from outside.
        OSError: the disk is full, or otherwise of no use.
    """
    check_owner(settings, directory)
    check_feasible(settings)
    mark_as_own(settings, directory)
    trials, notes = open_trials(settings, directory)
    for note in notes:
        say(note)
    teaches = lessons_note(settings.model, settings.training)
    if trials and teaches is not None:
        say(teaches)
    remove_parts(directory, trials)
    journal = Journal(directory, settings.trials, settings.iterations)
    progress(journal.advance())
    _run_trials(settings, directory, trials, lambda: progress(journal.advance()))
    progress(journal.advance())
    return len(trials)


def _run_trials(settings: Settings, directory: Path, trials: Sequence[int], tick: Callable[[], None]) -> None:
    """Run trials where the settings say."""
    workers = min(settings.workers or cores(), len(trials))
    alone = len(trials) < 2 or works_alone(settings)
    if alone or not may_start_processes() or (settings.backend is Backend.fork and workers < 2):
        _run_here(settings, directory, trials, tick)
    elif settings.backend is Backend.fork:
        for _ in work_off(functools.partial(_run_trial, settings, directory), trials, workers):
            tick()
    else:
        work = functools.partial(_run_far_trial, _far(settings), directory.absolute())
        work_off_joblib(work, trials, settings.workers, settings.backend, tick)
        _await_lines(directory, trials)


def _await_lines(directory: Path, trials: Sequence[int]) -> None:
    """Wait until the files that other machines have written are seen here, too: a network may take its time.

    Raises:
        RunFolderError: they do not come.
    """
    until = time.monotonic() + SEEN_WITHIN
    for part in (part_of(directory, trial) for trial in trials):
        while part.name not in os.listdir(part.parent):
            if time.monotonic() > until:
                raise RunFolderError(
                    f"{part}: this trial has run, but its lines are not here; give a hydra.run.dir that all nodes see "
                    "under the same path"
                )
            time.sleep(TICK)


def _far(settings: Settings) -> Settings:
    """The settings for a process that has another working folder."""
    named = settings.worlds in ("committed", "generated")
    worlds = settings.worlds if named else str(at_home(settings.worlds).absolute())
    training = settings.training and str(at_home(settings.training).absolute())
    return replace(settings, worlds=worlds, training=training)


def _run_here(settings: Settings, directory: Path, trials: Sequence[int], tick: Callable[[], None]) -> None:
    """Run trials in this process, one after another."""
    import dcg_torch.experiment.preloads  # noqa: F401

    last = time.monotonic()

    def now_and_then() -> None:
        nonlocal last
        if time.monotonic() > last + TICK:
            last = time.monotonic()
            tick()

    for trial in trials:
        _run_trial(settings, directory, trial, now_and_then)


def _run_trial(settings: Settings, directory: Path, trial: int, tick: Callable[[], None] = lambda: None) -> None:
    """Run a trial, mostly in another process; nothing but its files comes of it."""
    from dcg_torch.experiment.worker import run_one

    run_one(settings, trial, directory, tick)


def _run_far_trial(settings: Settings, directory: Path, trial: int) -> None:
    """Run a trial, perhaps on another machine, perhaps a second time while a lost one still runs it."""
    from dcg_torch.experiment.worker import run_one

    run_one(settings, trial, directory, at_once=True)
