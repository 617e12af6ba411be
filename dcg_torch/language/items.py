"""The phrases of a command before they have a place in the tree, and what kinds of phrases there are."""

from __future__ import annotations

import enum
from collections.abc import Iterator
from dataclasses import dataclass, field, replace
from typing import Final

from dcg_torch.language.lexicon import GRAMMAR, SETS, listed


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
    beside: bool = False  # "and" or a comma joins it to what stands before
    said: bool = False  # an adverb or participle that is said of a noun phrase
    forced: bool = False  # a preposition that can only tell a noun phrase apart, as behind a relative pronoun
    before: list[Item] = field(default_factory=list)  # the noun phrases that stand before a preposition
    children: list[Item] = field(default_factory=list)

    @property
    def name(self) -> str:
        """The first word: of a verb its base form, of a preposition its normal form."""
        return self.words[0] if self.words else ""

    def walk(self) -> Iterator[Item]:
        """The item and all below it."""
        yield self
        for child in self.children:
            yield from child.walk()

    @property
    def definite(self) -> bool:
        """Has it a definite article?"""
        return self.text.partition(" ")[0] in SETS["definite"]

    def copy(self) -> Item:
        """The same with all below it, to stand somewhere else as well."""
        return replace(self, children=[child.copy() for child in self.children])

    def take_up(self, more: Item) -> None:
        """Say what another noun phrase says of the same thing, or which of several is meant."""
        self.pick(more)
        self.color = self.color or more.color
        self.words += tuple(word for word in more.words if word not in self.words)
        self.children += [child for child in more.children if child not in self.children]

    def pick(self, one: Item) -> None:
        """Mean one of several, if a singular says which: "a pair of dots, the paler of them"."""
        told = one.words and (one.determined or one.text in SETS["stands_for"])
        if self.plural and told and not one.plural:
            if self.count:
                self.words += (f"of {self.count}",)
            elif self.is_a("grouped"):
                self.words, self.children = (), [self.copy().behind("in")]
            self.plural, self.count = False, 1

    def behind(self, preposition: str) -> Item:
        """A preposition with this noun phrase, which nobody said so."""
        return Item(Kind.PREPOSITION, self.start, self.stop, self.text, (preposition,), children=[self])

    def is_a(self, kind: str) -> bool:
        """Whether the item is of a kind of `grammar.yaml`: one of its rows holds."""
        return any(all(self._has(*feature) for feature in row) for row in _KINDS[kind])

    def _has(self, name: str, wanted: bool, words: frozenset[str], all_of_them: bool) -> bool:
        value = getattr(self, name)
        if words:
            values = value if isinstance(value, tuple) else (value,)
            value = words.issuperset(values) if all_of_them else not words.isdisjoint(values)
        return bool(value) is wanted


END: Final = Item(Kind.STOP, 0, 0, "")
"""What stands before the first item and behind the last."""


def _feature(text: str) -> tuple[str, bool, frozenset[str], bool]:
    """ "-noun:sides|ends": the attribute, whether it is to hold, the words that it is looked for among."""
    name, _, lists = text.removeprefix("-").replace("=", ":=").partition(":")
    words = listed(lists.removeprefix("=").split("|") if lists else ())
    return name, not text.startswith("-"), words, lists.startswith("=")


_KINDS: Final = {
    kind: [[_feature(text) for text in row.split()] for row in rows.split(";")]
    for kind, rows in GRAMMAR["kinds"].items()
}
