"""What is so far from a landmark as is said: "within a metre of the door", or nearer to it than to another.

That is measured, not learned.
"""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np

from dcg_torch.grounding.encoding import WorldEncoder
from dcg_torch.interpretation.distances import Apart, said_apart, said_turn
from dcg_torch.interpretation.ways import said_way
from dcg_torch.names.vocabulary import LED, NEARER_OF_TWO, NEARER_THAN, SO_FAR
from dcg_torch.types import Phrase
from dcg_torch.types.arrays import Floats

_SLIP = 0.001
"""The least probability that a thing is meant that is farther or closer than is said."""
_VAGUE, _STEP = 0.06, 0.03
"""By how much of a bound it is vague, and by how many metres at least."""
_OFF = 0.15
"""The same of a distance that is said itself."""


_HALF_AN_HOUR = np.pi / 12.0
"""Angle by which what is said to be at an hour of the clock may be off."""
_CONCENTRATION = 2.0
"""Of the directions in which lies what a way leads to, about that in which the way ends (of von Mises)."""
MEASURED = frozenset({SO_FAR, NEARER_OF_TWO, NEARER_THAN, LED})
"""Relations of which distances say all."""


def log_distance(
    phrase: Phrase, landmarks: Sequence[tuple[int, ...]], encoder: WorldEncoder, *, denied: bool
) -> Floats:
    """(combos, things) the log-probability that a modifier by one of `MEASURED` is said of a thing.

    Raises:
        ValueError: the phrase says no distance.
    """
    if phrase.words[0] == LED:
        return np.tile(log_led(said_way(phrase), encoder), (len(landmarks), 1))
    if phrase.words[0] != SO_FAR:
        return log_nearer(phrase.words[0], landmarks, encoder, denied=denied)
    said, turn = said_apart(phrase), said_turn(phrase)
    if turn is not None:
        return np.tile(log_turned(turn, encoder, denied=denied), (len(landmarks), 1))
    if said is None:
        raise ValueError(f"no distance is said by {phrase.text!r}")
    return log_apart(said, landmarks, encoder, denied=denied)


def log_apart(said: Apart, landmarks: Sequence[tuple[int, ...]], encoder: WorldEncoder, *, denied: bool) -> Floats:
    """(combos, things) the logarithm of the probability that people say so of a thing; 0 where nobody knows.

    Args:
        landmarks: numbers of things; the first of each is the landmark.
    """
    far = gaps_between([of[0] for of in landmarks], encoder) * encoder.world.unit
    inside = _below(said.most - far, said.most) * _below(far - said.least, said.least)
    if said.about is not None:
        inside = 1.0 / (
            1.0 + ((far - said.about) / (_OFF * said.about + _STEP)) ** 2
        )  # of all that are off, the closest
    likely = _SLIP + (1.0 - 2.0 * _SLIP) * (1.0 - inside if denied else inside)
    found: Floats = np.log(np.where(np.isfinite(far), likely, 1.0))
    found[np.arange(len(landmarks)), [of[0] for of in landmarks]] = np.log(_SLIP)
    return found


def log_turned(turn: float, encoder: WorldEncoder, *, denied: bool) -> Floats:
    """(things,) the logarithm of the probability that a thing is that way from the robot.

    Args:
        turn: radians to the left of straight ahead.
    """
    where = encoder.layout
    x, y = (where.position[:, :2] - where.robot).T
    off = np.abs((np.arctan2(y, x) - turn + np.pi) % (2.0 * np.pi) - np.pi)
    inside = 1.0 / (1.0 + (off / _HALF_AN_HOUR) ** 4)
    likely = _SLIP + (1.0 - 2.0 * _SLIP) * (1.0 - inside if denied else inside)
    found: Floats = np.log(np.where(np.isfinite(off) & where.solid, likely, _SLIP))
    return found


def log_led(way: float, encoder: WorldEncoder) -> Floats:
    """(things,) how much likelier a thing lies at the end of a way than what lies just there, as a logarithm.

    What is nowhere may be in any direction.

    Args:
        way: radians to the left of where the robot heads.
    """
    robot, found = encoder.world.robot, np.full(len(encoder.all), np.log(np.i0(_CONCENTRATION)))
    for j, o in enumerate(encoder.all):
        if robot is not None and o.position is not None:
            turned = math.atan2(o.position[1] - robot.y, o.position[0] - robot.x) - robot.yaw
            found[j] = _CONCENTRATION * math.cos(turned - way)
    return found - _CONCENTRATION


def log_nearer(name: str, landmarks: Sequence[tuple[int, ...]], encoder: WorldEncoder, *, denied: bool) -> Floats:
    """(combos, things) the logarithm of the probability that a thing is nearer to the first of two landmarks.

    Args:
        name: `NEARER_OF_TWO`, than to the second, or `NEARER_THAN`, than the second is.
        landmarks: pairs of numbers of things; nothing is nearer to itself.
    """
    first, second = np.array(landmarks).T
    row = np.arange(len(landmarks))
    near = gaps_between(first.tolist(), encoder)
    far = gaps_between(second.tolist(), encoder) if name == NEARER_OF_TWO else near[row, second][:, None]
    with np.errstate(over="ignore", invalid="ignore"):
        sure = 1.0 / (1.0 + np.exp((near - far) / (_VAGUE * (near + far) / 2.0 + _STEP)))
    likely = _SLIP + (1.0 - 2.0 * _SLIP) * (1.0 - sure if denied else sure)
    found: Floats = np.log(np.where(np.isfinite(sure), likely, 0.5))
    found[row, first] = found[row, second] = np.log(_SLIP)
    found[first == second] = np.log(_SLIP)
    return found


def gaps_between(landmarks: Sequence[int], encoder: WorldEncoder) -> Floats:
    """(combos, things) units between extents on the floor; of what nobody knows the extents of, from its middle."""
    where = encoder.layout
    at, half = where.position[:, :2], np.zeros((len(where.position), 2))
    if where.bodies is not None:
        half[: len(where.bodies.half)] = np.nan_to_num(where.bodies.half)
    apart = np.abs(at[landmarks][:, None] - at[None]) - half[landmarks][:, None] - half[None]
    found: Floats = np.linalg.norm(np.maximum(apart, 0.0), axis=2)
    return np.where(where.solid[None], found, np.nan)


def _below(room: Floats, bound: float) -> Floats:
    """How surely there is room up to a bound; there is to one that is nowhere, and down to none."""
    if not 0.0 < bound < np.inf:
        return np.ones_like(room)
    with np.errstate(over="ignore", invalid="ignore"):
        found: Floats = 1.0 / (1.0 + np.exp(-room / (_VAGUE * bound + _STEP)))
    return found
