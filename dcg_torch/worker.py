"""A process that runs trials: all that it needs for one, made once and kept for the next."""

from __future__ import annotations

import functools
import json
import math
import os
import threading
import time
from dataclasses import asdict
from pathlib import Path

import numpy as np
import torch

from dcg_torch.experiment import MODEL, animation_of, part_of
from dcg_torch.features import Group
from dcg_torch.language import default_parser
from dcg_torch.model import GroundingModel, Variant
from dcg_torch.settings import ModelSettings, RobotKind, Settings, SettingsError, SimulatorSettings
from dcg_torch.simulator import Recogniser, SimulatedRobot, SimulatorError
from dcg_torch.simulator.bodies import TYPES
from dcg_torch.speaker import SpeakerError
from dcg_torch.store import save
from dcg_torch.training import TrainingFileError, initial_training
from dcg_torch.trial.loop import run_trial
from dcg_torch.trial.plan import trial_commands, trial_generators
from dcg_torch.trial.robot import FakeRobot, Robot
from dcg_torch.watch.recording import Recorder
from dcg_torch.world.files import WorldFileError

TRIAL_ERRORS = (SettingsError, WorldFileError, SpeakerError, TrainingFileError, SimulatorError)
"""What a trial raises when the user's input is wrong: each has a message of one line."""


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
        groups=groups,
        unknown=settings.unknown,
        hypothetical=settings.hypothetical,
        learns=settings.learns,
        ternary=settings.ternary,
        l2=settings.l2,
        beam=settings.beam,
        synonyms=settings.synonyms,
    )


_initial_training = functools.cache(initial_training)


@functools.cache
def _robot(settings: str) -> Robot:
    """This process's robot: made once, since a world's outcome does not depend on the worlds before it."""
    chosen = SimulatorSettings(**json.loads(settings))
    if chosen.kind == RobotKind.fake:
        return FakeRobot()
    recogniser = Recogniser(
        min_pixels=chosen.min_pixels, wrong_class=chosen.wrong_class, missed=chosen.missed, types=TYPES
    )
    return SimulatedRobot(recogniser=recogniser, rng=np.random.default_rng(0), gui=chosen.gui)


def run_one(settings: Settings, trial: int, directory: Path) -> GroundingModel:
    """Run one trial, journalling its commands in `directory`; the model as it is at the end."""
    torch.set_num_threads(1)
    model = GroundingModel.trained(_initial_training(), variant(settings.model))
    robot = _robot(json.dumps(asdict(settings.simulator)))
    recorder = Recorder(robot) if trial in settings.animate else None
    if isinstance(robot, SimulatedRobot):
        robot.on_tick = recorder.tick if recorder else None
    commands = trial_commands(settings, trial)
    rows = run_trial(
        trial,
        commands,
        model,
        default_parser().parse,
        robot,
        trial_generators(settings.seed, trial)[2],
        spin_step=math.radians(settings.simulator.spin_step),
        watch=recorder.look if recorder else None,
    )
    part = part_of(directory, trial)
    with part.open("w", encoding="utf-8") as file:
        for command, (iteration, timing) in zip(commands, rows, strict=True):
            file.write(f"{iteration.model_dump_json()}\t{timing.model_dump_json()}\n")
            file.flush()
            if recorder:
                recorder.end(command, iteration)
    if recorder:
        from dcg_torch.watch.animation import animate  # here, because it costs a third of a second to import

        animate(recorder.episodes, animation_of(directory, trial))
    if trial == settings.trials - 1:
        save(model, directory / MODEL)
    return model


@functools.cache
def end_with(parent: int) -> None:
    """End this process soon after its parent, even one that was killed: the run may be gone on with by then."""

    def wait() -> None:
        while os.getppid() == parent:
            time.sleep(0.2)
        os._exit(1)

    threading.Thread(target=wait, daemon=True).start()
