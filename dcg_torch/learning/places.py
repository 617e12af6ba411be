"""Hand-made examples of the words for places, for their sides, and for groups: what "you" and "a row" are."""

from __future__ import annotations

from dataclasses import replace

from dcg_torch.names.vocabulary import (
    DIRECTIONS,
    EITHER_END,
    GROUP_WORDS,
    MIDDLE_LINE,
    OWNERS,
    PLACE_WORDS,
    READ_FROM,
    SIDE_WORDS,
)
from dcg_torch.scene.groups import groups, lines_of_all
from dcg_torch.scene.layout import LINE_NUMBERS
from dcg_torch.scene.places import places, side_middles
from dcg_torch.types import Correspondence, Example, Object, Phrase, PhraseKind, Pose, Symbol, WorldModel

_AMBIGUOUS = 0.1
_WEIGHT = 3.0
"""Of the examples of words for places: "you" and "left" are what they are until people say otherwise."""


_EDGES = (1.0, 7.0, -3.0, 3.0)
"""Of a workspace, seen from the robot, metres."""


def place_symbols() -> list[Symbol]:
    """The words for places that are known from the start."""
    return [Symbol(word, kind) for word, (kind, _) in PLACE_WORDS.items()]


def group_nouns() -> tuple[str, ...]:
    """The words for groups that are known from the start."""
    return tuple(GROUP_WORDS)


def place_examples() -> list[Example]:
    """Hand-made examples of what the words for places, for their sides, and for groups mean."""
    robot, speaker = Pose(0.0, 0.0), Pose(4.0, 0.0)
    things = (*places(_EDGES, robot, speaker), *side_middles(_EDGES, robot))
    cube = Object("cube", "cube", known=True)
    world = WorldModel((cube,), robot, speaker, things)
    phrases: list[tuple[Phrase, set[str], set[str]]] = []
    for noun, (kind, side) in PLACE_WORDS.items():
        phrase = Phrase(PhraseKind.NOUN, noun, noun=noun, context=("landmark: of any",))
        phrases.append((phrase, {kind}, set() if side is None else {side}))
        if kind in ("corner", "edge") and side is None:
            phrases += [(replace(phrase, words=(word,)), {kind}, {of}) for word, of in SIDE_WORDS.items()]
        if noun in DIRECTIONS:
            for word, owner in OWNERS.items():
                whose = replace(phrase, words=(word,))
                phrases.append((whose, {"direction"}, {DIRECTIONS[noun], owner}))
    return [
        Example(
            phrase,
            world,
            tuple(
                Correspondence.ACTIVE if o.type in kinds and sides <= o.attributes else Correspondence.INACTIVE
                for o in world.things
            ),
            weight=_WEIGHT * (_AMBIGUOUS if {phrase.noun, *phrase.words} & EITHER_END else 1.0),
        )
        for phrase, kinds, sides in phrases
    ] + [*_group_examples(), *_line_examples(things)]


def _group_examples() -> list[Example]:
    """A row, a stack and a cluster of cubes: which of them a word means, and that a cube alone is none of them."""
    rows = [Object(f"row {k}", "cube", known=True, position=(3.0, 1.0 * k, 0.0)) for k in range(3)]
    stack = [Object(f"stack {k}", "cube", known=True, position=(8.0, 0.0, 1.0 * k)) for k in range(3)]
    heap = [Object(f"heap {k}", "cube", known=True, position=(14.0 + k % 2, 1.0 * (k // 2), 0.0)) for k in range(4)]
    objects = (*rows, *stack, *heap)
    kept = [g for g in groups(objects) if {m.split()[0] for m in g.members} in ({"row"}, {"stack"}, {"heap"})]
    found = tuple(g for g in kept if ("row" in g.attributes) == g.members[0].startswith("row"))
    world = WorldModel(objects, Pose(0.0, 0.0), groups=found)

    def labels(kinds: tuple[str, ...]) -> tuple[Correspondence, ...]:
        meant = [bool(o.attributes & set(kinds)) if o.members else not kinds for o in world.things]
        return tuple(Correspondence.ACTIVE if m else Correspondence.INACTIVE for m in meant)

    said = [Example(Phrase(PhraseKind.NOUN, "cube", noun="cube"), world, labels(()), weight=_WEIGHT)]
    for word, kinds in GROUP_WORDS.items():
        if word in READ_FROM:
            continue
        alone = Phrase(PhraseKind.NOUN, word, noun=word)
        of_cubes = Phrase(PhraseKind.NOUN, f"{word} of cubes", (word,), "cube", plural=True)
        said += [Example(phrase, world, labels(kinds), weight=_WEIGHT) for phrase in (alone, of_cubes)]
    return said


def _line_examples(places_there: tuple[Object, ...]) -> list[Example]:
    """Boards with one thing in each row and column: which of them a number from an end means."""
    said = []
    for number in (7, 10):
        objects = tuple(Object(f"{k}", "cube", known=True, position=(1.0 * k, 1.0 * k, 0.0)) for k in range(number))
        robot = Pose(0.0, 0.0)
        world = WorldModel(objects, robot, groups=lines_of_all(objects, 1.0, robot), places=places_there)
        for word in (*LINE_NUMBERS, MIDDLE_LINE):
            for line in READ_FROM:
                meant = [{word, line} <= o.attributes for o in world.things]
                if any(meant):
                    label = tuple(Correspondence.ACTIVE if m else Correspondence.INACTIVE for m in meant)
                    phrase = Phrase(PhraseKind.NOUN, line, (word,), line, context=("landmark: of any",))
                    said.append(Example(phrase, world, label, weight=_WEIGHT))
    return said
