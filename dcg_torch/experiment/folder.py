"""A run folder: the names in it, whose experiment it holds, and what of it is whole."""

from __future__ import annotations

import hashlib
import json
from collections.abc import Sequence
from dataclasses import asdict
from pathlib import Path

from pydantic import ValidationError

from dcg_torch.report.summary import flatten
from dcg_torch.settings import LearnerKind, Settings
from dcg_torch.storage.atomic_files import write_whole
from dcg_torch.storage.errors import UserError
from dcg_torch.storage.records import NO_EFFECT, Iteration, Timing
from dcg_torch.storage.untrusted_files import at_home, pipe_in, plain

ITERATIONS, TIMINGS, MODEL, PARTS = "iterations.jsonl", "timings.jsonl", "model", "trials"
SETTINGS, ORIGIN = "settings.json", "origin.json"
MARKS = (SETTINGS, ".hydra")
"""Of these a run folder has one, from the first moment on."""


class RunFolderError(UserError):
    """A run folder that cannot be gone on with; the message is one line."""


def part_of(directory: Path, trial: int) -> Path:
    """The file of a trial's own lines."""
    return directory / PARTS / f"{trial:04d}.jsonl"


def animation_of(directory: Path, trial: int) -> Path:
    """The file of a trial's animation."""
    return directory / "animations" / f"trial_{trial:04d}.gif"


def lexicon_of(directory: Path, trial: int) -> Path:
    """The file of what a trial's robot believes of words in the end; only some models have beliefs."""
    return directory / "lexicon" / f"{trial:04d}.json"


def check_owner(settings: Settings, directory: Path) -> None:
    """See that a run folder is new, or belongs to these settings. Nothing is written.

    Raises:
        RunFolderError: it holds another experiment, or one of which nobody can say.
    """
    mark = directory / SETTINGS
    if (given := next((path for path in _inputs(settings) if path.is_fifo()), None)) is not None:
        raise RunFolderError(f"{given}: this is a pipe, which can be read only once; give a file")
    for name in (SETTINGS, ITERATIONS, TIMINGS):
        if (directory / name).is_dir():
            raise RunFolderError(f"{directory / name}: this is a folder; remove it, or give another hydra.run.dir")
    if (pipe := pipe_in(directory)) is not None:
        raise RunFolderError(f"{pipe}: this is a pipe; remove it, or give another hydra.run.dir")
    if not mark.exists():
        if (directory / PARTS).is_dir() and any((directory / PARTS).iterdir()):
            raise RunFolderError(
                f"{directory} holds trials but no {SETTINGS}, which would say of what; give another hydra.run.dir"
            )
        return
    try:
        held = mark.read_text(encoding="utf-8")
    except UnicodeDecodeError:
        held = ""
    if held != (wanted := _fingerprint(settings)):
        raise RunFolderError(
            f"{directory} holds a run with other settings ({_difference(held, wanted)}); "
            "give hydra.run.dir another folder"
        )


def mark_as_own(settings: Settings, directory: Path) -> None:
    """Note down whose the folder is."""
    (directory / PARTS).mkdir(parents=True, exist_ok=True)
    write_whole(directory / SETTINGS, _fingerprint(settings))


def _fingerprint(settings: Settings) -> str:
    kept = {k: v for k, v in asdict(settings).items() if k not in NO_EFFECT}
    inputs = _inputs(settings)
    if inputs:
        kept["inputs"] = hashlib.sha256(b"\0".join(path.read_bytes() for path in inputs)).hexdigest()
    return json.dumps(kept, indent=2, sort_keys=True) + "\n"


def _inputs(settings: Settings) -> list[Path]:
    """The files that a run reads besides its settings."""
    training = [] if settings.training is None else [at_home(settings.training)]
    if settings.worlds in ("committed", "generated"):
        return training
    return [*sorted(at_home(settings.worlds).glob("*.yaml")), *training]


def _difference(held: str, wanted: str) -> str:
    """The settings in which two fingerprints differ, as they are in the first: "seed=0, model.l2=0.05"."""
    try:
        old, new = flatten(json.loads(held)), flatten(json.loads(wanted))
    except (ValueError, AttributeError, RecursionError):
        return f"its {SETTINGS} is not readable"
    differing = [key for key in {**old, **new} if old.get(key) != new.get(key)]
    return plain(", ".join(f"{plain(key)}={plain(str(old.get(key)))}" for key in differing), 300)


def whole_lines(path: Path) -> list[tuple[str, str]]:
    """The (iteration, timing) lines of a part; one that was cut off does not count, nor does any after it.

    Raises:
        UnicodeDecodeError: it is no text.
    """
    if not path.exists():
        return []
    return split_lines(path.read_text(encoding="utf-8"))[0]


def split_lines(text: str) -> tuple[list[tuple[str, str]], int]:
    """The (iteration, timing) lines that are whole, and the number of characters in them."""
    end = text.rfind("\n") + 1
    halves = (line.partition("\t") for line in text[:end].split("\n")[:-1])
    return [(left, right) for left, _, right in halves], end


def damage(directory: Path, trial: int, iterations: int) -> str | None:
    """What is wrong with a trial's own lines, other than that there are too few; None where nothing is."""
    part = part_of(directory, trial)
    try:
        lines = whole_lines(part)
    except (UnicodeDecodeError, IsADirectoryError):
        return f"{part}: not readable"
    if len(lines) > iterations:
        return f"{part}: has more than {iterations} lines"
    for number, (row, timing) in enumerate(lines):
        try:
            found = Iteration.model_validate_json(row), Timing.model_validate_json(timing)
        except ValidationError:
            return f"{part}: line {number + 1} is no record"
        if any((record.trial, record.iteration) != (trial, number) for record in found):
            return f"{part}: line {number + 1} is one of another trial or command"
    return None


def open_trials(settings: Settings, directory: Path) -> tuple[list[int], list[str]]:
    """The trials that are yet to run, and what is to be said of damage that was found.

    A trial whose lines are whole is run again for an animation, a lexicon or a model that is missing or damaged: its
    lines come out the same.
    """
    found: list[int] = []
    notes: list[str] = []
    for trial in range(settings.trials):
        wrong = damage(directory, trial, settings.iterations)
        if wrong is not None:
            notes.append(f"{wrong}; trial {trial} is run again")
        elif len(whole_lines(part_of(directory, trial))) == settings.iterations:
            lacking = _lacking(settings, directory, trial)
            if lacking is None:
                continue
            notes.append(f"{lacking}: missing or damaged; trial {trial} is run again for it")
        found.append(trial)
    return found, notes


def _lacking(settings: Settings, directory: Path, trial: int) -> Path | None:
    """What a trial with all its lines should have left beside them, and did not."""
    if trial in settings.animate and not _is_whole_gif(animation_of(directory, trial)):
        return animation_of(directory, trial)
    if settings.model.learner is LearnerKind.word_posterior and not _is_json(lexicon_of(directory, trial)):
        return lexicon_of(directory, trial)
    if trial == settings.trials - 1 and not _is_model_of(directory / MODEL, trial):
        return directory / MODEL
    return None


def _is_whole_gif(path: Path) -> bool:
    try:
        content = path.read_bytes()
    except OSError:
        return False
    return content.startswith(b"GIF8") and content.endswith(b";")


def _is_json(path: Path) -> bool:
    try:
        json.loads(path.read_bytes())
    except (OSError, ValueError, RecursionError):
        return False
    return True


def _is_model_of(directory: Path, trial: int) -> bool:
    try:
        if json.loads((directory / ORIGIN).read_bytes()) != {"trial": trial}:
            return False
    except (OSError, ValueError, RecursionError):
        return False
    # Here: it takes seconds to import, and most runs don't need it.
    from dcg_torch.model.checkpoint import CheckpointError, load

    try:
        load(directory)
    except (CheckpointError, OSError):
        return False
    return True


def remove_parts(directory: Path, trials: Sequence[int]) -> None:
    """Take away the lines of trials that are to be run again.

    Raises:
        RunFolderError: one of them is a folder.
    """
    for trial in trials:
        part = part_of(directory, trial)
        if part.is_dir():
            raise RunFolderError(f"{part}: this is a folder; remove it, or give another hydra.run.dir")
        part.unlink(missing_ok=True)
