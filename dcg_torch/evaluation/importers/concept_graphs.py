"""ConceptGraphs: objects and relations of mapped scenes (concept-graphs/concept-graphs).

A scene is a folder. Its objects come from lists (or mappings) of objects with `object_tag`, `bbox_center` and
`bbox_extent`, as `scene_graph.json` has them, and from the ends of relations, lists of `object1`, `object2` and
`object_relation` as in `cfslam_object_relations.json`. The two files count objects differently, so an object is told
by its tag and box, not by its id.

The scenes have no commands. They are generated: "go to the TAG" where one object alone has the tag, and "go to the TAG
on the TAG" (or "in the") where a relation says so of one pair alone. Episodes say `"said_by": "generated"`.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Iterable
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from dcg_torch.evaluation.importers.base import (
    Converted,
    ImportFileError,
    LeftOut,
    files_below,
    numbers,
    read_json_file,
    reason_of,
)
from dcg_torch.storage.untrusted_files import plain

_NO_TAGS = ("fail", "invalid", "none", "")
_RELATIONS = {"a on b": ("on", False), "b on a": ("on", True), "a in b": ("in", False), "b in a": ("in", True)}
"""object_relation -> the preposition, and whether the second object is the one described."""

_Key = tuple[str, tuple[float, ...], tuple[float, ...]]
"""Tag, centre and extents."""


@dataclass
class _Scene:
    """What the files of a folder say: objects by tag and box, relations between them."""

    ids: dict[_Key, str] = field(default_factory=dict)
    relations: list[tuple[_Key, str, _Key]] = field(default_factory=list)
    _taken: set[str] = field(default_factory=set)

    def add(self, given: Any) -> _Key:
        """Take an object; it stays the same if it is there."""
        if not isinstance(given, dict):
            raise LeftOut("it is no object with tag and box")
        tag = given.get("object_tag")
        if not isinstance(tag, str) or tag.strip().lower() in _NO_TAGS:
            raise LeftOut("it has no tag, or one that says it failed")
        center, extent = (tuple(numbers(given.get(k), 3)) for k in ("bbox_center", "bbox_extent"))
        key = (" ".join(tag.split()), center, extent)
        if key not in self.ids:
            id_ = str(given.get("id", len(self.ids)))
            self.ids[key] = id_ if id_ not in self._taken else f"{id_} of {len(self.ids)}"
            self._taken.add(self.ids[key])
        return key


def convert(path: Path, tick: Callable[[int], None] = lambda total: None) -> Converted:
    """The scenes of a folder and below it, or that of one file.

    Args:
        tick: called after each file with the number of all.

    Raises:
        ImportFileError: there is no such path, or no JSON file in it.
    """
    found, files = Converted(), files_below(path, ".json")
    scenes: dict[Path, _Scene] = {}
    # Lists of objects first: their ids are the ones that the map has.
    contents = [(file, content) for file in files if (content := _content(file, path, found)) is not None]
    for relations in (False, True):
        for file, content in contents:
            if _holds_relations(content) is relations:
                _read(content, scenes.setdefault(file.parent, _Scene()), file.name, found)
                tick(len(files))
    for folder, scene in scenes.items():
        name = folder.name if folder == path or path.is_file() else folder.relative_to(path).as_posix()
        _say(scene, name, found)
    return found


def _content(file: Path, path: Path, found: Converted) -> list[Any] | None:
    try:
        content = read_json_file(file, "scene graph")
    except ImportFileError as error:
        if path == file:
            raise
        found.leave_out("file", reason_of(error, file), file.name)
        return None
    listed = list(content.values()) if isinstance(content, dict) else content
    if not isinstance(listed, list) or not any(isinstance(e, dict) and _KNOWN & e.keys() for e in listed):
        found.leave_out("file", "neither objects nor relations of ConceptGraphs", file.name)
        return None
    return listed


_KNOWN = {"object_tag", "object_relation"}


def _holds_relations(content: Iterable[Any]) -> bool:
    return any(isinstance(entry, dict) and "object1" in entry for entry in content)


def _read(content: Iterable[Any], scene: _Scene, where: str, found: Converted) -> None:
    for entry in content:
        pair = isinstance(entry, dict) and "object1" in entry
        try:
            if not pair:
                scene.add(entry)
                continue
            first, second = scene.add(entry["object1"]), scene.add(entry.get("object2"))
            relation = entry.get("object_relation")
            if not isinstance(relation, str) or relation not in _RELATIONS:
                raise LeftOut("it says neither on nor in")
            word, swapped = _RELATIONS[relation]
            scene.relations.append((second, word, first) if swapped else (first, word, second))
        except LeftOut as error:
            found.leave_out("relation" if pair else "object", str(error), where)


def _say(scene: _Scene, name: str, found: Converted) -> None:
    """Generate the commands of a scene."""
    objects = [
        {"id": id_, "type": tag, "position": [x, y, z - extent[2] / 2], "size": list(extent)}
        for (tag, (x, y, z), extent), id_ in scene.ids.items()
    ]
    tags = Counter(tag for tag, *_ in scene.ids)
    said = [(f"go to the {key[0]}", id_) for key, id_ in scene.ids.items() if tags[key[0]] == 1]
    pairs = Counter((a[0], word, b[0]) for a, word, b in dict.fromkeys(scene.relations))
    told = {a for a, word, b in scene.relations if pairs[a[0], word, b[0]] == 1}
    said += [
        (f"go to the {a[0]} {word} the {b[0]}", scene.ids[a])
        for a, word, b in dict.fromkeys(scene.relations)
        if pairs[a[0], word, b[0]] == 1
    ]
    untold = sum(tags[key[0]] > 1 and key not in told for key in scene.ids)
    if untold:
        found.leave_out("object", "others have its tag, so no command means it alone", plain(name), untold)
    for number, (text, target) in enumerate(said):
        record = {"id": f"{name}/{number}", "group": name, "text": text, "objects": objects, "target": [target]}
        found.add({**record, "said_by": "generated"}, plain(name))
