"""The settings of an experiment: plain dataclasses with their defaults, checked once they are complete."""

from __future__ import annotations

import enum
import math
from dataclasses import dataclass, field

from dcg_torch.geometry import FIELD_OF_VIEW
from dcg_torch.world.generator import TYPES
from dcg_torch.world.names import MORE_COLORS, MORE_TYPES


class SettingsError(ValueError):
    """A setting that makes no sense; the message is one line: which, what is wrong, how to mend it."""


class Speaker(enum.StrEnum):
    """Who gives the commands; see `dcg_torch.speaker`."""

    canonical = "canonical"
    written = "written"
    relational = "relational"
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
class OpenWorldSettings:
    """What `model=open_world` assumes, and when it looks and asks.

    Attributes:
        synonym: factor for a word that names a type which has a name already.
        unmet: weight of all types that were never met, where each met one has weight 1.
        slip: share of commands whose noun is not the one for the type that the recogniser reports.
        hidden: objects of a type and colour that are expected though the robot has looked all round.
        strength: of the soft examples; more is closer to the posterior, and slower.
        look_above: look on while types out of view have more than this share of the belief about the word.
        views: places that the robot drives to for a look behind things, at the most.
        ask_below: with asking=when_unsure, ask if the best object is less probable than this.
    """

    synonym: float = 0.05
    unmet: float = 1.0
    slip: float = 0.02
    hidden: float = 0.01
    strength: float = 5.0
    look_above: float = 0.03
    views: int = 2
    ask_below: float = 0.75


@dataclass
class ModelSettings:
    """See `model.Variant`; `posterior` makes it an `open_world.OpenWorldModel`, which `open_world` is for.

    `lessons` is the number of generated lessons on relations (`training.generated`) that it is taught before a trial,
    or before the episodes of a corpus.
    """

    name: str = "dcg_upup_away_color"
    groups: list[str] = field(default_factory=lambda: ["dcg", "unknown", "hypothetical", "color"])
    unknown: bool = True
    hypothetical: bool = True
    learns: bool = True
    ternary: bool = True
    l2: float = 0.05
    beam: int = 8
    synonyms: float | None = None
    lessons: int = 0
    posterior: bool = False
    open_world: OpenWorldSettings = field(default_factory=OpenWorldSettings)


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
        types: number of types in generated worlds, the paper's eight first; beyond these only with the fake robot.
        colors: number of colours in generated worlds, the paper's three first.
        object_rate: probability of each type in each colour in a generated world.
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
    types: int = 8
    colors: int = 3
    object_rate: float = 0.15
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
        known_colors: leave the training rows about objects of other colours out; null: keep all.
        learn: learn after each test command, in file order, without seeing its target.
        explain: id of a test episode whose grounding is to be explained.
        rounds: of expectation-maximisation over the landmarks.
        folds: instead of `test`, cross-validate `train` in so many parts; episodes of one `group` stay together.
        baseline: also fit scikit-learn's logistic regression, on words x object features, to the same episodes.
        save: write the model as it is at the end into `model/` of the run folder; not with folds.
    """

    train: str = "???"  # Hydra's mark of what must be given
    test: str | None = None
    model: ModelSettings = field(default_factory=ModelSettings)
    known_types: list[str] | None = None
    known_colors: list[str] | None = None
    learn: bool = False
    explain: str | None = None
    rounds: int = 4
    folds: int = 0
    baseline: bool = False
    save: bool = True


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
    if settings.model.lessons < 0:
        raise SettingsError(f"model.lessons={settings.model.lessons}: give a number of at least 0")
    if not settings.model.l2 > 0.0:
        raise SettingsError(f"model.l2={settings.model.l2}: it must be positive, or the optimum is not unique")
    widest = round(math.degrees(FIELD_OF_VIEW), 6)
    if not 0.0 < abs(settings.simulator.spin_step) <= widest:
        raise SettingsError(
            f"simulator.spin_step={settings.simulator.spin_step}: give degrees up to {widest:g}, the width of the view"
        )
    wrong = [trial for trial in settings.animate if not 0 <= trial < settings.trials]
    if wrong:
        raise SettingsError(f"animate={settings.animate}: trials go from 0 to {settings.trials - 1}")
    for name, asked in (("simulator.gui", settings.simulator.gui), ("animate", settings.animate)):
        if asked and settings.simulator.kind is RobotKind.fake:
            raise SettingsError(f"{name}={asked}: the fake robot has nothing to show; take simulator=pybullet")
    most = {"types": (settings.types, len(MORE_TYPES)), "colors": (settings.colors, len(MORE_COLORS))}
    for name, (number, limit) in most.items():
        if not 1 <= number <= limit:
            raise SettingsError(f"{name}={number}: give a number from 1 to {limit}")
    if settings.types > len(TYPES) and settings.simulator.kind is not RobotKind.fake:
        raise SettingsError(
            f"types={settings.types}: the simulator has bodies for {len(TYPES)}; take simulator=fake, or fewer types"
        )
    if not 0.0 < settings.object_rate <= 1.0:
        raise SettingsError(f"object_rate={settings.object_rate}: a probability above 0 and at most 1")
    _check_open_world(settings.model.open_world)
    if settings.asking is Asking.when_unsure and not settings.model.posterior:
        raise SettingsError(
            "asking=when_unsure: the paper's models ask nothing; take model=open_world, or asking=never"
        )


def _check_open_world(settings: OpenWorldSettings) -> None:
    for name in ("synonym", "slip"):
        if not 0.0 < getattr(settings, name) < 1.0:
            raise SettingsError(f"model.open_world.{name}={getattr(settings, name)}: give a share between 0 and 1")
    for name in ("unmet", "hidden", "strength"):
        if not getattr(settings, name) > 0.0:
            raise SettingsError(f"model.open_world.{name}={getattr(settings, name)}: give a number above 0")
    for name in ("look_above", "ask_below"):
        if not 0.0 <= getattr(settings, name) <= 1.0:
            raise SettingsError(f"model.open_world.{name}={getattr(settings, name)}: give a probability from 0 to 1")
    if settings.views < 0:
        raise SettingsError(f"model.open_world.views={settings.views}: give a number of at least 0")
