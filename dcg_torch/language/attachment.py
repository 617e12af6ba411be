"""Phrases in their order -> a tree. This is the one place that decides which phrase belongs to which.

spaCy's heads are right for most commands but weak for the ones that name two places ("place the red pyramid on the
green cube on the blue cube"): whether a prepositional phrase tells the object apart or says where it goes depends
on what the verb needs, so `_Clause.attach` decides by the verb and asks spaCy only between noun phrases.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field

from dcg_torch.language import lexicon as lx
from dcg_torch.language.chunks import Item, Kind
from dcg_torch.language.reader import Word
from dcg_torch.symbols import ParseTree, Phrase, PhraseKind


@dataclass(slots=True, eq=False)
class Clause:
    """A verb (None for a bare noun phrase) with its direct noun phrases and prepositional phrases."""

    verb: Item | None = None
    negated: bool = False
    objects: list[Item] = field(default_factory=list)
    places: list[Item] = field(default_factory=list)  # prepositional phrases that belong to the verb
    fronted: bool = False
    statement: bool = False


@dataclass(slots=True, eq=False)
class _Pending:
    """A prepositional phrase and what stands before it."""

    item: Item
    nouns: list[Item]
    forced: bool  # follows a relative pronoun or a participle: it can only tell a noun phrase apart
    joined: bool  # follows "and" or a comma


def split(items: Sequence[Item]) -> list[list[Item]]:
    """Cut a command into clauses: one main verb with all that follows it."""
    clauses: list[list[Item]] = [[]]
    relative = False
    for k, item in enumerate(items):
        before = items[k - 1] if k else None
        if item.kind is Kind.STOP:
            relative = False
            clauses.append([])
            continue
        if item.kind is Kind.RELATIVE:
            relative = True
        elif item.kind is Kind.COMMA and relative:
            relative = False
        elif item.kind is Kind.VERB and _is_main(items, k, relative) and not _is_statement(clauses[-1], items, k):
            relative = False
            tail: list[Item] = []
            # A negation, and a subject ("can you", "the robot should"), go with the verb that they precede.
            while clauses[-1] and clauses[-1][-1].kind in {Kind.NEGATION, Kind.AND, Kind.COMMA, Kind.ADVERB}:
                tail.insert(0, clauses[-1].pop())
            clauses.append([*tail, item])
            continue
        elif item.kind is Kind.NOUN and before is not None and before.kind is Kind.NOUN and _subject(items, k):
            relative = True  # "the block you are holding"
        clauses[-1].append(item)
    return [clause for clause in clauses if clause]


def _is_statement(clause: Sequence[Item], items: Sequence[Item], k: int) -> bool:
    """"The cone is behind the cube": the copula says something of the noun phrase before it."""
    if items[k].words[0] != "be" or any(item.kind is Kind.VERB for item in clause):
        return False
    after = items[k + 1] if k + 1 < len(items) else None
    named = after is not None and after.kind is Kind.NOUN and after.noun is not None
    return not named and any(item.kind is Kind.NOUN and item.noun not in {"you", "me"} for item in clause)


def _subject(items: Sequence[Item], k: int) -> bool:
    after = items[k + 1] if k + 1 < len(items) else None
    if after is None or after.kind is not Kind.VERB or items[k - 1].stop != items[k].start:
        return False
    return items[k].noun in {"you", "me"} and items[k - 1].noun not in lx.ROBOT


def _is_main(items: Sequence[Item], k: int, relative: bool) -> bool:
    item = items[k]
    before = items[k - 1] if k else None
    lemma = item.words[0].split()[0]
    if relative:
        # "... that is near you and put it there": a command verb after "and" ends the relative clause.
        joined = before is not None and before.kind in {Kind.AND, Kind.COMMA}
        return joined and not item.participle and lemma in lx.COMMANDS
    if before is not None and before.kind is Kind.ADVERB and k > 1:
        before = items[k - 2]
    if lemma == "be" and before is not None and before.kind is Kind.NOUN and before.noun not in {"you", "me"}:
        # "whichever cube is nearest": of the noun phrase, once the clause has its verb.
        clause = items[max((j for j in range(k) if items[j].kind in {Kind.STOP, Kind.AND}), default=-1) + 1 : k]
        if any(other.kind is Kind.VERB for other in clause):
            return False
    return not (item.participle and before is not None and before.kind is Kind.NOUN and before.noun not in {"you", "me"})


def build(clause_items: Sequence[Item], words: Sequence[Word], supplied: bool) -> Clause:
    """The clause of a list of items. `supplied`: a later clause says where the object goes ("and put it on ...")."""
    clause = Clause()
    pending: list[_Pending] = []
    nouns: list[Item] = []  # noun phrases so far, outermost first
    preposition: Item | None = None
    forced = joined = False
    relative = False
    after_copula = False
    negation = False
    for item in clause_items:
        if item.kind is Kind.NEGATION:
            negation = True
            if clause.verb is None or after_copula is False:
                clause.negated = True
        elif item.kind is Kind.RELATIVE:
            relative, forced = True, True
        elif item.kind in {Kind.AND, Kind.COMMA}:
            joined = True
            relative = forced = False
        elif item.kind is Kind.VERB:
            if clause.verb is None and not item.participle and not relative and not (nouns and item.words[0] == "be"):
                clause.verb = item
            elif clause.verb is None and not nouns:
                clause.verb = item
            elif item.words[0] == "be":
                after_copula = True
                if clause.verb is None and not relative:
                    clause.statement = True
                forced = True
            elif nouns and item.words[0] == "hold" and not relative_object(clause_items, item):
                nouns[-1 if nouns[-1].noun not in {"you", "me"} else -2 if len(nouns) > 1 else -1].words += ("held",)
                forced = False
            else:
                forced = True
                if relative_object(clause_items, item):
                    name = {"have": "with", "be": "with"}.get(item.words[0], item.words[0])
                    preposition = Item(Kind.PREPOSITION, item.start, item.stop, item.head, item.text, words=(name,))
                    pending.append(_Pending(preposition, list(nouns), True, False))
        elif item.kind is Kind.PREPOSITION:
            extreme = item.words[0] in lx.EXTREMES and bool(nouns) and not after_path(pending, nouns)
            preposition = item
            pending.append(_Pending(item, list(nouns), forced or extreme, joined))
            forced = joined = False
        elif item.kind is Kind.ADVERB:
            if preposition is None and nouns and item.words[0] in {"ahead", "left", "right"}:
                nouns[-1].words += item.words
        elif item.kind is Kind.NOUN:
            if relative and item.noun in {"you", "me"} and preposition is None:
                continue
            if nouns and preposition is None and not joined and item.noun in {"you", "me"} and _is_subject(clause_items, item):
                relative = True
                continue
            if preposition is not None and not preposition.children:
                if preposition.words[0] == "from" and nouns and _edge_of(nouns[-1], item):
                    article = "the " if item.noun in {"left", "right", "front", "back", "top", "bottom"} else ""
                    nouns[-1].words += (f"from {article}{item.noun}",)
                    pending.pop()
                else:
                    preposition.children.append(item)
                    nouns.append(item)
                if not (preposition.words[0] == "between"):
                    preposition = None
            elif preposition is not None and joined and preposition.words[0] == "between":
                preposition.children.append(item)
                nouns.append(item)
                preposition = None
            elif after_copula and nouns and forced:
                _merge(nouns[-1], item)
            elif joined and nouns and item.pronoun and item.color and not item.determined and not nouns[-1].color:
                _merge(nouns[-1], item)  # "the drill, yellow, behind you"
            elif joined and nouns and clause.verb is not None:
                _conjunct(item, nouns, pending, clause, words)
            elif item.noun in lx.MEASURES:
                pass
            else:
                clause.objects.append(item)
                nouns.append(item)
            joined = False
            if after_copula and forced and item.color and item.noun is None:
                after_copula = False
            forced = False
        if item.kind is not Kind.NEGATION:
            negation = negation and item.kind is not Kind.NOUN
    _settle(clause, pending, words, supplied)
    return clause


def relative_object(items: Sequence[Item], verb: Item) -> bool:
    """Whether a noun phrase follows the verb directly."""
    at = next(k for k, item in enumerate(items) if item is verb)
    return at + 1 < len(items) and items[at + 1].kind is Kind.NOUN and items[at + 1].noun not in lx.MEASURES


def _is_subject(items: Sequence[Item], noun: Item) -> bool:
    at = next(k for k, item in enumerate(items) if item is noun)
    return at + 1 < len(items) and items[at + 1].kind is Kind.VERB


def after_path(pending: Sequence[_Pending], nouns: Sequence[Item]) -> bool:
    return not nouns


def _edge_of(noun: Item, edge: Item) -> bool:
    ordered = any(word in lx.ORDINALS or word.endswith("est") for word in noun.words)
    return ordered and edge.noun in {"left", "right", "front", "back", "top", "bottom", "end", "me", "you"}


def _merge(noun: Item, predicate: Item) -> None:
    """"the block that is red", "the cube which is the biggest one": what a copula says of a noun phrase."""
    noun.color = noun.color or predicate.color
    noun.words += tuple(word for word in predicate.words if word not in noun.words)
    if noun.noun is None and predicate.noun is not None:
        noun.noun, noun.pronoun = predicate.noun, False


def _conjunct(
    item: Item, nouns: list[Item], pending: list[_Pending], clause: Clause, words: Sequence[Word]
) -> None:
    """"the cube and the cone": the second noun phrase stands beside the one that spaCy joins it to."""
    head = words[item.head].head
    partner = next((noun for noun in nouns if noun.start <= head < noun.stop), nouns[-1])
    for place in reversed(pending):
        if any(child is partner for child in place.item.children):
            place.item.children.append(item)
            nouns.append(item)
            return
    clause.objects.append(item)
    nouns.append(item)


def _settle(clause: Clause, pending: list[_Pending], words: Sequence[Word], supplied: bool) -> None:
    """Give each prepositional phrase its parent."""
    verb = clause.verb.words[0].split()[0] if clause.verb else ""
    full = [place for place in pending if place.item.children]
    target = main_object(clause)
    if verb in lx.PUT and target is not None and not supplied:
        goal = _destination(full, verb)
    elif verb in lx.TAKE | lx.GO and target is not None and not supplied:
        goal = next((place for place in full if place.item.words[0] in lx.STRONG and not place.forced), None)
    else:
        goal = None
    last: Item | None = None
    for place in pending:
        if not place.item.children:
            if place.nouns and place.item.words[0] in {"behind", "in front of", "opposite", "above", "under"}:
                place.nouns[-1].words += place.item.words
            continue
        name = place.item.words[0]
        path = name in lx.STRONG | lx.PATHS - {"with", "of", "like", "from", "without", "than", "as"}
        owner: Item | None
        if place is goal or not place.nouns:
            owner = None
        elif place.joined and last is not None and not place.forced and not (target is None and path):
            owner = last
        elif target is None and verb and not place.forced and path and not _about_noun(place):
            owner = None
        elif target is None and verb and not place.forced and not any(p.item.words[0] in lx.GOALS for p in full[: full.index(place)]):
            owner = None
        elif verb in lx.LOOK and target is None and not place.forced:
            owner = None
        else:
            owner = _nearest(place, words)
        if owner is None:
            clause.places.append(place.item)
        else:
            _below(owner, place.item)
        last = owner


def _about_noun(place: _Pending) -> bool:
    """"the cone to your left", "the cube to the right": to a side is where a thing is."""
    child = place.item.children[0]
    return place.item.words[0] == "to" and child.noun in {"left", "right", "side", "rear", "front"} and bool(place.nouns)


def _below(owner: Item, place: Item) -> None:
    child = place.children[0]
    if place.words[0] in {"to", "at", "in"} and child.noun in {"left", "right"}:
        place.words = ("on",)
    owner.children.append(place)


def _nearest(place: _Pending, words: Sequence[Word]) -> Item:
    """The noun phrase just before, passing over "me", "you" and sides, which nobody describes further."""
    candidates = [noun for noun in place.nouns if noun.noun not in {"me", "you"} | lx.MEASURES] or place.nouns
    if place.item.words[0] == "of":
        return candidates[-1]
    solid = [noun for noun in candidates if noun.noun not in lx.PLACES | {"hand"}] or candidates
    return solid[-1]


def _destination(places: list[_Pending], verb: str) -> _Pending | None:
    """Which phrase says where the object goes: a sure goal, else the last that does not only place a landmark."""
    free = [
        place
        for place in places
        if not (place.forced or place.item.words[0] in {"of", "with", "without"} or place.item.text.startswith("from"))
    ]
    # Each list is a stronger sign than the next: "to ...", "on a thing", "next to a thing", "in the corner".
    sure = [place for place in free if place.item.text.split()[0] in {"to", "onto", "into", "over"}]
    solid = [place for place in free if place.item.children[0].noun not in lx.PLACES]
    support = [place for place in solid if place.item.words[0] in lx.SUPPORTS]
    if sure:
        return sure[0]
    if support:
        return support[-1] if len(support) < 3 else support[1]
    if solid:
        return solid[-1]
    return free[0] if free else None


# Which noun phrase is meant ------------------------------------------------------------------------------------------


def main_object(clause: Clause) -> Item | None:
    """The direct object that is a thing: not the robot itself, a person spoken to, a measure or a direction."""
    for noun in clause.objects:
        if noun.noun not in lx.ROBOT | {"me", "way"} and (noun.noun not in lx.DIRECTIONS or noun.children):
            return noun
    return None


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
            score = 5.0 if verb in (lx.PUT | lx.TAKE) - {"open", "close"} else 4.0 if verb in lx.REACH - lx.LOOK else 2.0
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
    "it" stands for the noun phrase before.
    """
    found = choices(clauses)
    if not found:
        return None
    best = max(choice.score for choice in found)
    top = [choice for choice in found if choice.score == best]
    chosen = top[0] if best == 5.0 else top[-1]
    if chosen.noun.pronoun and chosen.noun.color is None and not chosen.noun.words and not chosen.noun.children:
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
    words = (*verb.words, *(("not",) if chosen.clause.negated else ())) if verb else ()
    phrase = Phrase(PhraseKind.VERB, verb.text if verb else "", words)
    return ParseTree(phrase, tuple(freeze(child) for child in children))


def _beside(chosen: Choice) -> list[Item]:
    objects = chosen.clause.objects
    at = next(k for k, noun in enumerate(objects) if noun is chosen.noun)
    return [noun for noun in objects[at + 1 :] if not noun.pronoun and chosen.clause.verb is not None]


def _later_destination(chosen: Choice, clauses: Sequence[Clause]) -> list[Item]:
    """"pick up the cube and put it on the block": where a later clause puts "it"."""
    at = next(k for k, clause in enumerate(clauses) if clause is chosen.clause)
    for clause in clauses[at + 1 :]:
        verb = clause.verb.words[0].split()[0] if clause.verb else ""
        if verb in lx.PUT and clause.places and all(noun.pronoun for noun in clause.objects):
            return clause.places
    return []


def _describe_later(chosen: Choice, clauses: Sequence[Clause]) -> None:
    """"Go to the cone. It is behind the cube.": a statement about "it" tells the object apart as well."""
    for clause in clauses:
        if clause.statement and clause is not chosen.clause and clause.objects and clause.objects[0].pronoun:
            for child in clause.objects[0].children:
                chosen.noun.children.append(child)


def freeze(item: Item) -> ParseTree:
    """An item and what hangs on it as values."""
    children = tuple(freeze(child) for child in item.children)
    if item.kind is Kind.PREPOSITION:
        return ParseTree(Phrase(PhraseKind.PREPOSITION, item.text, item.words), children)
    words = tuple(dict.fromkeys(item.words))
    phrase = Phrase(PhraseKind.NOUN, item.text, words, item.noun, item.color, item.plural, item.count)
    return ParseTree(phrase, children)
