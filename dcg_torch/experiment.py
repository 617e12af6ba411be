"""An experiment: trials in parallel, journalled so that an interrupted run can go on.

Every trial writes a line to `trials/NNNN.jsonl` as each of its commands ends, and is independent of all others:
its random numbers come from (seed, trial) alone. `iterations.jsonl` and `timings.jsonl` are these lines in the
order of the trials, so the same seed gives the same bytes for any number of workers.
"""

from __future__ import annotations

import contextlib
import functools
import json
import math
import os
import threading
from collections.abc import Callable, Iterator, Sequence
from dataclasses import asdict
from pathlib import Path

import numpy as np
import torch
from joblib import Parallel, delayed

from dcg_torch.features import Group
from dcg_torch.language import default_parser
from dcg_torch.model import GroundingModel, Variant
from dcg_torch.records import Iteration, Timing
from dcg_torch.settings import ModelSettings, Order, RobotKind, Settings, SettingsError, SimulatorSettings
from dcg_torch.resources import resource
from dcg_torch.speaker import Command, SpeakerError, draw_trial, make_speaker
from dcg_torch.store import save
from dcg_torch.simulator import Recogniser, SimulatedRobot, SimulatorError
from dcg_torch.training import TrainingFileError, initial_training
from dcg_torch.trial.loop import run_trial
from dcg_torch.trial.robot import FakeRobot, Robot
from dcg_torch.world.files import World, WorldFileError, load_worlds
from dcg_torch.world.generator import generate_world

ITERATIONS, TIMINGS, MODEL = "iterations.jsonl", "timings.jsonl", "model"
_PARTS, _FINGERPRINT = "trials", "settings.json"
# What may differ between a run and its continuation: it changes no byte of a trial.
_FREE = ("name", "trials", "workers", "animate", "figures", "tensorboard", "screenshots")


class RunFolderError(ValueError):
    """A run folder that cannot be gone on with; the message is one line."""


USER_ERRORS = (SettingsError, RunFolderError, WorldFileError, SpeakerError, TrainingFileError, SimulatorError)
"""What is raised when the user's input is wrong: each has a message of one line."""


def variant(settings: ModelSettings) -> Variant:
    """The model variant of a configuration.

    Raises:
        SettingsError: a feature group that does not exist.
    """
    try:
        groups = frozenset(Group(name) for name in settings.groups)
    except ValueError:
        raise SettingsError(f"model.groups={settings.groups}: choose from {', '.join(Group)}") from None
    return Variant(
        groups, settings.unknown, settings.hypothetical, settings.learns, settings.ternary, settings.l2, settings.beam
    )


def trial_worlds(settings: Settings, rng: np.random.Generator) -> list[World]:
    """The worlds that a trial's commands are drawn from.

    Raises:
        WorldFileError: a world file is missing or not valid.
    """
    if settings.worlds == "generated":
        return [generate_world(rng, f"generated_{k:02d}") for k in range(settings.worlds_per_trial)]
    return _worlds_of(resource("worlds") if settings.worlds == "committed" else Path(settings.worlds))


_worlds_of = functools.cache(load_worlds)
_initial_training = functools.cache(initial_training)


def trial_commands(settings: Settings, trial: int) -> list[Command]:
    """The commands of a trial, from (seed, trial) alone.

    Raises:
        WorldFileError: a world file is missing or not valid.
        SpeakerError: the speaker has too few commands for these worlds.
    """
    worlds_rng, commands_rng, _ = _generators(settings.seed, trial)
    worlds = trial_worlds(settings, worlds_rng)
    speaker = make_speaker(settings.speaker, settings.color_rate)
    if settings.order is Order.file:
        found = [c for world in worlds for c in speaker.commands(world, commands_rng)]
        if len(found) < settings.iterations:
            raise SettingsError(f"iterations={settings.iterations}, but the files have {len(found)} commands")
        return found[: settings.iterations]
    return draw_trial(worlds, speaker, settings.iterations, commands_rng)


def _generators(seed: int, trial: int) -> list[np.random.Generator]:
    """A trial's generators: of worlds, of commands, of the recogniser's mistakes."""
    return [np.random.default_rng(s) for s in np.random.SeedSequence(seed, spawn_key=(trial,)).spawn(3)]


@functools.cache
def _robot(settings: str) -> Robot:
    """This process's robot: made once, since a world's outcome does not depend on the worlds before it."""
    chosen = SimulatorSettings(**json.loads(settings))
    if chosen.kind == RobotKind.fake:
        return FakeRobot()
    recogniser = Recogniser(min_pixels=chosen.min_pixels, wrong_class=chosen.wrong_class, missed=chosen.missed)
    return SimulatedRobot(recogniser=recogniser, rng=np.random.default_rng(0), gui=chosen.gui)


def run_one(settings: Settings, trial: int, directory: Path) -> GroundingModel:
    """Run one trial, journalling its commands in `directory`; the model as it is at the end."""
    torch.set_num_threads(1)
    model = GroundingModel.trained(_initial_training(), variant(settings.model))
    rows = run_trial(
        trial,
        trial_commands(settings, trial),
        model,
        default_parser().parse,
        _robot(json.dumps(asdict(settings.simulator))),
        _generators(settings.seed, trial)[2],
        spin_step=math.radians(settings.simulator.spin_step),
    )
    part = _part(directory, trial)
    with part.open("w", encoding="utf-8") as file:
        for iteration, timing in rows:
            file.write(f"{iteration.model_dump_json()}\t{timing.model_dump_json()}\n")
            file.flush()
    if trial == settings.trials - 1:
        save(model, directory / MODEL)
    return model


def _part(directory: Path, trial: int) -> Path:
    return directory / _PARTS / f"{trial:04d}.jsonl"


def _whole_lines(path: Path) -> list[tuple[str, str]]:
    """The (iteration, timing) lines of a part; a line that was cut off does not count."""
    if not path.exists():
        return []
    text = path.read_text(encoding="utf-8")
    lines = text[: text.rfind("\n") + 1].splitlines()
    return [(left, right) for left, _, right in (line.partition("\t") for line in lines) if right]


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
                lines = _whole_lines(_part(self._directory, trial))
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
    rows = [Iteration.model_validate_json(x) for x in (directory / ITERATIONS).read_text("utf-8").splitlines()]
    timings = [Timing.model_validate_json(x) for x in (directory / TIMINGS).read_text("utf-8").splitlines()]
    return rows, timings


def _fingerprint(settings: Settings) -> str:
    kept = {k: v for k, v in asdict(settings).items() if k not in _FREE}
    return json.dumps(kept, indent=2, sort_keys=True) + "\n"


def prepare(settings: Settings, directory: Path) -> list[int]:
    """Make the run folder, or see that it belongs to these settings; the trials that are yet to run.

    Raises:
        RunFolderError: the folder holds another experiment.
    """
    (directory / _PARTS).mkdir(parents=True, exist_ok=True)
    mark = directory / _FINGERPRINT
    wanted = _fingerprint(settings)
    if mark.exists() and mark.read_text(encoding="utf-8") != wanted:
        raise RunFolderError(
            f"{directory} holds a run with other settings (see {mark.name} there); give hydra.run.dir another folder"
        )
    part = mark.with_suffix(".part")
    part.write_text(wanted, encoding="utf-8")
    os.replace(part, mark)
    open_trials = [t for t in range(settings.trials) if len(_whole_lines(_part(directory, t))) < settings.iterations]
    last = settings.trials - 1
    if not (directory / MODEL).is_dir() and last not in open_trials:
        open_trials.append(last)
    for trial in open_trials:
        _part(directory, trial).unlink(missing_ok=True)
    return open_trials


def run(settings: Settings, directory: Path, progress: Callable[[Sequence[Iteration]], None]) -> None:
    """Run the trials that are not finished yet, each over the cores.

    Args:
        settings: checked ones.
        directory: the run folder; a rerun with the same settings goes on with what is there.
        progress: called now and then with the rows that are new, in order; first with those of an earlier run.

    Raises:
        RunFolderError: the folder holds another experiment.
        WorldFileError, SpeakerError: there is not what the settings ask for; found before anything runs.
    """
    trial_commands(settings, 0)
    variant(settings.model)
    open_trials = prepare(settings, directory)
    journal = Journal(directory, settings.trials, settings.iterations)
    progress(journal.advance())
    workers = min(settings.workers or os.cpu_count() or 1, max(1, len(open_trials)))
    if settings.simulator.gui:
        workers = 1  # one window to look at
    with _ticking(lambda: progress(journal.advance())):
        jobs = (delayed(_run_silently)(settings, trial, directory) for trial in open_trials)
        for _ in Parallel(n_jobs=workers, return_as="generator_unordered", batch_size=1)(jobs):
            pass


def _run_silently(settings: Settings, trial: int, directory: Path) -> None:
    """`run_one` for another process: nothing but the journal comes back."""
    run_one(settings, trial, directory)


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
