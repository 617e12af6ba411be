"""The columns that named features have, and how phrases and groundings fire them."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass, field
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from dcg_torch import scene
from dcg_torch.grounding.features.names import (
    FEW,
    PAIRS,
    Feature,
    Group,
    Ranking,
    child_feature,
    fixed_groundings,
    fixed_languages,
    word_features,
)
from dcg_torch.grounding.features.said import Said, facts
from dcg_torch.grounding.psi import Bag
from dcg_torch.types import (
    LOOKED_ROUND,
    Child,
    Example,
    GroundingKind,
    Object,
    Phrase,
    PhraseKind,
    Symbol,
    WorldModel,
)


@dataclass(frozen=True)
class FeatureSet:
    """The columns of the log-linear model, and how phrases and groundings fire them.

    Attributes:
        groups: the feature groups that are switched on.
        language: name of each language column -> its index.
        grounding: name of each grounding column -> its index.
    """

    groups: frozenset[Group]
    language: dict[str, int] = field(default_factory=dict)
    grounding: dict[str, int] = field(default_factory=dict)

    @classmethod
    def initial(
        cls,
        groups: Iterable[Group],
        symbols: Iterable[Symbol],
        colors: Sequence[str],
        examples: Sequence[Example],
    ) -> FeatureSet:
        """The columns of a first training (Alg. 1, lines 3 and 4).

        Nouns, types and colours get columns from `symbols` and `colors` only, so that the invented ones of the
        examples that teach "unknown" stay unknown; verbs, prepositions and adjectives come from the examples.
        """
        start = cls(frozenset(groups))._with(fixed_languages(), fixed_groundings())
        return start.extended(symbols, colors, examples)

    def extended(self, symbols: Iterable[Symbol], colors: Sequence[str], examples: Iterable[Example]) -> FeatureSet:
        """Columns for a labelled corpus: its nouns, types and colours, its other words, attributes of things."""
        new = self
        for symbol in symbols:
            new = new.grow(symbol)
        for color in colors:
            new = new._with([(Group.COLOR, f"color: {color}")], [(Group.COLOR, f"color: {color}")])
        examples = list(examples)
        words = [f for example in examples for f in word_features(example.phrase)]
        worlds = {id(example.world): example.world for example in examples}.values()
        met = {a for world in worlds for o in world.objects for a in o.attributes} - {LOOKED_ROUND}
        further = [f"state: {attribute}" for attribute in sorted(met)]
        colored = [f"{of} color: {color}" for of in ("stack", "group") for color in colors]
        return new._with(words, [(Group.RELATION, name) for name in (*further, *colored)])

    def grow(self, symbol: Symbol) -> FeatureSet:
        """Columns for a learned symbol: f_word, f_obj and f_color (Alg. 1, lines 20 to 22)."""
        languages: list[Feature] = [(Group.DCG, f"noun: {symbol.word}")]
        groundings: list[Feature] = [(Group.DCG, f"type: {symbol.type}")]
        said = (symbol.color_word, symbol.color)
        languages += [(Group.COLOR, f"color: {word}") for word in said if word is not None]
        if symbol.color is not None:
            groundings.append((Group.COLOR, f"color: {symbol.color}"))
        return self._with(languages, groundings)

    def name_color(self, word: str, color: str) -> FeatureSet:
        """Columns for a learned colour: the word that is said, and the colour as it is perceived."""
        of_others = [(Group.RELATION, f"{of} color: {color}") for of in ("stack", "group")]
        seen = [(Group.COLOR, f"color: {color}"), *of_others]
        return self._with([(Group.COLOR, f"color: {word}")], seen)

    def include(
        self, *, nouns: Iterable[str] = (), types: Iterable[str] = (), colors: Iterable[str] = ()
    ) -> FeatureSet:
        """Columns for words heard and types met, not yet bound to one another; a colour has both."""
        of_colors = [(Group.COLOR, f"color: {c}") for c in colors]
        return self._with(
            [*((Group.DCG, f"noun: {n}") for n in nouns), *of_colors],
            [*((Group.DCG, f"type: {t}") for t in types), *of_colors],
        )

    def _with(self, languages: Iterable[Feature], groundings: Iterable[Feature]) -> FeatureSet:
        language, grounding = dict(self.language), dict(self.grounding)
        for table, features in ((language, languages), (grounding, groundings)):
            for group, name in features:
                if group in self.groups:
                    table.setdefault(name, len(table))
        return FeatureSet(self.groups, language, grounding)

    @property
    def shape(self) -> tuple[int, int]:
        """(L, G)."""
        return len(self.language), len(self.grounding)

    @property
    def pairs(self) -> NDArray[np.bool_]:
        """(L, G): which pairs of columns are features."""
        families = [name.partition(":")[0] for name in self.grounding]
        met = {family: [f in others for f in families] for family, others in PAIRS.items()}
        rows = [met[name.partition(":")[0]] for name in self.language]
        return np.array(rows, dtype=np.bool_).reshape(self.shape)

    @property
    def nouns(self) -> frozenset[str]:
        """The nouns that have a column."""
        found = (name.removeprefix("noun: ") for name in self.language if name.startswith("noun: "))
        return frozenset(found) - {"(unheard)"}

    def knows_noun(self, noun: str) -> bool:
        """Has this noun ever been grounded to a known type (Section III-A)?"""
        return f"noun: {noun}" in self.language

    def language_names(self, phrase: Phrase) -> list[str]:
        """Names of the language features that fire for a phrase."""
        names = [f"kind: {phrase.kind}", *(name for _, name in word_features(phrase))]
        if phrase.noun is not None:
            if self.knows_noun(phrase.noun):
                names += [f"noun: {phrase.noun}", "noun known: yes"]
            else:
                names += ["noun: (unheard)", "noun known: no"]
        if Group.NAMES in self.groups and phrase.kind is PhraseKind.NOUN:
            says = {"noun": phrase.noun is not None, "words": bool(phrase.words), "look": bool(phrase.look)}
            names += [f"{name} stated: yes" for name, is_said in says.items() if is_said]
        if phrase.color is not None:
            stated = f"color: {phrase.color}"
            names += ["color stated: yes", stated if stated in self.language else "color: unknown"]
            if Group.RELATION in self.groups:
                names += [f"color: {word}" for word in phrase.words]  # "the red and blue tower"
        return [name for name in names if name in self.language]

    def object_names(self, obj: Object, colors: Sequence[str] = ()) -> list[str]:
        """Names of the grounding features that fire for an object by itself; for a group, with its members' colours."""
        names = [f"type: {obj.type}", "known: yes"] if obj.known else ["type: (unmet)", "known: no"]
        if obj.hypothetical:
            names.append("hypothetical: yes")
            if LOOKED_ROUND in obj.attributes:
                names.append(f"hypothetical: {LOOKED_ROUND}")
        own = [f"color: {color}" for color in (colors or (obj.color,)) if color is not None]
        names += [name if name in self.grounding else "color: unknown" for name in own]
        return [name for name in dict.fromkeys(names) if name in self.grounding]

    def encode_phrases(self, phrases: Sequence[Phrase]) -> Bag:
        """(len(phrases), k) bag of language columns."""
        return _pad([[self.language[name] for name in self.language_names(phrase)] for phrase in phrases])

    def encode_groundings(
        self, kind: GroundingKind, world: WorldModel, children: Sequence[Sequence[Child]]
    ) -> NDArray[np.int64]:
        """Grounding columns of every grounding of `kind` in `world`, under every tuple of child groundings.

        Args:
            children: c hypotheses, each a tuple of equally many child groundings; one empty tuple for a leaf.

        Returns:
            (c, len(world.meanable), k) bag.
        """
        objects = world.meanable
        own = _pad(
            [
                [
                    self.grounding[name]
                    for name in (f"kind: {kind}", *(self.object_names(o) if kind is GroundingKind.OBJECT else ()))
                    if name in self.grounding
                ]
                for o in objects
            ]
        )
        slots = len(children[0])
        bag = np.full((len(children), len(objects), own.shape[1] + slots), -1, dtype=np.int64)
        bag[:, :, : own.shape[1]] = own
        index = {o.id: j for j, o in enumerate(objects)}
        for slot in range(slots):
            column = own.shape[1] + slot
            for c, hypothesis in enumerate(children):
                child = hypothesis[slot]
                other, same = (
                    self.grounding.get(child_feature(child.grounding.kind, child.correspondence, which)[1], -1)
                    for which in (False, True)
                )
                bag[c, :, column] = other
                bag[c, index[child.grounding.object.id], column] = same
        return bag

    def encode_things(self, world: WorldModel, where: scene.Layout) -> Bag:
        """Grounding columns of a noun phrase's groundings, groups and places included, whatever the phrase says.

        Args:
            where: the layout of `world`.

        Returns:
            (len(world.things), k) bag.
        """
        members = {o.id: o.color for o in world.objects}
        colors = [[c for m in o.members if (c := members[m]) is not None] for o in world.things]
        names = [
            [f"kind: {GroundingKind.OBJECT}", *self.object_names(o, of_members)]
            for o, of_members in zip(world.things, colors, strict=True)
        ]
        if Group.RELATION in self.groups:
            for own, more in zip(names, scene.states(where), strict=True):
                own += more
            for own, thing in zip(names[len(world.objects) :], world.things[len(world.objects) :], strict=True):
                own.append("kind: group" if thing.members else "kind: place")
        return self._bag(names)

    def encode_said(self, world: WorldModel, said: Said) -> Bag:
        """(len(world.things), k) bag: what the names of things say about a phrase."""
        return self._bag(facts(said, world.things))

    def encode_ranks(self, where: scene.Layout, ranking: Ranking, members: NDArray[np.bool_] | None) -> Bag:
        """(things, k) bag: the rank of every thing among those that are compared.

        Args:
            members: (things,) those that all the rest of the phrase describes; None: all that there are.
        """
        return self._ranks[scene.ranks(where, members, ordinal=ranking.ordinal, count=ranking.count)]

    def _bag(self, names: Iterable[Iterable[str]]) -> Bag:
        return _pad([[self.grounding[name] for name in own if name in self.grounding] for own in names])

    def encode_placed(
        self, where: scene.Layout, landmarks: Sequence[Sequence[int]], ranking: Ranking | None
    ) -> NDArray[np.int64]:
        """Grounding columns of a modifier's groundings: how every thing stands to every tuple of landmarks.

        Args:
            landmarks: c tuples of thing numbers.
            ranking: what the phrase counts that the modifier describes.

        Returns:
            (c, things, k) bag.
        """
        n, ranking = len(where.things), ranking or Ranking("all")
        columns = [np.full((len(landmarks), n, 1), self.grounding[f"kind: {GroundingKind.PLACED}"], dtype=np.int64)]
        if Group.RELATION in self.groups:
            found = scene.relations(where, landmarks, ranking.among)
            columns.append(self._relations[found])
            if ranking.count is not None and ranking.count > 1:
                columns.append(np.where(self._rank_of[found] < ranking.count, self._few[found], -1))
        return np.concatenate(columns, axis=2)

    @cached_property
    def _ranks(self) -> NDArray[np.int64]:
        """Index into `scene.RANKS` -> column; a last entry for -1."""
        return np.array([*(self.grounding.get(name, -1) for name in scene.RANKS), -1])

    @cached_property
    def _relations(self) -> NDArray[np.int64]:
        """Index into `scene.RELATION_NAMES` -> column; a last entry for -1."""
        return np.array([*(self.grounding.get(name, -1) for name in scene.RELATION_NAMES), -1])

    @cached_property
    def _few(self) -> NDArray[np.int64]:
        """Index into `scene.RELATION_NAMES` -> column of the "few" of its family, -1 for most families."""
        found = [self.grounding.get(FEW.get(f, ""), -1) for f, names in scene.RELATIONS.items() for _ in names]
        return np.array([*found, -1])

    @cached_property
    def _rank_of(self) -> NDArray[np.int64]:
        """Index into `scene.RELATION_NAMES` -> the number of the value in its family."""
        return np.array([*(k for names in scene.RELATIONS.values() for k in range(len(names))), 0])


def _pad(rows: list[list[int]]) -> Bag:
    """Rows of columns as one array, padded with -1."""
    bag = np.full((len(rows), max(map(len, rows), default=0)), -1, dtype=np.int64)
    for row, columns in zip(bag, rows, strict=True):
        row[: len(columns)] = columns
    return bag
