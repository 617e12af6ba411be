"""A disk that is full at one of ten points of a run, and then has room again."""

from __future__ import annotations

import random
import subprocess
import time
from pathlib import Path

from programs import PLAIN, Program, finish, whole

from dcg_torch.cli import run

POINTS = 10
_PROGRAM = Program("experiment", run.main, (*PLAIN[:-2], "workers=1"))  # with figures and curves


def full_disks(rng: random.Random, directory: Path, until: float) -> tuple[bool, str]:
    """Run on a file system that has room for a tenth, two tenths ... of what a run needs; enlarge it; run again."""
    status, err = finish(_PROGRAM, directory / "reference", directory / "err")
    if status != 0:
        return False, f"alone it ends with {status}: {err[-300:]}"
    reference = whole(directory / "reference")
    needs = sum(-(-p.stat().st_size // 4096) * 4096 for p in (directory / "reference").rglob("*") if p.is_file())
    found: list[str] = []
    tried = 0
    for point in range(1, POINTS + 1):
        if time.monotonic() > until:
            break
        disk = directory / f"disk{point}"
        disk.mkdir()
        room = max(8_192, int(needs * (point - 0.5) / POINTS))
        if subprocess.run(["mount", "-t", "tmpfs", "-o", f"size={room}", "tmpfs", disk], check=False).returncode:
            return True, "left out: file systems cannot be mounted here"
        try:
            wrong = _filled_once(disk, directory, reference)
        finally:
            subprocess.run(["umount", disk], check=True)
        tried += 1
        if wrong:
            found.append(f"{room} bytes: {wrong}")
    return (
        not found and tried > 0,
        f"{tried} of {POINTS} points, {len(found)} not whole after a rerun. {found[:2] or ''}",
    )


def _filled_once(disk: Path, directory: Path, reference: dict[str, bytes]) -> str | None:
    status, err = finish(_PROGRAM, disk / "run", directory / "err")
    if status != 2 or err.count("\n") != 1 or "No space left" not in err:
        return f"status {status}: {err[-300:]}"
    subprocess.run(["mount", "-o", "remount,size=64m", disk], check=True)
    status, err = finish(_PROGRAM, disk / "run", directory / "err")
    if status != 0:
        return f"the rerun ends with {status}: {err[-300:]}"
    return None if whole(disk / "run") == reference else "the rerun left something else"
