"""The phrases of a command before they have a place in the tree."""

from __future__ import annotations

import enum
from collections.abc import Iterator
from dataclasses import dataclass, field, replace


class Kind(enum.Enum):
    """What an item of a command is."""

    VERB = "verb"
    PREPOSITION = "preposition"
    NOUN = "noun"
    RELATIVE = "relative"  # which, that, who
    NEGATION = "negation"
    AND = "and"
    COMMA = "comma"
    STOP = "stop"
    ADVERB = "adverb"


@dataclass(slots=True, eq=False)
class Item:
    """A phrase before it has a place in the tree. `start` and `stop` are word indices."""

    kind: Kind
    start: int
    stop: int
    text: str
    words: tuple[str, ...] = ()
    noun: str | None = None
    color: str | None = None
    plural: bool = False
    count: int | None = None
    pronoun: bool = False  # it, one, that: stands for something else
    participle: bool = False  # a verb's -ed or -ing form
    finite: bool = False  # a verb's -s form
    determined: bool = False  # has an article
    negative: bool = False  # "no cube"
    beside: bool = False  # "and" or a comma joins it to the noun phrase before
    said: bool = False  # an adverb or participle that is said of a noun phrase
    children: list[Item] = field(default_factory=list)

    def walk(self) -> Iterator[Item]:
        """The item and all below it."""
        yield self
        for child in self.children:
            yield from child.walk()

    def copy(self) -> Item:
        """The same with all below it, to stand somewhere else as well."""
        return replace(self, children=[child.copy() for child in self.children])
