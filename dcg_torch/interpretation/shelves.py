"""Shelves that are no things of a scene.

What stands before who looks at several heights stands on shelves: "the top shelf" is its top row. "The box on the top
shelf of the rack" is the highest that is on the rack. Where it is no such picture, for the rack is there as well, a
noun phrase gets a word for the height ("tier: 3"), which is compared with the height that each thing stands at
(`with_tiers`).

Where a rack or a bookcase is there with its extents, and things stand in it at several heights, each has shelves of its
own, by whatever name the rack goes.
"""

from __future__ import annotations

import itertools
from collections.abc import Collection, Iterable, Mapping, Sequence
from dataclasses import replace

from dcg_torch.interpretation.parser_protocol import Words
from dcg_torch.names.evidence import is_generic
from dcg_torch.names.normal_form import normalise
from dcg_torch.names.relations import listed
from dcg_torch.names.vocabulary import LINE_ENDS, ORDINALS, TIER, TIERS
from dcg_torch.names.weights import names_one_of
from dcg_torch.scene.bodies import boards
from dcg_torch.scene.upright_pictures import is_upright
from dcg_torch.types import OPAQUE, Object, ParseTree, Phrase, PhraseKind, WorldModel

_STEP = 0.1
"""Metres that shelves are apart at least."""
_EVEN = 0.5
"""Share of the widest step between heights by which others are steps to another shelf as well."""
_ON = listed("on a shelf")
_OF = listed("of a shelf")
_ENDS = {"left of": "leftmost", "right of": "rightmost"}
"""Nothing is beside a board of a rack: "on the left of the top shelf" is at its end."""
_OUTER = {"on top of": "highest", "under": "lowest"}
"""What is at the top and at the bottom of a rack."""
_EXTREMES = {0: "highest", -1: "lowest"}


def by_shelves(tree: ParseTree, said: Words, world: WorldModel) -> ParseTree:
    """A tree in which shelves that are no things are rows, or heights in what they belong to.

    Args:
        said: the words of the tree.
    """
    if said.nouns.isdisjoint(TIERS) and said.words.isdisjoint(_OUTER):
        return tree
    held = boards(world.objects)
    if held:
        tree = _inside(tree, [o for o in world.objects if o.id in held], world)
        return _at_heights(tree, TIERS, world, _tiers(world, held), _ON | _ENDS.keys())
    if said.nouns.isdisjoint(TIERS):
        return tree
    heads = {normalise(type_).split(" ")[-1] for type_ in world.classes if not type_.startswith(OPAQUE)}
    missing = frozenset(TIERS - heads)
    if not missing:
        return tree
    upright = is_upright(world.objects, world.viewer or world.robot)
    found = _shelved(tree, missing, upright)
    return found if upright else _at_heights(found, missing, world, _tiers(world, held), _ON)


def with_tiers(world: WorldModel, trees: Iterable[ParseTree]) -> WorldModel:
    """The world whose things have the number of their shelf as an attribute, if a tree speaks of one."""
    if not any(word.startswith(TIER) for tree in trees for node in tree.walk() for word in node.phrase.words):
        return world
    tiers = _tiers(world, boards(world.objects))
    told = {id_: frozenset({f"{TIER}{tier}"}) for id_, tier in tiers.items()}
    objects = (replace(o, attributes=o.attributes | told.get(o.id, frozenset())) for o in world.objects)
    return replace(world, objects=tuple(objects))


def _tiers(world: WorldModel, held: Mapping[str, Mapping[str, float]]) -> dict[str, int]:
    """Id -> number of the shelf, from the bottom, of what stands at two heights at least; else nothing.

    Args:
        held: what stands in what has boards, see `boards`.
    """
    if held:
        return {id_: tier for own in held.values() for id_, tier in _numbered(own).items()}
    there = [o for o in world.objects if o.position is not None and not o.hypothetical]
    heights = [o.position[2] for o in there if o.position is not None]
    high = max(heights, default=0.0) - min(heights, default=0.0)
    # Not the rack itself.
    seen = {o.id: z for o, z in zip(there, heights, strict=True) if o.size is None or o.size[2] < high}
    return _numbered(seen)


def _numbered(heights: Mapping[str, float]) -> dict[str, int]:
    """Id -> number of the height, from the bottom; nothing where all are one.

    Args:
        heights: id -> metres.
    """
    seen = sorted((z, id_) for id_, z in heights.items())
    steps = [above - below for (below, _), (above, _) in itertools.pairwise(seen)]
    widest = max(steps, default=0.0)
    if widest < _STEP:
        return {}
    number = itertools.accumulate((step > _EVEN * widest for step in steps), initial=1)
    return {id_: tier for (_, id_), tier in zip(seen, number, strict=True)}


def _at_heights(
    tree: ParseTree, missing: frozenset[str], world: WorldModel, tiers: Mapping[str, int], before: frozenset[str]
) -> ParseTree:
    """A tree in which what is on a shelf is on one with a number.

    Args:
        before: the prepositions that stand before the shelf that a thing is on.
    """
    phrase = tree.phrase
    children = tuple(_at_heights(child, missing, world, tiers, before) for child in tree.children)
    for k, place in enumerate(children if phrase.kind is PhraseKind.NOUN else ()):
        shelf = _shelf(place, missing, _ON if phrase.plural else before)
        tier = None if shelf is None or _is_one_of_several(shelf, world) else _tier(shelf.phrase, phrase, world, tiers)
        if shelf is not None and tier is not None:
            of = [replace(c, phrase=replace(c.phrase, words=("on",))) for c in shelf.children if _is_of(c)]
            end = _ENDS.get(place.phrase.words[0])
            phrase = replace(phrase, words=(*phrase.words, *filter(None, (end,)), f"{TIER}{tier}"))
            return ParseTree(phrase, (*children[:k], *of, *children[k + 1 :]))
    return ParseTree(phrase, children)


def _inside(tree: ParseTree, racks: Sequence[Object], world: WorldModel) -> ParseTree:
    """A tree in which "at the top of the rack" is highest in it, where nothing stands over or under it."""
    phrase, children = tree.phrase, [_inside(child, racks, world) for child in tree.children]
    for k, place in enumerate(children if phrase.kind is PhraseKind.NOUN and not phrase.plural else ()):
        name = place.phrase.words[0] if place.phrase.kind is PhraseKind.PREPOSITION and place.phrase.words else ""
        of = [rack for rack in racks if len(place.children) == 1 and _is_called(place.children[0].phrase.noun, rack)]
        if name in _OUTER and of and not any(_is_beyond(o, rack, name) for o in world.objects for rack in of):
            children[k] = replace(place, phrase=replace(place.phrase, words=("on",)))
            phrase = replace(phrase, words=(*phrase.words, _OUTER[name]))
    return ParseTree(phrase, tuple(children))


def _is_beyond(thing: Object, rack: Object, name: str) -> bool:
    """Does a thing stand over a rack, or under it?"""
    if thing.position is None or rack.position is None or rack.size is None:
        return False
    off = [abs(a - b) <= wide / 2.0 for a, b, wide in zip(thing.position, rack.position, rack.size[:2], strict=False)]
    lifted = thing.position[2] - rack.position[2]
    return all(off) and (lifted < -_STEP if name == "under" else lifted > rack.size[2] - _STEP)


def _is_one_of_several(shelf: ParseTree, world: WorldModel) -> bool:
    """Is what is called a shelf rather one of several racks: the second of them, the middle one?"""
    named = sum(o.type is not None and normalise(o.type).split(" ")[-1] == shelf.phrase.noun for o in world.objects)
    return named > 1 and not any(map(_is_of, shelf.children))


def _tier(shelf: Phrase, phrase: Phrase, world: WorldModel, tiers: Mapping[str, int]) -> int | None:
    """The number of "the top shelf", "the second shelf from the bottom", "the middle shelf".

    The top shelf is the topmost on which things of a name stand that stand on several.
    """
    every, own = sorted({*tiers.values()}), _of_name(phrase.noun, world, tiers)
    ends = [LINE_ENDS[word][1] for word in shelf.words if word in LINE_ENDS and LINE_ENDS[word][0] in (0, None)]
    number = next((ORDINALS[word] for word in shelf.words if word in ORDINALS), None)
    if "middle" in shelf.words and len(every) % 2:
        return every[len(every) // 2]
    among = own if number is None and len(own) > 1 else every
    if len(ends) > 1 or not (ends or number) or (number or 1) > len(among):
        return None
    return among[-(number or 1)] if (*ends, 1)[0] == 1 else among[(number or 1) - 1]


def _of_name(noun: str | None, world: WorldModel, tiers: Mapping[str, int]) -> list[int]:
    """The shelves of what is called so."""
    named = noun is not None and not is_generic(noun)
    return sorted({tiers[o.id] for o in world.objects if named and o.id in tiers and _is_called(noun, o)})


def _is_called(noun: str | None, thing: Object) -> bool:
    return noun is not None and thing.type is not None and names_one_of(noun, (thing.type,))


def _shelf(place: ParseTree, missing: frozenset[str], prepositions: Collection[str] = _ON) -> ParseTree | None:
    """The shelf that a place is on."""
    shelf = place.children[0] if len(place.children) == 1 else place
    name = place.phrase.words[0] if place.phrase.words else ""
    on = place.phrase.kind is PhraseKind.PREPOSITION and name in prepositions and shelf.phrase.noun in missing
    return shelf if on else None


def _is_of(place: ParseTree) -> bool:
    return place.phrase.words[:1] != () and place.phrase.words[0] in _OF and len(place.children) == 1


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
    shelf = _shelf(place, missing)
    if shelf is None:
        return None
    of = [c for c in shelf.children if _is_of(c)]
    ends = [LINE_ENDS[word] for word in shelf.phrase.words if word in LINE_ENDS]
    if (
        len(of) != 1
        or len(ends) != 1
        or ends[0][0] not in (0, None)
        or not ORDINALS.keys().isdisjoint(shelf.phrase.words)
    ):
        return None
    return _EXTREMES[min(0, ends[0][1])], ParseTree(replace(place.phrase, words=("on",)), of[0].children)
