"""Episode files: commands with the scene they were given in and the objects meant (JSON lines)."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Annotated, Any

import numpy as np
from pydantic import BaseModel, ConfigDict, Field, ValidationError

from dcg_torch import scene
from dcg_torch.scene.workspace import Workspace
from dcg_torch.types import Percept, Pose


class EpisodeError(ValueError):
    """An episode file that is missing or not valid; the message is one line."""


class _Record(BaseModel):
    model_config = ConfigDict(frozen=True, extra="ignore", allow_inf_nan=False)


class _Place(_Record):
    x: float
    y: float
    yaw: float = 0.0


_Positive = Annotated[float, Field(gt=0.0)]


class EpisodeObject(_Record):
    """One object: metres; `size` are its extents, one number for all three, or a word, if known."""

    model_config = ConfigDict(extra="allow")

    id: str
    type: str
    color: str | None = None
    position: tuple[float, float, float] | tuple[float, float]
    size: tuple[_Positive, _Positive, _Positive] | _Positive | str | None = None

    @property
    def extents(self) -> tuple[float, float, float] | None:
        """Along x, y and z, if they are given as numbers."""
        if isinstance(self.size, float):
            return self.size, self.size, self.size
        return self.size if isinstance(self.size, tuple) else None

    @property
    def attributes(self) -> frozenset[str]:
        """Its further keys: "held" where true, "material: wood" where a string; numbers and all else are not."""
        further = {**(self.model_extra or {}), "size": self.size}
        named = {f"{key}: {value}" for key, value in further.items() if isinstance(value, str)}
        return frozenset(named | {key for key, value in further.items() if value is True})


class Episode(_Record):
    """One command in one scene; further keys are ignored.

    `target` lists the ids of the objects meant, `holding` is the object in the gripper. Episodes of one `group`
    show the same scene and its changes.
    """

    id: str
    text: str
    objects: tuple[EpisodeObject, ...] = Field(min_length=1)
    target: tuple[str, ...] = Field(min_length=1)
    robot: _Place | None = None
    speaker: _Place | None = None
    holding: str | None = None
    group: str | None = None

    @property
    def pose(self) -> Pose | None:
        """Of the robot."""
        return None if self.robot is None else Pose(self.robot.x, self.robot.y, self.robot.yaw)

    @property
    def speaker_pose(self) -> Pose | None:
        """Of the speaker, if it is not where the robot is."""
        return None if self.speaker is None else Pose(self.speaker.x, self.speaker.y, self.speaker.yaw)

    def percepts(self) -> list[Percept]:
        """The objects, all of them perceived."""
        return [
            Percept(
                o.id,
                o.type,
                o.color,
                (*o.position[:2], o.position[2] if len(o.position) == 3 else 0.0),
                o.extents,
                o.attributes | {"held"} if o.id == self.holding else o.attributes,
            )
            for o in self.objects
        ]


def read_episodes(path: Path) -> list[Episode]:
    """Read an episode file.

    Raises:
        EpisodeError: the file is absent or empty, or a line of it is not a valid episode; the line is named.
    """
    try:
        text = path.read_text(encoding="utf-8-sig")
    except FileNotFoundError:
        raise EpisodeError(f"{path}: no such episode file") from None
    except UnicodeDecodeError as error:
        raise EpisodeError(f"{path}: not UTF-8 text ({error.reason}); unpack it, or save it as UTF-8") from None
    except OSError as error:
        raise EpisodeError(f"{path}: cannot be read: {error.strerror}") from None
    episodes: list[Episode] = []
    lines: dict[str, int] = {}
    # Not str.splitlines, which also breaks lines at characters that may stand inside a JSON string.
    for number, line in enumerate(text.split("\n"), start=1):
        if not line.strip():
            continue
        episode = _parse(path, number, line)
        first = lines.setdefault(episode.id, number)
        if first != number:
            raise EpisodeError(f"{path}, line {number}: id: {episode.id!r} is that of line {first} too; rename one")
        episodes.append(episode)
    if not episodes:
        raise EpisodeError(f"{path}: holds no episodes; write one JSON object a line")
    return episodes


_MEND = {
    "the line": "write one JSON object a line",
    "id": "write a text in quotes",
    "type": "write a text in quotes",
    "text": "write the command in quotes",
    "objects": "give a list of objects, each with id, type and position",
    "target": "give the ids of the objects meant, as a list",
    "position": "give metres as [x, y, z], or [x, y]",
    "size": "give metres above 0, as [x, y, z] or one number, or a word",
    "color": "write a text in quotes, or null",
    "robot": "give metres and radians, as {x, y, yaw}",
    "speaker": "give metres and radians, as {x, y, yaw}",
    "holding": "write the id of an object in quotes, or null",
    "group": "write a text in quotes, or null",
}
"""How to mend each key of a line."""


def _parse(path: Path, number: int, line: str) -> Episode:
    try:
        episode = Episode.model_validate_json(line, strict=True)
    except ValidationError as error:
        first: Any = error.errors()[0]
        # The innermost key that an episode has; what follows are pydantic's names for the choices it tried.
        keys = [k for k, part in enumerate(first["loc"]) if part in _MEND]
        where = ".".join(map(str, first["loc"][: keys[-1] + 1])) if keys else "the line"
        said = "not understood" if where.endswith(("size", "position")) else first["msg"]
        raise EpisodeError(f"{path}, line {number}: {where}: {said}; {_MEND[where.rpartition('.')[2]]}") from None
    ids = [o.id for o in episode.objects]
    if len(set(ids)) < len(ids):
        raise EpisodeError(
            f"{path}, line {number}: objects: the id {_repeated(ids)!r} is there twice; give each object its own"
        )
    for what, named in (("target", episode.target), ("holding", (episode.holding,))):
        for one in named:
            if one is not None and one not in ids:
                some = ", ".join(ids[:8])
                raise EpisodeError(f"{path}, line {number}: {what}: {one!r} is no object of this episode: {some}")
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
    return Workspace(scene.scene_bounds([o.position for e in episodes for o in e.objects], episodes[0].pose), unit)


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
