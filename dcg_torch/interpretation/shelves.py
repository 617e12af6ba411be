"""Shelves that are no things of a scene, and the middle one of a few in a line.

What stands before who looks at several heights stands on shelves: "the top shelf" is its top row. "The box on the top
shelf of the rack" is the highest that is on the rack. "The jar in the middle", where three jars stand in a line,
is the middle one of these rather than what is nearest to the middle of all that is there.
"""

from __future__ import annotations

from dataclasses import replace

from dcg_torch.interpretation.spoken import Words
from dcg_torch.names.color_names import color_evidence
from dcg_torch.names.normal import normalise
from dcg_torch.names.vocabulary import LINE_ENDS, ORDINALS, TIERS
from dcg_torch.names.weights import names_one_of
from dcg_torch.scene.groups import in_line
from dcg_torch.scene.upright import is_upright, laid_flat
from dcg_torch.types import OPAQUE, Object, ParseTree, Phrase, PhraseKind, WorldModel
from dcg_torch.types.geometry import positions, to_robot_frame

_ON = frozenset({"on", "in", "from", "at"})
_OF = frozenset({"of", "on", "in"})
_EXTREMES = {0: "highest", -1: "lowest"}
_MIDDLES = frozenset({"middle", "center", "centre"})
_LEAST = 3
"""Things at least of which one is the middle one."""


def by_shelves(tree: ParseTree, said: Words, world: WorldModel) -> ParseTree:
    """A tree in which shelves that are no things are rows, or heights in what they belong to.

    Args:
        said: the words of the tree.
    """
    if said.nouns.isdisjoint(TIERS):
        return tree
    heads = {normalise(type_).split(" ")[-1] for type_ in world.classes if not type_.startswith(OPAQUE)}
    missing = frozenset(TIERS - heads)
    return _shelved(tree, missing, is_upright(world.objects, world.viewer or world.robot)) if missing else tree


def _shelved(tree: ParseTree, missing: frozenset[str], upright: bool) -> ParseTree:
    phrase, children = tree.phrase, tuple(_shelved(child, missing, upright) for child in tree.children)
    if upright and phrase.kind is PhraseKind.NOUN and phrase.noun in missing:
        return ParseTree(replace(phrase, noun="row"), children)
    for k, place in enumerate(children if phrase.kind is PhraseKind.NOUN and not phrase.plural else ()):
        found = _height_on(place, missing)
        if found is not None:
            word, on = found
            return ParseTree(replace(phrase, words=(*phrase.words, word)), (*children[:k], on, *children[k + 1 :]))
    return ParseTree(phrase, children)


def _height_on(place: ParseTree, missing: frozenset[str]) -> tuple[str, ParseTree] | None:
    """Of "on the top shelf of the rack": the highest, and "on the rack"."""
    shelf = place.children[0] if len(place.children) == 1 else place
    name = place.phrase.words[0] if place.phrase.words else ""
    if place.phrase.kind is not PhraseKind.PREPOSITION or name not in _ON or shelf.phrase.noun not in missing:
        return None
    of = [c for c in shelf.children if c.phrase.words[:1] and c.phrase.words[0] in _OF and len(c.children) == 1]
    ends = [LINE_ENDS[word] for word in shelf.phrase.words if word in LINE_ENDS]
    if (
        len(of) != 1
        or len(ends) != 1
        or ends[0][0] not in (0, None)
        or not ORDINALS.keys().isdisjoint(shelf.phrase.words)
    ):
        return None
    return _EXTREMES[min(0, ends[0][1])], ParseTree(replace(place.phrase, words=("on",)), of[0].children)


def by_middles(tree: ParseTree, said: Words, world: WorldModel) -> ParseTree:
    """A tree in which "in the middle" picks from a few things in a line.

    Args:
        said: the words of the tree.
    """
    return tree if said.nouns.isdisjoint(_MIDDLES) else _in_middle(tree, world)


def _in_middle(tree: ParseTree, world: WorldModel) -> ParseTree:
    phrase = tree.phrase
    if phrase.kind is not PhraseKind.NOUN:
        return replace(tree, children=(*(_in_middle(c, world) for c in tree.children[:1]), *tree.children[1:]))
    place = tree.children[0] if len(tree.children) == 1 else tree
    middle = place.children[0] if len(place.children) == 1 else tree
    bare = not (middle.children or middle.phrase.words or phrase.words)
    if place.phrase.words[:1] not in (("in",), ("at",)) or middle.phrase.noun not in _MIDDLES or not bare:
        return tree
    if phrase.plural or not _in_a_line([o for o in world.objects if _is_such(o, phrase)], world):
        return tree
    return ParseTree(replace(phrase, words=("middle",)))


def _is_such(thing: Object, phrase: Phrase) -> bool:
    if thing.hypothetical or thing.position is None or thing.type is None or phrase.noun is None:
        return False
    if phrase.color is not None and "color: equal" not in color_evidence(phrase.color, thing.color or ""):
        return False
    return names_one_of(phrase.noun, (thing.type,))


def _in_a_line(things: list[Object], world: WorldModel) -> bool:
    if len(things) < _LEAST or len(things) % 2 == 0:
        return False
    seen = [o for o in world.objects if o.position is not None and not o.hypothetical]
    at, viewer = positions(seen), world.viewer or world.robot
    if viewer is not None:
        at[:, :2] = to_robot_frame(viewer, at[:, :2])
    flat = laid_flat(at) / world.unit
    number = {o.id: k for k, o in enumerate(seen)}
    return in_line([flat[number[o.id]].tolist() for o in things])
