"""Episode files: commands with the scene they were given in and the objects meant (JSON lines)."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Sequence
from dataclasses import replace
from pathlib import Path
from typing import Annotated, Any

import numpy as np
from pydantic import BaseModel, ConfigDict, Field, ValidationError

from dcg_torch import scene
from dcg_torch.names.keys import attributes_of, is_used
from dcg_torch.scene.room_walls import room_walls
from dcg_torch.scene.upright_pictures import is_upright
from dcg_torch.scene.workspace import Workspace, spacing, spacings
from dcg_torch.storage.errors import UserError
from dcg_torch.storage.untrusted_files import misspelt, plain, read_json, read_text, shown
from dcg_torch.types import Percept, Pose


class EpisodeError(UserError):
    """An episode file that is missing or not valid; the message is one line."""


class _Record(BaseModel):
    model_config = ConfigDict(frozen=True, extra="allow", allow_inf_nan=False)


_Coordinate = Annotated[float, Field(ge=-1e6, le=1e6)]  # metres, or whatever a corpus counts in
_Length = Annotated[float, Field(ge=0.0, le=1e6)]
_Shade = Annotated[float, Field(ge=0.0, le=255.0)]
_Name = Annotated[str, Field(min_length=1, max_length=200, pattern=r"\S")]


class Place(_Record):
    """Where somebody stands: metres, and radians from x towards y."""

    x: _Coordinate
    y: _Coordinate
    yaw: _Coordinate = 0.0


class EpisodeObject(_Record):
    """One object: metres; `size` are its extents, one number for all three, or a word, if known.

    A size of 0 is what scanners write when they could not tell: it counts as unknown, but for the depth of what is in a
    picture, see `Episode.percepts`. `rgb` is what the object looks like, 0 to 255. Further keys are `attributes` where
    they are true, false or a text; what else they hold is not used, and `unused_keys` counts it.
    """

    id: _Name
    type: _Name
    color: str | None = Field(None, max_length=200)
    position: tuple[_Coordinate, _Coordinate, _Coordinate] | tuple[_Coordinate, _Coordinate]
    size: tuple[_Length, _Length, _Length] | _Length | Annotated[str, Field(max_length=200)] | None = None
    rgb: tuple[_Shade, _Shade, _Shade] | None = None

    @property
    def extents(self) -> tuple[float, float, float] | None:
        """Along x, y and z, if they are given as numbers of which one is above 0."""
        sizes = (self.size,) * 3 if isinstance(self.size, float) else self.size
        return sizes if isinstance(sizes, tuple) and any(sizes) else None

    @property
    def attributes(self) -> frozenset[str]:
        """What its further keys, and a size that is a word, come to: "held", "beard: no", "material: wood"."""
        return attributes_of({**(self.model_extra or {}), "size": self.size})


class Episode(_Record):
    """One command in one scene; further keys are not used, and `unused_keys` counts them.

    `target` lists the ids of the objects meant; empty: nothing that is there is meant. `holding` is the object in the
    gripper. Episodes of one `group` show the same scene and its changes.
    """

    id: Annotated[str, Field(max_length=1_000)]
    text: Annotated[str, Field(max_length=10_000)]
    objects: tuple[EpisodeObject, ...] = Field(min_length=1)
    target: tuple[str, ...]
    robot: Place | None = None
    speaker: Place | None = None
    holding: str | None = None
    group: str | None = None

    @property
    def pose(self) -> Pose | None:
        """Where the robot stands, if the episode says so."""
        return None if self.robot is None else Pose(self.robot.x, self.robot.y, self.robot.yaw)

    @property
    def speaker_pose(self) -> Pose | None:
        """Where the speaker stands, if not with the robot."""
        return None if self.speaker is None else Pose(self.speaker.x, self.speaker.y, self.speaker.yaw)

    def percepts(self) -> list[Percept]:
        """The objects, all of them perceived.

        What all of them lack is the depth of a picture; else extents of 0 say that nobody knows how large a thing is.
        """
        given = [o.extents for o in self.objects if o.extents is not None]
        flat = [not any(of) for of in zip(*given, strict=True)]
        return [
            Percept(
                o.id,
                o.type,
                o.color,
                (*o.position[:2], o.position[2] if len(o.position) == 3 else 0.0),
                o.extents if o.extents is None or all(e or no for e, no in zip(o.extents, flat, strict=True)) else None,
                o.attributes | {"held"} if o.id == self.holding else o.attributes,
                o.rgb,
            )
            for o in self.objects
        ]


def read_episodes(path: Path) -> list[Episode]:
    """Read an episode file.

    Raises:
        EpisodeError: the file is absent or empty, or a line of it is not a valid episode; the line is named.
    """
    text = read_text(path, "episode file", EpisodeError, "utf-8-sig")
    episodes: list[Episode] = []
    lines: dict[str, int] = {}
    # Not str.splitlines, which also breaks lines at characters that may stand inside a JSON string.
    for number, line in enumerate(text.split("\n"), start=1):
        if not line.strip():
            continue
        episode = parse_episode(line, f"{path}, line {number}")
        first = lines.setdefault(episode.id, number)
        if first != number:
            raise EpisodeError(
                f"{path}, line {number}: id: {shown(episode.id)} is that of line {first} too; rename one"
            )
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
    "size": "give metres, as [x, y, z] or one number, or a word",
    "rgb": "give three numbers from 0 to 255",
    "color": "write a text in quotes, or null",
    "robot": "give metres and radians, as {x, y, yaw}",
    "speaker": "give metres and radians, as {x, y, yaw}",
    "holding": "write the id of an object in quotes, or null",
    "group": "write a text in quotes, or null",
}
"""How to mend each key of a line."""


def parse_episode(line: str, where: str) -> Episode:
    """The episode of one line.

    Args:
        where: the line is, for the message.

    Raises:
        EpisodeError: it is not a valid episode.
    """
    try:
        _check_keys(read_json(line), where)
    except EpisodeError:
        raise
    except ValueError as error:
        raise EpisodeError(f"{where}: the line: {error}; {_MEND['the line']}") from None
    try:
        episode = Episode.model_validate_json(line, strict=True)
    except ValidationError as error:
        raise EpisodeError(f"{where}: {_problem(error.errors(include_url=False)[0])}") from None
    ids = Counter(o.id for o in episode.objects)
    if len(ids) < len(episode.objects):
        repeated = next(name for name, times in ids.items() if times > 1)
        raise EpisodeError(f"{where}: objects: the id {shown(repeated)} is there twice; give each object its own")
    for what, named in (("target", episode.target), ("holding", (episode.holding,))):
        for one in named:
            if one is not None and one not in ids:
                some = ", ".join(plain(name, 20) for name in list(ids)[:8])
                raise EpisodeError(f"{where}: {what}: {shown(one)} is no object of this episode: {some}")
    return episode


_MOST_SHOWN = 8  # keys in a note
_MOST_KEYS = 100  # of one record that are compared with the known ones


def _problem(found: Any) -> str:
    """Where, what and how to mend it, of one thing that pydantic found."""
    # The innermost key that an episode has; what follows are pydantic's names for the choices it tried.
    keys = [k for k, part in enumerate(found["loc"]) if part in _MEND]
    where = ".".join(map(str, found["loc"][: keys[-1] + 1])) if keys else "the line"
    if found["type"] == "missing" and isinstance(found["input"], dict):
        said = f"is missing; there are {', '.join(plain(key, 20) for key in list(found['input'])[:_MOST_SHOWN])}"
    else:
        said = "not understood" if where.endswith(("size", "position", "rgb")) else plain(found["msg"], 120)
    return f"{where}: {said}; {_MEND[where.rpartition('.')[2]]}"


def _check_keys(line: Any, where: str) -> None:
    """Refuse a key that must be a misspelt one: near to one that is known, which is not there."""
    if not isinstance(line, dict):
        return
    things = line.get("objects")
    records: list[tuple[str, Any, type[BaseModel]]] = [("", line, Episode)]
    records += [(f"{name}.", line.get(name), Place) for name in ("robot", "speaker")]
    records += [(f"objects.{k}.", o, EpisodeObject) for k, o in enumerate(things if isinstance(things, list) else [])]
    for prefix, record, model in records:
        if not isinstance(record, dict) or len(record) > _MOST_KEYS:
            continue
        absent = tuple(key for key in model.model_fields if key not in record)
        for key in record if absent else ():
            if key not in model.model_fields and (near := misspelt(key, absent)):
                raise EpisodeError(f"{where}: {prefix}{plain(key)}: there is no such key; did you mean {near}?")


def unused_keys(episodes: Iterable[Episode]) -> dict[str, int]:
    """Keys that say nothing to a model, each with the number of its episodes or objects.

    These are all further keys of an episode and of a place in it, and those of an object whose values are neither text
    nor true or false.
    """
    found: Counter[str] = Counter()
    for episode in episodes:
        found.update(list(episode.model_extra or ()))  # the keys, not a count of them
        for name, place in (("robot", episode.robot), ("speaker", episode.speaker)):
            found.update(f"{name}.{key}" for key in (place and place.model_extra) or {})
        for thing in episode.objects:
            further = (thing.model_extra or {}).items()
            used = ((key, is_used(key, value)) for key, value in further)
            found.update(f"objects.{key}" for key, heard in used if not heard)
    return dict(found)


def unused_note(episodes: Iterable[Episode]) -> str | None:
    """One line on the keys that say nothing, so that a misspelt one is seen; None: there are none."""
    found = sorted(unused_keys(episodes).items(), key=lambda item: (-item[1], item[0]))
    if not found:
        return None
    listed = ", ".join(f"{plain(key, 40)} ({times})" for key, times in found[:_MOST_SHOWN])
    more = f" and {len(found) - _MOST_SHOWN} more" if len(found) > _MOST_SHOWN else ""
    return f"keys that are not used (how often): {listed}{more}; see whether one is misspelt"


def turned_note(episodes: Iterable[Episode]) -> str | None:
    """One line on headings of more than a turn, which are degrees; None: there are none."""
    found = [
        (place.yaw, e.id) for e in episodes for place in (e.robot, e.speaker) if place and abs(place.yaw) > _FULL_TURN
    ]
    if not found:
        return None
    yaw, name = found[0]
    return f"a yaw of more than a turn (how often: {len(found)}; {yaw:g} in {plain(name, 40)}): angles are radians"


_FULL_TURN = 2.1 * np.pi

_ONE_SCALE = 2.0
"""Scenes of one scale: in none are neighbours so many times closer or farther than in the middle one."""


def workspace(episodes: Sequence[Episode]) -> Workspace:
    """What the scenes have in common: bounds, where the robot's place is one and the same in all; and the unit.

    Rooms in which nobody stands have no bounds in common: each begins somewhere else, and has walls of its own.
    The unit is the median distance from an object to its nearest neighbour.
    """
    apart = np.concatenate([np.zeros(0), *(spacings(e.percepts()) for e in episodes)])
    unit = float(np.median(apart)) if len(apart) else 1.0
    rooms = [e.pose is None and room_walls(e.percepts()) is not None for e in episodes]
    if len({(e.pose, e.speaker_pose) for e in episodes}) != 1 or 2 * sum(rooms) > len(rooms):
        return Workspace(None, unit)
    bounds = [scene.scene_bounds([o.position for o in e.objects], e.pose) for e in episodes if e.objects]
    low = [_foot_of_picture(e.percepts(), e.pose) for e in episodes if e.objects]
    near, far, right, left = zip(*bounds, strict=True)
    near, far = (tuple(map(sum, zip(end, low, strict=True))) for end in (near, far))
    return Workspace((min(near), max(far), min(right), max(left)), unit)


def _foot_of_picture(percepts: Sequence[Percept], robot: Pose | None) -> float:
    """How high the lowest thing is in a picture that stands upright, and is laid flat from there; else 0."""
    return min(p.position[2] for p in percepts) if is_upright(percepts, robot) else 0.0


def of_scene(percepts: Sequence[Percept], robot: Pose | None, where: Workspace) -> Workspace:
    """The workspace as one of the scenes has it.

    A picture that stands upright is laid flat from its lowest thing, so the bounds of its page move by as much. A scene
    of another scale has a unit of its own: a table top among rooms.
    """
    low = _foot_of_picture(percepts, robot)
    if where.bounds is not None and low:
        near, far, right, left = where.bounds
        where = replace(where, bounds=(near - low, far - low, right, left))
    unit = spacing(percepts) or where.unit
    return where if 1.0 / _ONE_SCALE <= unit / where.unit <= _ONE_SCALE else replace(where, unit=unit)
