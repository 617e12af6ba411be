"""The settings of an experiment and of an evaluation: plain dataclasses, checked once they are complete.

What a setting means and what values make sense stand beside its default, in one place that both the check and the help
read.
"""

from __future__ import annotations

import enum
import math
from collections.abc import Iterator
from dataclasses import dataclass, field, fields, is_dataclass
from typing import Any

from dcg_torch.storage.errors import UserError
from dcg_torch.world.generator import TYPES
from dcg_torch.world.names import MORE_COLORS, MORE_TYPES

MOST = 100_000
"""Of anything that is counted: trials, commands, lessons."""


class SettingsError(UserError):
    """A setting that makes no sense; the message is one line: which, what is wrong, how to mend it."""


@dataclass(frozen=True)
class Bounds:
    """The numbers that make sense for a setting, from `low` to `high`; `open` leaves `low` itself out."""

    low: float
    high: float
    open: bool = False

    def hold(self, number: float) -> bool:
        """Whether a number is finite and within."""
        above = number > self.low if self.open else number >= self.low
        return above and number <= self.high and (isinstance(number, int) or math.isfinite(number))

    def __str__(self) -> str:
        low, high = f"{self.low:g}", f"{self.high:g}"
        return f"above {low}, at most {high}" if self.open else f"from {low} to {high}"


def _setting(default: Any, text: str, bounds: Bounds | None = None) -> Any:
    """A field with its default, what it means, and what numbers make sense."""
    metadata = {"help": text, "bounds": bounds}
    if isinstance(default, list):
        return field(default_factory=lambda: list(default), metadata=metadata)
    return field(default=default, metadata=metadata)


_COUNT, _SHARE = Bounds(1, MOST), Bounds(0, 1)


class Speaker(enum.StrEnum):
    """Who gives the commands; see `dcg_torch.world.speaker`."""

    canonical = "canonical"
    written = "written"
    relational = "relational"
    human = "human"


class LearnerKind(enum.StrEnum):
    """How a model learns words."""

    commit_first = "commit_first"
    word_posterior = "word_posterior"


class Names(enum.StrEnum):
    """What the names of classes say of what people call them."""

    opaque = "opaque"
    words = "words"


class Asking(enum.StrEnum):
    """When the robot asks back."""

    never = "never"
    when_unsure = "when_unsure"


class RobotKind(enum.StrEnum):
    """What carries the commands out: a robot in physics, or one of pure geometry."""

    pybullet = "pybullet"
    fake = "fake"


class Backend(enum.StrEnum):
    """What works off the trials of a run."""

    fork = "fork"
    loky = "loky"
    ray = "ray"
    dask = "dask"


class Metric(enum.StrEnum):
    """What a run is judged by; see `dcg_torch.report.measures`."""

    accuracy = "accuracy"
    correct_symbols = "correct_symbols"
    wrong_symbols = "wrong_symbols"
    asked = "asked"
    path_length = "path_length"
    turned = "turned"
    collisions = "collisions"


class Order(enum.StrEnum):
    """How a trial's commands are taken from those of its worlds."""

    drawn = "drawn"
    file = "file"


@dataclass
class OpenWorldSettings:
    """When `model=open_world` looks further and when it asks."""

    look_above: float = _setting(
        0.03, "look on while types out of view have more than this share of the belief", _SHARE
    )
    views: int = _setting(2, "places that the robot drives to for a look behind things, at the most", Bounds(0, 100))
    ask_below: float = _setting(0.75, "with asking=when_unsure: ask if the best object is less probable", _SHARE)


@dataclass
class ModelSettings:
    """The kind of model: a variant of the paper's, or one beyond it."""

    name: str = _setting("dcg_upup_away_color", "of the kind, in tables")
    groups: list[str] = _setting(["dcg", "unknown", "hypothetical", "color"], "feature groups")
    hypothetical: bool = _setting(True, "believe in objects out of view")
    learns: bool = _setting(True, "learn new words")
    ternary: bool = _setting(True, "correspondences -1, 0, 1 (eq. 4); false: 0 and 1 (eq. 6)")
    l2: float = _setting(0.05, "penalty on the weights", Bounds(1e-6, 1e6))  # below: the fit is singular
    beam: int = _setting(8, "configurations kept a phrase", Bounds(1, 1_000))
    lessons: int = _setting(0, "generated lessons on relations before the first command", Bounds(0, MOST))
    learner: LearnerKind = _setting(
        LearnerKind.commit_first, "commit at once, as the paper does, or keep a posterior over what words mean"
    )
    open_world: OpenWorldSettings = field(default_factory=OpenWorldSettings)


@dataclass
class SimulatorSettings:
    """The robot and its camera."""

    kind: RobotKind = _setting(RobotKind.pybullet, "pybullet, or fake for a robot of pure geometry")
    gui: bool = _setting(False, "open PyBullet's window")
    spin_step: float = _setting(
        20.0, "degrees between two looks while it turns; below 0: to the right", Bounds(-57, 57)
    )
    min_pixels: int = _setting(4, "of an object in the picture, for it to be recognised", Bounds(1, MOST))
    wrong_class: float = _setting(0.0, "share of objects that the recogniser takes for another type", _SHARE)
    missed: float = _setting(0.0, "share of objects that it never recognises", _SHARE)


@dataclass
class Settings:
    """One experiment."""

    name: str = _setting("run", "of the run folder and in the tables")
    model: ModelSettings = field(default_factory=ModelSettings)
    simulator: SimulatorSettings = field(default_factory=SimulatorSettings)
    names: Names = _setting(Names.opaque, "whether class names are evidence for what nouns mean")
    training: str | None = _setting(None, "YAML file of initial examples, instead of the 53 that come along")
    seed: int = _setting(0, "of all that is drawn", Bounds(0, 1e15))
    trials: int = _setting(30, "each starts with the initial examples alone", _COUNT)
    iterations: int = _setting(10, "commands in a trial", _COUNT)
    worlds: str = _setting("committed", "committed, generated (fresh ones a trial), or a folder of world files")
    worlds_per_trial: int = _setting(10, "of generated worlds", Bounds(1, 10_000))
    types: int = _setting(
        8, "in generated worlds, the paper's eight first; more need the fake robot", Bounds(1, len(MORE_TYPES))
    )
    colors: int = _setting(3, "in generated worlds, the paper's three first", Bounds(1, len(MORE_COLORS)))
    object_rate: float = _setting(
        0.15, "probability of each type in each colour in a generated world", Bounds(0, 1, open=True)
    )
    order: Order = _setting(Order.drawn, "commands drawn at random, or as they stand in the files")
    speaker: Speaker = _setting(Speaker.written, "who gives the commands")
    color_rate: float = _setting(1.0, "share of generated commands that state the colour", _SHARE)
    asking: Asking = _setting(Asking.never, "when the robot asks back")
    workers: int = _setting(0, "processes; 0 takes one a core, or all that a cluster has", Bounds(0, 1_024))
    backend: Backend = _setting(
        Backend.fork, "what works off the trials: processes of our own, or joblib's loky, ray or dask"
    )
    metric: Metric = _setting(Metric.accuracy, "the measure of a run that a sweeper such as Optuna is told")
    animate: list[int] = _setting([], "trials to save as animations")
    figures: bool = _setting(True, "draw the figures")
    tensorboard: bool = _setting(True, "write TensorBoard event files")
    screenshots: bool = _setting(False, "save a picture of every pair of world and object")


@dataclass
class EvaluateSettings:
    """Grounding the commands of episode files, perhaps after training on others."""

    train: Any = _setting(None, "episode file (JSON lines) to train on, or a list of them; none: the model as it is")
    test: Any = _setting(None, "episode file to ground, or a list of them")
    model: ModelSettings = field(default_factory=ModelSettings)
    names: Names = _setting(Names.words, "whether class names are evidence for what nouns mean")
    training: str | None = _setting(None, "YAML file of initial examples, instead of the 53 that come along")
    known_types: list[str] | None = _setting(None, "leave the training rows about other types out")
    known_colors: list[str] | None = _setting(None, "leave the training rows about objects of other colours out")
    learn: bool = _setting(False, "learn after each test command, in file order, without seeing its target")
    explain: str | None = _setting(None, "id of a test episode whose grounding is to be explained")
    rounds: int = _setting(4, "of expectation-maximisation over the landmarks", Bounds(1, 1_000))
    folds: int = _setting(0, "instead of test: cross-validate train in so many parts, by group", Bounds(0, 1_000))
    halves: bool = _setting(False, "instead of test: train on half of each file's groups, test on the others")
    baseline: list[str] = _setting([], "also: overlap, nearest, outcomes, bow, minilm, on the same episodes")
    certify: bool = _setting(False, "change test episodes a little, and count how often the answer follows")
    device: str = _setting("cpu", "of torch, for Psi and the fits' sums: cpu, cuda, cuda:1")
    save: bool = _setting(True, "write the model as it is at the end into model/; not with folds")


@dataclass
class TalkSettings:
    """The page to talk to the robot."""

    world: str = _setting("laboratory", "name of a committed world, generated, or a world file")
    model: str | None = _setting(None, "folder of a saved model; none: the shipped one")
    session: str | None = _setting(None, "file that keeps the session; one that is there goes on. None: a new one")
    simulator: RobotKind = _setting(RobotKind.pybullet, "physics, or pure geometry")
    seed: int = _setting(0, "of a generated world", Bounds(0, 1e15))
    host: str = _setting("127.0.0.1", "address to listen on; all but the loopback address ask for a token")
    port: int = _setting(8080, "to listen on; 0 takes a free one", Bounds(0, 65_535))
    token: str | None = _setting(None, "what visitors need; none: made by chance, where one is needed")
    pace: float = _setting(1.0, "times as fast as the robot that it is shown; 0: as fast as can be", Bounds(0, 100))
    open: bool = _setting(True, "open the page in the browser")


def described(schema: type) -> Iterator[tuple[str, Any, str, Bounds | None]]:
    """(dotted name, default, what it means, bounds) of every setting of a schema."""
    return _walk(schema())


def _walk(settings: Any, prefix: str = "") -> Iterator[tuple[str, Any, str, Bounds | None]]:
    for one in fields(settings):
        value = getattr(settings, one.name)
        if is_dataclass(value):
            yield from _walk(value, f"{prefix}{one.name}.")
        else:
            yield prefix + one.name, value, one.metadata["help"], one.metadata["bounds"]


def check_bounds(settings: Settings | EvaluateSettings) -> None:
    """See that every number lies within its bounds, and that a model that is described has features.

    Raises:
        SettingsError: one does not.
    """
    check_values(settings)
    if not settings.model.groups:
        raise SettingsError("model.groups=[]: a model needs features; give some, [dcg,unknown] for one")


def check_values(settings: Any) -> None:
    """See that every number of any settings lies within its bounds, and that no text is beyond measure.

    Raises:
        SettingsError: one does not.
    """
    for name, value, _, bounds in _walk(settings):
        if bounds is not None and value is not None and not bounds.hold(value):
            raise SettingsError(f"{name}={_short(value)}: give a number {bounds}")
        if isinstance(value, str) and ("\0" in value or len(value) > 4_000):
            raise SettingsError(f"{name}: a text of {len(value)} characters makes no sense here; give a shorter one")


def _short(number: float) -> str:
    text = str(number)
    return text if len(text) <= 20 else f"{text[:20]}..."


def check(settings: Settings) -> None:
    """See that the values of an experiment make sense, each alone and together.

    Raises:
        SettingsError: one of them does not.
    """
    check_bounds(settings)
    if abs(step := settings.simulator.spin_step) < _LEAST_STEP:
        raise SettingsError(
            f"simulator.spin_step={_short(step)}: the robot would look round for ever; give degrees from 1 to 57"
        )
    if not isinstance(settings.animate, (list, tuple)):
        raise SettingsError(f"animate={_short(settings.animate)}: give a list of trials, such as animate=[0,1]")
    wrong = [t for t in settings.animate if not isinstance(t, int) or not 0 <= t < settings.trials]
    if wrong:
        raise SettingsError(f"animate: there is no trial {_short(wrong[0])}; trials go from 0 to {settings.trials - 1}")
    for name, asked in (("simulator.gui", settings.simulator.gui), ("animate", settings.animate)):
        if asked and settings.simulator.kind is RobotKind.fake:
            raise SettingsError(f"{name}={asked}: the fake robot has nothing to show; take simulator=pybullet")
    if settings.types > len(TYPES) and settings.simulator.kind is not RobotKind.fake:
        raise SettingsError(
            f"types={settings.types}: the simulator has bodies for {len(TYPES)}; take simulator=fake, or fewer types"
        )
    least = _FEWEST_OBJECTS / (settings.types * settings.colors)
    if settings.worlds == "generated" and settings.object_rate < least:
        raise SettingsError(f"object_rate={settings.object_rate}: worlds would stay empty; give at least {least:g}")
    if settings.asking is Asking.when_unsure and settings.model.learner is LearnerKind.commit_first:
        raise SettingsError(
            "asking=when_unsure: the paper's models ask nothing; take model=open_world, or asking=never"
        )


_LEAST_STEP = 1.0  # degrees: 360 looks a turn
_FEWEST_OBJECTS = 0.05  # expected in a world, so that one of the generator's 1,000 draws has an object
