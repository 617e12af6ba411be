"""Examples as the rows of the log-linear factor: which columns fire for every labelled factor."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from dcg_torch import scene
from dcg_torch.grounding.design import DesignMatrix, merge, stack_bags
from dcg_torch.grounding.features import GROUNDING_OF, FeatureSet, Ranking, ranking
from dcg_torch.grounding.psi import Bag
from dcg_torch.types import Correspondence, Example, GroundingKind, Phrase, WorldModel

_Aspect = tuple[tuple[str, ...] | None, Ranking | None]
"""What of an example, beside its world, says how a noun phrase or modifier is encoded: landmarks, what is counted."""


class WorldEncoder:
    """The grounding bags of one world; what several examples have in common is encoded once.

    Args:
        features: the columns.
        world: whose groundings are encoded.
    """

    def __init__(self, features: FeatureSet, world: WorldModel) -> None:
        self.features = features
        self.world = world
        self._bags: dict[_Aspect, Bag] = {}

    def bag(self, example: Example) -> Bag:
        """(groundings, k) bag of the factors of an example in this world."""
        kind = GROUNDING_OF[example.phrase.kind]
        if kind is GroundingKind.ACTION or kind is GroundingKind.REGION:
            hypotheses = self.features.encode_groundings(kind, self.world, [example.children])
            return hypotheses.reshape(hypotheses.shape[1:])
        placed = kind is GroundingKind.PLACED
        landmarks = tuple(c.grounding.object.id for c in example.children) if placed else None
        aspect = landmarks, ranking(example.phrase)
        if aspect not in self._bags:
            self._bags[aspect] = self._encode(*aspect)
        return self._bags[aspect]

    def _encode(self, landmarks: tuple[str, ...] | None, counted: Ranking | None) -> Bag:
        where = scene.layout(self.world)
        if landmarks is None:
            return self.features.encode_things(self.world, where, counted)
        index = {thing.id: j for j, thing in enumerate(self.world.things)}
        rows = self.features.encode_placed(where, [[index[i] for i in landmarks]], counted)
        return rows.reshape(rows.shape[1:])


def example_bag(example: Example, features: FeatureSet) -> Bag:
    """(groundings, k) bag of the grounding columns that fire for every grounding of an example's phrase."""
    return WorldEncoder(features, example.world).bag(example)


def encode(
    examples: Sequence[Example], features: FeatureSet, correspondences: Sequence[Correspondence]
) -> list[DesignMatrix]:
    """The labelled factors of `examples` under the given columns; rows of like width share a matrix."""
    return design_matrices(examples, bags(examples, features), features, correspondences)


def bags(examples: Sequence[Example], features: FeatureSet) -> list[Bag]:
    """The bag of each example."""
    worlds: dict[int, WorldEncoder] = {}  # by identity: the examples hold their worlds as long as this lasts
    found = []
    for example in examples:
        key = id(example.world)
        if key not in worlds:
            worlds[key] = WorldEncoder(features, example.world)
        found.append(worlds[key].bag(example))
    return found


def design_matrices(
    examples: Sequence[Example],
    encoded: Sequence[Bag],
    features: FeatureSet,
    correspondences: Sequence[Correspondence],
) -> list[DesignMatrix]:
    """The labelled factors of examples whose bags are known, identical ones merged; rows of like width together."""
    alike: dict[int, list[int]] = {}
    for k, bag in enumerate(encoded):
        alike.setdefault(max(3, bag.shape[1].bit_length()), []).append(k)
    return [
        _merged([examples[k] for k in of_width], [encoded[k] for k in of_width], features, correspondences)
        for of_width in alike.values()
    ]


def _merged(
    examples: Sequence[Example],
    encoded: Sequence[Bag],
    features: FeatureSet,
    correspondences: Sequence[Correspondence],
) -> DesignMatrix:
    rows, phrases, labels, weights = [], [], [], []
    number = {c: k for k, c in enumerate(correspondences)}
    phrase_of: dict[int, int] = {}
    distinct: list[Phrase] = []
    for example, bag in zip(examples, encoded, strict=True):
        labelled = [j for j, c in enumerate(example.correspondences) if c is not None]
        rows.append(bag[labelled])
        if id(example.phrase) not in phrase_of:
            phrase_of[id(example.phrase)] = len(distinct)
            distinct.append(example.phrase)
        phrases += [phrase_of[id(example.phrase)]] * len(labelled)
        labels += [number[c] for c in example.correspondences if c is not None]
        own = example.weights or (1.0,) * len(example.correspondences)
        weights += [example.weight * own[j] for j in labelled]
    return merge(
        features.encode_phrases(distinct),
        stack_bags(rows),
        np.array(phrases, dtype=np.int64),
        np.array(labels, dtype=np.int64),
        np.array(weights),
        len(correspondences),
    )
