"""Run folders as the report reads them: their rows, their times, the settings they were run with.

The rows are what counts: a run that did not finish has no `summary.json` and is reported from what there is.
"""

from __future__ import annotations

import json
import re
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any, TypeVar

from pydantic import BaseModel, ValidationError

from dcg_torch.report.measures import Measures, measure
from dcg_torch.report.seconds import summarise_seconds
from dcg_torch.report.summary import SUMMARY, ReportError, first_error, read_summary, unreadable
from dcg_torch.report.text import printable
from dcg_torch.storage.records import NO_EFFECT, Iteration, Timing
from dcg_torch.storage.untrusted_files import pipe_in, read_yaml

ROWS, TIMINGS, SETTINGS = "iterations.jsonl", "timings.jsonl", "settings.json"
PREDICTIONS = "predictions.jsonl"  # what lies in the folder of `evaluate`, beside a summary of its own
Record = TypeVar("Record", bound=BaseModel)


@dataclass(frozen=True)
class Run:
    """One experiment.

    Attributes:
        folder: where it lies.
        name: of the run; a run without `summary.json` is called unfinished.
        config: its settings, nested; empty where the folder doesn't hold them.
        overrides: what was given on the command line, key -> value; None where the folder doesn't say.
        rows: a line per command.
        seconds: as `summarise_seconds` gives; empty where they were not kept.
        measures: of the rows.
    """

    folder: Path
    name: str
    config: dict[str, Any]
    overrides: dict[str, str] | None
    rows: tuple[Iteration, ...]
    seconds: dict[str, float]
    measures: Measures

    @property
    def seed(self) -> int | None:
        """What the trials were drawn from; None where it is not known."""
        seed = self.config.get("seed")
        return seed if isinstance(seed, int) else None


def load_run(directory: Path) -> Run:
    """Read a run folder.

    Raises:
        ReportError: if it is none, holds no finished command, or one of its files is damaged.
    """
    if (pipe := pipe_in(directory)) is not None:
        raise ReportError(f"{pipe}: this is a pipe; remove it")
    summary = read_summary(directory / SUMMARY) if (directory / SUMMARY).exists() else None
    if summary is None and not (directory / ROWS).exists():
        raise ReportError(f"{directory}: no {SUMMARY} or {ROWS} in it; give the folder of a run or of a sweep")
    rows = read_rows(directory / ROWS)
    if not rows:
        raise ReportError(f"{directory / ROWS}: no finished command in it; run the experiment on")
    if summary is not None:
        name, config = summary.run, summary.config
    else:
        name, config = f"{directory.resolve().name} (unfinished)", _settings(directory)
    timings = [] if summary is not None else read_timings(directory)
    try:
        measures = measure(rows)
        seconds = summarise_seconds(timings) if summary is None else summary.seconds
    except (ValueError, ArithmeticError) as error:
        raise ReportError(f"{directory}: {error}; run the experiment again") from None
    return Run(directory, printable(name), config, given_overrides(directory), tuple(rows), seconds, measures)


def find_runs(directory: Path) -> list[Path]:
    """The run folders at or below `directory`, in the order of their paths, numbers by size.

    A run folder holds a `summary.json`; those of runs that did not finish hold their rows. What `evaluate` left beside
    them is no run.

    Raises:
        ReportError: if `directory` is not a folder, or has no run in it.
    """
    if not directory.is_dir():
        raise ReportError(f"{directory}: no such folder; give the folder of a run or of a sweep")
    found = {path.parent for name in (SUMMARY, ROWS) for path in directory.rglob(name)}
    if not found:
        raise ReportError(f"{directory}: no run in it; give the folder of a run or of a sweep")
    evaluated = {folder for folder in found if (folder / PREDICTIONS).exists() and not (folder / ROWS).exists()}
    if found == evaluated:
        raise ReportError(f"{directory}: evaluations are in it and no run; the figures of one are in its {SUMMARY}")
    return sorted(found - evaluated, key=_natural)


def load_runs(directories: Sequence[Path]) -> list[Run]:
    """All runs at or below the folders, each once.

    Raises:
        ReportError: as `find_runs` and `load_run` do.
    """
    folders = dict.fromkeys(folder for directory in directories for folder in find_runs(directory))
    return [load_run(folder) for folder in folders]


def read_rows(path: Path) -> list[Iteration]:
    """Read an `iterations.jsonl`; a last line cut short by a kill is left out.

    Raises:
        ReportError: if the file is missing, or a line of it is not a row.
    """
    return _read_lines(path, Iteration)


def read_timings(directory: Path) -> list[Timing]:
    """The times of a run folder; empty where they were not kept.

    Raises:
        ReportError: if a line is not one of times.
    """
    path = directory / TIMINGS
    return _read_lines(path, Timing) if path.exists() else []


def _read_lines(path: Path, kind: type[Record]) -> list[Record]:
    try:
        lines = path.read_bytes().split(b"\n")
    except OSError as error:
        raise unreadable(path, error) from None
    records = []
    for number, line in enumerate(lines, 1):
        if not line.strip():
            continue
        try:
            records.append(kind.model_validate_json(line))
        except ValidationError as error:
            if number == len(lines):  # every whole line ends in a newline, so this one was being written
                break
            raise ReportError(f"{path}:{number}: {first_error(error, 'the line')}; mend or remove the line") from None
    return records


def given_overrides(directory: Path) -> dict[str, str] | None:
    """The overrides of a run that its whole sweep does not share, from Hydra's files; None without these files.

    A run that was no part of a sweep shares none. A leading `+` is dropped, a deletion (`~key`) left out.
    """
    listed = _yaml(directory / ".hydra" / "overrides.yaml")
    if not isinstance(listed, list):
        return None
    hydra: Any = _yaml(directory / ".hydra" / "hydra.yaml")
    try:
        shared = set(hydra["hydra"]["job"]["config"]["override_dirname"]["exclude_keys"])
    except (KeyError, TypeError):
        shared = set()
    pairs = (line.lstrip("+").split("=", 1) for line in listed if isinstance(line, str) and "=" in line)
    return {key: value for key, value in pairs if key not in shared}


def varied_settings(directory: Path) -> dict[str, bool | int | float | str]:
    """In what a run may differ from those beside it: its overrides but for `NO_EFFECT` and what its sweep shares.

    Numbers and truth values are read as such, so that they can be sorted and filtered.
    """
    given = given_overrides(directory) or {}
    return {key: _value(text) for key, text in given.items() if key not in NO_EFFECT}


def _value(text: str) -> bool | int | float | str:
    if text.lower() in ("true", "false"):
        return text.lower() == "true"
    for number in (int, float):
        try:
            return number(text)
        except ValueError:
            continue
    return text


def _settings(directory: Path) -> dict[str, Any]:
    try:
        values = json.loads((directory / SETTINGS).read_bytes())
    except (OSError, ValueError, RecursionError):
        return {}
    return values if isinstance(values, dict) else {}


def _yaml(path: Path) -> Any:
    try:
        return read_yaml(path, "settings", ReportError)
    except ReportError:
        return None


def _natural(path: Path) -> list[tuple[int, str]]:
    """A sort key by which "seed=10" comes after "seed=9"."""
    parts = re.split(r"(\d+)", str(path))
    return [(int(part), "") if k % 2 else (-1, part) for k, part in enumerate(parts)]
