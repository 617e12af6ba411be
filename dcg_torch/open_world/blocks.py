"""The two blocks of an open-world model's weights.

What nouns and colours mean follows from the posterior, anew after every command. What "behind", "leftmost" or "you"
mean is taught once, by lessons. Hardly a feature is shared: a modifier's factor is about how a thing is placed, a
noun's about what it is, and a noun phrase's describing words and places add features of their own to the latter. So
each block is fitted with the other as it stands, and a command costs no more than it would without relations.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from dcg_torch.grounding.features import FeatureSet, Group
from dcg_torch.grounding.psi import LogLinearFactor
from dcg_torch.relational import PLACE_TYPES, PLACE_WORDS, group_nouns

_TAUGHT_LANGUAGE = frozenset({"modifier", "word", "context", "landmark"})
_TAUGHT_GROUNDING = frozenset({"relation", "state", "part", "rank", "stack color", "group color"})
_PLACES = {f"noun: {word}" for word in (*PLACE_WORDS, *group_nouns())}
_OF_PLACES = {*(f"type: {kind}" for kind in PLACE_TYPES), "kind: place", "kind: group"}


@dataclass(frozen=True)
class Blocks:
    """How a feature set divides.

    Attributes:
        believed: the columns of nouns, colours, verbs and prepositions, in their order.
        rows, columns: where these stand in the whole.
        whole: the feature set itself.
    """

    believed: FeatureSet
    rows: NDArray[np.int64]
    columns: NDArray[np.int64]
    whole: FeatureSet

    @classmethod
    def of(cls, features: FeatureSet) -> Blocks:
        """The blocks of a feature set."""
        language, grounding = list(features.language), list(features.grounding)
        rows = [k for k, name in enumerate(language) if not _is_taught_language(name)]
        columns = [k for k, name in enumerate(grounding) if not _is_taught_grounding(name)]
        believed = FeatureSet(
            features.groups - {Group.RELATION},
            {language[k]: n for n, k in enumerate(rows)},
            {grounding[k]: n for n, k in enumerate(columns)},
        )
        return cls(believed, np.array(rows), np.array(columns), features)

    @cached_property
    def taught(self) -> NDArray[np.bool_]:
        """(L, G) the features that lessons may teach."""
        return _taught(list(self.whole.language), list(self.whole.grounding))

    def part(self, model: LogLinearFactor) -> LogLinearFactor:
        """The block that follows from the posterior, as a model of its own."""
        part = LogLinearFactor(self.believed.pairs, model.correspondences)
        part.set_weight(model.weight[:, self.rows][:, :, self.columns].contiguous())
        return part

    def put(self, part: LogLinearFactor, model: LogLinearFactor) -> None:
        """Take over what `part` has learned."""
        weight = model.weight.clone()
        weight[:, self.rows[:, None], self.columns[None]] = part.weight
        model.set_weight(weight)


def _is_taught_language(name: str) -> bool:
    return name.partition(":")[0] in _TAUGHT_LANGUAGE or name in _PLACES or name == "kind: modifier"


def _is_taught_grounding(name: str) -> bool:
    return name.partition(":")[0] in _TAUGHT_GROUNDING or name in _OF_PLACES


def _taught(language: list[str], grounding: list[str]) -> NDArray[np.bool_]:
    """(L, G): what there is to be learned from lessons.

    Not what a noun or an object of a verb is like by itself, nor how things stand in a context whatever the word: the
    lessons' worlds are random, it would be chance.
    """
    of_context = np.array([name in {"kind: placed", "kind: place", "kind: group"} for name in grounding])
    of_any = np.array([name in {"kind: place", "kind: group"} for name in grounding])
    of_word = np.ones(len(grounding), dtype=np.bool_)
    rows = [
        of_context if name.startswith(("context:", "landmark:")) else of_word if _is_taught_language(name) else of_any
        for name in language
    ]
    return np.array(rows, dtype=np.bool_).reshape(len(language), len(grounding))
