"""Words with a fixed meaning, shared by the rooms: places that can be spoken of, groups, and who owns a side."""

from __future__ import annotations

# What people call the places; the side is the one that the word itself names, seen from the robot.
PLACE_WORDS = {
    "corner": ("corner", None),
    "edge": ("edge", None),
    "side": ("edge", None),
    "border": ("edge", None),
    "margin": ("edge", None),
    "left": ("edge", "left side"),
    "right": ("edge", "right side"),
    "top": ("edge", "far side"),
    "back": ("edge", "far side"),
    "bottom": ("edge", "near side"),
    "front": ("edge", "near side"),
    "middle": ("middle", None),
    "center": ("middle", None),
    "centre": ("middle", None),
    "you": ("robot", None),
    "robot": ("robot", None),
    "yourself": ("robot", None),
    "floor": ("ground", None),
    "ground": ("ground", None),
    "board": ("ground", None),
    "table": ("ground", None),
    "me": ("speaker", None),
    "myself": ("speaker", None),
    "speaker": ("speaker", None),
}
DIRECTIONS = {"left": "left side", "right": "right side", "front": "far side", "back": "near side"}
"""Nouns for the sides of somebody: "on your left"."""
PLACE_TYPES = frozenset(kind for kind, _ in PLACE_WORDS.values())
OWNERS = {"your": "of robot", "my": "of speaker"}
GROUP_WORDS = {
    "row": ("row",),
    "line": ("row",),
    "column": ("row", "stack"),
    "stack": ("stack",),
    "tower": ("stack",),
    "pile": ("stack", "cluster"),
    "heap": ("stack", "cluster"),
    "group": ("cluster",),
    "bunch": ("cluster",),
    "cluster": ("cluster",),
    "collection": ("cluster",),
}
"""What people call groups."""
INSIDE = frozenset({"in", "of", "from", "at the bottom of", "on top of", "in the middle of"})
"""Prepositions by which a thing is one of a group."""
RANKING = frozenset({"closest to", "farthest from", "farthest to"})
"""Prepositions by which things are ranked from a landmark."""
ORDINALS = {
    **{"first": 1, "second": 2, "third": 3, "fourth": 4, "fifth": 5},
    **{"sixth": 6, "seventh": 7, "eighth": 8, "ninth": 9, "tenth": 10},
}
ANYTHING = frozenset({"thing", "object", "item", "one"})
"""Nouns that may be said of every object."""
SIDE_WORDS = {"left": "left side", "right": "right side", "top": "far side", "far": "far side", "back": "far side"}
SIDE_WORDS |= {
    "bottom": "near side",
    "near": "near side",
    "front": "near side",
    "upper": "far side",
    "lower": "near side",
}
EITHER_END = frozenset({"back", "front"})
"""Of a table or a room: people who face the robot and people who stand behind it mean opposite ends."""
