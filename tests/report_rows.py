"""For the tests of the report: rows made by hand, runs of a simple make-believe robot, and run folders of both."""

from __future__ import annotations

import math
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np

from dcg_torch.report.measures import measure
from dcg_torch.report.seconds import summarise_seconds
from dcg_torch.report.summary import write_summary
from dcg_torch.storage.records import Iteration, Kind, ObjectRecord, ParsedRecord, PoseRecord, Timing

KNOWN = ("cube", "cylinder", "sphere")
NEW = ("door handle", "drill", "fire hydrant", "mailbox", "traffic cone")
COLORS = ("blue", "green", "red")


def thing(identifier: str, kind: str, color: str = "red", x: float = 2.0, y: float = 0.0) -> ObjectRecord:
    return ObjectRecord(id=identifier, type=kind, color=color, position=(x, y))


OBJECTS = (thing("c", "cube"), thing("d", "drill"), thing("m", "mailbox", "blue"), thing("c2", "cube", "blue"))


def row(trial: int = 0, iteration: int = 0, **changes: Any) -> Iteration:
    """A correct command, "go to the red cube", in a world of four objects; `changes` are fields."""
    noun, color = changes.get("noun", "cube"), changes.get("color", "red")
    values: dict[str, Any] = {
        "trial": trial,
        "iteration": iteration,
        "world": "w",
        "command": f"go to the {color or ''} {noun}",
        "noun": noun,
        "color": color,
        "robot": PoseRecord(x=0.0, y=0.0, yaw=0.0),
        "objects": OBJECTS,
        "in_view": ("c",),
        "known_types": KNOWN,
        "target": "c",
        "correct": True,
        "kind": "known",
        "probability": 0.9,
        "asked": 0,
        "symbols": {},
        "path_length": 1.5,
        "turned": 1.0,
        "parsed": ParsedRecord(noun=noun, color=color),
        "seen": ("c", "d", "m", "c2"),
        "chosen": changes.get("target", "c"),
        "arrived": True,
        "collisions": 0,
        "expected_symbols": 3.0,
    } | changes
    values.setdefault("grounded", values["chosen"] if values["arrived"] else None)
    return Iteration(**values)


def timing(trial: int = 0, iteration: int = 0, **changes: Any) -> Timing:
    values: dict[str, Any] = {
        "trial": trial,
        "iteration": iteration,
        "load_world": 0.04,
        "parse": 0.004,
        "perceive": 0.06,
        "ground": 0.003,
        "groundings": 3,
        "explore": 0.08,
        "drive": 0.05,
        "train": 0.02,
        "train_steps": 30,
        "train_loss": 0.1,
        "train_rows": 400,
        "language_columns": 20,
        "grounding_columns": 15,
    }
    return Timing(**(values | changes))


def run(trials: int, iterations: int, seed: int = 0, *, skill: float = 0.97, away: bool = True) -> list[Iteration]:
    """A run of the paper's policy on random worlds: commit to the first fitting object, believe it for ever.

    `skill` is the chance that nothing else goes wrong; without `away` only what is in the first view counts.
    """
    rng = np.random.default_rng(seed)
    rows = []
    for trial in range(trials):
        symbols: dict[str, str] = {}
        met = set(KNOWN)
        for iteration in range(iterations):
            objects = _world(rng)
            target = objects[int(rng.integers(len(objects)))]
            color = target.color if rng.random() < 0.8 else None
            order = [objects[i] for i in rng.permutation(len(objects))]
            in_view = order[: int(rng.binomial(len(order), 0.13))]
            candidates = order if away else in_view
            met.add(target.type)
            kind: Kind = "known" if target.type in KNOWN else "learned" if target.type in symbols else "unknown"
            taken = {*KNOWN, *symbols.values()}
            meaning = target.type if kind == "known" else symbols.get(target.type)
            fitting = [
                o
                for o in candidates
                if (o.type == meaning or (meaning is None and o.type not in taken)) and color in (None, o.color)
            ]
            chosen = fitting[0] if fitting else None
            if chosen is not None and kind == "unknown":
                symbols = symbols | {target.type: chosen.type}
            lucky = bool(rng.random() < skill)
            correct = chosen == target and lucky
            parsed = lucky or rng.random() < 0.4
            seen = order[: order.index(chosen) + 1] if chosen else candidates
            rows.append(
                row(
                    trial,
                    iteration,
                    world=f"world_{int(rng.integers(10))}",
                    noun=target.type,
                    color=color,
                    objects=objects,
                    in_view=tuple(o.id for o in in_view),
                    target=target.id,
                    chosen=chosen.id if chosen else None,
                    correct=correct,
                    kind=kind,
                    probability=float(rng.beta(12, 2)) if chosen else None,
                    symbols=symbols,
                    arrived=(lucky if chosen else None),
                    parsed=ParsedRecord(noun=target.type, color=color) if parsed else None,
                    seen=tuple(o.id for o in seen),
                    path_length=math.dist(target.position, (0.0, 0.0)) * float(rng.uniform(0.8, 1.4)),
                    turned=float(rng.uniform(0.3, 5.0)),
                    expected_symbols=float(len(met)),
                )
            )
    return rows


def timings(rows: list[Iteration], seed: int = 0) -> list[Timing]:
    """Times of the size that this project's robot takes, growing a little with what was learned."""
    rng = np.random.default_rng(seed)
    return [
        timing(
            r.trial,
            r.iteration,
            drive=float(rng.uniform(0.03, 0.09)),
            explore=float(rng.uniform(0.02, 0.14)),
            train=0.015 + 0.001 * r.iteration,
            train_loss=0.08 + 0.002 * r.iteration,
            train_rows=400 + 30 * r.iteration,
            language_columns=20 + len(r.symbols),
            grounding_columns=15 + 2 * len(r.symbols),
        )
        for r in rows
    ]


PAPER: dict[str, Any] = {
    "worlds": "committed",
    "speaker": "canonical",
    "order": "drawn",
    "iterations": 10,
    "types": 8,
    "colors": 3,
    "object_rate": 0.15,
}
"""Settings by which a run is the paper's experiment."""


def write_run(
    folder: Path, rows: Sequence[Iteration], *, overrides: Sequence[str] | None = None, **config: Any
) -> Path:
    """A finished run folder with these rows and settings, and Hydra's list of overrides if any; the folder."""
    times = timings(list(rows))
    config = {"seed": 0, **config}
    write_summary(folder / "summary.json", folder.name, config, measure(rows), summarise_seconds(times))
    for name, lines in (("iterations", rows), ("timings", times)):
        (folder / f"{name}.jsonl").write_text("".join(line.model_dump_json() + "\n" for line in lines))
    if overrides is not None:
        (folder / ".hydra").mkdir(exist_ok=True)
        (folder / ".hydra" / "overrides.yaml").write_text("".join(f"- {line}\n" for line in overrides))
    return folder


def _world(rng: np.random.Generator) -> tuple[ObjectRecord, ...]:
    present: list[ObjectRecord] = []
    while not present:
        present = [
            thing(f"{color} {kind}", kind, color, *(round(float(v), 3) for v in rng.uniform(-3, 3, 2)))
            for kind in (*KNOWN, *NEW)
            for color in COLORS
            if rng.random() < 0.15
        ]
    return tuple(present)
