"""`python -m dcg_torch.report DIR [DIR...]`: what a run, several runs, or a sweep amount to."""

from __future__ import annotations

import argparse
import sys
from collections.abc import Sequence
from pathlib import Path

from rich.console import Console

from dcg_torch.report.export import to_csv
from dcg_torch.report.runs import Run, load_runs
from dcg_torch.report.show import print_run, print_several, save_run_figures, save_several_figure
from dcg_torch.report.summary import ReportError
from dcg_torch.report.terminal import CLOSED, Output, close_output
from dcg_torch.report.text import printable
from dcg_torch.storage.arguments import Arguments
from dcg_torch.storage.atomic_files import write_whole

_FORMATS = ("png", "pdf", "svg")  # canvas.FORMATS: matplotlib is imported only where figures are asked for

_DESCRIPTION = """\
Prints what a run, several runs, or a sweep amount to.

One run: its measures with 95 % intervals (beside the paper's, if it is the paper's
experiment), by iteration, and why commands went wrong. Several: a row a run; a row a
configuration, which takes together the runs that differ in their seed alone; and the
differences between configurations on the same commands.
"""
_EPILOG = """\
  python -m dcg_torch.report runs/paper                     one run
  python -m dcg_torch.report runs/ablation --csv runs.csv   a sweep, and a row a run for pandas
  python -m dcg_torch.report runs/ablation --figures pdf    a sweep, and its figure for a paper

Exit status: 0 done, 2 for what can't be read or written; one line says what, where and how to mend it.
"""


def main(arguments: Sequence[str] | None = None) -> int:
    """Run the command line; returns the exit status."""
    if sys.stdout is None:
        return _refuse("standard output is closed; leave it open, or send it to a file")
    try:
        return _flushed(_run(arguments))
    except SystemExit as end:  # the help has been said
        raise SystemExit(_flushed(int(end.code or 0))) from None


def _flushed(status: int) -> int:
    """The exit status when all that was said has gone out, or cannot."""
    try:
        sys.stdout.flush()
    except OSError as error:
        close_output()
        if status:  # it has been said
            return status
        closed = isinstance(error, BrokenPipeError)
        return _refuse(CLOSED if closed else f"standard output: {error.strerror}; send it where there is room")
    return status


def _run(arguments: Sequence[str] | None) -> int:
    options = _parser().parse_args(arguments)
    if options.out is not None and options.figures is None:
        return _refuse("--out: there is nothing to write there; add --figures png, pdf or svg")
    try:
        runs = load_runs(options.directories)
        console = make_console()
        if len(runs) == 1:
            print_run(runs[0].measures, runs[0].seconds, runs[0].config, console)
        else:
            print_several(runs, console)
        for path in _write(runs, options):
            console.print(f"written: {path}", markup=False, highlight=False)
    except ReportError as error:
        return _refuse(str(error))
    except BrokenPipeError:
        close_output()
        return _refuse(CLOSED)
    except OSError as error:
        return _refuse(
            f"{error.filename or 'standard output'}: can't be written ({error.strerror}); give another place"
        )
    return 0


def make_console() -> Console:
    """Standard output; into a pipe or a file there is no width to keep to."""
    console = Output(highlight=False)
    return console if console.is_terminal else Output(width=max(100, console.width), highlight=False)


def _parser() -> argparse.ArgumentParser:
    parser = Arguments(
        prog="python -m dcg_torch.report",
        description=_DESCRIPTION,
        epilog=_EPILOG,
        formatter_class=argparse.RawDescriptionHelpFormatter,
    )
    parser.add_argument("directories", metavar="DIR", nargs="+", type=Path, help="a run folder, or one with runs below")
    parser.add_argument("--csv", metavar="FILE", type=Path, help="also write a row a run into this CSV file")
    parser.add_argument(
        "--figures", choices=_FORMATS, help="also draw: one run's figures, or the comparison of several"
    )
    parser.add_argument(
        "--out",
        metavar="FOLDER",
        type=Path,
        help="where the figures go; default: DIR/figures of one run, DIR of a sweep",
    )
    return parser


def _write(runs: Sequence[Run], options: argparse.Namespace) -> list[Path]:
    written = []
    if options.csv is not None:
        write_whole(options.csv, to_csv(runs))
        written.append(options.csv)
    if options.figures is not None and len(runs) == 1:
        written += save_run_figures(runs[0], options.out or runs[0].folder / "figures", options.figures)
    elif options.figures is not None:
        written.append(save_several_figure(runs, options.out or options.directories[0], options.figures))
    return written


def _refuse(message: str) -> int:
    """Say what is wrong in one line without escapes; the exit status."""
    print(f"dcg_torch: {printable(message)}", file=sys.stderr)
    return 2


if __name__ == "__main__":
    sys.exit(main())
