"""Rows of `iterations.jsonl` -> `Measures`: the numbers of the paper's Section IV, and those beyond it.

Definitions, where the paper leaves room:

* Accuracy over all commands has the trial as its unit: the mean of the trials' means, with Student's interval over
  trials. Commands of one trial share what was learned, so they are not independent. Accuracy at one iteration has one
  command per trial and Wilson's interval.
* Symbols count types that the robot has a right name for: those known at the start and those that a learned word
  names rightly. A word is right when it is the type's own name or is said of that type by the run's speaker (of
  several types, the one it is said of most).
* Shares of known, unknown and learned are taken among the correct commands, by what the target's word was to the
  robot when it heard it (Figs. 7 and 9f).
* An order to keep away is obeyed, and its row correct, when the robot left the surroundings of the object meant. Such
  a row has no object that the robot went to. It counts as correct like all others; only path efficiency leaves it
  out, since no way there could be the shortest.
* Accuracy per symbol is the least-squares slope of correct (0 or 1) on the number of symbols held before the command,
  pooled over all commands.
"""

from __future__ import annotations

import math
from collections import Counter, defaultdict
from collections.abc import Iterable, Sequence
from dataclasses import asdict, dataclass, replace
from typing import Any, get_args

from dcg_torch.report.calibration import Calibration, calibrate
from dcg_torch.report.causes import CAUSES
from dcg_torch.report.intervals import Estimate, mean_over_trials, slope_over_trials, wilson
from dcg_torch.report.steps import Step, steps_of
from dcg_torch.storage.records import Iteration, Kind

KINDS: tuple[Kind, ...] = get_args(Kind)
ARRIVAL_RADIUS = 0.5  # metres; nearer than this to the object the robot need not come


@dataclass(frozen=True, slots=True)
class KindMeasures:
    """Commands whose word was known, unknown or learned when heard; `accuracy` is None if there were none."""

    n: int
    correct: int
    accuracy: Estimate | None


@dataclass(frozen=True, slots=True)
class IterationMeasures:
    """One iteration over all trials. Symbols are those held after the command; lengths in metres, turns in radians.

    `shares` is empty when nothing was correct, `causes` counts the wrong ones, `out_of_view` is None without objects.
    """

    iteration: int
    n: int
    correct: int
    accuracy: Estimate
    kinds: dict[str, KindMeasures]
    shares: dict[str, float]
    correct_symbols: Estimate
    expected_symbols: float
    wrong_symbols: float
    all_symbols: float
    out_of_view: float | None
    asked: float
    path_length: float
    turned: float
    path_efficiency: float | None
    probability: float | None
    causes: dict[str, int]


@dataclass(frozen=True, slots=True)
class Measures:
    """What a run amounts to; see the module for the definitions.

    `types` are those a robot could come to name. Symbols are counted at the end of a trial, and are means over trials.
    `out_of_view` is the share of objects outside the first view, pooled over commands; `asked`, `path_length`
    (metres), `turned` (radians) and `collisions` are means per command; `path_efficiency` is success weighted by path
    length: 0 for a failure, otherwise the straight way to within 0.5 m of the object over the way driven; None where
    all commands were orders to keep away.
    """

    trials: int
    iterations: int
    commands: int
    correct: int
    types: tuple[str, ...]
    accuracy: Estimate
    trial_accuracy: tuple[float, ...]
    by_iteration: tuple[IterationMeasures, ...]
    by_kind: dict[str, KindMeasures]
    initial_symbols: float
    correct_symbols: Estimate
    expected_symbols: float
    all_symbols: Estimate
    wrong_symbols: float
    accuracy_per_symbol: Estimate | None
    out_of_view: float | None
    asked: float
    path_length: float
    turned: float
    path_efficiency: float | None
    collisions: float
    calibration: Calibration
    causes: dict[str, int]

    def to_dict(self) -> dict[str, Any]:
        """Plain values for JSON."""
        return asdict(self)


def measure(rows: Sequence[Iteration]) -> Measures:
    """Sum a run up. Rows may come in any order, and trials may be unfinished.

    Args:
        rows: one per trial and iteration.

    Raises:
        ValueError: without rows, if a pair of trial and iteration comes twice, if a target is not in its world, or if
            a probability is none.
    """
    if not rows:
        raise ValueError("no commands to measure: the run has no finished iteration")
    trials = steps_of(rows)
    every = frozenset(o.type for r in rows for o in r.objects).union(*(r.known_types for r in rows))
    last = [trial[-1] for trial in trials]
    flat = [step for trial in trials for step in trial]
    at: defaultdict[int, list[Step]] = defaultdict(list)
    for step in flat:
        at[step.row.iteration].append(step)
    accuracies = tuple(_mean(float(step.row.correct) for step in trial) for trial in trials)
    return Measures(
        trials=len(trials),
        iterations=len(at),
        commands=len(rows),
        correct=sum(r.correct for r in rows),
        types=tuple(sorted(every)),
        accuracy=_accuracy(accuracies, sum(r.correct for r in rows), len(rows)),
        trial_accuracy=accuracies,
        by_iteration=tuple(_iteration(i, at[i], len(every)) for i in sorted(at)),
        by_kind=_kinds(rows),
        initial_symbols=_mean(len(trial[0].row.known_types) for trial in trials),
        correct_symbols=_clip(mean_over_trials([step.right for step in last]), len(every)),
        expected_symbols=_mean(step.row.expected_symbols for step in last),
        all_symbols=wilson(sum(step.right == len(every) for step in last), len(last)),
        wrong_symbols=_mean(step.wrong for step in last),
        accuracy_per_symbol=slope_over_trials(
            [([step.before for step in trial], [float(step.row.correct) for step in trial]) for trial in trials]
        ),
        calibration=calibrate([r.probability for r in rows], [r.correct for r in rows]),
        causes=_count_causes(flat),
        collisions=_mean(r.collisions for r in rows),
        **_effort(rows),
    )


def path_efficiency(row: Iteration) -> float | None:
    """Success weighted by path length (Anderson et al. 2018, "On Evaluation of Embodied Navigation Agents").

    The shortest way is taken to be the straight one to within `ARRIVAL_RADIUS` of the object meant, obstacles aside.
    None for an order to keep away that was obeyed.
    """
    if not row.correct:
        return 0.0
    if row.grounded is None:
        return None
    target = next(o for o in row.objects if o.id == row.target)
    distance = math.dist(target.position, (row.robot.x, row.robot.y))
    straight = max(0.0, distance - ARRIVAL_RADIUS)
    longest = max(row.path_length, straight)
    return straight / longest if longest > 0 else 1.0


def _iteration(index: int, steps: Sequence[Step], every: int) -> IterationMeasures:
    rows = [step.row for step in steps]
    correct = sum(r.correct for r in rows)
    kinds = _kinds(rows)
    probabilities = [r.probability for r in rows if r.probability is not None]
    return IterationMeasures(
        iteration=index,
        n=len(rows),
        correct=correct,
        accuracy=wilson(correct, len(rows)),
        kinds=kinds,
        shares={kind: m.correct / correct for kind, m in kinds.items()} if correct else {},
        correct_symbols=_clip(mean_over_trials([step.right for step in steps]), every),
        expected_symbols=_mean(r.expected_symbols for r in rows),
        wrong_symbols=_mean(step.wrong for step in steps),
        all_symbols=_mean(float(step.right == every) for step in steps),
        probability=_mean(probabilities) if probabilities else None,
        causes=_count_causes(steps),
        **_effort(rows),
    )


def _effort(rows: Sequence[Iteration]) -> dict[str, Any]:
    """What a command costs: questions, metres, radians; and how much of its world is out of view."""
    efficiencies = [e for e in map(path_efficiency, rows) if e is not None]
    return {
        "out_of_view": _out_of_view(rows),
        "asked": _mean(r.asked for r in rows),
        "path_length": _mean(r.path_length for r in rows),
        "turned": _mean(r.turned for r in rows),
        "path_efficiency": _mean(efficiencies) if efficiencies else None,
    }


def _accuracy(trials: Sequence[float], correct: int, n: int) -> Estimate:
    """Mean of the trials' means. Where trials can't tell the spread (one, or all alike), Wilson over commands."""
    estimate = mean_over_trials(trials)
    if estimate.low is None or estimate.high is None or estimate.low == estimate.high:
        return replace(wilson(correct, n), value=estimate.value)
    return _clip(estimate, 1)


def _clip(estimate: Estimate, most: float) -> Estimate:
    """Student's interval knows no bounds; ours lie in [0, most]."""
    if estimate.low is None or estimate.high is None:
        return estimate
    return Estimate(estimate.value, max(0.0, estimate.low), min(float(most), estimate.high))


def _kinds(rows: Sequence[Iteration]) -> dict[str, KindMeasures]:
    result = {}
    for kind in KINDS:
        right = [r.correct for r in rows if r.kind == kind]
        n, correct = len(right), sum(right)
        result[str(kind)] = KindMeasures(n, correct, wilson(correct, n) if n else None)
    return result


def _count_causes(steps: Iterable[Step]) -> dict[str, int]:
    counts = Counter(step.cause for step in steps)
    return {cause: counts[cause] for cause in CAUSES}


def _out_of_view(rows: Iterable[Iteration]) -> float | None:
    objects = seen = 0
    for row in rows:
        objects += len(row.objects)
        seen += len(row.in_view)
    return 1 - seen / objects if objects else None


def _mean(values: Iterable[float]) -> float:
    listed = list(values)
    return math.fsum(listed) / len(listed)
