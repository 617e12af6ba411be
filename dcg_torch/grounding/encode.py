"""Examples as the rows of the log-linear factor: which columns fire for every labelled factor."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from dcg_torch.grounding.design import DesignMatrix, merge, stack_bags
from dcg_torch.grounding.features import GROUNDING_OF, FeatureSet, Group, Ranking, Said, ranking
from dcg_torch.grounding.psi import Bag
from dcg_torch.scene import Layout, layout
from dcg_torch.types import Correspondence, Example, GroundingKind, Phrase, WorldModel


class WorldEncoder:
    """The grounding bags of one world. What several phrases, examples or rounds have in common is encoded once.

    Args:
        features: the columns.
        world: whose groundings are encoded.
    """

    def __init__(self, features: FeatureSet, world: WorldModel) -> None:
        self.features = features
        self.world = world
        self._said: dict[Said, Bag] = {}
        self._placed: dict[tuple[tuple[int, ...], Ranking | None], NDArray[np.int16]] = {}

    @cached_property
    def layout(self) -> Layout:
        """Where the things of the world are."""
        return layout(self.world)

    @cached_property
    def number(self) -> dict[str, int]:
        """Id of a thing -> its number."""
        return {thing.id: j for j, thing in enumerate(self.world.things)}

    @cached_property
    def _objects(self) -> Bag:
        return self.features.encode_things(self.world, self.layout)

    def things(self, phrase: Phrase) -> Bag:
        """(things, k) bag of a noun phrase's factors, but for the ranks that it speaks of."""
        if Group.NAMES not in self.features.groups:
            return self._objects
        said = Said.of(phrase)
        if said not in self._said:
            self._said[said] = self.features.encode_said(self.world, said)
        return np.hstack([self._objects, self._said[said]])

    def ranked(self, phrase: Phrase, members: NDArray[np.bool_] | None = None) -> Bag:
        """(things, k) bag of a noun phrase's factors.

        Args:
            members: (things,) those among which it ranks; None: all.
        """
        counted = ranking(phrase)
        if counted is None or Group.RELATION not in self.features.groups:
            return self.things(phrase)
        return np.hstack([self.things(phrase), self.features.encode_ranks(self.layout, counted, members)])

    def placed(self, landmarks: Sequence[tuple[int, ...]], counted: Ranking | None) -> Bag:
        """(landmarks, things, k) bag of a modifier's factors, to each tuple of numbers of landmarks."""
        new = [of for of in dict.fromkeys(landmarks) if (of, counted) not in self._placed]
        if new:
            rows = self.features.encode_placed(self.layout, new, counted).astype(np.int16)
            self._placed.update({(of, counted): bag for of, bag in zip(new, rows, strict=True)})
        return np.stack([self._placed[of, counted] for of in landmarks]).astype(np.int64)

    def bag(self, example: Example) -> Bag:
        """(groundings, k) bag of the factors of an example in this world."""
        kind = GROUNDING_OF[example.phrase.kind]
        if kind is GroundingKind.OBJECT:
            return self.ranked(example.phrase)
        if kind is GroundingKind.PLACED:
            landmarks = tuple(self.number[c.grounding.object.id] for c in example.children)
            rows = self.placed([landmarks], ranking(example.phrase))
        else:
            rows = self.features.encode_groundings(kind, self.world, [example.children])
        return rows.reshape(rows.shape[1:])


@dataclass(frozen=True)
class Rows:
    """Labelled factors of one phrase.

    Attributes:
        grounding: (n, k) bag.
        label: (n,) which correspondence each has.
        weight: (n,) of each in the likelihood.
    """

    phrase: Phrase
    grounding: Bag
    label: Sequence[Correspondence] | NDArray[np.int64]
    weight: NDArray[np.float64]


def example_bag(example: Example, features: FeatureSet) -> Bag:
    """(groundings, k) bag of the grounding columns that fire for every grounding of an example's phrase."""
    return WorldEncoder(features, example.world).bag(example)


def rows_of(examples: Sequence[Example], features: FeatureSet) -> list[Rows]:
    """The labelled factors of examples; those of one world that stand together share what is encoded of it."""
    found: list[Rows] = []
    encoder: WorldEncoder | None = None
    for example in examples:
        if encoder is None or encoder.world is not example.world:
            encoder = WorldEncoder(features, example.world)
        labelled = [j for j, c in enumerate(example.correspondences) if c is not None]
        own = example.weights or (1.0,) * len(example.correspondences)
        found.append(
            Rows(
                example.phrase,
                encoder.bag(example)[labelled],
                np.array([example.correspondences[j] for j in labelled], dtype=np.int64),
                example.weight * np.array([own[j] for j in labelled]),
            )
        )
    return found


def encode(
    examples: Sequence[Example], features: FeatureSet, correspondences: Sequence[Correspondence]
) -> list[DesignMatrix]:
    """The labelled factors of `examples` under the given columns."""
    return design_matrices(rows_of(examples, features), features, correspondences)


def design_matrices(
    rows: Sequence[Rows], features: FeatureSet, correspondences: Sequence[Correspondence]
) -> list[DesignMatrix]:
    """Labelled factors with identical ones merged; rows of like width share a matrix."""
    alike: dict[int, list[Rows]] = {}
    for one in rows:
        alike.setdefault(max(3, one.grounding.shape[1].bit_length()), []).append(one)
    return [_merged(of_width, features, correspondences) for of_width in alike.values()]


def _merged(rows: Sequence[Rows], features: FeatureSet, correspondences: Sequence[Correspondence]) -> DesignMatrix:
    number: dict[Phrase, int] = {}
    phrase = [number.setdefault(one.phrase, len(number)) for one in rows]
    at = np.full(3, -1)
    at[[c + 1 for c in correspondences]] = range(len(correspondences))
    return merge(
        features.encode_phrases(list(number)),
        stack_bags([one.grounding for one in rows]),
        np.repeat(np.array(phrase, dtype=np.int64), [len(one.grounding) for one in rows]),
        at[np.concatenate([np.asarray(one.label, dtype=np.int64) for one in rows]) + 1],
        np.concatenate([one.weight for one in rows]),
        len(correspondences),
    )


def firing(designs: Sequence[DesignMatrix], shape: tuple[int, int]) -> NDArray[np.bool_]:
    """(L, G) the features that fire in some labelled factor."""
    found = np.zeros((shape[0] + 1, shape[1] + 1), dtype=np.bool_)  # the last of each is the padding
    for design in designs:
        for column in design.language.T:
            found[column[design.phrase][:, None], design.grounding] = True
    return found[:-1, :-1]
