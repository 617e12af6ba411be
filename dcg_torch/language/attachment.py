"""A clause's phrases in their order -> the clause: what is said of which noun phrase, what stands beside what.

This is the one place that decides which phrase belongs to which; `places` has its rules for prepositional phrases.
"""

from __future__ import annotations

from collections.abc import Sequence

from dcg_torch.language import lexicon as lx
from dcg_torch.language.clauses import Clause
from dcg_torch.language.items import Item, Kind
from dcg_torch.language.places import Pending, settle
from dcg_torch.language.reader import Word


def build(clause_items: Sequence[Item], words: Sequence[Word], supplied: bool) -> Clause:
    """The clause of a list of items. `supplied`: a later clause says where the object goes ("and put it on ...")."""
    return _Builder(clause_items, words).run(supplied)


class _Builder:
    """Walks over the items of a clause and notes what each could belong to."""

    def __init__(self, items: Sequence[Item], words: Sequence[Word]) -> None:
        self.items = items
        self.words = words
        self.clause = Clause()
        self.pending: list[Pending] = []
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
                self.pending.append(Pending(item, list(self.nouns), self.forced or extreme, self.joined))
                self.forced = self.joined = False
            elif item.kind is Kind.ADVERB:
                predicate = self.copula and item.words[0] in lx.MODIFIERS  # "the cube that is biggest"
                if self.preposition is None and self.nouns and (predicate or item.words[0] in {"ahead", *lx.SIDES}):
                    self.nouns[-1].words += (lx.NORMAL_WORDS.get(item.words[0], item.words[0]),)
            elif item.kind is Kind.NOUN and not self.is_subject(item, after):
                self.noun(item)
                self.joined = self.forced = False
        settle(self.clause, self.pending, self.words, supplied)
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
                self.pending.append(Pending(self.preposition, list(self.nouns), True, False))

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


def _conjunct(item: Item, nouns: list[Item], pending: list[Pending], clause: Clause, words: Sequence[Word]) -> None:
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
