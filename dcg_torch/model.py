"""The model that users import: train on examples, ground a sentence in a world, learn from the outcome.

It joins the rooms: features and weights, the symbols known, and the training set T.
"""

from __future__ import annotations

from collections.abc import Collection, Iterable, Sequence
from dataclasses import dataclass, replace

from dcg_torch.grounding.design import DesignMatrix
from dcg_torch.grounding.encode import encode, example_bag
from dcg_torch.grounding.features import LOOKED_ROUND, PAPER, FeatureSet, Group
from dcg_torch.grounding.fit import FitResult, fit
from dcg_torch.grounding.graph import FactorGraph, Solution
from dcg_torch.grounding.psi import BINARY, TERNARY, LogLinearFactor
from dcg_torch.learning.commit_first import contrast, new_symbol, replace_unknown, unsupervised_training
from dcg_torch.relational import (
    Workspace,
    coordinated,
    furnished,
    group_nouns,
    grouped,
    place_examples,
    place_symbols,
    relational,
)
from dcg_torch.scene.upsilon import world_model
from dcg_torch.types import (
    Correspondence,
    Example,
    ParseTree,
    Percept,
    PhraseKind,
    Pose,
    Symbol,
    WorldModel,
)

__all__ = ["GroundingModel", "Scene", "TrainingSet", "Variant", "encode", "example_bag"]


@dataclass(frozen=True)
class Variant:
    """What a model variant is: its feature groups, and the objects that enter its world model.

    Attributes:
        groups: feature groups that are on.
        unknown: perceived objects of unknown type enter Upsilon (DCG-UPUP).
        hypothetical: hypothetical objects enter Upsilon (DCG-UPUP-Away).
        learns: the robot adds its own examples and symbols (Alg. 1, lines 16 to 25).
        ternary: correspondences of eq. 4 (with INVERTED) rather than of eqs. 6, 8 and 9.
        l2: strength of the penalty on the weights.
        beam: hypotheses of a child phrase that its parent considers.
        synonyms: see `learning.new_symbol`; None in the paper, which has one word per type.
    """

    groups: frozenset[Group] = PAPER
    unknown: bool = True
    hypothetical: bool = True
    learns: bool = True
    ternary: bool = True
    l2: float = 0.05
    beam: int = 8
    synonyms: float | None = None


@dataclass(frozen=True)
class TrainingSet:
    """The labelled examples of Alg. 1, line 5, with the symbols and colours that they make known."""

    symbols: tuple[Symbol, ...]
    colors: tuple[str, ...]
    examples: tuple[Example, ...]


_BATCH = 256
"""Examples that are encoded together once there are as many, and then not again until the columns change."""


@dataclass(frozen=True)
class _Encoded:
    """Tables that hold for as long as the columns do: the corpus's, and those of whole batches of T."""

    features: FeatureSet
    corpus: list[DesignMatrix]
    batches: list[list[DesignMatrix]]


@dataclass(frozen=True)
class Scene:
    """What the robot saw and was told while it carried a command out.

    Attributes:
        percepts: all that it perceived.
        looked: did it look all round?
        meant: ids of the objects that may still be meant after the speaker's answers; None: nothing was said.
        certain: the speaker said which object is meant.
        source: which command it was, for the lexicon.
    """

    percepts: tuple[Percept, ...] = ()
    looked: bool = False
    meant: frozenset[str] | None = None
    certain: bool = False
    source: str = ""


class GroundingModel:
    """DCG, DCG-UPUP, DCG-UPUP-Away, with or without colour: which, is said by the `Variant`.

    Attributes:
        features: the columns, which say what is known.
        loglinear: the weights.
        symbols: every known word and its type, in the order of learning.
        examples: T, the training set so far.
        fitted: how the last training went; None for a model that was restored.
        workspace: what the scenes have in common, for relations; None for a robot that drives about.
    """

    def __init__(
        self,
        variant: Variant,
        symbols: Iterable[Symbol],
        examples: Iterable[Example],
        features: FeatureSet,
        loglinear: LogLinearFactor,
        corpus: Iterable[Example] = (),
    ) -> None:
        self.variant = variant
        self.symbols = {s.word: s for s in symbols}
        self.examples = list(examples)
        self._corpus = list(corpus)
        self.features = features
        self.loglinear = loglinear
        self.fitted: FitResult | None = None
        self.workspace: Workspace | None = None
        self._encoded: _Encoded | None = None

    @classmethod
    def trained(cls, training: TrainingSet, variant: Variant | None = None) -> GroundingModel:
        """Lines 1 to 6 of Algorithm 1: a model with its initial groundings and features, trained."""
        variant = variant or Variant()
        examples = _restrict(training.examples, variant)
        words, corpus = list(training.symbols), []
        if Group.RELATION in variant.groups:
            words += place_symbols()
            corpus = place_examples()
        features = FeatureSet.initial(variant.groups, words, training.colors, [*examples, *corpus])
        if Group.RELATION in variant.groups:
            features = features.include(nouns=group_nouns())
        loglinear = LogLinearFactor(features.pairs, TERNARY if variant.ternary else BINARY)
        model = cls(variant, training.symbols, examples, features, loglinear, corpus)
        model.train()
        return model

    @property
    def corpus(self) -> list[Example]:
        """Examples that were labelled over whole worlds: trained on as they are."""
        return self._corpus

    @corpus.setter
    def corpus(self, examples: Iterable[Example]) -> None:
        self._corpus, self._encoded = list(examples), None

    @property
    def known_types(self) -> tuple[str, ...]:
        """The types of M.Gamma, in the order of learning."""
        return tuple(dict.fromkeys(s.type for s in self.symbols.values()))

    def beliefs_about(self, but: Collection[str]) -> dict[str, dict[str, float]] | None:
        """word -> type -> probability, of all words `but` some; None for a model that has no such beliefs."""
        return None

    def sure_names(self) -> dict[str, str]:
        """type -> a word for it that the robot holds for certain."""
        return {s.type: s.word for s in reversed(self.symbols.values())}

    def world_model(
        self,
        percepts: Iterable[Percept],
        robot: Pose | None = None,
        speaker: Pose | None = None,
        *,
        looked: bool = False,
    ) -> WorldModel:
        """Upsilon as this variant represents it (lines 8 and 9).

        Args:
            looked: has the robot looked all round? The paper's hypothetical objects don't depend on it.
        """
        world = world_model(
            percepts,
            self.known_types,
            unknown=self.variant.unknown,
            hypothetical=self.variant.hypothetical,
            robot=robot,
            speaker=speaker,
            unseen=frozenset({LOOKED_ROUND} if looked and Group.OPEN in self.variant.groups else ()),
        )
        return furnished(world, self.workspace) if Group.RELATION in self.variant.groups else world

    def ground(self, tree: ParseTree, world: WorldModel) -> Solution:
        """[phi*, gamma*] of a command in a world (line 11)."""
        if Group.RELATION not in self.variant.groups:
            return self._ground(tree, world)
        first, *others = (self._ground(part, grouped(world, part)) for part in coordinated(tree))
        return replace(first, further=tuple(others))

    def _ground(self, tree: ParseTree, world: WorldModel) -> Solution:
        return FactorGraph(self.readable(tree), world).solve(self.features, self.loglinear, beam=self.variant.beam)

    def readable(self, tree: ParseTree) -> ParseTree:
        """The phrases of a tree that this variant's features read."""
        return relational(tree) if Group.RELATION in self.variant.groups else _path(tree)

    def learn(self, solution: Solution, scene: Scene | None = None, *, max_steps: int = 500) -> Symbol | None:
        """Add the outcome of a grounding that was acted on to the training set, and retrain (lines 16 to 25).

        Args:
            scene: all that was perceived; the paper's rule reads the solution alone.

        Returns:
            The symbol that was learned, if any.
        """
        if not self.variant.learns:
            return None
        examples = unsupervised_training(solution)
        symbol = (
            new_symbol(solution, self.features, synonyms=self.variant.synonyms)
            if Group.UNKNOWN in self.variant.groups
            else None
        )
        if symbol is not None:
            self.symbols[symbol.word] = symbol
            self.features = self.features.grow(symbol)
            self.loglinear.grow(self.features.pairs)
            self.examples = replace_unknown(self.examples, self.known_types)
            self.corpus = replace_unknown(self.corpus, self.known_types)
            examples = replace_unknown(examples, self.known_types)
        self.examples += examples
        self.train(max_steps=max_steps)
        return symbol

    def train(self, *, max_steps: int = 500) -> FitResult:
        """M.train (lines 6 and 25): encode T under the present features and fit from the present weights."""
        if self._encoded is None or self._encoded.features is not self.features:
            self._encoded = _Encoded(
                self.features, encode(self.corpus, self.features, self.loglinear.correspondences), []
            )
        batches = self._encoded.batches
        while (len(batches) + 1) * _BATCH <= len(self.examples):
            batches.append(self._tables(self.examples[len(batches) * _BATCH : (len(batches) + 1) * _BATCH]))
        rest = self._tables(self.examples[len(batches) * _BATCH :])
        tables = [*rest, *(table for batch in batches for table in batch), *self._encoded.corpus]
        self.fitted = fit(self.loglinear, tables, l2=self.variant.l2, max_steps=max_steps)
        return self.fitted

    def _tables(self, examples: Sequence[Example]) -> list[DesignMatrix]:
        return encode([contrast(e, self.symbols) for e in examples], self.features, self.loglinear.correspondences)


def _restrict(examples: Iterable[Example], variant: Variant) -> list[Example]:
    """The examples as a variant sees them: without the objects that it does not represent.

    An example about such an object is left out, and with binary correspondences so is one of INVERTED.
    """
    kept = []
    for e in examples:
        seen = [(o.known or variant.unknown) and (variant.hypothetical or not o.hypothetical) for o in e.world.objects]
        objects = tuple(o for o, keep in zip(e.world.objects, seen, strict=True) if keep)
        labels = tuple(c for c, keep in zip(e.correspondences, seen, strict=True) if keep)
        signs = {*labels, *(c.correspondence for c in e.children)}
        if signs <= {None, Correspondence.INACTIVE} or (not variant.ternary and Correspondence.INVERTED in signs):
            continue
        if all(c.grounding.object in objects for c in e.children):
            kept.append(replace(e, world=replace(e.world, objects=objects), correspondences=labels))
    return kept


def _path(tree: ParseTree) -> ParseTree:
    """The path from the root to the object meant: a tree's first child leads to it.

    What modifies a noun phrase, and where a thing is to be put, is beyond the paper's features.
    """
    return replace(tree, children=() if tree.phrase.kind is PhraseKind.NOUN else tuple(map(_path, tree.children[:1])))
