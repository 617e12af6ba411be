"""Asking back: when the robot is not sure enough, it describes the candidates so that a person can tell them apart.

Descriptions are relative to the robot's start pose, which is where it stood when it was spoken to.
"""

from __future__ import annotations

import itertools
import math
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass

from dcg_torch.grounding.solution import Solution
from dcg_torch.types import Percept, Pose

Fits = Callable[[Percept], bool]


@dataclass(frozen=True, slots=True)
class Question:
    """A sentence, and the ids of the objects that it names in this order."""

    text: str
    candidates: tuple[str, ...]


@dataclass(frozen=True, slots=True)
class Answer:
    """What the speaker says: the id of the candidate meant, or None for none of them."""

    meant: str | None

    def text(self, question: Question) -> str:
        """The answer in words."""
        if self.meant is None:
            return "no" if len(question.candidates) == 1 else "none of them"
        if len(question.candidates) == 1:
            return "yes"
        return f"the {_ORDINALS[question.candidates.index(self.meant)]} one"


_ORDINALS = ("first", "second", "third", "fourth", "fifth")

Listener = Callable[[Question], Answer]
"""Who answers."""


def truthful(target: str) -> Listener:
    """A speaker who meant the object `target` and says so when asked."""
    return lambda question: Answer(target if target in question.candidates else None)


@dataclass(frozen=True, slots=True)
class Asking:
    """When to ask, and how much.

    Attributes:
        below: ask if the best object's probability is lower.
        least: name the objects that are at least this probable.
        options: objects in one question, at the most.
        questions: in one command, at the most.
    """

    below: float = 0.9
    least: float = 0.05
    options: int = 4
    questions: int = 3


def candidates(solution: Solution, asking: Asking) -> tuple[str, ...]:
    """The objects to ask about, the most probable first; none if the robot is sure enough, or has seen none."""
    seen = [(solution.probabilities[o.id], o.id) for o in solution.world.objects if not o.hypothetical]
    seen.sort(key=lambda item: (-item[0], item[1]))
    if not seen or seen[0][0] >= asking.below:
        return ()
    return tuple(id_ for p, id_ in seen[: asking.options] if p >= asking.least)


def question(ids: Sequence[str], percepts: Sequence[Percept], start: Pose, names: Mapping[str, str]) -> Question:
    """Ask which of some objects is meant.

    Args:
        ids: of the objects.
        percepts: all that was seen; a description fits no other.
        start: where the robot stood when it was spoken to.
        names: type -> a word for it that the robot is sure of.
    """
    parts: list[str] = []
    last = ""
    for id_ in ids:
        base, where = describe(next(p for p in percepts if p.id == id_), percepts, start, names)
        # "the blue thing on the left, or the one on the right"
        parts.append(f"the one {where}" if base == last and where else " ".join(filter(None, (base, where))))
        last = base
    listed = parts[0] if len(parts) == 1 else f"{', '.join(parts[:-1])}, or {parts[-1]}"
    return Question(f"Do you mean {listed}?", tuple(ids))


def describe(thing: Percept, percepts: Sequence[Percept], start: Pose, names: Mapping[str, str]) -> tuple[str, str]:
    """What an object is and, if that fits others as well, where it is: ("the blue thing", "on my left")."""
    name = names.get(thing.type)
    base = " ".join(filter(None, ("the", thing.color, name or "thing")))
    alike = [p for p in percepts if p.color == thing.color and (name is None or names.get(p.type) == name)]
    if len(alike) == 1:
        return base, ""
    for where, fits in places(thing, percepts, alike, start, names):
        if [p.id for p in alike if fits(p)] == [thing.id]:
            return base, where
    ahead, left = relative(thing, start)
    return base, (
        f"{abs(ahead):.1f} m {'in front of' if ahead >= 0 else 'behind'} me and "
        f"{abs(left):.1f} m to the {'left' if left >= 0 else 'right'}"
    )


def places(
    thing: Percept, percepts: Sequence[Percept], alike: Sequence[Percept], start: Pose, names: Mapping[str, str]
) -> Iterator[tuple[str, Fits]]:
    """Ways to say where a thing is, each with the test that it passes, the simplest first."""
    sides: tuple[tuple[str, float], ...] = (
        ("in front of me", 0.0),
        ("on my left", math.pi / 2),
        ("on my right", -math.pi / 2),
        ("behind me", math.pi),
    )
    for where, middle in sides:

        def beside(p: Percept, middle: float = middle) -> bool:
            return abs(math.remainder(_bearing(p, start) - middle, math.tau)) < math.radians(40.0)

        if beside(thing):
            yield where, beside
    for mark in sorted(percepts, key=lambda p: (math.dist(p.position, thing.position), p.id)):
        name = names.get(mark.type)
        same = [p for p in percepts if p.color == mark.color and names.get(p.type) == name]
        if mark.id == thing.id or name is None or len(same) > 1 or math.dist(mark.position, thing.position) > 2.0:
            continue

        def near(p: Percept, mark: Percept = mark) -> bool:
            return p.id != mark.id and math.dist(p.position, mark.position) <= 2.0

        yield f"next to {' '.join(filter(None, ('the', mark.color, name)))}", near
    distances = sorted(_distance(p, start) for p in alike)
    # said only where the difference can be seen
    if len(distances) > 1 and distances[1] - distances[0] > 0.3:
        yield "closest to me", lambda p: _distance(p, start) <= distances[0]
    if len(distances) > 1 and distances[-1] - distances[-2] > 0.3:
        yield "farthest from me", lambda p: _distance(p, start) >= distances[-1]
    for (side, one), (depth, other) in itertools.product(
        (("to the left", 1.0), ("to the right", -1.0)), (("in front of me", 1.0), ("behind me", -1.0))
    ):

        def quarter(p: Percept, one: float = one, other: float = other) -> bool:
            ahead, left = relative(p, start)
            return ahead * other > 0 and left * one > 0

        if quarter(thing):
            yield f"{depth} {side}", quarter


def relative(thing: Percept, start: Pose) -> tuple[float, float]:
    """Metres ahead and to the left of the start pose."""
    x, y = thing.position[0] - start.x, thing.position[1] - start.y
    ahead, left = math.cos(start.yaw), math.sin(start.yaw)
    return x * ahead + y * left, y * ahead - x * left


def _bearing(thing: Percept, start: Pose) -> float:
    ahead, left = relative(thing, start)
    return math.atan2(left, ahead)


def _distance(thing: Percept, start: Pose) -> float:
    return math.hypot(*relative(thing, start))
