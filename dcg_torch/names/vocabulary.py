"""Words with a fixed meaning, shared by the rooms: places that can be spoken of, groups, and who owns a side."""

from __future__ import annotations

from collections.abc import Iterable

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
SIDE_MIDDLE = "middle of a side"
_SIDES = tuple((word, side) for word, (kind, side) in PLACE_WORDS.items() if kind == "edge" and side is not None)
PLACE_WORDS |= {f"{word} middle": (SIDE_MIDDLE, side) for word, side in _SIDES}
"""What "the top middle" is called where it is a place."""
DIRECTIONS = {"left": "left side", "right": "right side", "front": "far side", "back": "near side"}
"""Nouns for the sides of somebody: "on your left"."""
PLACE_TYPES = frozenset(kind for kind, _ in PLACE_WORDS.values())
OWNERS = {"your": "of robot", "my": "of speaker"}
ADVERBS = {"ahead": "ahead of", "behind": "behind"}
"""Words that say by themselves where a thing is for the one who is spoken to."""
BEARINGS = {"front": "ahead of", "back": "behind", "behind": "behind"}
"""Words for a side. Who stands among the things has it; for one who doesn't, it is a side of theirs."""
BESIDE_WHOM = {"left of": "left", "right of": "right"}
"""Relations to a person that are a person's sides: "left of you" is on your left."""
LINE_ACROSS, LINE_ALONG, MIDDLE_LINE = "line across", "line along", "middle line"
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
    LINE_ACROSS: (LINE_ACROSS,),
    LINE_ALONG: (LINE_ALONG,),
}
"""What people call groups; the last two are what "row" and "column" mean where they are counted through a scene."""
BUILT_OF = {
    **{"string": "row", "chain": "row", "segment": "row"},
    **{"story": "stack", "storey": "stack", "building": "stack", "structure": "stack"},
}
"""What they call one after its counted members, and not else: "the two-story building", "the three-block chain"."""
TIERS = frozenset({"shelf", "level", "tier", "board"})
"""What people call a row of what stands at several heights before them, where nothing that is there is called so."""
LINE_OF = {"row": LINE_ACROSS, "line": LINE_ACROSS, "column": LINE_ALONG}
_FIRST = ("top", "topmost", "upper", "uppermost", "highest", "back", "far")
_LAST = ("bottom", "bottommost", "lower", "lowest", "front", "near", "last")
LINE_FROM: dict[str, dict[str, str]] = {
    LINE_ACROSS: dict.fromkeys(_FIRST, "from the top") | dict.fromkeys(_LAST, "from the bottom"),
    LINE_ALONG: dict.fromkeys(("left", "leftmost"), "from the left")
    | dict.fromkeys(("right", "rightmost", "last"), "from the right"),
}
"""Line of a scene -> word for one of its ends -> from where it is the first."""
READ_FROM = {LINE_ACROSS: ("from the top", "from the left"), LINE_ALONG: ("from the left", "from the top")}
"""Line -> from where such lines are counted, and from where the things in one are, as one reads a page."""
LINE_ENDS: dict[str, tuple[int | None, int]] = {
    **dict.fromkeys(("top", "topmost", "upper", "highest", "from the top", "far", "back"), (0, 1)),
    **dict.fromkeys(("bottom", "bottommost", "lower", "lowest", "from the bottom", "near", "front"), (0, -1)),
    **dict.fromkeys(("left", "leftmost", "from the left"), (1, 1)),
    **dict.fromkeys(("right", "rightmost", "from the right"), (1, -1)),
    "last": (None, -1),
}
"""Word -> is it an end of rows (0), of columns (1) or of both, and is it the first (1) or the last (-1)?"""
CELL = "cell: "
"""Begins the attribute that tells in which row and column of a grid a thing stands."""
LIKELY_ROOM = "likely room: "
"""Begins the attribute that tells in which room of a home a thing is likely to be."""
SPOT = "spot: "
"""Begins the attribute that tells whether a thing is in a corner of a room."""
AT_WALL = "at a wall: "
"""Begins the attribute that tells whether a thing stands at a wall of a room, or hangs there."""
LEVEL = "level: "
"""Begins the attributes that tell how many levels of its stack are below a thing, and how many above it."""
TIER = "tier: "
"""Begins the attribute that tells on which shelf a thing stands, from the bottom, where shelves are no things."""
WORKED_OUT = (CELL, LIKELY_ROOM, SPOT, AT_WALL, LEVEL, TIER)
"""Attributes that no recogniser gives."""
CELL_STEPS = {"above": (-1, 0), "over": (-1, 0), "on top of": (-1, 0), "under": (1, 0), "below": (1, 0)}
CELL_STEPS |= {"left of": (0, -1), "right of": (0, 1)}
CELL_STEPS |= {"north of": (-1, 0), "south of": (1, 0), "west of": (0, -1), "east of": (0, 1)}
CELL_STEPS |= {"northwest of": (-1, -1), "northeast of": (-1, 1), "southwest of": (1, -1), "southeast of": (1, 1)}
"""Preposition -> one step that way in a grid: rows down, columns to the right."""
NUMBER_WORDS = {"two": 2, "three": 3, "four": 4, "five": 5, "six": 6, "seven": 7, "eight": 8}
INSIDE = frozenset({"in", "of", "from", "at the bottom of", "on top of", "in the middle of"})
"""Prepositions by which a thing is one of a group."""
NEAREST, FARTHEST = "closest to", "farthest from"
RANKING = frozenset({NEAREST, FARTHEST, "farthest to"})
"""Prepositions by which things are ranked from a landmark."""
WITHIN = "within"
"""What "on" and "to" a side say of things that are ranked there: they are in that part of the scene."""
ORDINALS = {
    **{"first": 1, "second": 2, "third": 3, "fourth": 4, "fifth": 5},
    **{"sixth": 6, "seventh": 7, "eighth": 8, "ninth": 9, "tenth": 10},
}
NTH = "nth "
"""Begins the word that says to which number a modifier counts, beyond those that have weights: "fifth closest to"."""
TOGETHER = "together "
"""Begins the word that says how many of a kind stand together, and are meant or picked from: "together 2"."""
MUTUAL = frozenset({"next to", "touching", "near", "close to", "beside"})
"""Prepositions by which several stand together: "two cubes next to each other"."""
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
OF_TWO = frozenset({"between", "in the middle of"})
"""Prepositions that say how a thing stands to two landmarks at once."""
OR = "or"
"""A word of a noun phrase that may be meant in the place of those that it is joined to."""
QUANTIFIERS = frozenset({"all", "any", "both", "each", "either", "every", OR})
"""Words that say how many are meant, and nothing of which."""
DEFINITE = frozenset({"the", "this", "that", "my", "your", "its", "his", "her", "our", "their"})
"""Words before what is one thing in particular."""
GROUP_LIKE = frozenset({*GROUP_WORDS, "pair"})
"""Words that make one whole of several things."""
ANY, SO_MANY = "any", frozenset({*NUMBER_WORDS, "one", "a couple"})
"""What begins a noun phrase that means some of several, whichever they are: "any two", "three of", "a couple of"."""
HALF, FEW = "half", {"few": 3}
"""Words for a share of what is described, and for how many are meant at most."""
SO_FAR = "so far from"
"""The relation of what is so far from a landmark as the text of a phrase says: "within a metre of"."""
LED = "led from"
"""The relation of what lies where a way leads from the robot."""
ODD, NOTHING, NO_OTHER = "odd", "nothing ", "no other "
"""The word for what alone differs from all else, and what begins the words for what has nothing, or no other of its
kind, beside it."""
ALONE = "alone"
"""The word for what stands by itself, and in no stack."""
NEARER_OF_TWO, NEARER_THAN = "nearer of two", "nearer than another"
"""Relations to two landmarks: a thing is nearer to the first than to the second, or than the second is."""
THAN = "than"
"""The preposition before what a thing is compared with."""
EXCEPT = "except"
"""The preposition before what is left out."""
EITHER_END = frozenset({"back", "front"})
"""Of a table or a room: people who face the robot and people who stand behind it mean opposite ends."""
WORKSPACE = frozenset({"table", "board", "floor", "ground", "grid", "image", "picture", "photo", "screen", "surface"})
WORKSPACE |= {"field", "map", "scene", "workspace", "plane"}
"""What people call all of a scene, where nothing that is there is called so."""
STOOD_ON = frozenset({"table", "floor", "ground"})
"""Of these what things may stand on, or on one another: "the block on the table" is not on a block."""
HOME = frozenset({"house", "home", "apartment", "flat"})
"""The same of a home: what is in it is anywhere."""
GROUND_WORD = "board"
VIEWERS = frozenset({"camera", "viewer", "observer", "lens", "forklift", "rover", "drone", "vehicle"})
"""Who sees the scene or is spoken to, where nothing that is there is called so."""
SIDE_OF = {"left of": "left", "right of": "right", "in front of": "front", "behind": "back", "under": "bottom"}
SIDE_OF |= {"in the middle of": "middle"}
"""Of the whole scene a preposition names a side: "on the right side of the table"."""
LATERAL = frozenset({"left", "right"})
VERTICAL = frozenset({"top", "bottom", "front", "back"})
SIDED = LATERAL | VERTICAL
DEGREES = frozenset({"far", "very", "extreme", "utmost", "farthest", "outer"})
SYNONYMS = {
    **{"smaller": "smallest", "littler": "smallest", "littlest": "smallest", "tiniest": "smallest"},
    **{"larger": "largest", "bigger": "biggest", "upper": "top", "lower": "bottom", "topmost": "top"},
    **{"bottommost": "bottom", "center": "middle", "central": "middle", "middlemost": "middle", "centric": "middle"},
    **dict.fromkeys(("lone", "single", "freestanding", "solitary", "lonely", "standalone"), ALONE),
    **{"northernmost": "top", "southernmost": "bottom", "easternmost": "rightmost", "westernmost": "leftmost"},
    **dict.fromkeys(("tiny", "teeny", "mini", "miniature", "minute", "smallish"), "small"),
    **dict.fromkeys(("huge", "giant", "gigantic", "enormous", "massive", "largish", "biggish"), "big"),
    **{"taller": "tallest", "shorter": "shortest", "higher": "highest", "uppermost": "highest", "lowermost": "lowest"},
    **{"high": "highest", "low": "lowest", "farther": "farthest", "closer": "closest", "nearer": "closest"},
    **{"isolated": ALONE},
    **{"frontmost": "closest", "foremost": "closest", "rearmost": "farthest", "hindmost": "farthest"},
}
"""Words of noun phrases, and those that say the same where nothing is compared with a thing that is named."""
FLAT_SYNONYMS = {"highest": "top", "lowest": "bottom"}
FLAT_SYNONYMS |= {"from the top": "from the back", "from the bottom": "from the front"}
"""The same where all stands on one level: "the lowest dot" of a picture is the one at its bottom."""
COMPASS: dict[str, tuple[str, ...]] = {"north": ("top",), "south": ("bottom",), "east": ("right",), "west": ("left",)}
COMPASS |= {f"{up}{side}": COMPASS[up] + COMPASS[side] for up in ("north", "south") for side in ("east", "west")}
COMPASS |= {f"{name}ern": sides for name, sides in COMPASS.items()}
COMPASS |= {f"{up}{side}ernmost": COMPASS[up] + COMPASS[side] for up in ("north", "south") for side in ("east", "west")}
"""Of a picture or a map north is up."""
_BY_SIDE = {"top": "behind", "bottom": "in front of", "left": "left of", "right": "right of"}
BY_COMPASS = {f"{name} of": tuple(_BY_SIDE[side] for side in sides) for name, sides in COMPASS.items()}
SAME_RELATION = {"closer to": NEAREST, "closest from": NEAREST, "farther from": FARTHEST}
SAME_RELATION |= {
    "before": "in front of",
    "beyond": "behind",
    "over": "above",
    "after": "behind",
    "along": "on",
    "without": "not with",
    "outside": "not in",
}
"""Prepositions, and those that say the same."""
LIKE_RELATION = {"touching": "next to", "in the middle of": "between", "among": "near", "around": "near"}
LIKE_RELATION |= {"surrounded by": "near", "with": "near", "not with": "near", "in line with": "next to"}
"""Prepositions, and those that say much the same: what is known of these holds for them too, until they are learned."""
AT_END, TOWARDS, AWAY_FROM = "at the end of", "on the side towards", "on the side away from"
"""Where a thing is at what has extents; the sides face another thing, or away from it."""
OF_OUTLINE = frozenset({AT_END, TOWARDS, AWAY_FROM})
OF_BOTH = OF_TWO | OF_OUTLINE | {NEARER_OF_TWO, NEARER_THAN}
"""Prepositions of which several landmarks are no several places."""
BESIDE_THE_WAY = "beside the way on"
"""Where a thing is on the side of a way on which somebody looks ahead, and what is counted there begins."""
LIKE_RELATION |= {BESIDE_THE_WAY: "on", AT_END: "at", TOWARDS: "next to", AWAY_FROM: "next to"}
PICKED_FROM = {"in the middle of": "middle", "left of": "leftmost", "right of": "rightmost"}
PICKED_FROM |= {"behind": "farthest", "in front of": "closest", "at the bottom of": "bottom"}
"""What picks a thing from a group: "the one in the middle of the row, at the left end of the row"."""


def ranks_from_landmark(relation: str) -> bool:
    """Does a relation rank things from a landmark: "closest to", "second closest to"?"""
    return relation in RANKING or relation.partition(" ")[2] in RANKING


def is_superlative(word: str) -> bool:
    """Does a word pick the end of an order: "nearest", "leftmost", "middle"?"""
    return word.endswith(("est", "most")) or word == "middle"


def cardinal(word: str) -> int | None:
    """What a number says that counts: 3 for "three" and "3"; None for other words, and for nought."""
    return NUMBER_WORDS.get(word) or (int(word) if word.isdecimal() else None) or None


def counted(words: Iterable[str], of: str = "of ") -> int | None:
    """How many the words of a noun phrase say that there are: 5 for "of 5"; None where they do not."""
    return next((int(word[len(of) :]) for word in words if word.startswith(of) and word[len(of) :].isdecimal()), None)
