"""Tables of one run for the terminal (rich): its measures, by iteration, and its errors."""

from __future__ import annotations

from collections.abc import Iterator, Mapping

from rich import box
from rich.console import Console
from rich.table import Table

from dcg_torch.report import paper
from dcg_torch.report.causes import CAUSES
from dcg_torch.report.measures import Measures
from dcg_torch.report.text import counted, number, number_interval, percent, percent_interval, points_interval, seconds

_SHARES_NOTE = (
    "Known words among the right commands: with targets drawn evenly and 3 of 8 types known from the start, 37.5 % of "
    "the commands use a known word at every iteration, which makes about 44 % of the right ones. The paper's fall from "
    "70 % to 10 % can't follow from such a draw; what does change is that unknown words become learned ones."
)
_SYMBOLS_NOTE = (
    "A symbol is a type that the robot has a right name for. Points per symbol: least-squares slope of right (0 or 1) "
    "on the symbols held before the command."
)

Row = tuple[str, str, str]
"""Measure, the paper's figure, the run's."""


def print_measures(
    measures: Measures, console: Console, times: Mapping[str, float] | None = None, *, beside_paper: bool
) -> None:
    """A run's measures with 95 % intervals, and what to know of them.

    Args:
        measures: the run.
        console: where to print.
        times: `summarise_seconds` of the run, for the rows on time.
        beside_paper: with the paper's figures; for runs that `paper.follows_paper`.
    """
    table = Table(title="The paper's figures and this run's" if beside_paper else "This run", box=box.SIMPLE_HEAD)
    table.add_column("measure", max_width=46)
    if beside_paper:
        table.add_column("paper", justify="right", no_wrap=True)
    table.add_column("this run [95 % interval]", justify="right")
    for rows in (_accuracy_rows(measures, beside_paper), _share_rows(measures), _effort_rows(measures, times or {})):
        for name, published, ours in rows:
            table.add_row(name, *((published,) if beside_paper else ()), ours)
    console.print(table)
    size = f"{counted(measures.commands, 'command')} in {counted(measures.trials, 'trial')}"
    console.print(f"{size}. {_interval_note(measures)}", highlight=False)
    console.print(_SYMBOLS_NOTE, highlight=False)
    if beside_paper:
        console.print(_SHARES_NOTE, highlight=False)


def _accuracy_rows(measures: Measures, beside_paper: bool) -> Iterator[Row]:
    values = [m.accuracy.value for m in measures.by_iteration]
    commands = f"after {counted(measures.iterations, 'command')}"
    yield "accuracy, all commands", "about 80 %", percent_interval(measures.accuracy)
    inside = sum(paper.ACCURACY[0] <= value <= paper.ACCURACY[1] for value in values)
    within = f" ({inside} of {len(values)} within 70-90)" if beside_paper else ""
    lowest_highest = f"{100 * min(values):.0f}-{100 * max(values):.0f} %{within}"
    yield "accuracy at each iteration, lowest to highest", "70-90 %", lowest_highest
    yield f"all {len(measures.types)} symbols right {commands}", "10 %", percent_interval(measures.all_symbols)
    right = f"{number_interval(measures.correct_symbols)} of {len(measures.types)}"
    yield f"symbols right {commands}", "-", f"{right}, {measures.expected_symbols:.1f} expected"
    yield "wrong symbols kept, per trial", "-", number(measures.wrong_symbols)
    slope = measures.accuracy_per_symbol
    yield "points of accuracy gained per right symbol", "> 4", points_interval(slope) if slope else "-"


def _share_rows(measures: Measures) -> Iterator[Row]:
    first, last = measures.by_iteration[0], measures.by_iteration[-1]
    yield "objects out of the first view", "about 87 %", percent(measures.out_of_view)
    yield "known words among the right, first iteration", "70 %", percent(first.shares.get("known"))
    yield "known words among the right, last iteration", "10 %", percent(last.shares.get("known"))
    yield "learned words among the right, last iteration", "-", percent(last.shares.get("learned"))
    for kind, of_kind in measures.by_kind.items():
        accuracy = percent_interval(of_kind.accuracy) if of_kind.accuracy else "-"
        yield f"accuracy where the word was {kind} (n = {of_kind.n})", "-", accuracy


def _effort_rows(measures: Measures, times: Mapping[str, float]) -> Iterator[Row]:
    yield "one training, longest", "< 60 s", seconds(times.get("train_max"))
    yield "grounding a command, longest", "< 40 s", seconds(times.get("ground_max"))
    yield "questions per command", "0", number(measures.asked)
    calibration = measures.calibration
    yield "expected calibration error", "-", number(calibration.error, 3)
    yield "the same of a calibrated robot, by chance", "-", f"up to {number(calibration.chance, 3)}"
    yield "driven and turned per command", "-", f"{measures.path_length:.2f} m, {measures.turned:.2f} rad"
    yield "success weighted by path length", "-", number(measures.path_efficiency)


def print_iterations(measures: Measures, console: Console) -> None:
    """Accuracy, symbols and shares by iteration, the numbers behind the figures; a long run in twenty lines."""
    table = Table(title="By iteration", box=box.SIMPLE_HEAD)
    for heading in ("iteration", "accuracy", "symbols right", "expected", "known", "unknown", "learned"):
        table.add_column(heading, justify="right", no_wrap=True)
    stride = -(-len(measures.by_iteration) // 20)
    for m in measures.by_iteration[::stride]:
        shares = [percent(m.shares.get(kind), 0) for kind in ("known", "unknown", "learned")]
        symbols = number_interval(m.correct_symbols)
        table.add_row(
            str(m.iteration + 1), percent_interval(m.accuracy, 0), symbols, number(m.expected_symbols), *shares
        )
    console.print(table)


def print_errors(measures: Measures, console: Console) -> None:
    """Wrong commands by cause."""
    wrong = sum(measures.causes.values())
    if not wrong:
        console.print(f"None of {counted(measures.commands, 'command')} went wrong.")
        return
    table = Table(title=f"Why {wrong} of {counted(measures.commands, 'command')} went wrong", box=box.SIMPLE_HEAD)
    table.add_column("cause", no_wrap=True)
    table.add_column("commands", justify="right")
    table.add_column("share", justify="right", no_wrap=True)
    table.add_column("meaning")
    for cause, count in measures.causes.items():
        if count:
            table.add_row(cause, str(count), percent(count / measures.commands), CAUSES[cause])
    console.print(table)


def _interval_note(measures: Measures) -> str:
    alike = len(set(measures.trial_accuracy)) == 1
    unit = "over commands (Wilson), the trials being one or all alike" if alike else "over trials (Student)"
    return f"Accuracy over all commands: interval {unit}; shares of trials: Wilson."
