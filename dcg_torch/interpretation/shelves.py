"""Shelves that are no things of a scene.

What stands before who looks at several heights stands on shelves: "the top shelf" is its top row. "The box on the top
shelf of the rack" is the highest that is on the rack.
"""

from __future__ import annotations

from dataclasses import replace

from dcg_torch.interpretation.spoken import Words
from dcg_torch.names.normal import normalise
from dcg_torch.names.vocabulary import LINE_ENDS, ORDINALS, TIERS
from dcg_torch.scene.upright import is_upright
from dcg_torch.types import OPAQUE, ParseTree, PhraseKind, WorldModel

_ON = frozenset({"on", "in", "from", "at"})
_OF = frozenset({"of", "on", "in"})
_EXTREMES = {0: "highest", -1: "lowest"}


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
