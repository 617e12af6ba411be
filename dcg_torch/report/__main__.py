"""`python -m dcg_torch.report DIR [DIR...]`: the tables of a run, of several, or of a sweep.

A folder with a `summary.json` is a run; one with several below it is a sweep. Exit status: 0 done, 2 for a folder
that can't be read, with one line that says why.
"""

from __future__ import annotations

import argparse
import sys
from collections.abc import Sequence
from pathlib import Path

from rich.console import Console

from dcg_torch.report.measures import Measures
from dcg_torch.report.summary import ReportError, Summary, find_runs, load_run
from dcg_torch.report.tables import print_comparison, print_errors, print_iterations, print_paper_table, tabulate_runs


def main(arguments: Sequence[str] | None = None) -> int:
    """Run the command line; returns the exit status."""
    parser = argparse.ArgumentParser(
        prog="python -m dcg_torch.report", description="Print what a run, several runs or a sweep amount to."
    )
    parser.add_argument("directories", metavar="DIR", nargs="+", type=Path, help="a run folder, or one with runs below")
    parser.add_argument("--compare", metavar="FILE", type=Path, help="also draw several runs into this PNG file")
    options = parser.parse_args(arguments)
    try:
        runs = _load(options.directories)
    except ReportError as error:
        print(f"error: {error}", file=sys.stderr)
        return 2
    console = Console()
    # Into a pipe or a file there is no width to keep to.
    if not console.is_terminal:
        console = Console(width=max(140, console.width))
    if len(runs) == 1:
        summary = next(iter(runs.values()))
        print_paper_table(summary.measures, console, summary.seconds)
        print_iterations(summary.measures, console)
        print_errors(summary.measures, console)
    else:
        console.print(tabulate_runs(runs, ", ".join(map(str, options.directories))))
        print_comparison(_named(runs), console)
    if options.compare is not None:
        from dcg_torch.report.figures import save_comparison  # matplotlib only where it is needed

        try:
            console.print(str(save_comparison(_named(runs), options.compare)))
        except (OSError, ValueError) as error:
            print(f"error: {options.compare}: can't be written ({error}); give a PNG file to write", file=sys.stderr)
            return 2
    return 0


def _load(directories: Sequence[Path]) -> dict[Path, Summary]:
    folders: dict[Path, None] = {}
    for directory in directories:
        folders |= dict.fromkeys(find_runs(directory) or [directory])
    return {folder: load_run(folder) for folder in folders}


def _named(runs: dict[Path, Summary]) -> dict[str, Measures]:
    """By the run's name, or by folder where names repeat."""
    names = [summary.run for summary in runs.values()]
    unique = len(set(names)) == len(names)
    return {summary.run if unique else str(folder): summary.measures for folder, summary in runs.items()}


if __name__ == "__main__":
    sys.exit(main())
