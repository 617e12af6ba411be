"""A session's file as a replay, as episodes and as a GIF."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from typing import Any

from dcg_torch.dialogue.events import Event


def replay(file: Path) -> Iterator[tuple[dict[str, Any], tuple[Event, ...]]]:
    """Every input of a session's file, as its line says it, with its events: the same bytes as when it happened."""
    raise NotImplementedError


def export_episodes(file: Path, to: Path) -> int:
    """Write the commands of a session as an episode file; their number. Commands that the person took back are out."""
    raise NotImplementedError


def export_gif(file: Path, to: Path) -> Path:
    """Write the commands of a session as an animation."""
    raise NotImplementedError
