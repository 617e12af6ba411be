"""Scenes and commands made by a program, to certify with: sides, distances, sizes and ordinals of everyday things.

We wrote these commands; no person gave them to a robot. They are not the lessons that the shipped model is taught:
things, sizes, distances, openings and ways to say a place are others, and none is told but by its class, perhaps its
colour, and one place. Right is what the coordinates say, as the robot sees them; where two could be meant, no command
is made.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Sequence
from typing import Final

import numpy as np

from dcg_torch.evaluation.episodes import Episode, EpisodeObject, Place
from dcg_torch.evaluation.measures import Measure, measures, ranked

THINGS: Final = {
    **{"mug": 0.1, "vase": 0.3, "suitcase": 0.6, "bucket": 0.35, "helmet": 0.3, "backpack": 0.5, "kettle": 0.25},
    **{"lamp": 0.5, "stool": 0.5, "armchair": 0.9, "barrel": 0.9, "crate": 0.7, "bicycle": 1.3, "bottle": 0.2},
}
"""Class -> edge in metres, of the usual one."""
COLORS: Final = ("red", "green", "blue", "yellow", "white", "black", "brown")
OPENINGS: Final = ("{}", "hand me {}", "could you fetch {}, please", "I need {}", "we want {} now", "show me {}")
_ORDINALS: Final = ("first", "second", "third", "fourth")
_SIDES: Final[Sequence[tuple[str, str]]] = (
    *(
        ("left", text)
        for text in ("the left {}", "the {} on the left", "the leftmost {}", "the {} on the left-hand side")
    ),
    *(
        ("right", text)
        for text in ("the right {}", "the {} on the right", "the rightmost {}", "the {} on the far right")
    ),
    *(("left", "the {} furthest to the left"), ("right", "the {} closest to the right")),
    *(
        ("near", text)
        for text in ("the nearest {}", "the closest {}", "the {} closest to you", "the {} nearest to the robot")
    ),
    *(("far", text) for text in ("the farthest {}", "the {} farthest from you", "the furthest {}")),
)
_COUNTED: Final[Sequence[tuple[str, str]]] = (
    *(
        ("left", text)
        for text in ("the {k} {} from the left", "the {} {k} from the left", "the {k} {} counting from the left")
    ),
    *(
        ("right", text)
        for text in ("the {k} {} from the right", "the {k} {} on the right", "the {} {k} from the right")
    ),
    *(("near", text) for text in ("the {k} nearest {}", "the {k} closest {}", "the {k} closest {} to you")),
    *(("biggest", text) for text in ("the {k} biggest {}", "the {k} largest {}")),
    *(("smallest", "the {k} smallest {}"), ("farthest", "the {k} farthest {}")),
)
_LANDMARKS: Final = (
    ("left", "to the left of"),
    ("right", "to the right of"),
    ("far", "behind"),
    ("near", "in front of"),
)
_APART: Final = 0.45  # metres at least between two things
_BESIDE: Final = 0.7  # of the way to a landmark that a thing is off its side at most
_DRAWS: Final = 1_000
_OURS: Final = 0x5CE9E5  # keeps these scenes from being those of another generator with the same seed
_ROBOT: Final = Place(x=0.0, y=0.0, yaw=0.0)
_BEARINGS: Final[dict[str, Measure]] = {
    "left": lambda o: math.atan2(o.position[1], o.position[0]),
    "right": lambda o: -math.atan2(o.position[1], o.position[0]),
}
"""How far to a side the robot must turn for a thing: who says "on the left" may mean this as well."""
Maker = Callable[[Episode, str, Sequence[EpisodeObject]], Iterator[tuple[str, str]]]
"""Of a scene, a name for some of its things and these things: commands, each with the id of the one that it means."""


def made_episodes(count: int, seed: int = 0) -> list[Episode]:
    """Episodes, the same for the same arguments: sides, sides of a landmark and ordinals in turn."""
    rng = np.random.default_rng(np.random.SeedSequence((seed, _OURS)))
    makers = (("side", _by_side), ("landmark", _by_landmark), ("ordinal", _by_ordinal))
    return [_episode(f"{makers[k % 3][0]}-{k}", makers[k % 3][1], rng) for k in range(count)]


def _episode(name: str, maker: Maker, rng: np.random.Generator) -> Episode:
    for _ in range(_DRAWS):
        things = _things(rng)
        scene = Episode(id=name, text="", robot=_ROBOT, objects=things, target=())
        alike = [o for o in things if o.type == things[0].type]
        color = things[0].color if rng.random() < 0.5 else None
        described = [o for o in alike if color in (None, o.color)]
        head = f"{color} {things[0].type}" if color else things[0].type
        said = list(maker(scene, head, described))
        if said and len(described) > 1:
            text, meant = said[int(rng.integers(len(said)))]
            opening = OPENINGS[int(rng.integers(len(OPENINGS)))]
            return scene.model_copy(update={"text": opening.format(text), "target": (meant,)})
    raise ValueError(f"none of {_DRAWS} scenes has a thing that a command can mean; seed another")


def _things(rng: np.random.Generator) -> tuple[EpisodeObject, ...]:
    """Three to six things of one class, and one of each of some others, before the robot."""
    names = [str(name) for name in rng.permutation(list(THINGS))]
    classes = [names[0]] * int(rng.integers(3, 7)) + names[1 : int(rng.integers(3, 6))]
    colors = [str(color) for color in rng.permutation(COLORS)[:3]]
    points: list[tuple[float, float]] = []
    while len(points) < len(classes):
        point = float(rng.uniform(1.0, 7.0)), float(rng.uniform(-4.0, 4.0))
        if all(math.dist(point, other) > _APART for other in points):
            points.append(point)
    things = []
    for k, (name, (x, y)) in enumerate(zip(classes, points, strict=True)):
        edge = round(THINGS[name] * float(rng.uniform(0.6, 1.6)), 3)
        color = colors[int(rng.integers(len(colors)))]
        at = (round(x, 2), round(y, 2), 0.0)
        things.append(EpisodeObject(id=f"m{k}", type=name, color=color, position=at, size=(edge, edge, edge)))
    return tuple(things)


def _by_side(scene: Episode, head: str, described: Sequence[EpisodeObject]) -> Iterator[tuple[str, str]]:
    for word, text in _SIDES:
        first = ranked(described, measures(word, scene)[0])[0]
        if first is not None and (word not in _BEARINGS or ranked(described, _BEARINGS[word])[0] == first):
            yield text.format(head), first


def _by_ordinal(scene: Episode, head: str, described: Sequence[EpisodeObject]) -> Iterator[tuple[str, str]]:
    for word, text in _COUNTED:
        order = ranked(described, measures(word, scene)[0])
        for ordinal, one in zip(_ORDINALS, order, strict=False):
            counts = len(described) > 2 and (ordinal != "first" or "from" in text)  # nobody says "the first biggest"
            if counts and one is not None:
                yield text.format(head, k=ordinal), one


def _by_landmark(scene: Episode, head: str, described: Sequence[EpisodeObject]) -> Iterator[tuple[str, str]]:
    """The one that lies clearly on a side of a thing, where no other lies on that side at all."""
    for mark in scene.objects:
        if mark.type == scene.objects[0].type:
            continue
        for word, text in _LANDMARKS:
            along, across = (0, 1) if word in ("near", "far") else (1, 0)
            sign = 1.0 if word in ("left", "far") else -1.0
            off = {o.id: (sign * (o.position[along] - mark.position[along]), o) for o in described}
            there = [(by, o) for by, o in off.values() if by > 0.0]
            if len(there) == 1 and abs(there[0][1].position[across] - mark.position[across]) < _BESIDE * there[0][0]:
                yield f"the {head} {text} the {mark.type}", there[0][1].id
