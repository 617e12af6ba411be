"""Symbol dictionaries of h2sl as training files: a robot that knows their object types and colours, and no others.

The examples are those of `lessons/initial.yaml`, said of these types and colours, three at a time.
"""

from __future__ import annotations

import functools
import re
from collections.abc import Callable, Mapping, Sequence
from importlib.resources import files
from pathlib import Path
from typing import Any
from xml.etree.ElementTree import Element

import yaml
from pydantic import ValidationError

from dcg_torch.evaluation.importers.base import Converted, ImportFileError
from dcg_torch.lessons.files import TrainingFile
from dcg_torch.storage.untrusted_files import plain, problem_of, read_xml

_NO_TYPES = ("na", "robot", "")


def convert(path: Path, tick: Callable[[int], None] = lambda total: None) -> Converted:
    """The training file of a dictionary; its text is the one line.

    Args:
        tick: called at the end.

    Raises:
        ImportFileError: there is no such file, it is no symbol dictionary, or it has no types or colours.
    """
    lists = symbol_lists(read_xml(path, "symbol dictionary", ImportFileError))
    if lists is None:
        raise ImportFileError(f"{path}: no symbol dictionary in it; give a file with <symbol_dictionary>")
    types, colors = lists.pop("object_type", []), lists.pop("object_color_type", lists.pop("object_color", []))
    types = [t for t in types if t not in _NO_TYPES]
    named = [c for c in colors if c not in _NO_TYPES]
    colors = [c for c in named if len(c.split()) == 1]
    if not types or not colors:
        raise ImportFileError(f"{path}: names no object types or no colours; a robot that knows none can't be taught")
    content = training(types, colors)
    try:
        TrainingFile.model_validate(content)
    except ValidationError as error:
        raise ImportFileError(f"{path}: makes no training file: {problem_of(error, TrainingFile)}") from None
    found = Converted([yaml.safe_dump(content, sort_keys=False, allow_unicode=True, width=200)])
    if len(colors) < len(named):
        found.leave_out("symbol", "a colour of several words", path.name, len(named) - len(colors))
    for key, values in lists.items():
        reason = f"of {plain(key)}, for which a training file has no place"
        found.leave_out("symbol", reason, path.name, len(values))
    found.notes.append(plain(f"known: {', '.join(types)}; {', '.join(colors)}; give it to training=FILE", 300))
    tick(1)
    return found


def symbol_lists(root: Element) -> dict[str, list[str]] | None:
    """key -> values of a dictionary; None: the file holds none."""
    dictionary = root.find("symbol_dictionary")
    if dictionary is None:
        return None
    entries = (e for e in dictionary if e.tag in ("string_property", "int_property"))
    return {e.get("key", ""): [v.strip() for v in e.get("value", "").split(",")] for e in entries}


def training(types: Sequence[str], colors: Sequence[str]) -> dict[str, Any]:
    """The content of a training file that teaches these types and colours."""
    ours = _initial()
    old_types, old_colors = list(ours["symbols"]), ours["colors"]
    examples: list[Any] = []
    for k in range(0, max(len(types), len(colors)), len(old_types)):
        names = {old: types[(k + n) % len(types)] for n, old in enumerate(old_types)}
        names |= {old: colors[(k + n) % len(colors)] for n, old in enumerate(old_colors)}
        examples += [renamed(example, names) for example in ours["examples"] if _stay_apart(example, names)]
    return {"symbols": {t: t for t in types}, "colors": list(colors), "examples": examples}


@functools.cache
def _initial() -> Any:
    """The content of `lessons/initial.yaml`, read once; it is not to be changed."""
    return yaml.safe_load(files("dcg_torch.lessons").joinpath("initial.yaml").read_text("utf-8"))


def _stay_apart(example: Any, names: Mapping[str, str]) -> bool:
    """Whether no two words of an example get the same name; where there are fewer than three types some do."""
    said = set(re.findall(r"[a-z]+", str(example))) & set(names)
    return len({names[word] for word in said}) == len(said)


def renamed(value: Any, names: Mapping[str, str]) -> Any:
    """A value in which every word that has another name is called by it; what is seen is named once."""
    if isinstance(value, str):
        return re.sub(r"[a-z]+", lambda found: names.get(found[0], found[0]), value)
    if isinstance(value, dict):
        return {key: renamed(one, names) for key, one in value.items()}
    return list(dict.fromkeys(renamed(one, names) for one in value)) if isinstance(value, list) else value
