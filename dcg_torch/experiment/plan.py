"""What a trial consists of: its worlds and commands, and the random numbers that both come from."""

from __future__ import annotations

import functools

import numpy as np

from dcg_torch.settings import Order, Settings, SettingsError
from dcg_torch.storage.resources import resource
from dcg_torch.storage.untrusted_files import at_home
from dcg_torch.world.files import World, load_worlds
from dcg_torch.world.generator import generate_world
from dcg_torch.world.names import MORE_COLORS, MORE_TYPES
from dcg_torch.world.speaker import Command, draw_trial, make_speaker


def trial_generators(seed: int, trial: int) -> list[np.random.Generator]:
    """A trial's generators: of worlds, of commands, of the recogniser's mistakes."""
    return [np.random.default_rng(s) for s in np.random.SeedSequence(seed, spawn_key=(trial,)).spawn(3)]


def trial_worlds(settings: Settings, rng: np.random.Generator) -> list[World]:
    """The worlds that a trial's commands are drawn from.

    Raises:
        WorldFileError: a world file is missing or not valid.
        SettingsError: such worlds cannot be generated.
    """
    if settings.worlds == "generated":
        draw = functools.partial(
            generate_world,
            rng,
            types=MORE_TYPES[: settings.types],
            colors=MORE_COLORS[: settings.colors],
            probability=settings.object_rate,
        )
        try:
            return [draw(f"generated_{k:02d}") for k in range(settings.worlds_per_trial)]
        except ValueError as error:
            raise SettingsError(f"worlds=generated: {error}") from None
    return _worlds_of(resource("worlds") if settings.worlds == "committed" else at_home(settings.worlds))


_worlds_of = functools.cache(load_worlds)


def trial_commands(settings: Settings, trial: int) -> list[Command]:
    """The commands of a trial, from (seed, trial) alone.

    Raises:
        SettingsError: in the order of the files there are too few commands.
        WorldFileError: a world file is missing or not valid.
        SpeakerError: the speaker has too few commands for these worlds.
    """
    worlds_rng, commands_rng, _ = trial_generators(settings.seed, trial)
    worlds = trial_worlds(settings, worlds_rng)
    speaker = make_speaker(settings.speaker, settings.color_rate)
    if settings.order is Order.file:
        found = [c for world in worlds for c in speaker.commands(world, commands_rng)]
        if len(found) < settings.iterations:
            raise SettingsError(f"iterations={settings.iterations}, but the files have {len(found)} commands")
        return found[: settings.iterations]
    return draw_trial(worlds, speaker, settings.iterations, commands_rng)
