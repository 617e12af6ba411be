"""The figure of several configurations: one curve with its band for each, and all commands with the single seeds."""

from __future__ import annotations

import textwrap
from collections.abc import Sequence

from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.ticker import PercentFormatter

from dcg_torch.report import paper
from dcg_torch.report.canvas import (
    BLUE,
    GREEN,
    GREY,
    ORANGE,
    PURPLE,
    RED,
    SKY,
    accuracy_curve,
    draw_band,
    iteration_axis,
    marker_for,
    percent_axis,
    style_axes,
)
from dcg_torch.report.configurations import Configuration
from dcg_torch.report.text import percent

_COLOURS = (BLUE, ORANGE, GREEN, RED, PURPLE, SKY, GREY)
_MARKERS = "os^DvPX"
_DASHES = ("-", "--", "-.", ":")
_BANDS = 5  # with more curves the bands would hide one another; the intervals on the right remain
_NAME_WIDTH = 34  # characters of a line of a name


def draw_comparison(found: Sequence[Configuration]) -> Figure:
    """Accuracy by iteration and over all commands, of configurations measured over all their seeds.

    The names on the right, beside bars of the curves' colours and markers, are the legend. The paper's range is drawn
    where every run follows its protocol.

    Raises:
        ValueError: without configurations.
    """
    if not found:
        raise ValueError("no runs to compare")
    names = [textwrap.fill(c.name, _NAME_WIDTH, break_on_hyphens=False) for c in found]
    lines = sum(max(1.6, 1 + name.count("\n")) for name in names)
    figure = Figure(figsize=(10.4, max(4.4, 1.4 + 0.24 * lines)), layout="constrained")
    left, right = figure.subplots(1, 2, width_ratios=(5, 4))
    for axes in (left, right):
        style_axes(axes)
    notes = ["by command" + max((accuracy_curve(c.measures)[2] for c in found), key=len)]
    if len(found) <= _BANDS:
        notes.append("bands: 95 % intervals")
    if all(paper.follows_paper(run.config) for c in found for run in c.runs):
        left.axhspan(*paper.ACCURACY, color=GREY, alpha=0.18, lw=0)
        notes.append("grey: the paper's range")
    for k, configuration in enumerate(found):
        _draw_curve(left, configuration, k, banded=len(found) <= _BANDS)
        _draw_bar(right, configuration, k)
    left.set_title("; ".join(notes), fontsize=10)
    percent_axis(left, "right object reached")
    iteration_axis(left, max((c.measures for c in found), key=lambda m: m.iterations))
    _finish_bars(right, names)
    figure.suptitle("Accuracy", fontsize=12)
    return figure


def _style(k: int) -> tuple[str, str, str]:
    """Colour, marker and dashes of the k-th configuration; 28 differ in at least two of them."""
    return _COLOURS[k % 7], _MARKERS[k % 7], _DASHES[(k + 2 * (k // 7)) % 4]


def _draw_curve(axes: Axes, configuration: Configuration, k: int, *, banded: bool) -> None:
    colour, marker, dashes = _style(k)
    x, curve, _ = accuracy_curve(configuration.measures)
    if banded:
        draw_band(axes, x, curve, colour, "")
    # Curves that coincide stay visible: a later one is thinner, and dashed otherwise.
    width = max(1.0, 2.6 - 0.4 * k)
    y = [e.value for e in curve]
    axes.plot(
        x,
        y,
        color=colour,
        ls=dashes,
        lw=width,
        marker=marker_for(x, marker),
        ms=5,
        clip_on=False,
        label=configuration.name,
    )


def _draw_bar(axes: Axes, configuration: Configuration, k: int) -> None:
    colour, marker, dashes = _style(k)
    total = configuration.measures.accuracy
    axes.barh(k, total.value, color=colour, height=0.62, alpha=0.55)
    low, high = total.low or 0.0, 1.0 if total.high is None else total.high
    axes.errorbar(total.value, k, xerr=[[total.value - low], [high - total.value]], color="black", capsize=4, lw=1.2)
    if len(configuration.runs) > 1:
        seeds = configuration.by_seed
        axes.plot(seeds, [k] * len(seeds), ls="", marker="|", ms=9, color="black", alpha=0.6, clip_on=False)
    axes.annotate(percent(total.value), (1.06, k), va="center", fontsize=9, annotation_clip=False)
    # The key to the curves: marker and dashes at the foot of the bar.
    axes.add_line(
        Line2D([-0.13, -0.07, -0.01], [k] * 3, color=colour, marker=marker, ls=dashes, markevery=[1], clip_on=False)
    )


def _finish_bars(axes: Axes, names: Sequence[str]) -> None:
    axes.set_title("all commands; ticks: single seeds", fontsize=10)
    axes.set_yticks(range(len(names)), names, fontsize=9, parse_math=False)  # a name may hold dollar signs
    axes.tick_params(axis="y", length=0)
    axes.set_ylim(len(names) - 0.4, -0.6)
    axes.set_xlim(-0.15, 1.24)
    axes.set_xticks([0, 0.25, 0.5, 0.75, 1])
    axes.xaxis.set_major_formatter(PercentFormatter(1.0, symbol=" %"))
    axes.set_xlabel("right object reached, 95 % interval")
    axes.grid(axis="y", visible=False)
    axes.spines["left"].set_visible(False)
