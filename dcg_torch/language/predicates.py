"""What noun phrases are like, and what may be said of one: questions and small changes to a single item."""

from __future__ import annotations

from collections.abc import Sequence

from dcg_torch.language import lexicon as lx
from dcg_torch.language.items import Item

# Nouns that what a copula says replaces ("the object is a cube"), and what may be asked of a thing ("whose color is").
ANYTHING = frozenset({"thing", "object", "item", "target", "goal", "destination"})
ASPECTS = frozenset({"color", "colour", "size", "shape"})


def only_color(item: Item) -> bool:
    """Whether a noun phrase is but a colour: "dark blue"."""
    return item.pronoun and item.color is not None and not item.determined


def share_noun(first: Item, second: Item) -> None:
    """ "the red and the blue cube": the noun stands but once."""
    if first.noun is None and first.color is not None and not first.text.endswith(("one", "ones")):
        first.noun, first.pronoun = second.noun, second.noun is None


def last_thing(nouns: Sequence[Item]) -> Item:
    """The last noun phrase that words can describe: no person and no side."""
    return next((noun for noun in reversed(nouns) if noun.noun not in {"you", "me"} | lx.PLACES), nouns[-1])


def is_side(item: Item) -> bool:
    """Whether a noun phrase is but a side: "left", "far right", "my left"."""
    owned = "my" in item.words or "your" in item.words
    if item.noun not in lx.SIDES or item.color is not None or item.plural:
        return False
    return owned or (not item.determined and all(word in lx.SIDES | {"very"} for word in item.words))


def settle_nothing(noun: Item) -> None:
    """ "with nothing on top of it" becomes the word "nothing on" of the noun phrase, "nothing behind it" another."""
    for without in [child for child in noun.children if child.words == ("without",)]:
        thing = without.children[0]
        if thing.noun not in {"anything", "nothing", "thing"} or len(thing.children) != 1:
            continue
        (where,) = thing.children
        if where.children[0].noun in {None, "top"}:
            noun.words += (f"nothing {({'on top of': 'on', 'at': 'on'}).get(where.words[0], where.words[0])}",)
            noun.children.remove(without)


def is_edge_of(noun: Item, edge: Item) -> bool:
    """Whether the edge says from where something is counted: "the second from the left"."""
    ordered = any(word in lx.ORDINALS or word.endswith("est") for word in noun.words)
    return ordered and edge.noun in {"left", "right", "front", "back", "top", "bottom", "end", "me", "you"}
