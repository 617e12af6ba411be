"""`summary.json`: written whole or not at all, and found and read back for tables."""

from __future__ import annotations

import json
import os
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import yaml
from pydantic import BaseModel, ConfigDict, ValidationError

from dcg_torch.errors import UserError
from dcg_torch.records import Iteration
from dcg_torch.report.measures import Measures, measure

SUMMARY = "summary.json"
ROWS = "iterations.jsonl"


class ReportError(UserError):
    """A folder or file that the report can't read; the message is one line for the user."""


class Summary(BaseModel):
    """A run's summary. `seconds` are mean seconds per command by phase and whatever else was timed ("wall")."""

    model_config = ConfigDict(frozen=True, extra="allow")

    run: str
    config: dict[str, Any]
    measures: Measures
    seconds: dict[str, float]


def write_summary(
    path: Path, run: str, config: Mapping[str, Any], measures: Measures, seconds: Mapping[str, float], **further: Any
) -> None:
    """Write `summary.json`, replacing an older one in a single step, so that no reader meets half a file.

    Raises:
        ValueError: if a number is not finite, which JSON can't say.
        TypeError: if a value of `config` or `further` is not plain JSON.
    """
    values = {"run": run, "config": dict(config), "measures": measures.to_dict(), "seconds": dict(seconds), **further}
    text = json.dumps(values, indent=1, allow_nan=False, ensure_ascii=False) + "\n"
    path.parent.mkdir(parents=True, exist_ok=True)
    temporary = path.with_name(f".{path.name}.{os.getpid()}.tmp")
    try:
        temporary.write_text(text, encoding="utf-8")
        os.replace(temporary, path)
    finally:
        temporary.unlink(missing_ok=True)


def read_summary(path: Path) -> Summary:
    """Read a `summary.json`.

    Raises:
        ReportError: if it is missing or not one.
    """
    try:
        return Summary.model_validate_json(path.read_bytes())
    except OSError as error:
        raise ReportError(f"{path}: can't be read ({error.strerror}); give a run folder that holds it") from None
    except ValidationError as error:
        first = error.errors()[0]
        where = ".".join(map(str, first["loc"])) or "the file"
        raise ReportError(f"{path}: {where}: {first['msg']}; run the experiment again to rewrite it") from None


def read_rows(path: Path) -> list[Iteration]:
    """Read an `iterations.jsonl`; a last line cut short by a kill is left out.

    Raises:
        ReportError: if the file is missing, or a line of it is not a row.
    """
    try:
        lines = path.read_text(encoding="utf-8").split("\n")
    except OSError as error:
        raise ReportError(f"{path}: can't be read ({error.strerror}); give a run folder that holds it") from None
    rows = []
    for number, line in enumerate(lines, 1):
        if not line.strip():
            continue
        try:
            rows.append(Iteration.model_validate_json(line))
        except ValidationError as error:
            if number == len(lines):  # every whole line ends in a newline, so this one was being written
                break
            first = error.errors()[0]
            where = ".".join(map(str, first["loc"])) or "the line"
            raise ReportError(f"{path}:{number}: {where}: {first['msg']}; mend or remove the line") from None
    return rows


def load_run(directory: Path) -> Summary:
    """The summary of a run folder, or one made from the rows of a run that did not finish.

    Raises:
        ReportError: if the folder holds neither, or they are broken.
    """
    if (directory / SUMMARY).is_file():
        return read_summary(directory / SUMMARY)
    if not (directory / ROWS).is_file():
        raise ReportError(f"{directory}: no {SUMMARY} or {ROWS} in it; give the folder of a run or of a sweep")
    rows = read_rows(directory / ROWS)
    if not rows:
        raise ReportError(f"{directory / ROWS}: no finished command in it; run the experiment on")
    return Summary(run=f"{directory.name} (unfinished)", config={}, measures=measure(rows), seconds={})


def find_runs(directory: Path) -> list[Path]:
    """The run folders at or below `directory`, in the order of their paths: those that hold a `summary.json`.

    Raises:
        ReportError: if `directory` is not a folder.
    """
    if not directory.is_dir():
        raise ReportError(f"{directory}: no such folder; give the folder of a run or of a sweep")
    return sorted(path.parent for path in directory.rglob(SUMMARY))


def distinguish(runs: Mapping[Path, Summary]) -> list[str]:
    """What tells each run from the others, as overrides: "model=dcg seed=1".

    Hydra's own list of overrides where every folder has one and they differ, otherwise the values of the saved
    configuration that are not the same in all runs.
    """
    overrides = [_overrides(folder) for folder in runs]
    if all(o is not None for o in overrides):
        settings = [dict(line.split("=", 1) for line in o or [] if "=" in line) for o in overrides]
        told = _differences(settings)
        if any(told):
            return told
    return _differences([flatten(summary.config) for summary in runs.values()])


def flatten(config: Mapping[str, Any], prefix: str = "") -> dict[str, Any]:
    """Nested mappings as one, with dotted keys."""
    flat: dict[str, Any] = {}
    for key, value in config.items():
        if isinstance(value, Mapping):
            flat |= flatten(value, f"{prefix}{key}.")
        else:
            flat[f"{prefix}{key}"] = value
    return flat


def _differences(settings: Sequence[Mapping[str, Any]]) -> list[str]:
    keys = list(dict.fromkeys(key for setting in settings for key in setting))
    differing = [key for key in keys if len({repr(setting.get(key)) for setting in settings}) > 1]
    return [" ".join(f"{key}={setting[key]}" for key in differing if key in setting) for setting in settings]


def _overrides(folder: Path) -> list[str] | None:
    try:
        listed = yaml.safe_load((folder / ".hydra" / "overrides.yaml").read_text(encoding="utf-8"))
    except (OSError, yaml.YAMLError):
        return None
    return [str(line) for line in listed] if isinstance(listed, list) else None
