"""The phrases of a command before they have a place in the tree: what kinds there are, what one is like, and small
changes to a single noun phrase."""

from __future__ import annotations

import enum
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field, replace
from typing import Final

from dcg_torch.english.forms import parts
from dcg_torch.language.lexicon import GRAMMAR, NORMAL, PLACING, SETS, listed


class Kind(enum.StrEnum):
    """What an item of a command is, with the tag of what is one by itself."""

    VERB = "V"
    PREPOSITION = "P"
    NOUN = "N"
    RELATIVE = "REL"  # which, that, who
    NEGATION = "NEG"
    AND = "AND"  # or, but as well
    COMMA = "COMMA"
    STOP = "STOP"  # the end of a sentence
    ADVERB = "ADV"


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
    late: bool = False  # a verb of what comes after all else: "before you go to the phone"
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
        """Say what another noun phrase says of the same thing, or which of several: "a pair of dots, the paler one"."""
        told = not (more.plural or more.is_a("empty"))
        if self.plural and told and (more.determined or more.text in SETS["stands_for"]):
            if self.count:
                self.words += (f"of {self.count}",)
            elif self.is_a("grouped"):
                self.words, self.children = (), [self.copy().behind("in")]
            self.plural, self.count = False, 1
        self.color, self.words = self.color or more.color, self.words + more.words
        self.children += [child for child in more.children if child not in self.children]

    def behind(self, preposition: str) -> Item:
        """A preposition with this noun phrase, which nobody said so."""
        return Item(Kind.PREPOSITION, self.start, self.stop, self.text, (preposition,), children=[self])

    def is_a(self, kind: str) -> bool:
        """Whether the item is of a kind of `grammar.yaml`: one of its rows holds."""
        for row in _KINDS[kind]:
            for name, wanted, words, all_of_them in row:
                value = getattr(self, name)
                if words:
                    values = value if isinstance(value, tuple) else (value,)
                    value = words.issuperset(values) if all_of_them else not words.isdisjoint(values)
                if bool(value) is not wanted:
                    break
            else:
                return True
        return False


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


def normal_words(words: Sequence[str]) -> tuple[str, ...]:
    """The describing words of a noun phrase in normal form, each once.

    An ordinal with what it counts along is two words of a noun phrase:

        ("second", "from the left")   the second from the left, the second leftmost
        ("second", "last")            the second to last, the next to last, the penultimate
        ("second", "biggest")         the second biggest; so with every superlative
        ("second",)                   with the preposition "closest to" below: the second closest to the sphere

    >>> normal_words(["third", "leftmost"]), normal_words(["nearest", "big"])
    (('third', 'from the left'), ('closest', 'big'))
    """
    out: list[str] = []
    for word in words:
        normal = NORMAL.get(word, word)
        side = normal.removesuffix("most")
        if out and out[-1] in SETS["ordinals"] and normal.endswith("most") and side in SETS["sides"]:
            normal = f"from the {side}"
        out.append(normal)
    return tuple(dict.fromkeys(out))


def is_superlative(word: str) -> bool:
    """Whether a word names an end: "leftmost", "biggest"."""
    return word.endswith(("est", "most")) and word not in SETS["ordinals"]


def share_noun(first: Item, second: Item) -> None:
    """ "the red and the blue cube", "the leftmost and the rightmost cube": the noun stands but once."""
    told = first.color is not None or any(is_superlative(word) or word in SETS["ordinals"] for word in first.words)
    if first.noun is None and told and not first.text.endswith(("one", "ones")):
        first.noun, first.pronoun = second.noun, second.noun is None


def last_thing(nouns: Sequence[Item]) -> Item:
    """The last noun phrase that words can describe: no person and no side."""
    return next((noun for noun in reversed(nouns) if not noun.is_a("somewhere")), nouns[-1])


def deny(noun: Item, other: Item) -> None:
    """ "The cube, but not the red one", "not the one on the left": what is said of the other does not hold."""
    bare = other.is_a("empty") and noun.start < other.start  # "the red one, not the cup"
    if noun.noun is None and other.determined and noun.text.endswith(" one") and not bare:
        noun.noun, noun.pronoun = other.noun, other.noun is None  # "not the left cup, the other one"
    if other.noun not in {None, noun.noun}:
        out = other.is_a("kind") and (noun.is_a("unnamed_one") or f" {other.noun}".endswith(f" {noun.noun}"))
        noun.children += [other.behind("except")] if out else []  # "a table, not an end table"
        return
    of_one = other.determined and noun.color is not None  # "the green cone, not the blue one"
    for word in (None if of_one else other.color, *other.words):
        side = (word or "").removesuffix("most")
        if side in SETS["left_right"] and all(place.children[0].noun != side for place in noun.children):
            noun.children.append(Item(noun.kind, other.start, other.stop, side, noun=side).behind("not on"))
        elif word and word not in (noun.color, *noun.words):
            noun.words += (f"not {word}",)
    for place in other.children:
        place.words = (f"not {place.name}",)
        noun.children.append(place)


def settle_words(noun: Item) -> None:
    """Bring what is said of a noun phrase to one form, when all has been said."""
    for place in list(noun.children):
        below = place.children[0]
        if place.words == ("without",):
            _settle_nothing(noun, place, below)
        elif place.words == ("with",) and len(place.children) == 1 and below.is_a("colored_part") and not noun.color:
            # "The screwdriver with the red handle": people and recognisers say that it is red.
            noun.color, below.said = below.color, True
            noun.children.remove(place)
        elif place.name in GRAMMAR["isolation"] and below.is_a("the_rest"):  # "the cube away from the others"
            noun.words, below.said = (*noun.words, *GRAMMAR["isolation"][place.name].split()), True
            noun.children.remove(place)
    ranks = any(map(is_superlative, noun.words)) or any(place.name in PLACING["extremes"] for place in noun.children)
    if ranks and noun.is_a("whatever"):
        noun.words, noun.plural = noun.words[1:], False  # "whatever is closest to you"
    if "each other" in noun.words[1:]:  # "side by side" becomes the preposition "next to" with another such thing
        at = noun.words.index("each other")
        other = Item(noun.kind, noun.stop, noun.stop, "", ("each other",), noun.noun, noun.color, pronoun=True)
        noun.children.append(other.behind(noun.words[at - 1]))
        noun.words = noun.words[: at - 1] + noun.words[at + 1 :]
    _settle_row(noun)
    noun.noun = "thing" if noun.noun in SETS["nothing"] else noun.noun


def _settle_nothing(noun: Item, without: Item, thing: Item) -> None:
    """ "with nothing on top of it" becomes the word "nothing on" of the noun phrase, "nothing behind it" another."""
    if thing.noun in SETS["unnamed_things"] and len(thing.children) == 1:
        (where,) = thing.children
        if where.children[0].noun in {None, "top"}:
            noun.words += (f"nothing {'on' if where.name in PLACING['upon'] else where.name}",)
            noun.children.remove(without)


def _settle_row(noun: Item) -> None:
    """ "Three cubes in a row" are a row of three."""
    for place in noun.children:
        row = place.children[0]
        alone = place.words == ("in",) and noun.plural and len(place.children) == 1
        if alone and row.is_a("group") and not row.text.startswith("the "):
            noun.words += (str(row.noun), *((f"of {noun.count}",) if noun.count else ()))
            noun.count, place.said, row.said = None, True, True
            noun.children.remove(place)
            return


def is_state(item: Item) -> bool:
    """ "(The one in the middle is) sick": a noun phrase of an adjective that is hardly ever a noun."""
    used = parts(item.noun) if item.noun and not (item.determined or item.plural or item.children) else {}
    return used.get("a", 0) > used.get("n", 0)


def is_edge_of(noun: Item, edge: Item, place: Item) -> bool:
    """Whether the edge says from where something is counted: "the second from the left", "the third on the left"."""
    ranked = any(is_superlative(word) for word in noun.words)
    if place.words != ("from",):
        # "The third on the left" counts from there, "the second highest on the left" does not.
        along = ranked or any(word[:5] == "from " or word == "last" for word in noun.words)
        return noun.is_a("ordered") and edge.is_a("sided") and not along
    return (noun.is_a("ordered") or ranked) and edge.noun in SETS["ends"] | SETS["someone"]
