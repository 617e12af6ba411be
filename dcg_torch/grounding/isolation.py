"""What has nothing beside or on it: "the cup with nothing around it", "the cups that touch nothing", "the bare desk".

That is measured, not learned: of the words for what is near a thing each is denied of all other things. Where some
things are stacked, "the lone block at the bottom" picks from those that are not.
"""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np

from dcg_torch.grounding.encoding import WorldEncoder
from dcg_torch.grounding.measured_relations import ASLANT, NEARNESS, ON_A_SIDE, UNSURE, aslant
from dcg_torch.grounding.stated_distances import gaps_between
from dcg_torch.names.relations import listed
from dcg_torch.names.vocabulary import ALONE, NO_OTHER, NOTHING, counted
from dcg_torch.scene.neighbours import SAME_SPOT
from dcg_torch.types.arrays import Bools, Floats

_TOUCHING, _NEAR = 0.05, 0.6
"""Metres of a gap below which things touch, and units up to which one is near another."""
_VAGUE = 0.15
"""The share of it by which that is vague."""
_LEAST = 1e-3
"""The least probability that nothing is there."""
_LEVEL = 0.02
"""Metres by which things may be in one another that are not beside one another."""


def not_alone(words: Sequence[str], encoder: WorldEncoder) -> Bools:
    """(things,) which are in a stack of their kind, where the words of a noun phrase mean one that stands alone."""
    found, where = np.zeros(len(encoder.all), dtype=np.bool_), encoder.layout
    if ALONE in words and counted(words) is None:
        stacked = np.flatnonzero(where.stacked & where.solid)
        spot, kind = where.position[stacked, :2], encoder.type_number[stacked]
        apart = np.linalg.norm(spot[:, None] - spot[None], axis=2)
        found[stacked] = ((apart < SAME_SPOT) & (kind[:, None] == kind)).sum(axis=1) > 1  # itself is one
    return found


def of_isolation(words: Sequence[str], encoder: WorldEncoder) -> Floats:
    """(things,) the log-probability that things have nothing beside or on them, where a noun phrase's words say so."""
    log = np.zeros(len(encoder.all))
    if not _BARE.isdisjoint(words):
        carries = _carries(encoder)
        log[: len(carries)] += np.where(carries, math.log(_LEAST), 0.0)
    where = encoder.layout
    things = np.flatnonzero(where.solid & np.isfinite(where.position).all(axis=1)).tolist()
    kind = encoder.type_number[things]
    for word in (word for word in words if word.startswith((NOTHING, NO_OTHER))):
        name = word.removeprefix(NOTHING).removeprefix(NO_OTHER)
        if len(things) > 1 and name in _BESIDE | ON_A_SIDE.keys():
            there = _there(name, things, encoder)[:, things]
            np.fill_diagonal(there, 0.0)
            there[(kind[:, None] != kind) & word.startswith(NO_OTHER)] = 0.0
            log[things] += np.log(np.maximum(_LEAST, 1.0 - there.max(axis=1)))
    return log


_BESIDE = NEARNESS | listed("around") | {"touching"}
_BARE = listed("carrying nothing")


def _carries(encoder: WorldEncoder) -> Bools:
    """(things with extents,) on which does another lie? On none where extents are not known."""
    bodies, at = encoder.layout.bodies, encoder.layout.position
    if bodies is None:
        return np.zeros(0, dtype=np.bool_)
    numbers = np.arange(len(bodies.half))
    covers, _ = bodies.over(numbers, at[None, numbers, :2] - at[numbers][:, None, :2])
    np.fill_diagonal(covers, False)
    found: Bools = (covers & (bodies.steps(numbers, covers) == 1)).any(axis=1)
    return found


def _there(name: str, things: list[int], encoder: WorldEncoder) -> Floats:
    """(landmarks, things) the probability that people say that a thing stands so to a landmark."""
    unit = encoder.world.unit
    gap = gaps_between(things, encoder)
    reach = _TOUCHING / unit if name == "touching" else _NEAR
    with np.errstate(over="ignore", invalid="ignore"):
        near = 1.0 / (1.0 + np.exp((gap - reach) / (_VAGUE * reach)))
        if name in ON_A_SIDE:
            near *= 1.0 / (1.0 + np.exp((aslant(name, things, encoder) - ASLANT) / UNSURE))
    return np.where(np.isfinite(near) & _on_its_level(things, encoder), near, 0.0)


def _on_its_level(things: list[int], encoder: WorldEncoder) -> Bools:
    """(landmarks, things) is a thing neither wholly over a landmark nor wholly under it, as what it stands on is?"""
    bodies, count = encoder.layout.bodies, len(encoder.all)
    if bodies is None:
        return np.ones((len(things), count), dtype=np.bool_)
    low, high = np.full(count, -math.inf), np.full(count, math.inf)
    n = len(bodies.half)
    low[:n] = np.where(np.isfinite(bodies.bottom), bodies.bottom, -math.inf)
    high[:n] = np.where(np.isfinite(bodies.top), bodies.top, math.inf)
    slack = _LEVEL / encoder.world.unit
    found: Bools = (low[None] < high[things][:, None] - slack) & (high[None] > low[things][:, None] + slack)
    return found
