"""Things of exactly the name that is said: where there are such, a phrase that ranks leaves other names out.

"The leftmost box" is one of the boxes where there are some, though a crate may be called a box where there is none.
"""

from __future__ import annotations

import numpy as np

from dcg_torch.grounding.encoding import WorldEncoder
from dcg_torch.names.evidence import evidence
from dcg_torch.types import OPAQUE, Phrase
from dcg_torch.types.arrays import Bools, Floats

_EQUAL, _OTHERWISE = "name: equal", frozenset({"name: none", "name: shared word", "name: class is word"})
_BEHIND = 3.0
"""Nats by which what goes by another name stays behind: who was taught that a crate is a box speaks of both."""


def compared_by_name(phrase: Phrase, described: Bools, odds: Floats, encoder: WorldEncoder) -> Bools:
    """(things,) those of the described that a noun phrase compares.

    Args:
        odds: (things,) log-odds that a thing is called so.
    """
    if phrase.noun is None:
        return described
    at = np.flatnonzero(described)
    types = {j: type_ for j in at.tolist() if (type_ := encoder.all[j].type) and not type_.startswith(OPAQUE)}
    forms = {type_: evidence(phrase.noun, type_)[0] for type_ in set(types.values())}
    if _EQUAL not in forms.values() or _OTHERWISE.isdisjoint(forms.values()):
        return described
    found = described.copy()
    least = odds[at].max() - _BEHIND
    found[[j for j, type_ in types.items() if forms[type_] in _OTHERWISE and odds[j] < least]] = False
    return found
