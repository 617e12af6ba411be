"""IRef-VLA: scene graphs of scanned rooms with referential statements (HaochenZ11/IRef-VLA).

A scene has two files side by side, SCENE_scene_graph.json and SCENE_referential_statements.json. A statement is an
episode in the region of the scene that it is about. A type is the label that the statements use (`nyu_label`), a
colour the first of the object's; a place is the middle of the box's floor, a size its extents along the axes of
the map. Where the speaker stands is not known. False statements are not read.
"""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any

from dcg_torch.evaluation.importers.base import Converted, LeftOut, each_file, numbers, read_json_file

_GRAPH, _STATEMENTS = "_scene_graph.json", "_referential_statements.json"
_NONE = (None, "", "N/A", "_")


def convert(path: Path, tick: Callable[[int], None] = lambda total: None) -> Converted:
    """The statements of a scene, given by one of its files, or of all scenes of a folder and below it.

    Args:
        tick: called after each scene with the number of all.

    Raises:
        ImportFileError: there is no such path, or no scene graph in it.
    """
    if path.name.endswith(_STATEMENTS):
        path = path.with_name(path.name.removesuffix(_STATEMENTS) + _GRAPH)
    found = Converted()
    each_file(found, path, _GRAPH, "scene", lambda file, where: _scene(file, where, found), tick)
    return found


def _scene(file: Path, where: str, found: Converted) -> None:
    graph = _regions(read_json_file(file, "scene graph"))
    beside = file.with_name(file.name.removesuffix(_GRAPH) + _STATEMENTS)
    if not beside.exists():
        raise LeftOut("no statements beside its scene graph")
    for region, statements in _regions(read_json_file(beside, "statements")).items():
        at = f"{where}/{region}"
        objects = _objects(graph.get(region), at, found)
        if not isinstance(statements, dict):
            found.leave_out("region", "its statements are no mapping", at)
            continue
        for number, (text, about) in enumerate(statements.items()):
            try:
                record = {"id": f"{at}/{number}", "group": where, "text": text, "objects": objects}
                found.add({**record, "target": [_target(about)]}, at)
            except LeftOut as error:
                found.leave_out("statement", str(error), f"{at}/{number}")


def _regions(content: Any) -> dict[str, Any]:
    regions = content.get("regions") if isinstance(content, dict) else None
    if not isinstance(regions, dict):
        raise LeftOut("no regions in it")
    return regions


def _objects(region: Any, at: str, found: Converted) -> list[dict[str, Any]]:
    """The objects of a region; one that has no label or box is left out."""
    listed = region.get("objects") if isinstance(region, dict) else None
    objects = []
    for given in listed if isinstance(listed, list) else []:
        try:
            objects.append(_object(given))
        except LeftOut as error:
            found.leave_out("object", str(error), at)
    return objects


def _object(given: Any) -> dict[str, Any]:
    if not isinstance(given, dict) or given.get("nyu_label") in _NONE or given.get("object_id") in _NONE:
        raise LeftOut("no id or label")
    corners = given.get("bbox")
    if not isinstance(corners, list) or not corners:
        raise LeftOut("no box")
    axes = list(zip(*(numbers(corner, 3) for corner in corners), strict=True))
    low, high = [min(axis) for axis in axes], [max(axis) for axis in axes]
    middle = [(a + b) / 2 for a, b in zip(low, high, strict=True)]
    record: dict[str, Any] = {
        "id": str(given["object_id"]),
        "type": given["nyu_label"],
        "color": _first(given.get("color_labels")),
        "position": [middle[0], middle[1], low[2]],
        "size": [b - a for a, b in zip(low, high, strict=True)],
    }
    shade = _first(given.get("color_vals"))
    return record if record["color"] is None or shade is None else {**record, "rgb": numbers(shade, 3)}


def _first(values: Any) -> Any:
    """The first of a list; None where there is none, or where it says that there is none."""
    value = values[0] if isinstance(values, list) and values else None
    return None if isinstance(value, str) and value in _NONE else value


def _target(about: Any) -> str:
    """The one object that a statement means."""
    entries = about if isinstance(about, list) else []
    meant = {str(e["target_index"]) for e in entries if isinstance(e, dict) and "target_index" in e}
    if len(meant) != 1:
        raise LeftOut("no object is meant" if not meant else "the same words are said of several objects")
    return meant.pop()
