"""What the environment is made of: settings of an experiment by name, and the spaces that follow from them."""

from __future__ import annotations

import enum
import string
from collections.abc import Mapping
from dataclasses import fields
from typing import Any

import gymnasium.spaces as spaces
import numpy as np

from dcg_torch.experiment.plan import trial_worlds
from dcg_torch.settings import Order, RobotKind, Settings, SettingsError, SimulatorSettings, Speaker, check
from dcg_torch.storage.untrusted_files import misspelt, shown
from dcg_torch.world.files import World

Observation = dict[str, Any]


class Act(enum.IntEnum):
    """The first number of an action; the second is the percept that it is about."""

    LOOK = 0  # turn by one step, and see
    DRIVE = 1  # to a percept
    LEAVE = 2  # the surroundings of a percept
    ASK = 3  # whether a percept is the one meant
    DONE = 4  # the command is obeyed, or what it means is not there


class Reply(enum.IntEnum):
    """The answer to the question of the last step."""

    NOTHING = 0  # nothing was asked
    NO = 1
    YES = 2


ROBOT = ("spin_step", "min_pixels", "wrong_class", "missed")
"""Settings of the simulator that the environment takes."""
WORLD = (
    *("worlds", "speaker", "iterations", "worlds_per_trial", "types", "colors"),
    *("object_rate", "order", "color_rate"),
)
"""Settings of an experiment that it takes."""

_FAR = 2_000.0  # metres: worlds end at 1,000, and no drive goes farther than 100
_LONGEST_COMMAND, _LONGEST_NAME = 1_000, 100  # characters; as world files have them
_LETTERS = string.ascii_letters + string.digits + string.punctuation + " "


def experiment_settings(simulator: str, given: Mapping[str, Any]) -> Settings:
    """The settings of the experiment whose commands the environment gives.

    Args:
        simulator: "fake" or "pybullet".
        given: of `WORLD` and `ROBOT`.

    Raises:
        SettingsError: there is no such setting, or its value makes no sense.
    """
    for name in given:
        if name not in WORLD + ROBOT:
            near = misspelt(name, WORLD + ROBOT)
            raise SettingsError(f"{name}: there is no such setting here" + (f"; did you mean {near}?" if near else ""))
    robot = SimulatorSettings(
        kind=_choice("simulator", RobotKind, simulator), **{k: v for k, v in given.items() if k in ROBOT}
    )
    chosen = {k: v for k, v in given.items() if k in WORLD}
    chosen |= {k: _choice(k, kind, chosen[k]) for k, kind in _CHOICES.items() if k in chosen}
    settings = Settings(simulator=robot, **chosen)
    numbers = {one.name: getattr(part, one.name) for part in (settings, robot) for one in fields(part)}
    for name in given:
        if name not in _CHOICES and name != "worlds" and not isinstance(numbers[name], int | float):
            raise SettingsError(f"{name}={shown(numbers[name])}: give a number")
    check(settings)
    return settings


_CHOICES: Mapping[str, type[enum.StrEnum]] = {"speaker": Speaker, "order": Order}


def _choice(name: str, kind: type[enum.StrEnum], value: str) -> Any:
    try:
        return kind(value)
    except ValueError:
        raise SettingsError(f"{name}={shown(value)}: choose from {', '.join(kind)}") from None


def make_spaces(settings: Settings) -> tuple[spaces.Dict, spaces.MultiDiscrete]:
    """The spaces of observations and actions.

    Worlds of files may use letters and numbers of objects of their own: the spaces hold those, too.

    Raises:
        WorldFileError: a world file is missing or not valid.
    """
    most, letters = settings.types * settings.colors, _LETTERS
    if settings.worlds != "generated":
        worlds = trial_worlds(settings, np.random.default_rng(0))
        most = max(len(world.objects) for world in worlds)
        letters = "".join(sorted(set(letters).union(*map(_letters, worlds))))
    place = spaces.Box(-_FAR, _FAR, (3,), np.float64)
    name = spaces.Text(_LONGEST_NAME, min_length=0, charset=letters)
    percept = spaces.Dict({"type": name, "color": name, "position": place})
    seen = spaces.Dict(
        {
            "command": spaces.Text(_LONGEST_COMMAND, charset=letters),
            "percepts": spaces.Sequence(percept),
            "robot": spaces.Box(-_FAR, _FAR, (3,), np.float64),
            "reply": spaces.Discrete(len(Reply)),
        }
    )
    return seen, spaces.MultiDiscrete([len(Act), most])


def _letters(world: World) -> set[str]:
    """All characters that its objects and commands use."""
    said = (command.text for command in (*world.commands, *world.relational))
    return set("".join([*(o.type + o.color for o in world.objects), *said]))
