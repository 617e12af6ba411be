"""What a word may be: its tags with their log-weights, from the closed classes, the colours and the dictionary.

What a word may be does not depend on what the robot has learned, but for one thing: a noun of the vocabulary that is
nothing else in the language of commands is a surer noun.
"""

from __future__ import annotations

import functools
import re
from typing import Final

from dcg_torch.english.dictionary import irregular
from dcg_torch.english.forms import is_compared, parts, singular, verb
from dcg_torch.language.colors import SINGLE_COLORS, normal_color
from dcg_torch.language.lexicon import GRAMMAR, NORMAL, PLACING, SETS, listed

_RULES: Final = [
    *(([name], tags) for name, tags in GRAMMAR["lists"].items()),
    *((row.split(), tags) for row, tags in GRAMMAR["words"]),
]
_ASKED: Final = SETS.keys() & {*GRAMMAR["seldom_nouns"], *(name.lstrip("-") for row, _ in _RULES for name in row)}
_CLOSED: Final = listed(GRAMMAR["lists"].keys() - GRAMMAR["open_lists"].split())
_FIXED: Final = listed(GRAMMAR["fixed_lists"].split())
_EMPTY: Final = listed(GRAMMAR["empty_lists"].split())
_SHAPES: Final = {name: re.compile(pattern) for name, pattern in GRAMMAR["shapes"].items()}


@functools.lru_cache(8192)
def candidates(word: str) -> tuple[tuple[str, float], ...]:
    """The tags that a word may have, each with its log-weight."""
    told, found = _features(word), dict[str, float]()
    for row, tags in _RULES:
        if row[0] in told and all((name[0] != "-") is (name.lstrip("-") in told) for name in row):
            for tag, weight in tags.items():
                found[tag] = max(found.get(tag, -99.0), weight - told.get(row[0], 0.0))
            told |= dict.fromkeys(("tagged", *tags), 0.0)
    return tuple(found.items())


def _features(word: str) -> dict[str, float]:
    """What the rules of `grammar.yaml` ask of a word; of its parts of speech, how much seldomer it is one."""
    known, base, stem = parts(word), singular(word), verb(word)
    if base != word and ("n" in parts(base) or (stem == word and not known)):
        known["n"] = max(known.get("n", 0), parts(base).get("n", 0))
    told = {part: GRAMMAR["step"] * (max(known.values()) - often) for part, often in known.items()}
    color, shapes = normal_color(word), {name for name, pattern in _SHAPES.items() if pattern.fullmatch(word)}
    asked = {
        **dict.fromkeys(shapes, True),
        **{name: word in SETS[name] for name in _ASKED},
        "normal": word in NORMAL,
        "color": color in SINGLE_COLORS,
        "basic_color": color in SETS["basic_colors"],
        "open": "plain" in shapes and not is_fixed(word),
        "compared": is_compared(word),
        "unknown": not known and stem == word,
        "plural": base != word,
        "derived": stem != word,
        "form": stem != word or (word, "v") in irregular(),
        "closed": word in _CLOSED,
        "command": base in SETS["commands"],
    }
    told |= dict.fromkeys((name for name, holds in asked.items() if holds), 0.0)
    if "n" in told:
        told["n"] += next((less for name, less in GRAMMAR["seldom_nouns"].items() if name in told), 0.0)
        told["n"] += GRAMMAR["gerund_noun"] if {"derived", "ing"} <= told.keys() else 0.0
    return told


def is_fixed(word: str) -> bool:
    """Whether a word is grammar and nothing else: "the", "and", "me"."""
    return word in _FIXED or word in PLACING["single"]


@functools.lru_cache(4096)
def is_plain_noun(word: str) -> bool:
    """Whether nothing in the language of commands is called by a word, so that it can only name things."""
    closed = word in _CLOSED or verb(word) in SETS["commands"]
    return not (closed or is_fixed(word) or normal_color(word) in SINGLE_COLORS)


def is_content(word: str) -> bool:
    """Whether a word says something of the world."""
    return not (is_fixed(word) or word in _EMPTY or singular(word) in SETS["measures"] or not word[:1].isalpha())
