"""What one model is taught and tested on: folds and halves in which no group is on both sides."""

from __future__ import annotations

import hashlib
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from dcg_torch.evaluation.episodes import Episode, EpisodeError


@dataclass(frozen=True)
class Split:
    """What one model is taught and tested on: files by their stems."""

    train: dict[str, list[Episode]]
    test: dict[str, list[Episode]]


def cross_validation(files: Mapping[str, Sequence[Episode]], folds: int, rng: np.random.Generator) -> list[Split]:
    """A split for each fold: it is the test, and the others of its file are what is taught.

    Raises:
        EpisodeError: a file has fewer groups than there are folds.
    """
    parts = {name: split_folds(episodes, folds, rng) for name, episodes in files.items()}
    return [
        Split(
            {name: [e for other in of if other is not of[k] for e in other] for name, of in parts.items()},
            {name: of[k] for name, of in parts.items()},
        )
        for k in range(folds)
    ]


def split_folds(episodes: Sequence[Episode], folds: int, rng: np.random.Generator) -> list[list[Episode]]:
    """Parts of about equal size, in which no group is in two; an episode without a group is one of its own.

    Raises:
        EpisodeError: there are fewer groups than parts.
    """
    groups: dict[str, list[Episode]] = {}
    for episode in episodes:
        groups.setdefault(_group(episode), []).append(episode)
    if len(groups) < folds:
        groups_there = f"{len(groups)} group{'s' * (len(groups) > 1)}"
        raise EpisodeError(f"folds={folds}, but the episodes are of {groups_there}; ask for fewer")
    names = sorted(groups)
    order = rng.permutation(len(names))
    return [[e for k in order[fold::folds] for e in groups[names[k]]] for fold in range(folds)]


def split_halves(files: Mapping[str, Sequence[Episode]]) -> Split:
    """One half of each file's groups to teach, and the other to test.

    A hash of the group's name decides, so that a group stays on its side whatever else is in the file, and a file is
    split alike whether it is alone or one of many.

    Raises:
        EpisodeError: a half of a file is empty.
    """
    train = {name: [e for e in episodes if not _is_tested(e)] for name, episodes in files.items()}
    test = {name: [e for e in episodes if _is_tested(e)] for name, episodes in files.items()}
    for name in files:
        if not train[name] or not test[name]:
            raise EpisodeError(f"halves=true: all groups of {name} fall into one half; it needs more groups")
    return Split(train, test)


def _is_tested(episode: Episode) -> bool:
    # Salted: a corpus that was cut by a plain hash of its groups itself would fall to one side.
    return hashlib.blake2b(_group(episode).encode(), salt=b"halves").digest()[0] % 2 == 1


def _group(episode: Episode) -> str:
    return episode.group or f"episode {episode.id}"
