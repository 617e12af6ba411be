"""A session as a file: JSON lines, a header and then every input, each on disk before anything comes of it."""

from __future__ import annotations

import fcntl
import hashlib
import json
import os
from collections.abc import Sequence
from pathlib import Path
from typing import Annotated, Any, Literal, TypeVar

from pydantic import BaseModel, Field, ValidationError, model_validator

from dcg_torch.model.checkpoint import DESCRIPTION, WEIGHTS
from dcg_torch.model.pretrain import SHIPPED
from dcg_torch.storage.errors import UserError, explain_os_error
from dcg_torch.storage.untrusted_files import Strict, problem_of, read_json, read_text
from dcg_torch.world.files import FileName, Metres, Radians, World, WorldObject

MOST_CHARACTERS = 2_000
"""Of one text; the parser refuses much shorter ones in words."""


class SessionError(UserError):
    """A session that cannot be made or played; the message is one line."""


class Header(Strict):
    """What a session begins with; `sha256` is of the model's files, whose folder is `model`, None for the shipped."""

    dcg_torch_session: Literal[1] = 1
    world: World
    model: str | None = None
    sha256: str
    simulator: Literal["pybullet", "fake"] = "pybullet"
    seed: Annotated[int, Field(ge=0)] = 0


class Move(Strict):
    """An object that is put elsewhere; metres, radians."""

    id: FileName
    position: tuple[Metres, Metres]
    yaw: Radians | None = None


class Input(Strict):
    """One input: a text (with what was pointed at), a click, or a change of the world by hand.

    Or `stop`, a line of its own behind the input that it stopped: after how many events of it.
    """

    say: Annotated[str, Field(max_length=MOST_CHARACTERS)] | None = None
    pointing_at: str | None = None
    click: str | None = None
    add: WorldObject | None = None
    move: Move | None = None
    remove: str | None = None
    stop: Annotated[int, Field(ge=1)] | None = None

    @model_validator(mode="after")
    def _is_one(self) -> Input:
        kinds = (self.say, self.click, self.add, self.move, self.remove, self.stop)
        if sum(kind is not None for kind in kinds) != 1:
            raise ValueError("an input has one of say, click, add, move, remove and stop")
        return self


def model_hash(folder: Path | None) -> str:
    """A SHA-256 of the files of a saved model.

    Raises:
        SessionError: they cannot be read.
    """
    found = hashlib.sha256()
    for name in (DESCRIPTION, WEIGHTS):
        try:
            found.update(((folder or SHIPPED) / name).read_bytes())
        except OSError as error:
            raise SessionError(f"model: {explain_os_error(error)}") from None
    return found.hexdigest()


def checked_model(header: Header, file: Path) -> Header:
    """See that the model is the one that the session began with.

    Raises:
        SessionError: it is another one, or is not there.
    """
    if model_hash(None if header.model is None else Path(header.model)) != header.sha256:
        where = header.model or "the shipped model"
        raise SessionError(f"{file}: {where} is not what it was when this session began; put the old one back")
    return header


class SessionFile:
    """A session's file, open for more; it belongs to one process at a time.

    Args:
        path: of the file; its folder is made if need be.
        header: of a new file; None: the file is there.

    Attributes:
        header, inputs: what it held when it was opened.

    Raises:
        SessionError: it is there though it is to be new, or the other way round; another process has it, or a line of
            it is not valid. A last line that was cut short is dropped: nothing has come of it.
    """

    def __init__(self, path: Path, header: Header | None = None) -> None:
        self.path = path
        try:
            path.parent.mkdir(parents=True, exist_ok=True)
            flags = os.O_RDWR | os.O_APPEND | os.O_CLOEXEC | (os.O_CREAT | os.O_EXCL if header is not None else 0)
            self._descriptor = os.open(path, flags, 0o644)
        except FileExistsError:
            raise SessionError(f"{path}: this session is there already; open it, or give another name") from None
        except OSError as error:
            raise SessionError(explain_os_error(error)) from None
        try:
            fcntl.flock(self._descriptor, fcntl.LOCK_EX | fcntl.LOCK_NB)
            if header is not None:
                self.header: Header = header
                self.inputs: tuple[Input, ...] = ()
                self._write(header)
                return
            os.truncate(self._descriptor, path.read_bytes().rfind(b"\n") + 1)
            self.header, self.inputs = read_session(path)
        except BlockingIOError:
            self.close()
            raise SessionError(f"{path}: another process has this session; end it, or take another") from None
        except BaseException:
            self.close()
            raise

    def append(self, line: Input) -> None:
        """Put an input on disk.

        Raises:
            SessionError: the disk takes no more.
        """
        self._write(line)

    def _write(self, line: BaseModel) -> None:
        text = json.dumps(line.model_dump(mode="json", exclude_none=True), ensure_ascii=False) + "\n"
        try:
            os.write(self._descriptor, text.encode())
            os.fsync(self._descriptor)
        except OSError as error:
            raise SessionError(f"{self.path}: {explain_os_error(error)}") from None

    def close(self) -> None:
        """Let go of it; a second call does nothing."""
        if self._descriptor >= 0:
            os.close(self._descriptor)
        self._descriptor = -1


def read_session(path: Path) -> tuple[Header, tuple[Input, ...]]:
    """The header and the inputs of a session's file, but a last line that was cut short.

    Raises:
        SessionError: it is missing or not valid; the line is named.
    """
    lines = read_text(path, "session file", SessionError).split("\n")[:-1]
    if not lines:
        raise SessionError(f"{path}: holds no session; make a new one")
    header = _parsed(path, 1, lines[0], Header)
    return header, tuple(_parsed(path, number, line, Input) for number, line in enumerate(lines[1:], start=2))


def with_stops(inputs: Sequence[Input]) -> list[tuple[Input, int | None]]:
    """The inputs, each with the number of the event after which it was stopped."""
    found: list[tuple[Input, int | None]] = []
    for line in inputs:
        if line.stop is None:
            found.append((line, None))
        elif found:
            found[-1] = (found[-1][0], line.stop)
    return found


_T = TypeVar("_T", bound=BaseModel)


def _parsed(path: Path, number: int, line: str, kind: type[_T]) -> _T:
    try:
        values: dict[str, Any] = read_json(line)
        return kind.model_validate_json(json.dumps(values))
    except ValidationError as error:
        raise SessionError(f"{path}, line {number}: {problem_of(error, kind)}") from None
    except ValueError as error:
        raise SessionError(f"{path}, line {number}: {error}") from None
