"""The parse tree as the factor graph reads it: the path to the object meant, its modifiers, and what each stands in."""

from __future__ import annotations

import functools
from collections.abc import Sequence
from dataclasses import replace
from typing import NamedTuple

from dcg_torch.interpretation.coordination import each_meant, either_color
from dcg_torch.interpretation.distances import said_apart, said_turn
from dcg_torch.interpretation.egocentric_adverbs import with_egocentric_places
from dcg_torch.interpretation.plain_lines import in_whole_line
from dcg_torch.interpretation.plain_words import in_group, in_plain_words
from dcg_torch.interpretation.scene_kinds import is_board, scene_kind, stands_among
from dcg_torch.names.normal_form import heads
from dcg_torch.names.relations import listed
from dcg_torch.names.vocabulary import (
    ANYTHING,
    GROUP_WORDS,
    INSIDE,
    LATERAL,
    LEVEL,
    NTH,
    OF_BOTH,
    OF_TWO,
    OR,
    ORDINALS,
    PLACE_WORDS,
    RANKING,
    READ_FROM,
    SIDE_MIDDLE,
    SIDED,
    SO_FAR,
    VERTICAL,
    WITHIN,
    counted,
    is_superlative,
    ranks_from_landmark,
)
from dcg_torch.scene.layout import NEAREST
from dcg_torch.scene.upright_pictures import is_upright
from dcg_torch.scene.workspace import Beside
from dcg_torch.types import NOT, ParseTree, Phrase, PhraseKind, WorldModel
from dcg_torch.types.geometry import positions

_AT = listed("on a side of the scene")
"""Prepositions that say at which side of the scene a thing is."""

_LEVEL = 0.02
"""Metres of height within which all stands on one level."""


@functools.lru_cache(maxsize=1024)
def speaks_of(tree: ParseTree) -> Beside:
    """What a tree of factors speaks of beside things and the usual places."""
    phrases = [node.phrase for node in tree.walk()]
    nouns = [phrase.noun or "" for phrase in phrases]
    return Beside(
        any(map(in_group, phrases)),
        any(noun in READ_FROM for noun in nouns),
        any(map(_is_a_pair, phrases)),
        any(PLACE_WORDS.get(noun, ("", None))[0] == SIDE_MIDDLE for noun in nouns),
    )


def _is_a_pair(phrase: Phrase) -> bool:
    """Two that stand side by side as a group? Stacks of two are groups anyway."""
    kinds = [GROUP_WORDS.get(word or "", ("stack",)) for word in (phrase.noun, *phrase.words)]
    return counted(phrase.words) == 2 and any("stack" not in of for of in kinds)


@functools.lru_cache(maxsize=1024)
def path_to_object(tree: ParseTree) -> ParseTree:
    """The path from the root to the object meant: a tree's first child leads to it.

    What modifies a noun phrase, and where a thing is to be put, is beyond the paper's features.
    """
    if tree.phrase.kind is PhraseKind.NOUN:
        return ParseTree(tree.phrase)
    return ParseTree(tree.phrase, tuple(map(path_to_object, tree.children[:1])))


@functools.lru_cache(maxsize=1024)
def coordinated(tree: ParseTree) -> tuple[ParseTree, ...]:
    """A tree for each noun phrase that a command is about: "the cube and the cone" is two of them."""
    joined = each_meant(_joined(tree))
    if len(joined) < 2:
        return (tree,)
    first = tree.children[0]
    if first.phrase.kind is PhraseKind.PREPOSITION:
        return tuple([replace(tree, children=(replace(first, children=(noun,)),)) for noun in joined])
    others = tuple(child for child in tree.children if child.phrase.kind is not PhraseKind.NOUN)
    return tuple([replace(tree, children=(noun, *others)) for noun in joined])


@functools.lru_cache(maxsize=1024)
def offers_choice(tree: ParseTree) -> bool:
    """Is one of the noun phrases that a command joins meant, whichever: "the cube or the cone"?"""
    return any(OR in noun.phrase.words for noun in _joined(tree))


def _joined(tree: ParseTree) -> tuple[ParseTree, ...]:
    """The noun phrases that a command is about."""
    first = tree.children[0] if tree.children else None
    if tree.phrase.kind is PhraseKind.NOUN:
        return ()
    if first is not None and first.phrase.kind is PhraseKind.PREPOSITION:
        return tuple(one for noun in first.children for one in either_color(noun))
    nouns = (child for child in tree.children if child.phrase.kind is PhraseKind.NOUN)
    return tuple(one for noun in nouns for one in either_color(noun))


def to_factor_tree(tree: ParseTree, world: WorldModel | None = None) -> ParseTree:
    """The path to the object meant, with everything that describes the object.

    A preposition below a noun phrase becomes a MODIFIER, and phrases get their context: a noun phrase what is done
    with its object ("object of take") or that it is a landmark and of what; a modifier what its landmark is. Both are
    told what "the closest" is one of.

    Args:
        world: that the tree is grounded in; None: no object has a name that is also one of a place.
    """
    return in_setting(tree, _NOWHERE if world is None else setting_of(world))


class Setting(NamedTuple):
    """What a tree of factors depends on of a world.

    Attributes:
        there: the names of the types that may be there.
        level: does all, or most on a board, stand on one level, or as on a page that stands upright?
        scene: the kind of scene.
        among: does the robot stand among the things?
    """

    there: frozenset[str]
    level: tuple[bool, bool]
    scene: str
    among: bool = False


_NOWHERE = Setting(frozenset(), (False, False), "")


def setting_of(world: WorldModel) -> Setting:
    """The setting that a world is: what of it changes how a tree is read."""
    at = positions([o for o in world.objects if o.position is not None])
    heights = at[:, 2].tolist()
    flat = len(at) > 0 and max(heights) - min(heights) < _LEVEL
    upright = not flat and is_upright(world.objects, world.viewer or world.robot)
    kind = scene_kind(world)
    flat = flat or (not upright and is_board(kind) and _low(heights) > 0.5)
    among = world.robot is not None and stands_among(at[:, :2] - (world.robot.x, world.robot.y))
    return Setting(heads(world.classes), (flat, upright), kind, among)


def _low(heights: Sequence[float]) -> float:
    """The share of things that stand on the level of the lowest one."""
    bound = min(heights) + _LEVEL
    return sum([height < bound for height in heights]) / len(heights)


@functools.lru_cache(maxsize=1024)
def in_setting(tree: ParseTree, setting: Setting) -> ParseTree:
    """The factor tree in a setting: one command is grounded in many worlds of a kind. See `to_factor_tree`."""
    there, (flat, upright), scene, among = setting
    said = with_egocentric_places(in_whole_line(tree), among=among)
    plain = in_plain_words(said, there, flat=flat or upright, upright=upright)
    found = _described(_beyond(plain) if flat else plain)
    return _said_in(found, scene) if scene else found


_BEYOND = {"above": "behind", "under": "in front of", "not above": "not behind", "not under": "not in front of"}


def _beyond(tree: ParseTree) -> ParseTree:
    """Where all lies on one level what is above a thing is behind it, if nobody sees it from another side."""
    phrase, children = tree.phrase, tuple(map(_beyond, tree.children))
    name = _BEYOND.get(phrase.words[0]) if phrase.words and phrase.kind is PhraseKind.PREPOSITION else None
    return ParseTree(phrase if name is None else replace(phrase, words=(name, *phrase.words[1:])), children)


def _said_in(tree: ParseTree, scene: str) -> ParseTree:
    children = tuple(_said_in(child, scene) for child in tree.children)
    return ParseTree(replace(tree.phrase, scene=scene), children)


def _described(tree: ParseTree) -> ParseTree:
    if tree.phrase.kind is PhraseKind.NOUN:
        return _noun(tree, ())
    verb = " ".join(tree.phrase.words)
    child = tree.children[0] if tree.children else None
    if child is None:
        return tree
    if child.phrase.kind is PhraseKind.NOUN:
        return replace(tree, children=(_noun(child, (f"object of {verb}", "object")),))
    if child.phrase.kind is PhraseKind.PREPOSITION and child.children:
        noun = _noun(child.children[0], (f"object of {verb}", "object"))
        return replace(tree, children=(replace(child, children=(noun,)),))
    return replace(tree, children=(child,))


def comparison_set(phrase: Phrase, modifiers: Sequence[ParseTree] = ()) -> str:
    """What a noun phrase's object is one of: of those of its kind, type or colour, of all, or of its row."""
    if any(m.phrase.words[0] in INSIDE and in_group(m.children[0].phrase) for m in modifiers):
        return "row"
    if phrase.noun is not None:
        return "kind" if phrase.color is not None else "type"
    return "color" if phrase.color is not None else "all"


def _landmark_context(tree: ParseTree) -> tuple[str, ...]:
    """What a modifier is relative to: things stand otherwise to a corner than to another thing."""
    phrase = tree.children[0].phrase
    if in_group(phrase):
        return ("to a group",)
    return ("to a place", f"to {PLACE_WORDS[phrase.noun][0]}") if phrase.noun in PLACE_WORDS else ("to a thing",)


def _noun(tree: ParseTree, context: tuple[str, ...]) -> ParseTree:
    phrase = replace(tree.phrase, noun=None) if tree.phrase.noun in ANYTHING else tree.phrase
    described = [c for c in tree.children if c.phrase.kind is PhraseKind.PREPOSITION and c.children]
    phrase, described = _counted_from(phrase, described)
    described = _within_parts(phrase, described)
    among = comparison_set(phrase, described)
    # What can be taken has no part in which is the middle one of a stack.
    told = (is_superlative(word) or word in ORDINALS or word.startswith(LEVEL) for word in phrase.words)
    placed = among == "row" and any(told)
    phrase = replace(phrase, context=() if placed else context, among=among)
    return ParseTree(phrase, tuple(_modifier(one, phrase) for child in described for one in _apart(child)))


def _apart(tree: ParseTree) -> list[ParseTree]:
    """ "Next to the cube and the cone" is next to each of them; "between" needs both."""
    if len(tree.children) < 2 or tree.phrase.words[0].removeprefix(f"{NOT} ") in OF_BOTH:
        return [tree]
    return [replace(tree, children=(landmark,)) for landmark in tree.children]


def _counted_from(phrase: Phrase, described: list[ParseTree]) -> tuple[Phrase, list[ParseTree]]:
    """An ordinal that counts from a landmark is told to what names it: "second" of "second closest to the sphere"."""
    at = next((k for k, c in enumerate(described) if c.phrase.words[0] in RANKING), None)
    ordinals = [word for word in phrase.words if word in ORDINALS]
    ranked = any(is_superlative(word) or word.startswith("from ") for word in phrase.words)
    if at is None or len(ordinals) != 1 or ranked:
        return phrase, described
    below, number = described[at], ORDINALS[ordinals[0]]
    said = ordinals[0] if number <= NEAREST else _LAST_NUMBERED
    beyond = (f"{NTH}{number}",) if number > NEAREST else ()
    words = (f"{said} {below.phrase.words[0]}", *below.phrase.words[1:], *beyond)
    changed = [*described[:at], replace(below, phrase=replace(below.phrase, words=words)), *described[at + 1 :]]
    return replace(phrase, words=tuple(word for word in phrase.words if word not in ordinals)), changed


_LAST_NUMBERED = next(word for word, number in ORDINALS.items() if number == NEAREST)
"""Places from a landmark beyond it have no weights of their own, and are counted in its place."""


def _within_parts(phrase: Phrase, described: list[ParseTree]) -> list[ParseTree]:
    """What is ranked on a side is ranked in a part of the scene, of which all have as good a claim to be on that side.

    "The nearest cube on the left" is the nearest of those, not the leftmost; all of "the cubes on the left" are there.
    """
    whole = phrase.plural and phrase.count is None
    from_somebody = any(map(_ranks_from_somebody, described))
    ranked = any(map(is_superlative, phrase.words)) or from_somebody
    # "Of the two cubes on the right the lower one" is the lower one of the two that are on the right.
    ranked |= counted(phrase.words) is not None and any(not c.phrase.text and _side_of(c) in SIDED for c in described)
    # "The left cube at the front", "the cube on your right in the back": the left one of those at the front.
    lateral = not LATERAL.isdisjoint(phrase.words) or any(_side_of(c) in LATERAL for c in described)

    parts = [c for c in described if _is_a_side(c) and (whole or ranked or (lateral and _side_of(c) in VERTICAL))]
    parts += [c for c in described if from_somebody and _is_far_off(c)]
    return [_within(c) if c in parts else c for c in described]


def _side_of(place: ParseTree) -> str | None:
    return place.children[0].phrase.noun if place.children and not place.children[0].children else None


def _ranks_from_somebody(place: ParseTree) -> bool:
    """Not from a corner or the middle: these are places beside the side ("in the middle on the left")."""
    landmark = place.children[0].phrase
    kind, _ = PLACE_WORDS.get(landmark.noun or "", (None, None))
    return ranks_from_landmark(place.phrase.words[0]) and kind in (None, "robot", "speaker")


def _is_a_side(place: ParseTree) -> bool:
    return place.phrase.words[0] in _AT and _side_of(place) in SIDED


def _is_far_off(place: ParseTree) -> bool:
    """ "On your far left", which is said to be at a side and ranks from it."""
    at = place.phrase.text.split(" ")[0] in _AT
    return at and place.phrase.words[0] in RANKING and _side_of(place) in SIDED


def _within(place: ParseTree) -> ParseTree:
    return replace(place, phrase=replace(place.phrase, words=(WITHIN, *place.phrase.words[1:])))


def _modifier(tree: ParseTree, head: Phrase) -> ParseTree:
    words = tree.phrase.words
    if words[0].startswith(f"{NOT} "):
        words = (words[0].removeprefix(f"{NOT} "), *words[1:], NOT)
    landmarks = [_noun(n, (f"landmark: of {' '.join(words)}", "landmark: of any")) for n in tree.children]
    if words[0] in OF_TWO and len(landmarks) == 1 and landmarks[0].phrase.plural:
        landmarks *= 2  # "between the two cones": two of one description
    several = head.count if head.count is not None and head.count > 1 else None
    if said_apart(tree.phrase) is not None or said_turn(tree.phrase) is not None:
        words = (SO_FAR, *words[1:])
    phrase = Phrase(
        PhraseKind.MODIFIER,
        tree.phrase.text,
        words,
        plural=head.plural and not in_group(head),
        count=several,
        context=_landmark_context(tree),
        among=head.among,
    )
    return ParseTree(phrase, tuple(landmarks))
