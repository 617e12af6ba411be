"""The settings of an experiment: plain dataclasses with their defaults, checked once they are complete."""

from __future__ import annotations

import enum
from dataclasses import dataclass, field


class SettingsError(ValueError):
    """A setting that makes no sense; the message is one line: which, what is wrong, how to mend it."""


class Speaker(enum.StrEnum):
    canonical = "canonical"
    written = "written"
    human = "human"


class Asking(enum.StrEnum):
    never = "never"
    when_unsure = "when_unsure"


class RobotKind(enum.StrEnum):
    pybullet = "pybullet"
    fake = "fake"


class Order(enum.StrEnum):
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


def check(settings: Settings) -> None:
    """See that the values make sense together.

    Raises:
        SettingsError: one of them does not.
    """
    positive = {"trials": settings.trials, "iterations": settings.iterations, "model.beam": settings.model.beam}
    positive |= {"worlds_per_trial": settings.worlds_per_trial, "simulator.min_pixels": settings.simulator.min_pixels}
    for name, value in positive.items():
        if value < 1:
            raise SettingsError(f"{name}={value}: give a number of at least 1")
    if settings.seed < 0 or settings.workers < 0:
        name = "seed" if settings.seed < 0 else "workers"
        raise SettingsError(f"{name}={getattr(settings, name)}: give a number of at least 0")
    shares = {"color_rate": settings.color_rate}
    shares |= {f"simulator.{name}": getattr(settings.simulator, name) for name in ("wrong_class", "missed")}
    for name, value in shares.items():
        if not 0.0 <= value <= 1.0:
            raise SettingsError(f"{name}={value}: a share lies between 0 and 1")
    if not settings.model.l2 > 0.0:
        raise SettingsError(f"model.l2={settings.model.l2}: it must be positive, or the optimum is not unique")
    if not 0.0 < abs(settings.simulator.spin_step) <= 57.0:
        raise SettingsError(
            f"simulator.spin_step={settings.simulator.spin_step}: give degrees up to 57, the width of the view"
        )
    wrong = [trial for trial in settings.animate if not 0 <= trial < settings.trials]
    if wrong:
        raise SettingsError(f"animate={settings.animate}: trials go from 0 to {settings.trials - 1}")
    if settings.asking is Asking.when_unsure:
        raise SettingsError("asking=when_unsure: the paper's models ask nothing; take asking=never")
