"""Text, YAML, JSON and XML that somebody else wrote: read without surprises, and spoken of in one short line."""

from __future__ import annotations

import contextlib
import difflib
import functools
import json
import os
import unicodedata
from collections.abc import Hashable, Sequence
from pathlib import Path
from typing import Any, ClassVar
from xml.etree.ElementTree import Element, ParseError

import yaml
from pydantic import BaseModel, ConfigDict, ValidationError

_LONGEST = 60  # characters that a message quotes of a foreign file
_NEAR = 0.75  # how alike a misspelt key is to the right one


class Strict(BaseModel):
    """What a file must hold to the letter: no further key, no number that is not finite."""

    model_config = ConfigDict(frozen=True, extra="forbid", allow_inf_nan=False)


def shown(value: object, longest: int = _LONGEST) -> str:
    """A value of a foreign file as a message may quote it: short, text in quotes, no control characters."""
    if isinstance(value, str):
        text = f"'{plain(value[: longest + 1], longest)}'"
    elif isinstance(value, int) and not isinstance(value, bool) and value.bit_length() > 200:
        text = "a number of very many digits"
    elif isinstance(value, (dict, list, tuple, set)):
        text = f"{type(value).__name__} of {len(value)}"
    else:
        text = plain(repr(value)[: longest + 1], longest)
    return text


def plain(text: str, longest: int = _LONGEST) -> str:
    """Text in one line, at most so long, without control characters and other invisible ones."""
    clean = "".join(" " if unicodedata.category(c)[0] in "CZ" else c for c in text[: longest + 1])
    return clean if len(text) <= longest else clean[:longest] + "..."


@functools.lru_cache(1_024)
def misspelt(key: str, known: tuple[str, ...]) -> str | None:
    """The known key that a strange one must be meant for, if it is near one."""
    near = difflib.get_close_matches(key[:_LONGEST].casefold(), known, n=1, cutoff=_NEAR)
    return near[0] if near and near[0] != key else None


def read_text(path: Path, what: str, error: type[Exception], encoding: str = "utf-8") -> str:
    """The text of a file.

    Args:
        what: it is to be, as in "world file".
        error: what to raise, with a message of one line.

    Raises:
        error: the file is not there, is no file, or cannot be read.
    """
    try:
        if path.is_dir() or path.is_char_device() or path.is_block_device() or path.is_socket():
            raise error(f"{path}: this is no file, and no {what}")
        return path.read_text(encoding=encoding)
    except FileNotFoundError:
        raise error(f"{path}: no such {what}") from None
    except UnicodeDecodeError as wrong:
        raise error(f"{path}: not readable: no UTF-8 text ({wrong.reason}); unpack it, or save it as UTF-8") from None
    except (OSError, RuntimeError) as wrong:  # RuntimeError: links that lead in a circle, on older Pythons
        said = getattr(wrong, "strerror", None) or "its links lead in a circle"
        raise error(f"{path}: cannot be read: {said}") from None


def at_home(path: Path | str) -> Path:
    """A path as a user wrote it, with `~` as in a shell: where nobody's home is known, it stays as it is."""
    return Path(os.path.expanduser(path))


def pipe_in(directory: Path) -> Path | None:
    """A pipe in a folder or below it, where only files belong: who reads from it waits for ever."""
    for folder, _, names in os.walk(directory):
        for path in (Path(folder, name) for name in names):
            if path.is_fifo():
                return path
    return None


# What no file of ours has; a set would also come out in another order every time.
_STRANGE = ("set", "omap", "pairs", "binary")


class _Strict(yaml.constructor.SafeConstructor):
    """Makes plain Python values, and refuses a key that stands twice."""

    yaml_constructors: ClassVar[dict[Any, Any]] = {
        tag: make
        for tag, make in yaml.SafeLoader.yaml_constructors.items()
        if str(tag).rpartition(":")[2] not in _STRANGE
    }

    def construct_mapping(self, node: yaml.MappingNode, deep: bool = False) -> dict[Hashable, Any]:
        seen: set[str] = set()
        for key, _ in node.value:
            if isinstance(key, yaml.ScalarNode) and key.tag != "tag:yaml.org,2002:merge":
                if key.value in seen:
                    raise yaml.constructor.ConstructorError(
                        None, None, f"the key {shown(key.value)} is there twice", key.start_mark
                    )
                seen.add(key.value)
        return super().construct_mapping(node, deep)


class _Loader(_Strict, yaml.SafeLoader):
    """PyYAML's own."""


class _QuickLoader(_Strict, getattr(yaml, "CSafeLoader", yaml.SafeLoader)):  # type: ignore[misc]
    """PyYAML's over libyaml, where it is there: ten times as fast; its messages say less."""


# Beside its own errors PyYAML lets through what Python says of a date, a number or a tag that makes no sense.
_UNREADABLE = (ValueError, ArithmeticError, LookupError, TypeError, AttributeError)


def read_yaml(path: Path, what: str, error: type[Exception]) -> Any:
    """The content of a YAML file, as plain Python values; arguments and what is raised as in `read_text`."""
    text = read_text(path, what, error)
    with contextlib.suppress(yaml.YAMLError, RecursionError, *_UNREADABLE):
        return yaml.load(text, _QuickLoader)
    try:
        return yaml.load(text, _Loader)  # reads it after all, or says what is wrong
    except yaml.MarkedYAMLError as wrong:
        mark = wrong.problem_mark or wrong.context_mark
        where = f"line {mark.line + 1}: " if mark else ""
        raise error(
            f"{path}: not readable as YAML: {where}{plain(wrong.problem or wrong.context or '', 120)}"
        ) from None
    except yaml.YAMLError as wrong:
        raise error(f"{path}: not readable as YAML: {plain(str(wrong), 120)}") from None
    except RecursionError:
        raise error(
            f"{path}: not readable as YAML: brackets or aliases within one another beyond all measure"
        ) from None
    except _UNREADABLE:
        raise error(f"{path}: not readable as YAML: a date, number or tag in it makes no sense") from None


def read_json(text: str) -> Any:
    """A JSON value in which no key stands twice.

    Raises:
        ValueError: it is no JSON, or a key repeats; the message is short.
    """

    def once(pairs: list[tuple[str, Any]]) -> dict[str, Any]:
        made = dict(pairs)
        if len(made) < len(pairs):
            keys = [key for key, _ in pairs]
            raise ValueError(f"the key {shown(next(k for k in keys if keys.count(k) > 1))} is there twice")
        return made

    try:
        return json.loads(text, object_pairs_hook=once)
    except json.JSONDecodeError as wrong:
        raise ValueError(f"no JSON at character {wrong.pos + 1}: {plain(wrong.msg)}") from None
    except RecursionError:
        raise ValueError("brackets within one another beyond all measure") from None


def read_xml(path: Path, what: str, error: type[Exception]) -> Element:
    """The root of an XML file without a document type, so without entities; see `read_text`."""
    try:
        from defusedxml import ElementTree, common  # here: of an extra, and few files are XML
    except ModuleNotFoundError:
        raise error(
            f"{path}: XML needs defusedxml, of the extra convert: pip install 'dcg-torch[convert]', "
            "in a checkout pip install -e '.[convert]'"
        ) from None
    text = read_text(path, what, error, "utf-8-sig")
    try:
        root: Element = ElementTree.fromstring(text, forbid_dtd=True)
    except common.DefusedXmlException:
        raise error(f"{path}: not read as XML: it declares a document type or entities; remove them") from None
    except (ParseError, ValueError) as wrong:
        raise error(f"{path}: not readable as XML: {plain(str(wrong), 120)}") from None
    return root


def problem_of(error: ValidationError, model: type[BaseModel]) -> str:
    """The first thing that is wrong, as "objects.0.colour: there is no such key; did you mean color?".

    Args:
        error: what pydantic found wrong in a foreign value.
        model: what the value was to be; its keys are what a misspelt one is compared with.
    """
    first = min(error.errors(include_url=False, include_context=False), key=_rank)
    where = _place(first["loc"])
    if first["type"] == "extra_forbidden":
        near = misspelt(str(first["loc"][-1]), keys_of(model))
        return f"{where}: there is no such key, it is not permitted" + (f"; did you mean {near}?" if near else "")
    if first["type"] == "missing":
        return f"{where}: it is required"
    said = plain(first["msg"].removeprefix("Value error, "), 160)
    given = first["input"]
    quoted = given is None or isinstance(given, (str, int, float, bool))
    return f"{where}: {said}" + (f", not {shown(given)}" if quoted and first["type"] != "value_error" else "")


def _rank(problem: Any) -> bool:
    """A misspelt key before the key that is missing because of it."""
    return bool(problem["type"] != "extra_forbidden")


def _place(parts: Sequence[int | str]) -> str:
    return ".".join(plain(str(part), 40) for part in parts) or "the file"


def keys_of(model: type[BaseModel]) -> tuple[str, ...]:
    """All keys of a model and of those within it."""
    found: dict[str, None] = {}
    for definition in (schema := model.model_json_schema()).get("$defs", {}).values():
        found |= dict.fromkeys(definition.get("properties", {}))
    return (*schema.get("properties", {}), *found)
