"""One command: perceive, hypothesise, ground, explore or drive (Alg. 1, lines 8 to 15)."""

from __future__ import annotations

import math
import time
from collections import defaultdict
from collections.abc import Callable, Collection, Iterator
from contextlib import contextmanager
from dataclasses import dataclass, field
from typing import Protocol

from dcg_torch.graph import Solution
from dcg_torch.model import GroundingModel
from dcg_torch.symbols import ParseTree, Percept, Pose
from dcg_torch.trial.robot import Robot


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
    """

    parse: Parse
    solution: Solution | None
    in_view: tuple[str, ...]
    percepts: tuple[Percept, ...]
    arrived: bool | None


def carry_out(
    text: str,
    model: GroundingModel,
    parse: Parser,
    robot: Robot,
    *,
    spin_step: float = math.radians(20.0),
    watch: Callable[[Look], None] | None = None,
    stopwatch: Stopwatch | None = None,
) -> Outcome:
    """Ground a command and act on it.

    While the grounding is hypothetical the robot turns in place (line 13) and grounds anew with what it has seen
    meanwhile, until it has come full circle. A grounding that is then still hypothetical is not acted on.

    Args:
        spin_step: radians between two looks; positive turns left.
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
    remaining = math.tau
    while True:
        with clock("ground"):
            world = model.world_model(percepts.values(), start)
            solution = model.ground(reading.tree, world)
        if watch is not None:
            watch(Look(robot.pose, tuple(percepts.values()), solution))
        if solution.object is None or not solution.object.hypothetical or remaining <= 1e-9:
            break
        step = min(abs(spin_step), remaining)
        remaining -= step
        with clock("explore"):
            robot.spin(math.copysign(step, spin_step))
        with clock("perceive"):
            for percept in robot.perceive():
                percepts.setdefault(percept.id, percept)
    arrived = None
    if solution.object is not None and not solution.object.hypothetical:
        move = robot.drive_away if solution.inverted else robot.drive_to
        with clock("drive"):
            arrived = move(solution.object.id, list(percepts.values()))
    return Outcome(reading, solution, in_view, tuple(percepts.values()), arrived)
