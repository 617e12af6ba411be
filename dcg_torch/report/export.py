"""Runs as comma-separated values: a row a run, for pandas, R or a spreadsheet.

`COLUMNS` come first and are always there. After them stands a column `setting.KEY` for every setting of the runs, in
the order of the alphabet: KEY is what an override is called ("setting.model.name", "setting.seed"). What a run does
not have is an empty cell. Shares lie between 0 and 1; times are seconds, lengths metres, turns radians.
"""

from __future__ import annotations

import csv
import io
import json
from collections.abc import Callable, Mapping, Sequence
from typing import Any

from dcg_torch.report.configurations import configurations
from dcg_torch.report.intervals import Estimate
from dcg_torch.report.measures import KINDS
from dcg_torch.report.runs import Run
from dcg_torch.report.summary import flatten


def _interval(name: str, of: Callable[[Run], Estimate | None]) -> dict[str, Callable[[Run], Any]]:
    """Three columns: the value and the bounds of its 95 % interval."""

    def part(attribute: str) -> Callable[[Run], Any]:
        return lambda run: getattr(of(run), attribute, None)

    return {name: part("value"), f"{name}_low": part("low"), f"{name}_high": part("high")}


def _kind_accuracy(kind: str) -> Callable[[Run], Any]:
    return lambda run: getattr(run.measures.by_kind[kind].accuracy, "value", None)


_VALUES: Mapping[str, Callable[[Run], Any]] = {
    "seed": lambda run: run.seed,
    "trials": lambda run: run.measures.trials,
    "iterations": lambda run: run.measures.iterations,
    "commands": lambda run: run.measures.commands,
    "correct": lambda run: run.measures.correct,
    **_interval("accuracy", lambda run: run.measures.accuracy),
    "accuracy_first": lambda run: run.measures.by_iteration[0].accuracy.value,
    "accuracy_last": lambda run: run.measures.by_iteration[-1].accuracy.value,
    **{f"accuracy_{kind}": _kind_accuracy(kind) for kind in KINDS},
    "types": lambda run: len(run.measures.types),
    **_interval("symbols_right", lambda run: run.measures.correct_symbols),
    "symbols_expected": lambda run: run.measures.expected_symbols,
    "symbols_wrong": lambda run: run.measures.wrong_symbols,
    **_interval("all_symbols_right", lambda run: run.measures.all_symbols),
    **_interval("accuracy_per_symbol", lambda run: run.measures.accuracy_per_symbol),
    "questions_per_command": lambda run: run.measures.asked,
    "calibration_error": lambda run: run.measures.calibration.error,
    "out_of_view": lambda run: run.measures.out_of_view,
    "path_length": lambda run: run.measures.path_length,
    "turned": lambda run: run.measures.turned,
    "path_efficiency": lambda run: run.measures.path_efficiency,
    "collisions": lambda run: run.measures.collisions,
    "seconds_per_command": lambda run: run.seconds.get("command"),
    "wall_seconds": lambda run: run.seconds.get("wall"),
}
COLUMNS = ("run", "folder", "configuration", *_VALUES)
"""The columns that are always there."""


def to_csv(runs: Sequence[Run]) -> str:
    """The text of the CSV file (RFC 4180 with plain newlines)."""
    names = {run.folder: found.name for found in configurations(runs) for run in found.runs}
    settings = [flatten(run.config) for run in runs]
    keys = sorted(set().union(*settings))
    buffer = io.StringIO()
    writer = csv.writer(buffer, lineterminator="\n")
    writer.writerow([*COLUMNS, *(f"setting.{key}" for key in keys)])
    for run, given in zip(runs, settings, strict=True):
        values = [run.name, str(run.folder), names[run.folder], *(value(run) for value in _VALUES.values())]
        writer.writerow(map(_cell, [*values, *(given.get(key) for key in keys)]))
    return buffer.getvalue()


def _cell(value: Any) -> Any:
    if value is None:
        return ""
    return value if isinstance(value, str | int | float) and not isinstance(value, bool) else json.dumps(value)
