"""Commands and worlds as the relational features read them.

A tree's modifiers are marked, and every phrase is told what it stands in; a world gets the places that can be spoken
of, and the groups that its objects form where the command speaks of one.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

from dcg_torch import scene
from dcg_torch.types import (
    NOT,
    Correspondence,
    Example,
    Object,
    ParseTree,
    Phrase,
    PhraseKind,
    Pose,
    Symbol,
    WorldModel,
)

# What people call the places; the side is the one that the word itself names, seen from the robot.
_PLACE_WORDS = {
    "corner": ("corner", None),
    "edge": ("edge", None),
    "side": ("edge", None),
    "border": ("edge", None),
    "margin": ("edge", None),
    "left": ("edge", "left side"),
    "right": ("edge", "right side"),
    "top": ("edge", "far side"),
    "back": ("edge", "far side"),
    "bottom": ("edge", "near side"),
    "front": ("edge", "near side"),
    "middle": ("middle", None),
    "center": ("middle", None),
    "centre": ("middle", None),
    "you": ("robot", None),
    "robot": ("robot", None),
    "yourself": ("robot", None),
    "floor": ("ground", None),
    "ground": ("ground", None),
    "board": ("ground", None),
    "table": ("ground", None),
    "me": ("speaker", None),
    "myself": ("speaker", None),
    "speaker": ("speaker", None),
}
_DIRECTIONS = {"left": "left side", "right": "right side", "front": "far side", "back": "near side"}
"""Nouns for the sides of somebody: "on your left"."""
PLACE_WORDS = frozenset(_PLACE_WORDS)
"""Nouns for places."""
PLACE_TYPES = frozenset(kind for kind, _ in _PLACE_WORDS.values())
_OWNERS = {"your": "of robot", "my": "of speaker"}
_GROUP_WORDS = {
    "row": ("row",),
    "line": ("row",),
    "column": ("row", "stack"),
    "stack": ("stack",),
    "tower": ("stack",),
    "pile": ("stack", "cluster"),
    "heap": ("stack", "cluster"),
    "group": ("cluster",),
    "bunch": ("cluster",),
    "cluster": ("cluster",),
    "collection": ("cluster",),
}
"""What people call groups."""
_INSIDE = frozenset({"in", "of", "from", "at the bottom of", "on top of", "in the middle of"})
"""Prepositions by which a thing is one of a group."""
_ANYTHING = frozenset({"thing", "object", "item", "one"})
"""Nouns that may be said of every object."""
_SIDE_WORDS = {"left": "left side", "right": "right side", "top": "far side", "far": "far side", "back": "far side"}
_SIDE_WORDS |= {
    "bottom": "near side",
    "near": "near side",
    "front": "near side",
    "upper": "far side",
    "lower": "near side",
}
_EITHER_END = frozenset({"back", "front"})
"""Of a table or a room: people who face the robot and people who stand behind it mean opposite ends."""
_AMBIGUOUS = 0.05
_GROUP_WEIGHT = 0.5
_PLACE_WEIGHT = 0.1
"""Of the hand-made examples of places: people differ about which side is the back, so a corpus must be able to say."""


def place_symbols() -> list[Symbol]:
    """The words for places that are known from the start."""
    return [Symbol(word, kind) for word, (kind, _) in _PLACE_WORDS.items()]


def group_nouns() -> tuple[str, ...]:
    """The words for groups that are known from the start."""
    return tuple(_GROUP_WORDS)


def place_examples() -> list[Example]:
    """Hand-made examples of what the words for places, for their sides, and for groups mean."""
    robot, speaker = Pose(0.0, 0.0), Pose(4.0, 0.0)
    things = scene.places((1.0, 7.0, -3.0, 3.0), robot, speaker)
    cube = Object("cube", "cube", known=True)
    world = WorldModel((cube,), robot, speaker, things)
    phrases: list[tuple[Phrase, set[str], set[str]]] = []
    for noun, (kind, side) in _PLACE_WORDS.items():
        phrase = Phrase(PhraseKind.NOUN, noun, noun=noun, context=("landmark: of any",))
        phrases.append((phrase, {kind}, set() if side is None else {side}))
        if kind in ("corner", "edge") and side is None:
            phrases += [(replace(phrase, words=(word,)), {kind}, {of}) for word, of in _SIDE_WORDS.items()]
        if noun in _DIRECTIONS:
            for word, owner in _OWNERS.items():
                whose = replace(phrase, words=(word,))
                phrases.append((whose, {"direction"}, {_DIRECTIONS[noun], owner}))
    return [
        Example(
            phrase,
            world,
            tuple(
                Correspondence.ACTIVE if o.type in kinds and sides <= o.attributes else Correspondence.INACTIVE
                for o in world.things
            ),
            weight=_PLACE_WEIGHT * (_AMBIGUOUS if {phrase.noun, *phrase.words} & _EITHER_END else 1.0),
        )
        for phrase, kinds, sides in phrases
    ] + _group_examples()


def _group_examples() -> list[Example]:
    """A row, a stack and a cluster of cubes: which of them a word means, and that a cube alone is none of them."""
    rows = [Object(f"row {k}", "cube", known=True, position=(3.0, 1.0 * k, 0.0)) for k in range(3)]
    stack = [Object(f"stack {k}", "cube", known=True, position=(8.0, 0.0, 1.0 * k)) for k in range(3)]
    heap = [Object(f"heap {k}", "cube", known=True, position=(14.0 + k % 2, 1.0 * (k // 2), 0.0)) for k in range(4)]
    objects = (*rows, *stack, *heap)
    kept = [g for g in scene.groups(objects) if {m.split()[0] for m in g.members} in ({"row"}, {"stack"}, {"heap"})]
    groups = tuple(g for g in kept if ("row" in g.attributes) == g.members[0].startswith("row"))
    world = WorldModel(objects, Pose(0.0, 0.0), groups=groups)

    def labels(kinds: tuple[str, ...]) -> tuple[Correspondence, ...]:
        meant = [bool(o.attributes & set(kinds)) if o.members else not kinds for o in world.things]
        return tuple(Correspondence.ACTIVE if m else Correspondence.INACTIVE for m in meant)

    said = [Example(Phrase(PhraseKind.NOUN, "cube", noun="cube"), world, labels(()), weight=_GROUP_WEIGHT)]
    for word, kinds in _GROUP_WORDS.items():
        alone = Phrase(PhraseKind.NOUN, word, noun=word)
        of_cubes = Phrase(PhraseKind.NOUN, f"{word} of cubes", (word,), "cube", plural=True)
        said += [Example(phrase, world, labels(kinds), weight=_GROUP_WEIGHT) for phrase in (alone, of_cubes)]
    return said


@dataclass(frozen=True)
class Workspace:
    """What the scenes of one robot have in common.

    Attributes:
        bounds: of its workspace, seen from the robot; None: each scene has its own, those of its objects.
        unit: metres that neighbours are apart.
    """

    bounds: scene.Bounds | None = None
    unit: float = 1.0


def furnished(world: WorldModel, workspace: Workspace | None = None) -> WorldModel:
    """A world with the places that can be spoken of.

    Without a workspace there are no edges, only the robot, the speaker and the directions from them: the world of a
    robot that drives about. A speaker of whom nothing is known is then taken to stand with the robot, and to speak of
    the robot's left and right.
    """
    if workspace is None:
        found = scene.places(None, world.robot, world.speaker)
        if world.speaker is None:
            here = [replace(place, id="place: speaker", type="speaker") for place in found if place.type == "robot"]
            found += tuple(here)
        return replace(world, places=found)
    bounds, there = workspace.bounds, [o.position for o in world.objects if o.position is not None]
    if bounds is None and there:
        bounds = scene.scene_bounds(there, world.robot)
    return replace(world, places=scene.places(bounds, world.robot, world.speaker), unit=workspace.unit)


def grouped(world: WorldModel, tree: ParseTree) -> WorldModel:
    """A world with the groups that its objects form, if the command speaks of any."""
    if not any(is_group(node.phrase) for node in tree.walk()):
        return world
    return replace(world, groups=scene.groups(world.objects, world.unit))


def is_group(phrase: Phrase) -> bool:
    """Does a noun phrase speak of a group of objects?"""
    return phrase.kind is PhraseKind.NOUN and any(w in _GROUP_WORDS for w in (phrase.noun, *phrase.words))


def coordinated(tree: ParseTree) -> list[ParseTree]:
    """A tree for each noun phrase that a command is about: "the cube and the cone" is two of them."""
    first = tree.children[0] if tree.children else None
    if first is not None and first.phrase.kind is PhraseKind.PREPOSITION:
        return [replace(tree, children=(replace(first, children=(noun,)),)) for noun in first.children] or [tree]
    nouns = [child for child in tree.children if child.phrase.kind is PhraseKind.NOUN]
    if tree.phrase.kind is PhraseKind.NOUN or len(nouns) < 2:
        return [tree]
    others = tuple(child for child in tree.children if child.phrase.kind is not PhraseKind.NOUN)
    return [replace(tree, children=(noun, *others)) for noun in nouns]


def relational(tree: ParseTree) -> ParseTree:
    """The path to the object meant, with everything that describes the object.

    A preposition below a noun phrase becomes a MODIFIER, and phrases get their context: a noun phrase what is done
    with its object ("object of take") or that it is a landmark and of what; a modifier what its landmark is. Both are
    told what "the closest" is one of.
    """
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


def among(phrase: Phrase, modifiers: Sequence[ParseTree] = ()) -> str:
    """What a noun phrase's object is one of: of those of its kind, type or colour, of all, or of its row."""
    if any(m.phrase.words[0] in _INSIDE and is_group(m.children[0].phrase) for m in modifiers):
        return "row"
    if phrase.noun is not None:
        return "kind" if phrase.color is not None else "type"
    return "color" if phrase.color is not None else "all"


def _landmark_context(tree: ParseTree) -> tuple[str, ...]:
    """What a modifier is relative to: things stand otherwise to a corner than to another thing."""
    phrase = tree.children[0].phrase
    if is_group(phrase):
        return ("to a group",)
    return ("to a place", f"to {_PLACE_WORDS[phrase.noun][0]}") if phrase.noun in _PLACE_WORDS else ("to a thing",)


def _noun(tree: ParseTree, context: tuple[str, ...]) -> ParseTree:
    phrase = replace(tree.phrase, noun=None) if tree.phrase.noun in _ANYTHING else tree.phrase
    described = [c for c in tree.children if c.phrase.kind is PhraseKind.PREPOSITION and c.children]
    phrase = replace(phrase, context=context, among=among(phrase, described))
    return ParseTree(phrase, tuple(_modifier(child, phrase) for child in described))


def _modifier(tree: ParseTree, head: Phrase) -> ParseTree:
    words = tree.phrase.words
    if words[0].startswith(f"{NOT} "):
        words = (words[0].removeprefix(f"{NOT} "), *words[1:], NOT)
    landmarks = [_noun(n, (f"landmark: of {' '.join(words)}", "landmark: of any")) for n in tree.children]
    if words[0] in ("between", "in the middle of") and len(landmarks) == 1 and landmarks[0].phrase.plural:
        landmarks *= 2  # "between the two cones": two of one description
    several = head.count if head.count is not None and head.count > 1 else None
    phrase = Phrase(
        PhraseKind.MODIFIER,
        tree.phrase.text,
        words,
        count=several,
        context=_landmark_context(tree),
        among=head.among,
    )
    return ParseTree(phrase, tuple(landmarks))
