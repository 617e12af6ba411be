"""Rows in the order of their trials, each with what follows from it and from the row before it."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass

from dcg_torch.report.causes import error_cause, is_right, names_of_types
from dcg_torch.storage.records import Iteration


@dataclass(frozen=True, slots=True)
class Step:
    """A row; the right symbols held before and after the command, the wrong ones after it; why it went wrong."""

    row: Iteration
    before: int
    right: int
    wrong: int
    cause: str | None


def steps_of(rows: Sequence[Iteration]) -> list[list[Step]]:
    """The steps of each trial, trials and iterations in order.

    Args:
        rows: in any order; trials may be unfinished.

    Raises:
        ValueError: if a pair of trial and iteration comes twice, or if a target is not in its world.
    """
    names = names_of_types(rows)
    return [_steps(trial, names) for trial in _by_trial(rows)]


def _by_trial(rows: Iterable[Iteration]) -> list[list[Iteration]]:
    trials: defaultdict[int, dict[int, Iteration]] = defaultdict(dict)
    for row in rows:
        if row.iteration in trials[row.trial]:
            raise ValueError(f"trial {row.trial}, iteration {row.iteration} comes twice; keep one row of each")
        trials[row.trial][row.iteration] = row
    return [[trial[i] for i in sorted(trial)] for _, trial in sorted(trials.items())]


def _steps(trial: Sequence[Iteration], names: Mapping[str, frozenset[str]]) -> list[Step]:
    steps: list[Step] = []
    held: Mapping[str, str] = {}
    before = len(set(trial[0].known_types))
    for row in trial:
        right = {meaning for word, meaning in row.symbols.items() if is_right(word, meaning, names)}
        wrong = sum(not is_right(word, meaning, names) for word, meaning in row.symbols.items())
        after = len(right.union(row.known_types))
        steps.append(Step(row, before, after, wrong, error_cause(row, held, names)))
        held, before = row.symbols, after
    return steps
