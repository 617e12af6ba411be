"""The columns that named features have, and how phrases and groundings fire them."""

from __future__ import annotations

import itertools
from collections.abc import Hashable, Iterable, Sequence
from dataclasses import dataclass, field
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from dcg_torch import scene
from dcg_torch.fitting.psi import Bag
from dcg_torch.grounding.features.name_facts import Said, facts
from dcg_torch.grounding.features.names import (
    PAIRS,
    Feature,
    Group,
    Ranking,
    child_feature,
    fixed_groundings,
    fixed_languages,
    scene_features,
    word_features,
)
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
from dcg_torch.types.arrays import Bools, Ints

KindColumns = dict[Hashable, list[int]]
"""What things are apart from their types -> the grounding columns of that."""


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

    def extended(
        self, symbols: Iterable[Symbol], colors: Sequence[str], examples: Iterable[Example], *, scenes: bool = False
    ) -> FeatureSet:
        """Columns for a labelled corpus: its nouns, types and colours, its other words, attributes of things.

        Args:
            scenes: words have columns for the kinds of scenes that they are said in, too.
        """
        new = self
        for symbol in symbols:
            new = new.grow(symbol)
        for color in colors:
            new = new._with([(Group.COLOR, f"color: {color}")], [(Group.COLOR, f"color: {color}")])
        examples = list(examples)
        phrases = dict.fromkeys([example.phrase for example in examples])
        words = [f for phrase in phrases for f in word_features(phrase)]
        words += [f for phrase in phrases for f in scene_features(phrase) if scenes]
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
        tables = []
        for table, features in ((self.language, languages), (self.grounding, groundings)):
            new = dict.fromkeys([name for group, name in features if name not in table and group in self.groups])
            tables.append({**table, **dict(zip(new, itertools.count(len(table))))} if new else table)
        language, grounding = tables
        same = language is self.language and grounding is self.grounding
        return self if same else FeatureSet(self.groups, language, grounding)

    @property
    def shape(self) -> tuple[int, int]:
        """(L, G) how many language and grounding columns there are."""
        return len(self.language), len(self.grounding)

    @property
    def pairs(self) -> Bools:
        """(L, G): which pairs of columns are features."""
        (left, rows), (right, columns) = _families(self.language), _families(self.grounding)
        met = np.array([[f in PAIRS[family] for f in right] for family in left], dtype=np.bool_)
        found: Bools = met.reshape(len(left), len(right)).take(rows, axis=0).take(columns, axis=1)
        return found

    @cached_property
    def nouns(self) -> frozenset[str]:
        """The nouns that have a column."""
        found = (name.removeprefix("noun: ") for name in self.language if name.startswith("noun: "))
        return frozenset(found) - {"(unheard)"}

    def knows_noun(self, noun: str) -> bool:
        """Has this noun ever been grounded to a known type (Section III-A)?"""
        return f"noun: {noun}" in self.language

    def language_names(self, phrase: Phrase) -> list[str]:
        """Names of the language features that fire for a phrase."""
        said = (*word_features(phrase), *scene_features(phrase))
        names = [f"kind: {phrase.kind}", *(name for _, name in said)]
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
        return padded([[self.language[name] for name in self.language_names(phrase)] for phrase in phrases])

    def encode_groundings(self, kind: GroundingKind, world: WorldModel, children: Sequence[Sequence[Child]]) -> Ints:
        """Grounding columns of every region or action in `world`, under every tuple of child groundings.

        Args:
            children: c hypotheses, each a tuple of equally many child groundings; one empty tuple for a leaf.

        Returns:
            (c, len(world.meanable), k) bag.
        """
        rows: list[list[int]] = []
        for hypothesis in children:
            about = [child.grounding.object.id for child in hypothesis]
            none = self.action_columns(kind, hypothesis, [False] * len(about))
            own = {id_: self.action_columns(kind, hypothesis, [id_ == a for a in about]) for id_ in about}
            rows += [own.get(o.id, none) for o in world.meanable]
        bag = padded(rows)
        return bag.reshape(len(children), -1, bag.shape[1])

    def action_columns(self, kind: GroundingKind, children: Sequence[Child], same: Sequence[bool]) -> list[int]:
        """Grounding columns of one region or action.

        Args:
            children: the child groundings.
            same: of each, is it about the same object?
        """
        names = [child_feature(c.grounding.kind, c.correspondence, s)[1] for c, s in zip(children, same, strict=True)]
        return self._columns((f"kind: {kind}", *names))

    def thing_columns(self, thing: Object, states: Iterable[str] = (), colors: Sequence[str] = ()) -> list[int]:
        """Grounding columns of a noun phrase's grounding, a group's and a place's too, whatever the phrase says.

        Args:
            states: names of what else is true of it.
            colors: of a group, those of its members.
        """
        names = (f"kind: {GroundingKind.OBJECT}", *self.object_names(thing, colors), *states)
        return self._columns(names)

    def object_columns(
        self, things: Sequence[Object], states: Sequence[tuple[str, ...]], kinds: KindColumns
    ) -> list[list[int]]:
        """The columns of several objects: what has nothing to do with their types is looked up once for those alike.

        Args:
            states: of each, names of what else is true of it.
            kinds: what was found before under these columns; more is added.
        """
        rows = []
        for thing, own in zip(things, states, strict=True):
            key = (
                thing.type if thing.known else None,
                thing.known,
                thing.hypothetical,
                thing.color,
                thing.attributes,
                own,
            )
            found = kinds.get(key)
            if found is None:
                found = kinds[key] = self._object_columns(thing, own, kinds)
            rows.append(found)
        return rows

    def _object_columns(self, thing: Object, states: tuple[str, ...], kinds: KindColumns) -> list[int]:
        key = thing.known, thing.hypothetical, thing.color, thing.attributes, states
        column = self.grounding.get(f"type: {thing.type}") if thing.known else None
        common = kinds.get(key)
        if common is None:
            common = kinds[key] = [c for c in self.thing_columns(thing, states) if c != column]
        return common if column is None else sorted((*common, column))

    def said_columns(
        self, said: Said, things: Sequence[Object], looks: Sequence[int], kinds: KindColumns | None = None
    ) -> list[list[int]]:
        """Columns of what the names of things say about a phrase.

        Args:
            looks: of each thing, see `target_descriptions.look_codes`.
            kinds: what was found before under these columns, of things that are called alike; more is added.
        """
        kinds, denies = {} if kinds is None else kinds, said.denies()
        (what,) = kinds.setdefault(said, [len(kinds)])  # a number takes less to hash, once for each thing
        rows = []
        for thing, look in zip(things, looks, strict=True):
            key = what, thing.type, thing.color, thing.attributes, look, thing.rgb if denies else None
            columns = kinds.get(key)
            if columns is None:
                columns = kinds[key] = self._columns(facts(said, thing, look))
            rows.append(columns)
        return rows

    def encode_ranks(self, where: scene.Layout, ranking: Ranking, members: Bools | None) -> Bag:
        """(things, k) bag: the rank of every thing among those that are compared.

        Args:
            members: (things,) those that all the rest of the phrase describes; None: all that there are.
        """
        return self.rank_of[scene.ranks(where, members, ordinal=ranking.ordinal, count=ranking.count)]

    def _columns(self, names: Iterable[str]) -> list[int]:
        """Each once, in the order of the columns."""
        number = self.grounding.get
        return sorted({column for name in names if (column := number(name)) is not None})

    def relation_columns(self, found: NDArray[np.int16]) -> Ints:
        """(..., k) grounding columns of a modifier's groundings, by relations (..., families) of `scene.relations`."""
        columns = [np.full((*found.shape[:-1], 1), self.placed_column), self.relation_of[found]]
        return np.concatenate(columns, axis=-1)

    @property
    def placed_column(self) -> int:
        """The column that fires for every grounding of a modifier."""
        return self.grounding[f"kind: {GroundingKind.PLACED}"]

    @cached_property
    def rank_of(self) -> Ints:
        """(ranks + 1,) index into `scene.RANKS` -> column; a last entry for -1."""
        return np.array([*(self.grounding.get(name, -1) for name in scene.RANKS), -1])

    @cached_property
    def relation_of(self) -> Ints:
        """(relations + 1,) index into `scene.RELATION_NAMES` -> column; a last entry for -1."""
        return np.array([*(self.grounding.get(name, -1) for name in scene.RELATION_NAMES), -1])


def _families(names: Iterable[str]) -> tuple[list[str], list[int]]:
    """The families of features, each once, and the number of each feature's own."""
    number: dict[str, int] = {}
    numbers = [number.setdefault(name.partition(":")[0], len(number)) for name in names]
    return list(number), numbers


def padded(rows: Sequence[Sequence[int]]) -> Bag:
    """Rows of columns as one array, padded with -1."""
    filled = list(itertools.zip_longest(*rows, fillvalue=-1))
    return np.array(filled, dtype=np.int64).reshape(len(filled), len(rows)).T.copy()
