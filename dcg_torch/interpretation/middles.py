"""The middle one of a few in a line.

"The jar in the middle", where three jars stand in a line, is the middle one of these rather than what is nearest to the
middle of all that is there.
"""

from __future__ import annotations

from dataclasses import replace

from dcg_torch.interpretation.parser_protocol import Words
from dcg_torch.interpretation.scene_kinds import scene_kind
from dcg_torch.names.color_names import color_evidence
from dcg_torch.names.relations import listed
from dcg_torch.names.vocabulary import NEAREST
from dcg_torch.names.weights import names_one_of
from dcg_torch.scene.groups import in_line
from dcg_torch.scene.upright_pictures import laid_flat
from dcg_torch.types import Object, ParseTree, Phrase, PhraseKind, WorldModel
from dcg_torch.types.geometry import positions, to_robot_frame

_MIDDLES = listed("middle")
_LEAST = 3
"""Things at least of which one is the middle one."""


def by_middles(tree: ParseTree, said: Words, world: WorldModel) -> ParseTree:
    """A tree in which "in the middle" picks from a few things in a line, and "the middle one" of many is in the middle.

    Args:
        said: the words of the tree.
    """
    found = tree if said.nouns.isdisjoint(_MIDDLES) else _in_middle(tree, world)
    return found if said.words.isdisjoint(_MIDDLES) else _middle_of_many(found, world)


def _middle_of_many(tree: ParseTree, world: WorldModel) -> ParseTree:
    """Of many things strewn about on a table the middle one is the one at its middle: they have no order."""
    phrase = tree.phrase
    if phrase.kind is not PhraseKind.NOUN:
        return replace(tree, children=(*(_middle_of_many(c, world) for c in tree.children[:1]), *tree.children[1:]))
    if not {*phrase.words} or not {*phrase.words} <= _MIDDLES or phrase.plural or tree.children:
        return tree
    such = [o for o in world.objects if _is_such(o, phrase)]
    if len(such) <= _LEAST or "table" not in scene_kind(world).split(" ") or _in_a_line(such, world):
        return tree
    place = ParseTree(Phrase(PhraseKind.NOUN, phrase.words[0], noun="middle"))
    nearest = Phrase(PhraseKind.PREPOSITION, phrase.words[0], (NEAREST,))
    return ParseTree(replace(phrase, words=()), (ParseTree(nearest, (place,)),))


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
