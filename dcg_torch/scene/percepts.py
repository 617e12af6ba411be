"""Percepts and poses as they come from robots of others: checked and brought into one form, before Upsilon is made."""

from __future__ import annotations

import contextlib
import math
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import replace
from typing import Any

from dcg_torch.names.keys import attributes_of
from dcg_torch.types import Percept, Pose


def checked(percepts: Iterable[Percept]) -> Iterator[Percept]:
    """The percepts; lists and arrays of numbers become tuples of plain ones, attributes a frozen set.

    Raises:
        ValueError: one of them makes no sense; the message names it in one line.
    """
    ids: set[str] = set()
    for percept in percepts:
        if not isinstance(percept, Percept):
            raise ValueError(f"{percept!r:.80} is no percept; make one: Percept(id, type, color, position)")
        id_ = percept.id
        if not isinstance(id_, str) or not id_:
            raise ValueError(f"percept {id_!r:.80}: an id is a text, and not an empty one")
        if id_ in ids:
            raise ValueError(f"percept {id_!r:.80}: two objects have this id; give each its own")
        ids.add(id_)
        yield _checked(percept)


def checked_pose(pose: Pose | None, who: str) -> Pose | None:
    """The pose, if there is one.

    Args:
        who: stands there.

    Raises:
        ValueError: it is no pose, or one of its numbers is not finite; the message says whose it is.
    """
    good = pose is None
    if isinstance(pose, Pose):
        with contextlib.suppress(TypeError):
            good = math.isfinite(pose.x) and math.isfinite(pose.y) and math.isfinite(pose.yaw)
    if not good:
        raise ValueError(f"{who} is {pose!r:.80}, not a Pose of three finite numbers")
    return pose


def _checked(percept: Percept) -> Percept:
    for name, given in (("type", percept.type), ("color", percept.color)):
        if not isinstance(given, str) and not (name == "color" and given is None):
            raise ValueError(f"percept {percept.id!r:.80}: {name} is {given!r:.60}, not a text")
    if not percept.type.strip():
        raise ValueError(f"percept {percept.id!r:.80}: type is empty; say what it was recognised as")
    position = _three(percept, "position", percept.position, "", -_FARTHEST, _FARTHEST)
    size = None if percept.size is None else _three(percept, "size", percept.size, " of at least 0", 0.0, _FARTHEST)
    rgb = None if percept.rgb is None else _three(percept, "rgb", percept.rgb, " from 0 to 255", 0.0, 255.0)
    attributes = _attributes(percept)
    if position is percept.position and size is percept.size and rgb is percept.rgb:
        return percept if attributes is percept.attributes else replace(percept, attributes=attributes)
    return replace(percept, position=position, size=size, rgb=rgb, attributes=attributes)


def _attributes(percept: Percept) -> frozenset[str]:
    """As a frozen set of texts; a dict is what it says of its keys.

    Raises:
        ValueError: they are something else.
    """
    given: Any = percept.attributes
    if isinstance(given, frozenset) and all(isinstance(one, str) for one in given):
        return given
    listed: list[Any] = [None]
    with contextlib.suppress(TypeError):
        listed = [None] if isinstance(given, str) else list(given or ())
    if not all(isinstance(one, str) for one in listed):
        raise ValueError(f"percept {percept.id!r:.80}: attributes is {given!r:.60}, not a set of texts, nor a dict")
    return attributes_of(given) if isinstance(given, Mapping) else frozenset(listed)


_FARTHEST = 1e12
"""Metres: what is farther is a mistake, and the squares of distances are to be numbers."""
_PLAIN = frozenset({int, float})


def _three(
    percept: Percept, name: str, given: Any, bounds: str, least: float, most: float
) -> tuple[float, float, float]:
    """Three finite numbers within bounds, which `bounds` names.

    Raises:
        ValueError: it is something else.
    """
    listed: tuple[Any, ...] = ()
    try:
        listed = tuple(given)
        good = len(listed) == 3 and all(least <= v <= most for v in listed)
    except (TypeError, ValueError, OverflowError):
        good = False
    if not good:
        raise ValueError(f"percept {percept.id!r:.80}: {name} is {given!r:.60}, not three finite numbers{bounds}")
    if isinstance(given, tuple) and _PLAIN.issuperset(map(type, given)):
        return given
    return float(listed[0]), float(listed[1]), float(listed[2])
