"""A folder that belongs to one process at a time."""

from __future__ import annotations

import contextlib
import errno
import fcntl
import os
from collections.abc import Collection, Iterator
from pathlib import Path

from dcg_torch.storage.atomic_files import sweep_parts
from dcg_torch.storage.errors import UserError
from dcg_torch.storage.untrusted_files import at_home

LOCK = ".lock"


class ClaimError(UserError):
    """A folder that cannot be taken; the message is one line."""


@contextlib.contextmanager
def claim(directory: Path, marks: Collection[str] = (), *, setting: str = "hydra.run.dir") -> Iterator[int | None]:
    """Own a folder for the length of a `with` block: nobody else who claims it gets past the first line.

    The folder is made if need be. The lock is the kernel's and ends with the process that holds it, however that
    ends. What an earlier owner left half written is removed.

    Args:
        directory: the folder.
        marks: names of which a folder that is not empty must hold one, so that nobody's other files are mixed with
            ours. Empty: any folder will do.
        setting: what the user names the folder with, for the message.

    Yields:
        The number of the process that was killed while it had the folder, if one was.

    Raises:
        ClaimError: another process has it, it holds other things, or it is no place for a folder.
    """
    check_place(directory, marks, setting=setting)
    descriptor = _locked(directory, setting)
    try:
        killed = os.read(descriptor, 20)
        os.pwrite(descriptor, f"{os.getpid()}\n".encode(), 0)
        sweep_parts(directory)
        yield int(killed) if killed.strip().isdigit() else None
    finally:
        with contextlib.suppress(OSError):
            (directory / LOCK).unlink()
        os.close(descriptor)


def check_place(directory: Path, marks: Collection[str] = (), *, setting: str = "hydra.run.dir") -> None:
    """See that a folder may be taken, without touching it.

    Raises:
        ClaimError: it is the root, the home or the working folder, is no folder, or holds other things.
    """
    try:
        where = directory.absolute().resolve()
        if where in (Path("/"), at_home("~").resolve(), Path.cwd().resolve()) or str(directory) == "":
            raise ClaimError(f"{setting}={directory}: this is {where} itself; give a folder of its own")
        if directory.exists() and not directory.is_dir():
            raise ClaimError(f"{setting}={directory}: this is no folder; give another name")
        there = {entry.name for entry in directory.iterdir()} if directory.exists() else set()
    except OSError as error:
        raise ClaimError(f"{setting}={directory}: {error.strerror}; give another folder") from None
    except RuntimeError:  # links that lead in a circle
        raise ClaimError(f"{setting}={directory}: its links lead in a circle; give another folder") from None
    if marks and there and there.isdisjoint({LOCK, *marks}):
        raise ClaimError(f"{setting}={directory}: holds other files, {min(there)} for one; give a folder of its own")


def _locked(directory: Path, setting: str) -> int:
    """The open lock file, locked."""
    while True:
        try:
            directory.mkdir(parents=True, exist_ok=True)
            descriptor = os.open(directory / LOCK, os.O_RDWR | os.O_CREAT | os.O_CLOEXEC, 0o644)
        except OSError as error:
            said = f"{setting}={directory}: {error.strerror}"
            raise ClaimError(f"{said}; give a folder that can be made and written") from None
        try:
            fcntl.flock(descriptor, fcntl.LOCK_EX | fcntl.LOCK_NB)
            # The owner before may have removed the file between the two lines above: then this is a lock on nothing.
            if os.path.samestat(os.fstat(descriptor), os.stat(directory / LOCK)):
                return descriptor
        except FileNotFoundError:
            pass
        except OSError as error:
            os.close(descriptor)
            said = f"{setting}={directory}: {error.strerror}; give a folder on a disk that knows locks"
            if error.errno in (errno.EWOULDBLOCK, errno.EACCES):
                said = f"{setting}={directory}: another process works in this folder; wait for it, or give another"
            raise ClaimError(said) from None
        os.close(descriptor)
