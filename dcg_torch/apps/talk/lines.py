"""The conversation as people read it: lines, from inputs and events."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable
from dataclasses import dataclass

from dcg_torch.dialogue import events
from dcg_torch.dialogue.file import Input
from dcg_torch.world.files import WorldObject


@dataclass(frozen=True, slots=True)
class Line:
    """A line of the conversation. `who` is "you", "robot" or "note"; `choices` are ids that a question is about."""

    who: str
    text: str
    choices: tuple[str, ...] = ()


def names_of(objects: Iterable[WorldObject]) -> dict[str, str]:
    """id -> what a visitor calls the object: colour and type, with the id where two are alike."""
    names = {thing.id: f"{thing.color} {thing.type}" for thing in objects}
    times = Counter(names.values())
    return {id_: name if times[name] == 1 else f"{name} ({id_})" for id_, name in names.items()}


def line_of_input(done: Input, names: dict[str, str]) -> Line:
    """What a person did, given what the objects are called."""
    if done.say is not None:
        return Line("you", done.say)
    if done.click is not None:
        return Line("you", f"(points at the {names.get(done.click, done.click)})")
    if done.add is not None:
        return Line("note", f"put here by hand: {done.add.color} {done.add.type}")
    id_ = done.move.id if done.move is not None else done.remove or ""
    return Line("note", f"{'moved' if done.move is not None else 'taken away'} by hand: {names.get(id_, id_)}")


def line_of_event(event: events.Event) -> Line | None:
    """What the robot says, and what it has learned; None for what the rest of the page shows."""
    match event:
        case events.Understood(_, text) | events.Said(text):
            return Line("robot", text)
        case events.Asked(text, choices):
            return Line("robot", text, choices)
        case events.Learned(word, None):
            return Line("note", f"forgotten: {word}")
        case events.Learned(word, type_, source):
            meaning = "" if word == type_ else f" = {type_}"
            return Line("note", f"learned{' from the outcome' if source == 'outcome' else ''}: {word}{meaning}")
    return None
