"""Twenty thousand hostile files for each reader."""

from __future__ import annotations

import random
import resource
import sys
import tempfile
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

from hostile import EPISODE, TRAINING, WORLD, damaged, json_lines, yaml_files
from hypothesis import HealthCheck, given, seed, settings
from hypothesis import strategies as st
from report_rows import row

from dcg_torch.evaluation.episodes import read_episodes
from dcg_torch.evaluation.importers import table
from dcg_torch.lessons import read_training
from dcg_torch.report.runs import read_rows
from dcg_torch.storage.errors import UserError
from dcg_torch.world.files import load_world

INPUTS, _BATCH = 20_000, 500
_CSV = b"""id,text,object,type,x,y,z,color,target,size_x,robot_x,robot_y,robot_yaw,group
1,"take the cone, please",a,cone,1,2,0,red,,0.2,0,0,0,g
1,,b,cone,1,-2,0,red,x,0.2,,,,
2,go to the cube,a,cube,1.5,2,,blue,yes,,,,,
"""
_SLOWEST, _MOST = 2.0, 200.0  # seconds, and MB by which the peak of memory grew, for one input


def readers(rng: random.Random, directory: Path, until: float) -> tuple[bool, str]:
    """Feed every reader; it takes a file or refuses it with one printable line, quickly."""
    said, good = [], True
    largest = 0.0
    choice: dict[str, tuple[Callable[[Path], Any], st.SearchStrategy[bytes]]] = {
        "world": (load_world, yaml_files(WORLD)),
        "training": (read_training, yaml_files(TRAINING)),
        "episodes": (read_episodes, json_lines(EPISODE)),
        "iterations": (read_rows, json_lines(row(beliefs={"crate": {"cube": 0.9}}).model_dump(mode="json"))),
        "csv": (
            table.convert,
            damaged(_CSV, [b'"', b",", b"\n", b"\x00", b"\xff", b"9" * 5_000, b"nan", b"," * 5_000]),
        ),
    }
    for k, (name, (read, files)) in enumerate(choice.items()):
        share = time.monotonic() + (until - time.monotonic()) / (len(choice) - k)
        tried, taken, slowest, more, wrong = _feed(read, files, rng.randrange(2**32), share)
        largest = max(largest, more)
        good &= wrong is None and slowest < _SLOWEST and tried > 0
        said.append(f"{name} {tried} files, {taken} taken, slowest {slowest:.2f} s{f', {wrong}' if wrong else ''}")
    return good and largest < _MOST, "; ".join(said) + f"; at most {largest:.0f} MB for one file"


def _feed(
    read: Callable[[Path], Any], files: st.SearchStrategy[bytes], start: int, until: float
) -> tuple[int, int, float, float, str | None]:
    """How many files there were and were taken, the most seconds and MB for one, and what went wrong first."""
    tried = taken = 0
    slowest = most = 0.0
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "a_file"

        @settings(max_examples=_BATCH, deadline=None, database=None, suppress_health_check=list(HealthCheck))
        @given(files)
        def feed(content: bytes) -> None:
            nonlocal tried, taken, slowest, most
            path.write_bytes(content)
            began, held = time.process_time(), _megabytes()
            tried += 1
            try:
                read(path)
                taken += 1
            except UserError as error:
                if not str(error).isprintable() or len(str(error)) > 600:
                    raise AssertionError(repr(str(error))) from error
            slowest = max(slowest, time.process_time() - began)
            most = max(most, _megabytes() - held)

        try:
            while tried < INPUTS and time.monotonic() < until:
                seed(start + tried)(feed)()
        except Exception as error:
            return tried, taken, slowest, most, f"{type(error).__name__}: {str(error)[:200]}"
    return tried, taken, slowest, most, None


def _megabytes() -> float:
    """The peak of this process's memory so far."""
    unit = 1024 if sys.platform != "darwin" else 1024**2
    return resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / unit
