"""Phrases in their order -> a tree. This is the one place that decides which phrase belongs to which.

spaCy's heads are right for most commands but weak for the ones that name two places ("place the red pyramid on the
green cube on the blue cube"): whether a prepositional phrase tells the object apart or says where it goes depends
on what the verb needs, so `_Clause.attach` decides by the verb and asks spaCy only between noun phrases.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field

from dcg_torch.language import lexicon as lx
from dcg_torch.language.items import Item, Kind
from dcg_torch.language.reader import Word


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
    """ "The cone is behind the cube": the copula says something of the noun phrase before it."""
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
    return not (
        item.participle and before is not None and before.kind is Kind.NOUN and before.noun not in {"you", "me"}
    )


def build(clause_items: Sequence[Item], words: Sequence[Word], supplied: bool) -> Clause:
    """The clause of a list of items. `supplied`: a later clause says where the object goes ("and put it on ...")."""
    return _Builder(clause_items, words).run(supplied)


class _Builder:
    """Walks over the items of a clause and notes what each could belong to."""

    def __init__(self, items: Sequence[Item], words: Sequence[Word]) -> None:
        self.items = items
        self.words = words
        self.clause = Clause()
        self.pending: list[_Pending] = []
        self.nouns: list[Item] = []  # noun phrases so far
        self.preposition: Item | None = None  # still waits for its noun phrase
        self.forced = False  # the next preposition tells the last noun phrase apart
        self.joined = False  # "and" or a comma stands before
        self.relative = False
        self.copula = False

    def run(self, supplied: bool) -> Clause:
        for k, item in enumerate(self.items):
            after = self.items[k + 1] if k + 1 < len(self.items) else None
            if item.kind is Kind.NEGATION:
                self.clause.negated = self.clause.negated or self.clause.verb is None or not self.copula
            elif item.kind is Kind.RELATIVE:
                self.relative = self.forced = True
            elif item.kind in {Kind.AND, Kind.COMMA}:
                self.joined, self.relative, self.forced = True, False, False
            elif item.kind is Kind.VERB:
                self.verb(item, after)
            elif item.kind is Kind.PREPOSITION:
                # "the cube closest to ..." can't be where the cube goes.
                extreme = item.words[0] in lx.EXTREMES and bool(self.nouns)
                self.preposition = item
                self.pending.append(_Pending(item, list(self.nouns), self.forced or extreme, self.joined))
                self.forced = self.joined = False
            elif item.kind is Kind.ADVERB:
                predicate = self.copula and item.words[0] in lx.MODIFIERS  # "the cube that is biggest"
                if self.preposition is None and self.nouns and (predicate or item.words[0] in {"ahead", *lx.SIDES}):
                    self.nouns[-1].words += (lx.NORMAL_WORDS.get(item.words[0], item.words[0]),)
            elif item.kind is Kind.NOUN and not self.is_subject(item, after):
                self.noun(item)
                self.joined = self.forced = False
        _settle(self.clause, self.pending, self.words, supplied)
        return self.clause

    def is_subject(self, item: Item, after: Item | None) -> bool:
        """The "you" of "the block that you hold", with and without "that"."""
        if item.noun not in {"you", "me"} or self.preposition is not None:
            return False
        if self.nouns and not self.joined and after is not None and after.kind is Kind.VERB:
            self.relative = True
        return self.relative

    def verb(self, item: Item, after: Item | None) -> None:
        name = item.words[0]
        direct = after is not None and after.kind is Kind.NOUN and after.noun not in lx.MEASURES
        main = not item.participle and not self.relative and name != "be"
        if self.clause.verb is None and (main or not self.nouns):
            self.clause.verb = item
        elif name == "be":
            self.copula = self.forced = True
            if self.clause.verb is None and not self.relative:
                self.clause.statement = True
        elif name == "hold" and self.nouns and not direct:
            things = [noun for noun in self.nouns if noun.noun not in {"you", "me"}] or self.nouns
            things[-1].words += ("held",)  # "the block you are holding"
            self.forced = False
        else:
            self.forced = True
            if direct:  # "the cube that has a cone on it", "the box facing the wall"
                name = {"have": "with"}.get(name, name)
                self.preposition = Item(Kind.PREPOSITION, item.start, item.stop, item.head, item.text, (name,))
                self.pending.append(_Pending(self.preposition, list(self.nouns), True, False))

    def noun(self, item: Item) -> None:
        place = self.preposition
        if place is not None and not place.children:
            if place.words[0] == "from" and self.nouns and _edge_of(self.nouns[-1], item):
                article = "the " if item.noun in lx.SIDES else ""
                self.nouns[-1].words += (f"from {article}{item.noun}",)  # "the second from the left"
                self.pending.pop()
            else:
                place.children.append(item)
                self.nouns.append(item)
            if place.words[0] != "between":
                self.preposition = None
        elif place is not None and self.joined:
            place.children.append(item)  # between this "and" that
            self.nouns.append(item)
            self.preposition = None
        elif self.copula and self.nouns and self.forced:
            _merge(self.nouns[-1], item)
        elif self.joined and self.nouns and _only_color(item) and not self.nouns[-1].color:
            _merge(self.nouns[-1], item)  # "the drill, yellow, behind you"
        elif self.joined and self.nouns and self.clause.verb is not None:
            _conjunct(item, self.nouns, self.pending, self.clause, self.words)
        elif item.noun not in lx.MEASURES:
            self.clause.objects.append(item)
            self.nouns.append(item)


def _only_color(item: Item) -> bool:
    return item.pronoun and item.color is not None and not item.determined


def _edge_of(noun: Item, edge: Item) -> bool:
    ordered = any(word in lx.ORDINALS or word.endswith("est") for word in noun.words)
    return ordered and edge.noun in {"left", "right", "front", "back", "top", "bottom", "end", "me", "you"}


def _merge(noun: Item, predicate: Item) -> None:
    """ "the block that is red", "the cube which is the biggest one": what a copula says of a noun phrase."""
    noun.color = noun.color or predicate.color
    noun.words += tuple(word for word in predicate.words if word not in noun.words)
    if noun.noun is None and predicate.noun is not None:
        noun.noun, noun.pronoun = predicate.noun, False


def _conjunct(item: Item, nouns: list[Item], pending: list[_Pending], clause: Clause, words: Sequence[Word]) -> None:
    """ "the cube and the cone": the second noun phrase stands beside the one that spaCy joins it to."""
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
        if name == "for" and place.item.children[0].noun in {"me", "you"}:
            continue  # "find it for me" says nothing of the thing
        path = name in lx.STRONG | lx.PATHS - {"with", "of", "like", "from", "without", "than", "as"}
        owner: Item | None
        if place is goal or not place.nouns:
            owner = None
        elif place.joined and last is not None and not place.forced and not (target is None and path):
            owner = last
        elif (
            (target is None and verb and not place.forced and path and not _about_noun(place))
            or (
                target is None
                and verb
                and not place.forced
                and not any(p.item.words[0] in lx.GOALS for p in full[: full.index(place)])
            )
            or (verb in lx.LOOK and target is None and not place.forced)
        ):
            owner = None
        else:
            owner = _nearest(place, words)
        if owner is None:
            clause.places.append(place.item)
        else:
            _below(owner, place.item)
        last = owner


def _about_noun(place: _Pending) -> bool:
    """ "the cone to your left", "the cube to the right": to a side is where a thing is."""
    child = place.item.children[0]
    return (
        place.item.words[0] == "to" and child.noun in {"left", "right", "side", "rear", "front"} and bool(place.nouns)
    )


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


def main_object(clause: Clause) -> Item | None:
    """The direct object that is a thing: not the robot itself, a person spoken to, a measure or a direction."""
    for noun in clause.objects:
        if noun.noun not in lx.ROBOT | {"me", "way"} and (noun.noun not in lx.DIRECTIONS or noun.children):
            return noun
    return None
