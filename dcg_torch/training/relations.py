"""Generated lessons on spatial relations, for a robot that starts without a corpus of its own.

Commands of fixed forms in random worlds, seen from the robot: no human wrote them, and they teach only what their
definitions below say. The words of a relation get their weights from these lessons by the same fit as all others.
"""

from __future__ import annotations

import functools
from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

from dcg_torch import space
from dcg_torch.supervised import Lesson
from dcg_torch.symbols import Object, ParseTree, Percept, Phrase, PhraseKind, WorldModel
from dcg_torch.world.files import World
from dcg_torch.world.generator import generate_world
from dcg_torch.world.upsilon import world_model

Floats = NDArray[np.float64]

KNOWN = ("cube", "sphere", "cylinder")
_WITHIN = 3.5  # metres: what is farther off is not said to be behind or beside something
_MARGIN = 0.3  # metres by which the one meant must stand out

# How well each of the offsets (n, 2) from a landmark fits: forward and leftward as the robot sees the landmark,
# metres. The least is meant; infinite does not fit.
_FITS: dict[str, Callable[[Floats, Floats], Floats]] = {
    "behind": lambda f, s: np.where((f > np.abs(s)), np.hypot(f, s), np.inf),
    "in front of": lambda f, s: np.where((-f > np.abs(s)), np.hypot(f, s), np.inf),
    "left of": lambda f, s: np.where((s > np.abs(f)), np.hypot(f, s), np.inf),
    "right of": lambda f, s: np.where((-s > np.abs(f)), np.hypot(f, s), np.inf),
    "next to": np.hypot,
    "near": np.hypot,
    "close to": np.hypot,
    "beside": np.hypot,
}
_SUPERLATIVES = {"closest to": 1.0, "farthest from": -1.0}
_WORDS = {"leftmost": (1, -1.0), "rightmost": (1, 1.0), "closest": (0, 1.0), "nearest": (0, 1.0), "farthest": (0, -1.0)}


@functools.cache
def relational_lessons(count: int = 400, seed: int = 0) -> tuple[Lesson, ...]:
    """Lessons, the same for the same arguments.

    Raises:
        ValueError: count is negative.
    """
    if count < 0:
        raise ValueError(f"count={count}: give a number of at least 0")
    rng = np.random.default_rng(seed)
    lessons: list[Lesson] = []
    relations = (*_FITS, *_SUPERLATIVES, *_WORDS)
    while len(lessons) < count:
        world = generate_world(rng, "lesson", probability=0.3)
        lesson = _lesson(world, relations[len(lessons) % len(relations)], rng)
        if lesson is not None:
            lessons.append(lesson)
    return tuple(lessons)


def _lesson(world: World, relation: str, rng: np.random.Generator) -> Lesson | None:
    percepts = [Percept(o.id, o.type, o.color, (*o.position, 0.0)) for o in world.objects]
    upsilon = world_model(percepts, KNOWN, hypothetical=False, robot=world.start)
    upsilon = WorldModel(upsilon.objects, world.start, None, space.places(None, world.start, None))
    objects = upsilon.objects
    position = space.seen_from(world.start, np.array([o.position[:2] for o in world.objects]).reshape(-1, 2))
    meant = objects[int(rng.integers(len(objects)))]
    noun, color = _described(meant, rng)
    fits = np.array([(noun is None or o.type == noun) and (color is None or o.color == color) for o in objects])
    if fits.sum() < 2:
        return None
    if relation in _WORDS:
        distance = np.hypot(*position.T)
        axis, sign = _WORDS[relation]
        value = sign * (position[:, 1] if axis else distance)
        return _told(upsilon, Phrase(PhraseKind.NOUN, "", (relation,), noun, color), (), np.where(fits, value, np.inf))
    known = [j for j, o in enumerate(objects) if o.known]
    if not known:
        return None
    mark = int(rng.choice(known))
    landmark = objects[mark]
    if sum(o.type == landmark.type and o.color == landmark.color for o in objects) != 1:
        return None
    offset = position - position[mark]
    ahead = position[mark] / max(float(np.hypot(*position[mark])), 1e-9)
    forward, leftward = offset @ ahead, offset @ np.array([-ahead[1], ahead[0]])
    if relation in _SUPERLATIVES:
        value = _SUPERLATIVES[relation] * np.hypot(forward, leftward)
    else:
        value = _FITS[relation](forward, leftward)
        value = np.where(value > _WITHIN, np.inf, value)
    fits[mark] = False
    said = Phrase(PhraseKind.NOUN, "", (), landmark.type, landmark.color)
    modifier = ParseTree(Phrase(PhraseKind.PREPOSITION, relation, (relation,)), (ParseTree(said),))
    return _told(upsilon, Phrase(PhraseKind.NOUN, "", (), noun, color), (modifier,), np.where(fits, value, np.inf))


def _described(meant: Object, rng: np.random.Generator) -> tuple[str | None, str | None]:
    """The noun and colour that a lesson says of the object meant, or neither; of an unknown type no noun is said."""
    noun = meant.type if meant.known and rng.random() < 0.6 else None
    return noun, meant.color if rng.random() < 0.5 else None


def _told(world: WorldModel, noun: Phrase, modifiers: tuple[ParseTree, ...], value: Floats) -> Lesson | None:
    """The lesson that the object of least value is meant, if it stands out."""
    order = np.argsort(value, kind="stable")
    if not np.isfinite(value[order[0]]) or value[order[1]] - value[order[0]] < _MARGIN:
        return None
    tree = ParseTree(
        Phrase(PhraseKind.VERB, "go", ("go",)),
        (ParseTree(Phrase(PhraseKind.PREPOSITION, "to", ("to",)), (ParseTree(noun, modifiers),)),),
    )
    return Lesson(tree, world, frozenset({world.objects[int(order[0])].id}))
