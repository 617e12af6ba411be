"""Where things are for a robot that stands among them: "the chair on your left", "the one in front of you".

A side of who stands outside is a part of the scene, and the thing farthest to it is meant. Who stands among the things
has them all around: those within a cone to that side are meant, the nearer the likelier. That is measured, not learned.
"""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np

from dcg_torch.grounding.encoding import WorldEncoder
from dcg_torch.grounding.measured_relations import ASLANT, UNSURE
from dcg_torch.grounding.nearness import nearest_of_a_kind
from dcg_torch.names.relations import listed
from dcg_torch.names.vocabulary import BESIDE_THE_WAY, WITHIN
from dcg_torch.scene.layout import OF_ROBOT
from dcg_torch.scene.order import TIE
from dcg_torch.types import Phrase
from dcg_torch.types.arrays import Bools, Floats

_AT = listed("on a side") | {WITHIN}
_FROM_YOU = {"ahead of": (1.0, 0.0), "in front of": (1.0, 0.0), "behind": (-1.0, 0.0)}
"""Preposition before who is spoken to -> the direction in which what is so stands."""
_STRAIGHT, _NOT_AHEAD = math.radians(25.0), -5.0
"""Angle at which a thing is half a nat less straight on, and the most that it loses."""
_AHEAD, _BEFORE = "ahead of", "in front of"
"""The preposition of what is straight on, wherever the robot stands, and of what is on this side of a thing."""
_SLANT = math.radians(40.0)
"""Angle at which a thing is half a nat less that way than one straight on."""
_E_FOLD = 2.0
"""Nats that a thing loses for each e-fold by which it is farther than the nearest of its kind that way."""
_LEAST = 0.5
"""Units below which distances are alike."""


def by_bearing(
    phrase: Phrase, log_psi: Floats, landmarks: Sequence[int], compared: Bools | None, encoder: WorldEncoder
) -> Floats:
    """(landmarks, things) log Psi of a modifier, measured where its landmark is the robot or a side of it.

    Args:
        log_psi: what is learned, which stays for all other landmarks, and for a robot that stands outside, but for
            what is straight ahead of it.
        landmarks: the number of each.
        compared: (things,) those of which the nearest is meant; None: those of one type.
    """
    name, where = phrase.words[0], encoder.layout
    if (name not in _AT and name not in _FROM_YOU and name != BESIDE_THE_WAY) or encoder.world.robot is None:
        return log_psi
    ways = [(k, way) for k, j in enumerate(landmarks) if (way := _way(name, j, encoder)) is not None]
    if not ways or not (encoder.among_things or name in (_AHEAD, _BEFORE, BESIDE_THE_WAY)):
        return log_psi
    rows, to = [k for k, _ in ways], np.array([way for _, way in ways])
    offset, found = where.position[:, :2] - where.robot, log_psi.copy()
    if name == BESIDE_THE_WAY:
        found[rows] = [_off_the_way(aside, where.solid) for aside in to @ offset.T]
    elif not encoder.among_things:
        found[rows] = _straight_on(offset, to) if name == _AHEAD else found[rows] + _right_before(offset, where.solid)
    else:
        whole = phrase.plural or name == WITHIN  # "the closest chair on your left" is one of all that are there
        found[rows] = that_way(offset, to, compared, encoder, whole=whole)
    return found


def _off(offset: Floats, ways: Floats) -> tuple[Floats, Floats]:
    """(ways, things) how far each is to the left of a direction, and how far along it."""
    (x, y), (along, across) = offset.T, ways.T[:, :, None]
    return y * along - x * across, x * along + y * across


def _straight_on(offset: Floats, ways: Floats) -> Floats:
    """(ways, things) how straight on each stands, near or far; `offset` is (things, 2) from the robot."""
    slant = np.arctan2(*_off(offset, ways))
    found: Floats = np.maximum(-0.5 * (np.where(np.isfinite(slant), slant, math.pi) / _STRAIGHT) ** 2, _NOT_AHEAD)
    return found


def _right_before(offset: Floats, solid: Bools) -> Floats:
    """(things,) what each loses for being farther than the nearest: who stands outside has all things in front."""
    away = np.hypot(*offset.T)
    known = solid & np.isfinite(away)
    nearest = max(_LEAST / 2.0, float(away[known].min())) if known.any() else 1.0
    return np.where(known, -_E_FOLD * np.log(np.maximum(1.0, away / nearest)), 0.0)


def _off_the_way(aside: Floats, solid: Bools) -> Floats:
    """(things,) how surely each is beside a way and not on it; `aside` is how far to one side each of them is."""
    off = np.where(np.isfinite(aside), aside, -np.inf)
    known = np.abs(off[solid & np.isfinite(off)])
    bound = _ON_THE_WAY * float(np.median(known)) if len(known) else 0.0
    found: Floats = np.maximum(-np.logaddexp(0.0, (bound - off) / max(TIE, _VAGUELY * bound)), _NOT_BESIDE)
    return found


_ON_THE_WAY, _VAGUELY, _NOT_BESIDE = 0.3, 0.1, -8.0
"""Share of how far things are off a way up to which one is on it, how vague that is, and the most that one loses."""


def _way(name: str, landmark: int, encoder: WorldEncoder) -> Floats | None:
    """(2,) the direction that a preposition names of a landmark; None where it is no side of the robot."""
    where, thing = encoder.layout, encoder.all[landmark]
    if name in _FROM_YOU:
        return np.array(_FROM_YOU[name]) if where.place[landmark] and thing.type == "robot" else None
    return where.heading[landmark] if where.direction[landmark] and OF_ROBOT in thing.attributes else None


def that_way(
    offset: Floats, ways: Floats, compared: Bools | None, encoder: WorldEncoder, *, whole: bool, aslant: float = _SLANT
) -> Floats:
    """(ways, things) how well each stands in a direction: off it by an angle, and behind how many of its kind.

    Args:
        offset: (things, 2) from the robot, or another landmark.
        compared: (things,) those of which the nearest is meant; None: those of one type.
        whole: are all meant that stand so, near or far?
        aslant: radians off it at which a thing loses half a nat.
    """
    left, ahead = _off(offset, ways)
    slant = np.arctan2(np.abs(left), ahead)
    there = np.isfinite(slant)
    slant = np.where(there, slant, math.pi)
    inside: Floats = -np.logaddexp(0.0, (slant - ASLANT) / UNSURE)
    if whole:
        return inside
    inside = inside - 0.5 * (slant / aslant) ** 2
    away = _E_FOLD * np.log(np.maximum(np.where(there, np.hypot(*offset.T), np.inf), max(_LEAST, TIE)))
    of_each, least = nearest_of_a_kind(np.where(there, away - inside, np.inf), compared, encoder)
    behind = np.where(there, away - np.where(np.isfinite(least), least, 0.0)[of_each], np.inf)
    found: Floats = inside - np.maximum(behind, 0.0)
    return found
