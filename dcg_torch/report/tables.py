"""Tables for the terminal (rich): a run beside the paper's figures, its errors, runs beside one another, sweeps."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path

from rich import box
from rich.console import Console
from rich.table import Table

from dcg_torch.report.causes import CAUSES
from dcg_torch.report.intervals import Estimate
from dcg_torch.report.measures import Measures, paired_difference
from dcg_torch.report.summary import Summary, distinguish, find_runs, read_summary

_SHARES_NOTE = (
    "Known words among the right commands: with targets drawn evenly and 3 of 8 types known from the start, 37.5 % of "
    "the commands use a known word at every iteration, which makes about 44 % of the right ones. The paper's fall from "
    "70 % to 10 % can't follow from such a draw; what does change is that unknown words become learned ones."
)
_SYMBOLS_NOTE = (
    "A symbol is a type that the robot has a right name for. Points per symbol: least-squares slope of right (0 or 1) "
    "on the symbols held before the command."
)


def print_paper_table(measures: Measures, console: Console, seconds: Mapping[str, float] | None = None) -> None:
    """The paper's figures beside the run's, with 95 % intervals and what to know of the comparison.

    Args:
        measures: the run.
        console: where to print.
        seconds: `summarise_seconds` of the run, for the rows on time.
    """
    seconds = seconds or {}
    first, last = measures.by_iteration[0], measures.by_iteration[-1]
    values = [m.accuracy.value for m in measures.by_iteration]
    inside = sum(0.7 <= value <= 0.9 for value in values)
    commands = f"after {measures.iterations} commands"
    table = Table(title="The paper's figures and this run's", box=box.SIMPLE_HEAD)
    table.add_column("measure", max_width=46)
    table.add_column("paper", justify="right", no_wrap=True)
    table.add_column("this run [95 % interval]", justify="right")
    table.add_row("accuracy, all commands", "about 80 %", _percent(measures.accuracy))
    table.add_row(
        "accuracy at each iteration, lowest to highest",
        "70-90 %",
        f"{100 * min(values):.0f}-{100 * max(values):.0f} % ({inside} of {len(values)} within 70-90)",
    )
    table.add_row(f"all {len(measures.types)} symbols right {commands}", "10 %", _percent(measures.all_symbols))
    table.add_row(
        f"symbols right {commands}",
        "-",
        f"{_number(measures.correct_symbols)} of {len(measures.types)}, {measures.expected_symbols:.1f} expected",
    )
    table.add_row("wrong symbols kept, per trial", "-", f"{measures.wrong_symbols:.2f}")
    slope = measures.accuracy_per_symbol
    table.add_row("accuracy gained per right symbol", "> 4 points", _points(slope) if slope else "-")
    table.add_row("objects out of the first view", "about 87 %", _share(measures.out_of_view))
    table.add_row("known words among the right, first iteration", "70 %", _share(first.shares.get("known")))
    table.add_row("known words among the right, last iteration", "10 %", _share(last.shares.get("known")))
    table.add_row("learned words among the right, last iteration", "-", _share(last.shares.get("learned")))
    table.add_row("one training, longest", "< 60 s", _seconds(seconds.get("train_max")))
    table.add_row("grounding a command, longest", "< 40 s", _seconds(seconds.get("ground_max")))
    for kind, of_kind in measures.by_kind.items():
        accuracy = _percent(of_kind.accuracy) if of_kind.accuracy else "-"
        table.add_row(f"accuracy where the word was {kind} (n = {of_kind.n})", "-", accuracy)
    table.add_row("questions per command", "0", f"{measures.asked:.2f}")
    error = measures.calibration.error
    table.add_row("expected calibration error", "-", f"{error:.3f}" if error is not None else "-")
    table.add_row("driven and turned per command", "-", f"{measures.path_length:.2f} m, {measures.turned:.2f} rad")
    table.add_row("success weighted by path length", "-", f"{measures.path_efficiency:.2f}")
    console.print(table)
    console.print(f"{_size(measures)}. {_interval_note(measures)}")
    console.print(_SYMBOLS_NOTE)
    console.print(_SHARES_NOTE)


def print_iterations(measures: Measures, console: Console) -> None:
    """Accuracy, symbols and shares by iteration, the numbers behind the figures; a long run in twenty lines."""
    table = Table(title="By iteration", box=box.SIMPLE_HEAD)
    for heading in ("iteration", "accuracy", "symbols right", "expected", "known", "unknown", "learned"):
        table.add_column(heading, justify="right", no_wrap=True)
    stride = -(-len(measures.by_iteration) // 20)
    for m in measures.by_iteration[::stride]:
        shares = [_share(m.shares.get(kind), 0) for kind in ("known", "unknown", "learned")]
        symbols = _number(m.correct_symbols)
        table.add_row(str(m.iteration + 1), _percent(m.accuracy, 0), symbols, f"{m.expected_symbols:.2f}", *shares)
    console.print(table)


def print_errors(measures: Measures, console: Console) -> None:
    """Wrong commands by cause."""
    wrong = sum(measures.causes.values())
    if not wrong:
        console.print(f"None of {measures.commands} commands went wrong.")
        return
    table = Table(title=f"Why {wrong} of {measures.commands} commands went wrong", box=box.SIMPLE_HEAD)
    table.add_column("cause", no_wrap=True)
    table.add_column("commands", justify="right")
    table.add_column("share", justify="right", no_wrap=True)
    table.add_column("meaning")
    for cause, count in measures.causes.items():
        if count:
            table.add_row(cause, str(count), _share(count / measures.commands), CAUSES[cause])
    console.print(table)


def print_comparison(runs: Mapping[str, Measures], console: Console) -> None:
    """Runs beside one another; where two heard the same commands, the difference to the one above, trial by trial."""
    table = Table(title="Runs compared", box=box.SIMPLE_HEAD)
    table.add_column("run", overflow="fold", min_width=12)
    for heading in ("accuracy", "gain", "first", "last", "symbols", "all right", "wrong", "asked", "calib."):
        table.add_column(heading, justify="right", min_width=len(heading) if " " not in heading else None)
    above: Measures | None = None
    for name, m in runs.items():
        difference = paired_difference(above, m) if above is not None else None
        error = m.calibration.error
        table.add_row(
            name,
            _percent(m.accuracy),
            _points(difference, "") if difference else "-",
            _share(m.by_iteration[0].accuracy.value, 0),
            _share(m.by_iteration[-1].accuracy.value, 0),
            f"{m.correct_symbols.value:.2f}",
            _share(m.all_symbols.value, 0),
            f"{m.wrong_symbols:.2f}",
            f"{m.asked:.2f}",
            f"{error:.3f}" if error is not None else "-",
        )
        above = m
    console.print(table)
    console.print(
        "gain: points of accuracy over the run above, by trial, where both heard the same commands. first, last: "
        "accuracy at the first and last iteration. symbols, all right, wrong: at the end of a trial. asked: questions "
        "a command. calib.: expected calibration error."
    )


def tabulate_sweep(directory: Path) -> Table:
    """One row for each run folder at or below `directory`, with the settings that tell it from the others.

    Raises:
        ReportError: if `directory` is not a folder, or a `summary.json` in it can't be read.
    """
    folders = find_runs(directory)
    return tabulate_runs({folder: read_summary(folder / "summary.json") for folder in folders}, str(directory))


def tabulate_runs(runs: Mapping[Path, Summary], title: str) -> Table:
    """`tabulate_sweep` of summaries that are already read."""
    table = Table(title=title, box=box.SIMPLE_HEAD)
    table.add_column("run", overflow="fold")
    table.add_column("settings that differ", overflow="fold")
    for heading in ("trials", "accuracy", "symbols", "all right", "ms a command"):
        table.add_column(heading, justify="right")
    for (folder, summary), settings in zip(runs.items(), distinguish(runs), strict=True):
        m = summary.measures
        each = summary.seconds.get("command")
        table.add_row(
            summary.run or folder.name,
            settings or "-",
            str(m.trials),
            _percent(m.accuracy),
            f"{m.correct_symbols.value:.2f} of {len(m.types)}",
            _share(m.all_symbols.value, 0),
            f"{1000 * each:.0f}" if each is not None else "-",
        )
    return table


def _size(measures: Measures) -> str:
    trials = f"{measures.trials} trials" if measures.trials > 1 else "1 trial"
    return f"{measures.commands} commands in {trials}"


def _interval_note(measures: Measures) -> str:
    alike = len(set(measures.trial_accuracy)) == 1
    unit = "over commands (Wilson), the trials being one or all alike" if alike else "over trials (Student)"
    return f"Accuracy over all commands: interval {unit}; shares of trials: Wilson."


def _percent(estimate: Estimate, digits: int = 1) -> str:
    text = f"{100 * estimate.value:.{digits}f} %"
    if estimate.low is None or estimate.high is None:
        return text
    return f"{text} \\[{100 * estimate.low:.{digits}f}, {100 * estimate.high:.{digits}f}]"


def _points(estimate: Estimate, unit: str = " points") -> str:
    text = f"{100 * estimate.value:+.1f}{unit}"
    if estimate.low is None or estimate.high is None:
        return text
    return f"{text} \\[{100 * estimate.low:+.1f}, {100 * estimate.high:+.1f}]"


def _number(estimate: Estimate) -> str:
    text = f"{estimate.value:.2f}"
    if estimate.low is None or estimate.high is None:
        return text
    return f"{text} \\[{estimate.low:.2f}, {estimate.high:.2f}]"


def _share(value: float | None, digits: int = 1) -> str:
    return "-" if value is None else f"{100 * value:.{digits}f} %"


def _seconds(value: float | None) -> str:
    if value is None:
        return "-"
    return f"{1000 * value:.0f} ms" if value < 1 else f"{value:.1f} s"
