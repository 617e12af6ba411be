"""`python -m dcg_torch.bench [--json FILE]`: how long each part takes, as a table and as JSON.

Medians over repeats, one thread, after a warm-up, as in a trial. The fit is compared with those of others on the same
rows and the same objective, as far as they are installed (the extra `bench`).
"""

from __future__ import annotations

import json
import math
import os
import platform
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import asdict, replace
from pathlib import Path
from typing import Any, ParamSpec, TypeVar

import numpy as np
import torch
from rich import box
from rich.table import Table as Grid

from dcg_torch.bench.fits import bench_fits
from dcg_torch.bench.grounding import bench_grounding
from dcg_torch.bench.learning import bench_learn, bench_life, bench_teaching
from dcg_torch.bench.result import Result, milliseconds, repeated, result, shown_number
from dcg_torch.cli.application import one_line_errors
from dcg_torch.cli.console import make_console
from dcg_torch.experiment.plan import trial_commands
from dcg_torch.experiment.trial import run_trial
from dcg_torch.language import default_parser
from dcg_torch.lessons import initial_training
from dcg_torch.model import GroundingModel
from dcg_torch.model.pretrain import pretrained
from dcg_torch.settings import Settings
from dcg_torch.simulator import FakeRobot, SimulatedRobot
from dcg_torch.storage.arguments import Arguments
from dcg_torch.storage.atomic_files import write_whole
from dcg_torch.storage.resources import resource
from dcg_torch.types import Percept
from dcg_torch.world.files import load_worlds
from dcg_torch.world.generator import TYPES

P = ParamSpec("P")
T = TypeVar("T")
_COLD = (
    "from dcg_torch.language import default_parser; from dcg_torch.lessons import initial_training; "
    "from dcg_torch.model import GroundingModel; "
    "default_parser().parse('go to the cube', ()); GroundingModel.trained(initial_training())"
)


def bench_model() -> Iterator[Result]:
    """Training, retraining as a trial goes on, parsing."""
    training = initial_training()
    yield repeated("initial training", lambda: GroundingModel.trained(training), 15, goal=9)

    commands = trial_commands(Settings(iterations=10), 0)
    parse = default_parser().parse
    for name, start, goal in (("paper", GroundingModel.trained(training), 4), ("open world", pretrained(), 8)):
        retraining: list[float] = []
        for _ in range(3):
            model = start.copy()
            model.learn = _timed(model.learn, retraining)  # type: ignore[method-assign]
            list(run_trial(0, commands, model, parse, FakeRobot(), np.random.default_rng(0)))
        yield result(f"one retraining in the loop, {name}", retraining, "ms CPU", goal=goal)

    model = GroundingModel.trained(training)
    texts = [command.text for command in commands] * 5
    parse(texts[0], model.symbols)
    yield result("parsing a command", [milliseconds(parse, text, model.symbols) for text in texts])


def _timed(work: Callable[P, T], times: list[float]) -> Callable[P, T]:
    """A function that also notes the milliseconds of the processor that it takes."""

    def timed(*arguments: P.args, **named: P.kwargs) -> T:
        began = time.process_time()
        found = work(*arguments, **named)
        times.append(1000 * (time.process_time() - began))
        return found

    return timed


_SCRAPS = """
go to the of on and one that is you not red cube , . move left from it all 2 dark don't 's which behind pick closest
most held between same ' " - ; DROP TABLE <b> {{7*7}} ../ %s \\ ((( \U0001f916 куб 立方体 مكعب \u202e a\u0301 ½ row
group facing without nothing each other
"""
_PIECES = [*_SCRAPS.split(), "\x00", "\ud800", "\n", "\t", ""]


def hostile(rng: np.random.Generator) -> str:
    """A string that no person would say: noise, scraps of commands, one phrase for ever, words that nobody knows."""
    size = int(2 ** rng.uniform(0, 9))
    letters = "".join(map(chr, rng.integers(97, 123, 8 * size)))
    kind = rng.integers(7)
    if kind == 0:
        return "".join(map(chr, rng.integers(0, 0x2FFF, size)))
    if kind == 1:
        return str(rng.choice(["", " ", "\t"])).join(rng.choice(_PIECES, size))
    if kind == 2:
        joint = rng.choice(["on", "and", ",", ".", "not on", "that is", "of", "go to", "which has nothing on"])
        return "go to the cube" + f" {joint} the cube" * (size // 4)
    if kind == 3:
        return letters[: 8 * size]
    if kind == 4:
        length = int(rng.integers(1, 9))
        return " ".join(letters[k : k + length] for k in range(0, min(len(letters), 400), length))
    if kind == 5:
        return "a" * int(rng.integers(1, 100_000))
    stop = str(rng.choice([". ", "! ", ", ", "; "]))
    return stop.join(letters[4 * k : 4 * k + 4] for k in range(min(size, 66)))


def bench_hostile(count: int = 2_000) -> Iterator[Result]:
    """Each of `count` hostile strings, all different; the highest is the worst case."""
    rng = np.random.default_rng(0)
    parse = default_parser().parse
    parse("go to the cube", TYPES)
    yield result("a hostile string", [milliseconds(parse, hostile(rng), TYPES) for _ in range(count)], goal=50)


def bench_robot() -> Iterator[Result]:
    """The simulated robot in the committed worlds: load, look, turn one step, drive to every object in view."""
    times: dict[str, list[float]] = {"loading a world": [], "perceiving": [], "turning 20 degrees": [], "a drive": []}
    with SimulatedRobot() as robot:
        for world in load_worlds(resource("worlds")):
            times["loading a world"].append(milliseconds(robot.load, world))
            seen: dict[str, Percept] = {}
            for _ in range(18):
                times["perceiving"].append(milliseconds(robot.perceive))
                times["turning 20 degrees"].append(milliseconds(robot.spin, math.radians(20)))
                seen |= {percept.id: percept for percept in robot.perceive()}
            for target in seen:
                robot.load(world)
                times["a drive"].append(milliseconds(robot.drive_to, target, list(seen.values())))
    for name, values in times.items():
        yield result(name, values)


def bench_start(repeats: int = 2) -> Iterator[Result]:
    """Processes that begin: torch alone, and one that reads a first command and trains for the first time."""
    for name, work in (("importing torch", "import torch"), ("cold start: a first command and training", _COLD)):
        command = [sys.executable, "-c", work]
        yield result(name, [_cpu_of_child(command) for _ in range(repeats)], "ms CPU")


def _cpu_of_child(command: Sequence[str]) -> float:
    """Milliseconds of the processor that a program takes, in all its processes."""
    before = os.times()
    subprocess.run(command, check=True, stdout=subprocess.DEVNULL)
    after = os.times()
    return 1000 * (after.children_user + after.children_system - before.children_user - before.children_system)


def bench_workers(counts: Sequence[int] = (1, 2), trials: int = 200) -> Iterator[Result]:
    """2,000 commands with the fake robot, from a cold start to the summary, by the number of workers."""
    for workers in counts:
        with tempfile.TemporaryDirectory() as folder:
            settings = ("simulator=fake", f"trials={trials}", "iterations=10", f"workers={workers}", "figures=false")
            command = [sys.executable, "-m", "dcg_torch", *settings, f"hydra.run.dir={folder}/run"]
            began = time.perf_counter()
            cpu = _cpu_of_child(command) / 1000
            seconds = time.perf_counter() - began
        curve = f"An experiment of {10 * trials:,} commands, seconds by workers: "
        name = f"{10 * trials:,} commands with the fake robot, workers={workers}"
        goal = 10 if workers == 2 else None
        yield result(name, [seconds], "s", goal, curve=f"{curve}on the clock", at=workers)
        if workers == 1:  # several are no children of the process that is started
            yield result(name, [cpu], "s CPU")


def peak_memory() -> Iterator[Result]:
    """The most memory that this process has taken so far."""
    from resource import RUSAGE_SELF, getrusage  # not on Windows

    peak = getrusage(RUSAGE_SELF).ru_maxrss
    yield result("peak memory", [peak / (1024 if sys.platform != "darwin" else 1024**2)], "MB", goal=1024)


PARTS: dict[str, tuple[str, Sequence[Callable[[], Iterable[Result]]]]] = {
    "start": ("Start, training, reading", (bench_start, bench_model, bench_teaching, bench_hostile)),
    "grounding": ("Grounding", (bench_grounding,)),
    "learning": ("Learning", (bench_learn, bench_life)),
    "robot": ("The simulated robot", (bench_robot,)),
    "experiments": ("Experiments", (bench_workers, peak_memory)),
    "fits": ("The fit and its peers", (bench_fits,)),
}
"""Name -> heading and benchmarks, in their order: the memory is measured before scikit-learn takes any."""


def run_part(name: str) -> Iterator[Result]:
    """The benchmarks of one of `PARTS`, as they are done."""
    torch.set_num_threads(1)
    title, benchmarks = PARTS[name]
    return (replace(found, part=title) for bench in benchmarks for found in bench())


def _processor() -> str:
    """The name of the processor's model, as far as the machine tells."""
    try:
        lines = Path("/proc/cpuinfo").read_text(encoding="utf-8").splitlines()
    except OSError:
        return platform.machine()
    return next((line.partition(": ")[2] for line in lines if line.startswith("model name")), platform.machine())


def _grid(results: Iterable[Result]) -> Grid:
    grid = Grid(title="Benchmarks: medians, one thread", box=box.SIMPLE_HEAD)
    grid.add_column("what")
    for heading in ("median", "lowest", "highest", "unit", "n", "goal"):
        grid.add_column(heading, justify="right")
    for r in results:
        goal = "" if r.goal is None else f"<= {r.goal:g}, {'met' if r.median <= r.goal else 'MISSED'}"
        grid.add_row(r.name, *map(shown_number, (r.median, r.low, r.high)), r.unit, str(r.repeats), goal)
    return grid


def _kept(path: Path | None, parts: Sequence[str]) -> list[Result]:
    """What a file has of other parts than these."""
    if path is None or not path.exists() or set(parts) == set(PARTS):
        return []
    titles = {PARTS[name][0] for name in parts}
    kept = (Result(**one) for one in json.loads(path.read_text(encoding="utf-8"))["benchmarks"])
    return [r for r in kept if r.part not in titles]


def main(arguments: Sequence[str] | None = None) -> int:
    """Run the command line; returns the exit status."""
    parser = Arguments(prog="python -m dcg_torch.bench", description="Time the parts of dcg_torch.")
    parser.add_argument("--json", metavar="FILE", type=Path, help="also write the results into this file")
    parser.add_argument(
        "--part", nargs="+", choices=PARTS, default=[*PARTS], help="these alone; a file keeps what it has of others"
    )
    options = parser.parse_args(arguments)
    console = make_console()
    with one_line_errors():
        kept, results = _kept(options.json, options.part), list[Result]()
        for name in options.part:
            with console.status(f"running the benchmarks: {name}"):
                results += run_part(name)
            if options.json is not None:
                write_whole(options.json, json.dumps(_document([*kept, *results]), indent=1) + "\n")
    console.print(_grid(results))
    load, cpus = os.getloadavg()[0], os.cpu_count() or 1
    if load > cpus:
        console.print(
            f"Others are busy here (load {load:.1f} on {cpus} CPUs): the times are higher than on a quiet machine."
        )
    if options.json is not None:
        console.print(f"written to {options.json}")
    return 0


def _document(results: Sequence[Result]) -> dict[str, Any]:
    """What a file holds: the machine, and the results in the order of their parts."""
    titles = [title for title, _ in PARTS.values()]
    versions = {"python": platform.python_version(), "torch": torch.__version__, "numpy": np.__version__}
    hardware = {"processor": _processor(), "processors": os.cpu_count() or 1, "load": os.getloadavg()[0]}
    ordered = sorted(results, key=lambda r: titles.index(r.part))
    return {"machine": {**versions, **hardware}, "benchmarks": [asdict(r) for r in ordered]}


if __name__ == "__main__":
    sys.exit(main())
