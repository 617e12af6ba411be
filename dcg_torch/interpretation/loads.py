"""What something holds is part of its name: "the pallet with the tires" is the tire pallet, where one is called so.

So it is where what it holds is no thing of its own that is there: else the crate with the apples is one with apples.
"""

from __future__ import annotations

from dataclasses import replace

from dcg_torch.interpretation.parser_protocol import Words
from dcg_torch.names.everyday_names import everyday, share_a_name
from dcg_torch.names.evidence import evidence
from dcg_torch.names.relations import listed
from dcg_torch.names.weights import log_odds
from dcg_torch.types import OPAQUE, ParseTree, Phrase, PhraseKind, WorldModel

_HOLDS = frozenset({"with", "of"})
_IT = listed("stands for a thing")
_CALLED = frozenset({"name: equal", "name: head", "name: part", "name: shared word"})
"""How the name of a class is said that has both words in it, or a word for one of them."""
_NAMED = 1.0
"""Log-odds from which a noun names a class."""


def by_loads(tree: ParseTree, said: Words, world: WorldModel) -> ParseTree:
    """A tree in which what holds something is called by what it holds.

    Args:
        said: the words of the tree.
    """
    if _HOLDS.isdisjoint(said.words):
        return tree
    there = (o.type for o in world.objects if not o.hypothetical)
    types = tuple(sorted({type_ for type_ in there if type_ and not type_.startswith(OPAQUE)}))
    return _by_loads(tree, types)


def _by_loads(tree: ParseTree, types: tuple[str, ...]) -> ParseTree:
    phrase, children = tree.phrase, tuple(_by_loads(child, types) for child in tree.children)
    if phrase.kind is PhraseKind.NOUN and phrase.noun is not None and _holds_things(phrase.noun):
        for child in children:
            name = _called(phrase.noun, child, types)
            if name is not None:
                others = tuple(other for other in children if other is not child)
                return ParseTree(replace(phrase, noun=name), others)
    return tree if children == tree.children else ParseTree(phrase, children)


def _holds_things(noun: str) -> bool:
    return any(noun == name or share_a_name(noun, name) for name in everyday().packages)


def _called(noun: str, place: ParseTree, types: tuple[str, ...]) -> str | None:
    """What a thing is called with what a place says that it holds; None where no class is called so."""
    if place.phrase.kind is not PhraseKind.PREPOSITION or place.phrase.words[:1] not in (("with",), ("of",)):
        return None
    load = place.children[0] if len(place.children) == 1 else place
    held: Phrase = load.phrase
    plain = held.color is None and not held.words and (held.plural or held.noun == held.text)
    if held.noun is None or not plain or not all(map(_is_in_it, load.children)):
        return None
    name = f"{held.noun} {noun}"
    whole = [type_ for type_ in types if log_odds(noun, type_) > _NAMED]
    itself = any(log_odds(held.noun, type_) > _NAMED for type_ in types if type_ not in whole)
    called = any(evidence(name, type_)[0] in _CALLED for type_ in whole)
    return name if called and not itself else None


def _is_in_it(place: ParseTree) -> bool:
    """ "(With tires) on it"."""
    return len(place.children) == 1 and place.children[0].phrase.text in _IT
