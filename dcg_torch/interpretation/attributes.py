"""What a command says of attributes by their keys: "with glasses", "the bearded one", "in the red shirt", "a woman".

Where objects carry a key such as `glasses`, a noun phrase that names it is no landmark: it says that the object has it.
It becomes a word of what it describes ("with glasses", "not with tie", "with dark hair"), which `names.attributes`
compares with the values. A noun that states a value ("woman" where `gender` is given) becomes a word too.
"""

from __future__ import annotations

from collections.abc import Collection, Iterator, Sequence
from dataclasses import replace

from dcg_torch.interpretation.people import OF_PEOPLE
from dcg_torch.names.attribute_values import is_told_apart, says_value, says_whether, states_value
from dcg_torch.names.attributes import HAS, NOT_
from dcg_torch.names.evidence import is_generic
from dcg_torch.names.keys import OF_KEY, attribute_key, is_clothing, is_worn, named_key
from dcg_torch.names.normal_form import normalise, singular
from dcg_torch.names.relations import listed
from dcg_torch.names.vocabulary import LINE_OF, PLACE_WORDS, SIDED
from dcg_torch.names.weights import log_odds, names_one_of
from dcg_torch.types import LOOKED_ROUND, OPAQUE, ParseTree, Phrase, PhraseKind, WorldModel

_HELD = "held"
"""What is in the gripper: a state, and no key that a noun names."""
_POSSESSIVE = listed("has")
"""Prepositions before what a thing has."""
_HAVING = listed("has as a verb")
"""Verbs whose object is what a thing has: "he has a beard"."""
_MADE = listed("made of")
"""Prepositions before what a thing is made of."""
_OF_LOOKS = frozenset({"gender", "age", "hair", "shape"})
"""Keys whose values people use as nouns: "the woman", "the blonde", "the ball"; "the iron" is no thing of iron."""
_OF_WHOLE = frozenset({"orientation", "gender", "age", "smiling"})
"""Keys that say how a whole thing is: of "a man in a suit looking left" the man looks left."""
_CLOTHES = frozenset(["clothes", "clothing", "cloth", "outfit", "attire", "dress", "wear", "garment"])
"""Nouns for whatever people wear."""
_PICTURES = frozenset(["picture", "pic", "photo", "photograph", "image", "portrait", "face", "headshot"])
_SHOWING = {("of", True, False), ("in", False, True), ("on", False, True)}
"""Prepositions between a picture and a person, and which of the two nouns is the picture."""
_PLACES = frozenset({*PLACE_WORDS, *LINE_OF})
"""Nouns that name parts of a scene, whatever keys there are: a column is no `shape`."""
_ENDINGS = ("ed", "d")
"""Of "bearded", "blue-eyed": what is left is tried as a key."""


def by_attributes(trees: Sequence[ParseTree], world: WorldModel) -> list[ParseTree]:
    """Trees in which what is said of the attributes of the world's objects is words.

    Args:
        world: its objects' attributes are "key: value", or a key that is merely true. What is held is no such key.
            Without any the trees come back as they are.
    """
    given = {a for o in world.objects for a in o.attributes if a != LOOKED_ROUND}
    keys = frozenset(attribute_key(a.partition(":")[0]) for a in given - {_HELD})
    if not keys:
        return list(trees)
    types = {t for t in world.classes if not t.startswith(OPAQUE)}
    colored = any(o.color is not None or o.rgb is not None for o in world.objects)
    worn = {attribute_key(a.partition(":")[0]) for a in given if not _yes_or_no(a)}
    pairs = frozenset((attribute_key(a.partition(":")[0]), a.partition(":")[2]) for a in given if ":" in a)
    dresses = tuple(sorted(filter(is_clothing, worn)))
    speaking = _Speaking(keys, tuple(sorted(types)), colored, dresses, _of_colorless(world), pairs)
    colors = {o.color for o in world.objects}
    return [speaking.root(_worn_colors(tree, {value for _, value in pairs}, colors)) for tree in trees]


def _worn_colors(tree: ParseTree, values: Collection[str], colors: Collection[str | None]) -> ParseTree:
    """The tree in which "dirty blue" is no colour where things are dirty, and others blue."""
    if not any(" " in (node.phrase.color or "") for node in tree.walk()):
        return tree
    phrase, children = tree.phrase, tuple(_worn_colors(child, values, colors) for child in tree.children)
    value, _, color = (phrase.color or "").partition(" ")
    if phrase.color not in colors and color in colors and not {value, f" {value}"}.isdisjoint(values):
        phrase = replace(phrase, color=color, words=tuple(dict.fromkeys((*phrase.words, value))))
    return ParseTree(phrase, children)


def _of_colorless(world: WorldModel) -> frozenset[str]:
    """The values of the attributes of things without a colour: "red" of a traffic light whose `state` it is."""
    plain = {a for o in world.objects if o.color is None and o.rgb is None for a in o.attributes}
    return frozenset(normalise(a.partition(":")[2]) for a in plain if ":" in a)


def _yes_or_no(attribute: str) -> bool:
    _, _, value = attribute.partition(":")
    return value.strip() in ("", "yes", "no")


class _Speaking:
    """Reads trees by the keys and the classes that are there."""

    def __init__(
        self,
        keys: frozenset[str],
        types: Sequence[str],
        colored: bool,
        worn: Sequence[str],
        values: Collection[str],
        pairs: Collection[tuple[str, str]],
    ) -> None:
        self.keys, self.types, self.colored, self.worn, self.values = keys, types, colored, worn, values
        self.pairs = pairs
        self.of_people = len(keys & OF_PEOPLE) > 1

    def root(self, tree: ParseTree) -> ParseTree:
        """The whole tree: "he has dark hair and a tie", "glasses, no beard" name the thing by what it has."""
        nouns = [child for child in tree.children if child.phrase.kind is PhraseKind.NOUN]
        wears = "wear" in tree.phrase.words
        of_each = [
            self.possessed(noun, denied=noun.phrase.text.startswith("no ")) if wears or noun.phrase.noun else []
            for noun in nouns
        ]
        had = [word for words in of_each for word in words]
        owners = [noun for noun, words in zip(nouns, of_each, strict=True) if not words]
        if had and (len(nouns) > 1 or not set(tree.phrase.words).isdisjoint(_HAVING) or not tree.phrase.words):
            first = owners[0] if owners else ParseTree(Phrase(PhraseKind.NOUN, ""))
            below = tuple(c for noun, words in zip(nouns, of_each, strict=True) if words for c in noun.children)
            owner = _with_words(replace(first, children=(*first.children, *below)), had)
            rest = [child for child in tree.children if all(child is not noun for noun in nouns)]
            tree = replace(tree, children=(owner, *owners[1:], *rest))
        return self.described(tree)

    def described(self, tree: ParseTree) -> ParseTree:
        """A node and all below it."""
        children: list[ParseTree] = []
        words: list[str] = []
        if tree.phrase.kind is PhraseKind.NOUN and self.of_people:
            tree = self.pictured(tree)
        left = list(tree.children)
        while left:
            child = left.pop(0)
            moved = list(self.moved(child)) if tree.phrase.kind is PhraseKind.NOUN else []
            words += [word for word, _ in moved]
            left[:0] = [below for _, of in moved for below in of]
            children += [] if moved else [child]
        if tree.phrase.kind is PhraseKind.PREPOSITION:
            children = [self.bearer(child) for child in children]
        tree = replace(tree, children=tuple(self.described(child) for child in children))
        if tree.phrase.kind is not PhraseKind.NOUN:
            return tree
        return _with_words(replace(tree, phrase=self.own_words(tree.phrase)), words)

    def bearer(self, landmark: ParseTree) -> ParseTree:
        """ "Left of the white shirt" is left of who has it."""
        words = self.possessed(landmark, denied=False) if landmark.phrase.noun else []
        if not words:
            return landmark
        return ParseTree(replace(landmark.phrase, noun=None, color=None, words=tuple(words)), landmark.children)

    def pictured(self, tree: ParseTree) -> ParseTree:
        """ "The picture of the old man", "the man in the left picture": what shows somebody stands for who is shown."""
        shows = (tree.phrase.noun or "").split(" ")
        if len(shows) > 1 and shows[-1] in _PICTURES:
            return replace(tree, phrase=replace(tree.phrase, noun=" ".join(shows[:-1])))
        for k, place in enumerate(tree.children):
            if place.phrase.kind is not PhraseKind.PREPOSITION or len(place.children) != 1:
                continue
            phrase, shown = tree.phrase, place.children[0].phrase
            if (place.phrase.words[0], phrase.noun in _PICTURES, shown.noun in _PICTURES) not in _SHOWING:
                continue
            noun = phrase.noun if shown.noun in _PICTURES else shown.noun
            words = tuple(dict.fromkeys((*phrase.words, *shown.words)))
            both = replace(phrase, noun=noun, words=words, color=phrase.color or shown.color)
            below = (*tree.children[:k], *place.children[0].children, *tree.children[k + 1 :])
            return self.pictured(ParseTree(both, below))
        if shows[-1] in _PICTURES and not names_one_of(shows[-1], self.types):
            return replace(tree, phrase=replace(tree.phrase, noun=None))  # "the face in the corner" is a person
        return tree

    def moved(self, place: ParseTree) -> Iterator[tuple[str, tuple[ParseTree, ...]]]:
        """The words that a prepositional phrase says of its noun phrase, if its landmarks are no things.

        With each word what is said of the landmark, which is then said of the whole ("the beard on the left").
        """
        name = place.phrase.words[0]
        plain = name.removeprefix(NOT_)
        if place.phrase.kind is not PhraseKind.PREPOSITION or plain not in _POSSESSIVE:
            return
        denied = (name != plain) != (plain == "without")
        made = self.material(place) if plain in _MADE else None
        if made is not None:
            yield f"{NOT_}{made}" if denied else made, ()
            return
        found = [
            (_worn_marks(landmark.phrase, denied) or self.possessed(landmark, denied=denied), landmark.children)
            for landmark in place.children
        ]
        if all(words for words, _ in found):
            for words, below in found:
                yield from ((word, below if k == 0 else ()) for k, word in enumerate(words))

    def material(self, place: ParseTree) -> str | None:
        """The value of "(made) of wood", "(a mug) of steel", where some key has such values."""
        said = place.children[0].phrase if len(place.children) == 1 else Phrase(PhraseKind.NOUN, "")
        word = said.noun or said.color
        bare = word is not None and not (said.words or place.children[0].children) and not said.text.startswith("the ")
        return word if bare and word is not None and states_value(word, self.keys - _OF_LOOKS) else None

    def possessed(self, noun: ParseTree, *, denied: bool) -> list[str]:
        """The words that say that an object has what a noun phrase names; none if it names no key."""
        phrase = noun.phrase
        said = [word for word in (phrase.color, *phrase.words) if word]
        if phrase.noun is None or (phrase.noun in _CLOTHES and phrase.noun not in self.keys):
            return self.dressed(phrase, denied=denied)
        if phrase.noun in _PLACES or names_one_of(phrase.noun, self.types):
            return []
        key = named_key(phrase.noun, self.keys)
        if key is None or (key in _OF_LOOKS and states_value(phrase.noun, frozenset({key}))):
            return []  # a triangle is a shape, and has none
        whole = [w for w in said if _is_of_whole(w.removeprefix(NOT_), key)]
        like = [w for w in said if w not in whole and not w.startswith(NOT_)]
        denied = denied or "no" in like
        values = [word for word in like if word != "no" and word not in _OWNED]
        own = [self.having(value, key) for value in values] or [f"{HAS}{key}"]
        return [*(f"{NOT_}{word}" if denied else word for word in own), *whole]

    def having(self, value: str, key: str) -> str:
        """The word of "black hair": just that where there is brown hair as well, and dark hair where there is not."""
        own = normalise(value)
        there = frozenset(normalise(v) for of, v in self.pairs if of == key)
        return f"{key}{OF_KEY}{own}" if is_told_apart(own, key, there) else f"{HAS}{value} {key}"

    def dressed(self, phrase: Phrase, *, denied: bool) -> list[str]:
        """The words of "(wearing) black", "in formal clothes", where what people wear is told."""
        values = [word for word in phrase.words if states_value(word, self.keys & {"suit"})]
        if len(self.worn) == 1 and phrase.color is not None:
            values.append(f"{HAS}{phrase.color} {self.worn[0]}")
        return [f"{NOT_}{word}" if denied else word for word in values]

    def without_values(self, noun: str, phrase: Phrase) -> tuple[str | None, list[str]]:
        """A noun without what states values before it: "redhead man"; None where it is all of a value: "red head"."""
        before, last = noun.split(" ")[:-1], noun.split(" ")[-1]
        if any(" " in word and singular(word.split(" ")[-1]) == noun and says_value(word) for word in phrase.words):
            return None, []
        if not before or noun in map(normalise, self.types) or not all(states_value(w, self.keys) for w in before):
            return noun, []
        known = names_one_of(last, self.types) or (self.of_people and _is_person(last))
        return (last, before) if known else (noun, [])

    def own_words(self, phrase: Phrase) -> Phrase:
        """A noun phrase whose noun, colour and participles say what attributes hold: "woman", "grey-haired"."""
        words = list(phrase.words)
        color = phrase.color
        for k, word in enumerate(phrase.words):
            if OF_KEY in word:
                continue
            denied, (*like, stem) = word.startswith(NOT_), word.removeprefix(NOT_).split(" ")
            key = next((named_key(stem.removesuffix(e), self.keys) for e in _ENDINGS if stem.endswith(e)), None)
            if key is None or stem in self.keys:
                continue
            if not like and k and states_value(words[k - 1], frozenset({key})):
                like = [words[k - 1]]  # "dark-haired"
            words[k] = f"{NOT_ if denied else ''}{self.having(' '.join(like), key) if like else HAS + key}"
        noun = phrase.noun
        if noun is not None:
            noun, values = self.without_values(noun, phrase)
            words += values
            color = None if noun is None else color
        if noun is not None and states_value(noun, self.keys):
            named = names_one_of(noun, self.types)
            if named or states_value(noun, self.keys & _OF_LOOKS):
                words.append(noun)
                noun = noun if named else None
        if self.of_people and noun is not None and _is_person(noun) and not names_one_of(noun, self.types):
            noun = noun if any(_is_person(type_) for type_ in self.types) else None
        if color is not None and not self.colored:
            own = {part for word in phrase.text.split() for part in normalise(word).split()}
            dressed = len(self.worn) == 1 and own.isdisjoint(color.split())  # "the guy in black"
            words.append(f"{HAS}{color} {self.worn[0]}" if dressed else color)
        elif color is not None and color in self.values:
            words.append(color)
        return replace(phrase, words=tuple(dict.fromkeys(words)), color=color, noun=noun)


def _worn_marks(phrase: Phrase, denied: bool) -> list[str]:
    """The words of "(in) the red jacket" that are a value of what people wear ("wears: red jacket").

    With them what says where somebody is: "in red far left". None of them where more is said of what is worn.
    """
    marks = [word for word in phrase.words if OF_KEY in word]
    worn = all(is_worn(word.partition(OF_KEY)[0]) for word in marks)
    where = [word for word in phrase.words if word in _SIDES or word.endswith("most")]
    if not worn or not marks or phrase.noun or phrase.color or len(marks) + len(where) < len(phrase.words):
        return []
    return [*(f"{NOT_}{word}" if denied else word for word in marks), *where]


def _is_of_whole(word: str, key: str) -> bool:
    """Does a word beside what somebody has say how or where he himself is: "a tie and bald", "a suit looking left"?"""
    if word.endswith("most") or word in SIDED:
        return True
    return states_value(word, _OF_WHOLE - {key}) or (says_whether(word) and not states_value(word, frozenset({key})))


def _is_person(name: str) -> bool:
    return not is_generic(name) and log_odds(name, "person") > 0.0


_OWNED = listed("owners")
_SIDES = frozenset({*SIDED, "far"})


def _with_words(tree: ParseTree, words: Sequence[str]) -> ParseTree:
    return replace(tree, phrase=replace(tree.phrase, words=tuple(dict.fromkeys((*tree.phrase.words, *words)))))
