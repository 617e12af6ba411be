"""The settings of an experiment: plain dataclasses with their defaults, checked once they are complete."""

from __future__ import annotations

import enum
from dataclasses import dataclass, field


class SettingsError(ValueError):
    """A setting that makes no sense; the message is one line: which, what is wrong, how to mend it."""


class Speaker(enum.StrEnum):
    """Who gives the commands; see `dcg_torch.speaker`."""

    canonical = "canonical"
    written = "written"
    human = "human"


class Asking(enum.StrEnum):
    """When the robot asks back."""

    never = "never"
    when_unsure = "when_unsure"


class RobotKind(enum.StrEnum):
    """What carries the commands out: a robot in physics, or one of pure geometry."""

    pybullet = "pybullet"
    fake = "fake"


class Order(enum.StrEnum):
    """How a trial's commands are taken from those of its worlds."""

    drawn = "drawn"
    file = "file"


@dataclass
class ModelSettings:
    """See `model.Variant`."""

    name: str = "dcg_upup_away_color"
    groups: list[str] = field(default_factory=lambda: ["dcg", "unknown", "hypothetical", "color"])
    unknown: bool = True
    hypothetical: bool = True
    learns: bool = True
    ternary: bool = True
    l2: float = 0.05
    beam: int = 8
    synonyms: float | None = None


@dataclass
class SimulatorSettings:
    """The robot and its camera.

    Attributes:
        kind: pybullet, or fake for a robot of pure geometry.
        gui: open PyBullet's window.
        spin_step: degrees between two looks while it turns.
        min_pixels: of an object in the picture, for it to be recognised.
        wrong_class: share of objects that the recogniser takes for another type.
        missed: share of objects that it never recognises.
    """

    kind: RobotKind = RobotKind.pybullet
    gui: bool = False
    spin_step: float = 20.0
    min_pixels: int = 4
    wrong_class: float = 0.0
    missed: float = 0.0


@dataclass
class Settings:
    """One experiment.

    Attributes:
        name: of the run folder and in the tables.
        experiment: the overlay it was composed with, for the record.
        worlds: committed, generated (ten fresh ones a trial), or a directory of world files.
        order: commands drawn at random, or as they stand in the files.
        color_rate: share of generated commands that state the colour.
        workers: processes; 0 takes one per core.
        animate: trials to save as animations.
        figures: draw the figures.
        tensorboard: write TensorBoard event files.
        screenshots: save a picture of every pair of world and highlighted object.
    """

    name: str = "run"
    model: ModelSettings = field(default_factory=ModelSettings)
    simulator: SimulatorSettings = field(default_factory=SimulatorSettings)
    seed: int = 0
    trials: int = 30
    iterations: int = 10
    worlds: str = "committed"
    worlds_per_trial: int = 10
    order: Order = Order.drawn
    speaker: Speaker = Speaker.written
    color_rate: float = 1.0
    asking: Asking = Asking.never
    workers: int = 0
    animate: list[int] = field(default_factory=list)
    figures: bool = True
    tensorboard: bool = True
    screenshots: bool = False


@dataclass
class EvaluateSettings:
    """Training on one episode file and grounding another.

    Attributes:
        train, test: the files (JSON lines).
        known_types: leave the training rows about other types out; null: keep all.
        learn: learn after each test command, in file order, without seeing its target.
        explain: id of a test episode whose grounding is to be explained.
        rounds: of expectation-maximisation over the landmarks.
    """

    train: str = "???"  # Hydra's mark of what must be given
    test: str = "???"
    model: ModelSettings = field(default_factory=ModelSettings)
    known_types: list[str] | None = None
    learn: bool = False
    explain: str | None = None
    rounds: int = 4


def check(settings: Settings) -> None:
    """See that the values make sense together.

    Raises:
        SettingsError: one of them does not.
    """
    positive = {"trials": settings.trials, "iterations": settings.iterations, "model.beam": settings.model.beam}
    positive |= {"worlds_per_trial": settings.worlds_per_trial, "simulator.min_pixels": settings.simulator.min_pixels}
    for name, number in positive.items():
        if number < 1:
            raise SettingsError(f"{name}={number}: give a number of at least 1")
    if settings.seed < 0 or settings.workers < 0:
        name = "seed" if settings.seed < 0 else "workers"
        raise SettingsError(f"{name}={getattr(settings, name)}: give a number of at least 0")
    shares = {"color_rate": settings.color_rate}
    shares |= {f"simulator.{name}": getattr(settings.simulator, name) for name in ("wrong_class", "missed")}
    for name, share in shares.items():
        if not 0.0 <= share <= 1.0:
            raise SettingsError(f"{name}={share}: a share lies between 0 and 1")
    if not settings.model.l2 > 0.0:
        raise SettingsError(f"model.l2={settings.model.l2}: it must be positive, or the optimum is not unique")
    if not 0.0 < abs(settings.simulator.spin_step) <= 57.0:
        raise SettingsError(
            f"simulator.spin_step={settings.simulator.spin_step}: give degrees up to 57, the width of the view"
        )
    wrong = [trial for trial in settings.animate if not 0 <= trial < settings.trials]
    if wrong:
        raise SettingsError(f"animate={settings.animate}: trials go from 0 to {settings.trials - 1}")
    for name, asked in (("simulator.gui", settings.simulator.gui), ("animate", settings.animate)):
        if asked and settings.simulator.kind is RobotKind.fake:
            raise SettingsError(f"{name}={asked}: the fake robot has nothing to show; take simulator=pybullet")
    if settings.asking is Asking.when_unsure:
        raise SettingsError("asking=when_unsure: the paper's models ask nothing; take asking=never")
