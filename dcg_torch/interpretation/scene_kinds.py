"""What kind of scene a command is said in: people use one word otherwise at a table, in a room and before a picture.

A corpus teaches what a word for a relation means, and how it differs in scenes like its own. So several corpora that
are taught together agree on what they share, and keep apart what they don't.
"""

from __future__ import annotations

from dcg_torch.types import WorldModel
from dcg_torch.types.arrays import Floats

_MANY = 25
_TABLE, _YARD = 0.4, 2.0
"""Metres between neighbours: less on tables and in pictures, more where one drives about."""
_STEP = 0.2
"""Share of a scene's unit by which heights differ where things lie on one another."""


def scene_kind(world: WorldModel) -> str:
    """By what anyone sees: how far things are apart, a speaker, more than one class, colours, many things, heights."""
    seen = [o for o in world.objects if not o.hypothetical]
    step = _STEP * world.unit
    low = next((o.position[2] for o in seen if o.position is not None), 0.0)
    told = {
        "table": world.unit < _TABLE,
        "yard": world.unit > _YARD,
        "speaker": world.speaker is not None and world.speaker != world.robot,
        "classes": len({o.type for o in seen}) > 1,
        "colors": any(o.color is not None for o in seen),
        "many": len(seen) > _MANY,
        "heights": any(abs(z - low) > step for z in {o.position[2] for o in seen if o.position is not None}),
    }
    return " ".join(name for name, holds in told.items() if holds) or "bare"


def is_on_floor(world: WorldModel) -> bool:
    """Are things of known sizes so far apart that they stand on a floor, and neither on a table nor in a picture?"""
    return world.unit >= _TABLE and all(o.size is not None for o in world.objects if not o.hypothetical)


def is_close_by(world: WorldModel) -> bool:
    """Are things on a table or in a picture, all of it seen at once?"""
    return world.unit < _TABLE


def is_board(kind: str) -> bool:
    """Are things of one kind on a table? What is "the highest" there is so as on a page, but for the top of a stack."""
    names = kind.split(" ")
    return "table" in names and "heights" in names and "classes" not in names


def stands_among(seen: Floats) -> bool:
    """Is there something on every side of the robot?

    Args:
        seen: (n, 2) where things are, from the robot; all finite.
    """
    if not len(seen):
        return False
    least, most = float(seen.min(axis=0).max()), float(seen.max(axis=0).min())
    return least <= 0.0 <= most
