"""The model that goes on learning words where scenes are seen as a whole: new nouns and new words for colours.

It is the log-linear factor graph, trained on a corpus. The paper's robot learns a word from one grounding and believes
it for ever. This one keeps, for every noun and colour word that the corpus did not teach, the sums of the
log-likelihoods of what it may name (`meaning.beliefs`), moved by every command that it hears:

    P(command | word names t)  ~  (1 - slip) q[t] + slip / SPREAD (1 - q[t])
    q[t] = sum over objects of type t of P(the object is meant | all of the command but this word)

so that no lesson rests on itself, a wrong one is outweighed by later ones, and what the rest of the command does not
tell teaches little. A word becomes a `Symbol`, with columns of its own, once one meaning is probable enough: a type or
colour that had no name yet, or a further name of one that has. Its weights come from soft examples of that posterior
(`meaning.soft`), in one fit with the corpus, whose sufficient statistics outlive the growth (`grounding.statistics`).
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, replace

from dcg_torch.grounding.design import DesignMatrix, concatenate
from dcg_torch.grounding.encode import encode
from dcg_torch.grounding.features import FeatureSet
from dcg_torch.grounding.fit import FitResult, fit
from dcg_torch.grounding.graph import FactorGraph, Solution
from dcg_torch.grounding.psi import LogLinearFactor
from dcg_torch.grounding.statistics import CorpusEncoder, Statistics
from dcg_torch.learning.beliefs import UNMET, Evidence
from dcg_torch.learning.commit_first import replace_unknown
from dcg_torch.learning.soft_labels import Pair, pair_examples
from dcg_torch.model import GroundingModel, Scene, TrainingSet, Variant
from dcg_torch.relational import group_nouns, place_symbols
from dcg_torch.types import (
    Correspondence,
    Example,
    Object,
    ParseTree,
    Phrase,
    Symbol,
)
from dcg_torch.words import Words, apart, soft_labels

_HELD = 0.5
"""A learned word keeps its meaning while its probability is above this."""
_MOVED = 1e-3
"""Probability by which a posterior must have moved for the weights to be fitted to it again."""
_STRENGTH = 5.0
_ENOUGH = 0.8  # where the variant does not say how probable a meaning must be


@dataclass(frozen=True)
class _Taught:
    """The labelled factors of the corpus and the hand-made examples, and what they hold under."""

    features: FeatureSet
    known_types: tuple[str, ...]
    designs: list[DesignMatrix]


class LexicalModel(GroundingModel):
    """A `GroundingModel` that learns words from the evidence of all commands that had them.

    Attributes:
        words: that evidence.
    """

    def __init__(
        self,
        variant: Variant,
        symbols: Iterable[Symbol],
        examples: Iterable[Example],
        features: FeatureSet,
        loglinear: LogLinearFactor,
        corpus: Iterable[Example] = (),
        words: Words | None = None,
        statistics: Statistics | None = None,
    ) -> None:
        super().__init__(variant, symbols, examples, features, loglinear, corpus)
        self.words = words or Words()
        self._reader = CorpusEncoder()
        self._restored = statistics
        self._statistics: Statistics | None = None
        self._taught_under: _Taught | None = None
        self._fitted_to: list[Pair] | None = None

    @classmethod
    def trained(cls, training: TrainingSet, variant: Variant | None = None) -> LexicalModel:
        """A model with its initial groundings and features, trained, to be taught a corpus; phi is of eq. 8."""
        model = super().trained(training, replace(variant or Variant(), ternary=False))
        assert isinstance(model, LexicalModel)
        model.words = replace(model.words, taught_colors={color: color for color in training.colors})
        return model

    @property
    def known_types(self) -> tuple[str, ...]:
        """The types that have a name, or were in the training."""
        return tuple(dict.fromkeys((*super().known_types, *self.words.taught_types)))

    def taught(
        self,
        types: Iterable[str] = (),
        nouns: Mapping[str, Mapping[str, int]] | None = None,
        colors: Mapping[str, Mapping[str, int]] | None = None,
    ) -> None:
        """Say what the corpus taught.

        A word that few lessons had is not settled: they are its first evidence, and what is heard may outweigh them.

        Args:
            types: met as known ones.
            nouns: how many lessons said each noun of an object of each type.
            colors: the same for words for colours and colours.
        """
        self.words = self.words.taught(types, nouns or {}, colors or {})

    def learn(self, solution: Solution, scene: Scene | None = None, *, max_steps: int = 500) -> Symbol | None:
        """Weigh what a command tells about its noun and colour word, and train if their meaning has moved.

        What the robot took the command to mean is no evidence; what else was said is.

        Args:
            scene: not looked at; all is in the solution's world.

        Returns:
            The symbol of the command's noun, if this command made or changed it.
        """
        phrase = solution.noun
        if phrase is None or not self.variant.learns:
            return None
        self._reader = CorpusEncoder()  # the corpus is complete: what it was encoded from is not needed any more
        self._settle()
        before = self.symbols.get(phrase.noun or "")
        for part in (solution, *solution.further):
            self._hear(part)
        self._renew(max_steps)
        now = self.symbols.get(phrase.noun or "")
        return now if now != before else None

    def _hear(self, solution: Solution) -> None:
        """Weigh what the rest of a command tells about the noun and the colour word of what it means."""
        phrase, things = solution.noun, solution.world.objects
        if phrase is None:
            return
        nouns = self.words.nouns.meet(o.type for o in things if o.type is not None)
        colors = self.words.colors.meet(o.color for o in things if o.color is not None)
        if phrase.noun is not None and phrase.noun not in nouns.settled:
            rest = self._without(solution, replace(phrase, noun=None))
            nouns = nouns.weigh(Evidence(phrase.noun, _summed((o.type, p) for o, p in rest)))
        if phrase.color is not None and phrase.color not in colors.settled:
            rest = self._without(solution, replace(phrase, color=None))
            colors = colors.weigh(Evidence(phrase.color, _summed((o.color, p) for o, p in rest)))
        self.words = replace(self.words, nouns=nouns, colors=colors)

    @property
    def corpus(self) -> list[Example]:
        """Examples that were labelled over whole worlds: trained on as they are."""
        return self._corpus

    @corpus.setter
    def corpus(self, examples: Iterable[Example]) -> None:
        self._corpus, self._statistics, self._taught_under = list(examples), None, None

    @property
    def statistics(self) -> Statistics:
        """The corpus as sufficient statistics: of its examples, and those that the model was restored with."""
        if self._statistics is None:
            own = self._reader.statistics(self.corpus, self.features, self.loglinear.correspondences)
            self._statistics = own if self._restored is None else self._restored.joined(own)
        return self._statistics

    def train(self, *, max_steps: int = 500) -> FitResult:
        """Fit the corpus, the hand-made examples and the posterior of the words, from the present weights."""
        pairs = self._pairs()
        taught, soft = self._taught(), self._soft(pairs)
        self.fitted = fit(self.loglinear, [*taught, *soft], l2=self.variant.l2, max_steps=max_steps)
        self._fitted_to = pairs
        return self.fitted

    def _taught(self) -> list[DesignMatrix]:
        """What does not change with the posterior, under the present columns."""
        known = self.known_types
        old = self._taught_under
        if old is None or old.features is not self.features or old.known_types != known:
            tables = [*self.statistics.under(self.features, known), *self._tables(self.examples)]
            self._taught_under = old = _Taught(self.features, known, [concatenate(tables)])
        return old.designs

    def _soft(self, pairs: Iterable[Pair]) -> list[DesignMatrix]:
        return encode(list(pair_examples(pairs, _STRENGTH)), self.features, self.loglinear.correspondences)

    def _settle(self) -> None:
        """Take as settled what the training taught: all symbols and colours that were not learned since."""
        given = {s.word: s.type for s in place_symbols()} | dict.fromkeys(group_nouns(), "group")
        named = {s.word: s.type for s in self.symbols.values() if s.word not in self.words.nouns.heard}
        self.words = self.words.settled(given | named)

    def _without(self, solution: Solution, phrase: Phrase) -> list[tuple[Object, float]]:
        """How probable each object is if `phrase` stands in the place of the noun phrase.

        What the model has learned of known and unknown types as such is taken out of a phrase without a noun: it says
        which types the training was about.
        """
        tree = _replaced(solution.tree, solution.noun, phrase)
        found = FactorGraph(tree, solution.world).solve(self.features, self.loglinear, beam=self.variant.beam)
        odds = dict(found.probabilities)
        if phrase.noun is None:
            signs = self.loglinear.correspondences
            weight = self.loglinear.weight
            active, inactive = (weight[signs.index(c)] for c in (Correspondence.ACTIVE, Correspondence.INACTIVE))
            languages = self.features.encode_phrases([phrase])[0]
            for o in solution.world.meanable:
                column = self.features.grounding.get(f"known: {'yes' if o.known else 'no'}")
                if column is not None:
                    odds[o.id] *= math.exp(-float((active - inactive)[languages, column].sum()))
        total = math.fsum(odds.values())
        return [(o, odds[o.id] / total) for o in solution.world.meanable]

    def _renew(self, max_steps: int) -> None:
        """Symbols and columns for what is probable enough by now, and a fit if the posterior has moved."""
        enough = _ENOUGH if self.variant.synonyms is None else self.variant.synonyms
        features = self.features
        posterior = self.words.nouns.posterior
        for word in self.words.nouns.heard:
            meaning, probability = posterior.best(word)
            old = self.symbols.get(word)
            if meaning == UNMET or probability < (enough if old is None else _HELD):
                continue
            if old is None or old.type != meaning:
                self.symbols[word] = Symbol(word, meaning)
                features = features.grow(self.symbols[word])
        posterior, named = self.words.colors.posterior, dict(self.words.color_words)
        for word in self.words.colors.heard:
            meaning, probability = posterior.best(word)
            if meaning == UNMET or probability < (enough if word not in named else _HELD):
                continue
            if named.get(word) != meaning:
                named[word] = meaning
                features = features.name_color(word, meaning)
        self.words = replace(self.words, color_words=named)
        if features.shape != self.features.shape:
            self.features = features
            self.loglinear.grow(features.pairs)
            self.examples = replace_unknown(self.examples, self.known_types)
        # A fit that was cut short goes on with the next command, so that the optimum is followed.
        underway = self.fitted is None or self.fitted.status == "step limit"
        if underway or self._fitted_to is None or apart(self._pairs(), self._fitted_to) > _MOVED:
            self.train(max_steps=max_steps)

    def _pairs(self) -> list[Pair]:
        """The soft labels of every learned word, and of one never heard."""
        self._settle()
        return soft_labels(self.words, self.features, self.known_types)


def _replaced(tree: ParseTree, old: Phrase | None, new: Phrase) -> ParseTree:
    """The tree with another phrase in the place of one."""
    children = tuple(_replaced(child, old, new) for child in tree.children)
    return ParseTree(new if tree.phrase is old else tree.phrase, children)


def _summed(parts: Iterable[tuple[str | None, float]]) -> dict[str, float]:
    total: dict[str, float] = {}
    for name, part in parts:
        if name is not None:
            total[name] = total.get(name, 0.0) + part
    return total
