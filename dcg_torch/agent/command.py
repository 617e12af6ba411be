"""One command: perceive, hypothesise, ground, explore or drive (Alg. 1, lines 8 to 15)."""

from __future__ import annotations

import math
import time
from collections import defaultdict
from collections.abc import Callable, Collection, Iterator
from contextlib import contextmanager
from dataclasses import dataclass, field, replace
from typing import Protocol

from dcg_torch.agent.asking import Answer, Asking, Listener, Question, candidates, question
from dcg_torch.agent.explore import Explorer, TurnInPlace
from dcg_torch.agent.robot import Robot
from dcg_torch.grounding.solution import Solution
from dcg_torch.learning.learner import Experience
from dcg_torch.model import GroundingModel
from dcg_torch.types import ParseTree, Percept, Pose, WorldModel


class Parse(Protocol):
    """What reading a command gives: a tree, or the problem in words."""

    @property
    def tree(self) -> ParseTree | None:
        """The phrases, or None if there is a problem."""
        ...

    @property
    def problem(self) -> str | None:
        """Why there is no tree."""
        ...

    @property
    def noun(self) -> str | None:
        """The noun of the object meant."""
        ...

    @property
    def color(self) -> str | None:
        """The colour stated of the object meant."""
        ...


Parser = Callable[[str, Collection[str]], Parse]


@dataclass
class Stopwatch:
    """Wall-clock seconds by what they were spent on."""

    seconds: defaultdict[str, float] = field(default_factory=lambda: defaultdict(float))
    counts: defaultdict[str, int] = field(default_factory=lambda: defaultdict(int))

    @contextmanager
    def __call__(self, name: str) -> Iterator[None]:
        """Add the time of a `with` block to `name`, and one to its count."""
        began = time.perf_counter()
        try:
            yield
        finally:
            self.seconds[name] += time.perf_counter() - began
            self.counts[name] += 1


@dataclass(frozen=True)
class Look:
    """One pass of lines 8 to 11, for those who watch: where from, what is known by then, what it means."""

    pose: Pose
    percepts: tuple[Percept, ...]
    solution: Solution


@dataclass(frozen=True)
class Outcome:
    """What came of a command.

    Attributes:
        parse: the reading of the command.
        solution: the last grounding; None if there was no tree.
        in_view: ids seen from the start pose.
        percepts: all that was perceived, in the order of first sight.
        arrived: did the drive end where it should; None if there was nowhere to drive.
        looked: did the robot look all round before it decided?
        asked: the questions that it asked, with their answers.
    """

    parse: Parse
    solution: Solution | None
    in_view: tuple[str, ...]
    percepts: tuple[Percept, ...]
    arrived: bool | None
    looked: bool = False
    asked: tuple[tuple[Question, Answer], ...] = ()

    def experience(self, source: str) -> Experience:
        """What bears on what can be learned, beside the grounding."""
        return Experience(self.looked, any(a.meant is not None for _, a in self.asked), source=source)


def carry_out(
    text: str,
    model: GroundingModel,
    parse: Parser,
    robot: Robot,
    *,
    spin_step: float = math.radians(20.0),
    explorer: Explorer | None = None,
    asking: Asking | None = None,
    listener: Listener | None = None,
    watch: Callable[[Look], None] | None = None,
    stopwatch: Stopwatch | None = None,
) -> Outcome:
    """Ground a command and act on it.

    The explorer moves the robot on, and what it has seen meanwhile is grounded anew, until the explorer is content:
    by default that is the paper's, which turns in place while the grounding is hypothetical (line 13). Then the
    robot may ask back. A grounding that is still hypothetical is not acted on: what is meant is not there.

    Args:
        spin_step: radians between two looks of the default explorer; positive turns left.
        explorer: decides on the looks.
        asking: when to ask back; None: never.
        listener: answers the questions; None: nobody does, so none are asked.
        watch: called after every grounding.
        stopwatch: takes the times.
    """
    clock = stopwatch or Stopwatch()
    start = robot.pose
    with clock("perceive"):
        percepts = {p.id: p for p in robot.perceive()}
    in_view = tuple(percepts)
    with clock("parse"):
        reading = parse(text, model.symbols.keys())
    if reading.tree is None:
        return Outcome(reading, None, in_view, tuple(percepts.values()), None)
    explorer = explorer or TurnInPlace(spin_step)
    while True:
        with clock("ground"):
            world = model.world_model(percepts.values(), start, looked=explorer.looked)
            solution = model.ground(reading.tree, world)
        if watch is not None:
            watch(Look(robot.pose, tuple(percepts.values()), solution))
        with clock("explore"):
            moved = explorer.move(solution, tuple(percepts.values()), robot)
        if not moved:
            break
        with clock("perceive"):
            for percept in robot.perceive():
                percepts.setdefault(percept.id, percept)
    asked: list[tuple[Question, Answer]] = []
    while asking is not None and listener is not None and len(asked) < asking.questions:
        ids = candidates(solution, asking)
        if not ids:
            break
        asked.append((q := question(ids, tuple(percepts.values()), start, model.sure_names()), listener(q)))
        with clock("ground"):
            solution = model.ground(reading.tree, _told(solution.world, *asked[-1]))
    arrived = None
    if solution.object is not None and not solution.object.hypothetical:
        move = robot.drive_away if solution.inverted else robot.drive_to
        with clock("drive"):
            arrived = move(solution.object.id, list(percepts.values()))
    return Outcome(
        reading, solution, in_view, tuple(percepts.values()), arrived, looked=explorer.looked, asked=tuple(asked)
    )


def _told(world: WorldModel, asked: Question, answer: Answer) -> WorldModel:
    """Upsilon after an answer: only the object that is meant may be, or all but those that are not.

    The others stay in the world: what is meant may stand next to them.
    """
    before = {o.id for o in world.objects} if world.meant is None else world.meant
    left = before - set(asked.candidates) if answer.meant is None else {answer.meant}
    return replace(world, meant=frozenset(left))
