"""`--help` of a command with settings, before what it runs is loaded: torch alone takes seconds."""

from __future__ import annotations

import hydra

from dcg_torch.cli.application import run_application
from dcg_torch.storage.resources import resource


def show_help(program: str, folder: str) -> int:
    """Print what a program's configuration says of it; the exit status.

    Args:
        program: of `settings_help.SCHEMAS`.
        folder: of its configuration, as `resource` finds it.
    """
    wrap = hydra.main(version_base="1.3", config_path=str(resource(folder)), config_name=program)
    return run_application(wrap(lambda _: None), program)
