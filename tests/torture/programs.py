"""The programs under torture: started in a fork, waited for, and compared with a run that nobody disturbed."""

from __future__ import annotations

import contextlib
import json
import os
import signal
import sys
import time
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import torch
from hostile import EPISODE

from dcg_torch.cli import evaluate, pretrain, run, sweep  # noqa: F401  (imported once, before the forks)
from dcg_torch.experiment import outcome, worker  # noqa: F401
from dcg_torch.language import default_parser

torch.set_num_threads(1)
default_parser().parse("go to the cube", ())

PLAIN = ("simulator=fake", "trials=3", "iterations=2", "speaker=canonical", "figures=false", "tensorboard=false")
# Files that tell of wall-clock times, of places, or of both.
_TIMED = ("timings.jsonl", "summary.json", "hydra.yaml", "config.yaml", "multirun.yaml", ".lock", "overrides.yaml")


@dataclass(frozen=True)
class Program:
    """A command that works in a folder: its main function, its arguments, and what stands before the folder's name."""

    name: str
    main: Any
    arguments: Sequence[str]
    folder: str = "hydra.run.dir="


def programs(directory: Path) -> list[Program]:
    """Those that are killed; `directory` is for their input."""
    episodes = directory / "episodes.jsonl"
    lines = [{**EPISODE, "id": f"e{k}", "text": f"take the {('red', 'blue')[k % 2]} cube"} for k in range(12)]
    episodes.write_text("".join(json.dumps(line) + "\n" for line in lines))
    small = (f"train={episodes}", f"test={episodes}", "model.lessons=0", "rounds=1")
    return [
        Program("experiment", run.main, (*PLAIN, "workers=1")),
        Program("experiment, 2 workers", run.main, (*PLAIN, "workers=2")),
        Program("sweep", run.main, ("-m", *PLAIN, "workers=1", "model=dcg,dcg_upup"), "hydra.sweep.dir="),
        Program("evaluate", evaluate.main, small),
        Program("pretrain", pretrain.main, ("--lessons=20",), "--out="),
    ]


@dataclass
class Process:
    """A program that runs in a process group of its own."""

    pid: int
    output: Path
    began: float = field(default_factory=time.monotonic)

    def end(self, seconds: float = 120.0) -> tuple[int, str]:
        """Wait for its end: exit status as a shell says it, and what it complained of."""
        until = time.monotonic() + seconds
        while time.monotonic() < until:
            done, status = os.waitpid(self.pid, os.WNOHANG)
            if done:
                code = os.waitstatus_to_exitcode(status)
                return (code if code >= 0 else 128 - code), self.output.read_text(errors="replace")
            time.sleep(0.005)
        os.killpg(self.pid, signal.SIGKILL)
        os.waitpid(self.pid, 0)
        return -1, "it hung"


def start(program: Program, directory: Path, output: Path) -> Process:
    """Fork, and run the program in the child."""
    pid = os.fork()
    if pid:
        return Process(pid, output)
    status = 70
    try:
        os.setsid()
        for stream, path in ((1, Path(os.devnull)), (2, output)):
            os.dup2(os.open(path, os.O_WRONLY | os.O_CREAT | os.O_TRUNC, 0o644), stream)
        signal.signal(signal.SIGINT, signal.default_int_handler)
        sys.argv = ["dcg_torch", *program.arguments, f"{program.folder}{directory}"]
        status = program.main()
    except SystemExit as leaving:
        status = leaving.code if isinstance(leaving.code, int) else 1
    except BaseException:
        sys.excepthook(*sys.exc_info())
    finally:
        with contextlib.suppress(OSError):
            sys.stderr.flush()
        os._exit(status)


def finish(program: Program, directory: Path, output: Path) -> tuple[int, str]:
    """Run a program to its end."""
    return start(program, directory, output).end()


def whole(directory: Path) -> dict[str, bytes]:
    """What a program left, without wall-clock times and names of folders; of trials' lines, their first halves."""
    return {str(p.relative_to(directory)): _content(p) for p in _files(directory)}


def _files(directory: Path) -> Iterator[Path]:
    for path in sorted(directory.rglob("*")):
        if path.is_file() and path.name not in _TIMED and not path.name.startswith("events.out"):
            yield path


def _content(path: Path) -> bytes:
    content = path.read_bytes()
    if path.parent.name == "trials":
        return b"\n".join(line.partition(b"\t")[0] for line in content.split(b"\n"))
    return b"" if path.suffix == ".png" else content


def left_behind() -> set[str]:
    """What is in shared memory and /tmp that such programs leave."""
    places = [p for d in ("/dev/shm", "/tmp") if Path(d).is_dir() for p in Path(d).iterdir()]
    return {str(p) for p in places if p.name.startswith(("sem.", "joblib", "loky", "pymp", "psm_", ".curves"))}
