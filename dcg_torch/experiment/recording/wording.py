"""What the animation says: names of things as the robot knows them, and what it is about to do."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

from dcg_torch.agent.command import Look
from dcg_torch.experiment.recording.recorder import RecordedCommand
from dcg_torch.grounding.solution import Solution
from dcg_torch.types import Object
from dcg_torch.world.files import WorldObject


@dataclass(frozen=True)
class Bar:
    """One row of the chart; `probability` is None as long as the robot hasn't met the thing."""

    name: str
    probability: float | None
    known: bool
    hypothetical: bool
    chosen: bool


def name_of(thing: Object) -> str:
    """An object's name: "blue cube", "orange traffic cone (unknown)", "unseen cube", "unseen unknown thing"."""
    if thing.hypothetical:
        return f"unseen {thing.type if thing.known else 'unknown thing'}"
    name = " ".join(part for part in (thing.color, thing.type) if part)
    return name if thing.known else f"{name} (unknown)"


def meant(solution: Solution) -> str:
    """What a command is taken to mean, in a few words, as in "unseen cube (98 %)"."""
    if solution.object is None or solution.probability is None:
        return "nothing here"
    return f"{name_of(solution.object)} ({100 * solution.probability:.0f} %)"


def bars(recorded: RecordedCommand, looks: int, most: int) -> list[Bar]:
    """The groundings' probabilities after so many looks, at most `most` rows, in the same places throughout.

    First what is hypothetical, then what is perceived, in the order of first sight; where there are too many, those
    that are the least probable all along share the last row.
    """
    things: dict[str, Object] = {}
    highest: dict[str, float] = {}
    for look in recorded.looks:
        for thing in look.solution.world.objects:
            things[thing.id] = thing
            highest[thing.id] = max(look.solution.probabilities[thing.id], highest.get(thing.id, 0.0))
    rows = sorted(things.values(), key=lambda thing: not thing.hypothetical)
    if len(rows) > most:
        kept = sorted(highest, key=lambda id_: -highest[id_])[: most - 1]
        rows = [thing for thing in rows if thing.id in kept]
    now = recorded.looks[looks - 1].solution if looks else None
    probabilities: Mapping[str, float] = now.probabilities if now else {}
    chosen = now.object.id if now and now.object else None
    found = [Bar(name_of(t), probabilities.get(t.id), t.known, t.hypothetical, chosen=t.id == chosen) for t in rows]
    if len(things) > len(rows):
        rest = sum(p for id_, p in probabilities.items() if id_ not in {t.id for t in rows})
        found.append(Bar(f"{len(things) - len(rows)} others", rest if now else None, True, True, chosen=False))
    return found


def doing(recorded: RecordedCommand, moment: int, before: Mapping[str, str]) -> str:
    """What goes on at a moment, in a sentence or two; `before` are the words learned from earlier commands."""
    at, last = recorded.moments[moment], len(recorded.moments) - 1
    if moment == last:
        return f"{ending(recorded)}  {lesson(recorded, before)}".strip()
    solution = recorded.looks[at.looks - 1].solution if at.looks else None
    if solution is None:
        return "It can't make sense of the command."
    if solution.object is None:
        return "It sees nothing that the command could mean."
    means = f"It takes the command to mean {_with_article(solution.object)}"
    if solution.object.hypothetical:
        return f"{means}, and turns to look for one."
    if at.looks < len(recorded.looks):
        return f"{means}, and looks on to be sure."
    return f"{means}, and {'keeps away from it' if solution.inverted else 'drives there'}."


def ending(recorded: RecordedCommand) -> str:
    """How a command came out, in a sentence."""
    row = recorded.row
    if not recorded.looks:
        return "It can't make sense of the command."
    solution = recorded.looks[-1].solution
    if row.chosen is None:
        return "It has turned full circle and found no such thing."
    if solution.inverted:
        return "It has left that object."
    if not row.arrived:
        return "It found no way there."
    return "It has arrived at the right object." if row.correct else "It has arrived, but another object was meant."


def lesson(recorded: RecordedCommand, before: Mapping[str, str]) -> str:
    """What the robot learned from a command, or nothing."""
    new = [(word, type_) for word, type_ in recorded.row.symbols.items() if before.get(word) != type_]
    return "  ".join(
        f"It now knows the word “{word}”." if word == type_ else f"It now knows that “{word}” means {type_}."
        for word, type_ in new
    )


def words(symbols: Mapping[str, str]) -> list[str]:
    """The words learned so far, with what they mean where that is something else."""
    return [f"“{word}”" if word == type_ else f"“{word}” = {type_}" for word, type_ in symbols.items()]


def label(item: WorldObject, look: Look | None) -> tuple[str, bool]:
    """What stands at an object on the floor, in two lines, and whether the robot has seen it."""
    name = f"{item.color} {item.type}"
    if look is None or item.id not in {percept.id for percept in look.percepts}:
        return f"{name}\n(not seen yet)", False
    known = any(thing.known for thing in look.solution.world.objects if thing.id == item.id)
    return name if known else f"{name}\n(unknown)", True


def _with_article(thing: Object) -> str:
    if thing.hypothetical:
        name = f"{thing.type} it has not seen yet" if thing.known else "unknown thing it has not seen yet"
        return f"{_article(name)} {name}"
    name = " ".join(part for part in (thing.color, thing.type) if part)
    return f"the {name}" if thing.known else "the unknown thing it sees"


def _article(name: str) -> str:
    return "an" if name[0] in "aeiou" else "a"
