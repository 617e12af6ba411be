"""The terminal: its width, and a progress bar over commands."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Self

from rich.console import Console
from rich.progress import BarColumn, MofNCompleteColumn, Progress, TextColumn, TimeElapsedColumn, TimeRemainingColumn

from dcg_torch.report.terminal import Output
from dcg_torch.storage.records import Iteration

_LOG_WIDTH = 140  # columns; into a pipe or a file there is no width to keep to


def make_console() -> Console:
    """Standard output; wide enough for the tables where it is no terminal."""
    console = Output(highlight=False)
    return console if console.is_terminal else Output(width=max(_LOG_WIDTH, console.width), highlight=False)


class _Shown:
    """A bar that is shown within a `with` block."""

    _bar: Progress

    def __enter__(self) -> Self:
        self._bar.start()
        return self

    def __exit__(self, *_: object) -> None:
        self._bar.stop()


class CommandBar(_Shown):
    """A progress bar over commands, with the accuracy so far; call it with new rows.

    Args:
        total: how many commands there are to be.
    """

    def __init__(self, total: int, console: Console) -> None:
        self._bar = Progress(
            "{task.description}",
            BarColumn(),
            MofNCompleteColumn(),
            TextColumn("accuracy {task.fields[accuracy]}"),
            TimeElapsedColumn(),
            TimeRemainingColumn(),
            console=console,
        )
        self._task = self._bar.add_task("commands", total=total, accuracy="-")
        self._done = self._right = 0

    def __call__(self, rows: Sequence[Iteration]) -> None:
        """Count `rows` as done."""
        self._done += len(rows)
        self._right += sum(row.correct for row in rows)
        accuracy = f"{100 * self._right / self._done:.1f} %" if self._done else "-"
        self._bar.update(self._task, completed=self._done, accuracy=accuracy)


class Bar(_Shown):
    """A progress bar on a terminal, and nothing elsewhere.

    Args:
        total: how many steps there are.
    """

    def __init__(self, description: str, total: int, console: Console) -> None:
        self._bar = Progress(
            "{task.description}",
            BarColumn(),
            MofNCompleteColumn(),
            TimeElapsedColumn(),
            TimeRemainingColumn(),
            console=console,
            transient=True,
            disable=not console.is_terminal,
        )
        self._task = self._bar.add_task(description, total=total)

    def advance(self, _: object = None) -> None:
        """Count one step as done."""
        self._bar.advance(self._task)
