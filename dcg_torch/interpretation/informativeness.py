"""Who tells of a thing that is alone of its kind what stands beside it means what stands there.

"There is a bed. The cushion is to its left" says where one of several cushions is, in a room with one bed: to know the
bed, its name would have been enough. In a room with three beds it may as well tell which of them is meant. So with "the
chair closest to the sink at the table that is near the door": the only sink needs no table, one of two tables a door.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence

from dcg_torch.names.relations import listed
from dcg_torch.names.vocabulary import STOOD_ON, ranks_from_landmark
from dcg_torch.names.weights import names_one_of
from dcg_torch.types import OPAQUE, ParseTree, PhraseKind, WorldModel

_NEEDLESS = 3.0
"""Nats that a reading loses by which more is said of a thing than is needed to know it."""
_WITH, _PRONOUNS = "with", listed("stands for a thing")


def needless(trees: Sequence[ParseTree], world: WorldModel) -> list[float]:
    """By how many nats each reading of a command says more than need be of what it speaks of.

    Args:
        trees: of the readings; of one alone, and of several that mean the same, nothing is needless.
        world: its classes say of how many things a noun is the name.
    """
    if len(trees) < 2:
        return [0.0] * len(trees)
    meant = [next((node for node in tree.walk() if node.phrase.kind is PhraseKind.NOUN), tree) for tree in trees]
    told = [any(map(_is_told_beside, noun.children)) for noun in meant]
    needed = len({noun.phrase.noun for noun in meant}) < 2
    more, texts = [_wrongly_described(tree, world) for tree in trees], [noun.phrase.text for noun in meant]
    least = {one: min(m for m, text in zip(more, texts, strict=True) if text == one) for one in set(texts)}
    return [
        _NEEDLESS * (wrong - least[text] + (beside and not needed and _is_alone(noun.phrase.noun, world)))
        for noun, beside, wrong, text in zip(meant, told, more, texts, strict=True)
    ]


def _wrongly_described(tree: ParseTree, world: WorldModel) -> int:
    """How many landmarks are described that need it not, or are not that need it.

    Of tables, which may be where all stands, and of what a thing is said to be the nearest to.
    """
    wrong = 0
    for place in tree.walk():
        ranked = any(map(ranks_from_landmark, place.phrase.words))
        for mark in place.children if place.phrase.kind is PhraseKind.PREPOSITION else ():
            noun, again = mark.phrase.noun, mark.phrase.text.split(" ")[0] in _AGAIN
            told = again or any(map(_is_told_there, mark.children))
            if noun in STOOD_ON:
                wrong += told is (_how_many(noun, world) < _SEVERAL)
            elif ranked and told:
                wrong += _is_alone(noun, world)
    return wrong


def _is_told_there(place: ParseTree) -> bool:
    """Is it said with a landmark where that is, and not by another sentence: "the window is close to it"?"""
    marks = [mark.phrase.text.split(" ")[0] for mark in place.children]
    return place.phrase.kind is PhraseKind.PREPOSITION and _PRONOUNS.isdisjoint(marks)


_SEVERAL, _AGAIN = 2, listed("points back") | _PRONOUNS


def _is_told_beside(place: ParseTree) -> bool:
    """A sentence of its own says what stands by it: "the cushion is to its left", "there is a bin next to it"."""
    if place.phrase.words != (_WITH,) or len(place.children) != 1 or place.phrase.text != place.children[0].phrase.text:
        return False
    marks = [mark.phrase for relation in place.children[0].children for mark in relation.children]
    return any(mark.text.split(" ")[0] in _PRONOUNS for mark in marks)


def _is_alone(noun: str | None, world: WorldModel) -> bool:
    return _how_many(noun, world) == 1


def _how_many(noun: str | None, world: WorldModel) -> int:
    """Of how many things a noun is the name, where their classes say what they are."""
    if noun is None:
        return 0
    counts = Counter(o.type for o in world.objects if o.type is not None and not o.hypothetical)
    if any(type_.startswith(OPAQUE) for type_ in counts):
        return 0
    return sum(count for type_, count in counts.items() if names_one_of(noun, (type_,)))
