"""What came of other people's files: the lines of an episode file, and what was left out and why."""

from __future__ import annotations

import json
import re
from collections.abc import Callable, Iterator
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from dcg_torch.evaluation.episodes import EpisodeError, parse_episode
from dcg_torch.storage.errors import UserError
from dcg_torch.storage.untrusted_files import plain, read_json, read_text


class ImportFileError(UserError):
    """A file of others that is missing or cannot be read as what it is to be; the message is one line."""


class LeftOut(Exception):
    """A part of a file that makes no episode; the message is the reason, and the same for all of its kind."""


@dataclass
class Converted:
    """The lines of a file to be written, and what is not in it.

    Attributes:
        lines: one JSON object each, valid episodes with an id of their own.
        left_out: (what, reason) -> how many, and where the first one is.
        notes: what else the user should know, a line each.
    """

    lines: list[str] = field(default_factory=list)
    left_out: dict[tuple[str, str], tuple[int, str]] = field(default_factory=dict)
    notes: list[str] = field(default_factory=list)
    _ids: set[str] = field(default_factory=set)

    def add(self, record: dict[str, Any], where: str) -> None:
        """Take an episode, or leave it out if it is not a valid one."""
        try:
            line = json.dumps(record, ensure_ascii=False, allow_nan=False)
            episode = parse_episode(line, "")
        except EpisodeError as error:
            reason = str(error).removeprefix(": ").partition(";")[0]
            self.leave_out("episode", re.sub(r"\.\d+", "", reason), where)
            return
        except (ValueError, TypeError):
            self.leave_out("episode", "a number is not finite", where)
            return
        if episode.id in self._ids:
            self.leave_out("episode", "another one has its id", where)
            return
        self._ids.add(episode.id)
        self.lines.append(line)

    def leave_out(self, what: str, reason: str, where: str, number: int = 1) -> None:
        """Count something that is not in the lines."""
        count, first = self.left_out.get((what, reason), (0, where))
        self.left_out[what, reason] = count + number, first

    def told(self) -> Iterator[str]:
        """What was left out, a line each, the most first; then the notes."""
        for (what, reason), (count, first) in sorted(self.left_out.items(), key=lambda item: (-item[1][0], item[0])):
            yield plain(f"left out: {count} {what}{'s' * (count > 1)}: {reason} (first: {first})", 300)
        yield from self.notes


def files_below(path: Path, suffix: str) -> list[Path]:
    """The file itself, or all files of a folder and below it that end so, sorted.

    Raises:
        ImportFileError: there is no such path, or no such file in the folder.
    """
    try:
        if not path.is_dir():
            if not path.exists():
                raise ImportFileError(f"{path}: no such file or folder")
            return [path]
        found = sorted(one for one in path.rglob(f"*{suffix}") if one.is_file())
    except (OSError, RuntimeError) as error:
        said = getattr(error, "strerror", None) or "its links lead in a circle"
        raise ImportFileError(f"{path}: cannot be read: {said}") from None
    if not found:
        raise ImportFileError(f"{path}: holds no file that ends in {suffix}; give another folder, or a file")
    return found


def each_file(
    found: Converted, path: Path, suffix: str, what: str, take: Callable[[Path, str], None], tick: Callable[[int], None]
) -> None:
    """Take what is in a file, or in each file of a folder and below it; what can't be read in a folder is left out.

    Args:
        found: says what was left out.
        what: a file holds, to be counted as left out.
        take: is given each file and its name below the folder.
        tick: called after each file with the number of all.

    Raises:
        ImportFileError: there is no such path or file, or the only one cannot be read.
    """
    files = files_below(path, suffix)
    for file in files:
        where = name_of(file, path, suffix)
        try:
            take(file, where)
        except LeftOut as error:
            found.leave_out(what, str(error), where)
        except ImportFileError as error:
            if path == file:
                raise
            found.leave_out(what, reason_of(error, file), where)
        tick(len(files))


def name_of(path: Path, root: Path, suffix: str) -> str:
    """A file's name below the folder that was given, without its suffix: the beginning of its episodes' ids."""
    below = path.relative_to(root) if root in path.parents else Path(path.name)
    return below.as_posix().removesuffix(suffix)


def read_json_file(path: Path, what: str) -> Any:
    """The content of a JSON file.

    Raises:
        ImportFileError: it is missing or not JSON.
    """
    try:
        return read_json(read_text(path, what, ImportFileError, "utf-8-sig"))
    except ImportFileError:
        raise
    except ValueError as error:
        raise ImportFileError(f"{path}: not readable as JSON: {error}") from None


def reason_of(error: Exception, path: Path) -> str:
    """The message of an error about a file, without the file and the place in it, so that such errors add up."""
    return re.sub(r":? (line|at character) \d+(, column \d+)?", "", str(error).removeprefix(f"{path}: "))


def numbers(values: Any, count: int) -> list[float]:
    """So many numbers of a foreign list.

    Raises:
        LeftOut: there are others, or something that is none.
    """
    try:
        found = [float(value) for value in values]
    except (TypeError, ValueError, OverflowError):
        raise LeftOut("a place or size is not given in numbers") from None
    if len(found) != count:
        raise LeftOut("a place or size has too few or too many numbers")
    return found
