"""One command: perceive, hypothesise, ground, explore or drive (Alg. 1, lines 8 to 15)."""

from __future__ import annotations

import math
import time
from collections import defaultdict
from collections.abc import Callable, Iterable, Iterator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass, field, replace
from typing import Any, Protocol

from dcg_torch.agent.asking import AskingPolicy, Listener, Question, Reply, candidates, question
from dcg_torch.agent.explore import Explorer, TurnInPlace
from dcg_torch.agent.robot import Robot
from dcg_torch.grounding.solution import Solution
from dcg_torch.interpretation.marks import heard
from dcg_torch.interpretation.parser_protocol import CommandParser, ParsedCommand, ReadCommand
from dcg_torch.learning.learner import Experience
from dcg_torch.scene.percepts import checked
from dcg_torch.types import DriveResult, Percept, Pose, WorldModel


class Grounder(Protocol):
    """What a command asks of a model; `model.GroundingModel` is one."""

    @property
    def symbols(self) -> Mapping[str, Any]:
        """The known words."""

    def sure_names(self) -> Mapping[str, str]:
        """type -> a word for it that the robot holds for certain."""

    def world_model(
        self, percepts: Iterable[Percept], robot: Pose | None = None, *, looked: bool = False
    ) -> WorldModel:
        """Upsilon of what was perceived from this start pose."""

    def ground(self, command: ReadCommand, world: WorldModel) -> Solution:
        """What a command means in a world."""


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
        drive: how the drive ended; None if there was nowhere to drive.
        looked: did the robot look all round before it decided?
        asked: the questions that it asked, with their answers.
    """

    parse: ParsedCommand
    solution: Solution | None
    in_view: tuple[str, ...]
    percepts: tuple[Percept, ...]
    drive: DriveResult | None
    looked: bool = False
    asked: tuple[tuple[Question, Reply], ...] = ()

    @property
    def arrived(self) -> bool | None:
        """Did the drive end where it should; None if there was nowhere to drive."""
        return None if self.drive is None else bool(self.drive)

    def experience(self, source: str) -> Experience:
        """What bears on what can be learned, beside the grounding."""
        return Experience(self.looked, any(a.meant is not None for _, a in self.asked), source=source)


def carry_out(
    text: str,
    model: Grounder,
    robot: Robot,
    *,
    parse: CommandParser | None = None,
    spin_step: float = math.radians(20.0),
    explorer: Explorer | None = None,
    asking: AskingPolicy | None = None,
    listener: Listener | None = None,
    watch: Callable[[Look], None] | None = None,
    stopwatch: Stopwatch | None = None,
) -> Outcome:
    """Ground a command and act on it.

    The explorer moves the robot on, and what it has seen meanwhile is grounded anew, until the explorer is content:
    by default that is the paper's, which turns in place while the grounding is hypothetical (line 13). Then the
    robot may ask back. A grounding that is still hypothetical is not acted on: what is meant is not there.

    The model does not learn here; `model.learn(outcome.solution, outcome.experience(text))` gives it the outcome.

    Args:
        parse: reads the command; None: the parser of `dcg_torch.language`.
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
        percepts = {p.id: p for p in checked(robot.perceive())}
    in_view = tuple(percepts)
    with clock("parse"):
        reading = heard(parse or _default_parser(), text, model.symbols.keys(), percepts.values())
    if reading.tree is None:
        return Outcome(reading, None, in_view, tuple(percepts.values()), None)
    explorer = explorer or TurnInPlace(spin_step)
    command = CommandUnderWay(reading, model, robot, start, percepts, clock)
    solution, asked = command.ask(command.look(explorer, watch), asking, listener)
    drive = command.act(solution)
    return Outcome(reading, solution, in_view, tuple(percepts.values()), drive, looked=explorer.looked, asked=asked)


@dataclass
class CommandUnderWay:
    """A command under way; `percepts`, by id, grow with every look.

    `carry_out` takes its steps one after the other; a conversation, which waits for answers, takes them by itself.
    """

    said: ReadCommand
    model: Grounder
    robot: Robot
    start: Pose
    percepts: dict[str, Percept]
    clock: Stopwatch = field(default_factory=Stopwatch)

    def look(self, explorer: Explorer, watch: Callable[[Look], None] | None) -> Solution:
        """Ground what is seen, and look on until the explorer is content.

        Where a look has shown nothing new, the command means what it meant before.
        """
        known: tuple[int, bool] | None = None
        while True:
            if known != (known := (len(self.percepts), explorer.looked)):
                with self.clock("ground"):
                    world = self.model.world_model(self.percepts.values(), self.start, looked=explorer.looked)
                    solution = self.model.ground(self.said, world)
            if watch is not None:
                watch(Look(self.robot.pose, tuple(self.percepts.values()), solution))
            with self.clock("explore"):
                moved = explorer.move(solution, tuple(self.percepts.values()), self.robot)
            if not moved:
                return solution
            with self.clock("perceive"):
                for percept in checked(self.robot.perceive()):
                    self.percepts.setdefault(percept.id, percept)

    def ask(
        self, solution: Solution, policy: AskingPolicy | None, listener: Listener | None
    ) -> tuple[Solution, tuple[tuple[Question, Reply], ...]]:
        """Ask until the robot is sure enough; the grounding then, and what was asked."""
        asked: list[tuple[Question, Reply]] = []
        if policy is None or listener is None:
            return solution, ()
        while len(asked) < policy.questions and (ids := candidates(solution, policy)):
            asking = question(ids, tuple(self.percepts.values()), self.start, self.model.sure_names())
            asked.append((asking, listener(asking)))
            solution = self.told(solution, *asked[-1])
        return solution, tuple(asked)

    def told(self, solution: Solution, asked: Question, reply: Reply) -> Solution:
        """Ground anew with the answer to a question."""
        with self.clock("ground"):
            return self.model.ground(self.said, _told(solution.world, asked, reply))

    def act(self, solution: Solution) -> DriveResult | None:
        """Drive to what is meant, or away from it; None: nothing that was seen is meant."""
        if solution.object is None or solution.object.hypothetical:
            return None
        move = self.robot.drive_away if solution.inverted else self.robot.drive_to
        with self.clock("drive"):
            return move(solution.object.id, tuple(self.percepts.values()))


def _default_parser() -> CommandParser:
    from dcg_torch.language import default_parser  # here: who brings a parser needs no words of ours

    return default_parser().parse


def _told(world: WorldModel, asked: Question, reply: Reply) -> WorldModel:
    """Upsilon after a reply: only the object that is meant may be, or all but those that are not.

    The others stay in the world: what is meant may stand next to them.
    """
    before = {o.id for o in world.objects} if world.meant is None else world.meant
    left = before - set(asked.candidates) if reply.meant is None else {reply.meant}
    return replace(world, meant=frozenset(left))
