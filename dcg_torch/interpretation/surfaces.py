"""The part of a long surface: what is on "the counter to the right of the sink" is itself to the right of the sink.

A counter runs along a wall, past what stands at it or is let into it. So a place by which people tell a part of it is
one of what is on that part as well, wherever the counter has its middle.
"""

from __future__ import annotations

import functools

from dcg_torch.interpretation.parser_protocol import Words
from dcg_torch.names.everyday_names import everyday, share_a_name
from dcg_torch.names.relations import listed
from dcg_torch.types import NOT, ParseTree, PhraseKind, WorldModel


def by_surfaces(tree: ParseTree, said: Words, _: WorldModel) -> ParseTree:
    """A tree in which the place of a part of a surface is that of what is on it, too.

    Args:
        said: the words of the tree.
    """
    return _by_surfaces(tree) if any(_is_long(noun) for noun in said.nouns) else tree


def _by_surfaces(tree: ParseTree) -> ParseTree:
    children = tuple(map(_by_surfaces, tree.children))
    if tree.phrase.kind is PhraseKind.NOUN:
        children = tuple(part for child in children for part in _parted(child))
    return tree if children == tree.children else ParseTree(tree.phrase, children)


def _parted(place: ParseTree) -> tuple[ParseTree, ...]:
    """A place at a part of a surface, and the places that tell that part; any other by itself."""
    words = place.phrase.words
    if place.phrase.kind is not PhraseKind.PREPOSITION or len(place.children) != 1:
        return (place,)
    (surface,) = place.children
    if words[:1] not in _at() or len(words) > 1 or not _is_long(surface.phrase.noun or "") or surface.phrase.plural:
        return (place,)
    return (place, *(child for child in surface.children if _tells_a_part(child)))


@functools.cache
def _at() -> frozenset[tuple[str]]:
    return frozenset((word,) for word in listed("at a surface"))


def _tells_a_part(place: ParseTree) -> bool:
    words = place.phrase.words
    return bool(words) and words[0] in listed("beside a thing") and NOT not in words and bool(place.children)


@functools.lru_cache(maxsize=1024)
def _is_long(noun: str) -> bool:
    return any(noun == name or share_a_name(noun, name) for name in everyday().surfaces)
