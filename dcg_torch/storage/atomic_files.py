"""A file that is there with all its content, or not there."""

from __future__ import annotations

import contextlib
import errno
import glob
import os
import secrets
import shutil
import time
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path

_MARK = ".part"


def write_whole(path: Path, content: bytes | str | Callable[[Path], object]) -> Path:
    """Write `path` so that readers, and those who come after a kill, meet the old content or the new one.

    The content goes into a hidden file in the same folder, to the disk, and then takes the place of `path`.

    Args:
        path: its folder is made if need be.
        content: bytes, text (as UTF-8), or a function that writes to the path it is given. That path has the same
            suffix as `path`, for those who tell a format by it.

    Returns:
        `path`.

    Raises:
        OSError: it cannot be written; nothing is left behind.
    """
    path.parent.mkdir(parents=True, exist_ok=True)
    if path.is_dir():
        raise IsADirectoryError(errno.EISDIR, os.strerror(errno.EISDIR), str(path))
    part = _part_of(path)
    try:
        if callable(content):
            content(part)
        else:
            part.write_bytes(content.encode("utf-8") if isinstance(content, str) else content)
        _to_disk(part)
        os.replace(part, path)
    except BaseException:
        with contextlib.suppress(OSError):
            part.unlink()
        raise
    return path


def write_whole_files(directory: Path, contents: Mapping[str, bytes]) -> None:
    """Write files that belong together, so that those of two writings never stand beside each other.

    All are on the disk before the first takes its place. The last of the old ones goes first and the last of the new
    ones comes last: while it is there, all others are of one writing with it.

    Args:
        directory: is made if need be; other files in it stay.
        contents: name -> content; `read_whole_files` reads them.

    Raises:
        OSError: they cannot be written; if there is no room for them, the old ones stay.
    """
    directory.mkdir(parents=True, exist_ok=True)
    paths = [directory / name for name in contents]
    for path in paths:
        if path.is_dir():
            raise IsADirectoryError(errno.EISDIR, os.strerror(errno.EISDIR), str(path))
    parts = [_part_of(path) for path in paths]
    try:
        for part, content in zip(parts, contents.values(), strict=True):
            part.write_bytes(content)
            _to_disk(part)
        if paths[-1].exists():
            paths[-1].unlink()
            _to_disk(directory)
        for part, path in zip(parts, paths, strict=True):
            os.replace(part, path)
            _to_disk(directory)
    except BaseException:
        for part in parts:
            with contextlib.suppress(OSError):
                part.unlink()
        raise


def read_whole_files(directory: Path, names: Sequence[str]) -> dict[str, bytes]:
    """Read files that `write_whole_files` wrote, all of one writing, even while they are written anew.

    Args:
        names: in the order in which they were written.

    Raises:
        OSError: one cannot be read, or is missing for longer than a writing takes.
    """
    *others, last = names
    until = time.monotonic() + _PATIENCE
    while True:
        try:
            with (directory / last).open("rb") as file:
                found = {name: (directory / name).read_bytes() for name in others} | {last: file.read()}
                now = (directory / last).stat()
                if _version(os.fstat(file.fileno())) == _version(now):  # so none was replaced before all were read
                    return found
        except FileNotFoundError:
            if time.monotonic() > until or not _under_way(directory, others, last):
                raise
        time.sleep(0.01)


_PATIENCE = 1.0  # seconds


def _version(status: os.stat_result) -> tuple[int, int, int]:
    return status.st_dev, status.st_ino, status.st_mtime_ns


def _under_way(directory: Path, others: Sequence[str], last: str) -> bool:
    """Whether a writing may be between taking away what is old and putting in place what is new, or has just been."""
    if directory.exists():
        return any((directory / name).exists() for name in (*others, last))
    return any(directory.parent.glob(f".{glob.escape(directory.name)}.*{_MARK}"))


def _part_of(path: Path) -> Path:
    """A hidden place beside `path`, with its suffix."""
    return path.with_name(f".{path.stem[:100]}.{secrets.token_hex(4)}{_MARK}{path.suffix}")


def sweep_parts(directory: Path) -> None:
    """Remove what killed writers left in a folder and below it; only for the folder's owner."""
    for part in directory.rglob(f".*{_MARK}*"):
        remove(part)


def remove(path: Path) -> None:
    """Remove a file, a link, or a folder with all that is in it."""
    if path.is_dir() and not path.is_symlink():
        shutil.rmtree(path, ignore_errors=True)
    else:
        path.unlink(missing_ok=True)


def _to_disk(path: Path) -> None:
    descriptor = os.open(path, os.O_RDONLY)
    try:
        os.fsync(descriptor)
    finally:
        os.close(descriptor)


def write_whole_folder(path: Path, content: Callable[[Path], object]) -> Path:
    """Write a folder of files, whole or not at all: `content` fills an empty one, which takes the place of `path`.

    Raises:
        OSError: it cannot be written; the old folder stays, if there was one.
    """
    path.parent.mkdir(parents=True, exist_ok=True)
    part, old = (path.with_name(f".{path.name}.{secrets.token_hex(4)}{_MARK}") for _ in range(2))
    part.mkdir()
    try:
        content(part)
        for file in part.rglob("*"):
            if file.is_file():
                _to_disk(file)
        if os.path.lexists(path):  # a link to nowhere, too
            os.rename(path, old)
        os.rename(part, path)
    finally:
        for rest in (part, old):
            with contextlib.suppress(OSError):
                remove(rest)
    return path
