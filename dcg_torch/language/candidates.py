"""What a word may be: its tags with their log-weights, from the closed classes, the colours and the dictionary.

What a word may be does not depend on what the robot has learned, but for one thing: a noun of the vocabulary that is
nothing else in the language of commands is a surer noun.
"""

from __future__ import annotations

import functools
from typing import Final

from dcg_torch.english.dictionary import irregular
from dcg_torch.english.forms import is_compared, is_plural, parts, singular, verb
from dcg_torch.language.colors import normal_color, single_colors
from dcg_torch.language.lexicon import GRAMMAR, NORMAL, NUMBERS, PLACING, PRONOUNS, SETS, listed

_OPEN: Final = GRAMMAR["open"]
_CLOSED: Final = listed(GRAMMAR["lists"].keys() - GRAMMAR["open_lists"].split())
_FIXED: Final = listed(GRAMMAR["fixed_lists"].split())
_EMPTY: Final = listed(GRAMMAR["empty_lists"].split())
_LONGEST: Final = 40


@functools.lru_cache(8192)
def candidates(word: str) -> tuple[tuple[str, float], ...]:
    """The tags that a word may have, each with its log-weight."""
    found: dict[str, float] = {}
    for name, weights in GRAMMAR["lists"].items():
        if word in SETS[name]:
            _add(found, weights)
    if word in PRONOUNS:
        _add(found, GRAMMAR["pronoun"])
    if word in NUMBERS or word.isdecimal():
        _add(found, GRAMMAR["number"])
    if word.isdecimal() or (len(word) == 1 and word.isalpha()):
        _add(found, GRAMMAR["named_number"])
    if word in NORMAL and not found:
        _add(found, GRAMMAR["lists"]["modifiers"])
    _add_color(found, word)
    plain = word.replace("'", "").isalnum() and word.isascii() and not word.isdecimal() and len(word) <= _LONGEST
    if plain and not is_fixed(word):
        _add_open(found, word)
    return tuple(found.items())


def is_fixed(word: str) -> bool:
    """Whether a word is grammar and nothing else: "the", "and", "me"."""
    return word in _FIXED or word in PRONOUNS or word in NUMBERS or word in PLACING["single"]


@functools.lru_cache(4096)
def is_plain_noun(word: str) -> bool:
    """Whether nothing in the language of commands is called by a word, so that it can only name things."""
    closed = word in _CLOSED or verb(word) in SETS["commands"]
    return not (closed or is_fixed(word) or normal_color(word) in single_colors())


def is_content(word: str) -> bool:
    """Whether a word says something of the world."""
    return not (is_fixed(word) or word in _EMPTY or singular(word) in SETS["measures"] or not word[:1].isalpha())


def _add(found: dict[str, float], weights: dict[str, float], less: float = 0.0) -> None:
    for tag, weight in weights.items():
        found[tag] = max(found.get(tag, -99.0), weight - less)


def _add_color(found: dict[str, float], word: str) -> None:
    name, rule = normal_color(word), "color_seldom" if word in SETS["color_seldom"] else "color_and_noun"
    if name in single_colors():
        _add(found, GRAMMAR["color" if name in SETS["basic_colors"] or "n" not in parts(word) else rule])


def _add_open(found: dict[str, float], word: str) -> None:
    step, known = _OPEN["step"], parts(word)
    base, stem = singular(word), verb(word)
    if base != word and "n" in parts(base):
        known["n"] = max(known.get("n", 0), parts(base)["n"])
    if is_compared(word) and not found:
        _add(found, _OPEN["compared"])
    if not known and base == word and stem == word:
        if not found:
            _add_unknown(found, word)
        return
    most = max(known.values(), default=0)
    if "n" in known or (base != word and stem == word and not known):
        less = step * (most - known.get("n", 0)) + _noun_penalty(word)
        less += _OPEN["gerund_noun"] if stem != word and word.endswith("ing") else 0.0
        rule = "plural" if is_plural(word) else "color_noun" if normal_color(word) in SETS["basic_colors"] else "noun"
        _add(found, _OPEN[rule], less)
    other = {"v": stem != word or word in SETS["commands"], "a": bool(found.keys() & {"COL", "MOD"}), "r": False}
    for part in [part for part, told in other.items() if part in known and not told]:
        _add(found, _OPEN[part], step * (most - known[part]))
    if stem != word or (word, "v") in irregular():
        _add_inflected(found, word)
    if "N" not in found and not found.keys() & {"COL", "SIDE"} and word not in SETS["modifiers"]:
        _add(found, _OPEN["no_noun"])


def _add_unknown(found: dict[str, float], word: str) -> None:
    if word.endswith("ly"):
        _add(found, _OPEN["r"])
    elif word.endswith(("ing", "ed")) and len(word) > len("ring"):
        _add(found, _OPEN["unknown_participle"])
    _add(found, _OPEN["unknown"])


def _add_inflected(found: dict[str, float], word: str) -> None:
    if word.endswith("s"):
        _add(found, _OPEN["third_person"])
        return
    _add(found, _OPEN["inflected"])
    _add(found, _OPEN["participle"])
    if word.endswith("ing") and word not in SETS["modifiers"]:
        _add(found, _OPEN["gerund"])


def _noun_penalty(word: str) -> float:
    if word in SETS["ordinals"]:
        return float(_OPEN["ordinal_noun"])
    if word in _CLOSED:
        return float(_OPEN["closed_noun"])
    return float(_OPEN["unused_noun"]) if singular(word) in SETS["commands"] else 0.0
