"""Made-up episodes, all our own: one object of a type and colour, and others that differ from it."""

from __future__ import annotations

import json
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np

COLORS = ("red", "green", "teal")


def episode(k: int, rng: np.random.Generator, noun: str, type_: str, color: str, word: str | None = None) -> Any:
    """One object of the type and colour, and others that differ in both; in every second episode, in one of them."""
    other = "cube" if type_ == "prism" else "prism"
    things = [(type_, color), *((other, c) for c in COLORS if c != color)]
    things += [(other, color), *((type_, c) for c in COLORS if c != color)] if k % 2 else []
    places = rng.uniform(1.0, 8.0, size=(len(things), 2)).round(2).tolist()
    objects = [
        {"id": f"o{j}", "type": t, "color": c, "position": [x, y]}
        for j, ((t, c), (x, y)) in enumerate(zip(things, places, strict=True))
    ]
    text = f"pick up the {word or color} {noun}"
    return {"id": f"e{k}", "text": text, "robot": {"x": 0, "y": 0, "yaw": 0}, "objects": objects, "target": ["o0"]}


def write(path: Path, rows: Sequence[Any]) -> Path:
    path.write_text("".join(json.dumps(row) + "\n" for row in rows), encoding="utf-8")
    return path
