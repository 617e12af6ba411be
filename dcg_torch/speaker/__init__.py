"""Who gives the commands: written ones, or generated for any world.

A speaker turns a world into commands, each about one object. What it says of the object, noun and colour, is
kept beside the text, so that a parse can be judged.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from functools import cache
from importlib.resources import files
from typing import Protocol

import numpy as np
import yaml

from dcg_torch.world.files import World, WorldObject


@dataclass(frozen=True, slots=True)
class Command:
    """A command in a world: the text, the noun (singular) and colour it says, the id of the object meant."""

    world: World
    text: str
    noun: str
    color: str | None
    target: str


class Speaker(Protocol):
    """Gives commands for a world; every object is meant by at least one, unless nobody wrote any."""

    def commands(self, world: World, rng: np.random.Generator) -> list[Command]:
        """What it says in one world."""
        ...


class SpeakerError(ValueError):
    """A speaker has nothing to say; the message is one line."""


class WrittenSpeaker:
    """Gives the commands that stand in the world files."""

    def commands(self, world: World, rng: np.random.Generator) -> list[Command]:
        """The commands of the world file, in its order.

        Raises:
            SpeakerError: the file has none.
        """
        if not world.commands:
            raise SpeakerError(
                f"world {world.name} has no written commands; add some, or take speaker=canonical or speaker=human"
            )
        return [Command(world, c.text, c.noun, c.color, c.target) for c in world.commands]


class RelationalSpeaker:
    """Gives the commands of the world files that need a relation to be understood; some worlds have none."""

    def commands(self, world: World, rng: np.random.Generator) -> list[Command]:
        """The relational commands of the world file, in its order."""
        return [Command(world, c.text, c.noun, c.color, c.target) for c in world.relational]


CANONICAL_FORMS = (
    "go to the {thing}",
    "move to the {thing}",
    "move towards the {thing}",
    "drive to the {thing}",
    "approach the {thing}",
)


class GeneratingSpeaker:
    """Gives one command for every object: a fixed form, the noun, and mostly the colour.

    Args:
        color_rate: share of the commands that state the colour.
        names: type -> noun -> how often it is used; a type that is missing is called by its own name.
    """

    def __init__(self, color_rate: float = 1.0, names: Mapping[str, Mapping[str, float]] | None = None) -> None:
        if not 0.0 <= color_rate <= 1.0:
            raise SpeakerError(f"color_rate is {color_rate}; a share lies between 0 and 1")
        self.color_rate = color_rate
        self.names = names or {}

    def commands(self, world: World, rng: np.random.Generator) -> list[Command]:
        """A command per object, in the order of the world file."""
        return [self._command(world, o, rng) for o in world.objects]

    def _command(self, world: World, obj: WorldObject, rng: np.random.Generator) -> Command:
        form = CANONICAL_FORMS[rng.integers(len(CANONICAL_FORMS))]
        color = obj.color if rng.random() < self.color_rate else None
        noun = _draw(self.names.get(obj.type, {obj.type: 1.0}), rng)
        text = form.format(thing=noun if color is None else f"{color} {noun}")
        return Command(world, text, noun, color, obj.id)


def _draw(counts: Mapping[str, float], rng: np.random.Generator) -> str:
    nouns = list(counts)
    shares = np.array([counts[n] for n in nouns], dtype=float)
    return nouns[int(rng.choice(len(nouns), p=shares / shares.sum()))]


@cache
def human_names() -> dict[str, dict[str, float]]:
    """How often people use which noun for the paper's types."""
    loaded: dict[str, dict[str, float]] = yaml.safe_load(files(__package__).joinpath("names.yaml").read_text("utf-8"))
    return loaded


def make_speaker(kind: str, color_rate: float) -> Speaker:
    """The speaker of a configuration: "canonical", "written" or "human".

    Raises:
        SpeakerError: no such speaker.
    """
    makers: dict[str, Callable[[], Speaker]] = {
        "canonical": lambda: GeneratingSpeaker(color_rate),
        "written": WrittenSpeaker,
        "relational": RelationalSpeaker,
        "human": lambda: GeneratingSpeaker(color_rate, human_names()),
    }
    if kind not in makers:
        raise SpeakerError(f"speaker={kind} is not one of {', '.join(makers)}")
    return makers[kind]()


def draw_trial(worlds: Sequence[World], speaker: Speaker, iterations: int, rng: np.random.Generator) -> list[Command]:
    """The commands of one trial: drawn without replacement from all pairs of world and command (Section IV-A).

    Raises:
        SpeakerError: there are fewer pairs than iterations.
    """
    pool = [command for world in worlds for command in speaker.commands(world, rng)]
    if len(pool) < iterations:
        raise SpeakerError(f"iterations={iterations}, but these worlds have {len(pool)} commands; ask for fewer")
    return [pool[k] for k in rng.choice(len(pool), size=iterations, replace=False)]
