"""The words of commands, loaded from `data/`: lists, patterns and weights.

Whatever is a list of words, a pattern or a number of the grammar stands there and not in code.
"""

from __future__ import annotations

import functools
import re
from collections.abc import Iterable, Iterator, Mapping
from typing import Any, Final

import yaml

from dcg_torch.english.dictionary import lines, read
from dcg_torch.english.patterns import FirstOf, New, Rewrites

_LOADER = getattr(yaml, "CSafeLoader", yaml.SafeLoader)
_FILES: Final = ("words.yaml", "grammar.yaml", "patterns.yaml")
_WORDS, GRAMMAR, _PATTERNS = (yaml.load(read(name, __package__), _LOADER) for name in _FILES)

VERBS: Final[Mapping[str, frozenset[str]]] = {name: frozenset(text.split()) for name, text in _WORDS["verbs"].items()}
"""Verbs by what they do with their object."""
SETS: Final[Mapping[str, frozenset[str]]] = {
    **{name: frozenset(text.split()) for name, text in _WORDS.items() if isinstance(text, str)},
    **{name: frozenset(_WORDS[name]) for name in ("pronouns", "numbers")},
    "commands": frozenset().union(*(VERBS[name] for name in ("put", "take", "go", "reach", "look"))),
}
"""Closed classes of words by name."""


def listed(names: Iterable[str]) -> frozenset[str]:
    """The words of several lists, of closed classes or of verbs."""
    return frozenset().union(*({**VERBS, **SETS}[name] for name in names))


TAGS: Final = {name: frozenset(text.split()) for name, text in GRAMMAR["tag_sets"].items()}
"""Tags by what they do in a phrase."""
PLACING: Final[Mapping[str, frozenset[str]]] = {
    name: frozenset(part.strip() for part in text.split(";")) for name, text in GRAMMAR["prepositions"].items()
}
"""Prepositions by what they can do."""
NUMBERS: Final[Mapping[str, int]] = _WORDS["numbers"]
_MAPS: Final[Mapping[str, Mapping[str, str]]] = {
    name: {key.strip(): new for new, keys in rows.items() for key in str(keys).split(";")}
    for name, rows in _PATTERNS["maps"].items()
}
NTH: Final[Mapping[str, str]] = _MAPS["nth"]
"""Ordinals by their numbers, as digits."""
PRONOUNS: Final[Mapping[str, str | None]] = _WORDS["pronouns"]
CHOICES: Final[Mapping[str, Any]] = GRAMMAR["choices"]
TARGETS: Final[Mapping[str, float]] = GRAMMAR["targets"]
PARTICLE_VERBS: Final = {name: frozenset(text.split()) for name, text in _WORDS["particle_verbs"].items()}
RELATION_VERBS: Final[Mapping[str, str]] = _WORDS["relation_verbs"]
COLOR_SPELLINGS: Final[Mapping[str, str]] = _WORDS["color_spellings"]
_SIZED: Final = {f"{size}{ending}": size for size in SETS["sizes"] for ending in SETS["size_endings"]}
NORMAL: Final[Mapping[str, str]] = {**_WORDS["normal"], **_SIZED, **_WORDS["size_words"]}
"""One word for those of one meaning: "furthest" is "farthest", "largish" is "large"."""


_PARTS: Final[dict[str, str]] = _PATTERNS["parts"] | {f":{name}": "|".join(rows) for name, rows in _MAPS.items()}
_ASKED: Final = re.compile(r"<(\w+):(\w+)>")


def _filled(pattern: str) -> str:
    """A pattern with its parts in it; `<:name>` is any word of a map."""
    return functools.reduce(lambda text, name: text.replace(f"<{name}>", _PARTS[name]), _PARTS, pattern)


def _mapped(word: str | None, name: str) -> str:
    """What stands in a map for a word, where numbers are digits; the word itself, if nothing does."""
    return _MAPS[name].get(str(NUMBERS.get(word or "", word or "")), word or "")


def _replacement(new: str) -> New:
    """What takes the place of a match: `<group:map>` is what the map has for the words of a group."""
    if not _ASKED.search(new):
        return new
    return lambda match: match.expand(_ASKED.sub(lambda asked: _mapped(match[asked[1]], asked[2]), new))


QUOTES: Final = str.maketrans(_PATTERNS["quotes"])
"""Typographic quotes, dashes and the ellipsis, as they are typed on a keyboard."""
REWRITES: Final = Rewrites(
    (_filled(old), _replacement(new), needs[0].split("|") if needs else ()) for old, new, *needs in _PATTERNS["rewrite"]
)
WORD: Final = re.compile(_PATTERNS["word"])
REFUSALS: Final = tuple((re.compile(_filled(row[0])), str(row[1])) for row in _PATTERNS["refusals"])
TALK: Final = tuple((re.compile(_filled(row[0])), str(row[1])) for row in _PATTERNS["refusals"] if len(row) > 2)
"""Those of the refusals that hold for a clause after another as well."""


_ROWS: Final = (_PATTERNS["phrases"], _PATTERNS["prepositions"])
_TOKENS: Final = [(FirstOf([_filled(row[0]) for row in rows]), rows) for rows in _ROWS]


def match_tokens(joined: str, offset: int) -> Iterator[tuple[str, tuple[str, ...], dict[str, float]]]:
    """The patterns that begin at a letter of a command's words joined by spaces: of phrases and prepositions the first.

    The words of each, what they mean in normal form and the weights that they have as which tag.
    """
    for first_of, rows in _TOKENS:
        if (found := first_of.match(joined, offset)) is not None:
            raw, number, way = found
            _, value, *tags = rows[number]
            way = str(NUMBERS.get(way, NORMAL.get(way, way)))
            words = value.replace("=", raw).replace("<way>", way).replace("<nth>", NTH.get(way, way))
            yield raw, tuple(words.split(";")), (*tags, {"P": 0.0})[0]


COMPOUNDS: Final = frozenset(tuple(line.split()) for line in lines("compounds.txt", __package__))
"""Nouns of several words whose words would be read one by one otherwise."""
