"""Made-up files in the forms of others, and what readers make of their conversions."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

from dcg_torch.evaluation.episodes import Episode, read_episodes
from dcg_torch.evaluation.importers.base import Converted


def episodes(found: Converted, folder: Path) -> dict[str, Episode]:
    """What a reader of episode files makes of the lines: id -> episode."""
    path = folder / "out.jsonl"
    path.write_text("\n".join(found.lines), encoding="utf-8")
    return {e.id: e for e in read_episodes(path)}


def left_out(found: Converted) -> dict[str, int]:
    return {f"{what}: {reason}": count for (what, reason), (count, _) in found.left_out.items()}


def thing(name: str, kind: str, place: str | None = "1,0,0", color: str = "na") -> str:
    at = "" if place is None else f' position="{place}"'
    return f'<object id="{name}" object_type="{kind}" object_color="{color}"{at} orientation="0,0,1,0"/>'


BASE = (thing("r", "robot", "1,2,0.4"), thing("a", "crate", "3,2,0", "red"), thing("b", "crate", "4,-1,0.5"))


def example(meant: str, *things: str, text: str | None = "go to the crate", parse: str | None = None) -> str:
    said = "" if text is None else f'<instruction text="{text}"/>'
    phrase = f'<VP><grounding_set>{meant}</grounding_set><VB text="go" order="0"/></VP>' if parse is None else parse
    world = f'<world time="0">{"".join(things or BASE)}</world>'
    return f'<?xml version="1.0" encoding="UTF-8"?>\n<root>{said}{world}{phrase}</root>'


def put(folder: Path, **files: str) -> Path:
    for name, content in files.items():
        path = folder / f"{name}.xml"
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(content, encoding="utf-8")
    return folder


def box(x: float, y: float, z: float, size: tuple[float, float, float]) -> list[list[float]]:
    return [
        [x + i * size[0] / 2, y + j * size[1] / 2, z + k * size[2] / 2]
        for i in (-1, 1)
        for j in (-1, 1)
        for k in (-1, 1)
    ]


def chair(name: str, x: float, **other: Any) -> dict[str, Any]:
    return {
        "object_id": name,
        "raw_label": "kitchen_chair",
        "nyu_label": "chair",
        "bbox": box(x, 1.0, 0.5, (0.4, 0.6, 1.0)),
        "color_labels": ["gray", "N/A"],
        "color_vals": [[105.0, 105.0, 105.0], ["_", "_", "_"]],
        **other,
    }


GRAPH = {
    "scene_name": "s",
    "regions": {"0": {"objects": [chair("0", 1.0), chair("1", 2.0, color_labels=["N/A"]), chair("2", 3.0, bbox=[])]}},
}
STATEMENTS = {
    "scene_name": "s",
    "regions": {
        "0": {
            "the gray chair": [{"target_index": "0", "target_class": "chair"}],
            "the chair on the right": [{"target_index": 1}, {"target_index": "1"}],
            "the chair": [{"target_index": "0"}, {"target_index": "1"}],
            "the lost chair": [{"target_index": "2"}],
            "the sofa": [],
        }
    },
}


def scene(folder: Path, graph: Any = GRAPH, statements: Any = STATEMENTS, name: str = "s") -> Path:
    (folder / f"{name}_scene_graph.json").write_text(json.dumps(graph))
    if statements is not None:
        (folder / f"{name}_referential_statements.json").write_text(json.dumps(statements))
    return folder


def node(name: int, tag: str, x: float, z: float = 0.5) -> dict[str, Any]:
    return {
        "id": name,
        "bbox_extent": [0.4, 0.4, 1.0],
        "bbox_center": [x, 1.0, z],
        "possible_tags": [tag],
        "object_tag": tag,
        "caption": f"a {tag}",
    }


def edge(first: Any, second: Any, relation: str) -> dict[str, Any]:
    return {"object1": first, "object2": second, "object_relation": relation, "reason": "seen"}
