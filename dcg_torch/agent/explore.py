"""When to look further, and where: the paper's turning in place, and looking before deciding.

An explorer lives for one command. After every grounding it either moves the robot and returns True, so that the
command is grounded anew with what is seen then, or returns False: what is known now is acted on.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Protocol

import numpy as np

from dcg_torch.agent.robot import Robot
from dcg_torch.grounding.solution import Solution
from dcg_torch.types import Percept
from dcg_torch.types.arrays import Bools, Floats
from dcg_torch.types.geometry import FIELD_OF_VIEW, segment_distances

Point = tuple[float, float]


class Explorer(Protocol):
    """Decides on the next look."""

    @property
    def looked(self) -> bool:
        """Has the robot seen all the ground that it can see from where it stood?"""

    def move(self, solution: Solution, percepts: Sequence[Percept], robot: Robot) -> bool:
        """Move the robot for another look, if one is wanted."""


class TurnInPlace:
    """The paper's: turn while the grounding is hypothetical, full circle at the most (Alg. 1, line 13).

    Args:
        step: radians between two looks; positive turns left.
    """

    looked = False  # the paper's world model doesn't tell

    def __init__(self, step: float) -> None:
        self._step = step
        self._remaining = math.tau

    def move(self, solution: Solution, percepts: Sequence[Percept], robot: Robot) -> bool:
        """Turn by a step, if what is meant hasn't been seen."""
        missing = solution.object is not None and solution.object.hypothetical
        if self._remaining <= 1e-9 or not missing:
            return False
        step = min(abs(self._step), self._remaining)
        self._remaining -= step
        robot.spin(math.copysign(step, self._step))
        return True


@dataclass(frozen=True, slots=True)
class Worth:
    """When another look is worth its turn or its way.

    Attributes:
        meanings: look on while the types that the word may name, and that are not in view, have more than this
            share of the belief: one of them may be meant, and the robot learns what was there to be meant.
        least: a type with less belief doesn't count.
        sure: with asking, also look on while the best object seen is less probable than this, so that the question
            names all there is; None without asking.
        absent: after looking round, drive to unseen ground while what is meant is unseen with more than this
            probability.
        ground: a place to look from must show at least this share of the ground.
        views: places that are driven to, at the most.
    """

    meanings: float = 0.03
    least: float = 0.005
    sure: float | None = None
    absent: float = 0.5
    ground: float = 0.02
    views: int = 2


@dataclass
class LookBefore:
    """Look round while more than one thing may be meant, or more must be seen; then drive to where unseen ground is.

    A turn of 360 degrees less the width of the view, in equal steps no wider than the view, shows all round.

    Attributes:
        meanings: gives type -> probability for a noun.
        worth: when to go on.
        places: where it has looked all round.
    """

    meanings: Callable[[str], Mapping[str, float]]
    worth: Worth = Worth()
    places: list[Point] = field(default_factory=list)
    _turned: int = 0
    _complete: bool = False

    TURNS = math.ceil((math.tau - FIELD_OF_VIEW) / math.radians(52.0))
    STEP = (math.tau - FIELD_OF_VIEW) / TURNS + 1e-3

    @classmethod
    def resumed(cls, meanings: Callable[[str], Mapping[str, float]], worth: Worth, places: list[Point]) -> LookBefore:
        """One that has looked all round at these places for an earlier command, and adds its own to them."""
        complete = bool(places)
        return cls(meanings, worth, places, cls.TURNS if complete else 0, complete)

    @property
    def looked(self) -> bool:
        """Has it come full circle, at least once?"""
        return self._complete

    def move(self, solution: Solution, percepts: Sequence[Percept], robot: Robot) -> bool:
        """Turn by a step, or drive to the next place; False when neither is worth it."""
        if self._turned < self.TURNS:
            found = self._complete and missing(solution) <= self.worth.absent
            if found or not (self._complete or self._worth_turning(solution)):
                return False
            robot.spin(self.STEP)
            self._turned += 1
            if self._turned == self.TURNS:
                self._complete = True
                self.places.append((robot.pose.x, robot.pose.y))
            return True
        if len(self.places) > self.worth.views or missing(solution) <= self.worth.absent:
            return False
        place = next_place((robot.pose.x, robot.pose.y), self.places, percepts, self.worth.ground)
        if place is None or not robot.go_to(*place, percepts):
            return False
        self._turned = 0
        return True

    def _worth_turning(self, solution: Solution) -> bool:
        if compares(solution):
            return True
        noun = None if solution.noun is None else solution.noun.noun
        if noun is None:
            return solution.object is not None and solution.object.hypothetical
        if meanings_out_of_view(solution, self.meanings(noun), self.worth.least) > self.worth.meanings:
            return True
        unsure = self.worth.sure is not None and max_seen(solution) < self.worth.sure
        return unsure and missing(solution) > 0.02


def compares(solution: Solution) -> bool:
    """Is the object meant told by what else there is? Then all of that must be seen: "farthest", "next to the cube"."""
    noun = solution.target
    return noun is not None and bool(noun.phrase.words or noun.children)


def missing(solution: Solution) -> float:
    """Probability that what is meant has not been seen."""
    return math.fsum(solution.probabilities[o.id] for o in solution.world.objects if o.hypothetical)


def max_seen(solution: Solution) -> float:
    """Probability of the most probable object that has been seen."""
    return max((solution.probabilities[o.id] for o in solution.world.objects if not o.hypothetical), default=0.0)


def meanings_out_of_view(solution: Solution, meanings: Mapping[str, float], least: float) -> float:
    """Share of the belief about a word that is with types of which no fitting object is in view.

    An object in view fits if it is more probable than an unseen one of its type: a stated colour is its colour.
    """
    probability = solution.probabilities
    unseen = {o.type: probability[o.id] for o in solution.world.objects if o.hypothetical}
    in_view = {
        o.type for o in solution.world.objects if not o.hypothetical and probability[o.id] > unseen.get(o.type, 0.0)
    }
    return math.fsum(p for t, p in meanings.items() if p > least and t not in in_view)


_CELL = 0.4  # metres
_BODY = 0.16  # metres, of what an object hides
_BERTH = 0.55  # metres from an object's middle to where the robot may stand


def next_place(here: Point, places: Sequence[Point], percepts: Sequence[Percept], least: float) -> Point | None:
    """Where to look from next: the most unseen ground for the way (Connolly 1985, "The determination of next best
    views"; the ground out of sight is a frontier in the sense of Yamauchi 1997).

    The ground is the rectangle about all that was seen, a metre wider. A cell is seen from a place if no object's
    disc is on the line between them.

    Args:
        here: where the robot is.
        places: where it has looked round.
        percepts: the objects, which hide what is behind them.
        least: share of the ground that a place must newly show.

    Returns:
        None if no place shows that much.
    """
    discs = np.array([p.position[:2] for p in percepts], dtype=np.float64).reshape(-1, 2)
    corners = np.vstack([discs, np.array([here, *places])])
    low, high = corners.min(axis=0) - 1.0, corners.max(axis=0) + 1.0
    axes = [np.arange(a, b + _CELL / 2, _CELL) for a, b in zip(low, high, strict=True)]
    cells = np.stack(np.meshgrid(*axes, indexing="ij"), axis=-1).reshape(-1, 2)
    seen = np.zeros(len(cells), dtype=np.bool_)
    for place in places:
        seen |= in_sight(np.array([place]), cells, discs)[0]
    hidden = cells[~seen]
    far = np.linalg.norm(cells[:, None] - discs[None], axis=2).min(axis=1, initial=math.inf) > _BERTH
    stands = cells[seen & far]
    if not len(hidden) or not len(stands):
        return None
    shown = in_sight(stands, hidden, discs).sum(axis=1) / len(cells)
    way = np.linalg.norm(stands - np.array(here), axis=1)
    score = np.where(shown >= least, shown / (1.0 + way), 0.0)
    best = int(score.argmax())
    return (float(stands[best, 0]), float(stands[best, 1])) if score[best] > 0.0 else None


def in_sight(places: Floats, cells: Floats, discs: Floats) -> Bools:
    """(places, cells): is the line between them free of discs? Cells on a disc count by what is before it."""
    starts, ends = np.repeat(places, len(cells), axis=0), np.tile(cells, (len(places), 1))
    free = np.ones(len(starts), dtype=np.bool_)
    for disc in discs:
        distance, foot = segment_distances(starts, ends, disc[None])
        free &= ((distance > _BODY) | (foot > 1.0) | (foot < 0.0))[:, 0]
    return free.reshape(len(places), len(cells))
