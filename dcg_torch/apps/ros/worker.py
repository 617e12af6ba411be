"""One note after another: taken once, waited for, done, acknowledged, saved."""

from __future__ import annotations

import threading
import time
import traceback
from collections import deque
from collections.abc import Callable
from dataclasses import asdict, dataclass

from dcg_torch.apps.ros.notes import BadNoteError, Note, read_note, to_text
from dcg_torch.apps.ros.options import Options
from dcg_torch.apps.ros.robot import TopicRobot
from dcg_torch.apps.ros.senses import HaltedError, RobotSilentError, Senses
from dcg_torch.apps.ros.state import Handled, Store
from dcg_torch.apps.ros.tasks import Outlet, Said, Tasks
from dcg_torch.storage.errors import explain_os_error

_REMEMBERED = 2_000  # notes with an id whose acknowledgement is kept
_UNSAVED = 1.0  # seconds for which what is done may wait to be saved, while more is to do


@dataclass(frozen=True)
class _Job:
    kind: str
    note: Note

    def is_same(self, other: _Job) -> bool:
        """Sent twice? By the id, or without one by the words: who says the same again while it waits adds nothing."""
        if self.note.id or other.note.id:
            return self.note.id == other.note.id
        return self == other

    def acknowledged(self, said: Said) -> Said:
        """What is published of it."""
        return {"id": self.note.id, "kind": self.kind, "text": self.note.text, **said}


class Worker:
    """Does what notes ask for: `accept` from any thread, `run` in the one that the model belongs to.

    Args:
        tasks: what there is to do.
        senses: of the robot.
        robot: stands still when it is stopped.
        options: the parameters as they are now.
        outlet: where all that is said goes.
        store: where the model is saved; None: nowhere.
        handled: acknowledgements of notes that an earlier node has handled.
    """

    def __init__(
        self,
        tasks: Tasks,
        senses: Senses,
        robot: TopicRobot,
        options: Callable[[], Options],
        outlet: Outlet,
        store: Store | None = None,
        handled: Handled | None = None,
    ) -> None:
        self._tasks, self._senses, self._robot = tasks, senses, robot
        self._options, self._outlet, self._store = options, outlet, store
        self._handled: Handled = dict(handled or {})
        self._changed = threading.Condition()
        self._jobs: deque[_Job] = deque()
        self._now: _Job | None = None
        self._closed = False
        self._done: list[Said] = []  # and not acknowledged yet
        self._saved = 0.0
        self._do = {"command": tasks.command, "teach": tasks.teach, "correct": tasks.correct, "forget": tasks.forget}

    def accept(self, kind: str, data: str) -> None:
        """Take a message of a kind: "command", "teach", "correct" or "forget"."""
        try:
            job = _Job(kind, read_note(data))
        except BadNoteError as error:
            self._acknowledge({"id": None, "kind": kind, "state": "refused", "said": str(error)})
            return
        with self._changed:
            before = self._handled.get(job.note.id or "")
            waiting = [*self._jobs, *([self._now] if self._now else [])]
            if before is not None:
                self._acknowledge({**before, "repeated": True})
            elif any(job.is_same(other) for other in waiting):
                self._acknowledge(job.acknowledged({"state": "accepted", "repeated": True}))
            elif self._closed or len(self._jobs) >= self._options().queue:
                said = f"{len(self._jobs)} wait already; send it again later"
                self._acknowledge(job.acknowledged({"state": "refused", "said": said}))
            else:
                self._jobs.append(job)
                self._acknowledge(job.acknowledged({"state": "accepted", "before": len(waiting)}))
                self._changed.notify_all()

    def stop(self) -> str:
        """End what is under way, and drop what waits; what was done, in words."""
        with self._changed:
            dropped = list(self._jobs)
            self._jobs.clear()
            self._senses.halt()
            self._robot.stand()
            for job in dropped:
                said = job.acknowledged({"state": "stopped", "said": "stopped before it began"})
                self._remember(job, said)
                self._acknowledge(said)
        return f"stopped; {len(dropped)} that waited will not be done"

    def save(self) -> tuple[bool, str]:
        """Write a snapshot: whether it was written, and where to or why not."""
        if self._store is None:
            return False, "no folder to save into; start the node with the parameter state"
        with self._changed:
            handled = dict(self._handled)
        try:
            with self._tasks.learning:
                return True, str(self._store.save(self._tasks.model, handled))
        except OSError as error:
            return False, explain_os_error(error)

    def lexicon(self) -> str:
        """The words as JSON."""
        with self._tasks.learning:
            return to_text({"words": [asdict(entry) for entry in self._tasks.model.lexicon()]})

    def close(self) -> None:
        """Stop, and let `run` return."""
        with self._changed:
            self._closed = True
            self._changed.notify_all()
        self.stop()

    def run(self) -> None:
        """Do one thing after another until `close`."""
        self._tasks.show()
        while True:
            with self._changed:
                while not (self._jobs or self._closed):
                    self._changed.wait()
                if self._closed:
                    break
                self._now = job = self._jobs.popleft()
                self._senses.go_on()
            said = job.acknowledged(self._outcome(job))
            with self._changed:
                self._now = None
                self._remember(job, said)
                more = bool(self._jobs)
            self._done.append(said)
            if self._store is None or not more or time.monotonic() - self._saved > _UNSAVED:
                self._publish()
        self._publish()

    def _publish(self) -> None:
        """Acknowledge what is done. Where there is a folder, only what is saved is said to be done."""
        done, self._done = self._done, []
        if self._store is not None and done:
            saved, where = self.save()
            self._saved = time.monotonic()
            if not saved:
                self._outlet.complain(where)
                done = [{**said, "unsaved": where} for said in done]
        self._tasks.show()
        for said in done:
            self._acknowledge(said)

    def _outcome(self, job: _Job) -> Said:
        """What came of a job; whatever was wrong with it, the robot must go on with the next."""
        try:
            said = self._do[job.kind](job.note)
        except HaltedError:
            said = {"state": "stopped", "said": "stopped while it was under way"}
        except (RobotSilentError, BadNoteError) as error:
            said = {"state": "failed", "said": str(error)}
        except Exception as error:
            self._outlet.complain(traceback.format_exc())
            said = {"state": "failed", "said": f"an error of the program: {type(error).__name__}: {error}"}
        if said["state"] == "stopped":
            self._robot.stand()  # the job may have sent a goal after `stop` did this
        return said

    def _remember(self, job: _Job, said: Said) -> None:
        if job.note.id is not None:
            self._handled[job.note.id] = said
            while len(self._handled) > _REMEMBERED:
                del self._handled[next(iter(self._handled))]

    def _acknowledge(self, said: Said) -> None:
        self._outlet.say("acknowledgement", to_text(said))
