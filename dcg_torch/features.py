"""Named binary features of phrases and of groundings, and the columns they have.

A feature f of the paper is a pair (language feature, grounding feature). The feature groups of eqs. 4 to 9 say
which names may fire:

    F_DCG            the words of a phrase, the type of a known object, how a grounding relates to its children
    F_U              is the noun known, is the object's type known
    F_H              is the object hypothetical
    F_C              the stated colour (f_word) and the object's colour (f_color)
    relation         beyond the paper: how things stand by themselves, among those alike, and to landmarks (`space`)

and `PAIRS` which of them meet: a noun with types, a stated colour with colours, a verb with the relation to its
child. Without that restriction a word learned from one blue object would come to mean "blue" as well.

What is known is a fact about the columns: a noun or colour without a column of its own fires the "unknown"
feature instead. Columns are only ever appended, so old indices stay valid.
"""

from __future__ import annotations

import enum
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass, field
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from dcg_torch import space
from dcg_torch.loglinear import Bag
from dcg_torch.symbols import (
    NOT,
    Child,
    Correspondence,
    Example,
    Grounding,
    GroundingKind,
    Object,
    Phrase,
    PhraseKind,
    Symbol,
    WorldModel,
)


class Group(enum.StrEnum):
    """The feature groups; the first four are the paper's."""

    DCG = "dcg"
    UNKNOWN = "unknown"
    HYPOTHETICAL = "hypothetical"
    COLOR = "color"
    RELATION = "relation"
    OPEN = "open"  # what has never been heard or met has columns too, and so has a look all round


LOOKED_ROUND = "looked round"
"""Attribute of a hypothetical object, once the robot has seen all the ground that it can."""


# The family of a feature is what stands before the colon of its name. A language family meets these grounding
# families; all other pairs are no features and keep a weight of zero.
PAIRS: dict[str, frozenset[str]] = {
    "kind": frozenset({"kind", "known", "hypothetical", "child"}),
    "verb": frozenset({"kind", "child"}),
    "preposition": frozenset({"kind", "child"}),
    "modifier": frozenset({"kind", "relation"}),
    "word": frozenset({"rank", "state", "part", "stack color", "group color"}),
    "context": frozenset({"kind", "state", "relation"}),
    "landmark": frozenset({"kind"}),  # what states landmarks are in is chance, which a corpus has plenty of
    "noun": frozenset({"type", "part"}),
    "noun known": frozenset({"known", "hypothetical"}),
    "color": frozenset({"color", "group color"}),
    "color stated": frozenset({"kind", "known", "hypothetical", "color"}),
}

FEW = {family: f"relation: {family} few" for family in ("closest", "farthest")}
"""Family of ranks by distance -> the name of the feature of the first few, as many as the phrase counts."""
_ORDINALS = {
    **{"first": 1, "second": 2, "third": 3, "fourth": 4, "fifth": 5},
    **{"sixth": 6, "seventh": 7, "eighth": 8, "ninth": 9, "tenth": 10},
}

PAPER = frozenset({Group.DCG, Group.UNKNOWN, Group.HYPOTHETICAL, Group.COLOR})
"""The feature groups of the paper's fullest model, DCG-UPUP-Away with colour."""

GROUNDING_OF = {
    PhraseKind.VERB: GroundingKind.ACTION,
    PhraseKind.PREPOSITION: GroundingKind.REGION,
    PhraseKind.NOUN: GroundingKind.OBJECT,
    PhraseKind.MODIFIER: GroundingKind.PLACED,
}

Feature = tuple[Group, str]


def child_feature(kind: GroundingKind, correspondence: Correspondence, same: bool) -> Feature:
    """The relation of a grounding to one child grounding: of which kind, how it corresponds, same object?"""
    return Group.DCG, f"child: {kind}, {'same' if same else 'other'}, {correspondence.name.lower()}"


def _fixed_groundings() -> Iterator[Feature]:
    """The grounding features that exist whatever has been learned."""
    for kind in GroundingKind:
        yield Group.DCG, f"kind: {kind}"
        for correspondence in (Correspondence.ACTIVE, Correspondence.INVERTED):
            for same in (True, False):
                yield child_feature(kind, correspondence, same)
    yield Group.UNKNOWN, "known: yes"
    yield Group.UNKNOWN, "known: no"
    yield Group.COLOR, "color: unknown"
    yield Group.HYPOTHETICAL, "hypothetical: yes"
    for name in (*space.RELATION_NAMES, *FEW.values(), *space.STATES, *space.RANKS):
        yield Group.RELATION, name
    yield Group.RELATION, "kind: place"
    yield Group.RELATION, "kind: group"
    yield Group.OPEN, f"hypothetical: {LOOKED_ROUND}"
    yield Group.OPEN, "type: (unmet)"


def _fixed_languages() -> Iterator[Feature]:
    """The language features that exist whatever has been learned."""
    for kind in PhraseKind:
        yield Group.DCG, f"kind: {kind}"
    yield Group.UNKNOWN, "noun known: yes"
    yield Group.UNKNOWN, "noun known: no"
    yield Group.COLOR, "color: unknown"
    yield Group.COLOR, "color stated: yes"
    yield Group.OPEN, "noun: (unheard)"


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
        start = cls(frozenset(groups))._with(_fixed_languages(), _fixed_groundings())
        return start.extended(symbols, colors, examples)

    def extended(self, symbols: Iterable[Symbol], colors: Sequence[str], examples: Iterable[Example]) -> FeatureSet:
        """Columns for a labelled corpus: its nouns, types and colours, its other words, attributes of things."""
        new = self
        for symbol in symbols:
            new = new.grow(symbol)
        for color in colors:
            new = new._with([(Group.COLOR, f"color: {color}")], [(Group.COLOR, f"color: {color}")])
        examples = list(examples)
        words = [f for example in examples for f in _word_features(example.phrase)]
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

    def joined(self, other: FeatureSet) -> FeatureSet:
        """With the columns of another set of the same groups, behind its own."""
        language, grounding = dict(self.language), dict(self.grounding)
        for table, names in ((language, other.language), (grounding, other.grounding)):
            for name in names:
                table.setdefault(name, len(table))
        return FeatureSet(self.groups, language, grounding)

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
        names = [f"kind: {phrase.kind}", *(name for _, name in _word_features(phrase))]
        if phrase.noun is not None:
            if self.knows_noun(phrase.noun):
                names += [f"noun: {phrase.noun}", "noun known: yes"]
            else:
                names += ["noun: (unheard)", "noun known: no"]
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

    def encode_things(self, world: WorldModel, where: space.Layout, ranking: Ranking | None) -> Bag:
        """Grounding columns of a noun phrase's groundings, groups and places included.

        Args:
            where: the layout of `world`.
            ranking: what the phrase counts, if it has words that a rank could be meant by.

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
            for own, more in zip(names, space.states(where), strict=True):
                own += more
            for own, thing in zip(names[len(world.objects) :], world.things[len(world.objects) :], strict=True):
                own.append("kind: group" if thing.members else "kind: place")
        bag = _pad([[self.grounding[name] for name in own if name in self.grounding] for own in names])
        if ranking is None or Group.RELATION not in self.groups:
            return bag
        found = space.ranks(where, ranking.among, ordinal=ranking.ordinal, count=ranking.count)
        return np.hstack([bag, self._ranks[found]])

    def encode_placed(
        self, where: space.Layout, landmarks: Sequence[Sequence[int]], ranking: Ranking | None
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
            found = space.relations(where, landmarks, ranking.among)
            columns.append(self._relations[found])
            if ranking.count is not None and ranking.count > 1:
                columns.append(np.where(self._rank_of[found] < ranking.count, self._few[found], -1))
        return np.concatenate(columns, axis=2)

    @cached_property
    def _ranks(self) -> NDArray[np.int64]:
        """Index into `space.RANKS` -> column; a last entry for -1."""
        return np.array([*(self.grounding.get(name, -1) for name in space.RANKS), -1])

    @cached_property
    def _relations(self) -> NDArray[np.int64]:
        """Index into `space.RELATION_NAMES` -> column; a last entry for -1."""
        return np.array([*(self.grounding.get(name, -1) for name in space.RELATION_NAMES), -1])

    @cached_property
    def _few(self) -> NDArray[np.int64]:
        """Index into `space.RELATION_NAMES` -> column of the "few" of its family, -1 for most families."""
        found = [self.grounding.get(FEW.get(f, ""), -1) for f, names in space.RELATIONS.items() for _ in names]
        return np.array([*found, -1])

    @cached_property
    def _rank_of(self) -> NDArray[np.int64]:
        """Index into `space.RELATION_NAMES` -> the number of the value in its family."""
        return np.array([*(k for names in space.RELATIONS.values() for k in range(len(names))), 0])

    def grounding_names(self, grounding: Grounding, children: Sequence[Child]) -> list[str]:
        """Names of the grounding features that fire, for explanations."""
        world = WorldModel(
            tuple({o.id: o for o in (grounding.object, *(c.grounding.object for c in children))}.values())
        )
        names = list(self.grounding)
        row = self.encode_groundings(grounding.kind, world, [children])[0, 0]
        return [names[column] for column in row if column >= 0]


@dataclass(frozen=True, slots=True)
class Ranking:
    """What a phrase counts: the nth (`ordinal`) or the first few (`count`) among those that it speaks of (`among`)."""

    among: str
    ordinal: int | None = None
    count: int | None = None


def ranking(phrase: Phrase) -> Ranking | None:
    """What a noun phrase or a modifier counts; None for a noun phrase without a word that could mean a rank."""
    if phrase.kind is PhraseKind.NOUN and not phrase.words:
        return None
    ordinal = next((_ORDINALS[word] for word in phrase.words if word in _ORDINALS), None)
    return Ranking(phrase.among or "all", ordinal, phrase.count)


def _word_features(phrase: Phrase) -> Iterator[Feature]:
    """The language features of a phrase's plain words; a noun's and a colour's depend on what is known.

    Words of a noun phrase also fire together ("second from the left"), and modifiers and such words together with
    the context: what they compare the object with.
    """
    is_noun = phrase.kind is PhraseKind.NOUN
    words = [word for word in phrase.words if word != NOT or phrase.kind is not PhraseKind.MODIFIER]
    for word in words:
        yield (Group.RELATION, f"word: {word}") if is_noun else (Group.DCG, f"{phrase.kind}: {word}")
    if is_noun and len(words) > 1:
        yield Group.RELATION, f"word: {' '.join(words)}"
    for context in phrase.context:
        yield Group.RELATION, context if context.startswith("landmark: ") else f"context: {context}"
        if not is_noun:
            for word in words:
                yield Group.RELATION, f"{phrase.kind}: {word}, {context}"


def _pad(rows: list[list[int]]) -> Bag:
    """Rows of columns as one array, padded with -1."""
    bag = np.full((len(rows), max(map(len, rows), default=0)), -1, dtype=np.int64)
    for row, columns in zip(bag, rows, strict=True):
        row[: len(columns)] = columns
    return bag
