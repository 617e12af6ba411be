"""A corpus that stays encoded while columns grow."""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterable, Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from dcg_torch.grounding.design import DesignMatrix
from dcg_torch.grounding.encode import WorldEncoder, design_matrices
from dcg_torch.grounding.features import FeatureSet
from dcg_torch.types import Correspondence, Example, WorldModel


@dataclass(frozen=True)
class Statistics:
    """A corpus's labelled factors, merged, under columns that keep apart all that may ever become known.

    Every noun, type and colour has a column of its own here, known or not. What is known by now says which of the
    model's columns each stands for: one of its own, or the one that all unknown ones share. So growth renames columns
    and encodes nothing anew.

    Attributes:
        features: those columns.
        parts: the factors.
        places: the types of places, which are known from the start.
    """

    features: FeatureSet
    parts: tuple[DesignMatrix, ...]
    places: frozenset[str]

    def joined(self, other: Statistics) -> Statistics:
        """Those of both corpora, under the columns of both."""
        features = self.features.joined(other.features)
        parts = []
        for one in (self, other):
            language = _renaming(one.features.language, features.language, lambda name: (name,))
            grounding = _renaming(one.features.grounding, features.grounding, lambda name: (name,))
            parts += [part.renamed(language, grounding) for part in one.parts]
        return Statistics(features, tuple(parts), self.places | other.places)

    def under(self, features: FeatureSet, known_types: Collection[str]) -> list[DesignMatrix]:
        """The design matrices under the model's columns."""
        language = _renaming(self.features.language, features.language, lambda n: _language(n, features))
        types = self.places | set(known_types)
        grounding = _renaming(self.features.grounding, features.grounding, lambda n: _grounding(n, features, types))
        return [part.renamed(language, grounding) for part in self.parts]


class CorpusEncoder:
    """Makes the statistics of a corpus, again and again: what a world looks like is encoded once.

    Worlds are told apart by value, and the bags of each are kept for as long as no column is added.
    """

    def __init__(self) -> None:
        self._features: FeatureSet | None = None
        self._worlds: dict[WorldModel, WorldEncoder] = {}

    def statistics(
        self, examples: Sequence[Example], features: FeatureSet, correspondences: Sequence[Correspondence]
    ) -> Statistics:
        """Of a corpus, with all columns that `features` has."""
        worlds = {id(e.world): e.world for e in examples}  # by identity while `examples` holds them: hashing costs
        start = features if self._features is None else self._features.joined(features)
        apart = _apart(start, examples, list(worlds.values()))
        if self._features is None or len(apart.grounding) > len(self._features.grounding):
            self._worlds = {}
        self._features = apart
        encoders = {key: self._encoder(world, apart) for key, world in worlds.items()}
        bags = [encoders[id(e.world)].bag(e) for e in examples]
        places = frozenset(o.type for world in worlds.values() for o in world.places if o.type is not None)
        return Statistics(apart, tuple(design_matrices(examples, bags, apart, correspondences)), places)

    def _encoder(self, world: WorldModel, features: FeatureSet) -> WorldEncoder:
        if world not in self._worlds:
            self._worlds[world] = WorldEncoder(features, _all_known(world))
        return self._worlds[world]


def _apart(start: FeatureSet, examples: Sequence[Example], worlds: Sequence[WorldModel]) -> FeatureSet:
    """Columns for every noun, type and colour of a corpus, known or not."""
    things = [o for world in worlds for o in world.things]
    types = {o.type: None for o in things if o.type is not None}
    nouns = {e.phrase.noun: None for e in examples if e.phrase.noun is not None}
    colors = {o.color: None for o in things if o.color is not None}
    colors |= {e.phrase.color: None for e in examples if e.phrase.color is not None}
    return start.extended((), list(colors), examples).include(nouns=nouns, types=types)


def _all_known(world: WorldModel) -> WorldModel:
    """The world with every object of some type known: whether it is, is said later."""
    objects, groups = (
        tuple(o if o.type is None else replace(o, known=True) for o in of) for of in (world.objects, world.groups)
    )
    return replace(world, objects=objects, groups=groups)


def _language(name: str, features: FeatureSet) -> tuple[str, ...]:
    """The model's language features that a fully apart one stands for."""
    family, _, what = name.partition(": ")
    if family == "noun" and what != "(unheard)":
        return (name, "noun known: yes") if features.knows_noun(what) else ("noun: (unheard)", "noun known: no")
    if name == "noun known: yes":
        return ()  # the noun itself says so
    if family == "color" and name not in features.language:
        return ("color: unknown",)
    return (name,)


def _grounding(name: str, features: FeatureSet, known_types: Collection[str]) -> tuple[str, ...]:
    """The model's grounding features that a fully apart one stands for."""
    family, _, what = name.partition(": ")
    if family == "type" and what != "(unmet)":
        return (name, "known: yes") if what in known_types else ("type: (unmet)", "known: no")
    if name == "known: yes":
        return ()  # the type itself says so
    if family == "color" and name not in features.grounding:
        return ("color: unknown",)
    return (name,)


def _renaming(
    old: Mapping[str, int], new: Mapping[str, int], names: Callable[[str], Iterable[str]]
) -> NDArray[np.int64]:
    """(len(old) + 1, 2) the new columns for each old one, -1 for none; the last row is that of the padding."""
    table = np.full((len(old) + 1, 2), -1, dtype=np.int64)
    for name, column in old.items():
        found = [new[n] for n in names(name) if n in new]
        table[column, : len(found)] = found
    return table
