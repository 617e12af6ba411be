"""Examples as the rows of the log-linear factor: which columns fire for every labelled factor."""

from __future__ import annotations

import copy
from collections.abc import Callable, Hashable, Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from dcg_torch import scene
from dcg_torch.fitting.design import DesignMatrix, distinct_rows, merge, stack_bags
from dcg_torch.fitting.psi import Bag
from dcg_torch.grounding.features import (
    GROUNDING_OF,
    FeatureSet,
    Group,
    KindColumns,
    Ranking,
    Said,
    look_codes,
    padded,
    ranking,
)
from dcg_torch.interpretation.scene_kinds import stands_among
from dcg_torch.scene.order import numbered
from dcg_torch.types import Correspondence, Example, GroundingKind, Object, Phrase, WorldModel
from dcg_torch.types.arrays import Bools, Floats, Ints

_FEW = 256
"""Things up to which it does not pay to look for rows that are alike."""


@dataclass(frozen=True)
class Coded:
    """The bag of n factors, rows that are alike once.

    Attributes:
        bag: (s, k); no row has a column twice, and what fires in several has the same order in each.
        code: (n,) the row of each factor; None: all have their own.
    """

    bag: Bag
    code: Ints | None

    @property
    def rows(self) -> Bag:
        """(n, k) the bag with a row for each factor."""
        return self.bag if self.code is None else self.bag[self.code]

    def beside(self, other: Coded) -> Coded:
        """The bag in which each factor has the columns of both."""
        if self.code is None or other.code is None or len(self.code) <= _FEW:
            return Coded(np.hstack([self.rows, other.rows]), None)
        _, first, code = np.unique(self.code * len(other.bag) + other.code, return_index=True, return_inverse=True)
        return Coded(np.hstack([self.bag[self.code[first]], other.bag[other.code[first]]]), code)


class WorldEncoder:
    """The grounding bags of one world. What several phrases, examples or rounds have in common is encoded once.

    Things that are alike (type, colour, state ...) are encoded once too, and nothing is worked out that no phrase asks
    for. All that is kept goes with the encoder.

    Args:
        features: the columns.
        world: whose groundings are encoded.
        kinds: the columns of things that were met before under these features; more are added.
    """

    def __init__(self, features: FeatureSet, world: WorldModel, kinds: KindColumns | None = None) -> None:
        self.features = features
        self.world = world
        self._kinds = {} if kinds is None else kinds
        self.related = Group.RELATION in features.groups
        self._derived: dict[Hashable, WorldEncoder] = {}
        self._said: dict[Said, Coded] = {}
        self._ranked: dict[tuple[int | None, int | None, bytes | None], Coded] = {}

    def derived(self, key: Hashable, make: Callable[[WorldModel], WorldModel]) -> WorldEncoder:
        """The encoder of a world that is made of this one; what is made by the same key is made once."""
        if key not in self._derived:
            self._derived[key] = WorldEncoder(self.features, make(self.world), self._kinds)
        return self._derived[key]

    def meaning(self, world: WorldModel) -> WorldEncoder:
        """The encoder of the same world in which some things alone can be meant; it shares what was worked out."""
        other = copy.copy(self)
        other.world, other._derived = world, {}
        return other

    @cached_property
    def all(self) -> tuple[Object, ...]:
        """The things of the world."""
        return self.world.things

    @cached_property
    def layout(self) -> scene.Layout:
        """Where the things of the world are."""
        return scene.layout(self.world)

    @cached_property
    def given(self) -> frozenset[str]:
        """The attributes that some object has."""
        return frozenset().union(*{o.attributes for o in self.world.objects})

    @cached_property
    def type_number(self) -> Ints:
        """(things,) equal for things of one type."""
        return numbered([o.type for o in self.all])

    @cached_property
    def among_things(self) -> bool:
        """Does the robot stand among the things?"""
        where = self.layout
        return stands_among(where.position[where.solid & np.isfinite(where.position).all(axis=1), :2] - where.robot)

    @cached_property
    def number(self) -> dict[str, int]:
        """Id of a thing -> its number."""
        return {thing.id: j for j, thing in enumerate(self.all)}

    @cached_property
    def perceived(self) -> Bools:
        """(things,) is it there, as far as the robot can tell?"""
        return np.array([not o.hypothetical for o in self.all], dtype=np.bool_)

    @cached_property
    def _objects(self) -> tuple[Coded, list[int]]:
        """What things are by themselves, and the first thing of each row."""
        objects, n = self.world.objects, len(self.all)
        names, state = scene.state_signatures(self.layout) if self.related else ([()], np.zeros(n, dtype=np.int64))
        first: list[int] = []
        code = np.zeros(0, dtype=np.int64)
        if objects:
            first, code = scene.signatures(
                [o.type for o in objects],
                [o.color for o in objects],
                [(2 * o.known + o.hypothetical) for o in objects],
                [o.attributes for o in objects],
                state[: len(objects)],
            )
        code = np.concatenate([code, np.arange(len(first), len(first) + n - len(objects))])
        which = state.tolist()
        rows = self.features.object_columns([objects[j] for j in first], [names[which[j]] for j in first], self._kinds)
        rows += [self._group_or_place(j, names[which[j]]) for j in range(len(objects), n)]
        first += range(len(objects), n)
        return Coded(padded(rows), code), first

    def _group_or_place(self, number: int, states: tuple[str, ...]) -> list[int]:
        thing = self.all[number]
        if self.related:
            states = (*states, *(("kind: group",) if thing.members else ("kind: place", "place: yes")))
        key = thing.type, thing.known, thing.color, states  # which tell of the colours in a group
        columns = self._kinds.get(key) if self.related else None
        if columns is None:
            inside = [self.all[j].color for j in self.layout.members[number].tolist()] if thing.members else []
            colors = [c for c in dict.fromkeys(inside) if c is not None]
            columns = self._kinds[key] = self.features.thing_columns(thing, states, colors)
        return columns

    def things(self, phrase: Phrase) -> Bag:
        """(things, k) bag of a noun phrase's factors, but for the ranks that it speaks of."""
        return self.unranked(phrase).rows

    def unranked(self, phrase: Phrase) -> Coded:
        """The bag of a noun phrase's factors without ranks, things that are alike once."""
        objects, first = self._objects
        if Group.NAMES not in self.features.groups:
            return objects
        said = Said.of(phrase)
        if said not in self._said:
            self._said[said] = self._of_names(said, objects, first)
        return self._said[said]

    def _of_names(self, said: Said, objects: Coded, first: list[int]) -> Coded:
        looks = look_codes(said.look, self.all)
        if looks is None or objects.code is None:
            columns = self.features.said_columns(said, [self.all[j] for j in first], [-1] * len(first), self._kinds)
            return Coded(np.hstack([objects.bag, padded(columns)]), objects.code)
        _, one, code = np.unique(objects.code * 64 + looks + 1, return_index=True, return_inverse=True)
        things = [self.all[j] for j in one.tolist()]
        columns = self.features.said_columns(said, things, looks[one].tolist(), self._kinds)
        return Coded(np.hstack([objects.bag[objects.code[one]], padded(columns)]), code)

    def ranked(self, phrase: Phrase, members: Bools | None = None) -> Bag:
        """(things, k) bag of a noun phrase's factors.

        Args:
            members: (things,) those among which it ranks; None: all.
        """
        return self.noun(phrase, members).rows

    def noun(self, phrase: Phrase, members: Bools | None = None) -> Coded:
        """The bag of a noun phrase's factors with the ranks that it speaks of, things that are alike once."""
        counted = ranking(phrase)
        if counted is None or not self.related:
            return self.unranked(phrase)
        key = counted.ordinal, counted.count, None if members is None else members.tobytes()
        coded = self._ranked.get(key)
        if coded is None:
            ranks = self.features.encode_ranks(self.layout, counted, members)
            few = len(ranks) <= _FEW
            coded = self._ranked[key] = Coded(ranks, None) if few else Coded(*distinct_rows(ranks))
        return self.unranked(phrase).beside(coded)

    @cached_property
    def _relations(self) -> scene.Relations:
        return scene.Relations(self.layout)

    def relations(
        self, landmarks: Sequence[tuple[int, ...]], counted: Ranking, members: Bools | None = None
    ) -> NDArray[np.int16]:
        """(families, landmarks, things) to each tuple of numbers of landmarks, see `scene.Relations`."""
        return self._relations.to(landmarks, counted.among, members, counted.ordinal, counted.count)

    def distances(self, landmarks: Sequence[int]) -> Floats:
        """(landmarks, things) units from each to every thing, between their extents; not to be written to."""
        return self._relations.standing.of(landmarks)[1]

    def placed(
        self,
        landmarks: Sequence[tuple[int, ...]],
        counted: Ranking | None,
        members: Bools | None = None,
    ) -> Bag:
        """(landmarks, things, k) bag of a modifier's factors, to each tuple of numbers of landmarks.

        Args:
            members: (things,) those among which it ranks; None: those that `counted` names.
        """
        counted = counted or Ranking("all")
        if not self.related:
            return np.full((len(landmarks), len(self.all), 1), self.features.placed_column)
        return self.features.relation_columns(self.relations(landmarks, counted, members).transpose(1, 2, 0))

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
class _Labelled:
    """Labelled factors of one phrase.

    Attributes:
        grounding: (n, k) bag.
        label: (n,) which correspondence each has.
        weight: (n,) of each in the likelihood.
    """

    phrase: Phrase
    grounding: Bag
    label: Ints
    weight: Floats


def _labelled(examples: Sequence[Example], features: FeatureSet) -> list[_Labelled]:
    """The labelled factors of examples; those of one world that stand together share what is encoded of it."""
    found: list[_Labelled] = []
    encoder: WorldEncoder | None = None
    for example in examples:
        if encoder is None or encoder.world is not example.world:
            encoder = WorldEncoder(features, example.world)
        labelled = [j for j, c in enumerate(example.correspondences) if c is not None]
        own = example.weights or (1.0,) * len(example.correspondences)
        found.append(
            _Labelled(
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
    """The labelled factors of examples, identical ones merged; rows of like width share a matrix."""
    alike: dict[int, list[_Labelled]] = {}
    for one in _labelled(examples, features):
        alike.setdefault(max(3, one.grounding.shape[1].bit_length()), []).append(one)
    return [_merged(of_width, features, correspondences) for of_width in alike.values()]


def _merged(rows: Sequence[_Labelled], features: FeatureSet, correspondences: Sequence[Correspondence]) -> DesignMatrix:
    number: dict[Phrase, int] = {}
    phrase = [number.setdefault(one.phrase, len(number)) for one in rows]
    at = np.full(3, -1)
    at[[c + 1 for c in correspondences]] = range(len(correspondences))
    return merge(
        features.encode_phrases(list(number)),
        stack_bags([one.grounding for one in rows]),
        np.repeat(np.array(phrase, dtype=np.int64), [len(one.grounding) for one in rows]),
        at[np.concatenate([one.label for one in rows]) + 1],
        np.concatenate([one.weight for one in rows]),
        len(correspondences),
    )


def firing(designs: Sequence[DesignMatrix], shape: tuple[int, int]) -> Bools:
    """(L, G) the features that fire in some labelled factor."""
    found = np.zeros((shape[0] + 1, shape[1] + 1), dtype=np.bool_)  # the last of each is the padding
    for design in designs:
        for column in design.language.T:
            found[column[design.phrase][:, None], design.grounding] = True
    return found[:-1, :-1]
