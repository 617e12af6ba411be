"""The conversation that all visitors share: one thread runs the session, the event loop holds what is shown of it."""

from __future__ import annotations

import asyncio
import collections
import contextlib
import functools
import hashlib
import io
import logging
import math
import time
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from nicegui import Event
from PIL import Image

from dcg_torch.apps.talk.lines import Line, line_of_event, line_of_input, names_of
from dcg_torch.apps.talk.live_updates import Live
from dcg_torch.dialogue import events
from dcg_torch.dialogue.acts import is_stop
from dcg_torch.dialogue.file import Input, with_stops
from dcg_torch.dialogue.session import Session
from dcg_torch.storage.errors import UserError
from dcg_torch.types import Pose
from dcg_torch.world.files import World

LINES = 400
"""Lines of the conversation that are kept to be shown; the session's file has all."""
_LONGEST = 500  # characters of what a person says
_WAITING = 50  # inputs that may wait for their turn
_PICTURE_EVERY = 0.25  # seconds between two pictures of the camera: each holds up all else for some hundredths
_MOVE = 1 / 30  # seconds that a move takes the robot
_POSE_EVERY = 2  # moves between two poses that are sent; the pages draw the motion between them
_BREATH = 0.02  # seconds after an answer in which the event loop has the interpreter for itself, to send it
_REPLAY = 4.0  # times as fast as it was
_log = logging.getLogger(__name__)

Change = Callable[[Session], None]
"""Puts another session's file in the place of the present one's, which it closes; or raises, and changes nothing."""


@dataclass
class State:
    """What the pages show. Only the event loop changes it."""

    world: World | None = None
    pose: Pose = field(default_factory=lambda: Pose(0.0, 0.0))
    lines: list[Line] = field(default_factory=list)
    dropped: int = 0  # lines that are no longer kept
    candidates: tuple[events.Candidate, ...] = ()
    seen: frozenset[str] = frozenset()
    words: dict[str, dict[str, float]] = field(default_factory=dict)
    question: tuple[str, ...] = ()
    waiting: int = 0
    ready: bool = False

    @property
    def names(self) -> dict[str, str]:
        """id -> what a visitor calls the object."""
        return names_of(self.world.objects) if self.world is not None else {}


class Host:
    """Takes what visitors do to the session, in turn, and what happens in it to all pages.

    Its methods are for the event loop.

    Args:
        file: that keeps the session.
        new: makes it, where the file is not there.
        pace: times as fast as the robot that it is shown; 0: as fast as can be.

    Attributes:
        changed: tells the name of the part of `state` that is new.
        live: tells what changes many times a second.
    """

    def __init__(self, file: Path, new: Callable[[], Session], pace: float = 1.0) -> None:
        self.file = file
        self.state, self.changed, self.live = State(), Event[str](), Live()
        self._new = new
        self._session: Session | None = None
        self._thread = ThreadPoolExecutor(1, "session")
        self._loop: asyncio.AbstractEventLoop | None = None
        self._usual, self._pace = pace, 0.0  # the latter: now
        self._replays = False
        self._asides: collections.deque[Input] = collections.deque()  # texts that came while it was busy
        self._due, self._moves, self._pictured_at = 0.0, 0, 0.0
        self._pictured: tuple[Pose, World] | None = None
        self._digest = hashlib.sha256()  # of all events of the session

    async def begin(self) -> None:
        """Open the session; the pages are there meanwhile.

        Raises:
            UserError: it can't be opened.
        """
        self._loop = asyncio.get_running_loop()
        await self._loop.run_in_executor(self._thread, self._open)
        self._set("status", ready=True)

    async def exchange(self, change: Change) -> None:
        """Put another session in the place of the present one, whose lines go.

        Raises:
            UserError: it can't be prepared; the present one goes on.
        """
        await self.ask(change)
        self._set("status", ready=False)
        await self.begin()

    async def end(self) -> None:
        """Stop the robot and let go of the session; what it still does nobody hears."""
        self.stop()
        self._loop = None
        self._thread.shutdown(wait=False, cancel_futures=True)

    def say(self, text: str, pointing_at: str | None = None) -> None:
        """A person says something, perhaps pointing at an object. "Stop" does not wait for its turn."""
        text = " ".join(text.split())[:_LONGEST]
        if self.state.waiting and is_stop(text):
            self.write(Line("you", text))
            self.stop()
        elif text:
            self.do(Input(say=text, pointing_at=pointing_at))

    def stop(self) -> None:
        """Stop what is under way, at once; bring a replay to its end."""
        if self._replays:
            self._pace = 0.0
        elif self._session is not None:
            self._session.stop()

    def do(self, done: Input) -> None:
        """Give the session an input when its turn comes."""
        if self.state.waiting >= _WAITING:
            self.write(Line("note", "Too many wait for the robot already; say it again later."))
            return
        self.write(line_of_input(done, self.state.names))
        if self.state.waiting and done.say is not None:
            self._asides.append(done)  # the robot may answer it while it drives
        else:
            self._queue(done)

    def _queue(self, done: Input) -> None:
        if self.state.waiting:
            others = f" after {self.state.waiting - 1} more" if self.state.waiting > 1 else ""
            self.write(Line("robot", f"I am still busy; this comes next{others}."))
        self._submit(lambda session: session.play(done, watch=self._watch))

    def _dealt_with(self) -> None:
        self._set("status", waiting=self.state.waiting - 1)
        while self._asides:
            self._queue(self._asides.popleft())

    async def ask(self, do: Callable[[Session], Any]) -> Any:
        """What a function of the session returns, when its turn comes.

        Raises:
            UserError: from `do`, or the session is not open.
        """

        def asked() -> Any:
            if self._session is None:
                raise UserError("the robot is not awake; wait a moment")
            return do(self._session)

        return await asyncio.get_running_loop().run_in_executor(self._thread, asked)

    def replay(self) -> None:
        """Play the session again from its start, for all to see; `stop` brings its end at once."""
        self._submit(self._replay)

    def write(self, line: Line) -> None:
        """Add a line to the conversation."""
        lines, dropped = [*self.state.lines, line], self.state.dropped
        more = max(0, len(lines) - LINES)
        self._set("lines", lines=lines[more:], dropped=dropped + more)

    def _submit(self, do: Callable[[Session], object]) -> None:
        self._set("status", waiting=self.state.waiting + 1)
        self._thread.submit(self._deal, do)

    def _set(self, part: str, **values: Any) -> None:
        """Change a part of the state, and tell the pages."""
        for name, value in values.items():
            setattr(self.state, name, value)
        pose, marks = self.state.pose, {row.id: round(row.probability, 3) for row in self.state.candidates}
        self.live.send(pose=[pose.x, pose.y, pose.yaw], marks=marks, seen=sorted(self.state.seen))
        self.changed.emit(part)

    # What follows runs in the session's thread.

    def _soon(self, do: Callable[[], object]) -> None:
        """Do something in the event loop, while there is one."""
        with contextlib.suppress(RuntimeError):  # it is closed
            if (loop := self._loop) is not None:
                loop.call_soon_threadsafe(do)

    def _post(self, part: str, **values: Any) -> None:
        self._soon(lambda: self._set(part, **values))

    def _write(self, line: Line) -> None:
        self._soon(lambda: self.write(line))

    def _write_input(self, session: Session, done: Input) -> None:
        self._write(line_of_input(done, names_of(session.world.objects)))

    def _clear(self) -> None:
        self._post("lines", lines=[], dropped=0)
        self._post("candidates", candidates=(), question=())

    def _open(self) -> None:
        """Go on with the session that is kept in the file, or begin one."""
        self._clear()
        self._pace, self._digest = 0.0, hashlib.sha256()
        there = self.file.exists()
        self._session = Session.open(self.file, self._watch, self._write_input) if there else self._new()
        self._pace = self._usual
        self._refresh(self._session)

    def _deal(self, do: Callable[[Session], object]) -> None:
        session = self._session
        try:
            if session is not None:
                do(session)
        except UserError as error:
            self._write(Line("note", str(error)))
        except Exception:
            _log.exception("an input failed")
            self._write(Line("note", "Something went wrong inside; the log of the program says what."))
        finally:
            if session is not None:
                self._refresh(session)
            self._soon(self._dealt_with)

    def _replay(self, present: Session) -> None:
        again, inputs = Session.replayed(self.file)
        before, self._digest = self._digest, hashlib.sha256()
        try:
            self._session, self._pace, self._replays = again, _REPLAY * self._usual, True
            self._clear()
            self._refresh(again)
            lines = with_stops(inputs)
            for line, stop_at in lines:
                self._write_input(again, line)
                again.play(line, stop_at, self._watch)
            same = self._digest.digest() == before.digest()
            verdict = "the same to the last byte" if same else "NOT the same as when it happened"
            self._write(Line("note", f"replay over: {len(lines)} inputs, all that followed from them {verdict}"))
        finally:
            self._session, self._digest = present, before
            self._pace, self._replays = self._usual, False
            again.close()

    def _refresh(self, session: Session) -> None:
        """Post what no event says in full."""
        seen = frozenset(percept.id for percept in session.memory)
        self._post("world", world=session.world, seen=seen, question=session.question, pose=session.pose)
        self._post("words", words={word: dict(types) for word, types in session.words().items()})
        self._take_picture(session)  # for the next visitor, even if there is none now

    def _watch(self, event: events.Event) -> None:
        """Show an event, and keep pace with the robot's own time."""
        self._digest.update(events.to_json(event).encode())
        if (line := line_of_event(event)) is not None:
            self._write(line)
        match event:
            case events.Understood() if self._pace:
                time.sleep(_BREATH)
                self._pictured_at = time.monotonic()
            case events.Moved(pose) if self._pace:
                self._moved(pose)
            case events.Candidates(rows, seen):
                self._post("candidates", candidates=rows, seen=frozenset(seen))
            case events.Asked(_, choices):
                self._post("candidates", question=choices)
            case events.WorldChanged() if self._session is not None:
                self._post("world", world=self._session.world)

    def _moved(self, pose: Pose) -> None:
        while self._asides and self._session is not None and not self._replays:
            aside = self._asides.popleft()
            answer = self._session.answer(aside.say or "") if aside.pointing_at is None else None
            if answer is None:
                self._soon(functools.partial(self._queue, aside))
            else:
                self._write(Line("robot", answer))
        self._moves += 1
        if self._moves % _POSE_EVERY == 0:
            self._post("pose", pose=pose)
        now = time.monotonic()
        if now - self._pictured_at >= _PICTURE_EVERY and self.live.visitors and self._session is not None:
            self._take_picture(self._session)
        step = _MOVE / (self._pace or math.inf)
        self._due = max(self._due, now - step) + step  # a late move is not made up for by many quick ones
        time.sleep(max(0.0, self._due - time.monotonic()))

    def _take_picture(self, session: Session) -> None:
        stands = (session.pose, session.world)
        pixels = session.picture(width=320, height=180) if stands != self._pictured else None
        if pixels is None:
            return
        self._pictured, self._pictured_at = stands, time.monotonic()
        content = io.BytesIO()
        Image.fromarray(pixels).save(content, "JPEG", quality=80)
        self._soon(lambda: self.live.send(picture=content.getvalue()))
