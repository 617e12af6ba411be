"""Protocols of a parser and of its answer, of which `language.Parse` is one."""

from __future__ import annotations

import functools
from collections.abc import Callable, Collection, Sequence
from typing import NamedTuple, Protocol

from dcg_torch.types import ParseTree


class WeightedReading(Protocol):
    """One way to read a command."""

    @property
    def tree(self) -> ParseTree:
        """What it says."""

    @property
    def log_weight(self) -> float:
        """log p(reading | command) before the world has spoken."""

    @property
    def rules(self) -> Sequence[str]:
        """The weighted choices that led here, as "rule=option"."""


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


class ParsedCommand(ReadCommand, Protocol):
    """What reading a command gives: readings, or the problem in words."""

    @property
    def tree(self) -> ParseTree | None:
        """The phrases of the likeliest reading, or None if there is a problem."""

    @property
    def noun(self) -> str | None:
        """The noun of the object meant."""

    @property
    def color(self) -> str | None:
        """The colour stated of the object meant."""


class Words(NamedTuple):
    """The nouns of a parse tree and the words of its phrases: what it does not speak of is soon told by them."""

    nouns: frozenset[str]
    words: frozenset[str]

    @staticmethod
    @functools.lru_cache(maxsize=1024)
    def of(tree: ParseTree) -> Words:
        """The nouns and words of a tree."""
        phrases = [node.phrase for node in tree.walk()]
        nouns = frozenset([phrase.noun for phrase in phrases if phrase.noun is not None])
        return Words(nouns, frozenset([word for phrase in phrases for word in phrase.words]))


CommandParser = Callable[[str, Collection[str]], ParsedCommand]
"""Reads a command, given the words that are known."""
