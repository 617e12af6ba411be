"""Prepositional phrases -> what they belong to: a noun phrase that they describe, or the verb; and conjuncts.

Whether a prepositional phrase tells the object apart or says where it goes depends on what the verb needs ("place the
red pyramid on the green cube on the blue cube"), so `settle` decides by the verb, and leaves a choice to the readings
where the other way is possible.
"""

from __future__ import annotations

import itertools
from dataclasses import dataclass

from dcg_torch.language.clauses import Clause, main_object
from dcg_torch.language.decisions import Decisions
from dcg_torch.language.items import Item, Kind
from dcg_torch.language.lexicon import CHOICES, PLACING, SETS, VERBS
from dcg_torch.language.predicates import is_side, last_thing, share_noun

_MOST_SUPPORTS = 3  # "on A on B on C": the second says where it goes


@dataclass(slots=True, eq=False)
class Pending:
    """A prepositional phrase and what stands before it."""

    item: Item
    nouns: list[Item]
    forced: bool  # follows a relative pronoun or a participle: it can only tell a noun phrase apart
    joined: bool  # follows "and" or a comma

    @property
    def name(self) -> str:
        """The preposition in its normal form."""
        return self.item.words[0]


def settle(clause: Clause, pending: list[Pending], supplied: bool, decisions: Decisions) -> None:
    """Give each prepositional phrase its parent."""
    pending = _sought(clause, pending)
    for place, after in itertools.pairwise(pending):
        if after.joined and not place.item.children and place.name not in PLACING["extremes"]:
            place.item.children = [child.copy() for child in after.item.children]  # "above and touching the cone"
    full = [place for place in pending if place.item.children]
    target = main_object(clause)
    goal = _goal(clause, full, target, supplied, decisions)
    last: Item | None = None
    for place in pending:
        if not place.item.children:
            if place.nouns and place.name in PLACING["mutual"] and place.nouns[-1].plural:
                place.nouns[-1].words += (place.name, "each other")  # "the two cubes touching"
            elif place.nouns and place.name in PLACING["bare"]:
                place.nouns[-1].words += place.item.words
            elif place.nouns and place.name in PLACING["extremes"]:
                place.nouns[-1].words += (place.name.split()[0],)  # "the one farthest away"
            continue
        if place.name == "for" and place.item.children[0].noun in SETS["someone"]:
            continue  # "find it for me" says nothing of the thing
        owner: Item | None
        if place is goal or not place.nouns:
            owner = None
        elif place.joined and last is not None and not place.forced and not (target is None and _is_path(place)):
            owner = last
        elif _belongs_to_verb(place, clause, target, full):
            owner = None
        else:
            owner = _nearest(place, decisions)
        if owner is None:
            clause.places.append(place.item)
        elif not _compound(owner, place, decisions):
            _below(owner, place.item)
        last = owner
    if clause.verb is None and (target is None or (target.noun in SETS["spots"] and not target.children)):
        _unnamed(clause)


def _sought(clause: Clause, pending: list[Pending]) -> list[Pending]:
    """Make what is looked for the object of "search the room for the cone", "look in the corner for the cone"."""
    sought = next((place for place in pending if place.name == "for" and place.item.children), None)
    if clause.action not in VERBS["seek"] or sought is None or sought.item.children[0].noun in SETS["someone"]:
        return pending
    thing, rooms = sought.item.children[0], clause.objects
    clause.objects = [thing]
    for room in rooms:
        thing.children.append(Item(Kind.PREPOSITION, room.start, room.start, "in", ("in",), children=[room]))
    others = [place for place in pending if place is not sought]
    for place in others:
        place.nouns = place.nouns or [thing]
    return others


def _compound(owner: Item, place: Pending, decisions: Decisions) -> bool:
    """Whether "a pallet of tires" is read as a tire pallet; then it has become one."""
    child = place.item.children[0]
    named = place.item.words == ("of",) and owner.stop == place.item.start and len(place.item.children) == 1
    plain = child.noun is not None and not (child.determined or child.color or child.children or child.pronoun)
    apart = SETS["places"] | SETS["aspects"] | SETS["someone"] | SETS["sides"] | SETS["anything"] | SETS["groups"]
    if not (named and plain) or owner.noun is None or not apart.isdisjoint((owner.noun, child.noun or "")):
        return False
    if decisions.choose("of", CHOICES["of"]) != "compound":
        return False
    owner.noun, owner.stop = f"{child.noun} {owner.noun}", child.stop
    return True


def _goal(
    clause: Clause, full: list[Pending], target: Item | None, supplied: bool, decisions: Decisions
) -> Pending | None:
    """The prepositional phrase that says where the object is to go, if any does."""
    supplied = supplied or any(noun.noun == "me" for noun in clause.objects)  # "bring me the cup on the table"
    if target is None or supplied:
        return None
    if clause.acting:
        return next((place for place in full if place.item.start >= clause.verb.start), None) if clause.verb else None
    if clause.action in VERBS["put"]:
        goal = _destination(full)
        if goal is None or goal.name in PLACING["sure"]:
            return goal
        kept = decisions.choose("goal", CHOICES["goal"]) == "destination"
        return goal if kept else None
    if clause.action in VERBS["take"] | VERBS["go"]:
        strong = (place for place in full if place.name in PLACING["strong"] and not place.forced)
        return next((place for place in strong if not _about_noun(place)), None)
    return None


def _is_path(place: Pending) -> bool:
    return place.name in PLACING["strong"] | PLACING["paths"] - PLACING["no_paths"]


def _belongs_to_verb(place: Pending, clause: Clause, target: Item | None, full: list[Pending]) -> bool:
    """Whether a phrase after a noun phrase still says where the motion goes."""
    if target is not None or clause.verb is None or place.forced:
        return False
    goals = any(other.name in PLACING["goals"] for other in full[: full.index(place)])
    return (_is_path(place) and not _about_noun(place)) or not goals or clause.action in VERBS["look"]


def _unnamed(clause: Clause) -> None:
    """ "closest to me", "in the corner", "my left", "top left corner": of the thing only the place is said."""
    somewhere = SETS["places"] | SETS["someone"]
    telling = PLACING["extremes"] | PLACING["between"]
    places = [p for p in clause.places if p.words[0] in telling or p.children[0].noun in somewhere]
    places += [
        Item(Kind.PREPOSITION, side.start, side.stop, side.text, ("on" if is_side(side) else "in",), children=[side])
        for side in clause.objects
        if (is_side(side) and (side.determined or side.words)) or (side.noun in SETS["spots"] and not is_side(side))
    ]
    if places:
        first = places[0]
        clause.places = [place for place in clause.places if place not in places]
        clause.objects = [Item(Kind.NOUN, first.start, first.start, "", pronoun=True, children=places)]


def _about_noun(place: Pending) -> bool:
    """ "the cone to your left", "the cube to the right": to a side is where a thing is."""
    return place.name == "to" and place.item.children[0].noun in SETS["about_sides"] and bool(place.nouns)


def _below(owner: Item, place: Item) -> None:
    child = place.children[0]
    if place.words == ("of",) and child.pronoun and not (child.color or child.children or owner.pronoun):
        return  # "the bigger cube of the two"
    if place.words[0] in PLACING["sided"] and child.noun in SETS["left_right"]:
        place.words = ("on",)
    elif place.words == ("towards",) and child.noun in SETS["places"]:
        place.words = ("in",)
    owner.children.append(place)


def _nearest(place: Pending, decisions: Decisions) -> Item:
    """The noun phrase just before, passing over "me", "you" and sides, which nobody describes further."""
    apart = SETS["someone"] | SETS["measures"] | SETS["robot"]
    candidates = [noun for noun in place.nouns if noun.noun not in apart] or place.nouns
    if place.name == "of":
        return candidates[-1]
    solid = [noun for noun in candidates if noun.noun not in SETS["places"] | SETS["groups"]] or candidates
    if len(solid) > 1 and solid[0].children + solid[-1].children != []:
        far = decisions.choose("owner", CHOICES["owner"]) == "far"
        return solid[0] if far else solid[-1]
    return solid[-1]


def _destination(places: list[Pending]) -> Pending | None:
    """Which phrase says where the object goes: a sure goal, else the last that does not only place a landmark."""
    free = [
        place
        for place in places
        if not (place.forced or place.name in PLACING["no_goals"] or place.item.text.startswith(("from", "off", "out")))
    ]
    # Each list is a stronger sign than the next: "to ...", "on a thing", "next to a thing", "in the corner".
    sure = [place for place in free if {place.item.text.split()[0], place.name} & PLACING["sure"]]
    solid = [place for place in free if place.item.children[0].noun not in SETS["places"] - SETS["hand"]]
    support = [place for place in solid if place.name in PLACING["supports"]]
    if sure:
        return sure[0]
    if support:
        return support[-1] if len(support) < _MOST_SUPPORTS else support[1]
    if solid:
        return solid[-1]
    return free[0] if free else None


def conjoin(item: Item, nouns: list[Item], pending: list[Pending], clause: Clause) -> None:
    """ "the cube and the cone": the second noun phrase stands beside one before it."""
    partner = nouns[-1]
    if partner.noun in SETS["places"] and item.noun not in SETS["places"]:
        partner = last_thing(nouns)  # "the cube on the left and the cone": things stand beside things
    if partner.noun in SETS["places"] and item.noun not in SETS["places"]:
        clause.objects.append(item)  # "On the left, the red cone"
        nouns.append(item)
        return
    share_noun(partner, item)
    item.words += ("no",) if item.negative else ()  # "(with) a tie and no beard"
    for place in reversed(pending):
        if any(child is partner for child in place.item.children):
            place.item.children.append(item)
            nouns.append(item)
            return
    clause.objects.append(item)
    nouns.append(item)
