"""Examples as the rows of the log-linear model: which columns fire for every labelled factor.

`encode` makes tables under the columns of the moment. `Statistics` is a corpus that stays encoded while columns grow.
"""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterable, Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from dcg_torch.grounding.features import GROUNDING_OF, FeatureSet, Ranking, ranking
from dcg_torch.grounding.psi import TERNARY, Bag, LogLinearModel, Merged, Table, merge
from dcg_torch.scene import layout
from dcg_torch.types import Correspondence, Example, GroundingKind, WorldModel


def encode(examples: Sequence[Example], features: FeatureSet, model: LogLinearModel) -> list[Table]:
    """The labelled factors of `examples` under the given columns; rows of like width share a table."""
    return [part.table(features.shape) for part in merged(examples, Encoder(features), model.correspondences)]


def merged(examples: Sequence[Example], encoder: Encoder, correspondences: Sequence[Correspondence]) -> list[Merged]:
    """The labelled factors of `examples`, identical ones merged; rows of like width stand together."""
    alike: dict[int, list[tuple[Example, Bag]]] = {}
    for example in examples:
        bag = encoder.bag(example)
        alike.setdefault(max(3, bag.shape[1].bit_length()), []).append((example, bag))
    return [_merge(members, encoder.features, correspondences) for members in alike.values()]


def firing(examples: Sequence[Example], features: FeatureSet) -> NDArray[np.bool_]:
    """(L, G) the features that fire in some labelled factor."""
    found = np.zeros((features.shape[0] + 1, features.shape[1] + 1), dtype=np.bool_)
    for part in merged(examples, Encoder(features), TERNARY):
        for k in range(part.language.shape[1]):
            found[part.language[part.phrase, k][:, None], part.grounding] = True
    return found[:-1, :-1]


def example_bag(example: Example, features: FeatureSet) -> Bag:
    """(groundings, k) bag of the grounding columns that fire for every grounding of an example's phrase."""
    return Encoder(features).bag(example)


class Encoder:
    """Encodes examples; what depends on the world and the landmarks alone is done once for all examples."""

    def __init__(self, features: FeatureSet) -> None:
        self.features = features
        self._bags: dict[tuple[int, tuple[str, ...] | None, Ranking | None], Bag] = {}
        self._worlds: dict[int, WorldModel] = {}  # held, so that no other gets the same id

    def bag(self, example: Example) -> Bag:
        """(groundings, k) bag of an example's factors."""
        kind, world = GROUNDING_OF[example.phrase.kind], example.world
        self._worlds[id(world)] = world
        if kind is GroundingKind.ACTION or kind is GroundingKind.REGION:
            hypotheses = self.features.encode_groundings(kind, world, [example.children])
            return hypotheses.reshape(hypotheses.shape[1:])
        placed = kind is GroundingKind.PLACED
        landmarks = tuple(c.grounding.object.id for c in example.children) if placed else None
        counted = ranking(example.phrase)
        key = id(world), landmarks, counted
        if key not in self._bags:
            self._bags[key] = self._encode(world, landmarks, counted)
        return self._bags[key]

    def _encode(self, world: WorldModel, landmarks: tuple[str, ...] | None, counted: Ranking | None) -> Bag:
        if landmarks is None:
            return self.features.encode_things(world, layout(world), counted)
        index = {thing.id: j for j, thing in enumerate(world.things)}
        rows = self.features.encode_placed(layout(world), [[index[i] for i in landmarks]], counted)
        return rows.reshape(rows.shape[1:])


def _merge(
    encoded: Sequence[tuple[Example, Bag]], features: FeatureSet, correspondences: Sequence[Correspondence]
) -> Merged:
    bags, phrases, labels, weights = [], [], [], []
    for k, (example, bag) in enumerate(encoded):
        labelled = [j for j, c in enumerate(example.correspondences) if c is not None]
        bags.append(bag[labelled])
        phrases += [k] * len(labelled)
        labels += [correspondences.index(c) for c in example.correspondences if c is not None]
        own = example.weights or (1.0,) * len(example.correspondences)
        weights += [example.weight * own[j] for j in labelled]
    width = max(b.shape[1] for b in bags)
    return merge(
        features.encode_phrases([example.phrase for example, _ in encoded]),
        np.concatenate([np.pad(b, ((0, 0), (0, width - b.shape[1])), constant_values=-1) for b in bags]),
        np.array(phrases, dtype=np.int64),
        np.array(labels, dtype=np.int64),
        np.array(weights),
        len(correspondences),
    )


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
    parts: tuple[Merged, ...]
    places: frozenset[str]

    def joined(self, other: Statistics) -> Statistics:
        """Those of both corpora, under the columns of both."""
        features = self.features.joined(other.features)
        parts = []
        for one in (self, other):
            language = _renaming(one.features.language, features.language, lambda name: (name,))
            grounding = _renaming(one.features.grounding, features.grounding, lambda name: (name,))
            parts += [_under(part, language, grounding) for part in one.parts]
        return Statistics(features, tuple(parts), self.places | other.places)

    def under(self, features: FeatureSet, known_types: Collection[str]) -> list[Table]:
        """The tables under the model's columns."""
        language = _renaming(self.features.language, features.language, lambda n: _language(n, features))
        types = self.places | set(known_types)
        grounding = _renaming(self.features.grounding, features.grounding, lambda n: _grounding(n, features, types))
        return [_under(part, language, grounding).table(features.shape) for part in self.parts]


class Reader:
    """Makes the statistics of a corpus, again and again: what a world looks like is encoded once."""

    def __init__(self) -> None:
        self._encoder: Encoder | None = None
        self._known: dict[int, tuple[WorldModel, WorldModel]] = {}

    def statistics(
        self, examples: Sequence[Example], features: FeatureSet, correspondences: Sequence[Correspondence]
    ) -> Statistics:
        """Of a corpus, with all columns that `features` has."""
        worlds = {id(e.world): e.world for e in examples}
        for key, world in worlds.items():
            if key not in self._known:
                self._known[key] = world, _all_known(world)  # the world too, so that no other gets the same id
        things = [o for world in worlds.values() for o in world.things]
        types = {o.type: None for o in things if o.type is not None}
        nouns = {e.phrase.noun: None for e in examples if e.phrase.noun is not None}
        colors = {o.color: None for o in things if o.color is not None}
        colors |= {e.phrase.color: None for e in examples if e.phrase.color is not None}
        start = features if self._encoder is None else self._encoder.features.joined(features)
        apart = start.extended((), list(colors), examples).include(nouns=nouns, types=types)
        if self._encoder is None or len(apart.grounding) > len(self._encoder.features.grounding):
            self._encoder = Encoder(apart)
        self._encoder.features = apart  # its grounding columns are the old ones, and so are its bags
        found = merged(
            [replace(e, world=self._known[id(e.world)][1]) for e in examples], self._encoder, correspondences
        )
        places = frozenset(o.type for world in worlds.values() for o in world.places if o.type is not None)
        return Statistics(apart, tuple(found), places)


def _under(part: Merged, language: NDArray[np.int64], grounding: NDArray[np.int64]) -> Merged:
    return replace(part, language=_renamed(part.language, language), grounding=_renamed(part.grounding, grounding))


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


def _renamed(bag: Bag, table: NDArray[np.int64]) -> Bag:
    """A bag under other columns, without columns of padding alone."""
    rows = np.sort(table[bag].reshape(len(bag), -1), axis=1)
    rows[:, 1:][rows[:, 1:] == rows[:, :-1]] = -1  # two unknown colours of a group are one feature
    used = (rows >= 0).any(axis=0)
    return rows[:, used]
