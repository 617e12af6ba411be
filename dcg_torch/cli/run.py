"""`python -m dcg_torch [overrides]`: one experiment, or a sweep of them (-m). Where it is put together."""

from __future__ import annotations

import contextlib
import time
from dataclasses import asdict, replace
from pathlib import Path

import hydra
from hydra.core.hydra_config import HydraConfig
from hydra.types import RunMode
from omegaconf import DictConfig
from rich.console import Console
from rich.markup import escape

from dcg_torch.cli.application import one_line_errors, raised_errors, run_application
from dcg_torch.cli.config import launcher_of, save_composed, settings_of
from dcg_torch.cli.console import CommandBar, make_console
from dcg_torch.cli.sweep import sweep_shared_memory
from dcg_torch.experiment.folder import MARKS, check_owner, lexicon_of
from dcg_torch.experiment.pool import leave_with_parent
from dcg_torch.experiment.runner import check_feasible, run
from dcg_torch.settings import Settings
from dcg_torch.storage.claim import claim
from dcg_torch.storage.resources import resource

_STARTED = time.perf_counter()


def _application(config: DictConfig) -> float:
    """One experiment, in the folder that Hydra chose; its metric, for a sweeper that looks for the best."""
    directory, sweep = Path(HydraConfig.get().runtime.output_dir), HydraConfig.get().mode == RunMode.MULTIRUN
    began = time.perf_counter() if sweep else _STARTED
    named = f"hydra.sweep.dir={HydraConfig.get().sweep.dir}" if sweep else f"hydra.run.dir={directory}"
    goes_on = f"the same command with {named} goes on from here"
    launcher = launcher_of(HydraConfig.get()) if sweep else "basic"
    if launcher == "joblib":
        leave_with_parent()
    with one_line_errors(directory, goes_on) if launcher == "basic" else raised_errors(directory):
        settings = settings_of(config)
        if launcher == "ray" and not settings.workers:  # it gives a job one core, whatever the machine has
            settings = replace(settings, workers=1)
        check_owner(settings, directory)
        check_feasible(settings)
        with claim(directory, MARKS) as killed:
            if killed is not None:
                sweep_shared_memory(killed)
            save_composed(config, directory)
            return _run(settings, directory, began)
    raise AssertionError("an error ends the program")


def _run(settings: Settings, directory: Path, began: float) -> float:
    """Run an experiment in its folder, and show what came of it; its metric."""
    console = make_console()
    trials = f"{settings.trials} trial{'s' * (settings.trials > 1)}"
    commands = f"{settings.iterations} command{'s' * (settings.iterations > 1)}"
    console.print(
        f"[bold]{escape(settings.name)}[/bold]: {trials} of {commands}, "
        f"model {escape(settings.model.name)}, in {escape(str(directory))}"
    )
    from dcg_torch.experiment.outcome import begin_drawing, save_outcome, value_of
    from dcg_torch.report.show import print_run

    with contextlib.closing(begin_drawing(settings, directory)) as drawing:
        with CommandBar(settings.trials * settings.iterations, console) as bar:
            ran = run(settings, directory, bar, lambda note: console.print(f"note: {escape(note)}"))
        outcome = save_outcome(settings, directory, time.perf_counter() - began if ran else None, drawing)
    print_run(outcome.measures, outcome.seconds, asdict(settings), console)
    _print_lexicon(lexicon_of(directory, settings.trials - 1), console)
    shown = escape(str(directory))
    for pictures in ("figures", "animations", "screenshots"):
        if (directory / pictures).is_dir():
            console.print(f"{pictures}: {shown}/{pictures}")
    console.print(f"rows: {shown}/iterations.jsonl   curves: tensorboard --logdir {escape(str(directory.parent))}")
    return value_of(outcome.measures, settings.metric)


def _print_lexicon(path: Path, console: Console) -> None:
    if path.exists():
        from dcg_torch.learning.lexicon import lexicon_table, load_lexicon

        console.print(lexicon_table(load_lexicon(path), f"What the words mean to the robot of trial {path.stem}"))


def main() -> int:
    """Run the command line; the exit status: 0 done, 2 wrong input, 130 interrupted."""
    application = hydra.main(version_base="1.3", config_path=str(resource("conf")), config_name="config")(_application)
    return run_application(application)
