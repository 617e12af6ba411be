"""What earlier and later sentences say of a noun phrase: pronouns, "those blocks", "the middle one", "It is ..."."""

from __future__ import annotations

import itertools
from collections.abc import Sequence
from dataclasses import replace

from dcg_torch.language.clauses import Clause, main_object
from dcg_torch.language.decisions import Decisions
from dcg_torch.language.items import END, Item, Kind
from dcg_torch.language.lexicon import CHOICES, NORMAL, NTH, PLACING, SETS, VERBS
from dcg_torch.names.rooms import room_named


def describe_later(noun: Item, own: Clause, clauses: Sequence[Clause]) -> None:
    """What other sentences say of the object, or of a landmark: "It is behind the cube.", "... The red one.",
    "The laptop on the desk. The desk near the door."."""
    for clause in clauses:
        if clause is own or clause.refused or not (clause.objects and clause.tells):
            continue
        there, more = exists(clause), clause.objects[0]
        if (landmark := named_again(clause, clauses)) is not None:
            landmark.take_up(more)
        elif there and about_it(more) and more.noun is not None and more.start > noun.start:
            noun.children.append(more.behind("with"))
        elif _the_same(noun, more) or (more.is_a("again") and (clause.statement or there or len(clause.objects) == 1)):
            beside = "other" in more.words or about_it(max(noun, more, key=lambda one: one.start))
            another = beside or (noun.plural and not more.plural) or None not in (more.color, noun.color)
            if more.text in SETS["stands_for"] or not another:
                noun.take_up(more)


def _the_same(one: Item, other: Item) -> bool:
    """ "(This is) a brown desk. The desk (is against the wall)": a thing is told of, and then named again."""
    first, then = sorted((one, other), key=lambda noun: noun.start)
    named = one.noun == other.noun is not None and not (one.plural or other.plural)
    alone = then.definite and then.text.split(" ", 1)[-1] == then.noun and not about_it(then)
    return named and alone and first.determined and not first.definite


def named_again(clause: Clause, clauses: Sequence[Clause]) -> Item | None:
    """The landmark before that a clause names again, and nothing else: "The laptop on the desk. The desk near ..."."""
    more = clause.objects[0] if len(clause.objects) == 1 and not clause.verb else END
    tops = [top for other in clauses[: clauses.index(clause)] for top in (*other.objects, *other.places)]
    below = [node for top in tops for child in top.children for node in child.walk()]
    same = [n for n in below if n.noun == more.noun is not None and (n.color in {None, more.color} or not more.color)]
    return same[-1] if same and more.definite and all(top.noun != more.noun for top in tops) else None


def list_places(clauses: Sequence[Clause]) -> None:
    """ "Dirty plate. Dining table.": names without articles, of which the first is by the others."""
    bare = [clause.objects[0] for clause in clauses if len(clause.objects) == 1 and not (clause.verb or clause.places)]
    if len({noun.noun for noun in bare if noun.is_a("listed")}) == len(clauses) > 1:
        bare.sort(key=lambda noun: room_named(noun.noun or "") is not None)  # "kitchen, mug": a mug
        bare[0].children += [noun.behind("near") for noun in bare[1:]]
        for clause in clauses:
            clause.objects = [noun for noun in clause.objects if noun is bare[0]]


def hang_fragments(clauses: Sequence[Clause]) -> None:
    """ "The red car... is there one? Yes, by the bridge.": a place by itself is where what was named before it is."""
    for k, (before, clause) in enumerate(itertools.pairwise(clauses)):
        if before.refused and clause.places and not (clause.refused or clause.verb or clause.objects):
            told = (main_object(other) for other in clauses[: k + 1] if other is before or other.verb is None)
            named = [noun for noun in told if noun is not None and noun.noun is not None]
            if named:  # also of a question: "Where is the cup? On the table."
                clause.objects, clause.places = [replace(named[-1], children=named[-1].children + clause.places)], []


def tells_of_neighbour(clause: Clause) -> bool:
    """ "Beside it (there) is a stand", "the stand is beside it": a clause that says what stands by what was named."""
    thing = clause.objects[0] if len(clause.objects) == 1 and clause.tells else END
    said = clause.statement and any(place.start > clause.statement.start for place in thing.children)
    return bool(thing.is_a("new") or said) and about_it(thing)


def exists(clause: Clause) -> bool:
    """A clause that says what is there: "There is a cone by the door", "beside it is a stand"."""
    return clause.tells and (clause.verb is not None or tells_of_neighbour(clause))


def about_it(noun: Item) -> bool:
    """ "(There is) a blue pillow next to it", "(a bin) to its left"."""
    return any(b.text.split(" ")[0] in SETS["stands_for"] | SETS["owners"] for c in noun.children for b in c.children)


def denied_later(noun: Item, later: Sequence[Clause]) -> bool:
    """ "We need a lid. Forget the lid.", "the cup. No, I don't need a cup": what a later clause denies by its name."""
    after = next((clause for clause in later if clause.verb or clause.objects or clause.places), Clause())
    if after.action in VERBS["shun"] and not after.places and any(one.is_a("back") for one in after.objects):
        return True  # "Take the lid. No, leave it."
    denied = (main_object(clause) for clause in later if clause.negated)
    return noun.noun is not None and any(one and one.noun == noun.noun and one.is_a("empty") for one in denied)


def by_mention(one: Item, clauses: Sequence[Clause]) -> None:
    """ "There is a lamp and a chair. Take the latter.": which of those that were named before, in their order."""
    named = sorted((n for n in _mentions(clauses) if n.start < one.start and n.is_a("mention")), key=lambda n: n.start)
    ranks = (*zip(NTH.values(), named, strict=False), *(("last", noun) for noun in named[-1:]))
    for noun in [noun for rank, noun in ranks if rank in one.words]:
        _take_over(one, noun)


def one_of_several(one: Item, clauses: Sequence[Clause], decisions: Decisions) -> None:
    """ "There are three cones ahead, go to the middle one", "in the row of cones, the last one"."""
    of = next((c for c in one.children if c.words == ("of",) and c.children[0].plural and c.children[0].noun), None)
    below = [node for child in one.children for node in child.children]
    named = [noun for noun in _mentions(clauses) if noun.noun and noun.start < one.start and noun not in below]
    if of is not None and one.noun is None and of.start < one.start:
        one.children.remove(of)  # "of the cubes, the one behind the box"
        named += of.children
    named = [noun for noun in named if one not in noun.walk()]
    several = [noun for noun in named if noun.plural or ("other" in one.words and not noun.is_a("someone"))]
    if not several and len(clauses) > 1 and all(clause.verb is None for clause in clauses):
        several = [noun for noun in map(main_object, clauses) if noun in named]  # "The sofa. The bigger one."
    if one.noun is None and not several and named and not any(_by_looks(one) and _may_be(one, n) for n in named):
        several = _one_and_another(clauses, about_it(one)) or _so_many_of(named[-1], one, clauses)
    several = [noun for noun in several if one.noun is None or _picks_from(one, noun)]  # "take the middle cone"
    if not several or (one.noun is not None and decisions.choose("picked", CHOICES["picked"]) != "of_those"):
        return
    whole = [noun for noun in several if noun.plural or "other" in one.words]
    tops = [noun for noun in several if not any(noun is not other and noun in other.walk() for other in whole)]
    top = max(tops, key=lambda noun: noun.start)  # "(two men) with hats", "yellow cup: the one left of it"
    group = replace(top, color=None, words=(), children=[]) if about_it(one) else top.copy()
    one.noun, one.color, one.pronoun = group.noun, one.color or group.color, False
    for place in [place for place in one.children if _picks(place)]:
        one.children.remove(place)
        one.words += _picks(place)
    if not (one.plural or group.is_a("grouped")):
        sized = not SETS["sizes"].isdisjoint(one.words)
        looks = [w for w in group.words if _describes(w) and not (sized and w in SETS["sizes"])]
        one.words = tuple(dict.fromkeys((*one.words, *looks, *[f"of {group.count}"] * ((group.count or 0) > 1))))
    one.children += [group.behind("in")] if group.is_a("grouped") else group.children


def _picks_from(one: Item, noun: Item) -> bool:
    """Whether a noun phrase picks one of several that were called the same before: "the middle cone"."""
    same = noun.plural and one.noun in {noun.noun, *SETS["anything"]} and one.color in (None, noun.color)
    picks = any(map(_picks, one.children)) or not all(map(_describes, one.words))
    return same and picks and one.definite and not one.plural


def _picks(place: Item) -> tuple[str, ...]:
    """ "(There are five cones,) the one in the middle" is the middle one, and that "at the left end" the leftmost."""
    at = place.children[0]
    most = [f"{word}most" for word in at.words if at.noun == "end" and word in SETS["sides"]]
    return ("middle",) if at.is_a("middle") else tuple(NORMAL.get(word, word) for word in most)


def _one_and_another(clauses: Sequence[Clause], near: bool) -> list[Item]:
    """ "There is a tall plant and a short one", "a tall plant. The short one by it": plants."""
    told = next((c.objects for c in clauses if c.objects[not near :] and (near or c.action in SETS["be"])), [])
    nouns = {noun.noun for noun in told if noun.noun is not None}
    alike = len(nouns) == 1 and not any(noun.definite for noun in told)
    return [replace(told[0], noun=nouns.pop(), color=None, words=(), plural=True, children=[])] if alike else []


def _so_many_of(named: Item, one: Item, clauses: Sequence[Clause]) -> list[Item]:
    """ "The cup. There are two of them.": two cups."""
    counts = [noun.count for noun in _mentions(clauses) if noun.noun is None and named.start < noun.start < one.start]
    return [replace(named, count=count, plural=True) for count in counts if (count or 0) > 1][:1]


def _describes(word: str) -> bool:
    """Does a word tell of each of several, and neither counts nor picks?"""
    counts = SETS["ordinals"] | SETS["quantifiers"] | SETS["others"] | SETS["pairs"] | SETS["sides"] | SETS["groups"]
    return word.isalpha() and word not in counts and not word.endswith(("est", "most"))


def refer(target: Item, own: Clause, clauses: Sequence[Clause], decisions: Decisions) -> None:
    """Give the landmarks of an object that name again what an earlier sentence named ("it", "that one", "those
    blocks", "this group") all that was said of it there."""
    before = clauses[: clauses.index(own)]
    asked = [noun for clause in before if clause.refused and (noun := main_object(clause)) is not None]
    main = [noun for clause in before for noun in clause.objects if noun.noun not in SETS["directions"]]
    # What a sentence is about is rather meant again than what it only places that by.
    earlier = [noun for clause in reversed(before) for noun in _mentions([clause]) if noun not in main] + main
    nodes = [(node, node.start) for node in target.walk()]
    for node, start in nodes:
        if node.kind is not Kind.NOUN or not _names_again(node):
            continue
        # "Is the mug clean? I'll take that one."
        mentions = asked if node is target and node.pronoun and not _by_looks(node) else earlier
        vague = node.noun in {None, *SETS["groups"], *SETS["anything"]}
        named = [noun for noun in reversed(mentions) if noun.start < start and _may_be(node, noun)]
        named = [noun for noun in named if node not in noun.walk() and (vague or not noun.is_a("empty"))]
        if named:
            options = {f"mention {k}": -CHOICES["mention_step"] * k for k in range(len(named))}
            meant = named[int(decisions.choose("mention", options).split()[1])]
            _take_over(node, meant)
            nodes += [(below, meant.start) for child in node.children for below in child.walk()]
        elif node.text == "it" and node.noun is None and "other" in target.words:  # "the other cup, behind it"
            node.noun, node.color, node.pronoun = target.noun, target.color, False
        elif node is target and _by_looks(node):  # "The blue cup is broken, take the red one"
            node.noun = next((noun.noun for noun in reversed(main) if noun.noun and not noun.plural), None)


def arrive(target: Item, own: Clause, clauses: Sequence[Clause], decisions: Decisions) -> list[Item]:
    """ "Walk to the sink. Pick up the cup.": what is handled is where the way leads, if nothing says where it is.

    "Turn to the sofa and take the plant on your left": what is faced is returned, for sides are as seen then.
    """
    apart = SETS["directions"] | SETS["someone"]
    below = [node for child in target.children for node in child.children]
    sides = [node for node in below if node.is_a("left_right") and "my" not in node.words]
    goal: Item | None = None
    turned = False
    led_by = VERBS["go"] | VERBS["look"] if own.action in VERBS["take"] else frozenset()
    for clause in clauses[: clauses.index(own)]:
        if clause.refused or clause.negated or (clause.verb or END).late or clause.action not in led_by:
            continue
        led = [place.children[0] for place in clause.places if place.name in PLACING["goals"] - PLACING["away"]]
        named = [noun for noun in (main_object(clause), *led) if noun is not None and noun.noun not in apart]
        goal = next((noun for noun in named if noun.noun and not noun.plural), goal)
        turned = clause.action in VERBS["turn"] if goal in named else turned
    if goal is None:
        return []
    facing = [goal.copy().behind("facing")] if turned and sides else []
    for side in sides if turned else ():
        side.words = tuple(word for word in side.words if word not in SETS["owned"])
    told = [node for child in target.children if child.name not in PLACING["extremes"] for node in child.children]
    placed = any(node.noun not in SETS["places"] | apart for node in told)
    if not placed and decisions.choose("route", CHOICES["route"]) == "there":
        target.children.append(goal.copy().behind("near"))
    return facing


def _mentions(clauses: Sequence[Clause]) -> list[Item]:
    """The noun phrases of clauses."""
    tops = [top for clause in clauses for top in (*clause.objects, *clause.places)]
    return [node for top in tops for node in top.walk() if node.kind is Kind.NOUN]


def _names_again(node: Item) -> bool:
    first = node.text.split(" ")[0]
    if node.pronoun and node.noun is None:
        return _by_looks(node) or (node.is_a("empty") and first in SETS["stands_for"] | SETS["demonstratives"])
    return first in SETS["demonstratives"] or (first == "the" and node.is_a("empty") and not node.count)


def _by_looks(node: Item) -> bool:
    """ "(There is a big dot with a tiny gray one to its left.) The gray one"."""
    return node.definite and not (node.noun or node.plural or node.children or node.is_a("empty"))


def _may_be(node: Item, noun: Item) -> bool:
    """Whether a noun phrase may be what another names again."""
    if _by_looks(node):
        return not noun.plural and {node.color, *node.words} <= {None, noun.color, *noun.words}
    if (noun.is_a("empty") if noun.pronoun else noun.noun is None) or noun.is_a("somewhere"):  # but "a big one"
        return False
    if node.noun is None or node.noun in SETS["groups"]:
        return noun.plural if node.noun else node.color in (None, noun.color)
    one, other = f" {node.noun}", f" {noun.noun}"  # "my tape", "the measuring tape"
    same = node.noun in SETS["anything"] or one.endswith(other) or other.endswith(one)
    return same and node.color in (None, noun.color) and node.plural == noun.plural


def _take_over(node: Item, noun: Item) -> None:
    grouped = node.noun in SETS["groups"] and not noun.is_a("grouped")
    group = (node.noun, *((f"of {noun.count}",) if noun.count else ())) if grouped else ()
    node.noun = node.noun if f" {node.noun}".endswith(f" {noun.noun}") else noun.noun
    node.color, node.plural, node.count = noun.color, noun.plural, None if grouped else noun.count
    node.words, node.pronoun = tuple(dict.fromkeys((*noun.words, *filter(None, group)))), False
    node.children = node.children or [child.copy() for child in noun.children]
