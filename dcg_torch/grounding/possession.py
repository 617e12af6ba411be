"""What things have on them, in them or at them: "the desk with two monitors", "a chair with a pillow".

Where extents are known that is measured, not learned: what lies on a thing, under it or against it is its own, and what
stands farther off is the less so. Of several that are named alike any will do, or so many as are counted.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from dcg_torch.grounding.encoding import WorldEncoder
from dcg_torch.grounding.measured_relations import alike_by, gaps
from dcg_torch.names.relations import listed
from dcg_torch.scene.order import numbered
from dcg_torch.types import NOT, ParseTree, Phrase
from dcg_torch.types.arrays import Bools, Floats, Ints

_WITH = "with"
_ASIDE, _E_FOLD, _STEP = 1.0, 2.0, 0.2
"""Nats that a thing loses whose landmark stands beside it, and for each e-fold of the gap in steps of so many units."""
_NOT_ITS = -8.0
"""The most that is lost."""


def of_possession(
    tree: ParseTree, log_psi: Floats, landmarks: Sequence[int], scores: Floats, several: int, encoder: WorldEncoder
) -> Floats | None:
    """(landmarks, things) log-factor of "with" and "without" among things that have extents.

    Args:
        tree: of the modifier, with one landmark.
        log_psi: what is learned, which stays for what has no extents.
        scores: (landmarks,) of the landmarks.
        several: how many landmarks are counted; 0 for one.

    Returns:
        None where nobody says how large the landmarks are, and of all other relations.
    """
    bodies, phrase = encoder.layout.bodies, tree.phrase
    what = tree.children[0].phrase
    counted = several > 0 or what.count == 1 or not _NUMBERS.isdisjoint(what.words)
    on_it = counted and phrase.words[0] in listed("straight under") and phrase.text.startswith(_SAYS_HAS)
    if (phrase.words[0] != _WITH and not on_it) or bodies is None:
        return None
    so_called = scores >= scores.max() - _SO_CALLED if NOT in phrase.words else alike_by(scores)
    alike = np.flatnonzero(so_called & encoder.perceived[list(landmarks)])
    mark = [landmarks[k] for k in alike.tolist()]
    if max(mark, default=len(bodies.half)) >= len(bodies.half) or not encoder.layout.solid[mark].all():
        return None
    bodies = replace(bodies, half=_as_points(bodies.half, mark))
    count = max(1, several, what.count or 1)
    if len(mark) < count:
        return None
    where = encoder.layout
    covers, _ = bodies.over(np.array(mark), where.position[None, :, :2] - where.position[mark][:, None, :2])
    gap, _ = gaps(mark, encoder, bodies)
    aside = -_ASIDE - _E_FOLD * np.log1p(np.nan_to_num(gap) / _STEP)
    own = np.where(_padded(covers, aside.shape[1]), 0.0, np.where(np.isfinite(gap), aside, _NOT_ITS))
    own[np.arange(len(mark)), mark] = _NOT_ITS  # nothing is with itself
    best: Floats = np.maximum(np.sort(own, axis=0)[-count:].mean(axis=0), _NOT_ITS)
    if NOT in phrase.words:
        best = np.maximum(np.log(-np.expm1(np.minimum(_of_its_kind(best, encoder), -1e-4))), _NOT_ITS)
    else:
        best = np.maximum(best + _of_number(what, _own(own).sum(axis=0), encoder), _NOT_ITS)
    found = log_psi.copy()
    found[alike] = np.where(np.isfinite(where.position[:, 0]) & where.solid, best, log_psi[alike])
    return found


def _own(own: Floats) -> Bools:
    """(landmarks, things) which are a thing's own: all that are on it, or else about as near as the nearest."""
    covered: Bools = own > np.minimum(_OWN, own.max(axis=0) - _AS_NEAR)
    return covered & (own > _NOT_ITS)


def _of_number(phrase: Phrase, counts: Ints, encoder: WorldEncoder) -> Floats:
    """(things,) what those lose that have more or fewer than is said: "with two mugs", "with the most mugs".

    Args:
        phrase: of the landmark.
        counts: (things,) how many of the landmarks each has; compared with others of its type.
    """
    number = phrase.count
    if _MOST in phrase.words or not _LEAST.isdisjoint(phrase.words):
        sign, kind = (-1 if _MOST in phrase.words else 1), encoder.type_number
        values = np.where(counts > 0, sign * counts, np.iinfo(np.int64).max)
        best = np.full(kind.max(initial=0) + 1, np.iinfo(np.int64).max)
        np.minimum.at(best, kind, values)
        return np.where(counts > 0, -_MISCOUNTED * (sign * counts - best[kind]), _NOT_ITS)
    if number is None or number not in counts:
        return np.zeros(len(counts))
    return np.where(counts > number, -_MISCOUNTED * (counts - number), 0.0)


_OWN, _AS_NEAR = -0.5, 1.0
"""Nats above which what stands so has the landmark, and by which others of its landmarks stand farther off."""
_MISCOUNTED = 3.0
"""Nats that a thing loses for each by which it has more than is said, or fewer than the most."""
_SO_CALLED = 9.0
"""Nats by which a name fits less that fits as well: who has no chair has no office chair."""
_ONLY, _MOST, _LEAST = "only", "most", frozenset({"fewest", "least"})
_NUMBERS = _LEAST | {_ONLY, _MOST}
_SAYS_HAS = ("with", "ha")
"""What begins the text of "with two mugs on it", "has two mugs on it", which is under them."""


def _of_its_kind(best: Floats, encoder: WorldEncoder) -> Floats:
    """(things,) as before, beside the one of each type that has it most: the chair beside a table is its own."""
    kind = numbered([o.type for o in encoder.all])
    most = np.full(kind.max(initial=0) + 1, _NOT_ITS)
    np.maximum.at(most, kind, best)
    found: Floats = np.where(most[kind] > _NOT_ITS / 2.0, best - most[kind], best)
    return found


def _as_points(half: Floats, mark: Sequence[int]) -> Floats:
    """(n, 2) half extents in which landmarks that nobody measured are points: a laptop on a desk is its own."""
    found = half.copy()
    found[mark] = np.nan_to_num(found[mark])
    return found


def _padded(covers: Bools, things: int) -> Bools:
    return np.pad(covers, ((0, 0), (0, things - covers.shape[1])))
