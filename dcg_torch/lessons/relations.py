"""Generated lessons on relations, for a robot that starts without a corpus of its own.

The commands and what they mean are those of `speaker.referring`: definitions by this project, in random worlds. No
human wrote them, and they teach no more than the definitions say. The words get their weights from these lessons by the
same fit as all others.
"""

from __future__ import annotations

import functools

import numpy as np

from dcg_torch.learning.landmarks import Lesson
from dcg_torch.scene.upsilon import world_model
from dcg_torch.scene.workspace import with_places
from dcg_torch.types import OPAQUE, Percept
from dcg_torch.world.generator import TYPES, generate_world
from dcg_torch.world.speaker.fit import Surroundings
from dcg_torch.world.speaker.phrases import command
from dcg_torch.world.speaker.referring import DIRECTED, RELATIONS, generate

KNOWN = ("cube", "sphere", "cylinder")
"""The types that the lessons call by name; they are known from the start."""
_WORLDS = ((TYPES, 0.15), (TYPES, 0.3), ((*KNOWN, "drill", "mailbox"), 0.5), (KNOWN, 0.7))
"""Types, and the probability of each in each colour: from the paper's sparse worlds to rows of cubes."""
_TURNS = (*RELATIONS, *DIRECTED, *DIRECTED)
"""Of directions there are more lessons: as seen by whom, they say only where the frames differ."""
_DRAWS = 40  # worlds tried for one relation, before it is left out once
_TRIES = 6  # descriptions tried in each of them
_UNHEARD = 0.4
"""Share of the lessons whose landmark may have a name never heard: such a noun means a thing, hardly a place."""


@functools.cache
def relational_lessons(count: int = 600, seed: int = 0) -> tuple[Lesson, ...]:
    """Lessons, all relations in turn; the same for the same arguments.

    Raises:
        ValueError: count is negative.
    """
    if count < 0:
        raise ValueError(f"count={count}: give a number of at least 0")
    rng = np.random.default_rng(seed)
    lessons: list[Lesson] = []
    turn = 0
    while len(lessons) < count:
        lesson = _lesson(_TURNS[turn % len(_TURNS)], rng)
        turn += 1
        if lesson is not None:
            lessons.append(lesson)
    return tuple(lessons)


def _lesson(relation: str, rng: np.random.Generator) -> Lesson | None:
    """A lesson on a relation, seen from the robot's start; the speaker stands with the robot."""
    for _ in range(_DRAWS):
        types, probability = _WORLDS[int(rng.integers(len(_WORLDS)))]
        world = generate_world(rng, "lesson", types=types, probability=probability)
        extents = rng.uniform(0.15, 0.6, size=len(world.objects))
        around = Surroundings.of(world, extents)
        landmarks = types if rng.random() < _UNHEARD else KNOWN
        drawn = (generate(around, relation, rng, KNOWN, landmarks) for _ in range(_TRIES))
        described = next((description for description in drawn if description is not None), None)
        if described is None:
            continue
        percepts = [
            Percept(o.id, _class_name(o.type), o.color, (*o.position, 0.0), (float(e), float(e), float(e)))
            for o, e in zip(world.objects, extents, strict=True)
        ]
        upsilon = world_model(percepts, KNOWN, hypothetical=False, robot=world.start)
        return Lesson(
            command(described.tree), with_places(upsilon), frozenset(world.objects[j].id for j in described.meant)
        )
    return None


def _class_name(kind: str) -> str:
    """Of a type that has no name yet, one that says nothing: which of them a new word means must be inferred."""
    return kind if kind in KNOWN else f"{OPAQUE}{kind}"
