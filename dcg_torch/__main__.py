"""`python -m dcg_torch [overrides]`: one experiment, or a sweep of them (-m). The composition root."""

from __future__ import annotations

import os
import sys
import time
from collections.abc import Callable, Sequence
from dataclasses import asdict
from pathlib import Path

import hydra
from hydra.core.hydra_config import HydraConfig
from hydra.errors import HydraException
from omegaconf import DictConfig
from omegaconf.errors import OmegaConfBaseException
from rich.console import Console
from rich.progress import BarColumn, MofNCompleteColumn, Progress, TextColumn, TimeElapsedColumn, TimeRemainingColumn

from dcg_torch.config import register, settings_of
from dcg_torch.records import Iteration
from dcg_torch.resources import resource
from dcg_torch.settings import Settings, SettingsError

_STARTED = time.perf_counter()


def run_experiment(settings: Settings, directory: Path, console: Console) -> None:
    """Run what is not finished yet, then write the report.

    Raises:
        SettingsError, RunFolderError, WorldFileError, SpeakerError, SimulatorError: the user's input is wrong.
    """
    from dcg_torch.experiment import run

    console.print(f"[bold]{settings.name}[/bold]: {settings.trials} trials of {settings.iterations} commands, "
                  f"model {settings.model.name}, in {directory}")
    with _progress(settings, console) as progress:
        run(settings, directory, progress)
    _report(settings, directory, console)


class _progress:
    """A progress bar over commands, with the accuracy so far."""

    def __init__(self, settings: Settings, console: Console) -> None:
        columns = ("{task.description}", BarColumn(), MofNCompleteColumn())
        self._bar = Progress(
            *(TextColumn(c) if isinstance(c, str) else c for c in columns),
            TextColumn("accuracy {task.fields[accuracy]}"),
            TimeElapsedColumn(),
            TimeRemainingColumn(),
            console=console,
        )
        self._task = self._bar.add_task("commands", total=settings.trials * settings.iterations, accuracy="-")
        self._done = self._right = 0

    def __enter__(self) -> Callable[[Sequence[Iteration]], None]:
        self._bar.start()
        return self._show

    def __exit__(self, *_: object) -> None:
        self._bar.stop()

    def _show(self, rows: Sequence[Iteration]) -> None:
        self._done += len(rows)
        self._right += sum(row.correct for row in rows)
        accuracy = f"{100 * self._right / self._done:.1f} %" if self._done else "-"
        self._bar.update(self._task, completed=self._done, accuracy=accuracy)


def _report(settings: Settings, directory: Path, console: Console) -> None:
    """Measures, tables, figures, TensorBoard and summary of the run in `directory`."""
    from dcg_torch.experiment import read_run
    from dcg_torch.report import tables
    from dcg_torch.report.measures import measure
    from dcg_torch.report.seconds import summarise_seconds
    from dcg_torch.report.summary import write_summary

    rows, timings = read_run(directory)
    measures = measure(rows)
    seconds = summarise_seconds(timings)
    figures: list[Path] = []
    if settings.figures:
        from dcg_torch.report.figures import save_figures

        figures = save_figures(rows, timings, directory / "figures")
    if settings.tensorboard:
        from dcg_torch.report.board import write_board

        write_board(directory, rows, timings, asdict(settings), figures)
    seconds["wall"] = time.perf_counter() - _STARTED
    write_summary(directory / "summary.json", directory.name, asdict(settings), measures, seconds)
    tables.print_paper_table(measures, console, seconds)
    tables.print_iterations(measures, console)
    tables.print_errors(measures, console)
    if figures:
        console.print(f"figures: {directory / 'figures'}")
    console.print(f"rows: {directory / 'iterations.jsonl'}   curves: tensorboard --logdir {directory.parent}")


def _application(config: DictConfig) -> None:
    run_experiment(settings_of(config), Path(HydraConfig.get().runtime.output_dir), Console())


def _refuse(message: str) -> int:
    print(f"dcg_torch: {' '.join(message.split())}", file=sys.stderr)
    return 2


def main() -> int:
    """Run the command line; the exit status: 0 done, 2 wrong input, 130 interrupted."""
    from dcg_torch.experiment import USER_ERRORS

    os.environ["HYDRA_FULL_ERROR"] = "1"  # errors come here as exceptions, not as Hydra's own printed report
    register()
    application = hydra.main(version_base="1.3", config_path=str(resource("conf")), config_name="config")(_application)
    try:
        application()
    except (HydraException, OmegaConfBaseException) as error:
        return _refuse(str(error))
    except USER_ERRORS as error:
        return _refuse(str(error))
    except KeyboardInterrupt:
        print("dcg_torch: interrupted; the same command with the same hydra.run.dir goes on from here", file=sys.stderr)
        return 130
    return 0


if __name__ == "__main__":
    sys.exit(main())
