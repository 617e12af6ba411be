"""Names in parts, and this project's lists of what people call things (`data/everyday.yaml`)."""

from __future__ import annotations

import functools
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from dcg_torch.names.normal_form import head_index, normalise, read_data, singular
from dcg_torch.names.wordnet import nouns


@dataclass(frozen=True, slots=True)
class Name:
    """A name in parts: its words in the singular, the head last; and written as one, to compare by."""

    words: tuple[str, ...]
    text: str
    solid: str

    @property
    def head(self) -> str:
        """The last word."""
        return self.words[-1]


@dataclass(frozen=True)
class Everyday:
    """The lists.

    Attributes:
        groups: name -> the numbers of the groups of names of one thing that it is in.
        generic, purposeful: names of whatever there is, and those that stand behind what a thing is for.
        purposes: verb -> names of what is for that.
        kinds: name of a kind -> names of what people count as it.
        packages: last words of the names of what is called by what it holds as well.
        fillings: names of whatever is in a thing.
        packs, wares: what things come packed in whatever they are, and names of whatever comes so.
        surfaces: names of what is so long that people mean a part of it.
        portions: what behind the name of a thing only says how much of it.
        beside: first word of a compound -> the name of what such a thing stands beside.
        ages: the same -> how large it is among those of its kind.
    """

    groups: dict[str, frozenset[int]]
    generic: frozenset[str]
    purposeful: frozenset[str]
    purposes: dict[str, list[str]]
    kinds: dict[str, frozenset[str]]
    packages: frozenset[str]
    fillings: frozenset[str]
    packs: frozenset[str]
    wares: frozenset[str]
    surfaces: frozenset[str]
    portions: frozenset[str]
    beside: dict[str, str]
    ages: dict[str, str]


@functools.cache
def measures() -> frozenset[str]:
    """Nouns that before "of" only count."""
    return frozenset(read_data("everyday.yaml")["measures"])


@functools.cache
def everyday() -> Everyday:
    """The lists, read at the first call."""
    data, groups = read_data("everyday.yaml"), dict[str, set[int]]()
    for k, names in enumerate(data["same"]):
        for name in names:
            groups.setdefault(name_parts(str(name)).text, set()).add(k)
    frozen = {name: frozenset(numbers) for name, numbers in groups.items()}
    lists = ("generic", "purposeful", "packages", "fillings", "packs", "wares", "surfaces", "portions")
    listed: dict[str, Any] = {name: frozenset(map(str, data[name])) for name in lists}
    kinds = {
        name_parts(kind).text: _members(kind, data["kinds"]) for line in data["kinds"] for kind in line.split(", ")
    }
    kinds = {kind: _also_called(members, data["same"]) for kind, members in kinds.items()}
    return Everyday(
        groups=frozen, kinds=kinds, purposes=data["purposes"], beside=data["beside"], ages=data["ages"], **listed
    )


@functools.cache
def _listed() -> frozenset[str]:
    return frozenset(everyday().groups).union(*everyday().kinds.values())


def is_everyday(noun: str) -> bool:
    """Is it the name of an everyday thing of the lists?

    >>> is_everyday("bicycle"), is_everyday("story")
    (True, False)
    """
    return name_parts(noun).text in _listed()


def share_a_name(noun: str, name: str) -> bool:
    """Whether both are in one group of the list: "picture" may be said of everything, and of a painting by its name."""
    groups = everyday().groups
    return bool(groups.get(noun, frozenset()) & groups.get(name, frozenset()))


def _members(kind: str, listed: Mapping[str, Sequence[str]]) -> frozenset[str]:
    """The names of things that people count as a kind, with those of the kinds in it."""
    members = next((of for line, of in listed.items() if kind in line.split(", ")), ())
    inside = [_members(one, listed) for one in members if one != kind]
    return frozenset([name_parts(one).text for one in members]).union(*inside)


def _also_called(members: frozenset[str], same: Sequence[Sequence[str]]) -> frozenset[str]:
    """The names of things, with the other names of each: a refrigerator is an appliance, and so is a fridge."""
    names = [[name_parts(str(name)).text for name in line] for line in same]
    return members.union(*(line for line in names if not members.isdisjoint(line)))


@functools.lru_cache(maxsize=8192)
def name_parts(name: str) -> Name:
    """The parts of a name. What follows "of" comes first, "bottle of wine" is "wine bottle", but not where the word
    before it only measures: "head of lettuce" is lettuce. A number comes first too: "cube 3" is a cube."""
    words = tuple(part for word in normalise(name).split(" ") for part in _split(word))
    head = head_index(words)
    if head < len(words) - 1:
        before, after = words[: head + 1], words[head + 2 :]
        if words[head + 1].isdigit():
            words = (*words[head + 1 :], *before)
        elif words[head + 1] == "of":
            words = (*before, *after) if before[-1] in measures() else (*after, *before)
        else:
            words = before
    words = tuple(w if w == "glasses" else singular(w) for w in words)
    return Name(words, " ".join(words), "".join(w.removesuffix("s") if w != "glasses" else w for w in words))


def _split(word: str) -> tuple[str, ...]:
    """The two nouns that are written as one that WordNet does not know: ("glass", "bottle") of "glassbottle"."""
    if len(word) < 7 or not word.isalpha() or word in nouns() or singular(word) in nouns():
        return (word,)
    for cut in range(len(word) - 3, 2, -1):
        if word[:cut] in nouns() and word[cut:] in nouns() and min(cut, len(word) - cut) > 2:
            return word[:cut], word[cut:]
    return (word,)
