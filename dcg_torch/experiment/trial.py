"""A trial: Algorithm 1 over a list of commands, a record for each."""

from __future__ import annotations

import functools
import math
from collections.abc import Callable, Iterator, Sequence
from typing import Any

import numpy as np

from dcg_torch.agent.asking import AskingPolicy, truthful
from dcg_torch.agent.command import Look, Outcome, Stopwatch, carry_out
from dcg_torch.agent.explore import Explorer
from dcg_torch.agent.robot import SimulationRobot
from dcg_torch.interpretation.parser_protocol import CommandParser
from dcg_torch.model import GroundingModel
from dcg_torch.report.seconds import PHASES
from dcg_torch.storage.records import Iteration, ObjectRecord, ParsedRecord, PoseRecord, Timing
from dcg_torch.world.speaker import Command


def run_trial(
    trial: int,
    commands: Sequence[Command],
    model: GroundingModel,
    parse: CommandParser,
    robot: SimulationRobot,
    rng: np.random.Generator,
    *,
    spin_step: float = math.radians(20.0),
    explorer: Callable[[], Explorer] | None = None,
    asking: AskingPolicy | None = None,
    watch: Callable[[Command, Look], None] | None = None,
) -> Iterator[tuple[Iteration, Timing]]:
    """Ground, act and learn, command by command; each command's record is yielded as it ends.

    As in Algorithm 1 the robot learns whether or not the drive arrived (line 16 follows line 15 in any case). It learns
    from the grounding and from what was in view; that a way is blocked says nothing of what a word means.

    Args:
        model: freshly trained on the initial training set (lines 1 to 6); it learns in place.
        rng: draws the recogniser's mistakes, if it makes any.
        explorer: makes the explorer of a command; None: the paper's turning in place.
        asking: when to ask back; the speaker answers truthfully. None: never.
    """
    book = _Book(trial, model, robot)
    obey = functools.partial(carry_out, model=model, robot=robot, parse=parse, spin_step=spin_step, asking=asking)
    for command in commands:
        clock = Stopwatch()
        with clock("load_world"):
            robot.load(command.world, rng=rng)
        book.open(command)
        outcome = obey(
            command.text,
            explorer=explorer and explorer(),
            listener=truthful(command.target),
            watch=watch and functools.partial(watch, command),
            stopwatch=clock,
        )
        with clock("train"):
            if outcome.solution is not None:
                model.learn(outcome.solution, outcome.experience(f"{book.iteration}"))
        yield book.close(command, outcome, clock)


class _Book:
    """Makes the records of a trial: told when a command is heard, and when it is over.

    Attributes:
        iteration: number of the command, from 0.
    """

    def __init__(self, trial: int, model: GroundingModel, robot: SimulationRobot) -> None:
        self._trial, self._model, self._robot = trial, model, robot
        self._known_types = model.known_types
        self._first_words = frozenset(model.symbols)
        self._met = set(self._known_types)
        self._said: dict[str, Any] = {}
        self.iteration = -1

    def open(self, command: Command) -> None:
        """The robot stands at its start and hears a command."""
        self.iteration += 1
        self._met |= {o.type for o in command.world.objects if o.id == command.target}
        learned = command.noun in self._model.symbols
        kind = "known" if command.noun in self._first_words else "learned" if learned else "unknown"
        start = self._robot.pose
        self._said = {
            "robot": PoseRecord(x=start.x, y=start.y, yaw=start.yaw),
            "known_types": self._known_types,
            "kind": kind,
            **_of_command(command),
        }

    def close(self, command: Command, outcome: Outcome, clock: Stopwatch) -> tuple[Iteration, Timing]:
        """The command is over, and the model has learned from it."""
        at: dict[str, Any] = {"trial": self._trial, "iteration": self.iteration}
        done = _of_outcome(command, outcome, self._robot)
        knows = _of_model(self._model, self._first_words, len(self._met))
        return Iteration(**at, **self._said, **done, **knows), Timing(**at, **_timing(clock, self._model, self._robot))


def _of_command(command: Command) -> dict[str, Any]:
    """The fields of a record that say what was commanded, and where."""
    objects = command.world.objects
    return {
        "world": command.world.name,
        "command": command.text,
        "noun": command.noun,
        "color": command.color,
        "objects": tuple(ObjectRecord(id=o.id, type=o.type, color=o.color, position=o.position) for o in objects),
        "target": command.target,
    }


def _of_outcome(command: Command, outcome: Outcome, robot: SimulationRobot) -> dict[str, Any]:
    """The fields that say what the robot understood and did."""
    solution, parse = outcome.solution, outcome.parse
    chosen = _chosen(outcome)
    reached = chosen if outcome.arrived and solution is not None else None
    grounded = reached if solution is not None and not solution.inverted else None
    obeyed = reached if (grounded is None) == command.away else None
    return {
        "in_view": outcome.in_view,
        "grounded": grounded,
        "correct": obeyed == command.target,
        "probability": None if chosen is None or solution is None else solution.probability,
        "asked": len(outcome.asked),
        "path_length": robot.path_length,
        "turned": robot.turned,
        "parsed": None if parse.tree is None else ParsedRecord(noun=parse.noun, color=parse.color),
        "seen": tuple(p.id for p in outcome.percepts),
        "chosen": chosen,
        "arrived": outcome.arrived,
        "collisions": robot.collisions,
        "dialogue": tuple((q.text, a.text(q)) for q, a in outcome.asked) or None,
    }


def _of_model(model: GroundingModel, first_words: frozenset[str], met: int) -> dict[str, Any]:
    """The fields that say what the robot knows after the command."""
    return {
        "symbols": {s.word: s.type for s in model.symbols.values() if s.word not in first_words},
        "expected_symbols": float(met),
        "beliefs": model.beliefs_about(first_words),
    }


def _timing(clock: Stopwatch, model: GroundingModel, robot: SimulationRobot) -> dict[str, Any]:
    fitted = model.fitted
    return {
        **{name: clock.seconds[name] for name in PHASES},
        "groundings": clock.counts["ground"],
        "train_steps": 0 if fitted is None else fitted.steps,
        "train_loss": 0.0 if fitted is None else fitted.value,
        "train_rows": 0 if fitted is None else fitted.rows,
        "language_columns": model.features.shape[0],
        "grounding_columns": model.features.shape[1],
        "moving": robot.seconds,
    }


def _chosen(outcome: Outcome) -> str | None:
    """The id of the perceived object that the command was grounded to."""
    obj = None if outcome.solution is None else outcome.solution.object
    return None if obj is None or obj.hypothetical else obj.id
