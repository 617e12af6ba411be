"""What a model asks of a parser's answer; `language.Parse` is one."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Protocol

from dcg_torch.types import ParseTree


class WeightedReading(Protocol):
    """One way to read a command."""

    @property
    def tree(self) -> ParseTree:
        """What it says."""

    @property
    def log_weight(self) -> float:
        """log p(reading | command) before the world has spoken."""


class ReadCommand(Protocol):
    """A command that has been read."""

    @property
    def text(self) -> str:
        """As it was said."""

    @property
    def readings(self) -> Sequence[WeightedReading]:
        """The likeliest first; none where there is a problem."""

    @property
    def problem(self) -> str | None:
        """Why there is no reading."""
