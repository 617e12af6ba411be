"""`python -m dcg_torch [overrides]`: one experiment, or a sweep of them (-m). The composition root."""

from __future__ import annotations

import contextlib
import os
import sys
import time
from collections.abc import Callable
from dataclasses import asdict
from pathlib import Path

import hydra
from hydra._internal.utils import get_args_parser
from hydra.core.hydra_config import HydraConfig
from hydra.types import RunMode
from omegaconf import DictConfig
from rich.console import Console
from rich.markup import escape

from dcg_torch.cli.config import CONFIG_ERRORS, explain, register, save_composed, settings_of
from dcg_torch.cli.console import CommandBar, make_console
from dcg_torch.resources import resource
from dcg_torch.settings import Settings

_STARTED = time.perf_counter()


def _application(config: DictConfig) -> None:
    """One experiment, in the folder that Hydra chose."""
    from dcg_torch.experiment.runner import WorkerKilledError, check_folder, run, user_errors

    directory, console = Path(HydraConfig.get().runtime.output_dir), make_console()
    sweep = HydraConfig.get().mode == RunMode.MULTIRUN
    began = time.perf_counter() if sweep else _STARTED
    try:
        settings = settings_of(config)
        check_folder(settings, directory)
        save_composed(config, directory)
        console.print(
            f"[bold]{escape(settings.name)}[/bold]: {settings.trials} trials of {settings.iterations} commands, "
            f"model {escape(settings.model.name)}, in {escape(str(directory))}"
        )
        with CommandBar(settings.trials * settings.iterations, console) as bar:
            ran = run(settings, directory, bar)
        _report(settings, directory, console, began if ran else None)
    except CONFIG_ERRORS as error:
        sys.exit(refuse(explain(error), directory))
    except KeyboardInterrupt:
        where = f"hydra.sweep.dir={HydraConfig.get().sweep.dir}" if sweep else f"hydra.run.dir={directory}"
        print(f"dcg_torch: interrupted; the same command with {where} goes on from here", file=sys.stderr)
        sys.exit(130)
    except WorkerKilledError as error:
        print(f"dcg_torch: {error}", file=sys.stderr)
        sys.exit(1)
    except Exception as error:
        if not isinstance(error, user_errors()):
            raise
        sys.exit(refuse(str(error), directory))


def _report(settings: Settings, directory: Path, console: Console, began: float | None) -> None:
    """Measures, tables, figures, TensorBoard and summary of the run in `directory`.

    Its wall time counts from `began`; None for a run that was finished before, whose wall time stays.
    """
    from dcg_torch.experiment.runner import lexicon_of, read_run
    from dcg_torch.report import tables
    from dcg_torch.report.measures import measure
    from dcg_torch.report.paper import follows_paper
    from dcg_torch.report.runs import varied_settings
    from dcg_torch.report.seconds import summarise_seconds
    from dcg_torch.report.summary import ReportError, read_summary, write_summary

    rows, timings = read_run(directory)
    measures = measure(rows)
    seconds = summarise_seconds(timings)
    beside_paper = follows_paper(asdict(settings))
    figures: list[Path] = []
    if settings.figures:
        from dcg_torch.report.figures import save_figures

        figures = save_figures(rows, timings, directory / "figures", beside_paper=beside_paper)
    if settings.screenshots:
        from dcg_torch.watch.pictures import save_screenshots

        save_screenshots(settings, directory / "screenshots")
    if settings.tensorboard:
        from dcg_torch.report.board import write_board

        write_board(directory, rows, timings, varied_settings(directory), figures)
    summary = directory / "summary.json"
    if began is not None:
        seconds["wall"] = time.perf_counter() - began
    else:
        with contextlib.suppress(ReportError):  # there may be none yet, if it was interrupted after its last trial
            seconds["wall"] = read_summary(summary).seconds["wall"]
    write_summary(summary, directory.name, asdict(settings), measures, seconds)
    tables.print_measures(measures, console, seconds, beside_paper=beside_paper)
    tables.print_iterations(measures, console)
    tables.print_errors(measures, console)
    if (last := lexicon_of(directory, settings.trials - 1)).exists():
        from dcg_torch.learning.lexicon import lexicon_table, load_lexicon

        console.print(lexicon_table(load_lexicon(last), f"What the words mean to the robot of trial {last.stem}"))
    shown = escape(str(directory))
    for pictures in ("figures", "animations", "screenshots"):
        if (directory / pictures).is_dir():
            console.print(f"{pictures}: {shown}/{pictures}")
    console.print(f"rows: {shown}/iterations.jsonl   curves: tensorboard --logdir {escape(str(directory.parent))}")


def refuse(message: str, directory: Path | None = None) -> int:
    """Say what is wrong, in one line; the exit status. A folder that was made for nothing goes away."""
    print(f"dcg_torch: {' '.join(message.split())}", file=sys.stderr)
    if directory is not None:
        with contextlib.suppress(OSError):
            directory.rmdir()  # only if it is empty
    return 2


def run_application(application: Callable[[], None]) -> int:
    """Run a Hydra application; the exit status: 0 done, 2 wrong input, 130 interrupted."""
    os.environ["HYDRA_FULL_ERROR"] = "1"  # errors come here as exceptions, not as Hydra's own printed report
    # Hydra would answer an option that it doesn't have with ten lines of usage.
    _, strange = get_args_parser().parse_known_args()
    if strange:
        return refuse(f"{strange[0]}: there is no such option; settings are written KEY=VALUE, without dashes")
    register()
    try:
        application()
    except CONFIG_ERRORS as error:
        return refuse(explain(error))
    except KeyboardInterrupt:
        print("dcg_torch: interrupted", file=sys.stderr)
        return 130
    return 0


def main() -> int:
    """Run the command line."""
    application = hydra.main(version_base="1.3", config_path=str(resource("conf")), config_name="config")(_application)
    return run_application(application)


if __name__ == "__main__":
    sys.exit(main())
