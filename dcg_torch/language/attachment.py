"""A clause's phrases in their order -> the clause: what is said of which noun phrase, what stands beside what.

This is the one place that decides which phrase belongs to which; `places` has its rules for prepositional phrases.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

from dcg_torch.language import lexicon as lx
from dcg_torch.language.clauses import Clause
from dcg_torch.language.items import Item, Kind
from dcg_torch.language.places import Pending, conjoin, settle
from dcg_torch.language.predicates import (
    ANYTHING,
    ASPECTS,
    is_edge_of,
    is_side,
    last_thing,
    only_color,
    settle_nothing,
    share_noun,
)
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
        self.and_joined = False  # the last of these was "and"
        self.relative = False
        self.copula = False
        self.denied = False  # "not" stands before what is said next of a noun phrase
        self.was_denied = False  # so was what was said last
        self.excluded = False  # "not" stands before a noun phrase: "not the cube"

    def run(self, supplied: bool) -> Clause:
        for k, item in enumerate(self.items):
            after = self.items[k + 1] if k + 1 < len(self.items) else None
            if item.kind is Kind.NEGATION:
                self.negation(item, after)
            elif item.kind is Kind.RELATIVE:
                self.relative = self.forced = True
            elif self.is_exception(item, after):
                self.place(Item(Kind.PREPOSITION, item.start, item.stop, item.head, item.text, ("instead of",)))
            elif item.kind in {Kind.AND, Kind.COMMA}:
                still = item.text == "or" and self.was_denied  # "that aren't red or blue"
                self.joined, self.relative, self.forced, self.denied = True, False, still, still
                self.and_joined = item.kind is Kind.AND
            elif item.kind is Kind.VERB:
                self.verb(item, after)
            elif item.kind is Kind.PREPOSITION:
                self.place(item)
            elif item.kind is Kind.ADVERB:
                self.adverb(item, after)
            elif item.kind is Kind.NOUN and not self.is_subject(item, after):
                self.noun(item)
                self.joined = self.forced = self.excluded = False
        settle(self.clause, self.pending, self.words, supplied)
        for noun in self.nouns:
            settle_nothing(noun)
            noun.noun = "thing" if noun.noun in {"anything", "nothing"} else noun.noun
        return self.clause

    def is_exception(self, item: Item, after: Item | None) -> bool:
        """The "but" of "all cubes but the red one"."""
        if item.text != "but" or after is None or after.kind is not Kind.NOUN or not self.nouns:
            return False
        return not {"all", "every", "any", "each"}.isdisjoint(self.nouns[-1].words)

    def negation(self, item: Item, after: Item | None) -> None:
        """Whether "not" denies what is said of a noun phrase, excludes a noun phrase, or is of the verb."""
        if self.nouns and (self.forced or item.text == "nor"):
            self.denied = self.forced = True  # "the cube that is not ...", "neither red nor blue"
        elif after is not None and after.kind is Kind.PREPOSITION and (self.nouns or self.contrasts()):
            self.denied = True  # "the cube not on the table"
        elif after is not None and after.kind is Kind.NOUN and after.noun not in {"you", "me"}:
            self.excluded = True  # "the cube, not the sphere"
        elif after is not None and after.kind is Kind.ADVERB and self.nouns:
            self.denied = True
        else:
            self.clause.negated = True

    def contrasts(self) -> bool:
        """ "Go not to the cube but to the cone"."""
        return any(item.kind is Kind.AND and item.text == "but" for item in self.items)

    def place(self, item: Item) -> None:
        if self.denied and item.words[0] in lx.STRONG:
            self.denied, self.excluded, self.preposition = False, True, None
            return
        # "the cube closest to ..." can't be where the cube goes, nor can "the cube not on ...".
        forced = self.forced or self.denied or (item.words[0] in lx.EXTREMES and bool(self.nouns))
        extreme = next((word for word in ("closest", "farthest") if self.nouns and word in self.nouns[-1].words), None)
        if extreme and item.words[0] in {"to", "from"}:  # "the closest cone to you"
            self.nouns[-1].words = tuple(word for word in self.nouns[-1].words if word != extreme)
            item.words, forced = (f"{extreme} {item.words[0]}",), True
        if self.denied:
            item.words, self.denied = (f"not {item.words[0]}",), False
        self.preposition = item
        self.pending.append(Pending(item, list(self.nouns), forced, self.joined))
        self.forced = self.joined = False

    def adverb(self, item: Item, after: Item | None) -> None:
        name = item.words[0]
        if not self.nouns or self.preposition is not None:
            return
        bare = self.joined or self.clause.verb is None
        # "the cube that is biggest", "the cube, big"
        predicate = self.forced or self.copula or (bare and name in lx.ADJECTIVES)
        predicate = name == "alone" or (predicate and name in lx.MODIFIERS)
        if name in lx.ORDINALS and after is not None and after.words == ("from",):
            predicate = True  # "the cone second from the left"
            if self.joined and self.nouns[-1].noun in lx.PLACES:  # "top row, second from the left"
                self.noun(replace(item, kind=Kind.NOUN, pronoun=True))
                return
        if predicate or name.startswith("facing ") or (name in {"ahead", *lx.SIDES} and self.says_where()):
            self.say(last_thing(self.nouns), (name,))

    def says_where(self) -> bool:
        """Whether a bare "left" tells where a thing is: "move the cube left" tells where it goes."""
        return self.clause.verb is None or self.forced or self.clause.verb.words[0] not in lx.PUT

    def say(self, noun: Item, words: Sequence[str]) -> None:
        """Add words to what is said of a noun phrase, or that they don't hold."""
        normal = [lx.NORMAL_WORDS.get(word, word) for word in words]
        noun.words += tuple(f"not {word}" if self.denied else word for word in normal if word not in noun.words)
        self.was_denied, self.denied = self.denied, False

    def is_subject(self, item: Item, after: Item | None) -> bool:
        """The "you" of "the block that you hold", with and without "that"."""
        if self.preposition is not None:
            return False
        if item.text in {"it", "they"} and self.nouns and after is not None and after.kind is Kind.VERB:
            self.relative = self.relative or after.words[0] == "be"
            return self.relative
        if item.noun in lx.HOLDERS and self.relative and self.forced and after is not None and after.kind is Kind.VERB:
            return True  # "the block that the arm is holding"
        if item.noun not in {"you", "me"}:
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
            self.say(last_thing(self.nouns), ("held",))  # "the block you are holding"
            self.forced = False
        elif name in {"color", "colour", "paint"} and self.nouns:
            self.copula = self.forced = True  # "the ball coloured dark blue"
        else:
            self.forced = True
            if direct:  # "the cube that has a cone on it", "the box facing the wall"
                name = {"have": "with"}.get(name, name)
                name = {"not with": "without"}.get(f"not {name}", f"not {name}") if self.denied else name
                self.denied = False
                self.preposition = Item(Kind.PREPOSITION, item.start, item.stop, item.head, item.text, (name,))
                self.pending.append(Pending(self.preposition, list(self.nouns), True, False))

    def noun(self, item: Item) -> None:
        place = self.preposition
        if item.words == ("each other",) and self.nouns:
            other = last_thing(self.nouns)
            item.noun, item.color = other.noun, other.color
        if self.is_about_color(item, place):
            return
        if place is not None and (self.joined or not place.children):
            self.landmark(item, place)
        elif self.excluded:
            self.nouns.append(item)  # what is said of it goes with it
        elif self.is_inverted(item):
            self.clause.objects.append(item)
            self.nouns.append(item)
            for pending in self.pending:
                pending.nouns, pending.forced = [item], True
        elif self.nouns and ((self.copula and self.forced) or self.repeats(item)):
            self.merge(self.nouns[-1], item)
        elif self.nouns and is_side(item) and not self.joins_sides():
            self.side(item)
        elif self.joined and self.nouns and (self.clause.verb is not None or self.and_joined):
            item.beside = True
            conjoin(item, self.nouns, self.pending, self.clause, self.words)
        elif item.noun not in lx.MEASURES:
            self.leading_place(item)
            self.clause.objects.append(item)
            self.nouns.append(item)

    def is_about_color(self, item: Item, place: Item | None) -> bool:
        """Whether the noun phrase but helps to state a colour, which is done here: "in red", "whose color is red"."""
        inside = place is not None and not place.children and place.words[0] in {"in", "of"}
        if item.noun in ASPECTS and (inside or self.relative):
            pass  # "blue in color"
        elif inside and self.nouns and only_color(item):
            self.merge(self.nouns[-1], item)
        else:
            return False
        if inside:
            self.pending.pop()
            self.preposition = None
        return True

    def landmark(self, item: Item, place: Item) -> None:
        """What a preposition is about; the second thing that it is between."""
        if item.negative or item.noun == "nothing":
            place.words = ({"with": "without"}.get(place.words[0], place.words[0]),)
        if place.children:
            share_noun(place.children[-1], item)
        elif place.words[0] == "from" and self.nouns and is_edge_of(self.nouns[-1], item):
            article = "the " if item.noun in lx.SIDES else ""
            self.nouns[-1].words += (f"from {article}{item.noun}",)  # "the second from the left"
            self.pending.pop()
            self.preposition = None
            return
        if place.children or place.words[0] != "between":
            self.preposition = None
        place.children.append(item)
        self.nouns.append(item)

    def is_inverted(self, item: Item) -> bool:
        """The cone of "behind the cube is a cone"."""
        landmarks = [child for pending in self.pending for child in pending.item.children]
        starts = bool(landmarks) and not self.clause.objects and all(noun in landmarks for noun in self.nouns)
        return starts and self.copula and not self.relative and item.noun is not None

    def joins_sides(self) -> bool:
        """ "on the left and right"."""
        return self.joined and self.and_joined and self.nouns[-1].noun in lx.SIDES

    def leading_place(self, item: Item) -> None:
        """ "Top left corner, red cube": the place named first is where the thing is."""
        objects = self.clause.objects
        if (
            self.clause.verb is None
            and len(objects) == 1
            and objects[0].noun in lx.PLACES
            and (item.noun or item.words)
        ):
            where = objects.pop()
            place = Item(Kind.PREPOSITION, where.start, where.stop, where.head, where.text, ("in",), children=[where])
            item.children.append(place)

    def repeats(self, item: Item) -> bool:
        """Whether a comma joins more of the same thing: "the drill, yellow, ...", "the cone, the yellow one"."""
        last = self.nouns[-1]
        ordered = not lx.ORDINALS.isdisjoint(item.words) and last.stop == item.start  # "the cone second from ..."
        if not (self.joined or ordered) or not item.pronoun or (item.color and last.color):
            return False
        if last.noun in lx.PLACES | lx.ROBOT or (last.pronoun and not ordered):
            return False
        if not item.determined:
            return item.color is not None or bool(item.words)
        return not self.and_joined and bool(item.color or item.words)

    def merge(self, noun: Item, predicate: Item) -> None:
        """ "the block that is red", "the cube which is the biggest one": what a copula says of a noun phrase."""
        if self.denied:
            things = () if predicate.pronoun or predicate.noun is None else (predicate.noun,)
            self.say(noun, (*(() if predicate.color is None else (predicate.color,)), *predicate.words, *things))
            return
        noun.color = noun.color or predicate.color
        self.say(noun, predicate.words)
        if noun.noun in {None, *ANYTHING} and predicate.noun is not None:
            noun.noun, noun.pronoun = predicate.noun, False

    def side(self, item: Item) -> None:
        """ "the sphere, left": a side with no preposition; "the sphere, my left" is on it; "move it left" too."""
        place = Item(Kind.PREPOSITION, item.start, item.stop, item.head, item.text, ("on",), children=[item])
        within = self.nouns[-1].noun in lx.PLACES and self.nouns[-1].stop == item.start  # "the table center"
        noun = self.nouns[-1] if within else last_thing(self.nouns)
        if not self.says_where():
            place.words = ("to",)
            self.pending.append(Pending(place, list(self.nouns), False, False))
        elif item.determined or item.noun is None:
            noun.children.append(place)
        else:
            self.say(noun, (*item.words, item.noun))
