"""A conversation in plain text, for terminals and for people without a browser."""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator

from dcg_torch.dialogue.events import Asked, Event, Said, Understood
from dcg_torch.dialogue.session import Session

_CLICK = re.compile(r"\[(?P<id>[^\]]+)\]")
_POINTING = re.compile(r"(?P<text>.*\S)\s*\[(?P<id>[^\]]+)\]")


def spoken(events: Iterable[Event]) -> list[str]:
    """The robot's sentences."""
    return [event.text for event in events if isinstance(event, (Understood, Said, Asked))]


def converse(session: Session, lines: Iterable[str]) -> Iterator[str]:
    """Play a list of turns, and give each with the robot's sentences, a line each.

    Args:
        lines: a text each; "this is a pallet [crate]" points at the object `crate`, and "[crate]" clicks on it.
    """
    for line in map(str.strip, lines):
        if not line:
            continue
        yield f"> {line}"
        if (click := _CLICK.fullmatch(line)) is not None:
            yield from spoken(session.click(click["id"]))
        elif (pointing := _POINTING.fullmatch(line)) is not None:
            yield from spoken(session.say(pointing["text"], pointing_at=pointing["id"]))
        else:
            yield from spoken(session.say(line))
