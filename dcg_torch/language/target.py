"""Clauses -> the tree of the one that names the object meant."""

from __future__ import annotations

import itertools
from collections.abc import Sequence
from typing import NamedTuple

from dcg_torch.language import references
from dcg_torch.language.clauses import Clause, main_object
from dcg_torch.language.decisions import Decisions
from dcg_torch.language.items import END, Item
from dcg_torch.language.lexicon import CHOICES, PLACING, SETS, TARGETS, VERBS
from dcg_torch.types import ParseTree, Phrase, PhraseKind


class Mention(NamedTuple):
    """A noun phrase that may be the one meant, the clause it is in, and how surely the verb is about it."""

    noun: Item
    clause: Clause
    score: float
    place: Item | None = None  # the prepositional phrase it stands in


def choices(clauses: Sequence[Clause]) -> list[Mention]:
    """Every noun phrase that some clause is about, in the order of the command."""
    found: list[Mention] = []
    for n, clause in enumerate(clauses):
        if clause.refused is not None:
            continue
        target = main_object(clause)
        clause.negated |= target is not None and references.denied_later(target, clauses[n + 1 :])
        penalty = TARGETS["negated"] * clause.negated + TARGETS["late"] * (clause.verb or END).late
        if target is not None:
            found.append(Mention(target, clause, _object_score(target, clause, clauses, found) + penalty))
            if clause.acting or clause.action in VERBS["put"] | VERBS["take"]:
                continue
        for place in clause.places:
            if not place.children[0].is_a("no_goal"):
                score = _place_score(place.name, clause.action, target is not None)
                found.append(Mention(place.children[0], clause, score + penalty, place))
    return found


def _object_score(target: Item, clause: Clause, clauses: Sequence[Clause], found: Sequence[Mention]) -> float:
    verb, told = clause.action, references.exists(clause)
    if clause.acting or (verb and not (told or clause.statement)):
        does = (name for name in CHOICES["target_verbs"].split() if verb in VERBS[name])
        return TARGETS["acting" if clause.acting else next(does, "handled" if target.is_a("named") else "other")]
    again = references.named_again(clause, clauses) is not None
    if target.is_a("singled_out") and (target.noun or any(m.noun.plural for m in found)) and not again:
        # "Until you see the window, then it is the plant next to it", or "Is the oven off? The stove by the sink."
        before = (noun for other in clauses for noun in other.objects if noun.text in SETS["stands_for"])
        if clause.verb is not None and any(noun.stop == clause.verb.start for noun in before):
            return TARGETS["identified"]
        last = clause.verb is None and clause is clauses[-1] and clause.sentence > clauses[0].sentence
        if last and not (told and all(other.tells for other in clauses)):
            return TARGETS["named_last"]
    # "The mirror above the sink, there are other mirrors", "there is another one", "beside it is a stand".
    more = any(m.noun.noun == target.noun and m.noun.definite > m.noun.plural for m in found) and target.plural
    another = again or (told and (more or "other" in target.words or references.about_it(target)))
    return TARGETS["another" if another else "statement"]


def _place_score(name: str, verb: str, beside_object: bool) -> float:
    kinds = (kind for kind in CHOICES["target_places"].split() if name in PLACING[kind])
    score = next((TARGETS[f"{kind}_place"] for kind in kinds), TARGETS["place"])
    return min(score, TARGETS["beside_object"]) if verb in VERBS["look"] or beside_object else score


def root(clauses: Sequence[Clause], decisions: Decisions) -> ParseTree | None:
    """The tree of the clause that names the object meant, or None if none does.

    An object to be handled is the first one named, the goal of a drive the last ("go past the cube to the cone").
    "it" stands for the noun phrase before, and "the middle one" for one of several that were named before.
    """
    references.list_places(clauses)
    references.hang_fragments(clauses)
    found = choices(clauses)
    if not found:
        return None
    chosen = _resolved(_choose(found, decisions), found)
    verb, places = chosen.clause.verb, chosen.clause.places
    if chosen.place is not None:
        children = [chosen.place, *(place for place in places if place is not chosen.place)]
    else:
        children = [chosen.noun, *_beside(chosen), *(places or _later_destination(chosen, clauses))]
        chosen.noun.children += _listed(chosen)
    # "Facing the bed, take the lamp on your left".
    others = (place for clause in clauses for place in clause.places if place.name in PLACING["frames"])
    children += [place for place in others if place not in children]
    for node in [node for node in chosen.noun.walk() if "mentioned" in node.words]:
        references.by_mention(node, clauses)
    references.describe_later(chosen.noun, chosen.clause, clauses)
    for one in [node for node in chosen.noun.walk() if node is chosen.noun or node.is_a("unnamed")]:
        references.one_of_several(one, clauses, decisions)
    references.refer(chosen.noun, chosen.clause, clauses, decisions)
    children += references.arrive(chosen.noun, chosen.clause, clauses, decisions)
    words = (*verb.words, *(("not",) if chosen.clause.negated else ())) if verb else ()
    said = verb or chosen.clause.statement  # "are" of "the scissors are in the drawer" tells, and is no action
    return ParseTree(Phrase(PhraseKind.VERB, said.text if said else "", words), tuple(map(freeze, children)))


def _choose(found: list[Mention], decisions: Decisions) -> Mention:
    best = max(choice.score for choice in found)
    top = [k for k, choice in enumerate(found) if choice.score == best]
    first = top[0] if best >= TARGETS["take"] else top[-1]
    options = {f"likeliest {first}": 0.0}
    goals = [choice for choice in found if _relation(choice, found[first]) == "earlier_goal"]
    # "Go to the table and take the cup on it", "go to the table, then take the cup", "enter the hall, go to the ..."
    parted = references.about_it(found[first].noun) or found[first].clause.apart
    leads = goals[:1] if not parted and all(goal.clause is goals[0].clause for goal in goals) else []
    for k, choice in enumerate(found):
        if k != first and not choice.noun.pronoun:
            step = CHOICES["target_step"] * (choice.score - best - 1.0)
            options[f"{_relation(choice, found[first])} {k}"] = CHOICES["first_order"] if choice in leads else step
    return found[int(decisions.choose("target", options).split()[1])]


def _relation(other: Mention, chosen: Mention) -> str:
    """How another mention stands to the likeliest one; readings are weighed by it."""
    one, two = other.clause, chosen.clause
    if one is two:
        return "beside_it"
    order = "earlier" if (one.sentence, other.noun.start) < (two.sentence, chosen.noun.start) else "later"
    if one.sentence != two.sentence:
        return f"{order}_sentence"
    reached = one.action in VERBS["go" if other.place else "arrive"]
    if not reached or (other.place and other.place.name not in PLACING["toward"]):
        return f"{order}_clause"
    return f"{order}_goal" if chosen.score >= TARGETS["take"] else f"{order}_way"


def _resolved(chosen: Mention, found: list[Mention]) -> Mention:
    """ "Find the cone and approach it": the noun phrase that a pronoun stands for."""
    noun = chosen.noun
    if noun.pronoun and (noun.is_a("empty") or noun.text in SETS["stands_for"]):
        before = [m for m in found[: found.index(chosen)] if m.noun.noun or m.noun.text not in SETS["stands_for"]]
        earlier = [choice for choice in before if not (choice.noun.pronoun and choice.noun.is_a("empty"))]
        last = earlier[-1] if earlier and chosen.place is None else chosen
        # What begins the sentence: "Start at the church. The tree closest to it, mark that."
        fronted = last.clause.verb is last.place is None and last.clause.sentence == chosen.clause.sentence
        handled = [choice for choice in earlier if choice.place is None and choice.score > TARGETS["shun"]]
        beside = earlier and not chosen.clause.tells and references.tells_of_neighbour(earlier[-1].clause)
        if handled and chosen.place is None and not (fronted or beside):
            return handled[-1]
        if beside:
            return earlier[-1]  # "Go to the shelf. On it there is a statue. Bring it."
        if earlier:
            meant = last if fronted else max(earlier, key=lambda choice: (choice.score, found.index(choice)))
            if meant.place or chosen.place or chosen.score <= TARGETS["shun"]:
                return meant
            objects = chosen.clause.objects  # "there was a cup. take it": it is to be taken
            objects[objects.index(noun)] = meant.noun
            return Mention(meant.noun, chosen.clause, chosen.score)
        # "Bring it to me. The mug."
        return next((one for one in found[found.index(chosen) :] if not (one.noun.pronoun or one.clause.verb)), chosen)
    return chosen


def _beside(chosen: Mention) -> list[Item]:
    """The noun phrases that are meant beside the chosen one."""
    objects = chosen.clause.objects
    later = objects[objects.index(chosen.noun) + 1 :]
    later = later[: max((k + 1 for k, noun in enumerate(later) if noun.beside), default=0)]
    return [n for n in later if (n.is_a("color_word") or not n.pronoun) and not n.is_a("direction")]


def _listed(chosen: Mention) -> list[Item]:
    """ "Bald man, glasses": what a list without a verb names behind its first noun phrase, that has."""
    if chosen.clause.verb is not None:
        return []
    objects, beside = chosen.clause.objects, _beside(chosen)
    pairs = itertools.pairwise(objects[objects.index(chosen.noun) :])
    later = [noun for before, noun in pairs if before.stop < noun.start]
    listed = [n for n in later if n.is_a("named") and n not in beside and not (n.definite or n.is_a("apart"))]
    return [noun.behind("without" if noun.negative else "with") for noun in listed]


def _later_destination(chosen: Mention, clauses: Sequence[Clause]) -> list[Item]:
    """ "pick up the cube and put it on the block": where a later clause puts "it"."""
    puts = (clause for clause in clauses[clauses.index(chosen.clause) + 1 :] if clause.action in VERBS["put"])
    return next((put.places for put in puts if put.places and all(noun.pronoun for noun in put.objects)), [])


def freeze(item: Item) -> ParseTree:
    """An item and what hangs on it as values."""
    words = tuple(dict.fromkeys(item.words))
    phrase = Phrase(PhraseKind[item.kind.name], item.text, words, item.noun, item.color, item.plural, item.count)
    return ParseTree(phrase, tuple(map(freeze, item.children)))
