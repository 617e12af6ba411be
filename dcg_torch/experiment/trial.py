"""A trial: Algorithm 1 over a list of commands, a record for each."""

from __future__ import annotations

import functools
import math
from collections.abc import Callable, Iterator, Sequence

import numpy as np

from dcg_torch.agent.asking import AskingPolicy, truthful
from dcg_torch.agent.command import CommandParser, Look, Outcome, Stopwatch, carry_out
from dcg_torch.agent.explore import Explorer
from dcg_torch.agent.robot import SimulationRobot
from dcg_torch.model import GroundingModel
from dcg_torch.records import Iteration, Kind, ObjectRecord, ParsedRecord, PoseRecord, Timing
from dcg_torch.speaker import Command


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
        start = robot.pose
        kind: Kind = (
            "known" if command.noun in first_words else "learned" if command.noun in model.symbols else "unknown"
        )
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
        fitted = model.fitted
        met |= {o.type for o in command.world.objects if o.id == command.target}
        chosen = _chosen(outcome)
        inverted = outcome.solution is not None and outcome.solution.inverted
        grounded = chosen if outcome.arrived and not inverted else None
        yield (
            Iteration(
                trial=trial,
                iteration=iteration,
                world=command.world.name,
                command=command.text,
                noun=command.noun,
                color=command.color,
                robot=PoseRecord(x=start.x, y=start.y, yaw=start.yaw),
                objects=tuple(
                    ObjectRecord(id=o.id, type=o.type, color=o.color, position=o.position)
                    for o in command.world.objects
                ),
                in_view=outcome.in_view,
                known_types=known_types,
                target=command.target,
                grounded=grounded,
                # Of an order to keep away, `arrived` says that the robot has left the object's surroundings.
                correct=bool(outcome.arrived) and chosen == command.target,
                kind=kind,
                probability=None if chosen is None or outcome.solution is None else outcome.solution.probability,
                asked=len(outcome.asked),
                symbols={s.word: s.type for s in model.symbols.values() if s.word not in first_words},
                path_length=robot.path_length,
                turned=robot.turned,
                parsed=None
                if outcome.parse.tree is None
                else ParsedRecord(noun=outcome.parse.noun, color=outcome.parse.color),
                seen=tuple(p.id for p in outcome.percepts),
                chosen=chosen,
                arrived=outcome.arrived,
                collisions=robot.collisions,
                expected_symbols=float(len(met)),
                beliefs=model.beliefs_about(first_words),
                dialogue=tuple((q.text, a.text(q)) for q, a in outcome.asked) or None,
            ),
            Timing(
                trial=trial,
                iteration=iteration,
                **{name: clock.seconds[name] for name in _TIMED},
                groundings=clock.counts["ground"],
                train_steps=0 if fitted is None else fitted.steps,
                train_loss=0.0 if fitted is None else fitted.value,
                train_rows=0 if fitted is None else fitted.rows,
                language_columns=model.features.shape[0],
                grounding_columns=model.features.shape[1],
                moving=robot.seconds,
            ),
        )


_TIMED = ("load_world", "parse", "perceive", "ground", "explore", "drive", "train")


def _chosen(outcome: Outcome) -> str | None:
    """The id of the perceived object that the command was grounded to."""
    obj = None if outcome.solution is None else outcome.solution.object
    return None if obj is None or obj.hypothetical else obj.id
