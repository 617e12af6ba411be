"""Plays `talk_script.yaml` and compares every turn with what was expected of it."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import yaml

from dcg_torch.dialogue.events import Asked, Done, Event, Learned, Moved, Understood, to_json
from dcg_torch.dialogue.session import Session
from dcg_torch.dialogue.text import spoken
from dcg_torch.types import Pose
from dcg_torch.world.files import WorldObject

SCRIPT = Path(__file__).parent / "talk_script.yaml"


def script() -> list[dict[str, Any]]:
    """The turns, and the changes of the world between them."""
    turns: list[dict[str, Any]] = yaml.safe_load(SCRIPT.read_text("utf-8"))["turns"]
    return turns


def transcript(events: Iterable[Event]) -> bytes:
    """The events as JSON lines."""
    return "".join(to_json(event) + "\n" for event in events).encode()


@dataclass
class Played:
    """A turn with what came of it."""

    turn: dict[str, Any]
    events: tuple[Event, ...]
    before: Pose
    after: Pose

    @property
    def failures(self) -> list[str]:
        """What is not as it was expected, a line each."""
        expected = self.turn["expect"]
        found = {name: find(self) for name, find in _FOUND.items() if name in expected}
        wrong = [f"{k}: {found[k]!r}, not {expected[k]!r}" for k in found if not _same(k, found[k], expected[k])]
        said = " ".join(spoken(self.events)).lower()
        wrong += [f"does not say {part!r}: {said}" for part in expected.get("says", ()) if part.lower() not in said]
        wrong += [f"says {part!r}: {said}" for part in expected.get("not_says", ()) if part.lower() in said]
        return wrong


def _done(played: Played) -> Done:
    done = played.events[-1]
    assert isinstance(done, Done)
    return done


def _act(played: Played) -> str:
    first = played.events[0] if isinstance(played.events[0], Understood) else None
    understood = first or next(e for e in played.events if isinstance(e, Understood))
    return understood.act


_FOUND: dict[str, Callable[[Played], Any]] = {
    "act": _act,
    "object": lambda played: _done(played).object,
    "result": lambda played: _done(played).result,
    "asked": lambda played: next((set(e.candidates) for e in played.events if isinstance(e, Asked)), set()),
    "learned": lambda played: {e.word: e.type for e in played.events if isinstance(e, Learned)},
    "turned": lambda played: math.degrees(played.after.yaw - played.before.yaw),
    "driven": lambda played: math.dist((played.after.x, played.after.y), (played.before.x, played.before.y)),
}


def _same(name: str, found: Any, expected: Any) -> bool:
    if name == "turned":
        return bool(abs(math.remainder(found - expected, 360.0)) < 3.0)
    if name == "driven":
        return bool(abs(found - expected) < 0.2)
    if name == "asked":
        return bool(found == set(expected))
    return bool(found == expected)


def play(session: Session, turns: list[dict[str, Any]], observe: Callable[[int], object] | None = None) -> list[Played]:
    """Play the turns; those of the world's changes are not among what is returned.

    Args:
        observe: called with the number of each move in its turn.
    """
    out = []
    for turn in turns:
        before = session.pose
        if "add" in turn:
            session.add_object(WorldObject(**{**turn["add"], "position": tuple(turn["add"]["position"])}))
        elif "move" in turn:
            session.move_object(turn["move"]["id"], tuple(turn["move"]["position"]))
        elif "remove" in turn:
            session.remove_object(turn["remove"])
        else:
            moves = [0]

            def watch(event: Event, moves: list[int] = moves, stop: int | None = turn.get("stop")) -> None:
                moves[0] += isinstance(event, Moved)
                if observe is not None:
                    observe(moves[0])
                if moves[0] == stop:
                    session.stop()

            if "click" in turn:
                events = session.click(turn["click"], watch=watch)
            else:
                events = session.say(turn["say"], pointing_at=turn.get("at"), watch=watch)
            out.append(Played(turn, events, before, session.pose))
    return out
