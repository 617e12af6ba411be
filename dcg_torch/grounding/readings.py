"""Several readings of one command, in the frames of reference that it may have: the factor graph sums over them."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from dcg_torch.grounding.encoding import WorldEncoder
from dcg_torch.grounding.exceptions import split_exceptions, without
from dcg_torch.grounding.frames import as_viewed
from dcg_torch.grounding.search import Search
from dcg_torch.grounding.solution import Solution
from dcg_torch.grounding.tables import Tables
from dcg_torch.grounding.thing_values import ByThing
from dcg_torch.interpretation.anaphora import refer_back
from dcg_torch.interpretation.appearance_words import Looks, with_appearance_words
from dcg_torch.interpretation.attributes import by_attributes
from dcg_torch.interpretation.containers import in_what_holds_it
from dcg_torch.interpretation.factor_tree import (
    Setting,
    coordinated,
    in_setting,
    offers_choice,
    path_to_object,
    setting_of,
    speaks_of,
)
from dcg_torch.interpretation.grids import by_cells, with_cells
from dcg_torch.interpretation.informativeness import needless
from dcg_torch.interpretation.parser_protocol import ReadCommand, WeightedReading, Words
from dcg_torch.interpretation.plain_places import of_two_sides
from dcg_torch.interpretation.room_parts import with_corners
from dcg_torch.interpretation.rooms import (
    leads_to_a_room,
    led_into_rooms,
    speaks_of_what_is_not_there,
    with_rooms,
)
from dcg_torch.interpretation.scene_kinds import is_close_by
from dcg_torch.interpretation.scene_rewrites import in_scene_words
from dcg_torch.interpretation.shelves import with_tiers
from dcg_torch.interpretation.stacks import with_levels
from dcg_torch.interpretation.walls import with_walls
from dcg_torch.interpretation.ways import led_along
from dcg_torch.names.keys import OF_KEY
from dcg_torch.names.vocabulary import PLACE_WORDS
from dcg_torch.scene.workspace import Beside, with_all, with_places_of_all
from dcg_torch.types import OPAQUE, ParseTree, WorldModel

_NEGLIGIBLE = 3.0
"""Readings whose log-weight is so far below the best one's are not grounded."""
_ABSENT = 3.0
"""Further down are those kept that name what is there, where the best one does not."""
_TO_A_ROOM = 2.0
"""How much less likely a reading is that means a room by which others only say where the thing is."""
_FIRST_GOAL, _ON_THE_WAY = "target=earlier_goal", 2.0
"""The choice to mean where the first of two orders leads, "go to the hall and take the cup", and how much less likely
it is for a robot that stands somewhere: for it that is a way, and the thing at its end is meant."""
_SENSELESS = math.log(1e-6)


@dataclass(frozen=True)
class Reading:
    """A reading as it is grounded: what it says, its log-weight, and the choices that led to it."""

    tree: ParseTree
    log_weight: float
    rules: tuple[str, ...] = ()


def worth_grounding(command: ReadCommand, world: WorldModel, learned: Mapping[str, float]) -> list[Reading]:
    """The readings of a command that are not negligible, the likeliest first.

    Args:
        world: what may be told by looking is added to their trees.
        learned: "rule=option" -> what is added to the log-weight of readings that took the option.
    """
    stands = world.robot is not None
    weighed = [(r, log_weight(r, learned) - stands * _on_the_way(r, command.text)) for r in command.readings]
    weighed.sort(key=lambda one: -one[1])
    types = frozenset([t for t in world.classes if not t.startswith(OPAQUE)])
    strange = [speaks_of_what_is_not_there(r.tree, types) for r, _ in weighed]
    least = weighed[0][1] - _NEGLIGIBLE if weighed else 0.0
    kept = [
        (r, weight)
        for (r, weight), absent in zip(weighed, strange, strict=True)
        if weight >= least - (_ABSENT if strange[0] and not absent else 0.0)
    ]
    kept = [(r, w - less) for (r, w), less in zip(kept, needless([r.tree for r, _ in kept], world), strict=True)]
    kept.sort(key=lambda one: -one[1])
    referring = refer_back([r.tree for r, _ in kept], [r.tree for r in command.readings])
    trees = [in_scene_words(tree, world) for tree in in_what_holds_it(referring, world)]
    led, looks = led_into_rooms(trees, world), Looks.of(world)
    told = by_cells(by_attributes([with_appearance_words(tree, command.text, looks) for tree, _ in led], world), world)
    if stands:
        told = [led_along(tree, r.tree, command.text) for tree, (r, _) in zip(told, kept, strict=True)]
    return [
        Reading(tree, weight - (_TO_A_ROOM if leads else 0.0), tuple(r.rules))
        for tree, (_, leads), (r, weight) in zip(told, led, kept, strict=True)
    ]


def _on_the_way(reading: WeightedReading, text: str) -> float:
    """What a reading loses that means where the first of two orders leads.

    Unless that is a room, and both are said in one breath: such an order is to be in that room.
    """
    first = _FIRST_GOAL in reading.rules and ("," in text or not leads_to_a_room(reading.tree))
    return _ON_THE_WAY if first else 0.0


_CORNER = "corner"
_OF_ALL = frozenset({_CORNER, "middle"})
"""Places of what is there as a whole: sides are the robot's own where there are no edges."""


def told_where(world: WorldModel, readings: Sequence[Reading]) -> WorldModel:
    """The world whose things are told the cells, rooms and corners that readings speak of, with places if need be."""
    trees = [reading.tree for reading in readings]
    said = [Words.of(tree) for tree in trees]
    kinds = {PLACE_WORDS[noun][0] for of in said for noun in of.nouns if noun in PLACE_WORDS} & _OF_ALL
    if any(of_two_sides(node.phrase) for tree in trees for node in tree.walk()) and is_close_by(world):
        kinds |= {_CORNER}
    if kinds:
        world = with_places_of_all(world, kinds)
    if not any(OF_KEY in word for of in said for word in of.words):
        return world
    for told in (with_cells, with_rooms, with_corners, with_walls, with_levels, with_tiers):
        world = told(world, trees)
    return world


def log_weight(reading: WeightedReading, learned: Mapping[str, float]) -> float:
    """The log-weight of a reading, with what was learned of the choices that led to it; see `worth_grounding`."""
    return reading.log_weight + sum(learned.get(rule, 0.0) for rule in reading.rules)


_NOTHING = Beside()


class SharedSearch:
    """Grounds several trees in one world: what they have in common is encoded and scored once.

    It remembers what it has scored, so it goes with the weights as they are, and lives as long as one command.

    Args:
        encoder: of the world.
        tables: of the phrases, under the weights.
        beam: hypotheses of a phrase that its parent considers.
    """

    def __init__(self, encoder: WorldEncoder, tables: Tables, beam: int) -> None:
        self._tables = tables
        self._beam = beam
        self._search = Search(encoder, tables, beam)
        self._others: dict[tuple[Beside, frozenset[str]], Search] = {(_NOTHING, frozenset()): self._search}
        self._solved: dict[tuple[ParseTree, Beside, bool, frozenset[str]], Solution] = {}

    @property
    def world(self) -> WorldModel:
        """Upsilon, without groups."""
        return self._search.encoder.world

    @cached_property
    def _setting(self) -> Setting:
        return setting_of(self.world)

    def ground(self, tree: ParseTree, *, brief: bool = False) -> Solution:
        """What one reading is grounded to.

        Args:
            brief: leave out the runner-up of what it is about, see `with_runner_up`.
        """
        if not self._search.encoder.related:
            return self.solve(path_to_object(tree), brief=brief)
        first, *others = coordinated(tree)
        further = tuple([self._described(part, brief=False) for part in others])
        found = self._described(first, brief=brief)
        if offers_choice(tree):
            return sum_over([found, *further], [_log_there(one) + _fit(one) for one in (found, *further)])
        return replace(found, further=further) if further else found

    def _described(self, tree: ParseTree, *, brief: bool) -> Solution:
        kept, exceptions = split_exceptions(tree)
        out = [self._described(one, brief=True).objects for one in exceptions]
        left_out = frozenset(o.id for objects in out for o in objects if not o.hypothetical)
        said = in_setting(kept, self._setting)
        return self.solve(said, beside=speaks_of(said), brief=brief, left_out=left_out)

    def solve(
        self, tree: ParseTree, *, beside: Beside = _NOTHING, brief: bool = False, left_out: frozenset[str] = frozenset()
    ) -> Solution:
        """The solution of a tree of factors.

        Args:
            beside: what is spoken of there beside things and the usual places.
            brief: leave out the runner-up.
            left_out: ids of what is there and is not meant.
        """
        key = (tree, beside, brief, left_out)
        if key not in self._solved:
            self._solved[key] = self._search_in(beside, left_out).solve(tree, brief=brief)
        return self._solved[key]

    def with_runner_up(self, solution: Solution) -> Solution:
        """A solution of this search that was found without one; one of another search as it is."""
        found = [s for s in self._others.values() if s.encoder.world is solution.world]
        if not found or solution.tree is None or solution.best is None:
            return solution
        return replace(solution, runner_up=found[0].runner_up(solution.tree, solution.best))

    def _search_in(self, beside: Beside, left_out: frozenset[str]) -> Search:
        """The search in the world with what is spoken of, and without what is left out."""
        key = beside, left_out
        if key not in self._others:

            def spoken_of(world: WorldModel) -> WorldModel:
                world = with_all(world, beside)
                return without(world, left_out) if left_out else world

            encoder = self._search.encoder.derived(key, spoken_of)
            self._others[key] = Search(encoder, self._tables, self._beam)
        return self._others[key]


def sum_over_frames(searches: Sequence[tuple[SharedSearch, float]], readings: Sequence[Reading]) -> Solution:
    """The sum over the frames of reference, and over the readings in each.

    Args:
        searches: in the world as it is seen in each frame, with the log-probability of the frame; the robot's first.
        readings: the likeliest first.
    """
    brief = len(searches) * len(readings) > 1  # only the solution that is taken needs a runner-up
    found = [[search.ground(as_viewed(r.tree, search.world), brief=brief) for r in readings] for search, _ in searches]
    weights = [[frame + r.log_weight for r in readings] for _, frame in searches]
    solution = sum_over([s for of in found for s in of], [w for of in weights for w in of])
    for search, _ in searches if brief else ():
        solution = search.with_runner_up(solution)
    if len(searches) == 1:
        return solution
    told = [
        np.logaddexp.reduce([w + _fit(s) for w, s in zip(*of, strict=True)]) for of in zip(weights, found, strict=True)
    ]
    return replace(solution, speakers_frame=float(1.0 / (1.0 + np.exp(told[0] - told[1]))))


def _log_there(solution: Solution) -> float:
    """Logarithm of the probability that what a noun phrase means is there: of two to choose from, one may not be."""
    unseen = sum(solution.probabilities.get(o.id, 0.0) for o in solution.world.objects if o.hypothetical)
    return math.log(max(1e-6, 1.0 - unseen))


def _fit(solution: Solution) -> float:
    """Logarithm of how well a reading describes what it describes best of all that is there."""
    return math.log(max([1e-9, *(solution.fits[o.id] for o in solution.world.objects if not o.hypothetical)]))


def sum_over(solutions: Sequence[Solution], log_weights: Sequence[float]) -> Solution:
    """p(object) = sum over readings t of p(t | command, world) p(object | t).

    A reading is as probable as it was before the world has spoken, times how well its noun phrase names something that
    is there.

    Args:
        solutions: one for each reading, the likeliest first; at least one.
        log_weights: of the readings, up to a constant.

    Returns:
        The solution of the likeliest reading that means the likeliest object, with the probabilities of all.
    """
    if len(solutions) == 1:
        return solutions[0]
    scores = [w + sense(s) for w, s in zip(log_weights, solutions, strict=True)]
    most = max(scores)
    shares = [math.exp(s - most) for s in scores]
    whole = sum(shares)
    total = _mixed([s.probabilities for s in solutions], [share / whole for share in shares])
    meant = [[o.id for o in (s.object, *s.objects) if o is not None] for s in solutions]
    grounded = [k for k, ids in enumerate(meant) if ids]
    if not grounded:
        return solutions[0]
    # Of several that one reading means alike any may be the likeliest.
    best = max(grounded, key=lambda k: (max(total[id_] for id_ in meant[k]), shares[k]))
    return replace(solutions[best], probabilities=total, world=_with_groups_of(solutions[best].world, solutions))


def _with_groups_of(world: WorldModel, solutions: Sequence[Solution]) -> WorldModel:
    """A world with the groups that some readings alone speak of, which have their probability too."""
    own = {group.id for group in world.groups}
    more = {group.id: group for s in solutions for group in s.world.groups if group.id not in own}
    return replace(world, groups=(*world.groups, *more.values())) if more else world


def _mixed(parts: Sequence[Mapping[str, float]], shares: Sequence[float]) -> Mapping[str, float]:
    """The sum of probabilities, each mapping times its share, of all ids that are in some."""
    found = ByThing.mixture(parts, shares)
    if found is not None:
        return found
    total: dict[str, float] = {}
    for part, share in zip(parts, shares, strict=True):
        for id_, value in part.items():
            total[id_] = total.get(id_, 0.0) + value * share
    return total


def sense(solution: Solution) -> float:
    """Logarithm of how well a reading names something that is there."""
    return _SENSELESS if solution.best is None else max(_SENSELESS, math.log(max(solution.named, 1e-300)))
