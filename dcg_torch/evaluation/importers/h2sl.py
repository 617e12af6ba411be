"""Examples of h2sl (Human-to-Structured-Language; tmhoward/h2sl): an instruction, a world, a parse with its symbols.

What an instruction means is read off the grounding set of its whole phrase: the objects listed there, those of the
containers (groups, rows), or what its constraints are about. A constraint on the robot is about its reference, "go to
the crate"; one on a thing about that thing, "put the block on the table". Robots are no objects of an episode. One
robot gives the pose; where there are several (the hands of an arm) that is the origin. In these worlds "in front"
is along x whatever way a robot's orientation points, so the heading is 0.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any
from xml.etree.ElementTree import Element

from dcg_torch.evaluation.importers.base import Converted, ImportFileError, LeftOut, each_file, numbers
from dcg_torch.storage.untrusted_files import read_xml

_NONE = (None, "", "na")
_ROBOT = "robot"


def convert(path: Path, tick: Callable[[int], None] = lambda total: None) -> Converted:
    """The examples of a file, or of all XML files of a folder and below it.

    Args:
        tick: called after each file with the number of all.

    Raises:
        ImportFileError: there is no such path, or no XML file in it.
    """
    found = Converted()

    def take(file: Path, where: str) -> None:
        record, skipped = example(read_xml(file, "h2sl example", ImportFileError))
        found.add({"id": where, **record}, where)
        for reason, count in skipped.items():
            found.leave_out("object", reason, where, count)

    each_file(found, path, ".xml", "file", take, tick)
    return found


def example(root: Element) -> tuple[dict[str, Any], dict[str, int]]:
    """The episode of an example, without its id, and what objects are not in it: reason -> number.

    Raises:
        LeftOut: it makes none.
    """
    if root.find("symbol_dictionary") is not None:
        raise LeftOut("a symbol dictionary; convert it with h2sl_symbols")
    instruction, world = root.find("instruction"), root.find("world")
    if world is None:
        raise LeftOut("no world in it")
    text = None if instruction is None else instruction.get("text")
    if not text or not text.strip():
        raise LeftOut("no text of the instruction")
    phrases = [child for child in root if child.tag.isupper()]  # VP, NP ...
    if len(phrases) != 1:
        raise LeftOut("no parse" if not phrases else "several parses")
    everything = {_attribute(o, "id", "name"): o for o in world.findall("object")}
    if None in everything or len(everything) < len(world.findall("object")):
        raise LeftOut("an object has no id, or that of another")
    robots = [name for name, o in everything.items() if _attribute(o, "object_type", "type") == _ROBOT]
    strange = [name for name, o in everything.items() if _attribute(o, "object_type", "type") in _NONE]
    objects = [_object(o) for name, o in everything.items() if name not in (*robots, *strange)]
    if not objects:
        raise LeftOut("no objects but robots in its world")
    target = _target(phrases[0], robots, strange)
    record: dict[str, Any] = {"text": text, "objects": objects, "target": target}
    if robots:
        x, y, _ = _position(everything[robots[0]]) if len(robots) == 1 else (0.0, 0.0, 0.0)
        record["robot"] = {"x": x, "y": y, "yaw": 0.0}
    skipped = {"a robot, which is no object of an episode": len(robots), "its type is na": len(strange)}
    return record, {reason: count for reason, count in skipped.items() if count}


def _attribute(element: Element, *names: str) -> str | None:
    """The first of some attributes that is there: older files have other names."""
    return next((value for name in names if (value := element.get(name)) is not None), None)


def _object(element: Element) -> dict[str, Any]:
    color = _attribute(element, "object_color", "color")
    return {
        "id": _attribute(element, "id", "name"),
        "type": _attribute(element, "object_type", "type"),
        "color": None if color in _NONE else color,
        "position": _position(element),
    }


def _position(element: Element) -> list[float]:
    given = element.get("position")
    if given is None:
        raise LeftOut("an object has no position")
    return numbers(given.replace(",", " ").split(), 3)


def _target(phrase: Element, robots: list[str | None], strange: list[str | None]) -> list[str]:
    """The ids of what the whole phrase means."""
    meant = phrase.find("grounding_set")
    meant = phrase.find("grounding/grounding_set") if meant is None else meant
    if meant is None:
        raise LeftOut("no grounding of the whole phrase")
    ids = _listed(meant)
    ids = ids or [one for container in meant.findall("container") for one in _listed(container)]
    ids = ids or [_about(c.attrib, robots) for c in meant.findall("constraint")]
    named = [one for one in dict.fromkeys(ids) if one]
    if not named:
        raise LeftOut("its grounding names no object")
    things = [one for one in named if one not in robots]
    if not things:
        raise LeftOut("it means the robot")
    if any(one in strange for one in things):
        raise LeftOut("it means an object whose type is na")
    return things


def _listed(element: Element) -> list[str | None]:
    """The ids of the objects within an element, or in its list of ids."""
    within = [_attribute(o, "id", "name") for o in element.findall("object")]
    return within or [one.strip() for one in element.get("object_ids", "").split(",") if one.strip()]


def _about(constraint: Mapping[str, str], robots: list[str | None]) -> str | None:
    payload = constraint.get("payload")
    return constraint.get("reference") if payload is None or payload in robots else payload
