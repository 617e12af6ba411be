"""Blocks of a stack: "the second block from the ground", "the lowest one of the tower".

Where there is a stack, a noun phrase that counts along it gets a word for the level ("level: 2 up"), which is compared
with the level that each thing is at (`with_levels`).
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterable, Sequence
from dataclasses import replace

from dcg_torch.interpretation.parser_protocol import Words
from dcg_torch.names.relations import listed
from dcg_torch.names.vocabulary import DEFINITE, GROUP_WORDS, INSIDE, LEVEL, ORDINALS, PLACE_WORDS, counted
from dcg_torch.scene.groups import stacks
from dcg_torch.types import Object, ParseTree, Phrase, PhraseKind, WorldModel

_ENDS = dict.fromkeys(("bottom", "bottommost", "lowest", "lower", "from the bottom"), "up")
_ENDS |= dict.fromkeys(("top", "topmost", "highest", "upper", "from the top"), "down")
_FEET = listed("foot of a stack")
_AT_ENDS = {"at the bottom of": "up"}
_TALL = 3
"""Levels at least of the one stack that "the second from the bottom" is about where none is named."""


def from_the_ground(tree: ParseTree) -> ParseTree:
    """A noun phrase in which "the second from the ground" is the second from the bottom."""
    phrase = tree.phrase
    if phrase.kind is not PhraseKind.NOUN or ORDINALS.keys().isdisjoint(phrase.words):
        return tree
    ground = next((c for c in tree.children if c.phrase.words[:1] == ("from",) and _is_ground(c)), None)
    if ground is None:
        return tree
    kept = tuple(c for c in tree.children if c is not ground)
    return ParseTree(replace(phrase, words=(*phrase.words, "from the bottom")), (*kept, *ground.children[0].children))


def end_of_a_stack(tree: ParseTree) -> ParseTree:
    """ "Take the top of the tower" is its top thing: no place, as "on top of the tower" is one."""
    place = tree.children[0] if tree.children else tree
    if tree.phrase.kind is not PhraseKind.VERB or place.phrase.kind is not PhraseKind.PREPOSITION:
        return tree
    said = place.phrase.text.split(" ")
    end = next((word for word in said if word in _ENDS), None)
    if end is None or said[0] not in DEFINITE or not (place.children and _is_stack(place.children[0].phrase)):
        return tree
    inside = ParseTree(Phrase(PhraseKind.PREPOSITION, "of", ("in",)), place.children)
    one = ParseTree(Phrase(PhraseKind.NOUN, place.phrase.text, (end,)), (inside,))
    return replace(tree, children=(one, *tree.children[1:]))


def _is_stack(phrase: Phrase) -> bool:
    return any(GROUP_WORDS.get(word or "", ())[:1] == ("stack",) for word in (phrase.noun, *phrase.words))


def levels_of_stack(words: Sequence[str], children: Sequence[ParseTree]) -> tuple[str, ...]:
    """The words of a noun phrase whose object is in a stack: the bottom one is the lowest, and not the nearest."""
    if "bottom" not in words:
        return tuple(words)
    places = (c for c in children if c.phrase.words[:1] and c.phrase.words[0] in INSIDE and len(c.children) == 1)
    if not any(_is_stack(c.children[0].phrase) for c in places):
        return tuple(words)
    return tuple("lowest" if word == "bottom" else word for word in words)


def _is_ground(place: ParseTree) -> bool:
    phrase = place.children[0].phrase if len(place.children) == 1 else place.phrase
    return PLACE_WORDS.get(phrase.noun or "", ("", None))[0] == "ground" and not phrase.words


def by_levels(tree: ParseTree, said: Words, world: WorldModel) -> ParseTree:
    """A tree in which what is said of the ends of a stack, and of what is counted from them, is words for levels.

    Args:
        said: the words of the tree.
    """
    if said.nouns.isdisjoint(_FEET) and said.words.isdisjoint(_ENDS) and said.words.isdisjoint(_AT_ENDS):
        return tree
    found = _stacks(world)
    tall = any(len(of) >= _TALL and 2 * len(of) > _seen(world) for of in found)
    return _told(tree, tall, frozenset(map(len, found))) if found else tree


def with_levels(world: WorldModel, trees: Iterable[ParseTree]) -> WorldModel:
    """The world whose things have the levels of their stacks as attributes, if a tree speaks of levels."""
    if not any(word.startswith(LEVEL) for tree in trees for node in tree.walk() for word in node.phrase.words):
        return world
    levels: dict[str, frozenset[str]] = defaultdict(lambda: frozenset({f"{LEVEL}none"}))
    for of in _stacks(world):
        for k, o in enumerate(of, 1):
            told = (f"{LEVEL}{k} up", f"{LEVEL}{len(of) + 1 - k} down")
            levels[o.id] = frozenset({*told, *(f"{level} of {len(of)}" for level in told)})
    objects = (replace(o, attributes=o.attributes | levels[o.id]) for o in world.objects)
    return replace(world, objects=tuple(objects))


def _seen(world: WorldModel) -> int:
    return sum(not o.hypothetical for o in world.objects)


def _stacks(world: WorldModel) -> list[list[Object]]:
    return stacks(world.objects, world.unit, world.viewer or world.robot)


def _told(tree: ParseTree, tall: bool, heights: frozenset[int]) -> ParseTree:
    tree = from_the_ground(replace(tree, children=tuple(_told(child, tall, heights) for child in tree.children)))
    phrase = tree.phrase
    stack = next((c for c in tree.children if _is_in_stack(c)), None)
    along = [word for word in phrase.words if word in _ENDS]
    number = next((ORDINALS[word] for word in phrase.words if word in ORDINALS), None)
    if stack is None:
        said = number is not None and along and along[0].startswith("from ") and tall and not tree.children
        return ParseTree(_at(phrase, number or 1, _ENDS[along[0]])) if said else tree
    end = _ENDS[along[0]] if along else _AT_ENDS.get(stack.phrase.words[0])
    if phrase.noun in _FEET and not along:
        phrase, end = replace(phrase, noun=None), "up"
    if phrase.kind is not PhraseKind.NOUN or end is None or phrase.plural:
        return tree
    inside = replace(stack, phrase=replace(stack.phrase, words=("in",)))
    blocks = counted(stack.children[0].phrase.words)
    if blocks in heights:  # "the top of the stack of two" is no other stack's top
        end = f"{end} of {blocks}"
    return ParseTree(_at(phrase, number or 1, end), tuple(inside if c is stack else c for c in tree.children))


def _at(phrase: Phrase, number: int, end: str) -> Phrase:
    """A phrase for what is at a level, without what counts to it."""
    words = tuple(word for word in phrase.words if word not in _ENDS and word not in ORDINALS)
    return replace(phrase, words=(*words, f"{LEVEL}{number} {end}"), count=None)


def _is_in_stack(place: ParseTree) -> bool:
    """Does it say that a thing is one of a stack?"""
    if place.phrase.kind is not PhraseKind.PREPOSITION or len(place.children) != 1:
        return False
    landmark = place.children[0].phrase
    named = (landmark.noun or "", *landmark.words)
    stack = any(GROUP_WORDS.get(word, ())[:1] == ("stack",) for word in named)
    return stack and place.phrase.words[0] in INSIDE - {"on top of", "in the middle of"}
