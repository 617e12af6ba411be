"""Tables of several runs for the terminal: a row a run, a row a configuration, differences on the same commands.

All fit 100 columns, whatever the runs are called: names fold.
"""

from __future__ import annotations

from collections.abc import Sequence
from itertools import combinations

from rich import box
from rich.console import Console
from rich.markup import escape
from rich.table import Table

from dcg_torch.report.configurations import Configuration, distinguish, paired_difference
from dcg_torch.report.measures import Measures
from dcg_torch.report.runs import Run
from dcg_torch.report.text import number, percent, percent_interval, points_interval, seconds
from dcg_torch.storage.records import NO_EFFECT

_ALL_PAIRS = 4  # up to so many configurations every pair is shown; of more, each against the first


def print_runs(runs: Sequence[Run], console: Console) -> None:
    """A row for each run, by the settings that tell it from the others."""
    table = _table("Runs", ("trials", "accuracy [95 %]", "symbols", "all right", "a command"), first="run")
    for run, told in zip(runs, distinguish(runs, NO_EFFECT), strict=True):
        m = run.measures
        table.add_row(
            escape(told or run.name),
            str(m.trials),
            percent_interval(m.accuracy),
            _symbols(m),
            percent(m.all_symbols.value, 0),
            seconds(run.seconds.get("command")),
        )
    console.print(table)


def print_configurations(found: Sequence[Configuration], console: Console) -> None:
    """A row for each configuration: its trials over all seeds taken together, and how far the seeds lie apart."""
    headings = ("seeds", "trials", "accuracy [95 %]", "by seed", "symbols", "wrong", "asked", "calib.")
    table = _table("Configurations compared", headings, first="configuration")
    for configuration in found:
        m = configuration.measures
        table.add_row(
            escape(configuration.name),
            str(len(configuration.runs)),
            str(m.trials),
            percent_interval(m.accuracy),
            _range(configuration.by_seed),
            _symbols(m),
            number(m.wrong_symbols),
            number(m.asked),
            number(m.calibration.error, 3),
        )
    console.print(table)
    console.print(
        "accuracy: mean over the trials of all seeds, which are independent. by seed: the lowest and highest run, in "
        "%. symbols, wrong: held at the end of a trial. asked: questions a command. calib.: calibration error.",
        highlight=False,
    )


def print_differences(found: Sequence[Configuration], console: Console) -> None:
    """Accuracy against one another on the commands that both heard; nothing where no two share any."""
    rows = []
    for first, second in _pairs(found):
        difference = paired_difference(first, second)
        if difference is not None:
            name = f"{second.name} - {first.name}"
            each = f"{difference.second_only} / {difference.first_only}"
            rows.append((name, difference.trials, difference.commands, each, points_interval(difference.accuracy)))
    if not rows:
        return
    table = _table("Differences on the same commands", ("trials", "commands", "only one right", "points [95 %]"))
    for name, trials, commands, each, points in rows:
        table.add_row(escape(name), str(trials), f"{commands:,}", each, points)
    console.print(table)
    console.print(
        "points: accuracy of the one before the minus sign, less that of the other; mean and interval over paired "
        "trials. only one right: commands that only the one, or only the other, got right.",
        highlight=False,
    )


def _pairs(found: Sequence[Configuration]) -> list[tuple[Configuration, Configuration]]:
    if len(found) <= _ALL_PAIRS:
        return list(combinations(found, 2))
    return [(found[0], other) for other in found[1:]]


def _table(title: str, headings: Sequence[str], first: str = "") -> Table:
    table = Table(title=title, box=box.SIMPLE_HEAD, padding=(0, 1, 0, 0))
    table.add_column(first, overflow="fold", min_width=12)
    for heading in headings:
        table.add_column(heading, justify="right", no_wrap=True)
    return table


def _symbols(measures: Measures) -> str:
    return f"{measures.correct_symbols.value:.2f} of {len(measures.types)}"


def _range(shares: Sequence[float]) -> str:
    low, high = 100 * min(shares), 100 * max(shares)
    return f"{low:.0f}-{high:.0f}" if len(shares) > 1 else "-"
