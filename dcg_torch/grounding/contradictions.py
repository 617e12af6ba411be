"""Words that contradict what is told of a thing: "with a hat" of who wears none."""

from __future__ import annotations

import functools
from collections.abc import Sequence

import numpy as np

from dcg_torch.grounding.encoding import WorldEncoder
from dcg_torch.names.attribute_values import states_value
from dcg_torch.names.attributes import NOT_, attribute_evidence
from dcg_torch.names.keys import OF_KEY
from dcg_torch.names.vocabulary import WORKED_OUT
from dcg_torch.types import Object
from dcg_torch.types.arrays import Floats

_UNMARKED = 2.0
"""As many such words is a mark that a thing does not bear: "block 7" of block 8."""
_NO_MARK = 4.5
"""Nats that a thing loses of which nobody says a mark that is said and borne by another."""
_JUDGED, _BY_EYE = 0.7, frozenset({"orientation", "age", "size"})
"""The same of a word for what people judge by eye, and judge in many ways."""
_AGAIN = 2.0
"""Nats that a thing loses for each word that its attributes contradict beside the first: each part of a description
counts, and one that nobody fits does not make all alike."""


def contradicted(words: Sequence[str], thing: Object) -> float:
    """How many words the attributes of a thing contradict; marks that it does not bear count more."""
    heard = [word for word in words if not word.removeprefix(NOT_).startswith(WORKED_OUT)]
    told = [(word, attribute_evidence((word,), thing.attributes)) for word in heard]
    marks = sum(OF_KEY in word and found == ("attribute: silent",) for word, found in told)
    others = sum(_weight(word) for word, found in told if "attribute: contrary" in found)
    return others + _UNMARKED * marks


@functools.lru_cache(maxsize=4096)
def _weight(word: str) -> float:
    if OF_KEY in word:
        return _UNMARKED
    return _JUDGED if states_value(word.removeprefix(NOT_), _BY_EYE) else 1.0


def of_missing_marks(words: Sequence[str], encoder: WorldEncoder) -> Floats | None:
    """(things,) log-factor of marks of which nothing is known of a thing while another bears them: "room 12".

    A room without a number is not the one whose number is said. None where no such mark is said or borne.
    """
    marks = [word for word in words if OF_KEY in word and not word.removeprefix(NOT_).startswith((NOT_, *WORKED_OUT))]
    if not marks or len(marks) > len({word.partition(OF_KEY)[0] for word in marks}):
        return None
    found = np.zeros(len(encoder.all))
    for word in marks:
        facts = [attribute_evidence((word,), o.attributes) for o in encoder.world.objects]
        if ("attribute: equal",) in facts and not word.startswith(NOT_):
            found[: len(facts)] -= [_NO_MARK if fact == ("attribute: silent",) else 0.0 for fact in facts]
    return found if found.any() else None


def of_contradictions(told: Sequence[str], encoder: WorldEncoder) -> Floats:
    """(things,) log-factor of the words that contradict a thing's attributes, beside the first of them."""
    if len(told) < 2:
        return np.zeros(len(encoder.all))
    return np.array([-_AGAIN * max(0.0, contradicted(told, o) - 1.0) for o in encoder.all])
