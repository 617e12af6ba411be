"""A trial: Algorithm 1 over a list of commands, a record for each."""

from __future__ import annotations

import functools
import math
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from dcg_torch.agent.asking import AskingPolicy, truthful
from dcg_torch.agent.command import CommandParser, Look, Outcome, Stopwatch, carry_out
from dcg_torch.agent.explore import Explorer
from dcg_torch.agent.robot import SimulationRobot
from dcg_torch.model import GroundingModel
from dcg_torch.records import Iteration, Kind, ObjectRecord, ParsedRecord, PoseRecord, Timing
from dcg_torch.speaker import Command
from dcg_torch.types import Pose


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

    Args:
        model: freshly trained on the initial training set (lines 1 to 6); it learns in place.
        rng: draws the recogniser's mistakes, if it makes any.
        explorer: makes the explorer of a command; None: the paper's turning in place.
        asking: when to ask back; the speaker answers truthfully. None: never.
    """
    known_types = model.known_types
    first_words = frozenset(model.symbols)
    met = set(known_types)
    for iteration, command in enumerate(commands):
        clock = Stopwatch()
        with clock("load_world"):
            robot.load(command.world, rng=rng)
        before = _Before(robot.pose, _kind(command.noun, first_words, model))
        outcome = carry_out(
            command.text,
            model,
            robot,
            parse=parse,
            spin_step=spin_step,
            explorer=None if explorer is None else explorer(),
            asking=asking,
            listener=truthful(command.target),
            watch=None if watch is None else functools.partial(watch, command),
            stopwatch=clock,
        )
        with clock("train"):
            if outcome.solution is not None:
                model.learn(outcome.solution, outcome.experience(f"{iteration}"))
        met |= {o.type for o in command.world.objects if o.id == command.target}
        said = _of_command(command, known_types, before)
        done = _of_outcome(command, outcome, robot)
        knows = _of_model(model, first_words, len(met))
        at: dict[str, Any] = {"trial": trial, "iteration": iteration}
        yield Iteration(**at, **said, **done, **knows), Timing(**at, **_timing(clock, model, robot))


@dataclass(frozen=True)
class _Before:
    """What was the case when a command was heard: the robot's pose, and what the noun was to it."""

    pose: Pose
    kind: Kind


def _kind(noun: str, first_words: frozenset[str], model: GroundingModel) -> Kind:
    return "known" if noun in first_words else "learned" if noun in model.symbols else "unknown"


def _of_command(command: Command, known_types: tuple[str, ...], before: _Before) -> dict[str, Any]:
    """The fields of a record that were settled when the command was given."""
    start, objects = before.pose, command.world.objects
    return {
        "world": command.world.name,
        "command": command.text,
        "noun": command.noun,
        "color": command.color,
        "robot": PoseRecord(x=start.x, y=start.y, yaw=start.yaw),
        "objects": tuple(ObjectRecord(id=o.id, type=o.type, color=o.color, position=o.position) for o in objects),
        "known_types": known_types,
        "target": command.target,
        "kind": before.kind,
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
        **{name: clock.seconds[name] for name in _TIMED},
        "groundings": clock.counts["ground"],
        "train_steps": 0 if fitted is None else fitted.steps,
        "train_loss": 0.0 if fitted is None else fitted.value,
        "train_rows": 0 if fitted is None else fitted.rows,
        "language_columns": model.features.shape[0],
        "grounding_columns": model.features.shape[1],
        "moving": robot.seconds,
    }


_TIMED = ("load_world", "parse", "perceive", "ground", "explore", "drive", "train")


def _chosen(outcome: Outcome) -> str | None:
    """The id of the perceived object that the command was grounded to."""
    obj = None if outcome.solution is None else outcome.solution.object
    return None if obj is None or obj.hypothetical else obj.id
