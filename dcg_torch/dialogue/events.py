"""What happens in a session, as frozen values: what a person did, what the robot says, and what it does meanwhile."""

from __future__ import annotations

import json
from collections.abc import Callable
from dataclasses import asdict, dataclass

from dcg_torch.types import Pose


@dataclass(frozen=True, slots=True)
class Understood:
    """The robot's first answer, before it moves: what it takes the text to be. A second one says how that came out.

    Attributes:
        act: "command", "answer", "lesson", "forget", "question", "motion", "stop" or "refused".
        text: a sentence for people, as in "You mean the red cube; I have not seen it yet, so I look round."
        object: id of the object that it takes to be meant, if it has seen it.
    """

    act: str
    text: str
    object: str | None = None


@dataclass(frozen=True, slots=True)
class Candidate:
    """One row of the chart: an object that may be meant.

    Attributes:
        id: of the object; a hypothetical one's begins with "hypothetical".
        name: for people: "red cube", "unseen cube", "unseen unknown thing".
        probability: that it is meant; those of one look sum to 1.
        known: is its type known?
        hypothetical: has it not been seen?
    """

    id: str
    name: str
    probability: float
    known: bool
    hypothetical: bool


@dataclass(frozen=True, slots=True)
class Candidates:
    """The robot has looked and grounded anew; the most probable candidate comes first."""

    rows: tuple[Candidate, ...]
    seen: tuple[str, ...]


@dataclass(frozen=True, slots=True)
class Looking:
    """The robot turns, or drives somewhere, to see more; the moves follow as `Moved`."""


@dataclass(frozen=True, slots=True)
class Moved:
    """The robot is on its way, and here by now: 30 of these to a second of its motion."""

    pose: Pose


@dataclass(frozen=True, slots=True)
class Said:
    """A sentence of the robot."""

    text: str


@dataclass(frozen=True, slots=True)
class Asked:
    """The robot asks which object is meant. The next text or click may answer; any other input drops the question."""

    text: str
    candidates: tuple[str, ...]


@dataclass(frozen=True, slots=True)
class Learned:
    """A word has a meaning now, or another one than before; `type` is None where a word was forgotten."""

    word: str
    type: str | None
    source: str  # "told", "outcome" or "forgotten"


@dataclass(frozen=True, slots=True)
class WorldChanged:
    """Somebody added, moved or removed this object by hand."""

    object: str


@dataclass(frozen=True, slots=True)
class Done:
    """The input is dealt with, and the robot stands here.

    Attributes:
        result: "arrived", "no way", "blocked", "too far" or "stopped" after a drive; "asked" where an answer is waited
            for; "absent" where what is meant is not there; "done" for all else.
        object: id of the object that the robot went to or spoke of, if any.
    """

    pose: Pose
    result: str
    object: str | None = None


Event = Understood | Candidates | Looking | Moved | Said | Asked | Learned | WorldChanged | Done

Watcher = Callable[[Event], None]
"""Called with every event as it happens, in the session's thread."""


def to_json(event: Event) -> str:
    """One line: {"event": "Said", "text": "..."}; numbers in full, so that equal events give equal bytes."""
    return json.dumps({"event": type(event).__name__, **asdict(event)}, ensure_ascii=False)
