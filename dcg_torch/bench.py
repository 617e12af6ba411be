"""`python -m dcg_torch.bench [--json FILE]`: how long each part takes, as a table and as JSON.

Medians over repeats, one thread, after a warm-up, as in a trial. The fit is compared with scikit-learn's L-BFGS on
the same rows and the same objective, if scikit-learn is installed (the extra `bench`).
"""

from __future__ import annotations

import argparse
import json
import math
import os
import platform
import statistics
import subprocess
import sys
import time
from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import asdict, dataclass
from pathlib import Path

import numpy as np
import torch
from rich import box
from rich.table import Table as Grid

from dcg_torch.cli.console import make_console
from dcg_torch.experiment.plan import trial_commands
from dcg_torch.experiment.trial import run_trial
from dcg_torch.grounding.design import merge
from dcg_torch.grounding.features import PAPER, Group
from dcg_torch.grounding.fit import fit, objective_at
from dcg_torch.grounding.psi import TERNARY, LogLinearFactor
from dcg_torch.language import default_parser
from dcg_torch.lessons import initial_training
from dcg_torch.lessons.generated import generated_lessons
from dcg_torch.model import GroundingModel, Variant
from dcg_torch.resources import resource
from dcg_torch.settings import Settings
from dcg_torch.simulator import FakeRobot, SimulatedRobot
from dcg_torch.types import Percept, Pose
from dcg_torch.world.files import load_worlds
from dcg_torch.world.generator import COLORS, TYPES

_L2 = 1.0
_TOLERANCE = 1e-6  # of the gradient's max-norm
_COLD = (
    "from dcg_torch.lessons import initial_training; from dcg_torch.language import default_parser; from dcg_torch.model import GroundingModel; "
    "default_parser().parse('go to the cube', ()); GroundingModel.trained(initial_training())"
)


@dataclass(frozen=True)
class Result:
    """One measurement: what, its unit, the median of `repeats`, the extremes, and the goal if there is one."""

    name: str
    unit: str
    median: float
    low: float
    high: float
    repeats: int
    goal: float | None = None


def _result(name: str, values: Sequence[float], unit: str = "ms", goal: float | None = None) -> Result:
    return Result(name, unit, statistics.median(values), min(values), max(values), len(values), goal)


def _milliseconds(work: Callable[..., object], *arguments: object) -> float:
    began = time.perf_counter()
    work(*arguments)
    return 1000 * (time.perf_counter() - began)


def _repeated(name: str, work: Callable[[], object], repeats: int, goal: float | None = None) -> Result:
    work()  # warm up
    return _result(name, [_milliseconds(work) for _ in range(repeats)], goal=goal)


def bench_model() -> Iterator[Result]:
    """Training, retraining as a trial goes on, grounding, parsing."""
    training = initial_training()
    yield _repeated("initial training", lambda: GroundingModel.trained(training), 15, goal=50)

    commands = trial_commands(Settings(iterations=10), 0)
    parse = default_parser().parse
    retraining = [
        1000 * timing.train
        for _ in range(3)
        for _, timing in run_trial(
            0, commands, GroundingModel.trained(training), parse, FakeRobot(), np.random.default_rng(0)
        )
    ]
    yield _result("one retraining in the loop", retraining, goal=50)

    model = GroundingModel.trained(training)
    percepts = [
        Percept(f"{color} {kind}", kind, color, (1.0 + k, 0.5 * j, 0.0))
        for k, kind in enumerate(TYPES)
        for j, color in enumerate(COLORS)
    ]
    tree = parse("move towards the red cube", model.symbols).tree
    assert tree is not None
    yield _repeated(
        f"grounding, {len(percepts)} objects and all hypotheticals",
        lambda: model.ground(tree, model.world_model(percepts, Pose(0.0, 0.0))),
        50,
        goal=5,
    )
    texts = [command.text for command in commands] * 5
    parse(texts[0], model.symbols)
    yield _result("parsing a command", [_milliseconds(parse, text, model.symbols) for text in texts])


_RELATED = (
    "go to the red cube next to the blue sphere",
    "go to the sphere behind the green cylinder on your left",
    "go to the second cube from the left in the row",
    "go to the two cylinders between the red cube and the blue sphere",
)


def bench_relations() -> Iterator[Result]:
    """Grounding of relational commands; each time the objects stand otherwise, as nothing of a world may be known."""
    parse, rng = default_parser().parse, np.random.default_rng(0)
    groups = PAPER | {Group.RELATION}
    model = GroundingModel.trained(initial_training(), Variant(groups=groups, hypothetical=False, ternary=False))
    model.teach(generated_lessons(parse, 200), relations_only=True, rounds=1)
    kinds = [("cube", "sphere", "cylinder")[k % 3] for k in range(25)]
    for text in _RELATED:
        tree = parse(text, model.symbols).tree
        assert tree is not None
        spent = []
        for _ in range(40):
            percepts = [
                Percept(
                    f"{k}",
                    kind,
                    COLORS[int(rng.integers(3))],
                    (float(rng.uniform(-5.0, 5.0)), float(rng.uniform(-5.0, 5.0)), 0.0),
                )
                for k, kind in enumerate(kinds)
            ]
            spent.append(
                _milliseconds(lambda p, t: model.ground(t, model.world_model(p, Pose(0.0, 0.0))), percepts, tree)
            )
        yield _result(f"grounding among {len(kinds)}, {text.removeprefix('go to ')!r}", spent[5:], goal=5)


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


def bench_hostile(count: int = 2_000) -> Result:
    """Each of `count` hostile strings, all different; the highest is the worst case."""
    rng = np.random.default_rng(0)
    parse = default_parser().parse
    parse("go to the cube", TYPES)
    return _result("a hostile string", [_milliseconds(parse, hostile(rng), TYPES) for _ in range(count)], goal=50)


def bench_robot() -> Iterator[Result]:
    """The simulated robot in the committed worlds: load, look, turn one step, drive to every object in view."""
    times: dict[str, list[float]] = {"loading a world": [], "perceiving": [], "turning 20 degrees": [], "a drive": []}
    with SimulatedRobot() as robot:
        for world in load_worlds(resource("worlds")):
            times["loading a world"].append(_milliseconds(robot.load, world))
            seen: dict[str, Percept] = {}
            for _ in range(18):
                times["perceiving"].append(_milliseconds(robot.perceive))
                times["turning 20 degrees"].append(_milliseconds(robot.spin, math.radians(20)))
                seen |= {percept.id: percept for percept in robot.perceive()}
            for target in seen:
                robot.load(world)
                times["a drive"].append(_milliseconds(robot.drive_to, target, list(seen.values())))
    for name, values in times.items():
        yield _result(name, values)


@dataclass(frozen=True)
class _Rows:
    """Labelled factors drawn from a model of their own, about a sixth of them distinct."""

    language: np.ndarray[tuple[int, int], np.dtype[np.int64]]
    grounding: np.ndarray[tuple[int, int], np.dtype[np.int64]]
    phrase: np.ndarray[tuple[int], np.dtype[np.int64]]
    label: np.ndarray[tuple[int], np.dtype[np.int64]]
    shape: tuple[int, int, int]


def _draw_rows(count: int, rng: np.random.Generator) -> _Rows:
    languages, groundings, ones = 40, 30, 3
    side = math.ceil(math.sqrt(count / 6))
    phrases = np.stack([rng.choice(languages, ones, replace=False) for _ in range(side)])
    objects = np.stack([rng.choice(groundings, ones, replace=False) for _ in range(side)])
    phrase = rng.integers(side, size=count)
    grounding = objects[rng.integers(side, size=count)]
    model = LogLinearFactor(np.ones((languages, groundings), dtype=np.bool_))
    model.set_weight(rng.normal(size=tuple(model.weight.shape)))
    chances = model.log_psi(phrases, grounding, phrase).exp().numpy()
    label = (rng.random((count, 1)) > chances.cumsum(axis=1)).sum(axis=1).clip(0, len(TERNARY) - 1)
    return _Rows(phrases, grounding, phrase, label, (len(TERNARY), languages, groundings))


def bench_fit(count: int, repeats: int) -> Iterator[Result]:
    """The fit of `count` rows, merging them included, beside scikit-learn's on the same rows.

    Both minimise the same objective: scikit-learn's C is 1 / l2, and its columns are the pairs of ours.
    """
    rows = _draw_rows(count, np.random.default_rng(count))
    model = LogLinearFactor(np.ones(rows.shape[1:], dtype=np.bool_))

    def ours() -> None:
        model.set_weight(torch.zeros_like(model.weight))
        design = merge(rows.language, rows.grounding, rows.phrase, rows.label, np.ones(count), rows.shape[0])
        fit(model, [design], l2=_L2, tolerance=_TOLERANCE)

    mine = _repeated(f"fit, {count:,} rows", ours, repeats)
    yield mine
    try:
        from scipy.sparse import csr_array
        from sklearn.linear_model import LogisticRegression
        from threadpoolctl import threadpool_limits
    except ImportError:
        return
    columns = (rows.language[rows.phrase][:, :, None] * rows.shape[2] + rows.grounding[:, None, :]).reshape(count, -1)
    starts = np.arange(0, columns.size + 1, columns.shape[1])
    design = csr_array((np.ones(columns.size), columns.reshape(-1), starts), (count, rows.shape[1] * rows.shape[2]))
    other = LogisticRegression(C=1 / _L2, fit_intercept=False, solver="lbfgs", tol=_TOLERANCE / count, max_iter=2000)
    with threadpool_limits(1):
        theirs = _repeated(f"scikit-learn's fit, {count:,} rows", lambda: other.fit(design, rows.label), repeats)
    yield theirs
    design = merge(rows.language, rows.grounding, rows.phrase, rows.label, np.ones(count), rows.shape[0])
    values = [objective_at(model, [design], _L2)[0]]
    model.set_weight(other.coef_.reshape(rows.shape))
    values.append(objective_at(model, [design], _L2)[0])
    yield _result(f"time over scikit-learn's, {count:,} rows", [mine.median / theirs.median], "ratio")
    yield _result(f"objective over scikit-learn's less 1, {count:,} rows", [values[0] / values[1] - 1], "relative")


def bench_start(repeats: int = 2) -> Result:
    """A process that begins to run trials: imports, the parser, a first command read, a first training."""
    command = [sys.executable, "-c", _COLD]
    return _result(
        "cold start of a worker", [_milliseconds(lambda: subprocess.run(command, check=True)) for _ in range(repeats)]
    )


def peak_memory() -> Result:
    """Of this process, so far."""
    from resource import RUSAGE_SELF, getrusage  # not on Windows

    peak = getrusage(RUSAGE_SELF).ru_maxrss
    return _result("peak memory", [peak / (1024 if sys.platform != "darwin" else 1024**2)], "MB", goal=1024)


def run_benchmarks() -> Iterator[Result]:
    """All of them, as they are done; the memory is measured before scikit-learn takes any."""
    torch.set_num_threads(1)
    yield bench_start()
    yield from bench_model()
    yield from bench_relations()
    yield bench_hostile()
    yield from bench_robot()
    yield peak_memory()
    yield from bench_fit(1_000, 7)
    yield from bench_fit(100_000, 3)


def _grid(results: Iterable[Result]) -> Grid:
    grid = Grid(title="Benchmarks: medians, one thread", box=box.SIMPLE_HEAD)
    grid.add_column("what")
    for heading in ("median", "lowest", "highest", "unit", "n", "goal"):
        grid.add_column(heading, justify="right")
    for r in results:
        goal = "" if r.goal is None else f"<= {r.goal:g}, {'met' if r.median <= r.goal else 'MISSED'}"
        grid.add_row(r.name, f"{r.median:.3g}", f"{r.low:.3g}", f"{r.high:.3g}", r.unit, str(r.repeats), goal)
    return grid


def main(arguments: Sequence[str] | None = None) -> int:
    """Run the command line; returns the exit status."""
    parser = argparse.ArgumentParser(prog="python -m dcg_torch.bench", description="Time the parts of dcg_torch.")
    parser.add_argument("--json", metavar="FILE", type=Path, help="also write the results into this file")
    options = parser.parse_args(arguments)
    console = make_console()
    with console.status("running the benchmarks"):
        results = list(run_benchmarks())
    console.print(_grid(results))
    load, cpus = os.getloadavg()[0], os.cpu_count() or 1
    if load > cpus:
        console.print(
            f"Others are busy here (load {load:.1f} on {cpus} CPUs): the times are higher than on a quiet machine."
        )
    if options.json is not None:
        machine = {"python": platform.python_version(), "torch": torch.__version__, "cpus": cpus, "load": load}
        options.json.parent.mkdir(parents=True, exist_ok=True)
        options.json.write_text(
            json.dumps({"machine": machine, "benchmarks": [asdict(r) for r in results]}, indent=1) + "\n", "utf-8"
        )
        console.print(f"written to {options.json}")
    return 0


if __name__ == "__main__":
    sys.exit(main())
