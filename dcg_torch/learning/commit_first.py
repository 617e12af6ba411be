"""The paper's learner, Algorithm 1, lines 16 to 25: an unknown noun names the first unknown thing that it met."""

from __future__ import annotations

import functools
from collections.abc import Collection, Iterable, Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np

from dcg_torch.grounding.features import FeatureSet, Group
from dcg_torch.grounding.solution import Solution
from dcg_torch.grounding.statistics import SoftLabels
from dcg_torch.learning.census import FrameCounts
from dcg_torch.learning.evidence import Ground
from dcg_torch.learning.labelling import labelled
from dcg_torch.learning.learner import Experience, Learned, Taught, TrainingSet
from dcg_torch.learning.lexicon import Entry
from dcg_torch.types import Child, Correspondence, Example, Grounding, Object, Phrase, PhraseKind, Symbol, WorldModel
from dcg_torch.types.arrays import Bools


@dataclass(frozen=True)
class CommitFirst:
    """Keeps the training set T and the symbols M.Gamma. It believes what it did, for ever.

    Attributes:
        symbols: word -> symbol, in the order of learning.
        examples: T.
        learns_symbols: are unknown phrases represented, so that symbols can be learned (DCG-UPUP)?
    """

    symbols: Mapping[str, Symbol]
    examples: tuple[Example, ...]
    learns_symbols: bool = True

    @classmethod
    def start(cls, training: TrainingSet, *, learns_symbols: bool = True) -> CommitFirst:
        """A learner that knows what the training set teaches (lines 1 to 5)."""
        return cls({s.word: s for s in training.symbols}, training.examples, learns_symbols)

    @property
    def known_types(self) -> tuple[str, ...]:
        """The types of M.Gamma."""
        return tuple(dict.fromkeys(s.type for s in self.symbols.values()))

    @property
    def settled(self) -> frozenset[str]:
        """All nouns that it has a symbol for."""
        return frozenset(self.symbols)

    @property
    def open_words(self) -> frozenset[str]:
        """None: a symbol is for ever."""
        return frozenset()

    @property
    def frames(self) -> None:
        """The paper knows one frame of reference."""
        return None

    @property
    def readings(self) -> Mapping[str, float]:
        """The paper knows one reading of a command."""
        return {}

    def hear(self, solution: Solution, experience: Experience, ground: Ground) -> tuple[CommitFirst, Learned]:
        """T with the outcome of a command that was acted on, and its symbol if there is one to learn."""
        if experience.taught:
            return self, Learned(reason="a lesson is no outcome")
        more = self._and(unsupervised_training(solution))
        symbol, reason = new_symbol(solution, self.symbols)
        if symbol is None or not self.learns_symbols:
            return more, Learned(reason=reason or "this variant learns no symbols")
        return more._with(symbol), Learned(symbol)

    def told(self, word: str, type_: str) -> CommitFirst:
        """The learner with a symbol that a person gave."""
        return self._with(Symbol(word, type_))

    def forget(self, word: str) -> CommitFirst:
        """The learner without a symbol, and without the examples of its word."""
        symbols = {w: s for w, s in self.symbols.items() if w != word}
        kept = [e for e in self.examples if e.phrase.noun != word]
        forgotten = replace(self, symbols=symbols)
        return replace(forgotten, examples=tuple(replace_unknown(kept, forgotten.known_types)))

    def with_frames(self, frames: FrameCounts | None) -> CommitFirst:
        """There is one frame of reference alone."""
        return self

    def with_readings(self, readings: Mapping[str, float]) -> CommitFirst:
        """There is one reading alone."""
        return self

    def taught(self, taught: Taught) -> CommitFirst:
        """The learner with a symbol for every noun of the lessons: for the type that it was said of most."""
        named = {word: Symbol(word, max(types, key=lambda t: types[t])) for word, types in taught.nouns.items()}
        return replace(self, symbols=named | dict(self.symbols))

    def training_examples(self, features: FeatureSet) -> Sequence[Example]:
        """T; where relations are features, with M.Gamma's other types as contrast: they stand where things do."""
        if Group.RELATION in features.groups:
            return [contrast(e, self.symbols) for e in self.examples]
        return self.examples

    def soft_labels(self, features: FeatureSet) -> Sequence[SoftLabels]:
        """M.Gamma's other types as contrast."""
        return [] if Group.RELATION in features.groups else contrasts(self._meant, self.symbols)

    def columns(self, features: FeatureSet) -> FeatureSet:
        """f_word, f_obj and f_color of every symbol (lines 20 to 22)."""
        for symbol in self.symbols.values():
            if not _has_columns(symbol, features):
                features = features.grow(symbol)
        return features

    def trainable(self, features: FeatureSet) -> Bools | None:
        """None: all weights follow from the training examples."""
        return None

    def names(self) -> dict[str, str]:
        """type -> the first word learned for it."""
        return {s.type: s.word for s in reversed(list(self.symbols.values()))}

    def meanings(self, word: str) -> dict[str, float]:
        """The type of the word's symbol, for certain."""
        return {self.symbols[word].type: 1.0} if word in self.symbols else {}

    def beliefs(self, but: Collection[str]) -> None:
        """None: this learner has no degrees of belief."""
        return

    def lexicon(self) -> list[Entry]:
        """Every symbol, held for certain."""
        return [Entry(s.word, ((s.type, 1.0),), 0, (), True) for s in self.symbols.values()]

    @functools.cached_property
    def _meant(self) -> Meant:
        """What `contrasts` asks of T."""
        return with_meant({}, self.examples)

    def _and(self, examples: Sequence[Example]) -> CommitFirst:
        """With more examples."""
        return self._keeping(with_meant(self._meant, examples), examples=(*self.examples, *examples))

    def _with(self, symbol: Symbol) -> CommitFirst:
        """With one more symbol; what it makes known changes what the examples show (line 23)."""
        grown = replace(self, symbols={**self.symbols, symbol.word: symbol})
        return grown._keeping(self._meant, examples=tuple(replace_unknown(self.examples, grown.known_types)))

    def _keeping(self, meant: Meant, *, examples: tuple[Example, ...]) -> CommitFirst:
        """With other examples, of which it is known what was meant."""
        other = replace(self, examples=examples)
        other.__dict__["_meant"] = meant
        return other


def unsupervised_training(solution: Solution) -> list[Example]:
    """T_u: the command's phrases labelled with the grounding that was acted on (line 16).

    For every phrase the chosen grounding is a positive example and the others are negative ones, save those
    that the phrase describes just as well: they are no evidence against the words. Nor is the unseen one of the
    type that was found: the preference for what is in view has been taught, and would grow with every command.
    """
    if solution.best is None:
        return []
    return [
        labelled(h.tree.phrase, h.child, h.factor_children, solution.world, unseen_alike=True)
        for h in solution.best.walk()
    ]


def new_symbol(solution: Solution, symbols: Mapping[str, Symbol]) -> tuple[Symbol | None, str | None]:
    """gamma': the symbol to learn, if an unknown noun met a perceived object of unknown type (lines 17 and 18).

    Returns:
        The symbol, or None and the reason.
    """
    obj, noun = solution.object, solution.noun
    if obj is None or noun is None:
        return None, "the command was not grounded to an object"
    if noun.noun is None:
        return None, "the command names no noun"
    if noun.noun in symbols:
        return None, f"{noun.noun!r} is known already"
    if obj.hypothetical or obj.type is None:
        return None, "what is meant has not been seen"
    if obj.known or any(s.type == obj.type for s in symbols.values()):  # named since the solution was made, perhaps
        return None, f"the object meant is of a known type, {obj.type!r}"
    return Symbol(noun.noun, obj.type, obj.color, noun.color), None


def replace_unknown(examples: Iterable[Example], known_types: Collection[str]) -> list[Example]:
    """The examples with every object's `known` as it is under `known_types` (line 23).

    An example recorded while a type was unknown changes its meaning when the type is learned: positives and
    negatives alike. Examples that mention no such object are returned as they are.
    """
    types, renewed = frozenset(known_types), dict[int, WorldModel]()  # examples of one world go on sharing it
    out = []
    for example in examples:
        if id(example.world) not in renewed:
            renewed[id(example.world)] = _renewed(example.world, types)
        out.append(_relabelled(example, renewed[id(example.world)]))
    return out


def _renewed(world: WorldModel, known_types: Collection[str]) -> WorldModel:
    if all(o.known == (o.type in known_types) for o in world.objects):
        return world
    return replace(world, objects=tuple(replace(o, known=o.type in known_types) for o in world.objects))


def _relabelled(example: Example, world: WorldModel) -> Example:
    """The example in another world of the same objects, which its children's groundings are about as well."""
    if world is example.world:
        return example
    objects = {o.id: o for o in world.objects}  # a place is known from the start, and stays as it is
    about = [(c.grounding.kind, c.grounding.object, c.correspondence) for c in example.children]
    children = tuple(Child(Grounding(kind, objects.get(thing.id, thing)), phi) for kind, thing, phi in about)
    return replace(example, world=world, children=children)


Meant = Mapping[tuple[str | None, bool, frozenset[str]], Mapping[tuple[Phrase, str | None], float]]
"""Colour, hypothetical and attributes of what noun phrases meant -> each phrase with its type -> summed weights."""


def with_meant(before: Meant, examples: Iterable[Example]) -> Meant:
    """What examples mean, beside what was meant before."""
    found = {key: dict(table) for key, table in before.items()}
    for example in examples:
        if (meant := _only_meant(example)) is not None:
            table = found.setdefault((meant.color, meant.hypothetical, meant.attributes), {})
            key = example.phrase, meant.type
            table[key] = table.get(key, 0.0) + example.weight
    return found


def contrasts(meant: Meant, symbols: Mapping[str, Symbol]) -> list[SoftLabels]:
    """What `contrast` adds to examples, summed: of every phrase with an object of every known type.

    It says the same where no feature depends on where things stand.
    """
    types = list(dict.fromkeys(s.type for s in symbols.values()))
    column = {t: k for k, t in enumerate(types)}
    found = []
    for (color, hypothetical, attributes), table in meant.items():
        inactive = np.repeat(np.array([list(table.values())]).T, len(types), axis=1)
        own = [(p, type_) for p, (_, type_) in enumerate(table)]
        own += [(p, symbols[noun].type) for p, (said, _) in enumerate(table) if (noun := said.noun or "") in symbols]
        spared = [(p, column[t]) for p, t in own if t in column]
        inactive[[p for p, _ in spared], [t for _, t in spared]] = 0.0
        objects = [_of_type(t, hypothetical, color, attributes) for t in types]
        found.append(SoftLabels([p for p, _ in table], objects, np.zeros_like(inactive), inactive, inactive > 0.0))
    return found


@functools.lru_cache(maxsize=4096)
def _of_type(type_: str, hypothetical: bool, color: str | None, attributes: frozenset[str]) -> Object:
    """One of a known type that stands nowhere."""
    return Object(type_, type_, True, hypothetical, color, attributes=attributes)


def _only_meant(example: Example) -> Object | None:
    """The one object that a noun phrase's example says is meant; None for another kind of example."""
    if example.phrase.kind is not PhraseKind.NOUN:
        return None
    meant = [o for o, c in zip(example.world.objects, example.correspondences, strict=False) if c]  # not INACTIVE
    return meant[0] if len(meant) == 1 else None


def _has_columns(symbol: Symbol, features: FeatureSet) -> bool:
    """Would the features be the same with this symbol?"""
    named = f"noun: {symbol.word}" in features.language and f"type: {symbol.type}" in features.grounding
    if not named or Group.COLOR not in features.groups:
        return named
    said = all(f"color: {c}" in features.language for c in (symbol.color, symbol.color_word) if c is not None)
    return said and (symbol.color is None or f"color: {symbol.color}" in features.grounding)


def contrast(example: Example, symbols: Mapping[str, Symbol]) -> Example:
    """A noun phrase's example over all of M.Gamma: with a factor for every known type that was not meant.

    Upsilon is the product of the symbolic objects and their attributes (Section II), so training sees, beside the
    object that was meant, one of every other known type with the same attributes, INACTIVE. Without these, what is
    known of a word learned in one lesson could not outweigh a matching colour.
    """
    meant = _only_meant(example)
    if meant is None:
        return example
    named = symbols.get(example.phrase.noun or "")
    spared = {meant.type, None if named is None else named.type}
    others = [
        replace(meant, id=f"{meant.id} as {t}", type=t, known=True)
        for t in dict.fromkeys(s.type for s in symbols.values())
        if t not in spared
    ]
    return replace(
        example,
        world=replace(example.world, objects=(*example.world.objects, *others)),
        correspondences=(*example.correspondences, *(Correspondence.INACTIVE for _ in others)),
    )
