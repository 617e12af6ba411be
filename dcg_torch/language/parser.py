"""Command text -> parse tree, or a sentence that says why there is none."""

from __future__ import annotations

import functools
import gc
from collections.abc import Collection, Sequence
from dataclasses import dataclass

from dcg_torch.language import lexicon as lx
from dcg_torch.language.attachment import build
from dcg_torch.language.chunks import items
from dcg_torch.language.clauses import split
from dcg_torch.language.items import Item, Kind
from dcg_torch.language.reader import Reader
from dcg_torch.language.target import root
from dcg_torch.types import ParseTree, PhraseKind

MAX_CHARACTERS = 400
MAX_WORDS = 64  # twice the longest of two thousand human commands; the time goes with the number of words


@dataclass(frozen=True, slots=True)
class Parse:
    """What a command says: a tree, or else the problem in words. Exactly one of the two is None."""

    text: str
    tree: ParseTree | None = None
    problem: str | None = None

    @property
    def noun(self) -> str | None:
        """The noun of the object meant, None if it has none ("the red one") or there is no tree."""
        return None if self.tree is None else target_phrase(self.tree).phrase.noun

    @property
    def color(self) -> str | None:
        """The colour stated of the object meant."""
        return None if self.tree is None else target_phrase(self.tree).phrase.color


def target_phrase(tree: ParseTree) -> ParseTree:
    """The noun phrase that the root's action is about: the first below the root, depth first.

    Objects named beside it ("the cube and the cone") are the noun phrases that follow it among its parent's children.

    Raises ValueError if the tree has no noun phrase.
    """
    for node in tree.walk():
        if node.phrase.kind is PhraseKind.NOUN:
            return node
    raise ValueError(f"the tree of {tree.phrase.text!r} has no noun phrase")


class Parser:
    """Reads commands. Loading takes half a second, a command a few milliseconds.

    Raises OSError if no English spaCy model is installed.
    """

    def __init__(self) -> None:
        self._reader = Reader()

    def parse(self, text: str, vocabulary: Collection[str] = ()) -> Parse:
        """The tree of `text`.

        `vocabulary` holds nouns known to the robot. They are used to mend misspelt words and to keep nouns of
        several words together; a command may name anything else.
        """
        if not text.strip():
            return Parse(text, problem="the command is empty")
        if len(text) > MAX_CHARACTERS:
            return Parse(text, problem=f"the command is longer than {MAX_CHARACTERS} characters")
        words = self._reader.words(text, vocabulary, MAX_WORDS)
        if words is None:
            return Parse(text, problem=f"the command is longer than {MAX_WORDS} words")
        found = items(words, self._reader, vocabulary)
        groups = split(found)
        clauses = [build(group, words, _supplied(groups, k)) for k, group in enumerate(groups)]
        tree = root(clauses)
        if tree is None:
            return Parse(text, problem="no object phrase found")
        return Parse(text, tree)


def _supplied(groups: Sequence[Sequence[Item]], k: int) -> bool:
    """Whether a later clause puts "it" somewhere, so that this one needs no destination."""
    for group in groups[k + 1 :]:
        verb = next((item for item in group if item.kind is Kind.VERB), None)
        objects = [item for item in group if item.kind is Kind.NOUN][:1]
        if verb is not None and verb.words[0] in lx.PUT and objects and objects[0].pronoun and objects[0].color is None:
            return True
    return False


@functools.cache
def default_parser() -> Parser:
    """One parser for the whole process, loaded at the first call.

    What is loaded by then leaves Python's cyclic garbage collector: walking spaCy's 200,000 objects would
    stop a command for up to 0.3 s now and then, and they live as long as the process anyway.
    """
    parser = Parser()
    gc.collect()
    gc.freeze()
    return parser


def parse_command(text: str, vocabulary: Collection[str] = ()) -> Parse:
    """`Parser.parse` of the process's parser."""
    return default_parser().parse(text, vocabulary)
