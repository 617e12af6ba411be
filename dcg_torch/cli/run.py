"""`python -m dcg_torch [overrides]`: one experiment, or a sweep of them (-m). Where it is put together."""

from __future__ import annotations

import os
import sys
import threading
import time
from dataclasses import asdict
from pathlib import Path

import hydra
from hydra.core.hydra_config import HydraConfig
from hydra.types import RunMode
from omegaconf import DictConfig
from rich.console import Console
from rich.markup import escape

from dcg_torch.cli.application import one_line_errors, run_application
from dcg_torch.cli.config import save_composed, settings_of
from dcg_torch.cli.console import CommandBar, make_console
from dcg_torch.experiment.folder import MARKS, check_owner, lexicon_of
from dcg_torch.experiment.pool import may_start_processes
from dcg_torch.experiment.runner import check_feasible, run
from dcg_torch.settings import Settings
from dcg_torch.storage.claim import claim
from dcg_torch.storage.resources import resource

_STARTED = time.perf_counter()
_LOOK = 0.5  # seconds between two looks whether the launcher of a sweep is still there


def _application(config: DictConfig) -> None:
    """One experiment, in the folder that Hydra chose."""
    directory, sweep = Path(HydraConfig.get().runtime.output_dir), HydraConfig.get().mode == RunMode.MULTIRUN
    began = time.perf_counter() if sweep else _STARTED
    if sweep and not may_start_processes():
        _end_with(os.getppid())
    named = f"hydra.sweep.dir={HydraConfig.get().sweep.dir}" if sweep else f"hydra.run.dir={directory}"
    with one_line_errors(directory, f"the same command with {named} goes on from here"):
        settings = settings_of(config)
        check_owner(settings, directory)
        check_feasible(settings)
        with claim(directory, MARKS):
            save_composed(config, directory)
            _run(settings, directory, began)


def _end_with(launcher: int) -> None:
    """End this process when the launcher's is gone: an orphan would keep the folder from the sweep that goes on."""

    def watch() -> None:
        while os.getppid() == launcher:
            time.sleep(_LOOK)
        os._exit(1)

    threading.Thread(target=watch, daemon=True).start()


def _run(settings: Settings, directory: Path, began: float) -> None:
    """Run an experiment in its folder, and show what came of it."""
    console = make_console()
    console.print(
        f"[bold]{escape(settings.name)}[/bold]: {settings.trials} trials of {settings.iterations} commands, "
        f"model {escape(settings.model.name)}, in {escape(str(directory))}"
    )
    with CommandBar(settings.trials * settings.iterations, console) as bar:
        ran = run(settings, directory, bar, lambda note: console.print(f"note: {escape(note)}"))
    from dcg_torch.experiment.outcome import save_outcome
    from dcg_torch.report import tables
    from dcg_torch.report.paper import follows_paper

    outcome = save_outcome(settings, directory, time.perf_counter() - began if ran else None)
    tables.print_measures(outcome.measures, console, outcome.seconds, beside_paper=follows_paper(asdict(settings)))
    tables.print_iterations(outcome.measures, console)
    tables.print_errors(outcome.measures, console)
    _print_lexicon(lexicon_of(directory, settings.trials - 1), console)
    shown = escape(str(directory))
    for pictures in ("figures", "animations", "screenshots"):
        if (directory / pictures).is_dir():
            console.print(f"{pictures}: {shown}/{pictures}")
    console.print(f"rows: {shown}/iterations.jsonl   curves: tensorboard --logdir {escape(str(directory.parent))}")


def _print_lexicon(path: Path, console: Console) -> None:
    if path.exists():
        from dcg_torch.learning.lexicon import lexicon_table, load_lexicon

        console.print(lexicon_table(load_lexicon(path), f"What the words mean to the robot of trial {path.stem}"))


def main() -> int:
    """Run the command line; the exit status: 0 done, 2 wrong input, 130 interrupted."""
    application = hydra.main(version_base="1.3", config_path=str(resource("conf")), config_name="config")(_application)
    return run_application(application)


if __name__ == "__main__":
    sys.exit(main())
