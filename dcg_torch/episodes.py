"""Episode files: commands with the scene they were given in and the objects meant (JSON lines)."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np
from pydantic import BaseModel, ConfigDict, Field, ValidationError

from dcg_torch import space
from dcg_torch.relational import Workspace
from dcg_torch.symbols import Percept, Pose


class EpisodeError(ValueError):
    """An episode file that is missing or not valid; the message is one line."""


class _Record(BaseModel):
    model_config = ConfigDict(frozen=True, extra="ignore", allow_inf_nan=False)


class _Robot(_Record):
    x: float
    y: float
    yaw: float = 0.0


class _Point(_Record):
    x: float
    y: float


class EpisodeObject(_Record):
    """One object: metres; `size` are its extents, if known."""

    id: str
    type: str
    color: str | None = None
    position: tuple[float, float, float] | tuple[float, float]
    size: tuple[float, float, float] | None = None


class Episode(_Record):
    """One command in one scene; further keys are ignored.

    `target` lists the ids of the objects meant, `holding` is the object in the gripper. Episodes of one `group`
    show the same scene and its changes.
    """

    id: str
    text: str
    objects: tuple[EpisodeObject, ...] = Field(min_length=1)
    target: tuple[str, ...] = Field(min_length=1)
    robot: _Robot | None = None
    speaker: _Point | None = None
    holding: str | None = None
    group: str | None = None

    @property
    def pose(self) -> Pose | None:
        """Of the robot."""
        return None if self.robot is None else Pose(self.robot.x, self.robot.y, self.robot.yaw)

    @property
    def speaker_pose(self) -> Pose | None:
        """Of the speaker, if it is not where the robot is."""
        return None if self.speaker is None else Pose(self.speaker.x, self.speaker.y)

    def percepts(self) -> list[Percept]:
        """The objects, all of them perceived."""
        return [
            Percept(
                o.id,
                o.type,
                o.color,
                (*o.position[:2], o.position[2] if len(o.position) == 3 else 0.0),
                o.size,
                frozenset({"held"}) if o.id == self.holding else frozenset(),
            )
            for o in self.objects
        ]


def read_episodes(path: Path) -> list[Episode]:
    """Read an episode file.

    Raises:
        EpisodeError: the file is absent or empty, or a line of it is not a valid episode; the line is named.
    """
    try:
        lines = path.read_text(encoding="utf-8").splitlines()
    except FileNotFoundError:
        raise EpisodeError(f"{path}: no such episode file") from None
    except (OSError, UnicodeDecodeError) as error:
        raise EpisodeError(f"{path}: cannot be read as UTF-8 text: {error}") from None
    episodes = [_parse(path, number, line) for number, line in enumerate(lines, start=1) if line.strip()]
    if not episodes:
        raise EpisodeError(f"{path}: holds no episodes; write one JSON object a line")
    return episodes


def _parse(path: Path, number: int, line: str) -> Episode:
    try:
        episode = Episode.model_validate_json(line)
    except ValidationError as error:
        first: Any = error.errors()[0]
        where = ".".join(str(part) for part in first["loc"]) or "the line"
        raise EpisodeError(f"{path}, line {number}: {where}: {first['msg']}") from None
    ids = [o.id for o in episode.objects]
    if len(set(ids)) < len(ids):
        raise EpisodeError(f"{path}, line {number}: objects: the id {_repeated(ids)!r} is there twice")
    for what, named in (("target", episode.target), ("holding", (episode.holding,))):
        for one in named:
            if one is not None and one not in ids:
                raise EpisodeError(f"{path}, line {number}: {what}: {one!r} is no object of this episode")
    return episode


def _repeated(ids: Sequence[str]) -> str:
    return next(i for i in ids if ids.count(i) > 1)


def workspace(episodes: Sequence[Episode]) -> Workspace:
    """What the scenes have in common: bounds, where the robot's place is one and the same in all; and the unit.

    The unit is the median distance from an object to its nearest neighbour.
    """
    nearest = []
    for episode in episodes:
        points = np.array([p.position for p in episode.percepts()])
        apart = np.linalg.norm(points[None] - points[:, None], axis=2)
        np.fill_diagonal(apart, np.inf)
        nearest += [d for d in apart.min(axis=1).tolist() if 0.0 < d < np.inf]
    unit = float(np.median(nearest)) if nearest else 1.0
    if len({(e.pose, e.speaker_pose) for e in episodes}) != 1:
        return Workspace(None, unit)
    return Workspace(space.scene_bounds([o.position for e in episodes for o in e.objects], episodes[0].pose), unit)


def split_folds(episodes: Sequence[Episode], folds: int, rng: np.random.Generator) -> list[list[Episode]]:
    """Parts of about equal size, in which no group is in two; an episode without a group is one of its own.

    Raises:
        EpisodeError: there are fewer groups than parts.
    """
    groups: dict[str, list[Episode]] = {}
    for episode in episodes:
        groups.setdefault(episode.group or f"episode {episode.id}", []).append(episode)
    if len(groups) < folds:
        raise EpisodeError(f"folds={folds}, but the episodes are of {len(groups)} groups; ask for fewer")
    names = sorted(groups)
    order = rng.permutation(len(names))
    return [[e for k in order[fold::folds] for e in groups[names[k]]] for fold in range(folds)]
