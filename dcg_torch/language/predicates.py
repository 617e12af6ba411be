"""What noun phrases are like, and what may be said of one: questions and small changes to a single item."""

from __future__ import annotations

from collections.abc import Sequence

from dcg_torch.language.items import Item, Kind
from dcg_torch.language.lexicon import PLACING, SETS
from dcg_torch.language.selection import is_superlative


def only_color(item: Item) -> bool:
    """Whether a noun phrase is but a colour: "dark blue"."""
    return item.pronoun and item.color is not None and not item.determined


def share_noun(first: Item, second: Item) -> None:
    """ "the red and the blue cube": the noun stands but once."""
    if first.noun is None and first.color is not None and not first.text.endswith(("one", "ones")):
        first.noun, first.pronoun = second.noun, second.noun is None


def last_thing(nouns: Sequence[Item]) -> Item:
    """The last noun phrase that words can describe: no person and no side."""
    apart = SETS["someone"] | SETS["places"]
    return next((noun for noun in reversed(nouns) if noun.noun not in apart), nouns[-1])


def is_side(item: Item) -> bool:
    """Whether a noun phrase is but a side: "left", "far right", "my left"."""
    if item.noun not in SETS["sides"] or item.color is not None or item.plural:
        return False
    owned = not SETS["owned"].isdisjoint(item.words)
    return owned or (not item.determined and all(word in SETS["sides"] for word in item.words))


def settle_nothing(noun: Item) -> None:
    """ "with nothing on top of it" becomes the word "nothing on" of the noun phrase, "nothing behind it" another."""
    for without in [child for child in noun.children if child.words == ("without",)]:
        thing = without.children[0]
        if thing.noun not in SETS["unnamed_things"] or len(thing.children) != 1:
            continue
        (where,) = thing.children
        if where.children[0].noun in {None, "top"}:
            name = where.words[0]
            noun.words += (f"nothing {'on' if name in PLACING['upon'] else name}",)
            noun.children.remove(without)


def settle_part(noun: Item) -> None:
    """ "The screwdriver with the red handle": of what has a coloured part people and recognisers say the colour."""
    for place in [child for child in noun.children if child.words == ("with",) and len(child.children) == 1]:
        part = place.children[0]
        if part.noun in SETS["parts"] and part.color is not None and noun.color is None and not part.children:
            noun.color, part.said = part.color, True
            noun.children.remove(place)


def settle_each_other(noun: Item) -> None:
    """ "side by side" becomes the preposition "next to" with another such thing."""
    if "each other" in noun.words[1:]:
        at = noun.words.index("each other")
        other = Item(Kind.NOUN, noun.stop, noun.stop, "", ("each other",), noun.noun, noun.color, pronoun=True)
        place = Item(Kind.PREPOSITION, noun.stop, noun.stop, "", noun.words[at - 1 : at], children=[other])
        noun.words = noun.words[: at - 1] + noun.words[at + 1 :]
        noun.children.append(place)


def settle_row(noun: Item) -> None:
    """ "Three cubes in a row" are a row of three."""
    for place in noun.children:
        row = place.children[0] if place.words == ("in",) and noun.plural and len(place.children) == 1 else noun
        bare = not (row.children or row.words or row.color) and not row.text.startswith("the ")
        if bare and row.noun in SETS["groups"] and SETS["groups"].isdisjoint(noun.words):
            noun.words += (row.noun, *((f"of {noun.count}",) if noun.count else ()))
            noun.count = None
            noun.children.remove(place)
            place.said = row.said = True
            return


def _is_end(word: str) -> bool:
    return is_superlative(word) and word not in SETS["ordinals"]


def is_edge_of(noun: Item, edge: Item, place: Item) -> bool:
    """Whether the edge says from where something is counted: "the second from the left", "the third on the left"."""
    ordered = any(
        word in SETS["ordinals"] or (is_superlative(word) and place.words == ("from",)) for word in noun.words
    )
    if place.words != ("from",):
        # "The third on the left" counts from there, "the second highest on the left" does not.
        along = any(word[:5] == "from " or word == "last" or _is_end(word) for word in noun.words)
        if along or edge.noun not in SETS["left_right"] or edge.words:
            return False
    return ordered and edge.noun in SETS["ends"] | SETS["someone"]
