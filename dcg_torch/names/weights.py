"""How much each fact between a noun and a class name tells: weights that `tools/noun_table.py` learned from
`data/nouns.yaml`.

    P(class c | noun n) is proportional to exp(sum of the weights of the facts between n and c)

over the classes in view, and over one more choice of weight 0: none of them. The weights are a prior; whoever learns
from use starts from them.
"""

from __future__ import annotations

import functools
from collections.abc import Iterable, Mapping

from dcg_torch.names.evidence import FORMS, KINDS, evidence, is_generic
from dcg_torch.names.normal_form import read_data

FACTS = FORMS + KINDS
WEIGHTS = "weights.yaml"


@functools.cache
def fact_weights() -> Mapping[str, float]:
    """The shipped weight of each fact, as log-odds."""
    return {str(fact): float(weight) for fact, weight in read_data(WEIGHTS).items()}


def names_one_of(noun: str, classes: Iterable[str]) -> bool:
    """Does a noun name one of some classes, or may it be said of whatever there is?"""
    return is_generic(noun) or any(log_odds(noun, name) > 0.0 for name in classes)


@functools.lru_cache(maxsize=65536)
def log_odds(noun: str, class_name: str) -> float:
    """log P(the noun means this class) - log P(it means nothing that is there), were this class alone in view."""
    weights = fact_weights()
    return sum(weights.get(fact, 0.0) for fact in evidence(noun, class_name))
