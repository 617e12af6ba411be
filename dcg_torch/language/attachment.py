"""A clause's phrases in their order -> the clause: what is said of which noun phrase, what stands beside what.

`phrase_roles` decides where a noun phrase goes, `places` where a prepositional phrase goes.
"""

from __future__ import annotations

import itertools
from collections.abc import Sequence
from dataclasses import replace

from dcg_torch.language.clauses import BEFORE_VERB, Clause
from dcg_torch.language.decisions import Decisions
from dcg_torch.language.items import END, Item, Kind, deny, is_superlative, last_thing, settle_words
from dcg_torch.language.lexicon import CHOICES, PLACING, RELATION_VERBS, SETS, VERBS
from dcg_torch.language.phrase_roles import NounPhrases
from dcg_torch.language.places import settle


def build(items: Sequence[Item], supplied: bool, decisions: Decisions) -> Clause:
    """The clause of a list of items. `supplied`: a later clause says where the object goes ("and put it on ...")."""
    builder = _Builder(items, decisions)
    for item, after in itertools.pairwise((*items, END)):
        builder.step(item, after)
    clause, start = builder.clause, items[0].start
    lead = itertools.takewhile(lambda item: item.kind in BEFORE_VERB, items)
    clause.apart = any(item.kind is Kind.COMMA or item.text in SETS["sequels"] for item in lead)
    settle(clause, builder.pending, supplied, decisions)
    for noun, before in builder.ruled_out:
        if noun.pronoun and not (clause.objects or builder.pending):  # what is not purple is a thing without a name
            clause.objects = [Item(Kind.NOUN, start, start, "", pronoun=True)]
        for owner in [before] if before else clause.objects[:1]:
            deny(owner, noun)
    for noun in builder.nouns:
        settle_words(noun)
    return clause


class _Builder(NounPhrases):
    """Walks over the items of a clause and notes what each could belong to."""

    def step(self, item: Item, after: Item) -> None:
        """Read one item; `after` is the next."""
        # "That aren't red or blue", "not a cup, a jar or a bowl".
        behind = (one.text for one in self.items if one.start >= item.start and one.kind not in {Kind.NOUN, Kind.COMMA})
        still = self.was_denied and next(behind, "") == "or"
        joins = item.kind is Kind.AND and (after.kind is not Kind.NOUN or after.negative or still)
        if self.meant is not None and (joins or item.kind is Kind.COMMA or item.text == "nor"):
            self.nouns, self.meant = self.meant, None  # it goes on with what was spoken of before what is ruled out
        if item.kind is Kind.NEGATION:
            self.negation(item, after)
        elif item.kind is Kind.RELATIVE:
            self.relative = self.forced = True
            self.nouns = self.described(after)
        elif item.text == "but" and any(noun.is_a("all") for noun in self.nouns):
            # "Anything (on the table) but the cone".
            self.place(replace(item, kind=Kind.PREPOSITION, words=("except",)))
        elif item.kind in {Kind.AND, Kind.COMMA}:
            self.excluded = still and bool(self.ruled_out)
            self.joined, self.relative, self.forced, self.denied = True, False, still, still
            self.conjunction = item.text if item.kind is Kind.AND else ""
        elif item.kind is Kind.VERB:
            self.verb(item, after)
        elif item.kind is Kind.PREPOSITION:
            self.place(item)
        elif item.kind is Kind.ADVERB:
            self.adverb(item, after)
        elif item.kind is Kind.NOUN and (self.preposition is not None or not self.is_subject(item, after)):
            place = (END, *self.pending)[-1]
            apart = place.name in PLACING["having"] and item.is_a("quantified") and item.negative != self.last.negative
            if self.joined and (self.denied or apart) and item.noun and self.last in place.children:
                # "Not on the table or (on) the desk", "with no hat and (with) a red shirt".
                self.place(replace(place, words=("with" if apart else place.name.removeprefix("not "),), children=[]))
                self.pending[-1].before = place.before if apart else self.pending[-1].before
            self.noun(item)
            self.joined = self.forced = self.excluded = self.denied = False

    def described(self, verb: Item) -> list[Item]:
        """The noun phrases up to that of which a relative clause tells: "the cup on the table that is red"."""
        place, last = (END, *self.pending)[-1], self.last
        # "The cup by the jar that is by the box that is red", "the corner of the table that is near you".
        if not (place.before and last in place.children) or place.forced or place.name == "of" or last.is_a("grouping"):
            return self.nouns
        agree = [verb.text not in SETS["one_does" if n.plural else "several_do"] for n in (place.before[-1], last)]
        agree[1] = agree[1] and not last.is_a("pointed")
        options = CHOICES["relative"] if agree[0] == agree[1] else {"thing" if agree[0] else "landmark": 0.0}
        landmark = [last] if last.noun in SETS["tables"] else self.nouns
        return list(place.before) if self.decisions.choose("relative", options) == "thing" else landmark

    def negation(self, item: Item, after: Item) -> None:
        """Whether "not" denies what is said of a noun phrase, excludes a noun phrase, or is of the verb."""
        self.joined = self.joined or item.text == "nor"
        place = after.kind is Kind.PREPOSITION
        told = place or after.kind is Kind.ADVERB or after.participle
        if self.nouns and (self.forced or item.text == "nor"):
            self.denied = self.forced = True  # "the cube that is not ...", "neither red nor blue"
        elif (self.nouns and told) or (place and any(other.text == "but" for other in self.items)):
            self.denied = True  # "the cube not on the table", "not wearing glasses", "go not to the cube but to ..."
        elif after.kind is Kind.NOUN and after.noun not in SETS["someone"]:
            self.excluded = True  # "the cube, not the sphere"
        else:
            self.clause.negated = True

    def place(self, item: Item) -> None:
        """A preposition, which waits for its noun phrase."""
        if self.denied and item.name in PLACING["strong"]:
            self.denied, self.excluded, self.preposition = False, True, None
            return
        # "the cube closest to ..." can't be where the cube goes, nor can "the cube not on ...".
        item.forced = self.forced or self.denied or (item.name in PLACING["extremes"] and bool(self.nouns))
        extreme = next((word for word in self.last.words if word in SETS["extremes"]), None)
        if extreme and item.name in PLACING["of_extremes"]:  # "the closest cone to you"
            self.last.words = tuple(word for word in self.last.words if word != extreme)
            item.words, item.forced = (f"{extreme} {item.name}",), True
        item.before, item.beside = list(self.nouns), self.joined
        alike = [place for place in self.pending if place.forced] if item.forced and not self.relative else []
        if self.joined and alike and self.clause.action not in VERBS["put"]:
            item.before = list(alike[-1].before)  # "that is on the desk by the door and is not near the lamp"
        elif self.joined and self.denied and len(self.nouns) > 1:
            item.before.pop()  # "on the sofa and not on the bed"
        if self.denied:
            item.words, self.denied, self.was_denied = (f"not {item.name}",), False, True
        self.preposition = item
        self.pending.append(item)
        self.forced = self.joined = False

    def adverb(self, item: Item, after: Item) -> None:
        """A word by itself: said of a noun phrase, or of the way the verb is done."""
        name = item.name
        if not self.nouns or (self.preposition is not None and self.preposition.name != "except"):
            return
        ranks = item.is_a("ordered") and after.name in PLACING["ranks"]
        if ranks and self.joined and self.last.is_a("place"):  # "top row, second from the left"
            self.noun(replace(item, kind=Kind.NOUN, pronoun=True))
            return
        # "the cube that is biggest", "the cube, big", "the cone second from the left", "... second closest to the cone"
        bare = self.copula or (name not in SETS["sides"] and (self.joined or self.clause.verb is None))
        predicate = name not in SETS["adverbs"] and (self.forced or bare)
        apart = name in SETS["predicates"] or item.words[-1] == "each other"
        where = name in SETS["bare_sides"] and self.says_where()
        if predicate or ranks or where or apart or is_superlative(name) or name[:7] == "facing ":
            item.said = True
            self.say(last_thing(self.nouns), item.words)

    def is_subject(self, item: Item, after: Item) -> bool:
        """The "you" of "the block that you hold", with and without "that"."""
        acts = after.kind is Kind.VERB
        it = item.text in SETS["stands_for"] and bool(self.nouns) and acts
        if not it and item.noun not in SETS["someone"]:  # "the block that the arm is holding"
            return item.noun in SETS["holders"] and self.relative
        self.relative |= after.name == "be" if it else bool(self.nouns) and not self.joined and acts
        return self.relative

    def verb(self, item: Item, after: Item) -> None:
        """A verb: the clause's own, or one that says something of a noun phrase."""
        name = item.name
        direct = after.kind is Kind.NOUN and after.noun not in SETS["measures"]
        main = not (item.participle or item.finite or self.relative or name == "be")
        if self.clause.verb is None and (main or not self.nouns):
            self.clause.verb = item
        elif name in SETS["possessing"] and direct:
            self.relation(item)  # "he wears a tie"
        elif item.finite and self.clause.verb is None and self.clause.objects and not self.relative:
            self.clause.verb, self.clause.acting = item, True  # "the top box moves left"
        elif name == "be":
            if self.joined and self.copula:  # "it is on the left and is touching the cone"
                self.nouns += self.clause.objects[:1]
            self.copula = self.forced = True
            if self.clause.verb is None and not self.relative:
                self.clause.statement = item
        elif name in VERBS["hold"] and self.nouns and not direct:
            item.said = True
            self.say(last_thing(self.nouns), ("held",))  # "the block you are holding"
            self.forced = False
        elif name in VERBS["paint"] and self.nouns:
            self.copula = self.forced = item.said = True  # "the ball coloured dark blue"
        elif direct:
            self.relation(item)
        else:
            self.forced = True

    def relation(self, item: Item) -> None:
        """ "The cube that has a cone on it", "the box facing the wall": a verb between two noun phrases."""
        name = RELATION_VERBS.get(item.name, item.name)
        if self.denied and name == "with":
            name, self.denied = "without", False
        self.forced = item.said = True
        self.place(replace(item, kind=Kind.PREPOSITION, words=(name,)))
