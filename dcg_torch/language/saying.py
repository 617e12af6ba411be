"""What the noun phrases of a clause are to one another: objects, landmarks, more of what was said, sides, places."""

from __future__ import annotations

from collections.abc import Sequence

from dcg_torch.language.clauses import Clause
from dcg_torch.language.items import Item, Kind
from dcg_torch.language.lexicon import NORMAL, PLACING, SETS, VERBS
from dcg_torch.language.places import Pending, conjoin
from dcg_torch.language.predicates import is_edge_of, is_side, last_thing, only_color, share_noun


class NounPhrases:
    """The noun phrases of a clause so far, and where the next one goes."""

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
            item.said = True
            self.nouns.append(item)  # what is said of it goes with it
        elif self.is_inverted(item):
            self.clause.objects.append(item)
            self.nouns.append(item)
            for pending in self.pending:
                pending.nouns, pending.forced = [item], True
        elif self.nouns and ((self.copula and self.forced) or self.repeats(item) or self.names_it(item)):
            self.merge(self.nouns[-1], item)
        elif self.nouns and is_side(item) and not (self.and_joined and self.joined and is_side(self.nouns[-1])):
            self.side(item)  # but "on the left and right"
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

    def names_it(self, item: Item) -> bool:
        """ "A green thing, the ball": the second noun phrase names what the first leaves open."""
        last, things = self.nouns[-1], SETS["anything"] | {None}
        if last.noun not in things or item.noun in things | SETS["places"] | SETS["someone"] | SETS["measures"]:
            return False
        told = last in self.clause.objects and last.text not in SETS["stands_for"] and item.color in {None, last.color}
        return told and item.determined and self.joined and not self.and_joined

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
        elif place.words[0] in PLACING["ranks_from"] and self.nouns and is_edge_of(self.nouns[-1], item, place):
            article = "the " if item.noun in SETS["sides"] else ""
            self.nouns[-1].words += (f"from {article}{item.noun}",)  # "the second from the left"
            self.pending.pop()
            self.preposition = None
            item.said = True
            return
        elif item.noun is None and item.words and self.nouns and all(word.endswith("most") for word in item.words):
            self.say(last_thing(self.nouns), item.words)  # "the cone on the rightmost"
            self.pending.pop()
            self.preposition = None
            item.said = True
            return
        if place.children or place.words[0] not in PLACING["between"] or item.plural:
            self.preposition = None
        place.children.append(item)
        if place.words != ("of",) or item.determined or not self.nouns:
            self.nouns.append(item)  # what follows "a pallet of tires" is said of the pallet

    def is_inverted(self, item: Item) -> bool:
        """The cone of "behind the cube is a cone"."""
        landmarks = [child for pending in self.pending for child in pending.item.children]
        starts = bool(landmarks) and not self.clause.objects and all(noun in landmarks for noun in self.nouns)
        return starts and self.copula and not self.relative and item.noun is not None

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
        ordered = not (SETS["ordinals"].isdisjoint(item.words) or item.determined)  # "the cone second from ..."
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

    def says_where(self) -> bool:
        """Whether a bare "left" tells where a thing is: "move the cube left" tells where it goes."""
        return self.clause.verb is None or self.forced or self.clause.action not in VERBS["put"]

    def say(self, noun: Item, words: Sequence[str]) -> None:
        """Add words to what is said of a noun phrase, or that they don't hold."""
        normal = [NORMAL.get(word, word) for word in words]
        noun.words += tuple(f"not {word}" if self.denied else word for word in normal if word not in noun.words)
        self.was_denied, self.denied = self.denied, False

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
