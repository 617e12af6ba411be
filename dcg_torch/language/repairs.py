"""What a speaker takes back: "Take the cube, no, the ball" orders to take the ball."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

from dcg_torch.language.items import END, Item, Kind
from dcg_torch.language.lexicon import PLACING, SETS
from dcg_torch.names.noun_similarity import is_akin

_SAYING = frozenset({Kind.VERB, Kind.NOUN, Kind.PREPOSITION})


def repair(items: Sequence[Item]) -> list[Item]:
    """The phrases of a command, with what is said instead in the place of what is taken back."""
    at = next((k for k, item in enumerate(items) if item.text in SETS["corrections"]), None)
    if at is None:
        return list(items)
    said, new, denied = items[:at], list(items[at + 1 :]), False
    while new and (denied or new[0].kind not in _SAYING):  # "no, not the red one, the blue one"
        denied = new[0].kind is Kind.NEGATION
        new.pop(0).said = True
    first = new[0] if new else END
    begin = max((k + 1 for k, item in enumerate(said) if item.kind is Kind.STOP), default=0)
    begin += _taken_back(said[begin:], first)
    alone = first.kind is Kind.NOUN and _SAYING.isdisjoint(item.kind for item in new[1:])
    # "Put the cube on the table, no, the ball": it goes there, too.
    more = said[begin + 1 :] if alone and any(item.is_a("putting") for item in said) else []
    for item in said[begin:]:
        item.said = item not in more
    was = next((item for item in said[begin:] if item.kind is Kind.NOUN and not item.is_a("someone")), None)
    if was is not None:
        _speak_of(was, new, said[begin])
    return repair([*said[:begin], *new[:1], *more, *new[1:]])


def _taken_back(said: Sequence[Item], new: Item) -> int:
    """Where in a sentence begins what a phrase takes the place of: all of it, the object or the last of its kind."""
    fits = [k for k, item in enumerate(said) if item.kind is new.kind and not item.is_a("someone")]
    objects = [k for k in fits if new.kind is Kind.NOUN and (k == 0 or said[k - 1].kind is not Kind.PREPOSITION)]
    landmark = said[fits[-1]].noun if objects and fits[-1] not in objects else None
    if landmark not in {None, *SETS["places"]} and is_akin(new.noun, landmark, said[objects[-1]].noun):
        return fits[-1]  # "the pillow on the bed, no, the couch"
    return (objects or fits or [len(said)])[-1]


def _speak_of(was: Item, new: list[Item], old: Item) -> None:
    """What the first noun phrase said instead leaves open is what the old one was about: "it", "one", a bare side."""
    k = next((k for k, item in enumerate(new) if item.kind is Kind.NOUN), len(new))
    noun = (*new, END)[k]
    if k == 1 and noun.is_a("sided") and old.name in PLACING["beside"]:
        new[0].words = (f"{noun.noun} of",)  # "left of the bowl, no, to the right"
        new[1] = was.copy()
    elif noun.is_a("back"):
        new[k] = replace(was, start=noun.start, stop=noun.stop)
    elif noun.pronoun and noun.noun is None:
        noun.noun, noun.pronoun = was.noun, was.noun is None
