"""`python -m dcg_torch.report.trade_off DIR [DIR...] --out FILE`: accuracy against questions asked.

Every run is a point; runs that differ in `model.open_world.ask_below` alone make up the threshold's curve.
Exit status: 0 done, 2 for what can't be read or written.
"""

from __future__ import annotations

import sys
from collections.abc import Mapping, Sequence
from pathlib import Path

from matplotlib.figure import Figure

from dcg_torch.report.canvas import BLUE, GREY, new_canvas, percent_axis, save_figure
from dcg_torch.report.measures import Measures
from dcg_torch.report.runs import Run, load_runs
from dcg_torch.report.summary import ReportError, flatten
from dcg_torch.report.text import printable
from dcg_torch.storage.arguments import Arguments

WANTED = (0.15, 0.99)
"""At most so many questions a command, at least so accurate: the goal that is drawn."""


def draw_trade_off(runs: Mapping[float, Measures]) -> Figure:
    """Accuracy with its interval against questions a command, by the threshold below which the robot asks.

    Args:
        runs: threshold -> measures; 0 stands for never asking.

    Raises:
        ValueError: without runs.
    """
    if not runs:
        raise ValueError("no runs to draw")
    figure, axes = new_canvas("What asking buys")
    ordered = sorted(runs.items())
    x = [m.asked for _, m in ordered]
    y = [m.accuracy.value for _, m in ordered]
    axes.plot(x, y, color=BLUE, marker="o", lw=1.2, label="threshold of the probability, interval of 95 %")
    names: dict[tuple[float, float], list[str]] = {}
    for threshold, m in ordered:
        axes.vlines(m.asked, m.accuracy.low or 0.0, m.accuracy.high or 1.0, color=BLUE, lw=1.2)
        names.setdefault((m.asked, m.accuracy.value), []).append(f"{threshold:g}" if threshold else "never")
    for point, alike in names.items():
        axes.annotate(", ".join(alike), point, (4, -11), textcoords="offset points", fontsize=8)
    axes.axvline(WANTED[0], color=GREY, ls=":", lw=1.2)
    axes.axhline(WANTED[1], color=GREY, ls=":", lw=1.2, label=f"goal: {WANTED[1]:g} at {WANTED[0]:g} questions")
    percent_axis(axes, "right object reached")
    axes.set_ylim(min(0.9, *(m.accuracy.low or 0.0 for _, m in ordered)) - 0.02, 1.005)
    axes.set_xlabel("questions a command")
    axes.set_xlim(left=-0.005)
    axes.legend(loc="lower right", fontsize=9, frameon=False)
    return figure


def main(arguments: Sequence[str] | None = None) -> int:
    """Run the command line; returns the exit status."""
    parser = Arguments(
        prog="python -m dcg_torch.report.trade_off", description="Draw accuracy against questions asked."
    )
    parser.add_argument("directories", metavar="DIR", nargs="+", type=Path, help="a run folder, or one with runs below")
    parser.add_argument("--out", metavar="FILE", type=Path, required=True, help="the PNG, PDF or SVG file to write")
    options = parser.parse_args(arguments)
    try:
        runs = {_threshold(run): run.measures for run in load_runs(options.directories)}
        print(save_figure(draw_trade_off(runs), options.out))
    except (ValueError, OSError) as error:  # a ReportError is a ValueError
        print(f"dcg_torch: {printable(str(error))}", file=sys.stderr)
        return 2
    return 0


def _threshold(run: Run) -> float:
    """The probability below which a run's robot asked; 0 where it never did."""
    if run.config.get("asking") != "when_unsure":
        return 0.0
    threshold = flatten(run.config).get("model.open_world.ask_below")
    if not isinstance(threshold, int | float):
        raise ReportError(f"{run.folder}: its settings don't say model.open_world.ask_below; run the experiment again")
    return float(threshold)


if __name__ == "__main__":
    sys.exit(main())
