"""Figures of a run as PNG files: the paper's 6a, 6b and 7, and what they leave open.

Drawn on `Figure` objects, without pyplot and its global state. Colours are Okabe and Ito's, told apart with any
colour vision; lines also differ by marker. Iterations count from 1 here, as in the paper.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from pathlib import Path

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import MaxNLocator, PercentFormatter

from dcg_torch.records import Iteration, Timing
from dcg_torch.report.causes import CAUSES
from dcg_torch.report.intervals import Estimate, wilson
from dcg_torch.report.measures import KINDS, Measures, measure
from dcg_torch.report.seconds import PHASES, summarise_seconds

BLUE, ORANGE, GREEN, RED, PURPLE, SKY, GREY = (
    "#0072B2",
    "#E69F00",
    "#009E73",
    "#D55E00",
    "#CC79A7",
    "#56B4E9",
    "#666666",
)
_SERIES = ((BLUE, "o"), (ORANGE, "s"), (GREEN, "^"), (RED, "D"), (PURPLE, "v"), (SKY, "P"), (GREY, "X"))
_KIND_STYLE = {"known": (BLUE, "o"), "unknown": (ORANGE, "s"), "learned": (GREEN, "^")}
PAPER_ACCURACY = (0.70, 0.90)
LONG = 50  # iterations from which on curves are rolling means
DPI = 150
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
    return [_save(draw(), directory / f"{name}.png") for name, draw in drawings.items()]


def save_comparison(runs: Mapping[str, Measures], path: Path) -> Path:
    """Write `draw_comparison` of the runs to `path`."""
    return _save(draw_comparison(runs), path)


def draw_accuracy(measures: Measures) -> Figure:
    """Accuracy by iteration with its 95 % interval, over the paper's range (Fig. 6a, 9d)."""
    figure, axes = _canvas(f"Right object reached ({_trials(measures)})")
    x, curve, note = _accuracy_curve(measures)
    axes.axhspan(*PAPER_ACCURACY, color=GREY, alpha=0.18, lw=0, label="the paper's range, 70 to 90 %")
    _band(axes, x, curve, BLUE, "95 % interval")
    axes.plot(x, [e.value for e in curve], color=BLUE, marker=_marker(x, "o"), label=f"right object{note}")
    axes.axhline(
        measures.accuracy.value, color=BLUE, ls=":", lw=1.2, label=f"all commands: {_interval(measures.accuracy)}"
    )
    _percent_axis(axes, "share of trials" if measures.trials > 1 else "share of commands")
    _iteration_axis(axes, measures)
    _legend(axes)
    return figure


def draw_symbols(measures: Measures) -> Figure:
    """Right symbols after so many commands, against the number if every new type met were learned (6b, 9e)."""
    figure, axes = _canvas(f"Words the robot has learned ({_trials(measures)})")
    heard = [0, *(m.iteration + 1 for m in measures.by_iteration)]
    right = [Estimate(measures.initial_symbols), *(m.correct_symbols for m in measures.by_iteration)]
    expected = [measures.initial_symbols, *(m.expected_symbols for m in measures.by_iteration)]
    wrong = [0.0, *(m.wrong_symbols for m in measures.by_iteration)]
    axes.axhline(len(measures.types), color=GREY, ls=":", lw=1.2, label=f"all types: {len(measures.types)}")
    _band(axes, heard, right, BLUE, "95 % interval")
    axes.plot(heard, [e.value for e in right], color=BLUE, marker=_marker(heard, "o"), label="types named rightly")
    axes.plot(heard, expected, color=RED, ls="--", marker=_marker(heard, "s"), ms=4, label="if all met were learned")
    axes.plot(heard, wrong, color=ORANGE, marker=_marker(heard, "X"), label="words held wrongly")
    axes.set_ylabel("number, mean over trials" if measures.trials > 1 else "number")
    axes.set_xlabel("commands heard")
    axes.xaxis.set_major_locator(_whole_numbers())
    axes.margins(x=0.02)
    axes.set_ylim(-0.02 * len(measures.types), len(measures.types) * 1.06)
    _legend(axes)
    return figure


def draw_shares(measures: Measures) -> Figure:
    """What the target's word was to the robot, among the commands it got right (Fig. 7, 9f)."""
    figure, axes = _canvas("Commands got right, by what their word was to the robot")
    counts = {kind: [m.kinds[kind].correct for m in measures.by_iteration] for kind in KINDS}
    totals = [m.correct for m in measures.by_iteration]
    window = _window(measures)
    summed = _rolling(totals, window)
    for kind in KINDS:
        colour, marker = _KIND_STYLE[kind]
        points = [
            (m.iteration + 1, part / whole)
            for m, part, whole in zip(measures.by_iteration, _rolling(counts[kind], window), summed, strict=True)
            if whole
        ]
        x, y = [p[0] for p in points], [p[1] for p in points]
        axes.plot(x, y, color=colour, marker=_marker(x, marker), label=f"{kind} word{_rolling_note(window)}")
    if not any(totals):
        _say(axes, "no command was got right")
    _percent_axis(axes, "share of the right ones")
    _iteration_axis(axes, measures)
    _legend(axes, columns=3)
    return figure


def draw_errors(measures: Measures) -> Figure:
    """Wrong commands by cause."""
    wrong = sum(measures.causes.values())
    found = {cause: n for cause, n in measures.causes.items() if n}
    title = f"Why {wrong} of {measures.commands} commands went wrong" if found else "No command went wrong"
    figure, axes = _canvas(title, size=(7.4, max(2.6, 1.3 + 0.55 * len(found))))
    labels = [f"{cause}\n{_wrapped(CAUSES[cause])}" for cause in found]
    bars = axes.barh(range(len(found)), list(found.values()), color=RED, height=0.6)
    axes.bar_label(bars, [f"{n} ({_percent(n / measures.commands)})" for n in found.values()], padding=3, fontsize=9)
    axes.set_yticks(range(len(found)), labels, fontsize=8)
    axes.set_xlabel("commands (share of all)")
    axes.xaxis.set_major_locator(_whole_numbers(6))
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
    figure, axes = _canvas("Does the robot know when it is right?", size=(5.4, 4.6))
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
            f"Expected calibration error {error:.3f}. Small figures: groundings in the bin"
            + (f"; {calibration.without} commands had none." if calibration.without else "."),
            fontsize=8,
        )
    else:
        _say(axes, "no grounding had a probability")
    axes.set_xlim(-0.02, 1.02)
    axes.xaxis.set_major_formatter(PercentFormatter(1.0, symbol=" %"))
    axes.set_xlabel("probability of the grounding")
    _percent_axis(axes, "share that was right")
    axes.legend(loc="lower right", fontsize=9, frameon=False)
    return figure


def draw_time(timings: Sequence[Timing]) -> Figure:
    """Mean seconds of each phase of a command."""
    seconds = summarise_seconds(timings)
    total = seconds["command"]
    figure, axes = _canvas(f"Where the time goes: {1000 * total:,.0f} ms a command", size=(6.4, 3.6))
    values = [1000 * seconds[phase] for phase in PHASES]
    bars = axes.barh(range(len(PHASES)), values, color=BLUE, height=0.6)
    shares = [f"{v:,.1f} ms ({_percent(v / (1000 * total), 0)})" if total else "0 ms" for v in values]
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
        _style(axes)
    left.axhspan(*PAPER_ACCURACY, color=GREY, alpha=0.18, lw=0, label="the paper's range")
    # Points of different runs stand side by side, so that their intervals don't cover each other.
    span = 0.5 * (len(runs) - 1) / max(1, len(runs))
    for k, (name, measures) in enumerate(runs.items()):
        colour, marker = _SERIES[k % len(_SERIES)]
        x, curve, note = _accuracy_curve(measures)
        y = [e.value for e in curve]
        if note or len(x) > 20:
            _band(left, x, curve, colour, "")
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
        right.annotate(f" {_percent(total.value)}", (total.high, k), va="center")
    left.set_title("by command, bars: 95 % interval", fontsize=10)
    right.set_title("all commands", fontsize=10)
    _percent_axis(left, "right object reached")
    _iteration_axis(left, max(runs.values(), key=lambda m: m.iterations))
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


def _canvas(title: str, size: tuple[float, float] = (6.0, 4.2)) -> tuple[Figure, Axes]:
    figure = Figure(figsize=size, layout="constrained")
    figure.suptitle(title, fontsize=12)
    axes = figure.add_subplot()
    _style(axes)
    return figure, axes


def _style(axes: Axes) -> None:
    axes.grid(visible=True, color="#DDDDDD", lw=0.7)
    axes.set_axisbelow(True)
    axes.spines[["top", "right"]].set_visible(False)


def _save(figure: Figure, path: Path) -> Path:
    path.parent.mkdir(parents=True, exist_ok=True)
    figure.savefig(path, dpi=DPI)
    return path


def _accuracy_curve(measures: Measures) -> tuple[list[int], list[Estimate], str]:
    """Iterations from 1, accuracy at each (or over a window of a long run), and a note for the legend."""
    window = _window(measures)
    x = [m.iteration + 1 for m in measures.by_iteration]
    correct = _rolling([m.correct for m in measures.by_iteration], window)
    n = _rolling([m.n for m in measures.by_iteration], window)
    return x, [wilson(c, k) for c, k in zip(correct, n, strict=True)], _rolling_note(window)


def _window(measures: Measures) -> int:
    """Iterations that a point of a curve covers: one, or a twentieth of a long run's (odd)."""
    return 1 if measures.iterations < LONG else max(5, measures.iterations // 20) | 1


def _rolling_note(window: int) -> str:
    return f" (mean of {window})" if window > 1 else ""


def _rolling(counts: Sequence[int], window: int) -> list[int]:
    """Sums over a centred window, which is cut at the ends."""
    half = window // 2
    total = np.concatenate([[0], np.cumsum(counts)])
    return [int(total[min(len(counts), i + half + 1)] - total[max(0, i - half)]) for i in range(len(counts))]


def _band(axes: Axes, x: Sequence[int], curve: Sequence[Estimate], colour: str, label: str) -> None:
    bounded = [(a, e.low, e.high) for a, e in zip(x, curve, strict=True) if e.low is not None and e.high is not None]
    if not bounded:
        return
    where, low, high = (list(column) for column in zip(*bounded, strict=True))
    if len(bounded) == 1:  # an area over a single point would not be seen
        axes.vlines(where, low, high, color=colour, alpha=0.4, lw=4, label=label)
    else:
        axes.fill_between(where, low, high, color=colour, alpha=0.18, lw=0, label=label)


def _marker(x: Sequence[float], marker: str) -> str:
    return marker if len(x) <= 30 else ""


def _percent_axis(axes: Axes, label: str) -> None:
    axes.set_ylim(-0.02, 1.02)
    axes.yaxis.set_major_formatter(PercentFormatter(1.0, symbol=" %"))
    axes.set_ylabel(label)


def _iteration_axis(axes: Axes, measures: Measures) -> None:
    axes.set_xlabel("command of the trial (iteration)")
    axes.xaxis.set_major_locator(_whole_numbers())
    first, last = (m.iteration + 1 for m in (measures.by_iteration[0], measures.by_iteration[-1]))
    axes.set_xlim(first - 0.5, last + 0.5)


def _legend(axes: Axes, columns: int = 2) -> None:
    axes.legend(loc="upper center", bbox_to_anchor=(0.5, -0.17), ncols=columns, fontsize=9, frameon=False)


def _say(axes: Axes, text: str) -> None:
    axes.text(0.5, 0.5, text, transform=axes.transAxes, ha="center", va="center", color=GREY)


def _trials(measures: Measures) -> str:
    return f"{measures.trials:,} trials" if measures.trials > 1 else "1 trial"


def _percent(share: float, digits: int = 1) -> str:
    return f"{100 * share:.{digits}f} %"


def _interval(estimate: Estimate) -> str:
    if estimate.low is None or estimate.high is None:
        return _percent(estimate.value)
    return f"{_percent(estimate.value)} [{100 * estimate.low:.1f}, {100 * estimate.high:.1f}]"


def _whole_numbers(bins: int = 10) -> MaxNLocator:
    return MaxNLocator(nbins=bins, integer=True, min_n_ticks=1)


def _wrapped(text: str, width: int = 48) -> str:
    lines = [""]
    for word in text.split():
        if len(lines[-1]) + len(word) > width:
            lines.append("")
        lines[-1] = f"{lines[-1]} {word}".strip()
    return "\n".join(lines)
