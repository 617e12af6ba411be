"""What a run and what a sweep print and draw: the tables and figures that belong together."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

from rich.console import Console

from dcg_torch.report.comparison_tables import print_configurations, print_differences, print_runs
from dcg_torch.report.configurations import configurations
from dcg_torch.report.measures import Measures
from dcg_torch.report.paper import follows_paper
from dcg_torch.report.runs import Run, read_timings
from dcg_torch.report.tables import print_errors, print_iterations, print_measures


def print_run(measures: Measures, seconds: Mapping[str, float], config: Mapping[str, Any], console: Console) -> None:
    """The tables of one run of these settings."""
    print_measures(measures, console, seconds, beside_paper=follows_paper(config))
    print_iterations(measures, console)
    print_errors(measures, console)


def print_several(runs: Sequence[Run], console: Console) -> None:
    """The tables of several runs: a row a run, a row a configuration, paired differences."""
    found = configurations(runs)
    if len(found) < len(runs) or len(runs) == 1:
        print_runs(runs, console)
    print_configurations(found, console)
    print_differences(found, console)


def save_run_figures(run: Run, directory: Path, form: str = "png") -> list[Path]:
    """Write the figures of one run; their paths.

    Raises:
        ReportError: if its times are damaged.
        OSError: if a file can't be written.
    """
    from dcg_torch.report.figures import save_figures  # matplotlib only where it is needed

    return save_figures(
        run.rows, read_timings(run.folder), directory, beside_paper=follows_paper(run.config), form=form
    )


def save_several_figure(runs: Sequence[Run], directory: Path, form: str = "png") -> Path:
    """Write `comparison.png` (or pdf, svg) of several runs; its path.

    Raises:
        OSError: if the file can't be written.
    """
    from dcg_torch.report.canvas import save_figure
    from dcg_torch.report.comparison import draw_comparison

    return save_figure(draw_comparison(configurations(runs)), directory / f"comparison.{form}")
