"""What the figures have in common: canvas, axes, intervals, rolling means, and numbers as text.

Figures are made on `Figure` objects, without pyplot and its global state. Colours are Okabe and Ito's, told apart with
any colour vision.
"""

from __future__ import annotations

import io
from collections.abc import Sequence
from pathlib import Path
from typing import Final

import matplotlib as mpl
import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import MaxNLocator, PercentFormatter

from dcg_torch.report.intervals import Estimate, wilson
from dcg_torch.report.measures import Measures
from dcg_torch.storage.atomic_files import write_whole

BLUE, ORANGE, GREEN, RED, PURPLE, SKY, GREY = (
    "#0072B2",
    "#E69F00",
    "#009E73",
    "#D55E00",
    "#CC79A7",
    "#56B4E9",
    "#666666",
)
FORMATS: Final = ("png", "pdf", "svg")
LONG = 50  # iterations from which on curves are rolling means
DPI = 150
_UNDATED: Final = {"png": {}, "pdf": {"CreationDate": None}, "svg": {"Date": None}}


def new_canvas(title: str, size: tuple[float, float] = (6.0, 4.2)) -> tuple[Figure, Axes]:
    """A figure with one styled axes and a title; `size` in inches."""
    figure = Figure(figsize=size, layout="constrained")
    figure.suptitle(title, fontsize=12)
    axes = figure.add_subplot()
    style_axes(axes)
    return figure, axes


def warm_up() -> None:
    """Draw a figure for nobody: the first of a process loads fonts and the like, and takes twice as long as others."""
    figure, _ = new_canvas("0")
    figure.savefig(io.BytesIO(), format="png", dpi=DPI)


def style_axes(axes: Axes) -> None:
    """Light grid, no box."""
    axes.grid(visible=True, color="#DDDDDD", lw=0.7)
    axes.set_axisbelow(True)
    axes.spines[["top", "right"]].set_visible(False)


def save_figure(figure: Figure, path: Path) -> Path:
    """Write the figure whole, in the format of the path's suffix, making its folder, and return the path.

    The file holds no date: the same figure gives the same bytes.

    Raises:
        ValueError: if the suffix is none of `FORMATS`.
        OSError: if the file can't be written.
    """
    form = path.suffix.removeprefix(".")
    if form not in FORMATS:
        raise ValueError(f"{path}: figures are written as {', '.join(FORMATS)}")
    drawn = io.BytesIO()
    # Text stays text in a PDF, and an SVG's ids don't change from run to run.
    with mpl.rc_context({"pdf.fonttype": 42, "svg.hashsalt": "dcg_torch"}):
        figure.savefig(drawn, format=form, dpi=DPI, metadata=_UNDATED[form])
    write_whole(path, drawn.getvalue())
    return path


def accuracy_curve(measures: Measures) -> tuple[list[int], list[Estimate], str]:
    """Iterations from 1, accuracy at each (or over a window of a long run), and a note for the legend."""
    window = window_of(measures)
    x = [m.iteration + 1 for m in measures.by_iteration]
    correct = rolling_sums([m.correct for m in measures.by_iteration], window)
    n = rolling_sums([m.n for m in measures.by_iteration], window)
    return x, [wilson(c, k) for c, k in zip(correct, n, strict=True)], rolling_note(window)


def window_of(measures: Measures) -> int:
    """Iterations that a point of a curve covers: one, or a twentieth of a long run's (odd)."""
    return 1 if measures.iterations < LONG else max(5, measures.iterations // 20) | 1


def rolling_note(window: int) -> str:
    """For the legend: over how many iterations a point is a mean."""
    return f" (mean of {window})" if window > 1 else ""


def rolling_sums(counts: Sequence[int], window: int) -> list[int]:
    """Sums over a centred window, which is cut at the ends."""
    half = window // 2
    total = np.concatenate([[0], np.cumsum(counts)])
    return [int(total[min(len(counts), i + half + 1)] - total[max(0, i - half)]) for i in range(len(counts))]


def draw_band(axes: Axes, x: Sequence[int], curve: Sequence[Estimate], colour: str, label: str) -> None:
    """Shade the 95 % intervals, where there are any."""
    bounded = [(a, e.low, e.high) for a, e in zip(x, curve, strict=True) if e.low is not None and e.high is not None]
    if not bounded:
        return
    where, low, high = (list(column) for column in zip(*bounded, strict=True))
    if len(bounded) == 1:  # an area over a single point would not be seen
        axes.vlines(where, low, high, color=colour, alpha=0.4, lw=4, label=label)
    else:
        axes.fill_between(where, low, high, color=colour, alpha=0.18, lw=0, label=label)


def draw_interval(axes: Axes, x: float, estimate: Estimate, colour: str) -> None:
    """A vertical line over the 95 % interval of one point, where there is one."""
    if estimate.low is not None and estimate.high is not None:
        axes.plot([x, x], [estimate.low, estimate.high], color=colour, lw=1.5, zorder=2)


def marker_for(x: Sequence[float], marker: str) -> str:
    """Markers for curves of few points only."""
    return marker if len(x) <= 30 else ""


def percent_axis(axes: Axes, label: str) -> None:
    """A vertical axis from 0 to 100 %."""
    axes.set_ylim(-0.02, 1.02)
    axes.yaxis.set_major_formatter(PercentFormatter(1.0, symbol=" %"))
    axes.set_ylabel(label)


def iteration_axis(axes: Axes, measures: Measures) -> None:
    """A horizontal axis of iterations, counted from 1."""
    axes.set_xlabel("command of the trial (iteration)")
    axes.xaxis.set_major_locator(whole_numbers())
    first, last = (m.iteration + 1 for m in (measures.by_iteration[0], measures.by_iteration[-1]))
    axes.set_xlim(first - 0.5, last + 0.5)


def legend_below(axes: Axes, columns: int = 2) -> None:
    """A legend under the axes."""
    axes.legend(loc="upper center", bbox_to_anchor=(0.5, -0.17), ncols=columns, fontsize=9, frameon=False)


def write_inside(axes: Axes, text: str) -> None:
    """Say what is missing, in the middle of the axes."""
    axes.text(0.5, 0.5, text, transform=axes.transAxes, ha="center", va="center", color=GREY)


def whole_numbers(bins: int = 10) -> MaxNLocator:
    """Ticks at whole numbers only."""
    return MaxNLocator(nbins=bins, integer=True, min_n_ticks=1)
