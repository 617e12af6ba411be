"""Clauses -> the tree of the one that names the object meant."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

from dcg_torch.language import lexicon as lx
from dcg_torch.language.clauses import Clause, main_object
from dcg_torch.language.items import Item, Kind
from dcg_torch.types import ParseTree, Phrase, PhraseKind


@dataclass(slots=True, eq=False)
class Choice:
    """A noun phrase that may be the one meant, the clause it is in, and how surely the verb is about it."""

    noun: Item
    clause: Clause
    score: float
    place: Item | None = None  # the prepositional phrase it stands in


def choices(clauses: Sequence[Clause]) -> list[Choice]:
    """Every noun phrase that some clause is about, in the order of the command."""
    found: list[Choice] = []
    for clause in clauses:
        verb = clause.verb.words[0].split()[0] if clause.verb else ""
        penalty = 10.0 if clause.negated else 0.0
        target = main_object(clause)
        if target is not None:
            score = (
                5.0 if verb in (lx.PUT | lx.TAKE) - {"open", "close"} else 4.0 if verb in lx.REACH - lx.LOOK else 2.0
            )
            if verb in lx.SHUN:
                score = 1.8
            elif clause.statement or not verb:
                score = 1.5
            elif verb in lx.LOOK:
                score = 2.5
            found.append(Choice(target, clause, score - penalty))
            if verb in lx.PUT | lx.TAKE:
                continue
        for place in clause.places:
            name = place.words[0]
            score = 4.0 if name in {"to", "towards", "onto", "into"} else 3.5 if name in lx.GOALS else 1.0
            if verb in lx.LOOK or target is not None:
                score = min(score, 2.2)
            if name in {"away from", "far from", "farther from"}:
                score = 1.8
            if name in {"instead of", "without", "like", "about"}:
                score = 0.1
            child = place.children[0]
            if child.noun in lx.DIRECTIONS | {"you"} and not child.children:
                continue
            found.append(Choice(child, clause, score - penalty, place))
    return found


def root(clauses: Sequence[Clause]) -> ParseTree | None:
    """The tree of the clause that names the object meant, or None if none does.

    An object to be handled is the first one named, the goal of a drive the last ("go past the cube to the cone").
    "it" stands for the noun phrase before, and "the middle one" for one of several that were named before.
    """
    found = choices(clauses)
    if not found:
        return None
    best = max(choice.score for choice in found)
    top = [choice for choice in found if choice.score == best]
    chosen = top[0] if best == 5.0 else top[-1]
    empty = chosen.noun.color is None and not chosen.noun.words and not chosen.noun.children
    if chosen.noun.pronoun and (empty or chosen.noun.text in {"it", "they", "them"}):
        earlier = [choice for choice in found[: found.index(chosen)] if not choice.noun.pronoun]
        if earlier:
            chosen = max(earlier, key=lambda choice: (choice.score, found.index(choice)))
    verb = chosen.clause.verb
    children: list[Item]
    if chosen.place is not None:
        others = [place for place in chosen.clause.places if place is not chosen.place]
        children = [chosen.place, *others]
    else:
        children = [chosen.noun, *_beside(chosen), *chosen.clause.places]
        if not chosen.clause.places:
            children += _later_destination(chosen, clauses)
    _describe_later(chosen, clauses)
    if chosen.noun.noun is None:
        _one_of_several(chosen.noun, clauses)
    words = (*verb.words, *(("not",) if chosen.clause.negated else ())) if verb else ()
    phrase = Phrase(PhraseKind.VERB, verb.text if verb else "", words)
    return ParseTree(phrase, tuple(freeze(child) for child in children))


def _beside(chosen: Choice) -> list[Item]:
    objects = chosen.clause.objects
    at = next(k for k, noun in enumerate(objects) if noun is chosen.noun)
    later = objects[at + 1 :]
    if chosen.clause.verb is None:
        later = later[: max((k + 1 for k, noun in enumerate(later) if noun.beside), default=0)]
    named = [noun for noun in later if not noun.pronoun or noun.color is not None or noun.words]
    return [noun for noun in named if noun.noun not in lx.DIRECTIONS or noun.children]


def _later_destination(chosen: Choice, clauses: Sequence[Clause]) -> list[Item]:
    """ "pick up the cube and put it on the block": where a later clause puts "it"."""
    at = next(k for k, clause in enumerate(clauses) if clause is chosen.clause)
    for clause in clauses[at + 1 :]:
        verb = clause.verb.words[0].split()[0] if clause.verb else ""
        if verb in lx.PUT and clause.places and all(noun.pronoun for noun in clause.objects):
            return clause.places
    return []


def _describe_later(chosen: Choice, clauses: Sequence[Clause]) -> None:
    """What a later sentence says of the object: "Go to the cone. It is behind the cube.", "... The red one."."""
    for clause in clauses:
        if clause is chosen.clause or not clause.objects or clause.verb is not None:
            continue
        more = clause.objects[0]
        if not more.pronoun or not (clause.statement or len(clause.objects) == 1):
            continue
        if more.color is None or chosen.noun.color is None:
            chosen.noun.color = chosen.noun.color or more.color
            chosen.noun.words += more.words
            chosen.noun.children += more.children


def _one_of_several(one: Item, clauses: Sequence[Clause]) -> None:
    """ "There are three cones ahead, go to the middle one", "in the row of cones, the last one"."""
    places = [child for clause in clauses for place in clause.places for child in place.children]
    named = [noun for clause in clauses for noun in clause.objects] + places
    several = [noun for noun in named if noun.plural and noun.noun is not None and noun.start < one.start]
    several = [noun for noun in several if all(node is not one for node in _below(noun))]
    if not several:
        return
    group = max(several, key=lambda noun: noun.start)
    one.noun, one.pronoun = group.noun, False
    one.color = one.color or group.color
    if lx.GROUPS.isdisjoint(group.words):
        one.children += group.children
    else:
        one.children.append(
            Item(Kind.PREPOSITION, group.start, group.stop, group.head, "in", ("in",), children=[group])
        )


def _below(item: Item) -> Iterator[Item]:
    yield item
    for child in item.children:
        yield from _below(child)


def freeze(item: Item) -> ParseTree:
    """An item and what hangs on it as values."""
    children = tuple(freeze(child) for child in item.children)
    if item.kind is Kind.PREPOSITION:
        return ParseTree(Phrase(PhraseKind.PREPOSITION, item.text, item.words), children)
    words = tuple(dict.fromkeys(item.words))
    phrase = Phrase(PhraseKind.NOUN, item.text, words, item.noun, item.color, item.plural, item.count)
    return ParseTree(phrase, children)
