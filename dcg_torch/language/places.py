"""Prepositional phrases -> what they belong to: a noun phrase that they describe, or the verb; and conjuncts.

spaCy's heads are right for most commands but weak for the ones that name two places ("place the red pyramid on the
green cube on the blue cube"): whether a prepositional phrase tells the object apart or says where it goes depends
on what the verb needs, so `settle` decides by the verb.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from dcg_torch.language import lexicon as lx
from dcg_torch.language.clauses import Clause, main_object
from dcg_torch.language.items import Item, Kind
from dcg_torch.language.predicates import is_side, last_thing, share_noun
from dcg_torch.language.reader import Word


@dataclass(slots=True, eq=False)
class Pending:
    """A prepositional phrase and what stands before it."""

    item: Item
    nouns: list[Item]
    forced: bool  # follows a relative pronoun or a participle: it can only tell a noun phrase apart
    joined: bool  # follows "and" or a comma


def settle(clause: Clause, pending: list[Pending], words: Sequence[Word], supplied: bool) -> None:
    """Give each prepositional phrase its parent."""
    verb = clause.verb.words[0].split()[0] if clause.verb else ""
    full = [place for place in pending if place.item.children]
    target = main_object(clause)
    supplied = supplied or any(noun.noun == "me" for noun in clause.objects)  # "bring me the cup on the table"
    if verb in lx.PUT and target is not None and not supplied:
        goal = _destination(full, verb)
    elif verb in lx.TAKE | lx.GO and target is not None and not supplied:
        goal = next((place for place in full if place.item.words[0] in lx.STRONG and not place.forced), None)
    else:
        goal = None
    last: Item | None = None
    for place in pending:
        if not place.item.children:
            if place.nouns and place.item.words[0] in {"behind", "in front of", "opposite", "above", "under"}:
                place.nouns[-1].words += place.item.words
            continue
        name = place.item.words[0]
        if name == "for" and place.item.children[0].noun in {"me", "you"}:
            continue  # "find it for me" says nothing of the thing
        path = name in lx.STRONG | lx.PATHS - {"with", "of", "like", "from", "without", "than", "as"}
        owner: Item | None
        if place is goal or not place.nouns:
            owner = None
        elif place.joined and last is not None and not place.forced and not (target is None and path):
            owner = last
        elif (
            (target is None and verb and not place.forced and path and not _about_noun(place))
            or (
                target is None
                and verb
                and not place.forced
                and not any(p.item.words[0] in lx.GOALS for p in full[: full.index(place)])
            )
            or (verb in lx.LOOK and target is None and not place.forced)
        ):
            owner = None
        else:
            owner = _nearest(place, words)
        if owner is None:
            clause.places.append(place.item)
        else:
            _below(owner, place.item)
        last = owner
    if clause.verb is None and target is None:
        _unnamed(clause)


def _unnamed(clause: Clause) -> None:
    """ "closest to me", "in the corner", "my left": of the thing only the place is said."""
    places = [p for p in clause.places if p.words[0] in lx.EXTREMES or p.children[0].noun in lx.PLACES | {"me", "you"}]
    for side in clause.objects:
        if is_side(side) and side.determined:
            place = Item(Kind.PREPOSITION, side.start, side.stop, side.head, side.text, ("on",), children=[side])
            places.append(place)
    if places:
        first = places[0]
        clause.places = [place for place in clause.places if place not in places]
        clause.objects = [Item(Kind.NOUN, first.start, first.start, first.head, "", pronoun=True, children=places)]


def _about_noun(place: Pending) -> bool:
    """ "the cone to your left", "the cube to the right": to a side is where a thing is."""
    child = place.item.children[0]
    return (
        place.item.words[0] == "to" and child.noun in {"left", "right", "side", "rear", "front"} and bool(place.nouns)
    )


def _below(owner: Item, place: Item) -> None:
    child = place.children[0]
    if place.words == ("of",) and child.pronoun and not (child.color or child.children or owner.pronoun):
        return  # "the bigger cube of the two"
    if place.words[0] in {"to", "at", "in"} and child.noun in {"left", "right"}:
        place.words = ("on",)
    owner.children.append(place)


def _nearest(place: Pending, words: Sequence[Word]) -> Item:
    """The noun phrase just before, passing over "me", "you" and sides, which nobody describes further."""
    candidates = [noun for noun in place.nouns if noun.noun not in {"me", "you"} | lx.MEASURES] or place.nouns
    if place.item.words[0] == "of":
        return candidates[-1]
    solid = [noun for noun in candidates if noun.noun not in lx.PLACES | {"hand"}] or candidates
    return solid[-1]


def _destination(places: list[Pending], verb: str) -> Pending | None:
    """Which phrase says where the object goes: a sure goal, else the last that does not only place a landmark."""
    free = [
        place
        for place in places
        if not (place.forced or place.item.words[0] in {"of", "with", "without"} or place.item.text.startswith("from"))
    ]
    # Each list is a stronger sign than the next: "to ...", "on a thing", "next to a thing", "in the corner".
    sure = [
        place for place in free if {place.item.text.split()[0], place.item.words[0]} & {"to", "onto", "into", "over"}
    ]
    solid = [place for place in free if place.item.children[0].noun not in lx.PLACES]
    support = [place for place in solid if place.item.words[0] in lx.SUPPORTS]
    if sure:
        return sure[0]
    if support:
        return support[-1] if len(support) < 3 else support[1]
    if solid:
        return solid[-1]
    return free[0] if free else None


def conjoin(item: Item, nouns: list[Item], pending: list[Pending], clause: Clause, words: Sequence[Word]) -> None:
    """ "the cube and the cone": the second noun phrase stands beside the one that spaCy joins it to."""
    head = words[item.head].head
    partner = next((noun for noun in nouns if noun.start <= head < noun.stop), nouns[-1])
    if partner.noun in lx.PLACES and item.noun not in lx.PLACES:
        partner = last_thing(nouns)  # "the cube on the left and the cone": things stand beside things
    if partner.noun in lx.PLACES and item.noun not in lx.PLACES:
        clause.objects.append(item)  # "On the left, the red cone"
        nouns.append(item)
        return
    share_noun(partner, item)
    for place in reversed(pending):
        if any(child is partner for child in place.item.children):
            place.item.children.append(item)
            nouns.append(item)
            return
    clause.objects.append(item)
    nouns.append(item)
