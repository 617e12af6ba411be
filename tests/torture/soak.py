"""One robot and thousands of commands: time and memory a command stay where they are.

CPU time is compared, since others are busy on the machine, and medians of blocks of commands, since a busy neighbour
makes a block dearer now and then.
"""

from __future__ import annotations

import os
import random
import statistics
import time
from pathlib import Path
from typing import NamedTuple

from programs import Program, start

from dcg_torch.cli import run

COMMANDS, SETTLED, WIDTH, BLOCK = 10_000, 2_000, 2_000, 250
_FLAT = 1.10


class Sample(NamedTuple):
    """A look at the process: commands done, pages resident, ticks of CPU. CPU, since others are busy here, too."""

    done: int
    resident: int
    ticks: int


def soak(rng: random.Random, directory: Path, until: float) -> tuple[bool, str]:
    """CPU time a command, and resident memory, in the end against those when `SETTLED` commands were over."""
    settings = ("experiment=long_life", f"iterations={COMMANDS}", "worlds_per_trial=1600", "workers=1")
    quiet = ("figures=false", "tensorboard=false")
    process = start(Program("soak", run.main, (*settings, *quiet)), directory / "run", directory / "err")
    samples: list[Sample] = []
    part = directory / "run" / "trials" / "0000.jsonl"
    while os.waitid(os.P_PID, process.pid, os.WEXITED | os.WNOHANG | os.WNOWAIT) is None and time.monotonic() < until:
        time.sleep(1.0)
        done = part.read_bytes().count(b"\n") if part.exists() else 0
        # When all commands are over, the rows of the whole trial are read and counted, which is no command's.
        if done < COMMANDS and (sample := _look(process.pid, done)) is not None:
            samples.append(sample)
    os.kill(process.pid, 15)
    process.end()
    count = samples[-1].done if samples else 0
    if count < SETTLED + 2 * BLOCK:
        return False, f"only {count} commands in the time there was"
    width = min(WIDTH, (count - SETTLED) // 2)
    early, late = (_dearness(samples, first, first + width) for first in (SETTLED, count - width))
    larger = samples[-1].resident / next(s for s in samples if s.done >= SETTLED).resident
    tick = 1000.0 / os.sysconf("SC_CLK_TCK")  # milliseconds
    said = f"{count} commands; CPU a command {early * tick:.1f} ms over {SETTLED} to {SETTLED + width}, "
    said += f"{late * tick:.1f} ms over the last {width} (x{late / early:.2f}); memory x{larger:.2f} since {SETTLED}"
    steps = (_dearness(samples, first, first + 1_000) * tick for first in range(0, count - 999, 1_000))
    return max(late / early, larger) <= _FLAT, said + "; by thousands: " + " ".join(f"{step:.1f}" for step in steps)


def _dearness(samples: list[Sample], first: int, last: int) -> float:
    """Ticks of CPU a command: the median of the blocks between two counts of commands."""
    blocks = range(first, last - BLOCK + 1, BLOCK)
    return statistics.median(_ticks(samples, at, at + BLOCK) for at in blocks)


def _ticks(samples: list[Sample], first: int, last: int) -> float:
    """Ticks of CPU a command between two counts of commands."""
    begin = next(s for s in samples if s.done >= first)
    end = next((s for s in samples if s.done >= last), samples[-1])
    return (end.ticks - begin.ticks) / max(1, end.done - begin.done)


def _look(pid: int, done: int) -> Sample | None:
    try:
        resident = int(Path(f"/proc/{pid}/statm").read_text().split()[1])
        user, system = Path(f"/proc/{pid}/stat").read_text().rpartition(")")[2].split()[11:13]
    except OSError:
        return None
    return Sample(done, resident, int(user) + int(system))
