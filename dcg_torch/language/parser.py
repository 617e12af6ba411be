"""Command text -> weighted readings, or a sentence that says why there is none."""

from __future__ import annotations

import bisect
import functools
import gc
import math
from collections.abc import Collection, Hashable, Sequence
from dataclasses import dataclass, fields
from operator import attrgetter

from dcg_torch.english.dictionary import english
from dcg_torch.language.attachment import build
from dcg_torch.language.candidates import is_content
from dcg_torch.language.clauses import Clause, split
from dcg_torch.language.decisions import Decisions, best_first
from dcg_torch.language.items import END, Item, Kind
from dcg_torch.language.lexicon import CHOICES, VERBS
from dcg_torch.language.phrases import items
from dcg_torch.language.refusals import MOTION, NO_THING, NONE, refuse, talk
from dcg_torch.language.repairs import repair
from dcg_torch.language.tagging import Path, paths
from dcg_torch.language.target import root
from dcg_torch.language.tokens import mend, names, normal_noun, tokens
from dcg_torch.types import ParseTree, Phrase, PhraseKind

MAX_CHARACTERS = 600
MAX_WORDS = 120  # four times the longest of most thousand human commands; the time goes with the number of words
_PATHS, _RUNS_A_READING = 3, 2
_SAID = attrgetter(*(field.name for field in fields(Phrase) if field.name != "text"))


@dataclass(frozen=True, slots=True)
class Reading:
    """One way to read a command.

    Attributes:
        tree: what it says, in the form of the package's docstring.
        log_weight: log p(reading | command) before the world has spoken, over the readings kept.
        rules: the weighted choices that led here, as "rule=option".
        unread: content words that no phrase uses.
    """

    tree: ParseTree
    log_weight: float
    rules: tuple[str, ...] = ()
    unread: tuple[str, ...] = ()


@dataclass(frozen=True, slots=True)
class Parse:
    """What a command says: readings, the likeliest first, or else the `problem` in words.

    `refused` says why a command is no order about a thing; it then has no reading, and the problem is the same.
    """

    text: str
    readings: tuple[Reading, ...] = ()
    problem: str | None = None
    refused: str | None = None

    @property
    def tree(self) -> ParseTree | None:
        """The likeliest reading's tree."""
        return self.readings[0].tree if self.readings else None

    @property
    def unread(self) -> tuple[str, ...]:
        """The content words that the likeliest reading leaves unread."""
        return self.readings[0].unread if self.readings else ()

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
    """Reads commands. Loading takes a tenth of a second, a command a few milliseconds."""

    def parse(self, text: str, vocabulary: Collection[str] = (), k: int = 4) -> Parse:
        """At most `k` readings of `text`.

        `vocabulary` holds nouns known to the robot. They serve to mend misspelt words and to keep nouns of several
        words together; a command may name anything else.
        """
        if not text.strip():
            return Parse(text, problem="the command is empty")
        if len(text) > MAX_CHARACTERS:
            return Parse(text, problem=f"the command is longer than {MAX_CHARACTERS} characters")
        words = tokens(text)
        if len(words) > MAX_WORDS:
            return Parse(text, problem=f"the command is longer than {MAX_WORDS} words")
        command = _Command(words, frozenset(map(normal_noun, vocabulary)), names(text))
        found: dict[Hashable, Reading] = {}
        reason, nothing = NO_THING, -math.inf  # the log-weight of the likeliest reading that means no thing
        for read, decisions in best_first(command.read, _RUNS_A_READING * k):
            if isinstance(read, Reading):
                found.setdefault(_shape(read.tree), read)
            elif nothing == -math.inf:
                nothing, reason = decisions.log_weight + CHOICES["no_thing"] * (read == NO_THING), read
            if len(found) == k:
                break
        if max((reading.log_weight for reading in found.values()), default=-math.inf) <= nothing:
            return Parse(text, problem=reason, refused=reason)
        return Parse(text, _normalised(list(found.values())))


class _Command:
    """The words of a command, and what of them is the same in all readings."""

    def __init__(self, words: list[str], known: frozenset[str], names: frozenset[str]) -> None:
        self.known, self.names, self.kept, self.mended = known, names, words, mend(words, known | names)
        self.tagged: dict[bool, tuple[dict[str, Path], list[tuple[int, int, str]]]] = {}

    def read(self, decisions: Decisions) -> Reading | str:
        """One reading, its weight not yet normalised; where the command has no tree, why not."""
        doubtful = len(self.mended) == len(self.kept) and self.mended != self.kept
        mended = not doubtful or decisions.choose("spelling", CHOICES["spelling"]) == "mended"
        words = self.mended if mended else self.kept
        if mended not in self.tagged:
            self.tagged[mended] = _named(paths(words, self.known, self.names, _PATHS)), talk(words)
        tagged, parts = self.tagged[mended]
        weights = {name: CHOICES["scale"] * path.weight for name, path in tagged.items()}
        said = items(tagged[decisions.choose("words", weights)].tokens)
        groups = split(repair(said), parts)
        last = _supplied(groups)
        clauses = [build(group, n < last, decisions) for n, group in enumerate(groups)]
        stops = [item.start for item in said if item.kind is Kind.STOP]
        for clause, group in zip(clauses, groups, strict=True):
            clause.sentence = bisect.bisect(stops, group[0].start)
            refuse(clause, group, parts, words)
        tree = root(clauses, decisions)
        if tree is None:
            return parts[0][2] if parts else _reason(clauses)
        unread = _unread(words, said, clauses)
        return Reading(tree, decisions.log_weight + CHOICES["unread"] * len(unread), decisions.rules, unread)


def _unread(words: Sequence[str], said: Sequence[Item], clauses: Sequence[Clause]) -> tuple[str, ...]:
    """The content words that are in no phrase."""
    nodes = [item for item in said if item.said or item.kind not in {Kind.ADVERB, Kind.NOUN, Kind.VERB}]
    for clause in clauses:
        nodes += [node for top in (clause.verb or END, *clause.objects, *clause.places) for node in top.walk()]
    used = {i for node in nodes for i in range(node.start, node.stop)}
    return tuple(word for i, word in enumerate(words) if i not in used and is_content(word))


def _reason(clauses: Sequence[Clause]) -> str:
    """Why clauses have no tree."""
    if any(noun.negative for clause in clauses for noun in clause.objects):
        return NONE
    return MOTION if any(clause.action in VERBS["go"] | VERBS["look"] for clause in clauses) else NO_THING


def _named(found: Sequence[Path]) -> dict[str, Path]:
    """Paths by a number and the tags that not all of them have: what they take words for."""
    common = set.intersection(*({id(token) for token in path.tokens} for path in found))
    differing = ["+".join(token.tag for token in path.tokens if id(token) not in common) for path in found]
    return {f"{tags or 'same'} {n}": path for n, (tags, path) in enumerate(zip(differing, found, strict=True))}


def _supplied(groups: Sequence[Sequence[Item]]) -> int:
    """The number of the last clause that puts "it" somewhere, so that those before need no destination; -1: none."""
    firsts = [{item.kind: item for item in reversed(group)} for group in groups]
    puts = [first.get(Kind.VERB, END).is_a("putting") and first.get(Kind.NOUN, END).is_a("it") for first in firsts]
    return max((n for n, put in enumerate(puts) if put), default=-1)


def _shape(tree: ParseTree) -> Hashable:
    """A tree without its texts: two readings of one shape are one."""
    return _SAID(tree.phrase), tuple(map(_shape, tree.children))


def _normalised(readings: list[Reading]) -> tuple[Reading, ...]:
    readings.sort(key=lambda reading: -reading.log_weight)
    top = readings[0].log_weight
    total = top + math.log(sum(math.exp(reading.log_weight - top) for reading in readings))
    return tuple(Reading(r.tree, r.log_weight - total, r.rules, r.unread) for r in readings)


@functools.cache
def default_parser() -> Parser:
    """One parser for the whole process, loaded at the first call.

    What is loaded by then leaves Python's cyclic garbage collector: walking it would stop a command now
    and then, and it lives as long as the process anyway.
    """
    english()
    gc.freeze()
    return Parser()


def parse_command(text: str, vocabulary: Collection[str] = (), k: int = 4) -> Parse:
    """`Parser.parse` of the process's parser."""
    return default_parser().parse(text, vocabulary, k)
