"""The speaker who is one of the things that are there: "follow me", "come to me", "look at me".

Who speaks and is not to be seen cannot be meant: a parser says so, and the command is refused. Where something stands
in the speaker's place, it is the speaker, and "me" is its name.
"""

from __future__ import annotations

import functools
import math
import re
from collections.abc import Sequence
from dataclasses import dataclass, replace

from dcg_torch.grounding.exceptions import without
from dcg_torch.grounding.solution import target_of, with_target
from dcg_torch.interpretation.parser_protocol import ReadCommand, WeightedReading
from dcg_torch.names.normal_form import read_data
from dcg_torch.types import Object, ParseTree, Phrase, PhraseKind, WorldModel

_SAME_PLACE = 0.1  # metres
_ME = "me"
_NAMELESS = Phrase(PhraseKind.NOUN, "that one")
_ORDER = ParseTree(Phrase(PhraseKind.VERB, ""), (ParseTree(Phrase(PhraseKind.NOUN, _ME, noun=_ME)),))
"""What an order about "me" comes to that a parser refuses."""


@dataclass(frozen=True, slots=True)
class _Reading:
    tree: ParseTree
    log_weight: float = 0.0
    rules: tuple[str, ...] = ()


@dataclass(frozen=True, slots=True)
class _Command:
    text: str
    readings: Sequence[WeightedReading]
    problem: str | None = None


def body_of_speaker(world: WorldModel) -> Object | None:
    """The thing that stands where the speaker does; None if nothing does, or nobody knows where the speaker is."""
    if world.speaker is None:
        return None
    at = world.speaker.x, world.speaker.y
    there = [o for o in world.objects if o.position is not None and math.dist(o.position[:2], at) < _SAME_PLACE]
    return there[0] if len(there) == 1 else None


def about_the_speaker(command: ReadCommand, world: WorldModel) -> tuple[ReadCommand, WorldModel]:
    """A command about the speaker as one about the thing that the speaker is; any other is about something else.

    Returns:
        The command, and the world in which only what may be meant is meant.
    """
    body = body_of_speaker(world)
    if body is None or (world.meant is not None and body.id not in world.meant):
        return command, world
    tree = command.readings[0].tree if command.readings else _ORDER if _orders().search(command.text) else None
    target = None if tree is None else target_of(tree)
    if tree is not None and target is not None and target.phrase.noun == _ME:
        said = _Command(command.text, [_Reading(with_target(tree, ParseTree(_NAMELESS)))])
        return said, replace(world, meant=frozenset({body.id}))
    alike = any(o.type == body.type for o in world.objects if o is not body and not o.hypothetical)
    return command, without(world, frozenset({body.id})) if alike else world


@functools.cache
def _orders() -> re.Pattern[str]:
    return re.compile(str(read_data("people.yaml")["to_speaker"]), re.IGNORECASE)
