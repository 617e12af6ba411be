"""The lexicon for people: every word, what it may mean, and from which commands the robot knows."""

from __future__ import annotations

import json
from collections.abc import Iterable
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import TYPE_CHECKING

from dcg_torch.learning.beliefs import Beliefs

if TYPE_CHECKING:
    from rich.table import Table


@dataclass(frozen=True, slots=True)
class Entry:
    """One word: its types by falling probability, the number of its commands, and the most telling of them.

    `settled` says that the meaning was given, at the start or by a person.
    """

    word: str
    types: tuple[tuple[str, float], ...]
    commands: int
    sources: tuple[str, ...]
    settled: bool


def lexicon(beliefs: Beliefs, least: float = 0.01) -> list[Entry]:
    """An entry per word, with its types of probability `least` or more."""
    entries = []
    for word in beliefs.posterior.words:
        ranked = sorted(beliefs.posterior.of(word).items(), key=lambda item: (-item[1], item[0]))
        heard = beliefs.heard.get(word)
        entries.append(
            Entry(
                word,
                tuple((t, p) for t, p in ranked if p >= least),
                0 if heard is None else heard.commands,
                () if heard is None else tuple(source for source, _ in heard.sources),
                word in beliefs.settled,
            )
        )
    return entries


def lexicon_table(entries: Iterable[Entry], title: str = "What the words mean to the robot") -> Table:
    """The lexicon as a table for the console."""
    from rich.table import Table  # here: a model that nobody looks at needs none

    table = Table(title=title, title_justify="left")
    for name in ("word", "means", "commands", "learned from"):
        table.add_column(name)
    for e in entries:
        means = ", ".join(f"{t} {100 * p:.0f} %" for t, p in e.types)
        table.add_row(e.word, means, str(e.commands), "given" if e.settled else " ".join(e.sources))
    return table


def save_lexicon(entries: Iterable[Entry], path: Path) -> None:
    """Write the lexicon as JSON, an object per word."""
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(json.dumps([asdict(entry) for entry in entries], indent=1) + "\n", encoding="utf-8")


def load_lexicon(path: Path) -> list[Entry]:
    """What `save_lexicon` wrote."""
    return [
        Entry(e["word"], tuple((t, p) for t, p in e["types"]), e["commands"], tuple(e["sources"]), e["settled"])
        for e in json.loads(path.read_text(encoding="utf-8"))
    ]
