"""What the node keeps: snapshots of its model with the notes that it has handled, each whole or not there.

    snapshot-00000012/    model.json, weights.safetensors, handled.json
    lexicon.json          for people, and the mark of the folder

A snapshot never takes the place of another: a node that is killed at any moment goes on from the one before.
"""

from __future__ import annotations

import json
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from dcg_torch.learning.lexicon import save_lexicon
from dcg_torch.model import GroundingModel
from dcg_torch.model.checkpoint import CheckpointError, load
from dcg_torch.storage.atomic_files import remove, write_whole, write_whole_folder
from dcg_torch.storage.errors import UserError

MARK = "lexicon.json"
_HANDLED, _NAME, _KEPT = "handled.json", "snapshot-", 2

Handled = dict[str, dict[str, Any]]
"""Id of a note -> its last acknowledgement."""


class Store:
    """Snapshots in a folder that this process has claimed."""

    def __init__(self, directory: Path) -> None:
        self._directory = directory
        self._last = max((_number(path) for path in self._snapshots()), default=0)

    def save(self, model: GroundingModel, handled: Mapping[str, Mapping[str, Any]]) -> Path:
        """Write the next snapshot, and remove those before the last.

        Raises:
            OSError: it cannot be written; those before stay.
        """

        def content(folder: Path) -> None:
            model.save(folder)
            (folder / _HANDLED).write_text(json.dumps(handled), encoding="utf-8")

        path = write_whole_folder(self._directory / f"{_NAME}{self._last + 1:08d}", content)
        self._last += 1
        write_whole(self._directory / MARK, lambda part: save_lexicon(model.lexicon(), part))
        for old in self._snapshots()[:-_KEPT]:
            remove(old)
        return path

    def restore(self) -> tuple[GroundingModel, Handled] | None:
        """The newest snapshot that can be read; None where there is none.

        Raises:
            UserError: there are some, and none can be read.
        """
        snapshots, problem = self._snapshots(), ""
        for path in reversed(snapshots):
            try:
                handled = json.loads((path / _HANDLED).read_text(encoding="utf-8"))
                return load(path), dict(handled)
            except (CheckpointError, OSError, ValueError, TypeError) as error:
                problem = str(error)
        if snapshots:
            raise UserError(f"{self._directory}: no snapshot can be read ({problem}); move the folder away")
        return None

    def _snapshots(self) -> list[Path]:
        found = (path for path in self._directory.glob(f"{_NAME}*") if path.name[len(_NAME) :].isdigit())
        return sorted(found, key=_number)


def _number(path: Path) -> int:
    return int(path.name[len(_NAME) :])
