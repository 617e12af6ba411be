"""The lines of all trials in one file, in the order of the trials, as they come."""

from __future__ import annotations

from pathlib import Path

from dcg_torch.experiment.folder import ITERATIONS, TIMINGS, part_of, split_lines
from dcg_torch.storage.atomic_files import write_whole
from dcg_torch.storage.records import Iteration


class Journal:
    """Gathers `trials/NNNN.jsonl` into `iterations.jsonl` and `timings.jsonl`, in the order of the trials.

    What is there at first is written in one step, so that a run that was finished loses nothing if the disk is full.

    Args:
        directory: the run folder.
        trials: how many there are to be.
        iterations: of a trial.
    """

    def __init__(self, directory: Path, trials: int, iterations: int) -> None:
        self._directory, self._trials, self._iterations = directory, trials, iterations
        self._trial = self._done = self._read = 0
        self._first: list[tuple[str, str]] | None = self._new_lines()
        for name, column in ((ITERATIONS, 0), (TIMINGS, 1)):
            write_whole(directory / name, "".join(line[column] + "\n" for line in self._first))

    def advance(self) -> list[Iteration]:
        """Append what has been finished since; returns the new rows in order."""
        if self._first is not None:
            new, self._first = self._first, None
        else:
            new = self._new_lines()
            for name, column in ((ITERATIONS, 0), (TIMINGS, 1)) if new else ():
                with (self._directory / name).open("a", encoding="utf-8") as file:
                    file.writelines(line[column] + "\n" for line in new)
        return [Iteration.model_validate_json(line[0]) for line in new]

    def _new_lines(self) -> list[tuple[str, str]]:
        new: list[tuple[str, str]] = []
        while self._trial < self._trials:
            lines = self._lines_of(part_of(self._directory, self._trial))
            new += lines
            self._done += len(lines)
            if self._done < self._iterations:
                break
            self._trial, self._done, self._read = self._trial + 1, 0, 0
        return new

    def _lines_of(self, part: Path) -> list[tuple[str, str]]:
        """The whole lines behind those that were read already."""
        if not part.exists():
            return []
        with part.open("rb") as file:
            file.seek(self._read)
            content = file.read()
        end = content.rfind(b"\n") + 1
        self._read += end
        return split_lines(content[:end].decode("utf-8"))[0]
