"""What the attributes of an object say about words: named facts, to be weighed elsewhere."""

from __future__ import annotations

import functools
from collections.abc import Collection, Sequence
from typing import Final

from dcg_torch.names.color_names import color_evidence
from dcg_torch.names.normal_form import normalise, read_data
from dcg_torch.names.palette import region
from dcg_torch.names.weights import log_odds

ATTRIBUTE_FACTS: Final = (
    "attribute: equal",  # "wooden" said of "wooden"
    "attribute: alike",  # "facing left" said of `orientation: left`
    "attribute: contrary",  # "big" said of `size: small`
    "attribute: silent",  # nothing is known of the object in this respect
)
HAS, NOT_ = "with ", "not "
"""How words say that an object has what a key names: "with glasses", "with dark hair", "not with tie"."""
OF_KEY = ": "
"""Between key and values, "|" between these, of a word that states just that: "brand: shell", "digit: 7|8"."""
_KEY_ODDS = 1.5
"""Log-odds from which a noun names a key."""
_COMPARED = ("er", "est")
_FREE = frozenset({"state", "texture"})  # several values of such a key may hold at once
_NONE, _SOME = "none", "has it"  # the first words of the values of a thing that an object has or has not


@functools.cache
def _meanings() -> tuple[dict[str, frozenset[tuple[str, int]]], frozenset[tuple[tuple[str, int], tuple[str, int]]]]:
    """The values (key and number in its list) that each word may mean, and the pairs that exclude one another."""
    data = read_data("values.yaml")
    opposites = data.pop("opposites")
    for name in ("absent", "present", "part_of", "same_key", "clothes", "counted", "sides"):
        del data[name]
    found: dict[str, set[tuple[str, int]]] = {}
    values = [(key, k, words) for key, lists in data.items() for k, words in enumerate(lists)]
    for key, k, words in values:
        for word in words:
            found.setdefault(normalise(word), set()).add((key, k))
    named = {words[0]: (key, k) for key, k, words in values if key in _FREE}
    pairs = {(named[one], named[other]) for one, other in opposites}
    pairs |= {
        ((key, j), (key, k))
        for key, lists in data.items()
        for j in range(len(lists))
        for k in range(len(lists))
        if j != k and key not in _FREE and not (_had(lists) and 1 in (j, k) and 0 not in (j, k))
    }
    return {word: frozenset(meant) for word, meant in found.items()}, frozenset(pairs | {(k, j) for j, k in pairs})


@functools.cache
def _keys() -> frozenset[str]:
    """Those whose values are listed, but for shapes: letters are shapes as well."""
    meanings, _ = _meanings()
    return frozenset(key for values in meanings.values() for key, _ in values) - {"shape"}


def _had(lists: Sequence[Sequence[str]]) -> bool:
    """Are these the values of a thing that an object has or has not, as of `beard`?"""
    return len(lists) > 1 and (lists[0][0], lists[1][0]) == (_NONE, _SOME)


def attribute_evidence(words: Collection[str], attributes: Collection[str]) -> tuple[str, ...]:
    """The facts that hold between words and the attributes of an object.

    >>> attribute_evidence(("big",), {"size: small"}), attribute_evidence(("facing left",), {"orientation: left"})
    (('attribute: contrary',), ('attribute: alike',))

    Args:
        words: adjectives and participles of a noun phrase; those that are no attribute at all say nothing.
        attributes: "orientation: left", or "held" for what is merely true.

    Returns:
        Some of `ATTRIBUTE_FACTS`, each once and in that order. A word that the attributes confirm is not "silent" or
        "contrary" too.
    """
    said = (word if HAS in word or OF_KEY in word else normalise(word) for word in words)
    found = {fact for word in said if (fact := _attribute_fact(word, frozenset(attributes))) is not None}
    return tuple(fact for fact in ATTRIBUTE_FACTS if fact in found)


def stated_values(words: Sequence[str]) -> tuple[str, ...]:
    """The phrases of several words among the words of a text that may state the value of an attribute.

    Of those that share words the longest counts.

    >>> stated_values("a chair seen from behind".split()), stated_values("with its back facing me".split())
    (('from behind',), ('back facing me',))
    """
    meanings, _ = _meanings()
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


@functools.lru_cache(maxsize=16384)
def _attribute_fact(word: str, attributes: frozenset[str]) -> str | None:
    if word.startswith(NOT_):
        found = _attribute_fact(word.removeprefix(NOT_), attributes)
        return _DENIED.get(found or "", found)
    pairs = [_pair(attribute) for attribute in attributes]
    if OF_KEY in word:
        key, _, stated = word.partition(OF_KEY)
        own = {value for of, value in pairs if of == key}
        held = not own.isdisjoint(stated.split("|"))
        return "attribute: equal" if held else "attribute: contrary" if own else "attribute: silent"
    if word.startswith(HAS):
        return _possession_fact(word.removeprefix(HAS), pairs)
    if any(word == value or (word == key and value not in _words_of("absent")) for key, value in pairs):
        return "attribute: equal"
    if any(word == key for key, _ in pairs):
        return "attribute: contrary"
    return _value_fact(word, pairs)


_DENIED = {
    "attribute: equal": "attribute: contrary",
    "attribute: alike": "attribute: contrary",
    "attribute: contrary": "attribute: alike",
}


def _value_fact(word: str, pairs: Sequence[tuple[str, str]]) -> str | None:
    """Of a word that may state a value, whatever the key."""
    meanings, excluded = _meanings()
    meant = meanings.get(word)
    if meant is None:
        return None
    if word in _words_of("sides"):
        return "attribute: silent"
    true = {one for key, value in pairs for one in _held(key, value)}
    if meant & true:
        return "attribute: alike"
    # What is true under one key excludes the word only if the word can mean nothing else that is consistent.
    contrary = any((one, other) in excluded for one in meant for other in true)
    return "attribute: contrary" if contrary else "attribute: silent"


@functools.lru_cache(maxsize=4096)
def _held(key: str, value: str) -> frozenset[tuple[str, int]]:
    """What the value of a key says. "No" says something of its own key alone: without a beard nobody is bald.

    What is not open is closed.
    """
    meanings, excluded = _meanings()
    state = {v for v in meanings.get(key, ()) if v[0] in _FREE}
    own = {v for v in meanings[normalise(_SOME)] if v[0] in key.split(" ")}
    if value in _words_of("absent"):
        none = {v for v in meanings[normalise(_NONE)] if v[0] in key.split(" ")}
        return frozenset(none | {other for one, other in excluded if one in state})
    told = frozenset(state) if value in _words_of("present") else _of_key(meanings.get(value, frozenset()), key)
    if not own and region(value) is not None and "hair" not in key.split(" "):
        told = frozenset(v for v in told if v[0] != "hair")  # a red shirt makes no redhead
    return told if own and told & meanings[normalise(_NONE)] else told | own


def _possession_fact(said: str, pairs: Sequence[tuple[str, str]]) -> str:
    """Of "glasses" or "dark hair" that an object is said to have."""
    named = [(k, v) for k, v in pairs if f" {said}".endswith(f" {k}")]
    if not named:
        return "attribute: silent"
    # Of two values of one key, `hasHair` and `hairColour`, "no" says most, and "yes" less than what it is like.
    bare = _words_of("present")
    key, value = max(named, key=lambda one: (len(one[0]), _is_none(*one), one[1] not in {one[0], *bare}, one))
    like = said.removesuffix(key).strip()
    if not like or _is_none(key, value):
        return "attribute: contrary" if _is_none(key, value) else "attribute: equal"
    if value == key or value in _words_of("present"):  # "the white beard": hair of the face is like that of the head
        whole = read_data("values.yaml")["part_of"].get(key)
        told = [(k, v) for k, v in pairs if k == whole and v not in _words_of("present") | _words_of("absent")]
        return _possession_fact(f"{like} {whole}", told) if told else "attribute: silent"
    *several, _ = parts = value.removesuffix(f" {key}").split(" ")
    if like in (value, *parts):
        return "attribute: equal"
    if several:  # "short hair" of "long black hair"
        facts = {_possession_fact(said, [(key, part)]) for part in parts}
        return "attribute: alike" if facts & {"attribute: equal", "attribute: alike"} else "attribute: contrary"
    value = parts[0]
    fact = _value_fact(like, [(key, value)]) if states_value(like, frozenset({key})) else None
    if fact is None and region(like) is not None:
        near = not {"color: equal", "color: same hue", "color: alike"}.isdisjoint(color_evidence(like, value))
        fact = "attribute: alike" if near else "attribute: contrary"
    return fact or "attribute: silent"


def _is_none(key: str, value: str) -> bool:
    """Does the value of a key say that there is none: "no", or "bald" of `hair`?"""
    meanings, _ = _meanings()
    none = {one for one in meanings[normalise(_NONE)] if one[0] in key.split(" ")}
    return value in _words_of("absent") or not none.isdisjoint(meanings.get(value, ()))


@functools.lru_cache(maxsize=4096)
def describes(key: str, value: str) -> bool:
    """Does the value of a key say how a thing looks, stands or is made, or yes or no, rather than what it is called?

    Args:
        key: as `attribute_key` has it.
    """
    meanings, _ = _meanings()
    plain = normalise(value)
    return (
        plain in meanings
        or plain in _words_of("absent") | _words_of("present")
        or not _keys().isdisjoint(key.split(" "))
    )


@functools.cache
def _words_of(what: str) -> frozenset[str]:
    """Values that say that what the key names is "absent" or "present"."""
    return frozenset(map(str, read_data("values.yaml")[what]))


def _pair(attribute: str) -> tuple[str, str]:
    """Key and value in normal form; what is merely true is its own value."""
    key, _, value = attribute.partition(":")
    return attribute_key(key), normalise(value) or attribute_key(key)


@functools.lru_cache(maxsize=4096)
def attribute_key(key: str) -> str:
    """What the key of an attribute names.

    >>> attribute_key("hasBeard"), attribute_key("hair_colour"), attribute_key("orientation")
    ('beard', 'hair', 'orientation')
    """
    words = normalise(key).split(" ")
    while len(words) > 1 and words[0] in ("has", "ha", "is", "with", "wears", "wear", "wearing"):
        words = words[1:]
    found = " ".join(words[:-1] if len(words) > 1 and words[-1] in ("color", "type") else words)
    return str(read_data("values.yaml")["same_key"].get(found, found))


@functools.lru_cache(maxsize=4096)
def counts(key: str) -> bool:
    """Are the values of a key numbers, so that 1 and 0 do not mean yes and no: "row"?"""
    return attribute_key(key) in _words_of("counted")


def is_clothing(key: str) -> bool:
    """Does a key or a noun name what people wear, of which a colour is told: "in black"?"""
    return key in _words_of("clothes")


@functools.lru_cache(maxsize=4096)
def named_key(noun: str, keys: frozenset[str]) -> str | None:
    """The key that a noun names: "glasses" for "spectacles"; None if it names none of them.

    Args:
        keys: as `attribute_key` has them.
    """
    near = [key for key in sorted(keys) if log_odds(noun, key) > _KEY_ODDS]
    return max(near, key=lambda key: log_odds(noun, key), default=None)


def is_told_apart(value: str, key: str, values: Collection[str]) -> bool:
    """Is it one of several values of a key that may mean the same: "black" beside "brown" hair, which is dark as well?

    Args:
        values: those that are there, in normal form as the value is.
    """
    meanings, _ = _meanings()
    meant = [_of_key(meanings.get(one, frozenset()), key) for one in values if one != value]
    return value in values and any(one & _of_key(meanings.get(value, frozenset()), key) for one in meant)


def says_value(phrase: str) -> bool:
    """Is it, as a whole, the value of some attribute: "red head"?"""
    return normalise(phrase) in _meanings()[0]


def says_whether(word: str) -> bool:
    """Does a word say whether somebody has a thing: "bald", "bearded", "smiling"?"""
    meanings, _ = _meanings()
    meant = meanings.get(normalise(word), frozenset())
    return not meant.isdisjoint(meanings[normalise(_NONE)] | meanings[normalise(_SOME)])


@functools.lru_cache(maxsize=4096)
def states_value(word: str, keys: frozenset[str]) -> bool:
    """May a word state the value of one of some keys: "bald" of `hair`, "woman" of `gender`?"""
    meanings, _ = _meanings()
    return any(key in of.split(" ") for key, _ in meanings.get(normalise(word), ()) for of in keys)


@functools.lru_cache(maxsize=4096)
def size_side(word: str) -> int | None:
    """Does a word say that a thing is large (1), small (-1) or between (0)? None for others and for "largest".

    >>> size_side("huge"), size_side("tiny"), size_side("medium"), size_side("bigger"), size_side("tall")
    (1, -1, 0, None, None)
    """
    if word.endswith(_COMPARED) or not says_size(word):
        return None
    return dict(_meanings()[0][word])["size"] - 1


@functools.lru_cache(maxsize=4096)
def says_size(word: str) -> bool:
    """Does a word say how large a thing is, or how large among others: "big", "biggest"?"""
    return {key for key, _ in _meanings()[0].get(word, ())} == {"size"}


def _of_key(values: frozenset[tuple[str, int]], key: str) -> frozenset[tuple[str, int]]:
    """The values that the key of an attribute leaves: "left" of an `orientation`; all, where the key is strange."""
    own = frozenset(v for v in values if v[0] in key.split(" "))
    return own or values
