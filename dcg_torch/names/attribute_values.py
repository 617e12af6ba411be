"""Words for the values of attributes: which keys and values each may mean, and which of them exclude one another.

They are listed in `data/values.yaml`. A value stands for itself as its key and its number in that key's list.
"""

from __future__ import annotations

import functools
from collections.abc import Collection, Sequence

from dcg_torch.names.normal_form import normalise, read_data

Value = tuple[str, int]
"""A key, and the number of a value in its list."""
_COMPARED = ("er", "est")
FREE = frozenset({"state", "texture"})
"""Keys of which several values may hold at once."""
NONE, SOME = "none", "has it"
"""The first words of the values of a thing that an object has or has not."""


@functools.cache
def value_meanings() -> tuple[dict[str, frozenset[Value]], frozenset[tuple[Value, Value]]]:
    """The values (key and number in its list) that each word may mean, and the pairs that exclude one another."""
    data = read_data("values.yaml")
    opposites = data.pop("opposites")
    for name in ("absent", "present", "part_of", "same_key", "clothes", "counted", "sides"):
        del data[name]
    found: dict[str, set[Value]] = {}
    values = [(key, k, words) for key, lists in data.items() for k, words in enumerate(lists)]
    for key, k, words in values:
        for word in words:
            found.setdefault(normalise(word), set()).add((key, k))
    named = {words[0]: (key, k) for key, k, words in values if key in FREE}
    pairs = {(named[one], named[other]) for one, other in opposites}
    pairs |= {
        ((key, j), (key, k))
        for key, lists in data.items()
        for j in range(len(lists))
        for k in range(len(lists))
        if j != k and key not in FREE and not (_had(lists) and 1 in (j, k) and 0 not in (j, k))
    }
    return {word: frozenset(meant) for word, meant in found.items()}, frozenset(pairs | {(k, j) for j, k in pairs})


@functools.cache
def _keys() -> frozenset[str]:
    """Those whose values are listed, but for shapes: letters are shapes as well."""
    meanings, _ = value_meanings()
    return frozenset(key for values in meanings.values() for key, _ in values) - {"shape"}


def _had(lists: Sequence[Sequence[str]]) -> bool:
    """Are these the values of a thing that an object has or has not, as of `beard`?"""
    return len(lists) > 1 and (lists[0][0], lists[1][0]) == (NONE, SOME)


def stated_values(words: Sequence[str]) -> tuple[str, ...]:
    """The phrases of several words among the words of a text that may state the value of an attribute.

    Of those that share words the longest counts.

    >>> stated_values("a chair seen from behind".split()), stated_values("with its back facing me".split())
    (('from behind',), ('back facing me',))
    """
    meanings, _ = value_meanings()
    found, taken = [], [False] * len(words)
    for n in (4, 3, 2):
        for k in range(len(words) - n + 1):
            span = " ".join(words[k : k + n])
            placed = (
                n == 2 and words[k + 1] == "side" and k > 0 and words[k - 1] == "the"
            )  # "on the left side" is a place
            if span in meanings and not placed and not any(taken[k : k + n]):
                found.append(span)
                taken[k : k + n] = [True] * n
    return tuple(dict.fromkeys(found))


@functools.lru_cache(maxsize=4096)
def describes(key: str, value: str) -> bool:
    """Does the value of a key say how a thing looks, stands or is made, or yes or no, rather than what it is called?

    Args:
        key: as `attribute_key` has it.
    """
    meanings, _ = value_meanings()
    plain = normalise(value)
    return (
        plain in meanings
        or plain in words_listed("absent") | words_listed("present")
        or not _keys().isdisjoint(key.split(" "))
    )


@functools.cache
def words_listed(what: str) -> frozenset[str]:
    """Values that say that what the key names is "absent" or "present"."""
    return frozenset(map(str, read_data("values.yaml")[what]))


def is_told_apart(value: str, key: str, values: Collection[str]) -> bool:
    """Is it one of several values of a key that may mean the same: "black" beside "brown" hair, which is dark as well?

    Args:
        values: those that are there, in normal form as the value is.
    """
    meanings, _ = value_meanings()
    meant = [values_under(meanings.get(one, frozenset()), key) for one in values if one != value]
    return value in values and any(one & values_under(meanings.get(value, frozenset()), key) for one in meant)


def says_value(phrase: str) -> bool:
    """Is it, as a whole, the value of some attribute: "red head"?"""
    return normalise(phrase) in value_meanings()[0]


def says_whether(word: str) -> bool:
    """Does a word say whether somebody has a thing: "bald", "bearded", "smiling"?"""
    meanings, _ = value_meanings()
    meant = meanings.get(normalise(word), frozenset())
    return not meant.isdisjoint(meanings[normalise(NONE)] | meanings[normalise(SOME)])


@functools.lru_cache(maxsize=4096)
def states_value(word: str, keys: frozenset[str]) -> bool:
    """May a word state the value of one of some keys: "bald" of `hair`, "woman" of `gender`?"""
    meanings, _ = value_meanings()
    return any(key in of.split(" ") for key, _ in meanings.get(normalise(word), ()) for of in keys)


@functools.lru_cache(maxsize=4096)
def size_side(word: str) -> int | None:
    """Does a word say that a thing is large (1), small (-1) or between (0)? None for others and for "largest".

    >>> size_side("huge"), size_side("tiny"), size_side("medium"), size_side("bigger"), size_side("tall")
    (1, -1, 0, None, None)
    """
    if word.endswith(_COMPARED) or not says_size(word):
        return None
    return dict(value_meanings()[0][word])["size"] - 1


@functools.lru_cache(maxsize=4096)
def says_size(word: str) -> bool:
    """Does a word say how large a thing is, or how large among others: "big", "biggest"?"""
    return {key for key, _ in value_meanings()[0].get(word, ())} == {"size"}


def values_under(values: frozenset[Value], key: str) -> frozenset[Value]:
    """The values that the key of an attribute leaves: "left" of an `orientation`; all, where the key is strange."""
    own = frozenset(v for v in values if v[0] in key.split(" "))
    return own or values
