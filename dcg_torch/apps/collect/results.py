"""What people wrote, as rows: from Mechanical Turk's batch results, from a CSV of ours, or from a database of ours."""

from __future__ import annotations

import contextlib
import csv
import io
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from dcg_torch.apps.collect.database import read_rows, sqlite_url
from dcg_torch.apps.collect.tasks import CollectError
from dcg_torch.storage.untrusted_files import at_home, misspelt, plain, read_json, read_text

TURK = {"person": "WorkerId", "world": "Input.world", "object": "Input.object", "text": "Answer.command"}
OURS = {"person": "person", "world": "world", "object": "object", "text": "text"}
_STATUS, _REJECT, _ASSIGNMENT, _TASK_ANSWERS = "AssignmentStatus", "Reject", "AssignmentId", "Answer.taskAnswers"
_SQLITE = b"SQLite format 3\0"


@dataclass(frozen=True)
class Row:
    """One answer; `line` is its line in the file, or its number in the database."""

    line: int
    person: str
    world: str
    object: str
    text: str
    rejected: bool = False
    assignment: str | None = None


def read_results(source: str) -> list[Row]:
    """The rows of a CSV file, an SQLite file, or a database by its URL.

    Raises:
        CollectError: it is none of these, or a column is missing.
    """
    path = at_home(source)
    if "://" not in source and not _is_sqlite(path):
        return list(_csv_rows(path, read_text(path, "file of results", CollectError, "utf-8-sig")))
    if (file := source.removeprefix("sqlite:///")) != source and not Path(file).is_file():
        raise CollectError(f"{source}: there is no file {file}; give the one that serve wrote")  # SQLite would make one
    url = source if "://" in source else sqlite_url(path)
    return [Row(w.id, w.person, w.world, w.object, w.text) for w in read_rows(url)]


def _is_sqlite(path: Path) -> bool:
    with contextlib.suppress(OSError), path.open("rb") as file:
        return file.read(len(_SQLITE)) == _SQLITE
    return False


def _csv_rows(path: Path, text: str) -> Iterator[Row]:
    reader = csv.reader(io.StringIO(text, newline=""))
    try:
        header = [name.strip() for name in next(reader, [])]
        columns = _columns(path, header)
        before = reader.line_num
        for cells in reader:
            if any(cell.strip() for cell in cells):
                yield _row(before + 1, dict(zip(header, cells, strict=False)), columns)
            before = reader.line_num
    except csv.Error as error:
        raise CollectError(f"{path}, line {reader.line_num}: not readable as CSV: {plain(str(error), 120)}") from None


def _columns(path: Path, header: Sequence[str]) -> Mapping[str, str]:
    """Where what a row says stands."""
    turk = any(name.startswith(("Input.", "Answer.")) or name == TURK["person"] for name in header)
    wanted = dict(TURK if turk else OURS)
    if turk and wanted["text"] not in header and _TASK_ANSWERS in header:
        wanted["text"] = _TASK_ANSWERS
    for name in wanted.values():
        if name not in header:
            near = next((given for given in header if misspelt(given, (name,)) or given.lower() == name.lower()), None)
            mend = (
                f"{plain(near)} must be it: rename it" if near else f"it has {plain(', '.join(header), 200) or 'none'}"
            )
            raise CollectError(f"{path}: there is no column {name}; {mend}")
    return wanted


def _row(line: int, cells: Mapping[str, str], columns: Mapping[str, str]) -> Row:
    said = {what: cells.get(name, "").strip() for what, name in columns.items()}
    if columns["text"] == _TASK_ANSWERS:
        said["text"] = _command_of(said["text"])
    rejected = cells.get(_STATUS, "").strip().lower() == "rejected" or bool(cells.get(_REJECT, "").strip())
    return Row(line, **said, rejected=rejected, assignment=cells.get(_ASSIGNMENT) or None)


def _command_of(answers: str) -> str:
    """The command in the JSON of a Crowd form that was not asked to flatten its answers."""
    try:
        found: Any = read_json(answers)
        return str(found[0]["command"])
    except (ValueError, LookupError, TypeError):
        return ""
