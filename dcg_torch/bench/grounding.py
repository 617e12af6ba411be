"""Grounding by the number of objects: `python -m dcg_torch.bench.grounding [--objects N ...]`.

Milliseconds of the processor, one thread. Every command has a world of its own, so nothing that is known of a world
from an earlier command can help. Memory is what a call holds at most beyond its input, as numpy and Python tell it.
"""

from __future__ import annotations

import argparse
import sys
import tracemalloc
from collections.abc import Iterator, Sequence

import numpy as np
import torch

from dcg_torch.bench.result import Result, cpu_milliseconds, result
from dcg_torch.grounding.features import PAPER, Group
from dcg_torch.language import default_parser
from dcg_torch.lessons import initial_training
from dcg_torch.lessons.curriculum import generated_lessons
from dcg_torch.model import GroundingModel, Variant
from dcg_torch.model.pretrain import pretrained
from dcg_torch.types import Percept, Pose, WorldModel

_PLAIN, _RELATED = "go to the red cube", "go to the red cube next to the blue sphere"
_RELATIONAL = (
    _RELATED,
    "go to the sphere behind the green cylinder on your left",
    "go to the second cube from the left in the row",
    "go to the two cylinders between the red cube and the blue sphere",
)
_READ = (
    "move the blue block which is on top of the yellow one to the left",
    "pick up the second box from the left next to the lamp",
    "take the small light green can standing behind the cup",
    "the one nearest to the front left corner",
    "bring me the book that is on the table near the window",
)
"""Commands that we wrote, most of which can be read in several ways."""
_GOALS = {(24, "plain"): 0.4, (25, "relation"): 2.0, (25, "shipped"): 5.0, (60, "shipped"): 12.0}
_GOALS |= {(10_000, "plain"): 20.0, (10_000, "relation"): 60.0, (100_000, "plain"): 500.0}
_LARGE = 1_000


def scene_of(count: int, rng: np.random.Generator) -> list[Percept]:
    """Cubes, spheres and cylinders in three colours, about as dense whatever their number."""
    side = max(5.0, count**0.5)
    places = rng.uniform(-side, side, size=(count, 2)).tolist()
    colors = rng.choice(["red", "green", "blue"], size=count).tolist()
    kinds = ("cube", "sphere", "cylinder")
    return [
        Percept(str(k), kinds[k % 3], color, (x, y, 0.0))
        for k, ((x, y), color) in enumerate(zip(places, colors, strict=True))
    ]


def _measured(
    kind: str, model: GroundingModel, texts: Sequence[str], count: int, goal: float | None
) -> Iterator[Result]:
    """Grounding each text in worlds of its own; beyond `_LARGE` objects also what memory it takes."""
    rng, parse = np.random.default_rng(count), default_parser().parse
    commands = [parse(text, model.symbols) for text in texts]

    def world() -> WorldModel:
        return model.world_model(scene_of(count, rng), Pose(0.0, 0.0))

    for command in commands:
        model.ground(command, world())
    large = count > _LARGE
    work = [(command, world()) for command in commands for _ in range(3 if large else max(8, 40 // len(commands)))]
    times, name = [cpu_milliseconds(model.ground, *one) for one in work], f"grounding among {count:,}, {kind}"
    yield result(name, times, "ms CPU", goal, curve=f"Grounding, ms by objects: {kind}", at=count)
    if large:
        tracemalloc.start()
        try:
            model.ground(*work[0])
            peak = tracemalloc.get_traced_memory()[1] / 2**20
        finally:
            tracemalloc.stop()
        yield result(f"{name}: memory beyond the input", [peak], "MB", 60 if count <= 10_000 else None)


def bench_grounding(counts: Sequence[int] = (24, 25, 60, 10_000, 100_000)) -> Iterator[Result]:
    """Plain commands by the paper's model, relational ones, and commands with readings by the shipped model."""
    parse = default_parser().parse
    paper, shipped = GroundingModel.trained(initial_training()), pretrained()
    groups = PAPER | {Group.RELATION}
    related = GroundingModel.trained(initial_training(), Variant(groups=groups, hypothetical=False, ternary=False))
    related.teach(generated_lessons(parse, 200), relations_only=True, rounds=1)
    for count in counts:
        yield from _measured("plain", paper, [_PLAIN], count, _GOALS.get((count, "plain")))
        relational = _RELATIONAL if count <= _LARGE else (_RELATED,)
        goal = _GOALS.get((count, "relation"))
        yield from _measured("relational", related, relational, count, goal)
        if count <= _LARGE:
            goal = _GOALS.get((count, "shipped"))
            yield from _measured("shipped model with readings", shipped, _READ, count, goal)
    read = [cpu_milliseconds(parse, text, shipped.symbols) for text in _READ * 8]
    yield result("parsing a command with its readings", read[len(_READ) :], "ms CPU", goal=4)


def main(arguments: Sequence[str] | None = None) -> int:
    """Print the results as they come; returns the exit status."""
    parser = argparse.ArgumentParser(prog="python -m dcg_torch.bench.grounding", description="Time the grounding.")
    parser.add_argument("--objects", type=int, nargs="+", default=[24, 25, 60, 10_000, 100_000], help="how many")
    torch.set_num_threads(1)
    for found in bench_grounding(parser.parse_args(arguments).objects):
        goal = "" if found.goal is None else f"  goal {found.goal:g}"
        print(f"{found.name:62} {found.median:10.4g} {found.unit}{goal}", flush=True)
    return 0


if __name__ == "__main__":
    sys.exit(main())
