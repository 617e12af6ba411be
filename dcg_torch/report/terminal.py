"""Standard output, for all programs: what happens when nobody reads on."""

from __future__ import annotations

import contextlib
import os
import sys

from rich.console import Console

CLOSED = "standard output was closed before all was said; the rest is not shown"


class Output(Console):
    """Leaves it to the program what to do when nobody reads on; Rich would end it without a word."""

    def on_broken_pipe(self) -> None:
        """Let the error through."""
        raise BrokenPipeError


def close_output() -> None:
    """Keep Python from complaining once more about a closed or full output, when it flushes at its end."""
    with contextlib.suppress(OSError, ValueError):
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())


def open_closed() -> None:
    """Send to nowhere what goes to a standard stream that whoever started this process has closed (`>&-`).

    Otherwise the next file that is opened takes its number, and what libraries print ends up in that file.
    """
    while (number := os.open(os.devnull, os.O_RDWR)) <= 2:
        os.set_inheritable(number, True)
    os.close(number)
    sys.stdin = sys.stdin or open(0, closefd=False)  # noqa: SIM115  (they stay open, as those of Python do)
    sys.stdout = sys.stdout or open(1, "w", closefd=False)  # noqa: SIM115
    sys.stderr = sys.stderr or open(2, "w", closefd=False)  # noqa: SIM115
