"""What commands say of rooms: "the lamp in the bedroom", "my office chair", "go to the bathroom and empty the bin".

A room is no thing that others stand next to. So a noun phrase that something is in gets a word for the room: for the
values of the key that gives the rooms ("room: kids room"), or else for what can be told by what stands around
("likely room: bedroom"), which is compared with the rooms that each thing is likely to be in (`with_rooms`).
"""

from __future__ import annotations

import functools
import itertools
from collections import Counter
from collections.abc import Collection, Iterable, Sequence
from dataclasses import replace

from dcg_torch.interpretation.coordination import own_and_repeated
from dcg_torch.interpretation.parser_protocol import Words
from dcg_torch.names.attributes import NOT_
from dcg_torch.names.keys import OF_KEY, attribute_key
from dcg_torch.names.normal_form import normalise
from dcg_torch.names.relations import listed
from dcg_torch.names.rooms import room_keys, room_named, told_rooms, within_words
from dcg_torch.names.vocabulary import LIKELY_ROOM
from dcg_torch.names.weights import log_odds, names_one_of
from dcg_torch.names.wordnet import nouns
from dcg_torch.scene.rooms import in_room
from dcg_torch.types import OPAQUE, Object, ParseTree, Phrase, PhraseKind, WorldModel

_IN, _ELSEWHERE = 0.45, 0.15
"""Probabilities from which a thing is taken to be in a room, and below which it is taken not to be."""
_ELSE = f"{LIKELY_ROOM}another"
_TELLING = 0.8
"""From which a thing tells its room by itself."""
_ABOUT = listed("in a room")
_NAMED = 4.0
"""Log-odds from which a noun is rather a class that is there than a room."""


def by_rooms(tree: ParseTree, said: Words, world: WorldModel) -> ParseTree:
    """A tree in which rooms that something is in are words of what is in them.

    Args:
        said: the words of the tree.
    """
    if not (any(map(_may_name_room, said.nouns)) or any(map(_is_room, said.words))):
        return tree
    types = frozenset(t for t in world.classes if not t.startswith(OPAQUE))
    return _Speaking(_values(world), types, world.objects).node(_each_in_its_room(tree))


def _each_in_its_room(tree: ParseTree) -> ParseTree:
    """ "The mug in the kitchen and the mug in the office": two noun phrases, each with a room."""
    if tree.phrase.kind is not PhraseKind.VERB:
        return tree
    first, *others = tree.children or (tree,)
    if others and others[0].phrase.kind is PhraseKind.PREPOSITION and first.phrase.kind is PhraseKind.NOUN:
        whole = _with_its_own(replace(first, children=(*first.children, others[0])))
        first, others = (whole, others[1:]) if len(whole.children) == len(first.children) else (first, others)
    nouns = [own_and_repeated(_with_its_own(c)) if c.phrase.kind is PhraseKind.NOUN else [c] for c in (first, *others)]
    return replace(tree, children=tuple(itertools.chain.from_iterable(nouns))) if tree.children else tree


def _with_its_own(noun: ParseTree) -> ParseTree:
    """A noun phrase in which a place behind the same noun, said again, is in the second one's phrase."""
    for k, (place, after) in enumerate(itertools.pairwise(noun.children)):
        again = place.children[-1] if len(place.children) > 1 else place
        bare = again.phrase.kind is PhraseKind.NOUN and again.phrase.noun == noun.phrase.noun and not again.children
        if bare and after.phrase.kind is PhraseKind.PREPOSITION and after.phrase.words[:1] == place.phrase.words[:1]:
            whole = replace(place, children=(*place.children[:-1], replace(again, children=(after,))))
            return replace(noun, children=(*noun.children[:k], whole, *noun.children[k + 2 :]))
    return noun


def led_into_rooms(trees: Sequence[ParseTree], world: WorldModel) -> list[tuple[ParseTree, bool]]:
    """ "Go to the bedroom and turn on the fan": the fan in the bedroom.

    Args:
        trees: the readings of one command, see `by_rooms`.

    Returns:
        Each reading, and whether it only leads to a room where others are about a thing.
    """
    nouns = [_first_noun(tree) for tree in trees]
    if not any(map(_room, filter(None, nouns))):
        return [(tree, False) for tree in trees]
    types = frozenset(t for t in world.classes if not t.startswith(OPAQUE))
    rooms = [_room(noun) if noun and is_only_a_room(noun.noun or "", types) else None for noun in nouns]
    if all(room is None for room in rooms) or all(rooms):
        return [(tree, False) for tree in trees]
    speaking = _Speaking(_values(world), types, world.objects)
    word = next(speaking.word(noun) for noun, room in zip(nouns, rooms, strict=True) if noun and room)
    found = []
    for tree, room in zip(trees, rooms, strict=True):
        placed = any(one.startswith(LIKELY_ROOM) or _is_room(one) for node in tree.walk() for one in node.phrase.words)
        told = () if room or word is None or placed else (word,)
        found.append((_of_first(tree, told), room is not None))
    return found


@functools.lru_cache(maxsize=1024)
def speaks_of_what_is_not_there(tree: ParseTree, types: frozenset[str]) -> bool:
    """Does the first noun of a reading name nothing that is there, or but a room?

    Args:
        types: the classes that are there, without opaque ones.
    """
    noun = next((node.phrase.noun for node in tree.walk() if node.phrase.noun is not None), None)
    if noun is None or not types:
        return False
    return not names_one_of(noun, types) or is_only_a_room(noun, types)


def leads_to_a_room(tree: ParseTree) -> bool:
    """Is the first noun phrase of a command the name of a room?"""
    first = _first_noun(tree)
    return first is not None and _room(first) is not None


@functools.lru_cache(maxsize=1024)
def _first_noun(tree: ParseTree) -> Phrase | None:
    return next((node.phrase for node in tree.walk() if node.phrase.kind is PhraseKind.NOUN), None)


def is_only_a_room(noun: str, types: Collection[str]) -> bool:
    """Does a noun name a room, and no class that is there?"""
    return room_named(noun) is not None and not any(log_odds(noun, type_) > _NAMED for type_ in types)


def _is_room(word: str) -> bool:
    _, key, value = word.removeprefix(NOT_).partition(OF_KEY)
    return bool(key) and room_named(value) is not None


def _values(world: WorldModel) -> dict[str, list[str]]:
    """Room -> the attributes that say that something is in it.

    Where several keys name rooms ("room", "belongs in"), those that say where a thing is, or else the commonest.
    """
    said = Counter(a.partition(OF_KEY)[::2] for o in world.objects for a in o.attributes)
    told = {pair: room for pair in sorted(said) if pair[1] and (room := room_named(pair[1])) is not None}
    times: Counter[str] = Counter()
    for key, value in told:
        times[key] += said[key, value]
    where = {key for key in times if normalise(key) in room_keys()} or {key for key, _ in times.most_common(1)}
    found: dict[str, list[str]] = {}
    for (key, value), room in told.items():
        if key in where:
            found.setdefault(room, []).append(f"{attribute_key(key)}{OF_KEY}{normalise(value)}")
    return found


@functools.lru_cache(maxsize=4096)
def _may_name_room(noun: str) -> bool:
    words = noun.split(" ")
    return noun == "room" or any(room_named(" ".join(words[: k + 1])) for k in range(len(words)))


def _room(phrase: Phrase) -> str | None:
    return None if phrase.kind is not PhraseKind.NOUN or phrase.noun is None else room_named(phrase.noun)


def _is_value(phrase: Phrase) -> bool:
    """Is it the name of a room that some key gives: "(in) the kitchen"?"""
    return phrase.noun is None and any(map(_is_room, phrase.words))


class _Speaking:
    """Reads trees where some rooms are given, and some classes are there.

    Args:
        values: room -> the attributes that say that something is in it.
    """

    def __init__(self, values: dict[str, list[str]], types: Collection[str], things: Sequence[Object]) -> None:
        self.values, self.types, self.things = values, types, things

    def node(self, tree: ParseTree) -> ParseTree:
        """A phrase and all below it."""
        children = [self.node(child) for child in tree.children]
        if tree.phrase.kind is PhraseKind.VERB and children:  # "in the kitchen, wipe the table"
            words, children[1:] = self.moved(children[1:], within=_ABOUT)
            children[0] = _of_first(children[0], words)
        if tree.phrase.kind is not PhraseKind.NOUN:
            return replace(tree, children=tuple(children))
        words, children = self.moved(self.rooms_with(children))
        phrase, own = self.own_room(tree.phrase)
        return _with_words(ParseTree(phrase, tuple(children)), (*own, *words))

    def moved(
        self, children: Sequence[ParseTree], *, within: Collection[str] = within_words()
    ) -> tuple[list[str], list[ParseTree]]:
        """The words for the rooms that places name, and what is left: what was said of the room is of the thing."""
        words: list[str] = []
        left: list[ParseTree] = []
        for child in children:
            name = child.phrase.words[0] if child.phrase.words else ""
            plain = name.removeprefix(NOT_)
            place = child.phrase.kind is PhraseKind.PREPOSITION and len(child.children) == 1
            word = self.word(child.children[0].phrase) if place and plain in within else None
            if word is None:
                left.append(child)
            else:
                words.append(f"{NOT_}{word}" if name != plain else word)
                left += child.children[0].children
        return words, left

    def rooms_with(self, children: Sequence[ParseTree]) -> list[ParseTree]:
        """Places in which "(in) the room with the piano" is what such a room is called."""
        inside = next((c for c in children if _is_in(c) and c.children[0].phrase.noun == "room"), None)
        if inside is None:
            return list(children)
        below = [*inside.children[0].children, *children]
        holder = next((c for c in below if c.phrase.words == ("with",) and len(c.children) == 1), None)
        name = None if holder is None else self.room_of(holder.children[0].phrase.noun or "")
        if name is None:
            return list(children)
        room = ParseTree(Phrase(PhraseKind.NOUN, name, noun=name))
        return [replace(inside, children=(room,)), *(c for c in children if c is not inside and c is not holder)]

    def room_of(self, noun: str) -> str | None:
        """The room that a thing of some name is in: where it is said to be, or where such things mostly are."""
        meant = [o for o in self.things if o.type in self.types and log_odds(noun, o.type or "") > _NAMED]
        given = {room for room, told in self.values.items() for o in meant if not o.attributes.isdisjoint(told)}
        likely = {room for o in meant for room, weight in told_rooms(o.type or "") if weight >= _TELLING}
        found = given or likely
        return found.pop() if len(found) == 1 else None

    def word(self, room: Phrase) -> str | None:
        """What says that something is in the room that a noun phrase names; None if it names none, or a thing."""
        if room.kind is PhraseKind.NOUN and _is_value(room):
            return next(filter(_is_room, room.words))
        name = _room(room)
        if name is None or not is_only_a_room(room.noun or "", self.types):
            return None
        if not self.values:
            return f"{LIKELY_ROOM}{name}"
        given = self.values.get(name)
        if given is None:
            return None
        number = next((word for word in room.words if word.isdecimal()), None)
        given = [one for one in given if number is None or one.split(" ")[-1] == number] or given
        key = given[0].partition(OF_KEY)[0]
        return f"{key}{OF_KEY}{'|'.join(one.partition(OF_KEY)[2] for one in given if one.startswith(key))}"

    def own_room(self, phrase: Phrase) -> tuple[Phrase, list[str]]:
        """ "The bedroom lamp" is a lamp in the bedroom, where no class has such a name."""
        words = (phrase.noun or "").split(" ")
        if phrase.noun in nouns():  # a kitchen table is a kind of table
            return phrase, []
        for k in range(len(words) - 1, 0, -1):
            room, thing = replace(phrase, noun=" ".join(words[:k])), " ".join(words[k:])
            if _room(room) is None or not names_one_of(thing, self.types):
                continue
            if any(log_odds(phrase.noun or "", type_) > _NAMED and normalise(type_) != thing for type_ in self.types):
                continue
            word = self.word(room)
            return (phrase, []) if word is None else (replace(phrase, noun=thing), [word])
        return phrase, []


def _is_in(place: ParseTree) -> bool:
    return (
        place.phrase.kind is PhraseKind.PREPOSITION
        and place.phrase.words[0] in within_words()
        and len(place.children) == 1
    )


def _of_first(tree: ParseTree, words: Sequence[str]) -> ParseTree:
    """A tree with words of its first noun phrase."""
    if tree.phrase.kind is PhraseKind.NOUN or not tree.children:
        return _with_words(tree, words)
    return replace(tree, children=(_of_first(tree.children[0], words), *tree.children[1:]))


def _with_words(tree: ParseTree, words: Iterable[str]) -> ParseTree:
    return replace(tree, phrase=replace(tree.phrase, words=tuple(dict.fromkeys((*tree.phrase.words, *words)))))


def with_rooms(world: WorldModel, trees: Iterable[ParseTree]) -> WorldModel:
    """The world whose things are told to be in the rooms that trees speak of or not, as far as that can be told."""
    words = {word.removeprefix(NOT_) for tree in trees for node in tree.walk() for word in node.phrase.words}
    rooms = sorted(word.removeprefix(LIKELY_ROOM) for word in words if word.startswith(LIKELY_ROOM))
    if not rooms:
        return world
    seen = [o for o in world.objects if not o.hypothetical]
    likely = {room: in_room(seen, room) for room in rooms}
    told = {o.id: {room: share[o.id] for room, share in likely.items() if o.id in share} for o in seen}
    return replace(world, objects=tuple(_in_rooms(o, told.get(o.id, {})) for o in world.objects))


def _in_rooms(thing: Object, shares: dict[str, float]) -> Object:
    own = {a for a in thing.attributes if not a.startswith(LIKELY_ROOM)}
    own |= {f"{LIKELY_ROOM}{room}" for room, share in shares.items() if share >= _IN}
    own |= {_ELSE} if any(share < _ELSEWHERE for share in shares.values()) else set()
    return thing if own == thing.attributes else replace(thing, attributes=frozenset(own))
