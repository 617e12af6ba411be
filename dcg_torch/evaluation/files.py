"""Episodes of several files in one test: which file each is from, and the figures of each file."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from dcg_torch.evaluation.episodes import Episode, EpisodeError, read_episodes
from dcg_torch.report.intervals import wilson

CalibrationError = Callable[[Sequence[float], Sequence[bool]], float]
"""Of probabilities and whether each was right."""


@dataclass(frozen=True, slots=True)
class FiledEpisode:
    """An episode and the stem of the file it stands in; ids may repeat from file to file."""

    file: str
    episode: Episode


@dataclass(frozen=True, slots=True)
class Outcome:
    """What came of one episode: how sure the answer was (0 where there was none), and was it right?"""

    file: str
    probability: float
    correct: bool


def read_files(paths: Sequence[Path]) -> list[FiledEpisode]:
    """The episodes of several files, in order.

    Raises:
        EpisodeError: a file is missing or not valid, or two files have one name.
    """
    stems: dict[str, Path] = {}
    for path in paths:
        other = stems.setdefault(path.stem, path)
        if other is not path:
            raise EpisodeError(f"{path}: its figures would stand under {path.stem!r}, as those of {other}; rename one")
    return [FiledEpisode(path.stem, episode) for path in paths for episode in read_episodes(path)]


def by_file(outcomes: Sequence[Outcome], calibration_error: CalibrationError) -> dict[str, dict[str, Any]]:
    """n, accuracy, its 95 % interval (Wilson) and calibration error of each file, in the order of the files."""
    files: dict[str, list[Outcome]] = {}
    for outcome in outcomes:
        files.setdefault(outcome.file, []).append(outcome)
    return {file: figures(of, calibration_error) for file, of in files.items()}


def figures(outcomes: Sequence[Outcome], calibration_error: CalibrationError) -> dict[str, Any]:
    """n, accuracy, its 95 % interval (Wilson) and calibration error of at least one outcome."""
    estimate = wilson(sum(o.correct for o in outcomes), len(outcomes))
    return {
        "n": len(outcomes),
        "accuracy": estimate.value,
        "ci95": [estimate.low, estimate.high],
        "calibration_error": calibration_error([o.probability for o in outcomes], [o.correct for o in outcomes]),
    }
