"""The settings of `serve`, `hit` and `import`."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any

from dcg_torch.settings import Bounds


def _setting(default: Any, text: str, bounds: Bounds | None = None) -> Any:
    return field(default=default, metadata={"help": text, "bounds": bounds})


@dataclass
class TaskSettings:
    """What people are shown, and who asks them."""

    worlds: str = _setting("committed", "committed, generated, or a folder of world files")
    count: int = _setting(10, "of generated worlds", Bounds(1, 10_000))
    seed: int = _setting(0, "of generated worlds", Bounds(0, 1e15))
    asked_by: str = _setting("A research group", "who asks, in the text that people agree to")
    contact: str | None = _setting(None, "whom to write to, in the same text")


@dataclass
class ServeSettings(TaskSettings):
    """Pages of our own."""

    folder: str = _setting("runs/collect", "for pictures, worlds, the salt and, by default, the database")
    database: str | None = _setting(None, "an SQLAlchemy URL; by default the file answers.sqlite in the folder")
    host: str = _setting("127.0.0.1", "address to listen on; 0.0.0.0 lets other machines in")
    port: int = _setting(8080, "0 takes a free one", Bounds(0, 65_535))
    per_person: int = _setting(10, "commands that one person is asked for", Bounds(1, 10_000))
    per_object: int = _setting(5, "people who write for one object", Bounds(1, 100_000))
    code: str | None = _setting(None, "shown to all at the end; by default everyone gets a code of their own")


@dataclass
class HitSettings(TaskSettings):
    """The same task for Mechanical Turk."""

    folder: str = _setting("runs/collect_hit", "for task.html, pictures.csv, the pictures and their worlds")
    pictures_at: str = _setting("", "https address below which you will put the pictures")


@dataclass
class ImportSettings:
    """What people wrote, as worlds and episodes."""

    folder: str = _setting("runs/collect_import", "for worlds, episodes.jsonl and commands.csv")
    worlds: str | None = _setting(
        None, "committed, or a folder of world files; by default the folder worlds beside what is imported"
    )
