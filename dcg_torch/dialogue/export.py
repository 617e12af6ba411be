"""A session's file as a replay, as episodes and as a GIF."""

from __future__ import annotations

import json
from collections.abc import Iterator
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from dcg_torch.dialogue.events import Candidates, Event, Moved
from dcg_torch.dialogue.file import Input, SessionError, with_stops
from dcg_torch.dialogue.session import Session, standing_at
from dcg_torch.dialogue.situation import Errand
from dcg_torch.experiment.recording.recorder import Moment, RecordedCommand
from dcg_torch.storage.atomic_files import write_whole
from dcg_torch.storage.records import Iteration, ObjectRecord, PoseRecord
from dcg_torch.types import DriveResult, Percept, Pose
from dcg_torch.world.files import World
from dcg_torch.world.speaker import Command

_EVERY = 3  # of the moves, 30 to a second, those that an animation has


def replay(file: Path) -> Iterator[tuple[Input, tuple[Event, ...]]]:
    """Every input of a session's file with its events: the same bytes as when it happened.

    Raises:
        UserError: the file is not valid, or its model is not what it was.
    """
    session, inputs = Session.replayed(file)
    try:
        for line, stop_at in with_stops(inputs):
            yield line, session.play(line, stop_at)
    finally:
        session.close()


@dataclass
class _Command:
    """A command of a session: what came of it, where, and what the robot did until it was over."""

    errand: Errand
    world: World
    symbols: dict[str, str] = field(default_factory=dict)
    known_types: tuple[str, ...] = ()
    moments: list[Moment] = field(default_factory=list)

    @property
    def is_over(self) -> bool:
        """Did it come to an end that the person left as it is?"""
        ended = self.errand.result is DriveResult.ARRIVED or self.errand.chosen is None
        return ended and not self.errand.taken_back


def _commands(file: Path) -> list[_Command]:
    """The commands of a session, in their order."""
    session, inputs = Session.replayed(file)
    found: list[_Command] = []
    known = set(session.model.symbols)  # from the start
    try:
        for line, stop_at in with_stops(inputs):
            moves: list[Pose | None] = []  # None: a look
            asked = len(found[-1].errand.asked) if found else 0
            session.play(line, stop_at, lambda event, moves=moves: _take_down(event, moves))  # type: ignore[misc]
            errand = session.state.last
            if errand is not None and (not found or found[-1].errand is not errand):
                world = standing_at(session.world, errand.start)
                found.append(_Command(errand, world, {}, session.model.known_types))
            elif errand is None or len(errand.asked) == asked:
                continue  # no command, and no answer to the question about one
            _append(found[-1], moves, session.pose)
            symbols = session.model.symbols
            found[-1].symbols = {word: symbol.type for word, symbol in symbols.items() if word not in known}
    finally:
        session.close()
    return found


def _take_down(event: Event, moves: list[Pose | None]) -> None:
    if isinstance(event, Moved):
        moves.append(event.pose)
    elif isinstance(event, Candidates):
        moves.append(None)


def _append(command: _Command, moves: list[Pose | None], end: Pose) -> None:
    """The moments of one input more."""
    looks = sum(moment.looking for moment in command.moments)
    for number, pose in enumerate(moves):
        if pose is None:
            looks += 1
            command.moments.append(Moment(command.errand.looks[looks - 1].pose, looks, looking=True))
        elif number % _EVERY == 0:
            command.moments.append(Moment(pose, looks))
    command.moments.append(Moment(end, looks))


def export_episodes(file: Path, to: Path) -> int:
    """Write the commands of a session as an episode file; their number.

    The target is what the robot went to, or nothing where it said that there is none. Left out are the commands that
    the person took back or stopped, or whose question nobody answered. "confirmed": the person told which is meant.

    Raises:
        UserError: the session is not valid, or it has no such command.
    """
    over = [c for c in _commands(file) if c.is_over and c.errand.looks[-1].percepts]
    if not over:
        raise SessionError(f"{file}: no command of this session was carried out; talk on, then export")
    lines = [
        json.dumps(_episode(f"{file.stem}-{k}", c.errand), ensure_ascii=False) for k, c in enumerate(over, start=1)
    ]
    write_whole(to, "\n".join(lines) + "\n")
    return len(over)


def _episode(id_: str, errand: Errand) -> dict[str, Any]:
    start = errand.start
    return {
        "id": id_,
        "text": errand.text,
        "robot": {"x": start.x, "y": start.y, "yaw": start.yaw},
        "objects": [_object(percept) for percept in errand.looks[-1].percepts],
        "target": [] if errand.chosen is None else [errand.chosen],
        "confirmed": any(reply.meant is not None for _, reply in errand.asked),
    }


def _object(percept: Percept) -> dict[str, Any]:
    size = {} if percept.size is None else {"size": percept.size}
    return {"id": percept.id, "type": percept.type, "color": percept.color, "position": percept.position, **size}


def export_gif(file: Path, to: Path) -> Path:
    """Write the commands of a session as an animation.

    Raises:
        UserError: the session is not valid, or it has no command.
    """
    from dcg_torch.experiment.recording.animation import (
        animate,  # here: it draws in the physics, which need not be there
    )

    commands = [_recorded(number, command) for number, command in enumerate(_commands(file))]
    if not commands:
        raise SessionError(f"{file}: this session has no command to animate; talk on, then export")
    return animate(commands, to)


def _recorded(number: int, command: _Command) -> RecordedCommand:
    """A command as the animation takes it; the object meant is the one that the robot went to, as nobody objected."""
    errand, world, solution = command.errand, command.world, command.errand.solution
    noun = solution.noun
    said = Command(world, errand.text, (noun and noun.noun) or "", noun.color if noun else None, errand.chosen or "")
    start, end = errand.start, command.moments[-1]
    row = Iteration(
        trial=0,
        iteration=number,
        world=world.name,
        command=errand.text,
        noun=said.noun,
        color=said.color,
        robot=PoseRecord(x=start.x, y=start.y, yaw=start.yaw),
        objects=tuple(ObjectRecord(id=o.id, type=o.type, color=o.color, position=o.position) for o in world.objects),
        in_view=errand.in_view,
        known_types=command.known_types,
        target=said.target,
        grounded=errand.chosen if errand.result else None,
        correct=errand.result is DriveResult.ARRIVED and not errand.taken_back,
        kind="known",
        probability=solution.probability,
        asked=len(errand.asked),
        symbols=command.symbols,
        path_length=0.0,
        turned=0.0,
        parsed=None,
        seen=tuple(percept.id for percept in errand.looks[-1].percepts),
        chosen=errand.chosen,
        arrived=None if errand.result is None else bool(errand.result),
        collisions=0,
        expected_symbols=0.0,
    )
    return RecordedCommand(said, tuple(errand.looks), (*command.moments, Moment(end.pose, end.looks)), row)
