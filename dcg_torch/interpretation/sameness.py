"""What is like its landmark: "the ball of the same colour as the cube", "the same size as", "at the same wall as"."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np

from dcg_torch.interpretation.same_walls import AT_WALL_OF, log_at_wall_of
from dcg_torch.names.color_names import color_evidence
from dcg_torch.names.keys import attribute_key
from dcg_torch.names.normal_form import normalise
from dcg_torch.names.palette import lab
from dcg_torch.scene.bodies import bulk
from dcg_torch.types import Object
from dcg_torch.types.arrays import Floats

SAME_AS = {"same color as": "color", "same size as": "size", "same shape as": "shape", "same material as": "material"}
"""Prepositions, and in what two things are then alike."""
LIKE = SAME_AS.keys() | AT_WALL_OF.keys()
_SURE = 0.98
"""Probability that two things are alike, where what is known of them says so."""
_OPEN = 0.5
_ALIKE = frozenset({"color: equal", "color: alike"})
_LOOKS_ALIKE = 15.0
"""Distance in CIELAB up to which two colours are the same."""
_SAME_BULK = math.log(1.25)
"""Logarithms of volumes that differ by less are the same size."""


def log_same(name: str, things: Sequence[Object], landmarks: Sequence[tuple[int, ...]], *, denied: bool) -> Floats:
    """(landmarks, things) the logarithm of the probability that a thing is like a landmark; nothing is like itself.

    Args:
        name: one of `LIKE`.
        landmarks: numbers of things; the first of each is the landmark.
        denied: that it is not.
    """
    if name in AT_WALL_OF:
        log = log_at_wall_of(name, things, landmarks)
        return np.log1p(-np.exp(log)) if denied else log
    found = np.array([[_same(SAME_AS[name], things[of[0]], thing) for thing in things] for of in landmarks])
    logs: Floats = np.log(1.0 - found if denied else found)
    return logs


def _same(what: str, one: Object, other: Object) -> float:
    if one.id == other.id:
        return 1.0 - _SURE
    alike = {"color": _same_color, "size": _same_size}.get(what)
    known = alike(one, other) if alike is not None else _same_value(what, one, other)
    return _OPEN if known is None else _SURE if known else 1.0 - _SURE


def _same_color(one: Object, other: Object) -> bool | None:
    if one.color is not None and other.color is not None:
        return not _ALIKE.isdisjoint(color_evidence(one.color, other.color))
    if one.rgb is None or other.rgb is None:
        return None
    return float(np.linalg.norm(np.subtract(*lab(np.array([one.rgb, other.rgb], dtype=np.float64))))) < _LOOKS_ALIKE


def _same_size(one: Object, other: Object) -> bool | None:
    sizes = [bulk(o.size) if o.size is not None else 0.0 for o in (one, other)]
    if not all(size > 0.0 for size in sizes):
        return _same_value("size", one, other)
    return abs(math.log(sizes[0] / sizes[1])) < _SAME_BULK


def _same_value(key: str, one: Object, other: Object) -> bool | None:
    """By an attribute; without one, things of one class have one shape."""
    values = [_value(key, o) for o in (one, other)]
    if None not in values:
        return values[0] == values[1]
    if key != "shape" or one.type is None or other.type is None:
        return None
    return normalise(one.type) == normalise(other.type)


def _value(key: str, thing: Object) -> str | None:
    pairs = (attribute.partition(":") for attribute in thing.attributes)
    return next((normalise(value) for of, _, value in pairs if attribute_key(of) == key), None)
