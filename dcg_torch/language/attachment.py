"""A clause's phrases in their order -> the clause: what is said of which noun phrase, what stands beside what.

This is the one place that decides which phrase belongs to which; `places` has its rules for prepositional phrases.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

from dcg_torch.language.clauses import Clause
from dcg_torch.language.decisions import Decisions
from dcg_torch.language.items import Item, Kind
from dcg_torch.language.lexicon import NORMAL, PLACING, SETS, VERBS
from dcg_torch.language.places import Pending, conjoin, settle
from dcg_torch.language.predicates import is_edge_of, is_side, last_thing, only_color, settle_nothing, share_noun
from dcg_torch.language.selection import is_superlative

_WHICH_EXCEPT = frozenset({"all", "every", "any", "each"})


def build(items: Sequence[Item], supplied: bool, decisions: Decisions) -> Clause:
    """The clause of a list of items. `supplied`: a later clause says where the object goes ("and put it on ...")."""
    return _Builder(items).run(supplied, decisions)


class _Builder:
    """Walks over the items of a clause and notes what each could belong to."""

    def __init__(self, items: Sequence[Item]) -> None:
        self.items = items
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
        self.not_colors: list[str] = []  # "(blue), not orange, not pink"
        self.denials: list[str] = []  # "not the bright one", which is no word of another thing

    def run(self, supplied: bool, decisions: Decisions) -> Clause:
        """Read the items."""
        for k, item in enumerate(self.items):
            self.step(item, self.items[k + 1] if k + 1 < len(self.items) else None)
        self.deny_colors()
        settle(self.clause, self.pending, supplied, decisions)
        for noun in self.nouns:
            settle_nothing(noun)
            noun.noun = "thing" if noun.noun in SETS["nothing"] else noun.noun
        return self.clause

    def step(self, item: Item, after: Item | None) -> None:
        """Read one item; `after` is the next."""
        if item.kind is Kind.NEGATION:
            self.negation(item, after)
        elif item.kind is Kind.RELATIVE:
            self.relative = self.forced = True
        elif self.is_exception(item, after):
            self.place(Item(Kind.PREPOSITION, item.start, item.stop, item.text, ("except",)))
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

    def deny_colors(self) -> None:
        """Say of the object, which may have no name, which colours it has not: "blue, not purple"."""
        if (self.not_colors or self.denials) and not self.clause.objects and not self.pending:
            first = self.items[0]
            unnamed = Item(Kind.NOUN, first.start, first.start, "", tuple(self.denials), pronoun=True)
            self.clause.objects = [unnamed]
        if self.not_colors and self.clause.objects:
            self.clause.objects[0].words += tuple(self.not_colors)

    def is_exception(self, item: Item, after: Item | None) -> bool:
        """The "but" of "all cubes but the red one", "anything but the cone"."""
        if item.text != "but" or after is None or after.kind is not Kind.NOUN or not self.nouns:
            return False
        last = self.nouns[-1]
        return not _WHICH_EXCEPT.isdisjoint(last.words) or last.noun in SETS["nothing"] | SETS["all_things"]

    def negation(self, item: Item, after: Item | None) -> None:
        """Whether "not" denies what is said of a noun phrase, excludes a noun phrase, or is of the verb."""
        if self.nouns and (self.forced or item.text == "nor"):
            self.denied = self.forced = True  # "the cube that is not ...", "neither red nor blue"
        elif after is not None and after.kind is Kind.PREPOSITION and (self.nouns or self.contrasts()):
            self.denied = True  # "the cube not on the table"
        elif after is not None and after.kind is Kind.NOUN and after.noun not in SETS["someone"]:
            self.excluded = True  # "the cube, not the sphere"
        elif after is not None and after.kind is Kind.ADVERB and self.nouns:
            self.denied = True
        else:
            self.clause.negated = True

    def contrasts(self) -> bool:
        """ "Go not to the cube but to the cone"."""
        return any(item.kind is Kind.AND and item.text == "but" for item in self.items)

    def place(self, item: Item) -> None:
        """A preposition, which waits for its noun phrase."""
        if self.denied and item.words[0] in PLACING["strong"]:
            self.denied, self.excluded, self.preposition = False, True, None
            return
        # "the cube closest to ..." can't be where the cube goes, nor can "the cube not on ...".
        forced = self.forced or self.denied or (item.words[0] in PLACING["extremes"] and bool(self.nouns))
        last = self.nouns[-1].words if self.nouns else ()
        extreme = next((word for word in last if word in SETS["extremes"]), None)
        if extreme and item.words[0] in PLACING["of_extremes"]:  # "the closest cone to you"
            self.nouns[-1].words = tuple(word for word in last if word != extreme)
            item.words, forced = (f"{extreme} {item.words[0]}",), True
        if self.denied:
            item.words, self.denied = (f"not {item.words[0]}",), False
        self.preposition = item
        self.pending.append(Pending(item, list(self.nouns), forced, self.joined))
        self.forced = self.joined = False

    def adverb(self, item: Item, after: Item | None) -> None:
        """A word by itself: said of a noun phrase, or of the way the verb is done."""
        name = item.words[0]
        if not self.nouns or self.preposition is not None:
            return
        bare = self.joined or self.clause.verb is None
        # "the cube that is biggest", "the cube, big"
        predicate = self.forced or self.copula or (bare and name not in SETS["sides"])
        ranked = is_superlative(name) and name not in SETS["ordinals"]
        predicate = name == "alone" or ranked or (predicate and name not in SETS["adverbs"])
        before_rank = after is not None and after.kind is Kind.PREPOSITION and after.words[0] in PLACING["ranks"]
        if name in SETS["ordinals"] and before_rank:
            predicate = True  # "the cone second from the left", "... second closest to the sphere"
            if self.joined and self.nouns[-1].noun in SETS["places"]:  # "top row, second from the left"
                self.noun(replace(item, kind=Kind.NOUN, pronoun=True))
                return
        if predicate or name.startswith("facing ") or (name in SETS["bare_sides"] and self.says_where()):
            item.said = True
            self.say(last_thing(self.nouns), item.words)

    def says_where(self) -> bool:
        """Whether a bare "left" tells where a thing is: "move the cube left" tells where it goes."""
        return self.clause.verb is None or self.forced or self.clause.action not in VERBS["put"]

    def say(self, noun: Item, words: Sequence[str]) -> None:
        """Add words to what is said of a noun phrase, or that they don't hold."""
        normal = [NORMAL.get(word, word) for word in words]
        noun.words += tuple(f"not {word}" if self.denied else word for word in normal if word not in noun.words)
        self.was_denied, self.denied = self.denied, False

    def is_subject(self, item: Item, after: Item | None) -> bool:
        """The "you" of "the block that you hold", with and without "that"."""
        if self.preposition is not None:
            return False
        acts = after is not None and after.kind is Kind.VERB
        if item.text in SETS["stands_for"] and self.nouns and after is not None and acts:
            self.relative = self.relative or after.words[0] == "be"
            return self.relative
        if item.noun in SETS["holders"] and self.relative and self.forced and acts:
            return True  # "the block that the arm is holding"
        if item.noun not in SETS["someone"]:
            return False
        if self.nouns and not self.joined and acts:
            self.relative = True
        return self.relative

    def verb(self, item: Item, after: Item | None) -> None:
        """A verb: the clause's own, or one that says something of a noun phrase."""
        name = item.words[0]
        direct = after is not None and after.kind is Kind.NOUN and after.noun not in SETS["measures"]
        main = not item.participle and not self.relative and name != "be"
        if self.clause.verb is None and (main or not self.nouns):
            self.clause.verb = item
        elif item.finite and self.clause.verb is None and self.clause.objects and not self.relative:
            self.clause.verb, self.clause.acting = item, True  # "the top box moves left"
        elif name == "be":
            self.copula = self.forced = True
            if self.clause.verb is None and not self.relative:
                self.clause.statement = True
        elif name in VERBS["hold"] and self.nouns and not direct:
            item.said = True
            self.say(last_thing(self.nouns), ("held",))  # "the block you are holding"
            self.forced = False
        elif name in VERBS["paint"] and self.nouns:
            self.copula = self.forced = item.said = True  # "the ball coloured dark blue"
        else:
            self.forced = True
            if direct:
                self.relation(item)

    def relation(self, item: Item) -> None:
        """ "The cube that has a cone on it", "the box facing the wall": a verb between two noun phrases."""
        name = "with" if item.words[0] == "have" else item.words[0]
        if self.denied:
            name = "without" if name == "with" else f"not {name}"
        self.denied, item.said = False, True
        self.preposition = Item(Kind.PREPOSITION, item.start, item.stop, item.text, (name,))
        self.pending.append(Pending(self.preposition, list(self.nouns), True, False))

    def noun(self, item: Item) -> None:
        """A noun phrase: a landmark, an object of the verb, or more of what was said before."""
        place = self.preposition
        if item.words == ("each other",) and self.nouns:
            other = last_thing(self.nouns)
            item.noun, item.color = other.noun, other.color
        if self.is_about_color(item, place):
            return
        if place is not None and (self.joined or not place.children):
            self.landmark(item, place)
        elif self.excluded and item.pronoun and (item.color or item.words):
            item.said = True
            found = self.denials if item.determined else self.not_colors
            found += [f"not {word}" for word in (item.color, *item.words) if word]
            self.nouns += [item] if item.determined else []
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
        elif self.nouns and self.is_bare_place(item):
            where = Item(Kind.PREPOSITION, item.start, item.stop, item.text, ("in",), children=[item])
            last_thing(self.nouns).children.append(where)
        elif self.joined and self.nouns and (self.clause.verb is not None or self.and_joined):
            item.beside = True
            conjoin(item, self.nouns, self.pending, self.clause)
        elif item.noun not in SETS["measures"] or item.color or item.text.startswith("the "):
            self.leading_place(item)
            self.clause.objects.append(item)
            self.nouns.append(item)

    def is_bare_place(self, item: Item) -> bool:
        """ "(blue fan,) top row": where the thing is, without a preposition."""
        somewhere = item.noun in SETS["place_nouns"] and bool(item.words) and not item.color
        return somewhere and not self.and_joined and self.clause.verb is None and not item.determined

    def is_about_color(self, item: Item, place: Item | None) -> bool:
        """Whether the noun phrase but helps to state a colour, which is done here: "in red", "whose color is red"."""
        inside = place is not None and not place.children and place.words[0] in PLACING["of_color"]
        if item.noun in SETS["aspects"] and (inside or self.relative):
            pass  # "blue in color"
        elif inside and self.nouns and only_color(item):
            self.merge(self.nouns[-1], item)
        else:
            return False
        item.said = True
        if inside:
            self.pending.pop()
            self.preposition = None
        return True

    def landmark(self, item: Item, place: Item) -> None:
        """What a preposition is about; the second thing that it is between."""
        if item.negative or item.noun == "nothing":
            place.words = ("without",) if place.words[0] == "with" else place.words
        if place.children:
            share_noun(place.children[-1], item)
        elif place.words[0] == "from" and self.nouns and is_edge_of(self.nouns[-1], item):
            article = "the " if item.noun in SETS["sides"] else ""
            self.nouns[-1].words += (f"from {article}{item.noun}",)  # "the second from the left"
            self.pending.pop()
            self.preposition = None
            item.said = True
            return
        if place.children or place.words[0] not in PLACING["between"] or item.plural:
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
        return self.joined and self.and_joined and self.nouns[-1].noun in SETS["sides"]

    def leading_place(self, item: Item) -> None:
        """ "Top left corner, red cube": the place named first is where the thing is."""
        objects = self.clause.objects
        if self.clause.verb is not None or len(objects) != 1 or objects[0].noun not in SETS["places"]:
            return
        if item.noun or item.words:
            where = objects.pop()
            place = Item(Kind.PREPOSITION, where.start, where.stop, where.text, ("in",), children=[where])
            item.children.append(place)

    def repeats(self, item: Item) -> bool:
        """Whether a comma joins more of the same thing: "the drill, yellow, ...", "the cone, the yellow one"."""
        last = self.nouns[-1]
        if only_color(item) and last.stop == item.start and last.noun is None and last.color is None:
            return True  # "something red"
        ordered = not SETS["ordinals"].isdisjoint(item.words) and last.stop == item.start  # "the cone second from ..."
        if not (self.joined or ordered) or not item.pronoun or (item.color and last.color):
            return False
        if last.noun in SETS["places"] | SETS["robot"] or (last.pronoun and not ordered):
            return False
        if not item.determined:
            return item.color is not None or bool(item.words)
        return not self.and_joined and bool(item.color or item.words or item.text.endswith(" one"))

    def merge(self, noun: Item, predicate: Item) -> None:
        """ "the block that is red", "the cube which is the biggest one": what a copula says of a noun phrase."""
        predicate.said = True
        if self.denied:
            things = () if predicate.pronoun or predicate.noun is None else (predicate.noun,)
            self.say(noun, (*(() if predicate.color is None else (predicate.color,)), *predicate.words, *things))
            return
        noun.color = noun.color or predicate.color
        self.say(noun, predicate.words)
        if noun.noun in {None, *SETS["anything"]} and predicate.noun is not None:
            noun.noun, noun.pronoun = predicate.noun, False

    def side(self, item: Item) -> None:
        """ "the sphere, left": a side with no preposition; "the sphere, my left" is on it; "move it left" too."""
        place = Item(Kind.PREPOSITION, item.start, item.stop, item.text, ("on",), children=[item])
        within = self.nouns[-1].noun in SETS["places"] and self.nouns[-1].stop == item.start  # "the table center"
        noun = self.nouns[-1] if within else last_thing(self.nouns)
        item.said = True
        if not self.says_where():
            place.words = ("to",)
            self.pending.append(Pending(place, list(self.nouns), False, False))
        elif item.determined or item.noun is None:
            noun.children.append(place)
        else:
            self.say(noun, (*item.words, item.noun))
