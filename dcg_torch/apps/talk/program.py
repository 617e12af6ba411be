"""`dcg-torch talk [KEY=VALUE ...]`: from the settings to a world, a session and a server."""

from __future__ import annotations

import secrets
from datetime import datetime
from pathlib import Path

import hydra
import numpy as np
from omegaconf import DictConfig

from dcg_torch.apps.talk.host import Host
from dcg_torch.apps.talk.server import Address, serve
from dcg_torch.cli.application import one_line_errors, run_application
from dcg_torch.cli.config import talk_settings_of
from dcg_torch.dialogue.session import Session
from dcg_torch.settings import SettingsError, TalkSettings
from dcg_torch.storage.resources import resource
from dcg_torch.world.files import World, load_world
from dcg_torch.world.generator import generate_world

_CONF = Path(__file__).parent / "conf"
"""Apart from that of the experiments, whose groups `model` and `simulator` mean something else."""


def world_of(settings: TalkSettings) -> World:
    """The world that is named: a committed one, "generated", or a file of one's own.

    Raises:
        SettingsError: there is none of this name.
        WorldFileError: the file is not valid.
    """
    if settings.world == "generated":
        return generate_world(np.random.default_rng(settings.seed), f"generated_{settings.seed}")
    path = Path(settings.world)
    if path.suffix in (".yaml", ".yml"):
        return load_world(path)
    committed = {file.stem: file for file in sorted(resource("worlds").rglob("*.yaml"))}
    if settings.world not in committed:
        names = ", ".join(committed)
        raise SettingsError(f"world={settings.world}: take generated, a YAML file, or one of {names}")
    return load_world(committed[settings.world])


def _application(config: DictConfig) -> None:
    with one_line_errors(program="talk"):
        settings = talk_settings_of(config)
        # The random part: two of one second, or a clock put back, must not go on with the session of another.
        new_file = f"runs/talk_{datetime.now():%Y-%m-%d_%H-%M-%S}_{secrets.token_hex(3)}/session.jsonl"
        file = Path(settings.session or new_file)
        world = None if file.exists() else world_of(settings)

        def new() -> Session:
            model = Path(settings.model) if settings.model else None
            return Session(
                world or world_of(settings), model, file=file, simulator=settings.simulator.value, seed=settings.seed
            )

        address = Address.checked(settings.host, settings.port, settings.token)
        try:
            serve(Host(file, new, settings.pace), address, show=settings.open)
        finally:
            if world is not None and file.exists() and file.read_bytes().count(b"\n") < 2:  # nobody said a thing
                file.unlink()
                if not settings.session:
                    file.parent.rmdir()


def main() -> int:
    """Run the command line; the exit status: 0 done, 2 wrong input, 130 interrupted."""
    wrap = hydra.main(version_base="1.3", config_path=str(_CONF), config_name="talk")
    return run_application(wrap(_application), "talk")
