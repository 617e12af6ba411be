"""Figures of a run: the paper's 6a, 6b and 7, and what they leave open.

Lines differ by marker as well as by colour. Iterations count from 1 here, as in the paper.
"""

from __future__ import annotations

import math
import textwrap
from collections.abc import Callable, Sequence
from pathlib import Path

from matplotlib.figure import Figure
from matplotlib.ticker import PercentFormatter

from dcg_torch.report import paper
from dcg_torch.report.calibration import Calibration
from dcg_torch.report.canvas import (
    BLUE,
    GREEN,
    GREY,
    ORANGE,
    RED,
    accuracy_curve,
    draw_band,
    draw_interval,
    iteration_axis,
    legend_below,
    marker_for,
    new_canvas,
    percent_axis,
    rolling_sums,
    save_figure,
    whole_numbers,
    window_of,
    write_inside,
)
from dcg_torch.report.causes import CAUSES
from dcg_torch.report.intervals import Estimate, wilson
from dcg_torch.report.measures import KINDS, Measures, measure
from dcg_torch.report.seconds import PHASES, summarise_seconds
from dcg_torch.report.text import counted, percent, percent_interval
from dcg_torch.storage.records import Iteration, Timing

_KIND_STYLE = {"known": (BLUE, "o"), "unknown": (ORANGE, "s"), "learned": (GREEN, "^")}
_ENOUGH = 20  # right commands that a point of the shares is to rest on
_PHASE_NAMES = {
    "load_world": "load the world",
    "parse": "parse the command",
    "perceive": "perceive (camera)",
    "ground": "ground the command",
    "explore": "explore (turn)",
    "drive": "drive",
    "train": "retrain",
}


def save_figures(
    rows: Sequence[Iteration],
    timings: Sequence[Timing],
    directory: Path,
    *,
    beside_paper: bool,
    form: str = "png",
) -> list[Path]:
    """Write all figures of a run into `directory`, made if need be, and return their paths in reading order.

    Args:
        rows: as for `measure`.
        timings: the wall-clock times; without them there is no figure of the time.
        directory: where to.
        beside_paper: draw the paper's range of accuracy; for runs that `paper.follows_paper`.
        form: one of `canvas.FORMATS`.

    Raises:
        ValueError: as `measure` and `save_figure` do.
        OSError: if a file can't be written.
    """
    measures = measure(rows)
    drawings: dict[str, Callable[[], Figure]] = {
        "accuracy": lambda: draw_accuracy(measures, beside_paper=beside_paper),
        "symbols": lambda: draw_symbols(measures),
        "shares": lambda: draw_shares(measures),
        "errors": lambda: draw_errors(measures),
        "calibration": lambda: draw_calibration(measures),
    }
    if timings:
        drawings["time"] = lambda: draw_time(timings)
    return [save_figure(draw(), directory / f"{name}.{form}") for name, draw in drawings.items()]


def draw_accuracy(measures: Measures, *, beside_paper: bool) -> Figure:
    """Accuracy by iteration with its 95 % interval (Fig. 6a, 9d), over the paper's range if that is asked for."""
    figure, axes = new_canvas(f"Right object reached ({counted(measures.trials, 'trial')})")
    x, curve, note = accuracy_curve(measures)
    if beside_paper:
        axes.axhspan(*paper.ACCURACY, color=GREY, alpha=0.18, lw=0, label="the paper's range, 70 to 90 %")
    draw_band(axes, x, curve, BLUE, "95 % interval")
    axes.plot(x, [e.value for e in curve], color=BLUE, marker=marker_for(x, "o"), label=f"right object{note}")
    axes.axhline(
        measures.accuracy.value,
        color=BLUE,
        ls=":",
        lw=1.2,
        label=f"all commands: {percent_interval(measures.accuracy)}",
    )
    percent_axis(axes, "share of trials" if measures.trials > 1 else "share of commands")
    iteration_axis(axes, measures)
    legend_below(axes)
    return figure


def draw_symbols(measures: Measures) -> Figure:
    """Right symbols after so many commands, against the number if every new type met were learned (6b, 9e)."""
    figure, axes = new_canvas(f"Words the robot has learned ({counted(measures.trials, 'trial')})")
    heard = [0, *(m.iteration + 1 for m in measures.by_iteration)]
    right = [Estimate(measures.initial_symbols), *(m.correct_symbols for m in measures.by_iteration)]
    expected = [measures.initial_symbols, *(m.expected_symbols for m in measures.by_iteration)]
    wrong = [0.0, *(m.wrong_symbols for m in measures.by_iteration)]
    axes.axhline(len(measures.types), color=GREY, ls=":", lw=1.2, label=f"all types: {len(measures.types)}")
    draw_band(axes, heard, right, BLUE, "95 % interval")
    axes.plot(heard, [e.value for e in right], color=BLUE, marker=marker_for(heard, "o"), label="types named rightly")
    axes.plot(heard, expected, color=RED, ls="--", marker=marker_for(heard, "s"), ms=4, label="if all met were learned")
    axes.plot(heard, wrong, color=ORANGE, marker=marker_for(heard, "X"), label="words held wrongly")
    axes.set_ylabel("number, mean over trials" if measures.trials > 1 else "number")
    axes.set_xlabel("commands heard")
    axes.xaxis.set_major_locator(whole_numbers())
    axes.margins(x=0.02)
    axes.set_ylim(-0.02 * len(measures.types), len(measures.types) * 1.06)
    legend_below(axes)
    return figure


def draw_shares(measures: Measures) -> Figure:
    """What the target's word was to the robot, among the commands it got right (Fig. 7, 9f), with 95 % intervals.

    A point takes in neighbouring iterations until it rests on about twenty right commands, so that a short run shows
    shares and not the noise of two or three commands.
    """
    figure, axes = new_canvas("Commands got right, by what their word was to the robot")
    totals = [m.correct for m in measures.by_iteration]
    window = _shares_window(measures)
    summed = rolling_sums(totals, window)
    for kind in KINDS:
        colour, marker = _KIND_STYLE[kind]
        counts = rolling_sums([m.kinds[kind].correct for m in measures.by_iteration], window)
        points = [
            (m.iteration + 1, wilson(part, whole))
            for m, part, whole in zip(measures.by_iteration, counts, summed, strict=True)
            if whole
        ]
        x, curve = [p[0] for p in points], [p[1] for p in points]
        draw_band(axes, x, curve, colour, "")
        axes.plot(x, [e.value for e in curve], color=colour, marker=marker_for(x, marker), label=f"{kind} word")
    if not any(totals):
        write_inside(axes, "no command was got right")
    percent_axis(axes, "share of the right ones")
    iteration_axis(axes, measures)
    legend_below(axes, columns=3)
    each = f"; a point: mean of up to {window} iterations" if window > 1 else ""
    figure.supxlabel(f"{counted(sum(totals), 'right command')}{each}; bands: 95 % intervals", fontsize=8)
    return figure


def _shares_window(measures: Measures) -> int:
    """Iterations (odd) that hold about `_ENOUGH` right commands, and no fewer than any long run's curve takes."""
    each = measures.correct / len(measures.by_iteration)
    needed = math.ceil(_ENOUGH / each) if each else 1
    return max(window_of(measures), min(needed, 2 * len(measures.by_iteration) - 1) | 1)


def draw_errors(measures: Measures) -> Figure:
    """Wrong commands by cause."""
    wrong = sum(measures.causes.values())
    found = {cause: n for cause, n in measures.causes.items() if n}
    title = f"Why {wrong} of {measures.commands} commands went wrong" if found else "No command went wrong"
    figure, axes = new_canvas(title, size=(7.4, max(2.6, 1.3 + 0.55 * len(found))))
    labels = [f"{cause}\n{textwrap.fill(CAUSES[cause], 48)}" for cause in found]
    bars = axes.barh(range(len(found)), list(found.values()), color=RED, height=0.6)
    axes.bar_label(bars, [f"{n} ({percent(n / measures.commands)})" for n in found.values()], padding=3, fontsize=9)
    axes.set_yticks(range(len(found)), labels, fontsize=8)
    axes.set_xlabel("commands (share of all)")
    axes.xaxis.set_major_locator(whole_numbers(6))
    axes.set_ylim(max(2, len(found)) - 0.5, -0.5)
    axes.grid(axis="y", visible=False)
    axes.margins(x=0.22)
    if not found:
        axes.set_xlim(0, 1)
    return figure


def draw_calibration(measures: Measures) -> Figure:
    """Reliability diagram: how often groundings of a given probability were right.

    The area of a point goes with its groundings; below stands what of the error chance alone would make.
    """
    calibration = measures.calibration
    figure, axes = new_canvas("Does the robot know when it is right?", size=(5.4, 4.8))
    axes.plot([0, 1], [0, 1], color=GREY, ls="--", lw=1.2, label="perfectly calibrated")
    for k, b in enumerate(calibration.bins):
        estimate = wilson(round(b.accuracy * b.n), b.n)
        label = "groundings in each tenth, 95 % interval" if k == 0 else None
        draw_interval(axes, b.probability, estimate, BLUE)
        size = 15 + 285 * b.n / calibration.n
        axes.scatter([b.probability], [b.accuracy], s=size, color=BLUE, zorder=3, label=label)
        axes.annotate(str(b.n), (b.probability, b.accuracy), (9, -12), textcoords="offset points", fontsize=8)
    if not calibration.bins:
        write_inside(axes, "no grounding had a probability")
    figure.supxlabel(_calibration_note(calibration), fontsize=8)
    axes.set_xlim(-0.04, 1.04)
    axes.xaxis.set_major_formatter(PercentFormatter(1.0, symbol=" %"))
    axes.set_xlabel("probability of the grounding")
    percent_axis(axes, "share that was right")
    axes.set_ylim(-0.04, 1.04)
    axes.legend(loc="upper left", fontsize=8, frameon=False, markerscale=0.6)
    return figure


def _calibration_note(calibration: Calibration) -> str:
    lines = []
    if calibration.error is not None and calibration.chance is not None:
        shows = "more than chance explains" if calibration.error > calibration.chance else "which chance may explain"
        lines.append(
            f"Calibration error {calibration.error:.3f} over {counted(calibration.n, 'grounding')}, {shows}:\n"
            f"a calibrated robot's stays below {calibration.chance:.3f} in 95 % of runs of this length."
        )
    if calibration.without:
        lines.append(f"Without a grounding: {counted(calibration.without, 'command')}.")
    return "\n".join(lines)


def draw_time(timings: Sequence[Timing]) -> Figure:
    """Mean seconds of each phase of a command."""
    seconds = summarise_seconds(timings)
    total = seconds["command"]
    figure, axes = new_canvas(f"Where the time goes: {1000 * total:,.0f} ms a command", size=(6.4, 3.6))
    values = [1000 * seconds[phase] for phase in PHASES]
    bars = axes.barh(range(len(PHASES)), values, color=BLUE, height=0.6)
    shares = [f"{v:,.1f} ms ({percent(v / (1000 * total), 0)})" if total else "0 ms" for v in values]
    axes.bar_label(bars, shares, padding=3, fontsize=9)
    axes.set_yticks(range(len(PHASES)), [_PHASE_NAMES[phase] for phase in PHASES])
    axes.invert_yaxis()
    axes.set_xlabel(f"milliseconds a command (mean of {len(timings):,})")
    axes.grid(axis="y", visible=False)
    axes.set_xlim(0, max(values) * 1.35 if total else 1)
    return figure
