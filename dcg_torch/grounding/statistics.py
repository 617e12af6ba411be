"""Labelled factors as sufficient statistics of a fit: what features see of phrases and groundings, and sums of labels.

A retraining differs from the one before by a few examples. So what features see of an example is found once; a fit adds
up what is counted of each pair of a phrase and a grounding; columns are looked up for what is new, or was unknown.
"""

from __future__ import annotations

import itertools
import operator
from collections.abc import Callable, Hashable, Iterable, Sequence
from dataclasses import dataclass
from typing import Any, TypeVar

import numpy as np

from dcg_torch.fitting.design import DesignMatrix
from dcg_torch.fitting.psi import Bag
from dcg_torch.grounding.encoding import encode
from dcg_torch.grounding.features import GROUNDING_OF, FeatureSet, Group, Said, child_feature, ranking
from dcg_torch.grounding.features.name_facts import facts
from dcg_torch.types import Correspondence, Example, GroundingKind, Object, Phrase, PhraseKind
from dcg_torch.types.arrays import Bools, Floats, Ints

Value = TypeVar("Value")

_UNSEEN = -1
"""Of a thing whose colour no phrase judges by how it looks."""
_LABELS = 3
_Own = tuple[str | None, bool, bool, str | None, frozenset[str]]
Seen = tuple[GroundingKind, _Own | None, tuple[str, ...]]
"""What features see of a grounding: its kind; an object's type, known, hypothetical, colour, attributes; more names."""
_Kept = tuple[Example, list[int], list[float]]
"""An example, the pair and label of each of its labelled factors as one number, and the weight of each."""
_Counted = tuple[Ints, Ints, Floats]
"""Of n pairs, the phrase, what is seen of the grounding, and (P, n) the weight of each label."""


@dataclass(frozen=True)
class SoftLabels:
    """Every one of some phrases with every one of some objects that stand nowhere, and how much is counted of it.

    Attributes:
        active, inactive: (phrases, objects) summed weights of the examples with either label.
        shown: (phrases, objects) which pairs there are; None: all.
    """

    phrases: Sequence[Phrase]
    objects: Sequence[Object]
    active: Floats
    inactive: Floats
    shown: Bools | None = None


class Statistics:
    """Turns examples into the rows of a fit; what it has seen of them it keeps.

    Args:
        groups: the feature groups that are on, which say what features see.
    """

    def __init__(self, groups: frozenset[Group]) -> None:
        self._groups = groups
        self._phrases = _Columns()
        self._seen = _Columns()
        self._pairs: dict[tuple[int, int], int] = {}
        self._pair_of: Ints = np.zeros((0, 2), dtype=np.int64)
        self._kept: dict[int, _Kept] = {}
        self._objects: dict[Object, int] = {}
        self._of_phrase: dict[int, Ints] = {}
        self._related: dict[tuple[Hashable, ...], dict[tuple[bool, ...], int]] = {}
        self._came: dict[int, tuple[Any, int]] = {}
        self._sorted: tuple[list[Example], list[_Kept], list[Example]] = [], [], []
        self._joined: tuple[Sequence[_Kept], Ints, Floats] = ((), np.zeros(0, dtype=np.int64), np.zeros(0))

    def copy(self) -> Statistics:
        """Another that knows the same, and goes its own way from here."""
        other = Statistics(self._groups)
        other._phrases, other._seen = self._phrases.copy(), self._seen.copy()
        other._pairs, other._kept, other._objects = dict(self._pairs), dict(self._kept), dict(self._objects)
        other._pair_of, other._joined, other._came = self._pair_of, self._joined, dict(self._came)
        other._of_phrase = {phrase: seen.copy() for phrase, seen in self._of_phrase.items()}
        return other

    def designs(
        self,
        examples: Iterable[Example],
        soft: Iterable[SoftLabels],
        features: FeatureSet,
        correspondences: Sequence[Correspondence],
    ) -> list[DesignMatrix]:
        """The labelled factors of examples and soft labels under the given columns."""
        plain, others = self._plain_and_others(list(examples))
        at = [int(c) + 1 for c in correspondences]
        parts = [self._of_examples(plain, at), *(self._of_soft(labels, at) for labels in soft)]
        phrase, seen, count = (np.concatenate(part, axis=-1) for part in zip(*parts, strict=True))
        language = self._phrases.bag(features, _phrase_columns)
        grounding = self._seen.bag(features, _seen_columns)
        return [DesignMatrix(language, grounding[seen], phrase, count), *encode(others, features, correspondences)]

    def _plain_and_others(self, examples: list[Example]) -> tuple[list[_Kept], list[Example]]:
        """What is kept of plain examples, and the examples that are not plain; of those that came before as it was."""
        before, plain, others = self._sorted
        if len(before) <= len(examples) and all(map(operator.is_, before, examples)):
            new, plain, others, kept = examples[len(before) :], [*plain], [*others], self._kept
        else:
            new, plain, others, kept = examples, [], [], {}
        for example in new:
            found = self._kept.get(id(example))
            if found is None or found[0] is not example:
                if not self._is_plain(example):
                    others.append(example)
                    continue
                found = (example, *self._encoded(example))  # it is held, so that no other gets its id meanwhile
            kept[id(example)] = found
            plain.append(found)
        self._kept, self._sorted = kept, (examples, plain, others)
        return plain, others

    def _of_examples(self, plain: Sequence[_Kept], at: Sequence[int]) -> _Counted:
        before, codes, weights = self._joined
        if len(before) > len(plain) or not all(map(operator.is_, before, plain)):
            before, codes, weights = (), codes[:0], weights[:0]
        new = plain[len(before) :]
        codes = np.concatenate([codes, np.array([code for _, own, _ in new for code in own], dtype=np.int64)])
        weights = np.concatenate([weights, [weight for _, _, own in new for weight in own]])
        self._joined = plain, codes, weights
        total: Floats = np.bincount(codes, weights, minlength=_LABELS * len(self._pairs)).astype(np.float64)
        count = total.reshape(-1, _LABELS).T
        if len(self._pairs) > len(self._pair_of):
            further = list(itertools.islice(self._pairs, len(self._pair_of), None))
            self._pair_of = np.concatenate([self._pair_of, np.array(further, dtype=np.int64)])
        used: Ints = np.flatnonzero(count.any(axis=0))
        pairs = self._pair_of[used]
        return pairs[:, 0], pairs[:, 1], count[at][:, used]

    def _of_soft(self, labels: SoftLabels, at: Sequence[int]) -> _Counted:
        phrases = np.array(self._numbers(labels.phrases, self._phrases.number), dtype=np.int64)
        if Group.NAMES in self._groups:
            things = self._numbers(labels.objects, self._number_of)
            seen = np.stack([self._with_facts(p, things, labels.objects) for p in phrases.tolist()])
        else:
            own = self._numbers(labels.objects, lambda o: self._seen.number(_of_object(o, ())))
            seen = np.broadcast_to(np.array(own, dtype=np.int64), labels.active.shape)
        which = np.flatnonzero(np.ones(labels.active.size, np.bool_) if labels.shown is None else labels.shown)
        count = np.zeros((_LABELS, len(which)))
        count[1 + Correspondence.INACTIVE] = labels.inactive.reshape(-1)[which]
        count[1 + Correspondence.ACTIVE] = labels.active.reshape(-1)[which]
        return np.repeat(phrases, len(labels.objects))[which], seen.reshape(-1)[which], count[at]

    def _numbers(self, values: Sequence[Value], find: Callable[[Value], int]) -> list[int]:
        """The number that `find` gives to each; those that came before, as the same objects, are not looked up anew."""
        numbers = []
        for value in values:
            came = self._came.get(id(value))
            if came is None or came[0] is not value:
                came = self._came[id(value)] = value, find(value)
            numbers.append(came[1])
        return numbers

    def _number_of(self, thing: Object) -> int:
        return self._objects.setdefault(thing, len(self._objects))

    def _with_facts(self, phrase: int, things: Sequence[int], objects: Sequence[Object]) -> Ints:
        """(things,) what features see of them beside a phrase that says something of their names."""
        known = self._of_phrase.get(phrase, np.zeros(0, dtype=np.int64))
        if len(known) < len(self._objects):
            known = np.pad(known, (0, 2 * len(self._objects) - len(known)), constant_values=-1)
            self._of_phrase[phrase] = known
        found: Ints = known[things]
        for k in np.flatnonzero(found < 0).tolist():
            more = facts(Said.of(self._phrases.keys[phrase]), objects[k], _UNSEEN)
            found[k] = known[things[k]] = self._seen.number(_of_object(objects[k], more))
        return found

    def _is_plain(self, example: Example) -> bool:
        """Does what features see of its groundings depend on nothing but each by itself?"""
        phrase, world = example.phrase, example.world
        if phrase.kind is PhraseKind.MODIFIER:
            return False
        if phrase.kind is not PhraseKind.NOUN:
            return True
        if phrase.look or world.groups:
            return False
        nowhere = not world.places and all(o.position is None for o in world.objects) and ranking(phrase) is None
        return nowhere or Group.RELATION not in self._groups

    def _encoded(self, example: Example) -> tuple[list[int], list[float]]:
        """The pair and label of each labelled factor, as one number, and its weight."""
        phrase, kind = self._phrases.number(example.phrase), GROUNDING_OF[example.phrase.kind]
        labels = [label for label in example.correspondences if label is not None]
        labelled = [j for j, label in enumerate(example.correspondences) if label is not None]
        of_things = kind is GroundingKind.OBJECT
        seen = self._of_things(example, labelled) if of_things else self._of_children(example, kind, labelled)
        pairs = [self._pairs.setdefault((phrase, number), len(self._pairs)) for number in seen]
        codes = [_LABELS * pair + label + 1 for pair, label in zip(pairs, labels, strict=True)]
        whole, own = example.weight, example.weights
        return codes, [whole] * len(codes) if own is None else [whole * own[j] for j in labelled]

    def _of_things(self, example: Example, numbers: Sequence[int]) -> list[int]:
        """What is seen of some groundings of a noun phrase."""
        named, things, said = Group.NAMES in self._groups, example.world.things, Said.of(example.phrase)
        more = [facts(said, things[j], _UNSEEN) if named else () for j in numbers]
        return [self._seen.number(_of_object(things[j], own)) for j, own in zip(numbers, more, strict=True)]

    def _of_children(self, example: Example, kind: GroundingKind, numbers: Sequence[int]) -> list[int]:
        """What is seen of some groundings of a verb or a preposition: is each about the same object as a child's?"""
        about = [c.grounding.object.id for c in example.children]
        such = (kind._value_, *[(c.grounding.kind._value_, c.correspondence._value_) for c in example.children])
        found = self._related.setdefault(such, {})
        things = example.world.meanable
        of_each = [tuple([one == things[j].id for one in about]) for j in numbers]
        for same in [one for one in dict.fromkeys(of_each) if one not in found]:
            found[same] = self._seen.number(_of_relations(example, kind, same))
        return [found[same] for same in of_each]


class _Columns:
    """The columns that fire for each of some keys, as a bag; those of a key that is known in full stay for ever."""

    def __init__(self) -> None:
        self.keys: list[Any] = []
        self._number: dict[Hashable, int] = {}
        self._bag: Bag = np.zeros((0, 0), dtype=np.int64)
        self._open: list[int] = []
        self._done = 0
        self._features: FeatureSet | None = None

    def copy(self) -> _Columns:
        """Another with the same keys."""
        other = _Columns()
        other.keys, other._number, other._bag = list(self.keys), dict(self._number), self._bag.copy()
        other._open, other._done, other._features = self._open, self._done, self._features
        return other

    def number(self, key: Hashable) -> int:
        """Its row."""
        found = self._number.setdefault(key, len(self.keys))
        if found == len(self.keys):
            self.keys.append(key)
        return found

    def bag(self, features: FeatureSet, find: Callable[[Any, FeatureSet], tuple[list[int], bool]]) -> Bag:
        """(keys, k) under the given columns, which only ever become more.

        Args:
            find: the columns of a key, and whether further columns can change them.
        """
        before = [] if features is self._features else self._open
        todo = [*before, *range(self._done, len(self.keys))]
        rows = [find(self.keys[k], features) for k in todo]
        size, width = self._bag.shape
        wider = max([0, *(len(columns) - width for columns, _ in rows)])
        longer = len(self.keys) - size
        if wider or longer > 0:
            grown = (0, 2 * longer if longer > 0 else 0), (0, wider)
            self._bag = np.pad(self._bag, grown, constant_values=-1)
        for k, (columns, _) in zip(todo, rows, strict=True):
            self._bag[k] = -1
            self._bag[k, : len(columns)] = columns
        still = [k for k, (_, may_change) in zip(todo, rows, strict=True) if may_change]
        self._open = still if features is not self._features else [*self._open, *still]
        self._done, self._features = len(self.keys), features
        return self._bag[: len(self.keys)]


def _of_object(thing: Object, more: Iterable[str]) -> Seen:
    own = thing.type, thing.known, thing.hypothetical, thing.color, thing.attributes
    return GroundingKind.OBJECT, own, tuple(more)


def _of_relations(example: Example, kind: GroundingKind, same: Sequence[bool]) -> Seen:
    """What is seen of a grounding that is about the same object as some children's, or not."""
    children = zip(example.children, same, strict=True)
    return kind, None, tuple([child_feature(c.grounding.kind, c.correspondence, own)[1] for c, own in children])


def _seen_columns(seen: Seen, features: FeatureSet) -> tuple[list[int], bool]:
    kind, own, more = seen
    names, may_change = [f"kind: {kind}"], False
    if own is not None:
        type_, known, hypothetical, color, attributes = own
        names += features.object_names(Object("", type_, known, hypothetical, color, attributes=attributes))
        names += [f"state: {attribute}" for attribute in sorted(attributes)]
        met = not known or f"type: {type_}" in features.grounding
        may_change = not met or bool(attributes) or (color is not None and f"color: {color}" not in features.grounding)
    columns = (features.grounding.get(name) for name in (*names, *more))
    return [c for c in columns if c is not None], may_change


def _phrase_columns(phrase: Phrase, features: FeatureSet) -> tuple[list[int], bool]:
    met = phrase.noun is None or features.knows_noun(phrase.noun)
    named = phrase.color is None or f"color: {phrase.color}" in features.language
    may_change = not (met and named) or bool(phrase.words or phrase.context)
    return [features.language[name] for name in features.language_names(phrase)], may_change
