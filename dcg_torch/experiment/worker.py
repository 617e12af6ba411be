"""A process that runs trials, one after another, each into files of its own."""

from __future__ import annotations

import json
import math
from collections.abc import Callable
from pathlib import Path
from typing import Any, Protocol, runtime_checkable

import torch

from dcg_torch.agent.command import Look
from dcg_torch.agent.robot import SimulationRobot
from dcg_torch.experiment.factory import make_asking, make_explorer, make_model
from dcg_torch.experiment.folder import MODEL, ORIGIN, animation_of, lexicon_of, part_of
from dcg_torch.experiment.plan import trial_commands, trial_generators
from dcg_torch.experiment.reading import parse_once
from dcg_torch.experiment.recording.recorder import Recorder
from dcg_torch.experiment.recording.wording import meant
from dcg_torch.experiment.robots import make_robot
from dcg_torch.experiment.trial import run_trial
from dcg_torch.learning.lexicon import save_lexicon
from dcg_torch.model import GroundingModel
from dcg_torch.model.checkpoint import save
from dcg_torch.settings import LearnerKind, Settings
from dcg_torch.storage.atomic_files import write_whole, write_whole_folder
from dcg_torch.types import Pose
from dcg_torch.world.speaker import Command


def run_one(
    settings: Settings, trial: int, directory: Path, tick: Callable[[], None] = lambda: None, *, at_once: bool = False
) -> GroundingModel:
    """Run one trial, journalling its commands in `directory`; the model as it is at the end.

    Args:
        tick: called as each command ends.
        at_once: the lines appear when all are there, so that several processes may run the same trial.
    """
    torch.set_num_threads(1)
    model = make_model(settings.model, settings.names, settings.training)
    robot = make_robot(settings.simulator, settings.types)
    recorder = Recorder(robot) if trial in settings.animate else None
    _observe(robot, recorder)
    commands = trial_commands(settings, trial)
    rows = run_trial(
        trial,
        commands,
        model,
        parse_once,
        robot,
        trial_generators(settings.seed, trial)[2],
        spin_step=math.radians(settings.simulator.spin_step),
        explorer=make_explorer(settings, model),
        asking=make_asking(settings),
        watch=_watcher(robot, recorder),
    )

    def journal(part: Path) -> None:
        with part.open("w", encoding="utf-8") as file:
            for command, (iteration, timing) in zip(commands, rows, strict=True):
                file.write(f"{iteration.model_dump_json()}\t{timing.model_dump_json()}\n")
                file.flush()
                if recorder:
                    recorder.end(command, iteration)
                tick()

    if at_once:
        write_whole(part_of(directory, trial), journal)
    else:
        journal(part_of(directory, trial))
    _save_outcome(settings, model, recorder, trial, directory)
    return model


def _save_outcome(
    settings: Settings, model: GroundingModel, recorder: Recorder | None, trial: int, directory: Path
) -> None:
    """What a trial leaves beside its lines: an animation, what words mean to its robot, and the last one its model."""
    if recorder:
        from dcg_torch.experiment.recording.animation import animate  # here: it takes a third of a second to import

        write_whole(animation_of(directory, trial), lambda path: animate(recorder.commands, path))
    if settings.model.learner is LearnerKind.word_posterior:
        entries = model.lexicon()
        write_whole(lexicon_of(directory, trial), lambda path: save_lexicon(entries, path))
    if trial == settings.trials - 1:

        def fill(folder: Path) -> None:
            save(model, folder)
            (folder / ORIGIN).write_text(json.dumps({"trial": trial}) + "\n", encoding="utf-8")

        write_whole_folder(directory / MODEL, fill)


@runtime_checkable
class _Moving(Protocol):
    """A robot that takes its time, and may have a window to speak in; the simulated one, which is not imported here."""

    on_tick: Callable[[Pose], None] | None
    client: Any

    def say(self, text: str) -> None: ...


def _observe(robot: SimulationRobot, recorder: Recorder | None) -> None:
    """Let the recorder follow a robot that moves, or let go of the recorder before."""
    if isinstance(robot, _Moving):
        robot.on_tick = recorder.tick if recorder else None


def _watcher(robot: SimulationRobot, recorder: Recorder | None) -> Callable[[Command, Look], None] | None:
    """Who is told of every look: the recorder, and the window."""
    window = robot if isinstance(robot, _Moving) and robot.client.gui else None
    if recorder is None and window is None:
        return None

    def watch(command: Command, look: Look) -> None:
        if recorder:
            recorder.look(command, look)
        if window is not None:
            window.say(f"{command.text}: {meant(look.solution)}")

    return watch
