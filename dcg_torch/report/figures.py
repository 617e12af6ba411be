"""Figures of a run as PNG files: the paper's 6a, 6b and 7, and what they leave open.

Lines differ by marker as well as by colour. Iterations count from 1 here, as in the paper.
"""

from __future__ import annotations

import textwrap
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path

from matplotlib.figure import Figure
from matplotlib.ticker import PercentFormatter

from dcg_torch.records import Iteration, Timing
from dcg_torch.report.canvas import (
    BLUE,
    GREEN,
    GREY,
    ORANGE,
    PURPLE,
    RED,
    SKY,
    accuracy_curve,
    count_of_trials,
    draw_band,
    interval_text,
    iteration_axis,
    legend_below,
    marker_for,
    new_canvas,
    percent_axis,
    percent_text,
    rolling_note,
    rolling_sums,
    save_png,
    style_axes,
    whole_numbers,
    window_of,
    write_inside,
)
from dcg_torch.report.causes import CAUSES
from dcg_torch.report.intervals import Estimate, wilson
from dcg_torch.report.measures import KINDS, Measures, measure
from dcg_torch.report.seconds import PHASES, summarise_seconds

_SERIES = ((BLUE, "o"), (ORANGE, "s"), (GREEN, "^"), (RED, "D"), (PURPLE, "v"), (SKY, "P"), (GREY, "X"))
_KIND_STYLE = {"known": (BLUE, "o"), "unknown": (ORANGE, "s"), "learned": (GREEN, "^")}
PAPER_ACCURACY = (0.70, 0.90)
_PHASE_NAMES = {
    "load_world": "load the world",
    "parse": "parse the command",
    "perceive": "perceive (camera)",
    "ground": "ground the command",
    "explore": "explore (turn)",
    "drive": "drive",
    "train": "retrain",
}


def save_figures(rows: Sequence[Iteration], timings: Sequence[Timing], directory: Path) -> list[Path]:
    """Write all figures of a run into `directory`, made if need be, and return their paths in reading order.

    Without timings there is no figure of the time. Raises ValueError as `measure` does.
    """
    measures = measure(rows)
    drawings: dict[str, Callable[[], Figure]] = {
        "accuracy": lambda: draw_accuracy(measures),
        "symbols": lambda: draw_symbols(measures),
        "shares": lambda: draw_shares(measures),
        "errors": lambda: draw_errors(measures),
        "calibration": lambda: draw_calibration(measures),
    }
    if timings:
        drawings["time"] = lambda: draw_time(timings)
    return [save_png(draw(), directory / f"{name}.png") for name, draw in drawings.items()]


def save_comparison(runs: Mapping[str, Measures], path: Path) -> Path:
    """Write `draw_comparison` of the runs to `path`."""
    return save_png(draw_comparison(runs), path)


def draw_accuracy(measures: Measures) -> Figure:
    """Accuracy by iteration with its 95 % interval, over the paper's range (Fig. 6a, 9d)."""
    figure, axes = new_canvas(f"Right object reached ({count_of_trials(measures)})")
    x, curve, note = accuracy_curve(measures)
    axes.axhspan(*PAPER_ACCURACY, color=GREY, alpha=0.18, lw=0, label="the paper's range, 70 to 90 %")
    draw_band(axes, x, curve, BLUE, "95 % interval")
    axes.plot(x, [e.value for e in curve], color=BLUE, marker=marker_for(x, "o"), label=f"right object{note}")
    axes.axhline(
        measures.accuracy.value, color=BLUE, ls=":", lw=1.2, label=f"all commands: {interval_text(measures.accuracy)}"
    )
    percent_axis(axes, "share of trials" if measures.trials > 1 else "share of commands")
    iteration_axis(axes, measures)
    legend_below(axes)
    return figure


def draw_symbols(measures: Measures) -> Figure:
    """Right symbols after so many commands, against the number if every new type met were learned (6b, 9e)."""
    figure, axes = new_canvas(f"Words the robot has learned ({count_of_trials(measures)})")
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
    """What the target's word was to the robot, among the commands it got right (Fig. 7, 9f)."""
    figure, axes = new_canvas("Commands got right, by what their word was to the robot")
    counts = {kind: [m.kinds[kind].correct for m in measures.by_iteration] for kind in KINDS}
    totals = [m.correct for m in measures.by_iteration]
    window = window_of(measures)
    summed = rolling_sums(totals, window)
    for kind in KINDS:
        colour, marker = _KIND_STYLE[kind]
        points = [
            (m.iteration + 1, part / whole)
            for m, part, whole in zip(measures.by_iteration, rolling_sums(counts[kind], window), summed, strict=True)
            if whole
        ]
        x, y = [p[0] for p in points], [p[1] for p in points]
        axes.plot(x, y, color=colour, marker=marker_for(x, marker), label=f"{kind} word")
    if not any(totals):
        write_inside(axes, "no command was got right")
    percent_axis(axes, f"share of the right ones{rolling_note(window)}")
    iteration_axis(axes, measures)
    legend_below(axes, columns=3)
    return figure


def draw_errors(measures: Measures) -> Figure:
    """Wrong commands by cause."""
    wrong = sum(measures.causes.values())
    found = {cause: n for cause, n in measures.causes.items() if n}
    title = f"Why {wrong} of {measures.commands} commands went wrong" if found else "No command went wrong"
    figure, axes = new_canvas(title, size=(7.4, max(2.6, 1.3 + 0.55 * len(found))))
    labels = [f"{cause}\n{textwrap.fill(CAUSES[cause], 48)}" for cause in found]
    bars = axes.barh(range(len(found)), list(found.values()), color=RED, height=0.6)
    axes.bar_label(
        bars, [f"{n} ({percent_text(n / measures.commands)})" for n in found.values()], padding=3, fontsize=9
    )
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
    """Reliability diagram: how often groundings of a given probability were right."""
    calibration = measures.calibration
    error = calibration.error
    figure, axes = new_canvas("Does the robot know when it is right?", size=(5.4, 4.6))
    axes.plot([0, 1], [0, 1], color=GREY, ls="--", lw=1.2, label="perfectly calibrated")
    for b in calibration.bins:
        estimate = wilson(round(b.accuracy * b.n), b.n)
        assert estimate.low is not None
        assert estimate.high is not None
        axes.plot([b.probability] * 2, [estimate.low, estimate.high], color=BLUE, lw=1.5, zorder=2)
    if calibration.bins:
        x = [b.probability for b in calibration.bins]
        y = [b.accuracy for b in calibration.bins]
        axes.plot(x, y, color=BLUE, marker="o", lw=1.5, label="groundings, 95 % interval")
        for b in calibration.bins:
            axes.annotate(
                str(b.n), (b.probability, b.accuracy), (6, -11), textcoords="offset points", fontsize=8, color=BLUE
            )
        figure.supxlabel(
            f"Expected calibration error {error:.3f}. Numbers: groundings in each tenth."
            + (f"\nCommands without a grounding: {calibration.without}." if calibration.without else ""),
            fontsize=8,
        )
    else:
        write_inside(axes, "no grounding had a probability")
    axes.set_xlim(-0.02, 1.02)
    axes.xaxis.set_major_formatter(PercentFormatter(1.0, symbol=" %"))
    axes.set_xlabel("probability of the grounding")
    percent_axis(axes, "share that was right")
    axes.legend(loc="lower right", fontsize=9, frameon=False)
    return figure


def draw_time(timings: Sequence[Timing]) -> Figure:
    """Mean seconds of each phase of a command."""
    seconds = summarise_seconds(timings)
    total = seconds["command"]
    figure, axes = new_canvas(f"Where the time goes: {1000 * total:,.0f} ms a command", size=(6.4, 3.6))
    values = [1000 * seconds[phase] for phase in PHASES]
    bars = axes.barh(range(len(PHASES)), values, color=BLUE, height=0.6)
    shares = [f"{v:,.1f} ms ({percent_text(v / (1000 * total), 0)})" if total else "0 ms" for v in values]
    axes.bar_label(bars, shares, padding=3, fontsize=9)
    axes.set_yticks(range(len(PHASES)), [_PHASE_NAMES[phase] for phase in PHASES])
    axes.invert_yaxis()
    axes.set_xlabel(f"milliseconds a command (mean of {len(timings):,})")
    axes.grid(axis="y", visible=False)
    axes.set_xlim(0, max(values) * 1.35 if total else 1)
    return figure


def draw_comparison(runs: Mapping[str, Measures]) -> Figure:
    """Several runs in one: accuracy by iteration with intervals, and over all commands.

    Raises:
        ValueError: without runs.
    """
    if not runs:
        raise ValueError("no runs to compare")
    figure = Figure(figsize=(9.6, max(4.4, 2.6 + 0.35 * len(runs))), layout="constrained")
    left, right = figure.subplots(1, 2, width_ratios=(3, 2))
    for axes in (left, right):
        style_axes(axes)
    left.axhspan(*PAPER_ACCURACY, color=GREY, alpha=0.18, lw=0, label="the paper's range")
    # Points of different runs stand side by side, so that their intervals don't cover each other.
    span = 0.5 * (len(runs) - 1) / max(1, len(runs))
    for k, (name, measures) in enumerate(runs.items()):
        colour, marker = _SERIES[k % len(_SERIES)]
        x, curve, note = accuracy_curve(measures)
        y = [e.value for e in curve]
        if note or len(x) > 20:
            draw_band(left, x, curve, colour, "")
            left.plot(x, y, color=colour, label=name + note)
        else:
            shifted = [v + span * (k / max(1, len(runs) - 1) - 0.5) for v in x]
            left.vlines(shifted, [e.low or 0.0 for e in curve], [e.high or 0.0 for e in curve], color=colour, lw=1)
            left.plot(shifted, y, color=colour, marker=marker, ms=5, label=name)
        total = measures.accuracy
        right.barh(k, total.value, color=colour, height=0.6)
        assert total.low is not None
        assert total.high is not None
        bounds = [[total.value - total.low], [total.high - total.value]]
        right.errorbar(total.value, k, xerr=bounds, color="black", capsize=4, lw=1.2)
        right.annotate(f" {percent_text(total.value)}", (total.high, k), va="center")
    left.set_title("by command, bars: 95 % interval", fontsize=10)
    right.set_title("all commands", fontsize=10)
    percent_axis(left, "right object reached")
    iteration_axis(left, max(runs.values(), key=lambda m: m.iterations))
    right.set_yticks(range(len(runs)), list(runs))
    right.invert_yaxis()
    right.set_xlim(0, 1.25)  # room for a number beyond 100 %
    right.set_xticks([0, 0.25, 0.5, 0.75, 1])
    right.xaxis.set_major_formatter(PercentFormatter(1.0, symbol=" %"))
    right.set_xlabel("right object reached")
    right.grid(axis="y", visible=False)
    figure.suptitle("Accuracy" + _same_commands(runs), fontsize=12)
    handles, labels = left.get_legend_handles_labels()
    figure.legend(handles, labels, loc="outside lower center", ncols=min(5, len(labels)), fontsize=9, frameon=False)
    return figure


def _same_commands(runs: Mapping[str, Measures]) -> str:
    same = len({m.fingerprint for m in runs.values()}) == 1
    return " on the same worlds and commands" if same and len(runs) > 1 else ""
