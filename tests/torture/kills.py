"""Programs that are killed at random moments, and two of them in one folder."""

from __future__ import annotations

import os
import random
import shutil
import signal
import time
from collections import Counter
from pathlib import Path

from programs import Process, Program, finish, left_behind, programs, start, whole

KILLS, PAIRS = 100, 50
_SIGNALS = (signal.SIGTERM, signal.SIGHUP, signal.SIGINT, signal.SIGKILL)


def kills(rng: random.Random, directory: Path, until: float) -> tuple[bool, str]:
    """Kill a program at a random moment, run it again, and compare all it left with an undisturbed run."""
    before = left_behind()
    references: dict[str, tuple[float, dict[str, bytes]]] = {}
    choice = programs(directory)
    for program in choice:
        began, folder = time.monotonic(), directory / "reference"
        status, err = finish(program, folder, directory / "err")
        if status != 0:
            return False, f"{program.name} alone ends with {status}: {err[-300:]}"
        references[program.name] = (time.monotonic() - began, whole(folder))
        shutil.rmtree(folder)
    found: list[str] = []
    tried: Counter[str] = Counter()
    while tried.total() < KILLS and time.monotonic() < until:
        program = choice[tried.total() % len(choice)]
        seconds, reference = references[program.name]
        wrong = _killed_once(rng, program, directory, seconds, reference)
        tried[program.name] += 1
        if wrong:
            found.append(f"{program.name}: {wrong}")
    if left := left_behind() - before:
        found.append(f"left behind: {sorted(left)[:3]}")
    good = not found and tried.total() > 0
    return good, f"{tried.total()} kills ({dict(tried)}), {len(found)} not whole after a rerun. {found[:3] or ''}"


def _killed_once(
    rng: random.Random, program: Program, directory: Path, seconds: float, reference: dict[str, bytes]
) -> str | None:
    """What was wrong after one kill and one rerun."""
    folder = directory / "run"
    shutil.rmtree(folder, ignore_errors=True)
    process = start(program, folder, directory / "err")
    time.sleep(rng.uniform(0.0, seconds))
    _kill(rng, process)
    status, err = process.end()
    if "Traceback" in err or status == -1:
        return f"status {status}: {err[-300:]}"
    status, err = finish(program, folder, directory / "err")
    if status != 0:
        return f"the rerun ends with {status}: {err[-300:]}"
    found = whole(folder)
    differing = sorted(k for k in found.keys() | reference.keys() if found.get(k) != reference.get(k))
    return f"differs in {differing[:5]}" if differing else None


def _kill(rng: random.Random, process: Process) -> None:
    """A signal to the program, to all of its group, or death to one of its workers."""
    who = rng.choice(("parent", "group", "worker"))
    try:
        if who == "parent":
            os.kill(process.pid, rng.choice(_SIGNALS))
        elif who == "group":
            os.killpg(process.pid, rng.choice(_SIGNALS))
        else:
            children = Path(f"/proc/{process.pid}/task/{process.pid}/children").read_text().split()
            os.kill(int(rng.choice(children)) if children else process.pid, signal.SIGKILL)
    except (ProcessLookupError, FileNotFoundError):
        pass  # it was faster


def pairs(rng: random.Random, directory: Path, until: float) -> tuple[bool, str]:
    """Two processes in one folder, a moment apart: one goes on, one says so."""
    found: list[str] = []
    tried = 0
    choice = [program for program in programs(directory) if "2 workers" not in program.name]
    while tried < PAIRS and time.monotonic() < until:
        program, folder = choice[tried % len(choice)], directory / f"run{tried}"
        both = []
        for k in range(2):
            both.append(start(program, folder, directory / f"err{k}"))
            time.sleep(rng.uniform(0.0, 0.2))
        ends = sorted(process.end() for process in both)
        tried += 1
        if [status for status, _ in ends] != [0, 2] or "another process works in this folder" not in ends[1][1]:
            found.append(f"{program.name}: {ends}"[:400])
    return not found and tried > 0, f"{tried} pairs, {len(found)} not as they should. {found[:2] or ''}"
