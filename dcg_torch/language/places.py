"""Prepositional phrases -> what they belong to: a noun phrase that they describe, or the verb; and conjuncts.

Whether a prepositional phrase tells the object apart or says where it goes depends on what the verb needs ("place the
red pyramid on the green cube on the blue cube"), so `settle` decides by the verb, and leaves a choice to the readings
where the other way is possible.
"""

from __future__ import annotations

import itertools

from dcg_torch.language.clauses import Clause, main_object
from dcg_torch.language.decisions import Decisions
from dcg_torch.language.items import Item, Kind, last_thing, share_noun
from dcg_torch.language.lexicon import CHOICES, PLACING, SETS, VERBS
from dcg_torch.names.noun_similarity import is_akin

_MOST_SUPPORTS = 3  # "on A on B on C": the second says where it goes


def settle(clause: Clause, pending: list[Item], supplied: bool, decisions: Decisions) -> None:
    """Give each prepositional phrase its parent."""
    pending = _sought(clause, pending)
    for place, after in itertools.pairwise(pending):
        if after.beside and not place.children and place.name not in PLACING["extremes"]:
            place.children = [child.copy() for child in after.children]  # "above and touching the cone"
    full = [place for place in pending if place.children]
    target = main_object(clause)
    goal = _goal(clause, full, supplied, decisions)
    last: Item | None = None
    for place in pending:
        if not place.children:
            if place.before:
                place.before[-1].words += _bare(place)
            continue
        if place.name == "for" and place.children[0].is_a("someone"):
            continue  # "find it for me" says nothing of the thing
        owner: Item | None = None
        if place is not goal and place.before:
            apart = place.forced or (target is None and place.name in PLACING["ways"])
            if place.beside and last is not None and not apart:
                owner = last
            elif not _belongs_to_verb(place, clause, target, full):
                owner = _nearest(place, decisions)
        if clause.verb is None and not place.before and place.name not in PLACING["frames"]:
            owner = target  # "in the top row the red one"
        if owner is None:
            clause.places.append(place)
        elif not _compound(owner, place, decisions):
            _below(owner, place)
        last = owner
    if clause.verb is None and (target is None or (target.is_a("spot") and not target.children)):
        _unnamed(clause)


def _bare(place: Item) -> tuple[str, ...]:
    """What a preposition without a noun phrase says of the one before it."""
    if place.name in PLACING["mutual"] and place.before[-1].plural:
        return place.name, "each other"  # "the two cubes touching"
    farthest = (place.name.split()[0],) if place.name in PLACING["extremes"] else ()  # "the one farthest away"
    return place.words if place.name in PLACING["bare"] else farthest


def _sought(clause: Clause, pending: list[Item]) -> list[Item]:
    """Make what is looked for the object of "search the room for the cone", "look in the corner for the cone"."""
    sought = next((place for place in pending if place.name == "for" and place.children), None)
    if clause.action not in VERBS["seek"] or sought is None or sought.children[0].is_a("someone"):
        return pending
    thing = sought.children[0]
    thing.children += [room.behind("in") for room in clause.objects]
    clause.objects = [thing]
    others = [place for place in pending if place is not sought]
    for place in others:
        place.before = place.before or [thing]
    return others


def _compound(owner: Item, place: Item, decisions: Decisions) -> bool:
    """Whether "a pallet of tires" is read as a tire pallet; then it has become one."""
    child = place.children[0]
    named = place.words == ("of",) and owner.stop == place.start and len(place.children) == 1
    named = named and child.is_a("bare_name") and owner.is_a("named")
    if not named or decisions.choose("of", CHOICES["of"]) != "compound":
        return False
    owner.noun, owner.stop = f"{child.noun} {owner.noun}", child.stop
    return True


def _goal(clause: Clause, full: list[Item], supplied: bool, decisions: Decisions) -> Item | None:
    """The prepositional phrase that says where the object is to go, if any does."""
    # "Bring me the cup on the table" needs no other goal.
    if supplied or main_object(clause) is None or any(noun.noun == "me" for noun in clause.objects):
        return None
    if clause.acting:
        return next((place for place in full if place.start >= clause.verb.start), None) if clause.verb else None
    if clause.action in VERBS["put"]:
        goal = _destination(full)
        sure = goal is None or goal.name in PLACING["sure"]
        rule = "goal_of_bringing" if clause.action in VERBS["bring"] and not clause.objects[0].is_a("back") else "goal"
        return goal if sure or decisions.choose(rule, CHOICES[rule]) == "destination" else None
    strong = (place for place in full if place.name in PLACING["strong"] and not (place.forced or _about_noun(place)))
    return next(strong, None) if clause.action in VERBS["take"] | VERBS["go"] else None


def _belongs_to_verb(place: Item, clause: Clause, target: Item | None, full: list[Item]) -> bool:
    """Whether a phrase after a noun phrase still says where the motion goes."""
    if clause.verb is None or place.forced:
        return False
    if target is not None:  # "the top box moves left and ...", "move the cube down and to the left"
        moved = clause.acting and place.before[-1].start < clause.verb.start <= place.start
        sideways = place.name in PLACING["toward"] and place.children[0].is_a("sided_place")
        return moved or (sideways and place.beside and clause.action in VERBS["put"])
    goals = any(other.name in PLACING["goals"] for other in full[: full.index(place)])
    return (place.name in PLACING["ways"] and not _about_noun(place)) or not goals


def _unnamed(clause: Clause) -> None:
    """ "closest to me", "in the corner", "my left", "top left corner": of the thing only the place is said."""
    telling = PLACING["extremes"] | PLACING["between"]
    places = [p for p in clause.places if p.name in telling or p.children[0].is_a("somewhere")]
    told = (side for side in clause.objects if side.is_a("side") and side.is_a("told_side"))
    places += [side.behind("in" if side.is_a("middle") else "on") for side in told]
    places += [spot.behind("in") for spot in clause.objects if spot.is_a("spot") and not spot.is_a("side")]
    if places:
        clause.places = [place for place in clause.places if place not in places]
        clause.objects = [Item(Kind.NOUN, places[0].start, places[0].start, "", pronoun=True, children=places)]


def _about_noun(place: Item) -> bool:
    """ "the cone to your left", "the cube to the right": to a side is where a thing is."""
    return place.name == "to" and place.children[0].is_a("sided_place") and bool(place.before)


def _below(owner: Item, place: Item) -> None:
    child = place.children[0]
    if place.words == ("of",) and child.is_a("pronoun") and not owner.pronoun:
        owner.children += child.children  # "the bigger cube of the two (on the table)"
        child.children = owner.children
        return
    if place.name in PLACING["sided"] and child.is_a("left_right"):
        place.words = ("on",)
    elif place.words == ("towards",) and child.is_a("place"):
        place.words = ("in",)
    owner.children.append(place)


def _nearest(place: Item, decisions: Decisions) -> Item:
    """The noun phrase just before, passing over "me", "you" and sides, which nobody describes further."""
    candidates = [noun for noun in place.before if not noun.is_a("apart")] or place.before
    last = candidates[-1]
    if place.name == "of":
        return last
    if place.name == "except":
        return next((noun for noun in reversed(candidates) if noun.is_a("all") or noun.plural), last)
    solid = [noun for noun in candidates if not noun.is_a("not_solid")] or candidates
    table = last.noun in SETS["tables"] and last.text.split(" ")[0] not in SETS["demonstratives"]
    if (table or last.noun in SETS["groups"]) and last is not solid[-1]:  # "the cube above the tower on the left"
        rule = "group_extreme" if place.name in PLACING["extremes"] and not table else "group_owner"
        return last if decisions.choose(rule, CHOICES[rule]) == "group" else solid[-1]
    far = len(solid) > 1 and solid[0].children + solid[-1].children != []
    return solid[0] if far and decisions.choose("owner", CHOICES["owner"]) == "far" else solid[-1]


def _destination(places: list[Item]) -> Item | None:
    """Which phrase says where the object goes: a sure goal, else the last that does not only place a landmark."""
    free = [place for place in places if not (place.forced or place.name in PLACING["no_goals"])]
    free = [place for place in free if not place.text.startswith(("from", "off", "out"))]
    # Each list is a stronger sign than the next: "to ...", "on a thing", "next to a thing", "in the corner".
    sure = [place for place in free if {place.text.split()[0], place.name} & PLACING["sure"]]
    solid = [place for place in free if place.children[0].noun not in SETS["places"] - SETS["hand"]]
    support = [place for place in solid if place.name in PLACING["supports"]]
    last = support[1:2] if len(support) >= _MOST_SUPPORTS else support[-1:] or solid[-1:]
    return next(iter([*sure[:1], *last, *free]), None)


def conjoin(item: Item, nouns: list[Item], pending: list[Item], clause: Clause, joint: str) -> None:
    """ "the cube and the cone": the second noun phrase stands beside one before it."""
    one = item.pronoun and clause.action in SETS["be"]  # "a cube near you and one near me"
    apart = nouns[-1].is_a("somewhere" if one else "place") and not item.is_a("place")
    # But "(the mug on) the table or the desk".
    apart = apart and not (joint and is_akin(item.noun, nouns[-1].noun, last_thing(nouns).noun))
    partner = last_thing(nouns) if apart else nouns[-1]  # "the cube on the left and the cone"
    beside = clause.objects
    whole = () if item.determined else tuple(SETS["whole"].intersection(partner.words))  # "every bowl or apple"
    item.words, item.plural = (*item.words, *(whole or ("or",) * (joint == "or"))), item.plural or whole != ()
    if not (apart and partner.is_a("place")):  # but "On the left, the red cone"
        share_noun(partner, item)
        beside = next((of.children for of in reversed(pending) if any(one is partner for one in of.children)), beside)
    beside.append(item)
    nouns.append(item)
