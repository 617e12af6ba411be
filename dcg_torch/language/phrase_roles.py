"""What the noun phrases of a clause are to one another: objects, landmarks, more of what was said, sides, places."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

from dcg_torch.language.clauses import Clause, main_object
from dcg_torch.language.decisions import Decisions
from dcg_torch.language.items import END, Item, Kind, is_edge_of, is_state, last_thing, share_noun
from dcg_torch.language.lexicon import NORMAL, PLACING, SETS, VERBS
from dcg_torch.language.places import conjoin


class NounPhrases:
    """The noun phrases of a clause so far, and where the next one goes."""

    def __init__(self, items: Sequence[Item], decisions: Decisions) -> None:
        self.items, self.decisions = items, decisions
        self.clause = Clause()
        self.pending: list[Item] = []
        self.nouns: list[Item] = []  # noun phrases so far
        self.preposition: Item | None = None  # still waits for its noun phrase
        self.forced = False  # the next preposition tells the last noun phrase apart
        self.joined = False  # "and" or a comma stands before
        self.conjunction = ""  # the last of these, if it was one
        self.relative = self.copula = False
        self.denied = False  # "not" stands before what is said next of a noun phrase
        self.was_denied = False  # so was what was said last
        self.excluded = False  # "not" stands before a noun phrase: "not the cube"
        self.ruled_out: list[tuple[Item, Item | None]] = []  # what is not meant, and the noun phrase before it
        self.meant: list[Item] | None = None  # noun phrases before what is ruled out, until a comma

    @property
    def last(self) -> Item:
        """The noun phrase just before."""
        return self.nouns[-1] if self.nouns else END

    def noun(self, item: Item) -> None:
        """A noun phrase: a landmark, an object of the verb, or more of what was said before."""
        if item.words == ("each other",) and self.nouns:
            other = last_thing(self.nouns)
            item.noun, item.color = other.noun, other.color
        if self.is_about_color(item) or self.is_rank(item):
            item.said = True
        elif self.meets(item):
            self.nouns.append(item)
        elif self.preposition is not None and (self.joined or not self.preposition.children):
            self.landmark(item, self.preposition)
        elif self.excluded or self.is_exception(item):
            self.exclude(item)  # "the cube, not the sphere"
        elif self.nouns and item.noun and self.copula and not (self.clause.objects or self.relative):
            self.mention(item)  # "behind the cube is a cone"
            for pending in self.pending:
                pending.before, pending.forced = [item], True
        elif self.nouns and ((self.copula and self.forced) or self.repeats(item) or self.names_it(item)):
            counts = item.pronoun and item.is_a("ordered")
            one = self.last.plural and item.text.endswith(" one") and not item.plural  # "by the two cups, the big one"
            self.merge(last_thing(self.nouns) if counts else self.nouns[0] if one else self.last, item)
        elif self.nouns and item.is_a("side"):
            self.side(item)
        elif self.nouns and self.is_bare(item):
            last_thing(self.nouns).children.append(item.behind("with" if item.noun in SETS["parts"] else "in"))
            self.nouns.append(item)
        elif self.joined and self.nouns and (self.clause.verb is not None or self.conjunction):
            item.beside = True
            conjoin(item, self.nouns, self.pending, self.clause, self.conjunction)
        elif item.noun not in SETS["measures"] or item.color or item.text.startswith("the ") or item.is_a("told_apart"):
            self.mention(item)

    def mention(self, item: Item) -> None:
        """A noun phrase that the clause is about. "Top left corner, red cube": a place before it is where it is."""
        objects = self.clause.objects
        if self.clause.verb is None and len(objects) == 1 and objects[0].is_a("place"):
            item.children.append(objects.pop().behind("in"))
        objects.append(item)
        self.nouns.append(item)

    def meets(self, item: Item) -> bool:
        """Whether two lines, or a line and its end, name a place: "row 3, column 2", "far right, second row"."""
        line, end = (item, self.last) if item.is_a("line") else (self.last, item)
        both, alone = end.is_a("line") and end.noun != line.noun, self.clause.objects == [self.last]
        apart = self.preposition is not None and self.preposition.name not in PLACING["within"]
        if apart or not line.is_a("line") or not (both or (alone and end.is_a("side"))):
            return False
        if both:
            end.children.append(item.behind("in"))
        if alone:
            words = () if both else (str(end.noun) if end.noun in SETS["middles"] else f"{end.noun}most",)
            place = (end if both else line).behind("in")
            self.clause.objects = [Item(Kind.NOUN, place.start, place.start, "", words, pronoun=True, children=[place])]
        return True

    def exclude(self, item: Item) -> None:
        """The cube of "not the cube", "but not the bright one", "(blue,) not pink"."""
        # "No cup, (no) jar or bowl": each is said as one that is not meant.
        item.determined |= self.denied and item.noun is not None
        self.ruled_out.append((item, main_object(self.clause) or (last_thing(self.nouns) if self.nouns else None)))
        item.said, self.was_denied, self.meant = True, True, list(self.nouns)
        if item.determined or not item.is_a("color_word"):
            self.nouns.append(item)  # what is said of it goes with it

    def is_exception(self, item: Item) -> bool:
        """ "Something red but no sphere", "(the one that is) no cube and no sphere"."""
        more = self.conjunction == "but" or bool(self.ruled_out)
        return item.negative and self.joined and more and self.last.is_a("open")

    def names_it(self, item: Item) -> bool:
        """ "A green thing, the ball": the second noun phrase names what the first leaves open."""
        told = self.last.is_a("open") and self.last in self.clause.objects and item.color in {None, self.last.color}
        return told and item.is_a("name") and self.joined and not self.conjunction

    def is_bare(self, item: Item) -> bool:
        """ "(blue fan,) top row", "(screwdriver,) red handle": where the thing is or what it has, no preposition."""
        where = item.is_a("bare_place") and (self.clause.verb is None or self.joined)
        return not self.conjunction and (where or (self.joined and item.is_a("bare_part")))

    def is_about_color(self, item: Item) -> bool:
        """Whether the noun phrase but helps to state a colour, which is done here: "in red", "whose color is red"."""
        place = self.preposition
        inside = place is not None and not place.children and place.name in PLACING["within"]
        aspect = item.noun in SETS["aspects"]  # "blue in color"
        if not (inside and (aspect or (self.nouns and item.is_a("color")))):
            return aspect and self.relative
        if not aspect:
            self.merge(self.last, item)
        return self.drop_preposition()

    def is_rank(self, item: Item) -> bool:
        """Whether the noun phrase says along what is counted: "(the second) from the left", "on the rightmost"."""
        place = self.preposition
        if place is None or not self.nouns or place.name == "except":
            return False
        near = (self.last, last_thing(self.nouns)) if place.name in PLACING["ranks_from"] else ()
        if near and item.noun and near[0].is_a("unnamed_rank") and item.is_a("sided_thing"):
            # "The third from the left mug".
            near[0].noun, near[0].pronoun, item.noun, item.words = item.noun, False, item.words[0], ()
        counted = [noun for noun in near if is_edge_of(noun, item, place)]
        if counted:
            counted[0].words += (f"from {'the ' if item.noun in SETS['sides'] else ''}{item.noun}",)
        elif item.noun is None and item.words and all(word.endswith("most") for word in item.words):
            self.say(last_thing(self.nouns), item.words)
        else:
            return False
        return self.drop_preposition()

    def drop_preposition(self) -> bool:
        """Forget the preposition that was read last: what it says has been said otherwise."""
        self.pending.pop()
        self.preposition = None
        return True

    def landmark(self, item: Item, place: Item) -> None:
        """What a preposition is about; the second thing that it is between."""
        if item.is_a("nothing") and place.words == ("with",):
            place.words = ("without",)
        if place.children:
            share_noun(place.children[-1], item)
        if place.name != "except" and (place.children or place.name not in PLACING["between"] or item.plural):
            self.preposition = None  # but "except the fork, the spoon and the knife"
        place.children.append(item)
        if place.words != ("of",) or item.determined or not self.nouns:
            self.nouns.append(item)  # what follows "a pallet of tires" is said of the pallet

    def repeats(self, item: Item) -> bool:
        """Whether a comma joins more of the same thing: "the drill, yellow, ...", "the cone, the yellow one"."""
        last = self.last
        if item.is_a("color") and last.stop == item.start and last.is_a("bare"):
            return True  # "something red"
        ordered = item.is_a("ordered") and not item.determined  # "the cone second from ..."
        one = item.determined and item.text.endswith(" one")
        told = last.is_a("told") and not (one and last.noun and last in self.clause.objects)
        if not (self.joined or ordered) or not item.pronoun or (item.color and last.color) or told:
            return False
        return (one or item.is_a("color_word")) and not (item.determined and self.conjunction)

    def merge(self, noun: Item, predicate: Item) -> None:
        """ "the block that is red", "the cube which is the biggest one": what a copula says of a noun phrase."""
        predicate.said = True
        no_such = predicate.is_a("kind") and predicate.noun != noun.noun and noun.is_a("open")
        that_one = predicate.is_a("that_one") and (predicate.noun in {None, noun.noun} or noun.is_a("unnamed_one"))
        if (self.denied and (no_such or that_one)) or (no_such and predicate.negative):
            self.exclude(predicate)  # "the red thing that is no cup", "not the one by the door", "not the red cup"
            return
        if self.denied:
            self.say(noun, tuple(filter(None, (predicate.color, *predicate.words, predicate.noun))))
            return
        noun.take_up(predicate)
        self.was_denied = False
        if is_state(predicate):  # "the box that is open"
            self.say(noun, (str(predicate.noun),))
        elif noun.noun in {None, *SETS["anything"]} and predicate.noun is not None:
            noun.noun, noun.pronoun = predicate.noun, False

    def says_where(self) -> bool:
        """Whether a bare "left" tells where a thing is: "move the cube left" tells where it goes."""
        # But "move towards the chair ahead", "bring me the chair ahead".
        given = main_object(self.clause) is None or any(noun.noun == "me" for noun in self.clause.objects)
        return self.clause.verb is None or self.forced or given or self.clause.action not in VERBS["put"]

    def say(self, noun: Item, words: Sequence[str]) -> None:
        """Add words to what is said of a noun phrase, or that they don't hold."""
        normal = [NORMAL.get(word, word) for word in words]
        noun.words += tuple(f"not {word}" if self.denied else word for word in normal if word not in noun.words)
        self.was_denied, self.denied = self.denied, False

    def side(self, item: Item) -> None:
        """ "the sphere, left": a side with no preposition; "the sphere, my left" is on it; "move it left" too."""
        within = self.last.is_a("place") and self.last.stop == item.start  # "the table's left"
        noun = self.last if within else last_thing(self.nouns)
        item.said = True
        if within and item.is_a("middle"):  # "the table center"
            noun.children, noun.noun = [noun.copy().behind("of")], item.noun
        elif self.conjunction and self.last.is_a("edge") and item.is_a("sided_place"):  # "closest to the top and left"
            self.last.words, self.last.noun = (str(self.last.noun), str(item.noun)), "corner"
        elif not self.says_where():
            self.pending.append(replace(item.behind("to"), before=list(self.nouns)))
        elif item.determined:
            noun.children.append(item.behind("on"))
        else:
            self.say(noun, (*item.words, str(item.noun)))
