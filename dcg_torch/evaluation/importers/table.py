"""A CSV file with a row per object of an episode: the form for who has a spreadsheet.

Columns: id (of the episode), text, object (its id), type, x, y; and, if there are any, z, color, target, size_x,
size_y, size_z, robot_x, robot_y, robot_yaw, group. Rows of one id are one episode; what is said of the episode (text,
robot, group) stands in its first row and may be repeated. `target` marks what is meant: 1, true, yes or x.
"""

from __future__ import annotations

import csv
import io
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any

from dcg_torch.evaluation.importers.base import Converted, ImportFileError, LeftOut, numbers
from dcg_torch.storage.untrusted_files import misspelt, plain, read_text, shown

_NEEDED = ("id", "text", "object", "type", "x", "y")
_FURTHER = ("z", "color", "target", "size_x", "size_y", "size_z", "robot_x", "robot_y", "robot_yaw", "group")
_YES, _NO = ("1", "true", "yes", "x"), ("0", "false", "no", "")

_Row = dict[str, str]


def convert(path: Path, tick: Callable[[int], None] = lambda total: None) -> Converted:
    """The episodes of a CSV file.

    Args:
        tick: called after each episode with the number of all.

    Raises:
        ImportFileError: the file is missing, not CSV, or lacks a column.
    """
    found = Converted()
    episodes: dict[str, list[tuple[int, _Row]]] = {}
    for line, row in _rows(path, found):
        if row["id"]:
            episodes.setdefault(row["id"], []).append((line, row))
        else:
            found.leave_out("row", "no id of an episode", f"line {line}")
    for id_, rows in episodes.items():
        where = f"line {rows[0][0]}"
        try:
            found.add(_episode(id_, [row for _, row in rows]), where)
        except LeftOut as error:
            found.leave_out("episode", str(error), where)
        tick(len(episodes))
    return found


def _rows(path: Path, found: Converted) -> list[tuple[int, _Row]]:
    """The rows with the lines that they end in; every value is there, without spaces around it."""
    reader = csv.reader(io.StringIO(read_text(path, "CSV file", ImportFileError, "utf-8-sig"), newline=""), strict=True)
    rows: list[tuple[int, _Row]] = []
    try:
        columns = [name.strip() for name in next(reader, [])]
        _check_columns(path, columns, found)
        for values in reader:
            if len(values) == len(columns):
                rows.append((reader.line_num, {c: v.strip() for c, v in zip(columns, values, strict=True)}))
            elif values:
                found.leave_out("row", "more or fewer values than columns", f"line {reader.line_num}")
    except csv.Error as error:
        raise ImportFileError(
            f"{path}, line {reader.line_num}: not readable as CSV: {plain(str(error), 120)}"
        ) from None
    return rows


def _check_columns(path: Path, columns: Sequence[str], found: Converted) -> None:
    repeated = [name for name in columns if columns.count(name) > 1]
    if repeated:
        raise ImportFileError(f"{path}: the column {shown(repeated[0])} is there twice; rename one")
    missing = [name for name in _NEEDED if name not in columns]
    if missing:
        raise ImportFileError(f"{path}: no column {missing[0]}; the first line names {', '.join(_NEEDED)}")
    for name in columns:
        if name not in _NEEDED + _FURTHER:
            near = misspelt(name, _NEEDED + _FURTHER)
            hint = f"; did you mean {near}?" if near else ""
            found.leave_out("column", f"{shown(name)} is none that is read{hint}", path.name)


def _episode(id_: str, rows: Sequence[_Row]) -> dict[str, Any]:
    first = rows[0]
    for key in ("text", "group", "robot_x", "robot_y", "robot_yaw"):
        if any(row.get(key) not in ("", None, first.get(key)) for row in rows):
            raise LeftOut(f"its rows say different things in {key}")
    record: dict[str, Any] = {
        "id": id_,
        "text": first["text"],
        "objects": [_object(row) for row in rows],
        "target": [row["object"] for row in rows if _is_target(row.get("target", ""))],
    }
    if first.get("robot_x") or first.get("robot_y"):
        yaw = first.get("robot_yaw") or "0"
        pose = numbers((first.get("robot_x"), first.get("robot_y"), yaw), 3)
        record["robot"] = dict(zip(("x", "y", "yaw"), pose, strict=True))
    return record | ({"group": first["group"]} if first.get("group") else {})


def _object(row: _Row) -> dict[str, Any]:
    sizes = [row.get(f"size_{axis}") for axis in "xyz"]
    return {
        "id": row["object"],
        "type": row["type"],
        "color": row.get("color") or None,
        "position": numbers((row["x"], row["y"], row.get("z") or "0"), 3),
        **({"size": numbers(sizes, 3)} if any(sizes) else {}),
    }


def _is_target(said: str) -> bool:
    if said.lower() not in _YES + _NO:
        raise LeftOut("target is neither yes nor no")
    return said.lower() in _YES
