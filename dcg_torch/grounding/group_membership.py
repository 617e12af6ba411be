"""Groups that a phrase names: of so many, the whole row, the tidiest one; and what it says of a thing to be in one.

That is measured, not learned. A group loses nats where another is meant rather.
"""

from __future__ import annotations

from collections.abc import Collection, Sequence

import numpy as np

from dcg_torch.grounding.encoding import WorldEncoder
from dcg_torch.grounding.measured_relations import NEARNESS, ON_A_SIDE
from dcg_torch.interpretation.plain_words import in_group
from dcg_torch.names.vocabulary import GROUP_WORDS, LATERAL, OWNERS, counted
from dcg_torch.scene.groups import CLUSTER, ROW
from dcg_torch.scene.neighbours import SAME_SPOT, nearest_other
from dcg_torch.types import Phrase
from dcg_torch.types.arrays import Floats

_OTHER = 5.0
"""Nats that a group of another number loses."""
_A_PART = 3.0
"""Nats that a row loses which is a part of a longer one, where no number is said."""
_WIDE, _BENT = 4.0, 8.0
"""Nats that a row loses for each e-fold by which its steps are wider, and for each step by which one stands aside."""
_LOOSE = 3.0
"""Nats that a cluster loses for each e-fold by which its things stand farther from one another."""
_NOT_THERE = -3.0
"""Nats that a group loses that is not the one farthest to the side that is said."""
_FAR = -8.0
"""The most that a group loses for these."""
_INSIDE = -0.05
"""The most that a thing loses that is in the group in which it is said to be."""
_OUTSIDE = -6.0
"""Nats that a thing loses that is none of a row of so many in which it is said to be."""
_ASIDE = -2.5
"""The same of a row of which nobody says how many are in it."""
_ROWS = frozenset(word for word, kinds in GROUP_WORDS.items() if "row" in kinds)
_CLUSTERS = frozenset(word for word, kinds in GROUP_WORDS.items() if kinds == (CLUSTER,))


def log_of_group(phrase: Phrase, encoder: WorldEncoder) -> Floats:
    """(things,) what groups lose to the one that a phrase names; 0 of all else."""
    told = (_of_kind, _of_so_many, _of_a_whole, _tidy, _close, _to_a_side)
    lost: Floats = np.sum([log_of(phrase, encoder) for log_of in told], axis=0)
    return lost


def of_members(log_psi: Floats, groups: Sequence[int], encoder: WorldEncoder, *, row: bool) -> Floats:
    """(groups, things) what "in the group" says: all that are in it are in it alike, however far from its middle.

    Args:
        row: is it said how many are in a row? Then what is outside of one is not meant.
    """
    found = log_psi.copy()
    for k, j in enumerate(groups):
        inside = encoder.layout.members.get(j)
        if inside is None:
            continue
        if ROW in encoder.all[j].attributes:
            outside = encoder.layout.solid.copy()
            outside[inside] = False
            found[k, outside] = np.minimum(found[k, outside], _OUTSIDE if row else _ASIDE)
        found[k, inside] = np.maximum(found[k, inside], _INSIDE)
    return found


def beside_members(name: str, log_psi: Floats, landmarks: Sequence[tuple[int, ...]], encoder: WorldEncoder) -> Floats:
    """(combos, things) what stands between two groups, or beside one, is in none of them.

    Args:
        name: of the relation.
    """
    members = encoder.layout.members
    if name not in _BESIDE or not any(j in members for of in landmarks for j in of):
        return log_psi
    found = log_psi.copy()
    for k, of in enumerate(landmarks):
        for j in of:
            found[k, members.get(j, ())] -= _OTHER
    return found


_BESIDE = frozenset({"between", *ON_A_SIDE, *NEARNESS})
"""Relations to a group in which nothing of it stands."""


def _kinds(phrase: Phrase) -> frozenset[str]:
    """What kinds of groups a phrase speaks of."""
    return frozenset(kind for word in (phrase.noun, *phrase.words) for kind in GROUP_WORDS.get(word or "", ()))


def _of_kind(phrase: Phrase, encoder: WorldEncoder) -> Floats:
    """(things,) what groups of another kind, and places, lose to "the row", where there is one."""
    kinds, where = _kinds(phrase), encoder.layout
    of_kind = np.array([not kinds.isdisjoint(o.attributes) for o in encoder.all]) & where.group
    return np.where(of_kind.any() & ~of_kind & ~where.solid, -_OTHER, 0.0)


def _of_so_many(phrase: Phrase, encoder: WorldEncoder) -> Floats:
    """(things,) what groups of another number lose to "the stack of three", where there is a group of three."""
    number = counted(phrase.words)
    if number is None or not in_group(phrase):
        return np.zeros(len(encoder.all))
    counts = np.array([len(o.members) for o in encoder.all])
    if number not in counts:
        return np.zeros(len(counts))
    return np.where((counts > 0) & (counts != number), -_OTHER, 0.0)


def _of_a_whole(phrase: Phrase, encoder: WorldEncoder) -> Floats:
    """(things,) what a row loses to "the row of blocks" that is a part of a longer one."""
    lost = np.zeros(len(encoder.all))
    if not in_group(phrase) or counted(phrase.words) is not None:
        return lost
    rows = [(j, frozenset(o.members)) for j, o in enumerate(encoder.all) if ROW in o.attributes]
    for j, members in rows:
        lost[j] = -_A_PART if any(members < more for _, more in rows) else 0.0
    return lost


def _tidy(phrase: Phrase, encoder: WorldEncoder) -> Floats:
    """(things,) what rows lose that are wider and less even than the tidiest, to "the row of three".

    Any three things by chance lie about in a line: people mean by a row what is plainly one.
    """
    lost = np.zeros(len(encoder.all))
    number = counted(phrase.words)
    if number is None or _ROWS.isdisjoint({phrase.noun, *phrase.words}):
        return lost
    many = [j for j, o in enumerate(encoder.all) if ROW in o.attributes and len(o.members) == number]
    if len(many) < 2:
        return lost
    at = {o.id: place for o, place in zip(encoder.all, encoder.layout.position, strict=True)}
    rows = [_tidiness(np.array([at[i] for i in encoder.all[j].members])) for j in many]
    steps, bent = np.array(rows).T
    loss = -_WIDE * np.log(steps) - _BENT * bent
    lost[many] = np.maximum(_FAR, loss - loss.max())
    return lost


def _close(phrase: Phrase, encoder: WorldEncoder) -> Floats:
    """(things,) what clusters lose that are wider than the closest of as many: "the group of three".

    Of things strewn about some always stand a little closer to one another than to others.
    """
    lost = np.zeros(len(encoder.all))
    if _CLUSTERS.isdisjoint({phrase.noun, *phrase.words}):
        return lost
    number, where = counted(phrase.words), encoder.layout
    some = [j for j in where.members if CLUSTER in encoder.all[j].attributes]
    some = [j for j in some if number in (None, len(where.members[j]))]
    if len(some) < 2:
        return lost
    steps = [nearest_other(where.position[where.members[j]]).mean() for j in some]
    loss = -_LOOSE * np.log(np.maximum(steps, SAME_SPOT / 2.0))
    lost[some] = np.maximum(_FAR, loss - loss.max())
    return lost


def _to_a_side(phrase: Phrase, encoder: WorldEncoder) -> Floats:
    """(things,) what groups lose to "the left row" that are not the one farthest to that side.

    Groups of one kind are compared, of so many as are said, without those that are a part of another, unless that
    is several of them together.
    """
    lost = np.zeros(len(encoder.all))
    sides, kinds = LATERAL.intersection(phrase.words), _kinds(phrase)
    if len(sides) != 1 or not OWNERS.keys().isdisjoint(phrase.words):
        return lost
    number, where = counted(phrase.words), encoder.layout
    some = [j for j in where.members if not kinds.isdisjoint(encoder.all[j].attributes)]
    inside = {j: frozenset(where.members[j].tolist()) for j in some if number in (None, len(where.members[j]))}
    single = {j: of for j, of in inside.items() if not _holds_two(of, inside.values())}
    whole = [j for j, of in single.items() if not any(of < other for other in single.values())]
    if len(whole) < 2:
        return lost
    left = np.array([where.position[j, 1] for j in whole]) * (1.0 if sides == {"left"} else -1.0)
    lost[whole] = np.where(left < left.max() - SAME_SPOT / 2.0, _NOT_THERE, 0.0)
    return lost


def _holds_two(group: frozenset[int], groups: Collection[frozenset[int]]) -> bool:
    """Is a group made of two others, or of more?"""
    parts = [of for of in groups if of < group]
    return any(one.isdisjoint(other) for one in parts for other in parts)


def _tidiness(points: Floats) -> tuple[float, float]:
    """The step of a row (n, 3), and how far at most, in steps, one stands from where it is due."""
    centred = points - points.mean(axis=0)
    along = centred @ np.linalg.svd(centred, full_matrices=False)[2][0]
    order = np.argsort(along)
    due = np.linspace(points[order[0]], points[order[-1]], len(points))
    step = float(np.linalg.norm(points[order[-1]] - points[order[0]])) / (len(points) - 1) + 1e-9
    return step, float(np.linalg.norm(points[order] - due, axis=1).max()) / step
