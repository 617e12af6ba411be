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
* Accuracy per symbol is the least-squares slope of correct (0 or 1) on the number of symbols held before the command,
  pooled over all commands.
"""

from __future__ import annotations

import hashlib
import json
import math
from collections import Counter, defaultdict
from collections.abc import Collection, Iterable, Mapping, Sequence
from dataclasses import asdict, dataclass, replace
from typing import Any, get_args

from pydantic import TypeAdapter

from dcg_torch.records import Iteration, Kind
from dcg_torch.report.causes import CAUSES, error_cause, is_right, names_of_types
from dcg_torch.report.intervals import Estimate, mean_over_trials, slope_over_trials, wilson

KINDS: tuple[Kind, ...] = get_args(Kind)
ARRIVAL_RADIUS = 0.5  # metres; nearer than this to the object the robot need not come
BINS = 10


@dataclass(frozen=True, slots=True)
class KindMeasures:
    """Commands whose word was known, unknown or learned when heard; `accuracy` is None if there were none."""

    n: int
    correct: int
    accuracy: Estimate | None


@dataclass(frozen=True, slots=True)
class Bin:
    """Groundings with a probability in [low, high): their number, mean probability and share that was right."""

    low: float
    high: float
    n: int
    probability: float
    accuracy: float


@dataclass(frozen=True, slots=True)
class Calibration:
    """Does the probability mean what it says? `error` is the expected calibration error, None without probabilities.

    `bins` has only the bins that hold something; `without` counts the commands that ended without a probability.
    """

    error: float | None
    bins: tuple[Bin, ...]
    n: int
    without: int


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
    path_efficiency: float
    probability: float | None
    causes: dict[str, int]


@dataclass(frozen=True, slots=True)
class Measures:
    """What a run amounts to; see the module for the definitions.

    `fingerprint` is equal for two runs exactly when they heard the same commands in the same worlds, in which case
    their `trial_accuracy` may be compared pair by pair. `types` are those a robot could come to name. Symbols are
    counted at the end of a trial; `wrong_symbols` is their number per trial, `wrong_symbols_total` over all.
    `out_of_view` is the share of objects outside the first view, pooled over commands; `asked`, `path_length`
    (metres), `turned` (radians) and `collisions` are means per command; `path_efficiency` is success weighted by path
    length: 0 for a failure, otherwise the straight way to within 0.5 m of the object over the way driven.
    """

    fingerprint: str
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
    wrong_symbols_total: int
    accuracy_per_symbol: Estimate | None
    out_of_view: float | None
    asked: float
    path_length: float
    turned: float
    path_efficiency: float
    collisions: float
    calibration: Calibration
    causes: dict[str, int]

    def to_dict(self) -> dict[str, Any]:
        """Plain values for JSON; `from_dict` reads them back."""
        return asdict(self)

    @staticmethod
    def from_dict(values: Mapping[str, Any]) -> Measures:
        """The inverse of `to_dict`; further keys are ignored.

        Raises:
            pydantic.ValidationError: if a field is missing or has another type.
        """
        return TypeAdapter(Measures).validate_python(values)


@dataclass(frozen=True, slots=True)
class _Step:
    """A row with what is derived from it and the row before it in its trial."""

    row: Iteration
    before: int  # symbols right before the command
    right: int  # and after it
    wrong: int
    cause: str | None


def measure(rows: Sequence[Iteration], types: Collection[str] | None = None) -> Measures:
    """Sum a run up. Rows may come in any order, and trials may be unfinished.

    Args:
        rows: one per trial and iteration.
        types: the types a robot could come to name; by default all that occur in the rows' worlds.

    Raises:
        ValueError: without rows, if a pair of trial and iteration comes twice, or if a target is not in its world.
    """
    if not rows:
        raise ValueError("no commands to measure: the run has no finished iteration")
    trials = _by_trial(rows)
    names = names_of_types(rows)
    nameable = tuple(sorted({o.type for r in rows for o in r.objects} if types is None else types))
    every = frozenset(nameable).union(*(r.known_types for r in rows))
    steps = [_steps(trial, names) for trial in trials]
    flat = [step for trial in steps for step in trial]
    last = [trial[-1] for trial in steps]
    at: defaultdict[int, list[_Step]] = defaultdict(list)
    for step in flat:
        at[step.row.iteration].append(step)
    correct = sum(r.correct for r in rows)
    finished = sum(step.right == len(every) for step in last)
    return Measures(
        fingerprint=_fingerprint(trials),
        trials=len(trials),
        iterations=len(at),
        commands=len(rows),
        correct=correct,
        types=tuple(sorted(every)),
        accuracy=_accuracy(trials, correct, len(rows)),
        trial_accuracy=tuple(_mean(float(r.correct) for r in trial) for trial in trials),
        by_iteration=tuple(_iteration(i, at[i], len(every)) for i in sorted(at)),
        by_kind=_kinds(rows),
        initial_symbols=_mean(len(trial[0].known_types) for trial in trials),
        correct_symbols=_clip(mean_over_trials([step.right for step in last]), len(every)),
        expected_symbols=_mean(step.row.expected_symbols for step in last),
        all_symbols=wilson(finished, len(last)),
        wrong_symbols=_mean(step.wrong for step in last),
        wrong_symbols_total=sum(step.wrong for step in last),
        accuracy_per_symbol=slope_over_trials(
            [([step.before for step in trial], [float(step.row.correct) for step in trial]) for trial in steps]
        ),
        out_of_view=_out_of_view(rows),
        asked=_mean(r.asked for r in rows),
        path_length=_mean(r.path_length for r in rows),
        turned=_mean(r.turned for r in rows),
        path_efficiency=_mean(path_efficiency(r) for r in rows),
        collisions=_mean(r.collisions for r in rows),
        calibration=calibrate(rows),
        causes=_count_causes(flat),
    )


def calibrate(rows: Iterable[Iteration], bins: int = BINS) -> Calibration:
    """Reliability of `probability` in `bins` bins of equal width, and the expected calibration error.

    The error is the mean over groundings of |share right - mean probability| of the bin each falls in.
    """
    cells: defaultdict[int, list[tuple[float, bool]]] = defaultdict(list)
    without = n = 0
    for row in rows:
        if row.probability is None:
            without += 1
            continue
        n += 1
        cells[min(max(int(row.probability * bins), 0), bins - 1)].append((row.probability, row.correct))
    filled = tuple(
        Bin(k / bins, (k + 1) / bins, len(c), _mean(p for p, _ in c), _mean(float(right) for _, right in c))
        for k, c in sorted(cells.items())
    )
    error = math.fsum(b.n * abs(b.accuracy - b.probability) for b in filled) / n if n else None
    return Calibration(error, filled, n, without)


def path_efficiency(row: Iteration) -> float:
    """Success weighted by path length (Anderson et al. 2018, "On Evaluation of Embodied Navigation Agents").

    The shortest way is taken to be the straight one to within `ARRIVAL_RADIUS` of the object meant, obstacles aside.
    """
    if not row.correct:
        return 0.0
    target = next(o for o in row.objects if o.id == row.target)
    distance = math.dist(target.position, (row.robot.x, row.robot.y))
    straight = max(0.0, distance - ARRIVAL_RADIUS)
    longest = max(row.path_length, straight)
    return straight / longest if longest > 0 else 1.0


def paired_difference(a: Measures, b: Measures) -> Estimate | None:
    """Accuracy of `b` minus that of `a`, trial by trial; None unless both heard the same commands."""
    if a.fingerprint != b.fingerprint:
        return None
    return mean_over_trials([y - x for x, y in zip(a.trial_accuracy, b.trial_accuracy, strict=True)])


def _by_trial(rows: Iterable[Iteration]) -> list[list[Iteration]]:
    trials: defaultdict[int, dict[int, Iteration]] = defaultdict(dict)
    for row in rows:
        if row.iteration in trials[row.trial]:
            raise ValueError(f"trial {row.trial}, iteration {row.iteration} comes twice; keep one row of each")
        trials[row.trial][row.iteration] = row
    return [[trial[i] for i in sorted(trial)] for _, trial in sorted(trials.items())]


def _steps(trial: Sequence[Iteration], names: Mapping[str, frozenset[str]]) -> list[_Step]:
    steps: list[_Step] = []
    held: Mapping[str, str] = {}
    before = len(set(trial[0].known_types))
    for row in trial:
        right = {meaning for word, meaning in row.symbols.items() if is_right(word, meaning, names)}
        wrong = sum(not is_right(word, meaning, names) for word, meaning in row.symbols.items())
        after = len(right.union(row.known_types))
        steps.append(_Step(row, before, after, wrong, error_cause(row, held, names)))
        held, before = row.symbols, after
    return steps


def _iteration(index: int, steps: Sequence[_Step], every: int) -> IterationMeasures:
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
        out_of_view=_out_of_view(rows),
        asked=_mean(r.asked for r in rows),
        path_length=_mean(r.path_length for r in rows),
        turned=_mean(r.turned for r in rows),
        path_efficiency=_mean(path_efficiency(r) for r in rows),
        probability=_mean(probabilities) if probabilities else None,
        causes=_count_causes(steps),
    )


def _accuracy(trials: Sequence[Sequence[Iteration]], correct: int, n: int) -> Estimate:
    """Mean of the trials' means. Where trials can't tell the spread (one, or all alike), Wilson over commands."""
    estimate = mean_over_trials([_mean(float(r.correct) for r in trial) for trial in trials])
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


def _count_causes(steps: Iterable[_Step]) -> dict[str, int]:
    counts = Counter(step.cause for step in steps)
    return {cause: counts[cause] for cause in CAUSES}


def _out_of_view(rows: Iterable[Iteration]) -> float | None:
    objects = seen = 0
    for row in rows:
        objects += len(row.objects)
        seen += len(row.in_view)
    return 1 - seen / objects if objects else None


def _fingerprint(trials: Iterable[Iterable[Iteration]]) -> str:
    heard = [(r.trial, r.iteration, r.world, r.command, r.target) for trial in trials for r in trial]
    return hashlib.sha256(json.dumps(heard).encode()).hexdigest()[:16]


def _mean(values: Iterable[float]) -> float:
    listed = list(values)
    return math.fsum(listed) / len(listed)
