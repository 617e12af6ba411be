"""A conversation with a robot in a world: inputs in, events out, every input on disk before anything comes of it."""

from __future__ import annotations

import logging
import threading
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import Any, Literal

import numpy as np
import yaml
from numpy.typing import NDArray

from dcg_torch.agent.robot import InteractiveRobot
from dcg_torch.dialogue import conversation, questions
from dcg_torch.dialogue.acts import read_act
from dcg_torch.dialogue.events import Done, Event, Moved, Said, Watcher, WorldChanged
from dcg_torch.dialogue.file import (
    MOST_CHARACTERS,
    Header,
    Input,
    Move,
    SessionFile,
    checked_model,
    model_hash,
    read_session,
    with_stops,
)
from dcg_torch.dialogue.situation import Situation
from dcg_torch.learning.beliefs import UNMET
from dcg_torch.model import GroundingModel
from dcg_torch.model.checkpoint import load
from dcg_torch.model.pretrain import SHIPPED
from dcg_torch.speech_acts.requests import Question
from dcg_torch.storage.atomic_files import write_whole
from dcg_torch.storage.untrusted_files import plain
from dcg_torch.types import Percept, Pose
from dcg_torch.world.files import RobotStart, World, WorldObject

_log = logging.getLogger(__name__)


class Session:
    """One robot, one world, one model, and whoever talks to it.

    All methods but `stop` are for one thread at a time. Each input returns its events when it is dealt with, and gives
    them to `watch` as they happen: a page shows them there, and may sleep a thirtieth of a second at each `Moved`, for
    that is how long the move took the robot. An input that the world or the robot refuses is answered with `Said`, not
    with an exception.

    Args:
        world: where it begins; a world file, or one of the generator's.
        model: folder of a saved model; None: the shipped one.
        file: where the session is kept, a new file; None: nowhere. `Session.open` goes on with one that is there.
        simulator: with physics, or without.
        seed: kept in the file; draws the recogniser's mistakes, if it is ever told to make any.

    Attributes:
        header: what it began with.
        world: as it is now, the robot's start in it being where it stood when the world was last changed by hand.
        model: what it has learned by now; read it (`lexicon()`, `symbols`), don't teach it past the session.
        state: what the conversation rests on, for those who draw it.

    Raises:
        UserError: the file is there already, the model is missing or not valid, or the simulator can't have the world.
    """

    _file: SessionFile | None

    def __init__(
        self,
        world: World,
        model: Path | None = None,
        *,
        file: Path | None = None,
        simulator: Literal["pybullet", "fake"] = "pybullet",
        seed: int = 0,
    ) -> None:
        folder = None if model is None else str(model.resolve())
        header = Header(world=world, model=folder, sha256=model_hash(model), simulator=simulator, seed=seed)
        self._begin(header)
        try:
            self._file = SessionFile(file, header) if file is not None else None
        except BaseException:
            self.close()
            raise

    def _begin(self, header: Header) -> None:
        """Stand at the start of a session."""
        self.header, self.world = header, header.world
        self._file = None
        self._stop = threading.Event()
        self._events: list[Event] = []
        self._watch: Watcher | None = None
        self._stop_at: int | None = None
        self._was_stopped = False
        self.model: GroundingModel = load(header.model or SHIPPED)
        robot = _robot(header.simulator)
        self.state = Situation(robot, self.model, self._emit, lambda: self._was_stopped)
        robot.load(header.world, rng=np.random.default_rng(header.seed))
        robot.on_tick = lambda pose: self._emit(Moved(pose))
        read_act("turn left", (), asked=False)  # so that the first text does not wait for the words to load
        self.state.warm_up()

    @classmethod
    def replayed(cls, file: Path) -> tuple[Session, tuple[Input, ...]]:
        """A session at its start, with no file of its own, and the inputs of the one that is to be played again.

        Raises:
            UserError: the file is not valid, or its model is not there, or not the one that it was.
        """
        header, inputs = read_session(file)
        session = cls.__new__(cls)
        session._begin(checked_model(header, file))
        return session, inputs

    @classmethod
    def open(
        cls,
        file: Path,
        watch: Watcher | None = None,
        before: Callable[[Session, Input], object] | None = None,
    ) -> Session:
        """Go on with a session: all its inputs are played again, each after a call of `before`, its events to `watch`.

        This is how a killed server comes back: an input that was under way is carried out to its end.
        """
        kept = SessionFile(file)
        try:
            session = cls.__new__(cls)
            session._begin(checked_model(kept.header, file))
        except BaseException:
            kept.close()
            raise
        for line, stop_at in with_stops(kept.inputs):
            if before is not None:
                before(session, line)
            session.play(line, stop_at, watch)
        session._file = kept
        return session

    def say(self, text: str, *, pointing_at: str | None = None, watch: Watcher | None = None) -> tuple[Event, ...]:
        """A text, with the id of the object that was pointed at, if any. The first answer comes before it moves."""
        clean = text.encode("utf-8", "replace").decode()[:MOST_CHARACTERS]
        return self.play(Input(say=clean, pointing_at=pointing_at), None, watch)

    def click(self, object_id: str, *, watch: Watcher | None = None) -> tuple[Event, ...]:
        """A click: the answer to a question, or else the robot says what it takes the object for."""
        return self.play(Input(click=object_id), None, watch)

    def add_object(self, thing: WorldObject, *, watch: Watcher | None = None) -> tuple[Event, ...]:
        """Put an object into the world."""
        return self.play(Input(add=thing), None, watch)

    def move_object(
        self, object_id: str, position: tuple[float, float], yaw: float | None = None, *, watch: Watcher | None = None
    ) -> tuple[Event, ...]:
        """Put an object elsewhere: metres, and radians if it is turned too."""
        return self.play(Input(move=Move(id=object_id, position=position, yaw=yaw)), None, watch)

    def remove_object(self, object_id: str, *, watch: Watcher | None = None) -> tuple[Event, ...]:
        """Take an object away."""
        return self.play(Input(remove=object_id), None, watch)

    def stop(self) -> None:
        """Stop what is under way, at once; any thread may call this, also while the robot drives.

        Nothing happens if nothing is under way. A page calls it for a text of which `acts.is_stop` holds, and does not
        wait for its turn.
        """
        self._stop.set()

    def play(self, line: Input, stop_at: int | None = None, watch: Watcher | None = None) -> tuple[Event, ...]:
        """Any input; `stop_at` is the number of the event after which it is stopped, as a session's file says."""
        if self._file is not None:
            self._file.append(line)
        self._events, self._watch, self._stop_at, self._was_stopped = [], watch, stop_at, False
        self._stop.clear()
        self.state.robot.resume()
        try:
            done = self._done(line)
        except Exception:  # a fault in one input must not take the session with it, now or when it is played again
            _log.exception("an input failed: %s", line)
            self._emit(Said("Something went wrong in me; the log of the program says what."))
            done = Done(self.pose, "done")
        self._emit(done)
        self._watch = None
        return tuple(self._events)

    def _done(self, line: Input) -> Done:
        things = {thing.id: thing for thing in self.world.objects}
        if line.say is not None:
            return conversation.hear(self.state, line.say, things.get(line.pointing_at or ""))
        if line.click is not None:
            if line.click in things:
                return conversation.clicked(self.state, things[line.click])
            return self._refused(f"there is no {line.click} here")
        if line.add is not None:
            id_ = line.add.id
            return (
                self._refused(f"there is a {id_} already") if id_ in things else self._change({**things, id_: line.add})
            )
        id_ = line.remove or (line.move.id if line.move is not None else "")
        if id_ not in things:
            return self._refused(f"there is no {id_} here")
        if line.move is None:
            return self._change({key: thing for key, thing in things.items() if key != id_})
        yaw = things[id_].yaw if line.move.yaw is None else line.move.yaw
        moved = things[id_].model_copy(update={"position": line.move.position, "yaw": yaw})
        return self._change({**things, id_: moved})

    def _refused(self, why: str) -> Done:
        self._emit(Said(f"That can't be done: {plain(why, 200)}."))
        return Done(self.pose, "done")

    def _change(self, things: Mapping[str, WorldObject]) -> Done:
        """The world with these objects, the robot where it is; it forgets what was changed unless it sees it."""
        if not things:
            return self._refused("one object must stay")
        before, state, here = self.world, self.state, self.pose
        old = {thing.id: thing for thing in before.objects}
        changed = [id_ for id_ in {**old, **things} if old.get(id_) != things.get(id_)]
        try:
            world = standing_at(World(name=before.name, objects=tuple(things.values())), here)
            state.robot.load(world, rng=np.random.default_rng(self.header.seed))
        except ValueError as error:
            state.robot.load(standing_at(before, here), rng=np.random.default_rng(self.header.seed))
            return self._refused(str(error).splitlines()[0])
        self.world = world
        state.places.clear()
        state.open = None
        for key in changed:
            state.memory.pop(key, None)
            self._emit(WorldChanged(key))
        state.look()
        return Done(self.pose, "done", changed[0] if changed else None)

    def _emit(self, event: Event) -> None:
        self._events.append(event)
        if self._watch is not None:
            self._watch(event)
        if not self._was_stopped and (self._stop.is_set() or len(self._events) == self._stop_at):
            self._was_stopped = True
            self.state.robot.stop()
            if self._file is not None:
                self._file.append(Input(stop=len(self._events)))

    @property
    def pose(self) -> Pose:
        """Where the robot is; from the session's own thread."""
        return self.state.robot.pose

    @property
    def memory(self) -> Sequence[Percept]:
        """The objects that it has seen, as it remembers them, in the order of first sight."""
        return self.state.seen

    @property
    def question(self) -> tuple[str, ...]:
        """Ids of the objects that its open question is about; empty: none is open."""
        return () if self.state.open is None else self.state.open[1].candidates

    def words(self) -> Mapping[str, Mapping[str, float]]:
        """word -> type -> probability: what each word heard or taught may mean, those of the start left out."""
        new = [e for e in self.model.lexicon() if not e.settled or e.word in self.state.taught]
        return {e.word: {"not met yet" if t == UNMET else t: p for t, p in e.types} for e in new}

    def answer(self, text: str) -> str | None:
        """The answer to a question that takes neither a look nor a move; None for any other text.

        It changes nothing and is not kept. From the session's own thread, also from `watch`, while the robot drives.
        """
        act = read_act(text, self.model.symbols.keys(), asked=self.state.open is not None)
        return questions.answer_at_once(self.state, act) if isinstance(act, Question) else None

    def reasons(self, most: int = 12) -> list[str]:
        """Why the last command was grounded as it was: factors and features with their log-odds, a line each."""
        return questions.reasons(self.state, most)

    def picture(self, *, width: int = 320, height: int = 180) -> NDArray[np.uint8] | None:
        """What the camera sees, (height, width, 3) bytes; None without physics. From the session's own thread."""
        look: Any = getattr(self.state.robot, "picture", None)
        return None if look is None else look(width=width, height=height)

    def save_model(self, folder: Path) -> None:
        """Write what it has learned into a folder; `Session(model=folder)` and `dcg_torch.load` read it."""
        self.model.save(folder)

    def save_world(self, path: Path) -> None:
        """Write the world as it is now, the robot's pose as its start, as a world file."""
        values = standing_at(self.world, self.pose).model_dump(mode="json", exclude={"commands", "relational"})
        write_whole(path, yaml.safe_dump(values, sort_keys=False, allow_unicode=True))

    def close(self) -> None:
        """Let go of the simulator and the file."""
        self.state.robot.close()
        if self._file is not None:
            self._file.close()


def _robot(simulator: str) -> InteractiveRobot:
    if simulator == "fake":
        from dcg_torch.simulator.fake_robot import FakeRobot

        return FakeRobot()
    from dcg_torch.simulator.robot import SimulatedRobot  # here: PyBullet need not be there for the fake robot

    return SimulatedRobot(observed=1)


def standing_at(world: World, pose: Pose) -> World:
    """The world with the robot at this pose."""
    return world.model_copy(update={"robot": RobotStart(x=pose.x, y=pose.y, yaw=pose.yaw)})
