"""Phrases in their order -> clauses: one main verb each, with all that follows it."""

from __future__ import annotations

import itertools
from collections.abc import Sequence
from dataclasses import dataclass, field, replace

from dcg_torch.language.items import END, Item, Kind, is_state
from dcg_torch.language.lexicon import RELATION_VERBS, SETS

BEFORE_VERB = frozenset({Kind.NEGATION, Kind.AND, Kind.COMMA, Kind.ADVERB})
_JOINTS = frozenset({Kind.AND, Kind.COMMA})


@dataclass(slots=True, eq=False)
class Clause:
    """A verb (None for a bare noun phrase) with its direct noun phrases and prepositional phrases.

    `refused` says why it is no order about a thing; `sentence` is the number of its sentence.
    """

    verb: Item | None = None
    negated: bool = False
    objects: list[Item] = field(default_factory=list)
    places: list[Item] = field(default_factory=list)  # prepositional phrases that belong to the verb
    statement: Item | None = None  # its copula, if it says something of a noun phrase
    acting: bool = False  # the object does what is ordered: "the top box moves left"
    apart: bool = False  # a comma or "then" stands before it: no mere end of the order before
    refused: str | None = None
    sentence: int = 0

    @property
    def action(self) -> str:
        """The verb without its particle, empty if there is none."""
        return self.verb.name.split()[0] if self.verb else ""

    @property
    def tells(self) -> bool:
        """Whether it orders nothing: no verb, or "there is"."""
        return self.verb is None or self.action in SETS["be"]


def main_object(clause: Clause) -> Item | None:
    """The direct object that is a thing: not the robot itself, a person spoken to, a measure or a direction."""
    return next((noun for noun in clause.objects if not noun.is_a("no_object")), None)


def split(items: Sequence[Item], talk: Sequence[tuple[int, int, str]] = ()) -> list[list[Item]]:
    """Cut a command into clauses: one main verb with all that follows it. `talk`: words that order nothing."""
    clauses: list[list[Item]] = [[]]
    relative = False
    for k, item in enumerate(items):
        if item.kind is Kind.STOP:
            relative = False
            said = clauses[-1] and any(start <= clauses[-1][0].start < stop for start, stop, _ in talk)
            if _is_fragment(items[k + 1 :]) and clauses[-1] and not said:
                clauses[-1].append(replace(item, kind=Kind.COMMA))
            else:
                clauses.append([])
            continue
        if item.kind in {Kind.RELATIVE, Kind.COMMA}:
            relative = item.kind is Kind.RELATIVE
        elif item.kind is Kind.VERB and _is_main(items, k, relative, clauses[-1]):
            relative = False
            item.words = ("be",) if _tells(items, k) else item.words
            tail: list[Item] = []
            # A negation, and a subject ("can you", "the robot should"), go with the verb that they precede.
            # Not so the "leftmost" of "the one that is leftmost and put it ...".
            goes = BEFORE_VERB
            while clauses[-1] and clauses[-1][-1].kind in goes:
                tail.insert(0, clauses[-1].pop())
                goes = _JOINTS if tail[0].kind in _JOINTS else BEFORE_VERB
            clauses.append([*tail, item])
            continue
        elif item.kind is Kind.NOUN and _subject(items, k):
            relative = True  # "the block you are holding"
        clauses[-1].append(item)
    return [clause for clause in clauses if clause]


def _is_fragment(after: Sequence[Item]) -> bool:
    """ "The ball. Green. On the left.": a sentence without a verb or a noun of its own goes on with the one before."""
    first = next((item for item in after if item.kind not in {Kind.COMMA, Kind.NEGATION}), END)
    sentence = itertools.takewhile(lambda item: item.kind is not Kind.STOP, after)
    whole = any(item.kind in {Kind.VERB, Kind.RELATIVE} for item in sentence)
    # "Blue. Not the dark one.", "A table. Not an end table."
    denied = bool(after) and after[0].kind is Kind.NEGATION
    described = (denied and first.is_a("kind")) or (first.is_a("color_word") and (denied or not first.determined))
    return not whole and (described or first.kind in {Kind.PREPOSITION, Kind.ADVERB})


def _is_statement(clause: Sequence[Item], items: Sequence[Item], k: int) -> bool:
    """ "The cone is behind the cube": the copula says something of the noun phrase before it."""
    verbs = [item for item in clause if item.kind is Kind.VERB]
    if items[k].name != "be" or any(verb.name != "be" for verb in verbs):
        return False
    if verbs:  # "it is on the left and is touching the cone"
        return items[k - 1].kind is Kind.AND
    after, one = (*items[k + 1 :], END)[0], next((item for item in clause if item.kind is Kind.NOUN), END)
    # But "the middle one is sick".
    named = after.noun is not None and not (one.pronoun and " " in one.text and is_state(after))
    # "It is the lower of the two cubes", "the red mug was a present".
    told = k and (items[k - 1].text in SETS["stands_for"] or (items[k - 1].noun and items[k].text in SETS["past"]))
    return (told or not named) and any(item.kind is Kind.NOUN and not item.is_a("someone") for item in clause)


def _is_inverted(clause: Sequence[Item], verb: Item) -> bool:
    """ "Behind the cube is a cone": what follows the copula is where the beginning says."""
    kinds = [item.kind for item in clause if item.kind not in {Kind.COMMA, Kind.ADVERB, Kind.AND}]
    return verb.name == "be" and kinds[:2] == [Kind.PREPOSITION, Kind.NOUN] and Kind.VERB not in kinds


def _subject(items: Sequence[Item], k: int) -> bool:
    """The "you" of "the block you are holding", the "it" of "the ball it is on the cube"."""
    before, item, after = (END, *items, END)[k : k + 3]
    acts = after.name == "be" if item.text in SETS["stands_for"] else item.is_a("someone")
    return acts and before.kind is Kind.NOUN and after.kind is Kind.VERB and before.stop == item.start


def _goes_on(item: Item, before: Item, clause: Sequence[Item]) -> bool:
    """ "(The blonde,) not wearing glasses", "(no hair,) has a beard": more of what a noun phrase by itself is like."""
    kinds = {other.kind for other in clause}
    more = item.participle if before.kind is Kind.NEGATION else item.finite and item.name in SETS["possessing"]
    return more and Kind.NOUN in kinds and Kind.VERB not in kinds


def _tells(items: Sequence[Item], k: int) -> bool:
    """ "My grandmother gave us that painting": a verb tells what somebody did, unlike "the cup placed on the table"."""
    before, item, after = (END, *items, END)[k : k + 3]
    past = item.participle and not item.text.endswith("ing") and item.name not in RELATION_VERBS
    done = item.stop == after.start and (after.determined or after.is_a("someone"))
    return past and done and before.kind is after.kind is Kind.NOUN


def _is_main(items: Sequence[Item], k: int, relative: bool, clause: Sequence[Item]) -> bool:
    """Whether a clause begins with the verb at `k`."""
    item = items[k]
    second, before = (END, END, *items[:k])[-2:]
    lemma = item.name.split()[0]
    if _goes_on(item, before, clause) or _is_statement(clause, items, k) or _is_inverted(clause, item):
        return False
    if item.participle and before.name == "be" and second.kind is Kind.NOUN and second.text not in SETS["people"]:
        return False  # "the block being held", "the cube is placed on ...", but "you are looking for"
    if relative:
        # "... that is near you and put it there": a command verb after "and" ends the relative clause.
        return before.kind in BEFORE_VERB - {Kind.NEGATION} and not item.participle and lemma in SETS["commands"]
    before = second if before.kind is Kind.ADVERB else before
    after_noun = before.kind is Kind.NOUN and not before.is_a("someone")
    since = itertools.takewhile(lambda other: other.kind not in {Kind.STOP, Kind.AND}, reversed(items[:k]))
    # "whichever cube is nearest": of the noun phrase, once the clause has its verb.
    predicate = lemma == "be" and any(other.kind is Kind.VERB for other in since)
    said_of = predicate or (item.participle and not _tells(items, k)) or item.finite or lemma == "have"
    return not (after_noun and said_of)
