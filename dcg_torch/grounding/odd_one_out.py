"""The odd one out: the thing that alone differs from all others, by its class, its colour, its size or a mark.

That is measured, not learned: which one is odd depends on all that is there.
"""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Hashable, Sequence
from dataclasses import replace

import numpy as np

from dcg_torch.grounding.encoding import WorldEncoder
from dcg_torch.names.palette import lab
from dcg_torch.names.vocabulary import ODD, WORKED_OUT
from dcg_torch.scene.bodies import bulk
from dcg_torch.types import LOOKED_ROUND, Object, Phrase
from dcg_torch.types.arrays import Bools, Floats

_NOT_IT = -6.0
"""Nats that a thing loses that is not the odd one."""
_FEW, _MOST = 3, 0.6
"""Things at least of which one can be odd, and the share of the others at least that are alike."""
_LARGER, _OTHER_COLOR = math.log(1.5), 15.0
"""How far at least the logarithm of a volume, and a colour in CIELAB, is from those of all others."""


def odd_one(phrase: Phrase, among: Bools, encoder: WorldEncoder) -> tuple[Phrase, Floats]:
    """What a noun phrase says that names the odd one.

    Args:
        among: (things,) what the rest of the phrase describes.

    Returns:
        The phrase without the word, and the log-factor of each thing; as it was where none is odd.
    """
    log = np.zeros(len(among))
    at = np.flatnonzero(among & encoder.layout.solid & encoder.perceived)
    if ODD not in phrase.words or phrase.plural or len(at) < _FEW:
        return phrase, log
    things = [encoder.all[j] for j in at.tolist()]
    lone = np.max([_lone(values) for values in _aspects(things)] + [_far_out(things)], axis=0)
    if lone.max() < _MOST:
        return phrase, log
    log[at] = np.where(lone >= lone.max() - 1e-9, 0.0, _NOT_IT)
    return replace(phrase, words=tuple(word for word in phrase.words if word != ODD)), log


def _aspects(things: Sequence[Object]) -> list[list[Hashable]]:
    """What is known of things, an aspect at a time."""
    own = [{a for a in o.attributes if a != LOOKED_ROUND and not a.startswith(WORKED_OUT)} for o in things]
    keys = {a.partition(":")[0] for of in own for a in of}
    marks: list[list[Hashable]] = [
        [tuple(sorted(a for a in of if a.partition(":")[0] == key)) for of in own] for key in sorted(keys)
    ]
    return [[o.type for o in things], [o.color for o in things], *marks]


def _lone(values: Sequence[Hashable]) -> Floats:
    """(things,) the share of the others that are alike, of what alone has its value; else 0."""
    often = Counter(values)
    most = [max((n for other, n in often.items() if other != value), default=0) for value in values]
    shares = [n / (len(values) - 1) if often[value] == 1 else 0.0 for value, n in zip(values, most, strict=True)]
    return np.array(shares)


def _far_out(things: Sequence[Object]) -> Floats:
    """(things,) 1 of what alone is of another size or of another colour, as it looks; else 0."""
    found = np.zeros(len(things))
    sizes = [math.nan if o.size is None or not bulk(o.size) > 0.0 else math.log(bulk(o.size)) for o in things]
    looks = [(math.nan,) * 3 if o.rgb is None else o.rgb for o in things]
    for values, least in ((np.array(sizes)[:, None], _LARGER), (lab(np.array(looks, dtype=np.float64)), _OTHER_COLOR)):
        if np.isfinite(values).all():
            apart = np.linalg.norm(values[:, None] - values[None], axis=2)
            np.fill_diagonal(apart, np.inf)
            rest = [np.delete(np.delete(apart, k, 0), k, 1) for k in range(len(things))]
            wide = np.array([np.where(np.isfinite(of), of, 0.0).max() for of in rest])
            found = np.maximum(found, (apart.min(axis=1) > np.maximum(least, 2.0 * wide)).astype(np.float64))
    return found
