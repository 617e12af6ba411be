"""A conversation in plain text, for terminals and for people without a browser."""

from __future__ import annotations

from collections.abc import Iterable

from dcg_torch.dialogue.events import Asked, Event, Said, Understood


def spoken(events: Iterable[Event]) -> list[str]:
    """The robot's sentences."""
    return [event.text for event in events if isinstance(event, (Understood, Said, Asked))]
