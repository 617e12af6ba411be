"""Text -> words: one spelling for quotes, dashes and letters, fillers left out, misspelt words mended."""

from __future__ import annotations

import functools
import re
import unicodedata
from collections.abc import Collection, Sequence

from dcg_torch.english.dictionary import english
from dcg_torch.english.forms import is_compared, parts, singular, verb
from dcg_torch.english.spelling import Speller
from dcg_torch.language import lexicon as lx
from dcg_torch.language.candidates import is_plain_noun
from dcg_torch.language.colors import COLOR_NAMES, SINGLE_COLORS

_HYPHENATED = re.compile(r"\b([a-z]+)-([a-z]+)\b")
_NAME = re.compile(r"(?<=[a-z,] )[A-Z][a-z]+\b")
_CAMEL = re.compile(r"(?<=[a-z])(?=[A-Z])")
_LONG_ENOUGH, _LONG_COLOR = 3, 5
_STRANGE = 12  # words at most that are mended: more are no English, and each costs time


def tokens(text: str) -> list[str]:
    """The words and stops of a command.

    >>> tokens("Um, go to the red_cube, please!")
    ['go', 'to', 'the', 'red', 'cube', ',', 'please', '!']
    """
    text = unicodedata.normalize("NFKC", text).translate(lx.QUOTES).lower()
    text = text if text.isprintable() else "".join(" " if unicodedata.category(c)[0] == "C" else c for c in text)
    text = _HYPHENATED.sub(_swap, text)
    found: list[str] = []
    for token in lx.WORD.findall(lx.REWRITES.applied(text)):
        if token in lx.SETS["size_nouns"] and found and found[-1] in lx.SETS["sizes"]:
            found[-1] += "-sized"
        elif token not in lx.SETS["fillers"] and (found or not (token in lx.SETS["openings"] or token == ",")):
            found.append(token)
    return found


def names(text: str) -> frozenset[str]:
    """Words that are written like names: with a capital, inside a sentence of small letters. Plurals are none.

    >>> sorted(names("Follow Jules to the two Orange Blocks."))
    ['jules', 'orange']
    """
    found = (match.group().lower() for match in _NAME.finditer(text))
    return frozenset(word for word in found if singular(word) == word or "n" not in parts(singular(word)))


def _swap(match: re.Match[str]) -> str:
    """ "blue-sky" is "sky blue"."""
    swapped = " ".join(match.group(2, 1))
    return swapped if swapped in COLOR_NAMES and " ".join(match.groups()) not in COLOR_NAMES else match.group()


def normal_noun(name: str) -> str:
    """A noun as it is looked for in commands.

    >>> normal_noun("CoffeeTable"), normal_noun("traffic_cone")
    ('coffee table', 'traffic cone')
    """
    return " ".join(_CAMEL.sub(" ", name).replace("_", " ").replace("-", " ").lower().split())


def mend(words: Sequence[str], known: Collection[str]) -> list[str]:
    """Words with what is misspelt mended; what is English or among the `known` nouns stays as it is."""
    single = {noun for noun in known if " " not in noun}
    mended: list[str] = []
    strange = 0
    for word in words:
        if mended and mended[-1] + word in single and word not in single and is_plain_noun(mended[-1]):
            mended[-1] += word  # "mail box" where "mailbox" is known
        elif strange < _STRANGE and not is_english(word):
            strange += 1
            mended.append(_speller(frozenset(part for noun in known for part in noun.split())).correct(word))
        else:
            mended.append(word)
    return mended


@functools.lru_cache(8192)
def is_english(word: str) -> bool:
    """Whether a word is English: in the dictionary, an inflection of a word there, or of a closed class."""
    closed = (lx.NORMAL, *lx.SETS.values(), *lx.PLACING.values())
    forms = {word, singular(word), verb(word)}
    return not english().keys().isdisjoint(forms) or is_compared(word) or any(word in words for words in closed)


@functools.lru_cache(16)
def _speller(known: frozenset[str]) -> Speller:
    words = lx.listed(lx.GRAMMAR["spelt_lists"].split())
    single = {name for names in lx.PLACING.values() for name in names if " " not in name}
    colors = {color for color in SINGLE_COLORS if len(color) > _LONG_COLOR}
    commands = frozenset(word for word in words | single if len(word) > _LONG_ENOUGH) | colors
    return Speller([known, lx.SETS["basic_colors"], commands], is_english)
