"""What visitors take home and bring along: worlds, models, sessions, as files of the browser.

All functions, and those that they return, run in the session's thread; `file` is the one that keeps the session.
"""

from __future__ import annotations

import io
import itertools
import shutil
import tempfile
import zipfile
import zlib
from collections.abc import Callable
from pathlib import Path

from dcg_torch.apps.talk.host import Change
from dcg_torch.dialogue.export import export_episodes, export_gif
from dcg_torch.dialogue.session import Session
from dcg_torch.storage.atomic_files import remove
from dcg_torch.storage.errors import UserError
from dcg_torch.world.files import load_world

MOST = 64_000_000
"""Bytes of a file that a visitor may bring along, packed or not."""


def _save_model(session: Session, file: Path, to: Path) -> None:
    with tempfile.TemporaryDirectory() as folder:
        session.save_model(Path(folder) / "model")
        shutil.make_archive(str(to.with_suffix("")), "zip", f"{folder}/model")


SAVED: dict[str, tuple[str, Callable[[Session, Path, Path], object]]] = {
    "World": ("world.yaml", lambda session, file, to: session.save_world(to)),
    "Model": ("model.zip", _save_model),
    "Session": ("session.jsonl", lambda session, file, to: shutil.copy(file, to)),
    "Episodes": ("episodes.jsonl", lambda session, file, to: export_episodes(file, to)),
    "GIF": ("session.gif", lambda session, file, to: export_gif(file, to)),
}
"""What visitors may have -> the name of the file, and what writes it."""


def saved(what: str, session: Session, file: Path) -> bytes:
    """The content of one of the files that `SAVED` lists, for a visitor to take home."""
    name, write = SAVED[what]
    with tempfile.TemporaryDirectory() as folder:
        write(session, file, Path(folder) / name)
        return (Path(folder) / name).read_bytes()


def with_world(file: Path, content: bytes) -> Change:
    """A new session in the world of a YAML file, with all that the robot has learned."""

    def make(session: Session, model: Path, fresh: Path) -> Session:
        with tempfile.TemporaryDirectory() as place:
            path = Path(place) / "world.yaml"
            path.write_bytes(content)
            world = load_world(path)
        session.save_model(model)
        return Session(world, model, file=fresh, simulator=session.header.simulator)

    return lambda session: _exchange(session, file, make)


def with_model(file: Path, content: bytes) -> Change:
    """A new session in the same world, with the model of a zip file that `model_file` made."""

    def make(session: Session, model: Path, fresh: Path) -> Session:
        _unpack(content, model)
        return Session(session.world, model, file=fresh, simulator=session.header.simulator)

    return lambda session: _exchange(session, file, make)


def with_session(file: Path, content: bytes) -> Change:
    """A session that goes on from a session file."""

    def make(session: Session, model: Path, fresh: Path) -> Session:
        fresh.write_bytes(content)
        return Session.open(fresh)

    return lambda session: _exchange(session, file, make)


def _exchange(session: Session, file: Path, make: Callable[[Session, Path, Path], Session]) -> None:
    """Make a new session beside the present one, and put its file in the place of the present one's, which is kept."""
    fresh, model = _free(file, "-new", file.suffix), _free(file, "-model", "")
    try:
        make(session, model, fresh).close()
    except BaseException:
        remove(fresh)
        remove(model)
        raise
    session.close()
    file.rename(_free(file, "-before", file.suffix))
    fresh.rename(file)


def _unpack(content: bytes, folder: Path) -> None:
    try:
        with zipfile.ZipFile(io.BytesIO(content)) as archive:
            if sum(item.file_size for item in archive.infolist()) > MOST:
                raise UserError(f"the model is larger than {MOST // 1_000_000} MB; save a smaller one")
            archive.extractall(folder)  # which lets no name lead out of the folder
    except (zipfile.BadZipFile, zlib.error, OSError, NotImplementedError, RuntimeError) as error:
        raise UserError(f"that is no model: {error}; take a zip file that this page saved") from None


def _free(file: Path, name: str, suffix: str) -> Path:
    """A path beside `file` that nothing is at yet."""
    paths = (file.with_name(f"{file.stem}{name}-{number}{suffix}") for number in itertools.count(1))
    return next(path for path in paths if not path.exists())
