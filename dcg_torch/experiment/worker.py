"""A process that runs trials: all that it needs for one, made once and kept for the next."""

from __future__ import annotations

import copy
import functools
import json
import math
import os
import threading
import time
from collections.abc import Callable
from dataclasses import asdict
from pathlib import Path

import numpy as np
import torch

from dcg_torch.agent.asking import AskingPolicy
from dcg_torch.agent.command import Look
from dcg_torch.agent.explore import Explorer, LookBefore, Worth
from dcg_torch.agent.robot import SimulationRobot
from dcg_torch.checkpoint import save
from dcg_torch.experiment.plan import trial_commands, trial_generators
from dcg_torch.experiment.runner import MODEL, animation_of, lexicon_of, part_of
from dcg_torch.experiment.trial import run_trial
from dcg_torch.grounding.features import Group
from dcg_torch.language import default_parser
from dcg_torch.learning.beliefs import Prior
from dcg_torch.learning.lexicon import save_lexicon
from dcg_torch.learning.word_posterior import Assumptions, WordPosterior
from dcg_torch.lessons import TrainingFileError, initial_training
from dcg_torch.lessons.generated import generated_lessons
from dcg_torch.model import GroundingModel, Variant
from dcg_torch.settings import Asking, ModelSettings, RobotKind, Settings, SettingsError, SimulatorSettings
from dcg_torch.simulator import FakeRobot, Recogniser, SimulatedRobot, SimulatorError
from dcg_torch.speaker import Command, SpeakerError
from dcg_torch.watch.recording import Recorder
from dcg_torch.watch.wording import meant
from dcg_torch.world.files import WorldFileError
from dcg_torch.world.names import MORE_TYPES

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
    )


_initial_training = functools.cache(initial_training)


@functools.cache
def _robot(settings: str, types: int) -> SimulationRobot:
    """This process's robot: made once, since a world's outcome does not depend on the worlds before it."""
    chosen = SimulatorSettings(**json.loads(settings))
    recogniser = Recogniser(
        min_pixels=chosen.min_pixels, wrong_class=chosen.wrong_class, missed=chosen.missed, types=MORE_TYPES[:types]
    )
    if chosen.kind == RobotKind.fake:
        return FakeRobot(recogniser.labels if chosen.wrong_class or chosen.missed else None)
    return SimulatedRobot(recogniser=recogniser, rng=np.random.default_rng(0), gui=chosen.gui)


def run_one(settings: Settings, trial: int, directory: Path) -> GroundingModel:
    """Run one trial, journalling its commands in `directory`; the model as it is at the end."""
    torch.set_num_threads(1)
    model = make_model(settings.model)
    robot = _robot(json.dumps(asdict(settings.simulator)), settings.types)
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
        explorer=_explorer(settings, model),
        asking=_asking(settings),
        watch=_watcher(robot, recorder),
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

        animate(recorder.commands, animation_of(directory, trial))
    if settings.model.posterior:
        save_lexicon(model.lexicon(), lexicon_of(directory, trial))
    if trial == settings.trials - 1:
        save(model, directory / MODEL)
    return model


def _watcher(robot: SimulationRobot, recorder: Recorder | None) -> Callable[[Command, Look], None] | None:
    """Who is told of every look: the recorder, and the window."""
    if recorder is None and not (isinstance(robot, SimulatedRobot) and robot.client.gui):
        return None

    def watch(command: Command, look: Look) -> None:
        if recorder:
            recorder.look(command, look)
        if isinstance(robot, SimulatedRobot):
            robot.say(f"{command.text}: {meant(look.solution)}")

    return watch


@functools.cache
def _made(chosen: Variant, lessons: int, assumed: Assumptions | None) -> GroundingModel:
    """A model after the initial training and so many generated lessons on relations: the same for every trial.

    Args:
        assumed: of a learner that keeps a posterior; None: the paper's learner.
    """
    training = _initial_training()
    learner = None if assumed is None else WordPosterior.start(training, assumed)
    model = GroundingModel.trained(training, chosen, learner)
    if lessons and Group.RELATION in chosen.groups:
        model.teach(generated_lessons(default_parser().parse, lessons), relations_only=True, rounds=2)
    return model


def make_model(settings: ModelSettings) -> GroundingModel:
    """The model of a configuration, before its first command.

    Raises:
        SettingsError: a feature group that does not exist.
    """
    chosen = settings.open_world
    prior = Prior(synonym=chosen.synonym, unmet=chosen.unmet, slip=chosen.slip)
    assumed = Assumptions(nouns=prior, hidden=chosen.hidden, strength=chosen.strength)
    return copy.deepcopy(_made(variant(settings), settings.lessons, assumed if settings.posterior else None))


def _explorer(settings: Settings, model: GroundingModel) -> Callable[[], Explorer] | None:
    """Looking before deciding, for the model that can tell what it is unsure of."""
    chosen = settings.model.open_world
    if not settings.model.posterior:
        return None
    sure = chosen.ask_below if settings.asking is Asking.when_unsure else None
    worth = Worth(meanings=chosen.look_above, sure=sure, views=chosen.views)
    return functools.partial(LookBefore, model.beliefs_of, worth)


def _asking(settings: Settings) -> AskingPolicy | None:
    if settings.asking is Asking.never:
        return None
    return AskingPolicy(below=settings.model.open_world.ask_below)


@functools.cache
def end_with(parent: int) -> None:
    """End this process soon after its parent, even one that was killed: the run may be gone on with by then."""

    def wait() -> None:
        while os.getppid() == parent:
            time.sleep(0.2)
        os._exit(1)

    threading.Thread(target=wait, daemon=True).start()
