"""Measures of sides, sizes and distances of things, from the coordinates of an episode alone.

A side word may be meant in several frames: the robot's, or that of a speaker who faces it; "the front" may be what is
near or what is ahead. So there are several measures for a word; where a target is known, it says which can be meant.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from itertools import pairwise, product
from typing import Final

from dcg_torch.evaluation.episodes import Episode, EpisodeObject
from dcg_torch.scene.bodies import bulk

Measure = Callable[[EpisodeObject], float]
"""Of a thing; the greater, the further to the side."""
Point = tuple[float, float]

NEAR: Final = frozenset({"near", "nearest", "close", "closest"})
FAR: Final = frozenset({"far", "farthest", "furthest"})
_BIG: Final = frozenset({"biggest", "largest", "tallest"})
_SMALL: Final = frozenset({"smallest", "littlest", "shortest"})
_CLEAR: Final = 0.02  # of the spread of all, by which one must be told from the next
OPPOSITE: Final = {"left": "right", "right": "left", "top": "bottom", "bottom": "top", "front": "back", "back": "front"}


def measures(word: str, episode: Episode) -> list[Measure]:
    """The measures of a word for a side, a distance or a size; none where the coordinates do not say."""
    if word in _BIG | _SMALL:
        sign = 1.0 if word in _BIG else -1.0
        return [lambda o: sign * volume(o)] if all(volume(o) for o in episode.objects) else []
    if word in NEAR | FAR:
        sign = 1.0 if word in FAR else -1.0
        return [_scaled(distance(at), sign) for at in _people(episode)]
    robot = episode.robot
    if word in ("top", "bottom", "above", "below"):
        sign = 1.0 if word in ("top", "above") else -1.0
        heights = [_scaled(_height, sign)] if _spread(_height, episode) else []
        return heights if robot is None or word in ("above", "below") else [*heights, _along(robot.yaw, sign)]
    if robot is None:
        return []
    if word in ("left", "right"):
        sign = 1.0 if word == "left" else -1.0
        own = _along(robot.yaw + math.pi / 2.0, sign)
        return [own] if episode.speaker is None else [own, _scaled(own, -1.0)]
    ahead = _along(robot.yaw, 1.0)
    return [ahead, _scaled(ahead, -1.0)]


def to_corner(words: Sequence[str], episode: Episode) -> list[tuple[Measure, Measure]]:
    """Nearness to the corner of what is there that two words name, and to the opposite one; for each frame."""
    return [
        (_near_ends(frame, episode, 1.0), _near_ends(frame, episode, -1.0))
        for frame in product(*(measures(word, episode) for word in words))
    ]


def distance(at: Point) -> Measure:
    """The distance on the floor from a point."""
    return lambda o: math.dist(o.position[:2], at)


def volume(o: EpisodeObject) -> float:
    """How large an object is, from its extents; 0.0 where they are unknown."""
    return 0.0 if o.extents is None else bulk(o.extents)


def ranked(things: Sequence[EpisodeObject], measure: Measure) -> list[str | None]:
    """The ids, the furthest to the side first; None in the place of one that can hardly be told from a neighbour."""
    order = sorted(things, key=measure, reverse=True)
    values = [measure(o) for o in order]
    clear = max(_CLEAR * (values[0] - values[-1]), 1e-6) if values else 0.0
    apart = [math.inf, *(one - other for one, other in pairwise(values)), math.inf]
    return [o.id if min(apart[k], apart[k + 1]) > clear else None for k, o in enumerate(order)]


def _people(episode: Episode) -> list[Point]:
    return [(one.x, one.y) for one in (episode.robot, episode.speaker) if one is not None]


def _along(yaw: float, sign: float) -> Measure:
    return lambda o: sign * (math.cos(yaw) * o.position[0] + math.sin(yaw) * o.position[1])


def _scaled(measure: Measure, sign: float) -> Measure:
    return lambda o: sign * measure(o)


def _height(o: EpisodeObject) -> float:
    return o.position[2] if len(o.position) == 3 else 0.0


def _spread(measure: Measure, episode: Episode) -> float:
    values = [measure(o) for o in episode.objects]
    return max(values) - min(values)


def _near_ends(frame: Sequence[Measure], episode: Episode, sign: float) -> Measure:
    """Nearness to where all measures are greatest (sign 1.0) or least (-1.0) among what is there."""
    ends = [sign * max(sign * of(o) for o in episode.objects) for of in frame]
    return lambda o: -math.hypot(*(of(o) - end for of, end in zip(frame, ends, strict=True)))
