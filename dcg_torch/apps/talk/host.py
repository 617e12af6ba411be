"""The conversation that all visitors share: one thread runs the session, the event loop holds what is shown of it."""

from __future__ import annotations

import asyncio
import contextlib
import hashlib
import io
import logging
import threading
import time
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from PIL import Image

from dcg_torch.apps.talk.lines import Line, line_of_event, line_of_input, names_of, with_inputs
from dcg_torch.apps.talk.live import Live
from dcg_torch.dialogue import events
from dcg_torch.dialogue.acts import is_stop
from dcg_torch.dialogue.file import Input, read_session
from dcg_torch.dialogue.session import Session, with_stops
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
_GATHER = 0.005  # seconds in which changes are gathered before the pages hear of them
_BREATH = 0.02  # seconds after an answer in which the event loop has the interpreter for itself, to send it
_REPLAY = 4.0  # times as fast as it was
_log = logging.getLogger(__name__)

OpenSession = Callable[[events.Watcher], Session]
"""Makes a session, or goes on with one; what happened in it before goes to the watcher."""
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
    """

    def __init__(self, file: Path, new: Callable[[], Session], pace: float = 1.0) -> None:
        self.file = file
        self.state = State()
        self.live = Live()
        self._new = new
        self._session: Session | None = None
        self._thread = ThreadPoolExecutor(1, "session")
        self._loop: asyncio.AbstractEventLoop | None = None
        self._listeners: list[Callable[[str], None]] = []
        self._stopped = threading.Event()  # ends the pace of a replay
        self._usual = pace
        self._pace = 0.0  # now
        self._hurries = False  # what is under way may be brought to its end at once
        self._due, self._moves, self._pictured_at = 0.0, 0, 0.0
        self._changed: dict[str, None] = {}  # parts of the state, in the order of their change
        self._pictured: tuple[Pose, World] | None = None
        self._digest = hashlib.sha256()  # of all events of the session

    async def begin(self) -> None:
        """Open the session; the pages are there meanwhile.

        Raises:
            UserError: it can't be opened.
        """
        self._loop = asyncio.get_running_loop()
        await self._run(self._open)
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

    def listen(self, listener: Callable[[str], None]) -> Callable[[], None]:
        """Call `listener` with the part of `State` that has changed, at every change; the function that ends it."""
        self._listeners.append(listener)
        return lambda: self._listeners.remove(listener) if listener in self._listeners else None

    def say(self, text: str, pointing_at: str | None = None) -> None:
        """A person says something, perhaps pointing at an object. "Stop" does not wait for its turn."""
        text = " ".join(text.split())[:_LONGEST]
        if not text:
            return
        if self.state.waiting and is_stop(text):
            self.write(Line("you", text))
            self.stop()
        else:
            self.do(Input(say=text, pointing_at=pointing_at))

    def stop(self) -> None:
        """Stop what is under way, at once."""
        self._stopped.set()
        if self._session is not None:
            self._session.stop()

    def do(self, done: Input) -> None:
        """Give the session an input when its turn comes."""
        if self.state.waiting >= _WAITING:
            self.write(Line("note", "Too many wait for the robot already; say it again later."))
            return
        self.write(line_of_input(done, self.state.names))
        if self.state.waiting:
            others = f", after {self.state.waiting - 1} of others" if self.state.waiting > 1 else ""
            self.write(Line("note", f"The robot is still busy; this is next{others}. Stop ends what it does."))
        self._submit(lambda session: session.play(done, watch=self._watch))

    async def ask(self, do: Callable[[Session], Any]) -> Any:
        """What a function of the session returns, when its turn comes.

        Raises:
            UserError: from `do`, or the session is not open.
        """

        def asked() -> Any:
            if self._session is None:
                raise UserError("the robot is not awake; wait a moment")
            return do(self._session)

        return await self._run(asked)

    def replay(self) -> None:
        """Play the session again from its start, for all to see; `stop` brings its end at once."""
        self._submit(lambda _: self._replay())

    def write(self, line: Line) -> None:
        """Add a line to the conversation."""
        lines, dropped = [*self.state.lines, line], self.state.dropped
        more = max(0, len(lines) - LINES)
        self._set("lines", lines=lines[more:], dropped=dropped + more)

    def _submit(self, do: Callable[[Session], object]) -> None:
        self._set("status", waiting=self.state.waiting + 1)
        self._thread.submit(self._deal, do)

    async def _run(self, do: Callable[[], Any]) -> Any:
        return await asyncio.get_running_loop().run_in_executor(self._thread, do)

    def _set(self, part: str, **values: Any) -> None:
        """Change the state, and tell the pages soon which part of it is new: once of many changes in a row."""
        for name, value in values.items():
            setattr(self.state, name, value)
        if not self._changed:
            asyncio.get_running_loop().call_later(_GATHER, self._tell)
        self._changed[part] = None

    def _tell(self) -> None:
        parts, self._changed = tuple(self._changed), {}
        pose, marks = self.state.pose, {row.id: round(row.probability, 3) for row in self.state.candidates}
        self.live.send(pose=[pose.x, pose.y, pose.yaw], marks=marks, seen=sorted(self.state.seen))
        for listener in tuple(self._listeners):
            try:
                for part in parts:
                    listener(part)
            except Exception:  # a page that is going away must not keep the others from hearing
                _log.exception("a page could not show %s", ", ".join(parts))

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

    def _clear(self) -> None:
        self._post("lines", lines=[], dropped=0)
        self._post("candidates", candidates=(), question=())

    def _open(self) -> None:
        """Go on with the session that is kept in the file, or begin one."""
        self._clear()
        self._pace, self._digest = 0.0, hashlib.sha256()
        if self.file.exists():
            header, inputs = read_session(self.file)
            played = [line for line, _ in with_stops(inputs)]
            watch = with_inputs(header.world, played, self._watch, self._write)
            self._session = Session.open(self.file, watch)
        else:
            self._session = self._new()
        self._pace = self._usual
        self._refresh(self._session)

    def _deal(self, do: Callable[[Session], object]) -> None:
        session = self._session
        self._stopped.clear()
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
            self._soon(lambda: self._set("status", waiting=self.state.waiting - 1))

    def _replay(self) -> None:
        again, inputs = Session.replayed(self.file)
        before, self._digest, present = self._digest, hashlib.sha256(), self._session
        try:
            self._session, self._pace, self._hurries = again, _REPLAY * self._usual, True
            self._clear()
            self._refresh(again)
            lines = with_stops(inputs)
            watch = with_inputs(again.world, [line for line, _ in lines], self._watch, self._write)
            for line, stop_at in lines:
                again.play(line, stop_at, watch)
            same = self._digest.digest() == before.digest()
            verdict = "the same to the last byte" if same else "NOT the same as when it happened"
            self._write(Line("note", f"replay over: {len(lines)} inputs, all that followed from them {verdict}"))
        finally:
            self._session, self._digest = present, before
            self._pace, self._hurries = self._usual, False
            again.close()

    def _refresh(self, session: Session) -> None:
        """Post what no event says in full."""
        seen = frozenset(percept.id for percept in session.memory)
        self._post("world", world=session.world, seen=seen, question=session.question)
        self._post("pose", pose=session.pose)
        self._post("words", words={word: dict(types) for word, types in session.words().items()})
        self._take_picture(session)  # for the next visitor, even if there is none now

    def _watch(self, event: events.Event) -> None:
        """Show an event, and keep pace with the robot's own time."""
        self._digest.update(events.to_json(event).encode())
        line = line_of_event(event)
        if line is not None:
            self._write(line)
        if self._pace and isinstance(event, events.Understood):
            time.sleep(_BREATH)
            self._pictured_at = time.monotonic()
        match event:
            case events.Moved(pose):
                self._moved(pose)
            case events.Candidates(rows, seen):
                self._post("candidates", candidates=rows, seen=frozenset(seen))
            case events.Asked(_, choices):
                self._post("candidates", question=choices)
            case events.WorldChanged() if self._session is not None:
                self._post("world", world=self._session.world)
            case events.Done(pose):
                self._post("pose", pose=pose)

    def _moved(self, pose: Pose) -> None:
        if not self._pace or (self._hurries and self._stopped.is_set()):
            return
        self._moves += 1
        if self._moves % _POSE_EVERY == 0:
            self._post("pose", pose=pose)
        now, step = time.monotonic(), _MOVE / self._pace
        if now - self._pictured_at >= _PICTURE_EVERY and self.live and self._session is not None:
            self._take_picture(self._session)
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
