"""Compounds of two things that are there: "the desk lamp" is the lamp on the desk, "the bedside lamp" one by the bed.

So it is where a class of that name is not there, and where some of the things named by the last word stand on what the
first words name, and others do not. "The bedroom lamp" is one in the bedroom, where the bedroom is there as a thing.
"The baby giraffe" is small among the giraffes.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import replace

from dcg_torch.interpretation.parser_protocol import Words
from dcg_torch.names.everyday_names import everyday
from dcg_torch.names.normal_form import normalise
from dcg_torch.names.rooms import room_named
from dcg_torch.names.weights import log_odds
from dcg_torch.types import OPAQUE, Object, ParseTree, Phrase, PhraseKind, WorldModel

_NAMED = 4.0
"""Log-odds from which a noun is the name of a class."""
_ONE = "one"
_SPOT = 0.6
"""Units within which, seen from above, a thing is over another whose extents nobody says."""


def by_compounds(tree: ParseTree, said: Words, world: WorldModel) -> ParseTree:
    """A tree in which such compounds are a noun and where it stands.

    Args:
        said: the words of the tree.
    """
    if not said.words.isdisjoint(everyday().ages):
        tree = _sized(tree, world)
    if any(_ends_in_one(node.phrase) for node in tree.walk()):
        types = {normalise(type_) for type_ in {o.type for o in world.objects} if type_}
        tree = _joined(tree, frozenset(name for name in types if " " in name))
    return _split(tree, world) if any(" " in noun for noun in said.nouns) else tree


def _joined(tree: ParseTree, names: frozenset[str]) -> ParseTree:
    """ "Not the wooden bridge, the stone one": a word before "one" makes the name of a class with the noun before.

    Where no noun was named, it does where one class alone begins with it.

    Args:
        names: of classes, of several words.
    """
    phrase, children = tree.phrase, tuple(_joined(child, names) for child in tree.children)
    if _ends_in_one(phrase):
        for word in phrase.words:
            begun = [n for n in names if n.partition(" ")[0] == word and (phrase.noun or "") in (n.split(" ")[-1], "")]
            if len(begun) == 1:
                kept = tuple(w for w in phrase.words if w != word)
                return ParseTree(replace(phrase, noun=begun[0], words=kept), children)
    return tree if children == tree.children else ParseTree(phrase, children)


def _ends_in_one(phrase: Phrase) -> bool:
    return _ONE in phrase.text and phrase.kind is PhraseKind.NOUN and _ONE in phrase.text.split(" ")


def _sized(tree: ParseTree, world: WorldModel) -> ParseTree:
    """ "The adult zebra" is a large one, where things have extents and nobody says how old they are."""
    children, ages = tuple(_sized(child, world) for child in tree.children), everyday().ages
    known = any(a.startswith("age") for o in world.objects for a in o.attributes)
    if known or tree.phrase.kind is not PhraseKind.NOUN or all(o.size is None for o in world.objects):
        return replace(tree, children=children)
    words = tuple(ages.get(word, word) for word in tree.phrase.words)
    return ParseTree(tree.phrase if words == tree.phrase.words else replace(tree.phrase, words=words), children)


def _split(tree: ParseTree, world: WorldModel) -> ParseTree:
    phrase = tree.phrase
    children = tuple(_split(child, world) for child in tree.children)
    words = (phrase.noun or "").split(" ") if phrase.kind is PhraseKind.NOUN else []
    if len(words) < 2:
        return ParseTree(phrase, children)
    things = [o for o in world.objects if o.position is not None and o.type and not o.type.startswith(OPAQUE)]
    types = {o.type or "" for o in things}
    first, head = " ".join(words[:-1]), words[-1]
    named = {word for type_ in types for word in normalise(type_).split(" ")}
    beside = everyday().beside.get(first)
    heads = [o for o in things if log_odds(head, o.type or "") > _NAMED]
    if len(heads) < 2 or (not named.isdisjoint(words[:-1]) and not _is_class(first, types)):
        return ParseTree(phrase, children)
    if any(log_odds(phrase.noun or "", type_) > _NAMED and normalise(type_) != head for type_ in types):
        return ParseTree(phrase, children)
    if (size := everyday().ages.get(first)) is not None and any(o.size is not None for o in heads):
        return ParseTree(replace(phrase, noun=head, words=(*phrase.words, size)), children)
    place = beside or first
    marks = [o for o in things if log_odds(place, o.type or "") > _NAMED and o not in heads]
    over = [any(_is_over(o, mark, world.unit) for mark in marks) for o in heads]
    name = "next to" if beside else "on" if room_named(place) is None else "in"
    if not marks or (name == "on" and (all(over) or not any(over))):
        return ParseTree(phrase, children)
    where = ParseTree(Phrase(PhraseKind.NOUN, place, noun=place))
    preposition = Phrase(PhraseKind.PREPOSITION, name, (name,))
    return ParseTree(replace(phrase, noun=head), (*children, ParseTree(preposition, (where,))))


def _is_class(name: str, types: Sequence[str] | set[str]) -> bool:
    return any(normalise(type_) == name for type_ in types)


def _is_over(thing: Object, mark: Object, unit: float) -> bool:
    if thing.position is None or mark.position is None or thing.position[2] <= mark.position[2]:
        return False
    offset = [abs(a - b) for a, b in zip(thing.position[:2], mark.position[:2], strict=True)]
    if mark.size is None:
        return math.hypot(*offset) < _SPOT * unit
    return all(apart <= extent / 2.0 for apart, extent in zip(offset, mark.size[:2], strict=True))
