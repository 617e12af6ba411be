"""How likely each thing is in a room, where no recogniser says so: it follows from what stands around."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from dcg_torch.names.rooms import told_rooms
from dcg_torch.types import Object

_REACH = 1.6
"""Metres within which a thing tells its room: a bed tells of the nightstand, and less of what is at the other wall."""
_NOTHING = 0.05
"""What tells of no room: far from all that tells of one nothing is known."""
_AT_ONCE = 500_000
"""Distances that are worked out at once: among thousands of things there are many millions."""


def in_room(things: Sequence[Object], room: str) -> dict[str, float]:
    """Id -> the probability that the thing is in a room of that name.

    Args:
        things: those that are seen; lengths are metres.
        room: of `data/rooms.yaml`.
    """
    placed = [o for o in things if o.position is not None]
    telling = [(o, name, weight) for o in placed for name, weight in told_rooms(o.type or "")]
    if not any(name == room for _, name, _ in telling):
        return {}
    where = np.array([(o.position or ())[:2] for o in placed])
    seen = np.array([(o.position or ())[:2] for o, _, _ in telling])
    # What is found in many rooms tells much less than what is found in one.
    told = np.array([weight for _, _, weight in telling]) ** 3
    own = np.array([name == room for _, name, _ in telling])
    share: list[float] = []
    for part in np.array_split(where, max(1, len(where) * len(seen) // _AT_ONCE)):
        squared = ((part[:, None] - seen[None]) ** 2).sum(axis=2)
        near = np.exp(-squared / (2.0 * _REACH**2)) * told
        share += (near[:, own].sum(axis=1) / (near.sum(axis=1) + _NOTHING)).tolist()
    return dict(zip([o.id for o in placed], share, strict=True))
