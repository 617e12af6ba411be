"""A parse tree as the relational features read it: modifiers marked, and every phrase told what it stands in."""

from __future__ import annotations

from dataclasses import replace

from dcg_torch import space
from dcg_torch.symbols import Correspondence, Example, Object, ParseTree, Phrase, PhraseKind, Pose, Symbol, WorldModel

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
    "me": ("speaker", None),
    "myself": ("speaker", None),
    "speaker": ("speaker", None),
}
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
_PLACE_WEIGHT = 0.1
"""Of the hand-made examples of places: people differ about which side is the back, so a corpus must be able to say."""


PLACE_WORDS = frozenset(_PLACE_WORDS)
PLACE_TYPES = frozenset(kind for kind, _ in _PLACE_WORDS.values())


def place_symbols() -> list[Symbol]:
    """The words for places that are known from the start."""
    return [Symbol(word, kind) for word, (kind, _) in _PLACE_WORDS.items()]


def place_examples() -> list[Example]:
    """Hand-made examples of what the words for places, and for their sides, mean."""
    robot, speaker = Pose(0.0, 0.0), Pose(4.0, 0.0)
    things = space.places((1.0, 7.0, -3.0, 3.0), robot, speaker)
    cube = Object("cube", "cube", known=True)
    world = WorldModel((cube,), robot, speaker, things)
    phrases: list[tuple[Phrase, str, set[str]]] = []
    for noun, (kind, side) in _PLACE_WORDS.items():
        phrase = Phrase(PhraseKind.NOUN, noun, noun=noun, context=("landmark",))
        phrases.append((phrase, kind, set() if side is None else {side}))
        if kind in ("corner", "edge") and side is None:
            for word, of_word in _SIDE_WORDS.items():
                phrases.append((replace(phrase, words=(word,)), kind, {of_word}))
    return [
        Example(
            phrase,
            world,
            tuple(
                Correspondence.ACTIVE if o.type == kind and sides <= o.attributes else Correspondence.INACTIVE
                for o in world.things
            ),
            weight=_PLACE_WEIGHT,
        )
        for phrase, kind, sides in phrases
    ]


def relational(tree: ParseTree) -> ParseTree:
    """The path to the object meant, with everything that describes the object.

    A preposition below a noun phrase becomes a MODIFIER, and phrases get their context: a noun phrase what is done
    with its object ("object of take") or that it is a landmark and of what; a modifier and a describing word, what
    the object is compared with ("of kind": type and colour are said; "of type"; "of color"; "of all").
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


def compared(phrase: Phrase) -> str:
    """What a noun phrase's object is one of: of those of its kind, type or colour, or of all."""
    if phrase.noun is not None:
        return "of kind" if phrase.color is not None else "of type"
    return "of color" if phrase.color is not None else "of all"


def _landmark_context(tree: ParseTree) -> tuple[str, ...]:
    """What a modifier is relative to: things stand otherwise to a corner than to another thing."""
    noun = tree.children[0].phrase.noun
    return ("to a place", f"to {_PLACE_WORDS[noun][0]}") if noun in _PLACE_WORDS else ("to a thing",)


def _noun(tree: ParseTree, context: tuple[str, ...]) -> ParseTree:
    phrase = replace(tree.phrase, noun=None) if tree.phrase.noun in _ANYTHING else tree.phrase
    of = compared(phrase)
    modifiers = [
        ParseTree(
            Phrase(PhraseKind.MODIFIER, child.phrase.text, child.phrase.words, context=(of, *_landmark_context(child))),
            tuple(_noun(n, (f"landmark of {' '.join(child.phrase.words)}", "landmark")) for n in child.children),
        )
        for child in tree.children
        if child.phrase.kind is PhraseKind.PREPOSITION and child.children
    ]
    return ParseTree(replace(phrase, context=(*context, of) if phrase.words else context), tuple(modifiers))
