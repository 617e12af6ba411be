"""The values that the rooms hand to one another: frozen, hashable, free of behaviour.

Units are metres and radians. The world frame has z up; a robot at yaw 0 looks along +x and has +y on its
left. Notation of the paper: lambda_i is a `Phrase`, gamma_ij a `Grounding`, phi_ij a `Correspondence`,
Upsilon a `WorldModel` and Upsilon_KP, UP, KH, UH are told apart by `Object.known` x `Object.hypothetical`.
"""

from __future__ import annotations

import enum
from collections.abc import Collection, Iterator
from dataclasses import dataclass, field
from typing import NamedTuple


class Correspondence(enum.IntEnum):
    """phi_ij: does the phrase mean this grounding, its opposite, or neither (Section II)?"""

    INVERTED = -1
    INACTIVE = 0
    ACTIVE = 1


class PhraseKind(enum.StrEnum):
    """What a phrase is, by its head."""

    VERB = "verb"
    PREPOSITION = "preposition"
    NOUN = "noun"
    MODIFIER = "modifier"  # a preposition that describes a noun phrase: "(the cone) behind (the cube)"


LOOKED_ROUND = "looked round"
"""Attribute of a hypothetical object, once the robot has seen all the ground that it can."""
OPAQUE = "opaque: "
"""Begins the name of a type that is to say nothing of what people call it."""

NOT = "not"
"""Word of a modifier that is negated ("not on the cube"): it says how the factor is read, and is no feature of it."""


class GroundingKind(enum.StrEnum):
    """What a phrase may ground to; every grounding is about one object."""

    ACTION = "action"  # a verb's constraint on the motion: end near the object, or far from it
    REGION = "region"  # a preposition's: the surroundings of the object
    OBJECT = "object"  # a noun phrase's: the object itself
    PLACED = "placed"  # a modifier's: the object, as one that stands so to the child's


@dataclass(frozen=True, slots=True)
class Phrase:
    """lambda_i, one node of the parse tree.

    `words` are the lower-case lemmas that describe a verb or preposition ("go", "not"; "away from" is one
    word of a preposition). A noun phrase has its head in `noun` (singular, "fire hydrant" is one noun, None
    for a pronoun such as "one"), its stated colour in `color`, and its other adjectives and ordinals in
    `words` ("big", "second", "leftmost"). `context` says what the phrase stands in, as far as that tells something
    of its meaning ("object of take"), and `among` what "the closest" is the closest of: things of one "kind", "type"
    or "color", or "all". `look` holds the words of the command, where the colours that objects show are known, and
    `scene` the kind of scene that it is said in.
    """

    kind: PhraseKind
    text: str
    words: tuple[str, ...] = ()
    noun: str | None = None
    color: str | None = None
    plural: bool = False
    count: int | None = None
    context: tuple[str, ...] = ()
    among: str | None = None
    look: tuple[str, ...] = ()
    scene: str = ""

    def __hash__(self) -> int:
        # Few phrases that are kept together share these, and phrases are looked up all the time.
        return hash((self.text, self.noun, self.words, self.context))


@dataclass(frozen=True, slots=True)
class ParseTree:
    """A phrase and the phrases below it; the children are grounded first (Section II, Fig. 2)."""

    phrase: Phrase
    children: tuple[ParseTree, ...] = ()
    _hash: int | None = field(default=None, init=False, repr=False, compare=False)

    def __hash__(self) -> int:
        # Trees are looked up all the time: what a tree hashes to is found once.
        found = self._hash
        if found is None:
            found = hash((self.phrase, self.children))
            object.__setattr__(self, "_hash", found)
        return found

    def __reduce__(self) -> tuple[type[ParseTree], tuple[Phrase, tuple[ParseTree, ...]]]:
        return ParseTree, (self.phrase, self.children)  # in another process text hashes to something else

    def walk(self) -> Iterator[ParseTree]:
        """Every node, parents before children."""
        below = [self]
        while below:
            node = below.pop()
            yield node
            below.extend(node.children[::-1])


@dataclass(frozen=True, slots=True)
class Pose:
    """Where on the floor, and the heading: metres, radians."""

    x: float
    y: float
    yaw: float = 0.0


class DriveResult(enum.Enum):
    """How a drive ended; true only if it ended where it should."""

    ARRIVED = "arrived"
    NO_WAY = "no way"  # the obstacles leave none
    BLOCKED = "blocked"  # it did not get there in time
    TOO_FAR = "too far"  # beyond what the robot drives at a time
    STOPPED = "stopped"  # somebody stopped the robot

    def __bool__(self) -> bool:
        return self is DriveResult.ARRIVED


@dataclass(frozen=True, slots=True)
class Percept:
    """One recognised object: what the camera and the recogniser say of it.

    `position` is the foot of the object, `size` its extents, both (x, y, z) in metres in the world frame.
    `attributes` are further facts, as texts ("held", "material: wood", "glasses: no") or as a dict
    (`{"held": True, "material": "wood", "glasses": False}`). `rgb` is what it looks like, each 0 to 255.
    """

    id: str
    type: str
    color: str | None
    position: tuple[float, float, float]
    size: tuple[float, float, float] | None = None
    attributes: Collection[str] = frozenset()
    rgb: tuple[float, float, float] | None = None


@dataclass(frozen=True, slots=True)
class Object:
    """An element of Upsilon. A hypothetical object has no position, and no type if it is unknown too.

    A group of objects has `members`, their ids, and the type and colour that they share.
    """

    id: str
    type: str | None
    known: bool
    hypothetical: bool = False
    color: str | None = None
    position: tuple[float, float, float] | None = None
    size: tuple[float, float, float] | None = None
    attributes: frozenset[str] = frozenset()
    members: tuple[str, ...] = ()
    rgb: tuple[float, float, float] | None = None


@dataclass(frozen=True, slots=True)
class WorldModel:
    """Upsilon, with the poses that "in front of" or "closest to me" are relative to.

    `groups` are rows, stacks and clusters of objects: a command about one means its members. `places` can be spoken
    of but not be meant: corners, edges, the middle, the robot, the speaker. `unit` is the length in metres that
    neighbours are apart in scenes like this: what "next to" is measured by. Where `meant` is given, only the objects
    of these ids can be meant; the others are there and can be landmarks. `viewer` is whose left and right are meant
    where nobody's are named: None is the robot.
    """

    objects: tuple[Object, ...]
    robot: Pose | None = None
    speaker: Pose | None = None
    places: tuple[Object, ...] = ()
    groups: tuple[Object, ...] = ()
    unit: float = 1.0
    meant: frozenset[str] | None = None
    viewer: Pose | None = None
    _classes: frozenset[str] | None = field(default=None, init=False, repr=False, compare=False)

    @property
    def things(self) -> tuple[Object, ...]:
        """All that a noun phrase may speak of: the objects, then the groups, then the places."""
        return self.objects + self.groups + self.places

    @property
    def meanable(self) -> tuple[Object, ...]:
        """What a command may be about: the objects, then the groups."""
        return self.objects + self.groups

    @property
    def classes(self) -> frozenset[str]:
        """The types of what may be there: of what is perceived, and of what is unseen until all has been looked at."""
        found = self._classes
        if found is None:  # asked for several times with each command
            there = {o.type for o in self.objects if not o.hypothetical or LOOKED_ROUND not in o.attributes}
            found = frozenset([type_ for type_ in there if type_ is not None])
            object.__setattr__(self, "_classes", found)
        return found


class Grounding(NamedTuple):
    """gamma_ij: an object, the region around it, or the constraint to move with respect to it."""

    kind: GroundingKind
    object: Object


class Child(NamedTuple):
    """One element of Gamma_c_ij: a child phrase's grounding and how it corresponds."""

    grounding: Grounding
    correspondence: Correspondence = Correspondence.ACTIVE


@dataclass(frozen=True, slots=True)
class Symbol:
    """gamma': the word, the type it names, the colour of the object it was learned from, the colour stated."""

    word: str
    type: str
    color: str | None = None
    color_word: str | None = None


@dataclass(frozen=True, slots=True)
class Example:
    """The labelled factors of one phrase in one world: phi_ij for every grounding gamma_ij of lambda_i.

    `correspondences[j]` labels the grounding about `world.things[j]`; None leaves it unlabelled, and so do labels
    that end early. `children`
    are the child groundings, about objects of the same world. Symbols are stored, never features:
    `features.FeatureSet` encodes an example anew under whatever is known by then. `weight` scales its
    log-likelihood; `weights`, if given, has a further factor for each grounding, so that a label can be soft: the
    same groundings ACTIVE in one example and INACTIVE in another.
    """

    phrase: Phrase
    world: WorldModel
    correspondences: tuple[Correspondence | None, ...]
    children: tuple[Child, ...] = ()
    weight: float = 1.0
    weights: tuple[float, ...] | None = None
