"""Asking back: when the robot is not sure enough, it describes the candidates so that a person can tell them apart.

Descriptions are relative to the robot's start pose, which is where it stood when it was spoken to.
"""

from __future__ import annotations

import functools
import itertools
import math
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from dcg_torch.grounding.solution import Solution
from dcg_torch.types import Percept, Pose
from dcg_torch.types.geometry import NEXT_TO, bearing, to_robot_frame, wrap_angle

Fits = Callable[[Percept], bool]
"""Whether some words fit an object."""

_SIDES = (
    ("in front of me", 0.0),
    ("on my left", math.pi / 2),
    ("on my right", -math.pi / 2),
    ("behind me", math.pi),
)
_SIDE = math.radians(40.0)  # from the middle of a side, within which a thing is there
_DECIMALS = (1, 2, 3)  # of metres, until what is measured fits one thing
_MARGIN = 0.3  # metres by which the closest and the farthest must stand out, so that it can be seen


@dataclass(frozen=True, slots=True)
class Question:
    """A sentence, and the ids of the objects that it names in this order."""

    text: str
    candidates: tuple[str, ...]


@dataclass(frozen=True, slots=True)
class Reply:
    """What the speaker says: the id of the candidate meant, or None for none of them."""

    meant: str | None

    def text(self, question: Question) -> str:
        """The reply in words."""
        if self.meant is None:
            return "no" if len(question.candidates) == 1 else "none of them"
        if len(question.candidates) == 1:
            return "yes"
        return f"the {_ORDINALS[question.candidates.index(self.meant)]} one"


_ORDINALS = ("first", "second", "third", "fourth", "fifth")

Listener = Callable[[Question], Reply]
"""Who answers."""


def truthful(target: str) -> Listener:
    """A speaker who meant the object `target` and says so when asked."""
    return lambda question: Reply(target if target in question.candidates else None)


@dataclass(frozen=True, slots=True)
class AskingPolicy:
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


def candidates(solution: Solution, policy: AskingPolicy) -> tuple[str, ...]:
    """The objects to ask about, the most probable first; none if the robot is sure enough, or has seen none."""
    seen = [(solution.probabilities[o.id], o.id) for o in solution.world.objects if not o.hypothetical]
    seen.sort(key=lambda item: (-item[0], item[1]))
    if not seen or seen[0][0] >= policy.below:
        return ()
    return tuple(id_ for p, id_ in seen[: policy.options] if p >= policy.least)


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
    base = _described(thing, names)
    # "the blue thing" fits whatever is blue, "the blue cube" only blue cubes
    rivals = [p for p in percepts if p.color == thing.color and names.get(thing.type) in (None, names.get(p.type))]
    if len(rivals) == 1:
        return base, ""
    for where, fits in location_phrases(thing, percepts, rivals, start, names):
        if [p.id for p in rivals if fits(p)] == [thing.id]:
            return base, where
    for decimals in _DECIMALS:
        where = _measured(thing, start, decimals)
        if [p.id for p in rivals if _measured(p, start, decimals) == where] == [thing.id]:
            break  # so exact that it fits no other
    return base, where


def _measured(thing: Percept, start: Pose, decimals: int) -> str:
    """As in "1.5 m in front of me and 0.2 m to the left"."""
    ahead, left = _relative(thing, start)
    return (
        f"{abs(ahead):.{decimals}f} m {'in front of' if ahead >= 0 else 'behind'} me and "
        f"{abs(left):.{decimals}f} m to the {'left' if left >= 0 else 'right'}"
    )


def location_phrases(
    thing: Percept, percepts: Sequence[Percept], rivals: Sequence[Percept], start: Pose, names: Mapping[str, str]
) -> Iterator[tuple[str, Fits]]:
    """Ways to say where a thing is, the simplest first, each with the test that it passes.

    Args:
        percepts: all that was seen: a landmark is one of them.
        rivals: those that the thing must be told from, itself among them.
        start: where the robot stood when it was spoken to.
        names: type -> a word for it that the robot is sure of.
    """
    for where, middle in _SIDES:
        beside = functools.partial(_is_at_side, start=start, middle=middle)
        if beside(thing):
            yield where, beside
    for landmark in _landmarks(thing, percepts, names):
        yield f"next to {_described(landmark, names)}", functools.partial(_is_next_to, landmark=landmark)
    distances = sorted(_distance(p, start) for p in rivals)
    if len(distances) > 1 and distances[1] - distances[0] > _MARGIN:
        yield "closest to me", lambda p: _distance(p, start) <= distances[0]
    if len(distances) > 1 and distances[-1] - distances[-2] > _MARGIN:
        yield "farthest from me", lambda p: _distance(p, start) >= distances[-1]
    for (side, sign), (depth, forward) in itertools.product(
        (("to the left", 1.0), ("to the right", -1.0)), (("in front of me", 1.0), ("behind me", -1.0))
    ):
        quarter = functools.partial(_is_in_quarter, start=start, forward=forward, sign=sign)
        if quarter(thing):
            yield f"{depth} {side}", quarter


def _described(thing: Percept, names: Mapping[str, str]) -> str:
    """As in "the red cube", "the blue thing"."""
    return " ".join(filter(None, ("the", thing.color, names.get(thing.type, "thing"))))


def _landmarks(thing: Percept, percepts: Sequence[Percept], names: Mapping[str, str]) -> Iterator[Percept]:
    """Things next to this one that a name, with their colour, says by itself; the nearest first."""
    for landmark in sorted(percepts, key=lambda p: (math.dist(p.position, thing.position), p.id)):
        alike = [p for p in percepts if p.color == landmark.color and names.get(p.type) == names.get(landmark.type)]
        if landmark.type in names and len(alike) == 1 and _is_next_to(thing, landmark):
            yield landmark


def _is_next_to(thing: Percept, landmark: Percept) -> bool:
    return thing.id != landmark.id and math.dist(thing.position, landmark.position) <= NEXT_TO


def _is_at_side(thing: Percept, start: Pose, middle: float) -> bool:
    return abs(wrap_angle(bearing(start, *thing.position[:2]) - middle)) < _SIDE


def _is_in_quarter(thing: Percept, start: Pose, forward: float, sign: float) -> bool:
    ahead, left = _relative(thing, start)
    return ahead * forward > 0 and left * sign > 0


def _relative(thing: Percept, start: Pose) -> tuple[float, float]:
    """Metres ahead and to the left of the start pose."""
    ((ahead, left),) = to_robot_frame(start, np.array([thing.position[:2]])).tolist()
    return ahead, left


def _distance(thing: Percept, start: Pose) -> float:
    return math.dist(thing.position[:2], (start.x, start.y))
