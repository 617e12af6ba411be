"""`summary.json`: what a run amounts to, written whole or not at all; and the settings it was run with."""

from __future__ import annotations

import json
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from pydantic import BaseModel, ConfigDict, ValidationError

from dcg_torch.report.measures import Measures
from dcg_torch.storage.atomic_files import write_whole
from dcg_torch.storage.errors import UserError
from dcg_torch.storage.untrusted_files import plain

SUMMARY = "summary.json"
_LONGEST = 200  # characters of what a foreign file makes one say


class ReportError(UserError):
    """A folder or file that the report can't read; the message is one line for the user."""


class Summary(BaseModel):
    """What the report reads back of a `summary.json`; the measures are taken from the rows anew.

    `seconds` are mean seconds per command by phase, and those of the whole run ("wall").
    """

    model_config = ConfigDict(frozen=True, extra="ignore", allow_inf_nan=False)

    run: str
    config: dict[str, Any]
    seconds: dict[str, float]


def write_summary(
    path: Path, run: str, config: Mapping[str, Any], measures: Measures, seconds: Mapping[str, float]
) -> None:
    """Write `summary.json`, replacing an older one in a single step, so that no reader meets half a file.

    Raises:
        ValueError: if a number is not finite, which JSON can't say.
        TypeError: if a value of `config` is not plain JSON.
    """
    values = {"run": run, "config": dict(config), "measures": measures.to_dict(), "seconds": dict(seconds)}
    text = json.dumps(values, indent=1, allow_nan=False, ensure_ascii=False) + "\n"
    write_whole(path, text)


def read_summary(path: Path) -> Summary:
    """Read a `summary.json`.

    Raises:
        ReportError: if it is missing or not one.
    """
    try:
        return Summary.model_validate_json(path.read_bytes())
    except OSError as error:
        raise unreadable(path, error) from None
    except ValidationError as error:
        raise ReportError(f"{path}: {first_error(error, 'the file')}; run the experiment again to rewrite it") from None


def unreadable(path: Path, error: OSError) -> ReportError:
    """What to raise for a file that the machine refuses."""
    return ReportError(f"{path}: can't be read ({error.strerror}); give a run folder that holds it")


def first_error(error: ValidationError, whole: str) -> str:
    """Where and what the first of pydantic's errors is; `whole` names the file or line where it is no field's."""
    first = error.errors(include_url=False, include_input=False)[0]
    return plain(f"{'.'.join(map(str, first['loc'])) or whole}: {first['msg']}", _LONGEST)


def flatten(config: Mapping[str, Any], prefix: str = "") -> dict[str, Any]:
    """Nested mappings as one, with dotted keys."""
    flat: dict[str, Any] = {}
    for key, value in config.items():
        if isinstance(value, Mapping):
            flat |= flatten(value, f"{prefix}{key}.")
        else:
            flat[f"{prefix}{key}"] = value
    return flat
