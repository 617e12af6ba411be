"""What notes ask for: carry out a command, learn a name, correct one, forget one."""

from __future__ import annotations

import math
import threading
import time
from collections.abc import Callable
from typing import Any, Protocol

from dcg_torch.agent.asking import AskingPolicy, Question, Reply
from dcg_torch.agent.command import Look, Outcome, carry_out
from dcg_torch.agent.explore import LookBefore, Worth
from dcg_torch.apps.ros.notes import BadNoteError, Note, read_correction, read_reply, to_text, understood
from dcg_torch.apps.ros.options import Options
from dcg_torch.apps.ros.robot import TopicRobot
from dcg_torch.apps.ros.senses import RobotSilentError, Senses
from dcg_torch.learning.lexicon import Entry
from dcg_torch.model import GroundingModel
from dcg_torch.types import DriveResult, Percept, WorldModel

Said = dict[str, Any]
"""What is acknowledged: at least `state` (done or failed) and `said`, a sentence."""


class Outlet(Protocol):
    """Where the node's words go; any thread may call it."""

    def say(self, topic: str, text: str) -> None:
        """Publish a text."""

    def show(self, entries: list[Entry], percepts: tuple[Percept, ...]) -> None:
        """Publish the lexicon, as text and at what is seen."""

    def complain(self, text: str) -> None:
        """Log what went wrong."""


class Tasks:
    """Each method does what a note asks for, in the thread that the model belongs to.

    Attributes:
        percepts: all that was seen for the last note.
        learning: held while the model changes; who reads its words or saves it from another thread holds it too.
    """

    def __init__(
        self, model: GroundingModel, senses: Senses, robot: TopicRobot, options: Callable[[], Options], outlet: Outlet
    ) -> None:
        self.model = model
        self.percepts: tuple[Percept, ...] = ()
        self.learning = threading.Lock()
        self._senses, self._robot, self._options, self._outlet = senses, robot, options, outlet
        self._answers: list[str] = []
        # The paper's models hold words without degrees: they turn while what is meant is out of view, and never ask.
        self._doubts = model.beliefs_about(()) is not None

    def command(self, note: Note) -> Said:
        """Algorithm 1; the model learns from a drive that arrived, or that there was nothing to drive to."""
        options = self._options()
        worth = Worth(meanings=options.look_above, sure=options.ask_below if options.ask else None, views=options.views)
        outcome = carry_out(
            note.text,
            self.model,
            self._robot,
            spin_step=math.radians(options.spin_step or 20.0),
            explorer=LookBefore(self.model.beliefs_of, worth) if self._doubts else None,
            asking=AskingPolicy(below=options.ask_below) if self._doubts and options.ask else None,
            listener=lambda question: self._ask(note, question),
            watch=lambda look: self._report(note, look),
        )
        self.percepts = outcome.percepts
        said = _said(outcome)
        if outcome.solution is None or not options.learn or outcome.drive not in (None, DriveResult.ARRIVED):
            return said
        with self.learning:
            learned = self.model.learn(outcome.solution, outcome.experience(note.id or note.text))
        symbol = learned.symbol
        return {**said, "learned": None if symbol is None else {symbol.word: symbol.type}, "reason": learned.reason}

    def teach(self, note: Note) -> Said:
        """A teacher's sentence about what is seen now."""
        world = self._world()
        with self.learning:
            told = self.model.tell(note.text, world, pointing_at=note.pointing_at)
        if not told:
            return _failed(told.problem or "")
        return {"state": "done", "said": f"{told.word} names a {told.type}", "learned": {told.word: told.type}}

    def correct(self, note: Note) -> Said:
        """Learn what a word means, from a note "WORD = TYPE"."""
        word, type_ = read_correction(note.text)
        self._change(lambda: self.model.correct(word, type_))
        return {"state": "done", "said": f"{word} names a {type_}", "learned": {word: type_}}

    def forget(self, note: Note) -> Said:
        """Forget the word of a note."""
        word = " ".join(note.text.lower().split())
        self._change(lambda: self.model.forget(word))
        return {"state": "done", "said": f"{word} is forgotten"}

    def answer(self, data: str) -> None:
        """An answer to the question that was asked; any thread may call it."""
        self._answers.append(data[:200])
        self._senses.notify()

    def show(self) -> None:
        """Publish the lexicon."""
        self._outlet.show(self.model.lexicon(), self.percepts)

    def _change(self, change: Callable[[], None]) -> None:
        with self.learning:
            try:
                change()
            except ValueError as error:
                raise BadNoteError(str(error)) from None

    def _world(self) -> WorldModel:
        pose = self._robot.pose
        self.percepts = tuple(self._robot.perceive())
        return self.model.world_model(self.percepts, pose)

    def _report(self, note: Note, look: Look) -> None:
        self._outlet.say("understood", to_text(understood(note, look.solution)))

    def _ask(self, note: Note, question: Question) -> Reply:
        """Ask until somebody answers; another answer is one to nothing that was asked."""
        options, asked = self._options(), {"id": note.id, "text": question.text, "candidates": question.candidates}
        ends = time.monotonic() + options.answer_timeout
        self._answers.clear()
        while (left := ends - time.monotonic()) > 0.0:
            self._outlet.say("question", to_text(asked))
            reply = self._senses.wait(lambda: self._reply(question), min(left, options.resend))
            if reply is not None:
                return reply
        raise RobotSilentError(f"nobody answered for {options.answer_timeout:g} s: {question.text}")

    def _reply(self, question: Question) -> Reply | None:
        return next((r for data in list(self._answers) if (r := read_reply(data, question)) is not None), None)


def _said(outcome: Outcome) -> Said:
    """How a command went."""
    solution, drive = outcome.solution, outcome.drive
    if solution is None or solution.object is None:
        return _failed(outcome.parse.problem or (solution and solution.problem) or "nothing here is meant")
    if drive is None:
        return {**_failed("what is meant was not found"), "probability": solution.probability}
    found = {"object": solution.object.id, "probability": solution.probability, "drive": drive.value}
    if drive is DriveResult.STOPPED:
        return {"state": "stopped", "said": "stopped on the way", **found}
    if not drive:
        return {**_failed(f"it did not get there: {drive.value}"), **found}
    return {"state": "done", "said": f"{'away from' if solution.inverted else 'at'} {solution.object.id}", **found}


def _failed(problem: str) -> Said:
    return {"state": "failed", "said": problem}
