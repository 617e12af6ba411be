"""The words of commands, loaded from `data/`: lists, patterns and weights.

Whatever is a list of words, a pattern or a number of the grammar stands there and not in code.
"""

from __future__ import annotations

import functools
import re
from collections.abc import Mapping
from dataclasses import dataclass
from importlib import resources
from typing import Any, Final

import yaml

_LOADER = getattr(yaml, "CSafeLoader", yaml.SafeLoader)


def read(name: str) -> str:
    """The text of a file of `data/`."""
    return resources.files(__package__).joinpath("data", name).read_text(encoding="utf-8")


def lines(name: str) -> list[str]:
    """The lines of a file of `data/` that are neither empty nor comments."""
    return [line for line in read(name).splitlines() if line and not line.startswith("#")]


def _yaml(name: str) -> dict[str, Any]:
    loaded: dict[str, Any] = yaml.load(read(name), Loader=_LOADER)
    return loaded


_WORDS: Final = _yaml("words.yaml")
GRAMMAR: Final = _yaml("grammar.yaml")
_PATTERNS: Final = _yaml("patterns.yaml")

VERBS: Final[Mapping[str, frozenset[str]]] = {name: frozenset(text.split()) for name, text in _WORDS["verbs"].items()}
"""Verbs by what they do with their object."""
SETS: Final[Mapping[str, frozenset[str]]] = {
    **{name: frozenset(text.split()) for name, text in _WORDS.items() if isinstance(text, str)},
    "commands": frozenset().union(*(VERBS[name] for name in ("put", "take", "go", "reach", "look"))),
}
"""Closed classes of words by name."""
PLACING: Final[Mapping[str, frozenset[str]]] = {
    name: frozenset(part.strip() for part in text.split(";")) for name, text in GRAMMAR["prepositions"].items()
}
"""Prepositions by what they can do."""
NUMBERS: Final[Mapping[str, int]] = _WORDS["numbers"]
PRONOUNS: Final[Mapping[str, str | None]] = _WORDS["pronouns"]
CHOICES: Final[Mapping[str, Any]] = GRAMMAR["choices"]
TARGETS: Final[Mapping[str, float]] = GRAMMAR["targets"]
PARTICLE_VERBS: Final = {name: frozenset(text.split()) for name, text in _WORDS["particle_verbs"].items()}
RELATION_VERBS: Final[Mapping[str, str]] = _WORDS["relation_verbs"]
MISSPELT: Final[Mapping[str, str]] = _WORDS["misspelt"]
COLOR_SPELLINGS: Final[Mapping[str, str]] = _WORDS["color_spellings"]
_SIZED: Final = {f"{size}{ending}": size for size in SETS["sizes"] for ending in SETS["size_endings"]}
NORMAL: Final[Mapping[str, str]] = {**_WORDS["normal"], **_SIZED, **_WORDS["size_words"]}
"""One word for those of one meaning: "furthest" is "farthest", "largish" is "large"."""


def _filled(pattern: str) -> str:
    for name, part in _PATTERNS["parts"].items():
        pattern = pattern.replace(f"<{name}>", part)
    return pattern


REWRITES: Final = tuple((re.compile(_filled(old)), new) for old, new in _PATTERNS["rewrite"])
WORD: Final = re.compile(_PATTERNS["word"])
PHRASES: Final = tuple(
    (re.compile(rf"(?:{_filled(pattern)})(?= |$)"), tag, value.split(";"), weight)
    for pattern, tag, value, weight in _PATTERNS["phrases"]
)
REFUSALS: Final = tuple((re.compile(_filled(row[0])), str(row[1])) for row in _PATTERNS["refusals"])
TALK: Final = tuple((re.compile(_filled(row[0])), str(row[1])) for row in _PATTERNS["refusals"] if len(row) > 2)
"""Those of the refusals that hold for a clause after another as well."""
MEETING: Final = (re.compile(_PATTERNS["meeting"][0]), str(_PATTERNS["meeting"][1]))
GREETING: Final = re.compile(_PATTERNS["greeting"])
SAME: Final[Mapping[str, str]] = _PATTERNS["same"]
_NORMALS: Final = tuple(row[1] for row in _PATTERNS["prepositions"])
_WEIGHTS: Final = tuple(row[2] if len(row) > 2 else 0.0 for row in _PATTERNS["prepositions"])
_PREPOSITION: Final = re.compile(
    "|".join(f"(?P<p{i}>(?:{_filled(row[0])})(?= |$))" for i, row in enumerate(_PATTERNS["prepositions"]))
)


@dataclass(frozen=True, slots=True)
class PrepositionMatch:
    """A preposition of a command: its words, their number, its normal form (empty: only says how exactly).

    `weight` is what the pattern adds to the log-weight of a preposition.
    """

    raw: str
    length: int
    normal: str
    weight: float


def match_preposition(joined: str, offset: int) -> PrepositionMatch | None:
    """The preposition that begins at a letter of a command's words joined by spaces, or None."""
    match = _PREPOSITION.match(joined, offset)
    if match is None:
        return None
    raw, compass = match.group(), match["compass"]
    at = next(i for i in range(len(_NORMALS)) if match[f"p{i}"] is not None)
    normal = _NORMALS[at]
    if normal == "=":
        normal = SAME.get(raw, raw)
    return PrepositionMatch(raw, raw.count(" ") + 1, normal.replace("<compass>", compass or ""), _WEIGHTS[at])


@functools.cache
def compounds() -> frozenset[tuple[str, ...]]:
    """Nouns of several words whose words would be read one by one otherwise."""
    return frozenset(tuple(line.split()) for line in lines("compounds.txt"))
