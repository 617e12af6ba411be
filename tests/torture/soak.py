"""One robot and thousands of commands: time and memory a command stay where they are."""

from __future__ import annotations

import json
import os
import random
import statistics
import time
from pathlib import Path

from programs import Program, start

from dcg_torch.cli import run

COMMANDS, SETTLED = 10_000, 2_000
_FLAT = 1.10


def soak(rng: random.Random, directory: Path, until: float) -> tuple[bool, str]:
    """Median seconds and resident memory at the end against those when `SETTLED` commands were over."""
    settings = ("experiment=long_life", f"iterations={COMMANDS}", "worlds_per_trial=1600", "workers=1")
    quiet = ("figures=false", "tensorboard=false")
    process = start(Program("soak", run.main, (*settings, *quiet)), directory / "run", directory / "err")
    memory: list[tuple[int, float]] = []
    part = directory / "run" / "trials" / "0000.jsonl"
    while os.waitid(os.P_PID, process.pid, os.WEXITED | os.WNOHANG | os.WNOWAIT) is None and time.monotonic() < until:
        time.sleep(1.0)
        done = part.read_bytes().count(b"\n") if part.exists() else 0
        memory.append((done, _resident(process.pid)))
    os.kill(process.pid, 15)
    process.end()
    timings = [json.loads(line.partition("\t")[2]) for line in part.read_text().split("\n")[:-1]]
    seconds = [t["parse"] + t["ground"] + t["train"] for t in timings]
    count = len(seconds)
    if count < SETTLED + 1_000:
        return False, f"only {count} commands in the time there was"
    width = min(1_000, (count - SETTLED) // 2)
    slower = statistics.median(seconds[-width:]) / statistics.median(seconds[SETTLED : SETTLED + width])
    held = [(done, size) for done, size in memory if done >= SETTLED and size]
    larger = held[-1][1] / held[0][1]
    return max(slower, larger) <= _FLAT, f"{count} commands; time x{slower:.2f}, memory x{larger:.2f} since {SETTLED}"


def _resident(pid: int) -> float:
    try:
        return float(Path(f"/proc/{pid}/statm").read_text().split()[1])
    except OSError:
        return 0.0
