"""How near two nouns are to each other in WordNet, whatever class they are held against."""

from __future__ import annotations

import functools

from dcg_torch.names.everyday_names import name_parts, share_a_name
from dcg_torch.names.wordnet import nouns

_SENSES, _STEPS = 2, 5
FAR_APART = 12
_AKIN = 8
"""Steps from which nouns are hardly said for one another."""


@functools.lru_cache(maxsize=8192)
def steps_apart(one: str, other: str) -> int:
    """How many steps two nouns are apart over the nearest thing that both are kinds of; `FAR_APART` for strangers.

    >>> steps_apart("desk", "table"), steps_apart("couch", "bed"), steps_apart("couch", "pillow") > 4
    (0, 4, True)
    """
    if share_a_name(name_parts(one).text, name_parts(other).text) or one == other:
        return 0
    table, least = nouns(), FAR_APART
    for said in table.senses(name_parts(one).text, _SENSES) or table.senses(name_parts(one).head, _SENSES):
        above = table.ancestors(said, _STEPS)
        for named in table.senses(name_parts(other).text, _SENSES) or table.senses(name_parts(other).head, _SENSES):
            common = (above[s] + steps for s, steps in table.ancestors(named, _STEPS).items() if s in above)
            least = min(least, min(common, default=FAR_APART))
    return least


def is_akin(new: str | None, other: str | None, thing: str | None) -> bool:
    """Is a noun rather said for another thing than for one?

    >>> is_akin("couch", "bed", "pillow"), is_akin("cushion", "bed", "pillow")
    (True, False)
    """
    if new is None or other is None:
        return False
    apart = FAR_APART if thing is None else steps_apart(new, thing)
    return steps_apart(new, other) + 1 < min(apart, _AKIN)
