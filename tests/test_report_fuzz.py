"""Damaged run folders: each is reported, or refused in one line, and never a traceback."""

from __future__ import annotations

import io
import json
import tempfile
from pathlib import Path
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st
from report_rows import row, run, write_run
from rich.console import Console

from dcg_torch.report.export import to_csv
from dcg_torch.report.runs import load_run, read_rows
from dcg_torch.report.show import print_run, print_several
from dcg_torch.report.summary import ReportError

HOSTILE: list[Any] = [None, True, -1, 0, 10**400, 1e308, -1e308, 5e-324, float("nan"), float("inf"), "", "\x1b[2J\n"]
HOSTILE += [
    "x" * 5000,
    "\ud7ff\u202e",
    [],
    {},
    [[]],
    {"": {}},
    [0.0, 1e300],
    ["c"] * 40,
    json.loads("[" * 150 + "]" * 150),
]
FILES = ("summary.json", "iterations.jsonl", "timings.jsonl", "settings.json", ".hydra/overrides.yaml")


def places(value: Any, path: tuple[Any, ...] = ()) -> list[tuple[Any, ...]]:
    """The paths of all values within a JSON value."""
    inside = (
        list(value.items()) if isinstance(value, dict) else list(enumerate(value)) if isinstance(value, list) else []
    )
    return [path, *(place for key, child in inside for place in places(child, (*path, key)))]


def spoil(value: Any, data: st.DataObject) -> Any:
    """Replace, drop or add one value somewhere within a JSON value."""
    path = data.draw(st.sampled_from(places(value)))
    new = data.draw(st.sampled_from(HOSTILE))
    if not path:
        return new
    parent = value
    for key in path[:-1]:
        parent = parent[key]
    change = data.draw(st.sampled_from(["replace", "drop", "add"]))
    if change == "replace":
        parent[path[-1]] = new
    elif change == "drop":
        del parent[path[-1]]
    elif isinstance(parent, dict):
        parent["strange"] = new
    else:
        parent.append(new)
    return value


def damage(folder: Path, data: st.DataObject) -> None:
    """Spoil one of a run's files: a value of its JSON, or its bytes."""
    path = folder / data.draw(st.sampled_from(FILES))
    content = path.read_bytes()
    if path.suffix != ".yaml" and data.draw(st.booleans()):
        lines = content.splitlines() if path.suffix == ".jsonl" else [content]
        k = data.draw(st.integers(0, len(lines) - 1))
        lines[k] = json.dumps(spoil(json.loads(lines[k]), data)).encode()
        path.write_bytes(b"\n".join(lines) + b"\n")
        return
    start = data.draw(st.integers(0, len(content)))
    end = data.draw(st.integers(start, len(content)))
    path.write_bytes(content[:start] + data.draw(st.binary(max_size=40)) + content[end:])


def report(folder: Path) -> str:
    """What is printed of a run, alone and twice beside itself, or the line that refuses it."""
    console = Console(file=io.StringIO(), width=100)
    try:
        one = load_run(folder)
        print_run(one.measures, one.seconds, one.config, console)
        print_several([one, one], console)
        return to_csv([one])
    except ReportError as error:
        return str(error)


@given(data=st.data())
def test_a_damaged_run_is_reported_or_refused(data: st.DataObject) -> None:
    with tempfile.TemporaryDirectory() as name:
        folder = write_run(
            Path(name), [row(), *run(1, 2, 3)[1:]], overrides=["model=dcg", "seed=0"], model={"name": "a"}
        )
        (folder / "settings.json").write_text('{"seed": 0, "model": {"name": "dcg"}}')
        damage(folder, data)
        if data.draw(st.booleans()):
            (folder / "summary.json").unlink()  # as of a run that did not finish
        said = report(folder)
        assert said.startswith("run,folder,") or ("\n" not in said and 0 < len(said) < 400 + len(name))


def test_a_strange_key_does_not_steer_the_terminal(tmp_path: Path) -> None:
    path = tmp_path / "iterations.jsonl"
    path.write_text(json.dumps({**row().model_dump(mode="json"), "\x1b[31m" + "x" * 5_000: 1}) + "\n")
    with pytest.raises(ReportError) as caught:
        read_rows(path)
    assert str(caught.value).isprintable()
    assert len(str(caught.value)) < 300 + len(str(path))
