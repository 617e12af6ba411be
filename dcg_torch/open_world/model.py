"""The model of `model=open_world`.

It is the paper's log-linear factor graph, with one difference in what it is trained on. The paper's robot adds its
own guess to the training set and believes it for ever. This one keeps a posterior over what each word names
(`meaning`), moved by every command with all that was in the world, and trains on it: soft examples that are made
anew from the posterior before every fit. When later evidence contradicts an earlier one, the weights of the wrong
columns fade. Every type met and every word heard has columns, whether or not their bond is known yet.

With the feature group `relation` it reads relations too, once it has been taught them (`supervised.teach`). Their
weights are a block of their own (`blocks`), which the posterior does not move, and they say which things a word may
have been said of (`hearing`).

Grounding is still that of `graph.FactorGraph`, and nothing else decides.
"""

from __future__ import annotations

from collections.abc import Collection, Iterable, Mapping
from dataclasses import replace

from dcg_torch.grounding.features import LOOKED_ROUND, PAPER, FeatureSet, Group
from dcg_torch.grounding.fit import FitResult, fit
from dcg_torch.grounding.graph import Solution
from dcg_torch.grounding.psi import TERNARY, LogLinearFactor
from dcg_torch.learning.beliefs import UNMET, Beliefs, Evidence
from dcg_torch.learning.lexicon import Entry, lexicon
from dcg_torch.learning.soft_labels import soft_examples
from dcg_torch.model import GroundingModel, Scene, TrainingSet, Variant, encode
from dcg_torch.open_world.blocks import Blocks
from dcg_torch.open_world.hearing import described_fit, landmark_fits, target
from dcg_torch.open_world.mind import Mind, OpenWorld
from dcg_torch.relational import PLACE_WORDS, group_nouns, place_examples, place_symbols
from dcg_torch.types import Example, ParseTree, PhraseKind, Symbol

LOOKED = frozenset({LOOKED_ROUND})
_SURE = 0.95  # probability from which on the robot uses a word itself
HELD = 0.5
"""Probability from which on a word counts among `symbols`."""
_PLACE_WEIGHT = 3.0
"""Of the examples of words for places: "you" and "left" are what they are; no corpus will say otherwise."""
_TAUGHT_L2 = 0.2
"""Penalty on the weights that are taught by lessons."""


class OpenWorldModel(GroundingModel):
    """A `GroundingModel` that trains on a posterior over meanings.

    Attributes:
        mind: what it has learned.
    """

    def __init__(
        self,
        variant: Variant,
        symbols: Iterable[Symbol],
        examples: Iterable[Example],
        features: FeatureSet,
        loglinear: LogLinearFactor,
        *,
        mind: Mind,
        corpus: Iterable[Example] = (),
    ) -> None:
        super().__init__(variant, symbols, examples, features, loglinear, corpus)
        self.mind = mind
        self._blocks: Blocks | None = None
        self._fitted_corpus: list[Example] = []

    @classmethod
    def trained(
        cls, training: TrainingSet, variant: Variant | None = None, assumed: OpenWorld | None = None
    ) -> OpenWorldModel:
        """The model before its first command.

        Of the training set, the examples of verbs and prepositions are kept as they are; those of a bare noun and
        colour are what the settled words say.
        """
        assumed = assumed or OpenWorld()
        variant = variant or Variant()
        variant = replace(variant, groups=variant.groups | PAPER | {Group.OPEN}, ternary=True)
        kept = [e for e in training.examples if not _is_plain_noun(e)]
        words, corpus = list(training.symbols), []
        if Group.RELATION in variant.groups:
            words += place_symbols()
            corpus = [replace(e, weight=_PLACE_WEIGHT) for e in place_examples()]
        features = FeatureSet.initial(variant.groups, words, training.colors, [*kept, *corpus])
        if Group.RELATION in variant.groups:
            features = features.include(nouns=group_nouns())
        model = cls(
            variant,
            training.symbols,
            kept,
            features,
            LogLinearFactor(features.pairs, TERNARY),
            mind=Mind(
                Beliefs.start({s.word: s.type for s in training.symbols}, assumed.nouns),
                Beliefs.start({c: c for c in training.colors}, assumed.colors),
                assumed,
            ),
            corpus=corpus,
        )
        model.train()
        return model

    @property
    def beliefs(self) -> Beliefs:
        """What the nouns name."""
        return self.mind.beliefs

    @property
    def known_types(self) -> tuple[str, ...]:
        """The types met so far; before the first command, those that the training set names."""
        return self.beliefs.types

    def beliefs_about(self, but: Collection[str]) -> dict[str, dict[str, float]]:
        """word -> type -> probability, of all words `but` some; what is below a thousandth is left out."""
        posterior = self.beliefs.posterior
        return {
            word: {t: round(p, 6) for t, p in posterior.of(word).items() if p >= 1e-3}
            for word in posterior.words
            if word not in but
        }

    def sure_names(self) -> dict[str, str]:
        """type -> the word that most certainly names it, if any does."""
        posterior = self.beliefs.posterior
        best = {word: posterior.best(word) for word in posterior.words}
        sure = sorted((p, word, t) for word, (t, p) in best.items() if p >= _SURE and t != UNMET)
        return {t: word for _, word, t in sure}

    def learn(self, solution: Solution, scene: Scene | None = None, *, max_steps: int = 500) -> Symbol | None:
        """Weigh a command's evidence and train on the posterior that follows.

        What the robot chose to do is no evidence, so it doesn't enter.

        Args:
            scene: what was perceived and said; without it nothing can be learned.

        Returns:
            The command's word, if this command moved its probability above `HELD`.
        """
        phrase = solution.noun
        relations = Group.RELATION in self.variant.groups
        if scene is None or phrase is None or not self.variant.learns or (phrase.noun is None and not relations):
            return None
        self._meet(scene)
        before = self.symbols.get(phrase.noun or "")
        fit_of = described_fit(solution, self.features, self.loglinear, self.variant.beam) if relations else None
        landmarks = self._landmarks(solution) if relations else []
        self._hear(phrase.noun, phrase.color, scene, fit_of)
        for word, by_type in landmarks:
            unseen = self.mind.expected_unseen(looked=scene.looked)
            self.mind = replace(self.mind, beliefs=self.beliefs.weigh(Evidence(word, by_type, unseen, scene.source)))
        self._renew(max_steps)
        now = self.symbols.get(phrase.noun or "")
        return now if now != before else None

    def train(self, *, max_steps: int = 500) -> FitResult:
        """Fit from the present weights: what is believed to the posterior, and a new corpus to its examples.

        The two are blocks of weights, each fitted as the other stands (`blocks`).
        """
        if self._blocks is None or self._blocks.whole is not self.features:
            self._blocks = Blocks.of(self.features)
        blocks = self._blocks
        soft = soft_examples(
            self.beliefs,
            self.mind.color_beliefs,
            self.mind.unseen,
            looked=LOOKED,
            strength=self.mind.assumed.strength,
            forgotten=sorted(blocks.believed.nouns - set(self.beliefs.posterior.words)),
            unnamed=Group.RELATION in self.variant.groups,
        )
        part = blocks.part(self.loglinear)
        tables = encode([*self.examples, *soft], blocks.believed, part.correspondences)
        self.fitted = fit(part, tables, l2=self.variant.l2, max_steps=max_steps)
        blocks.put(part, self.loglinear)
        if self.corpus and self.corpus is not self._fitted_corpus:
            tables = encode(self.corpus, self.features, self.loglinear.correspondences)
            fit(self.loglinear, tables, l2=_TAUGHT_L2, free=blocks.taught, max_steps=max_steps)
            self._fitted_corpus = self.corpus
        return self.fitted

    def settle(self) -> None:
        """Keep what the corpus has taught and let go of its examples: the posterior does not move those weights."""
        self.corpus = self._fitted_corpus = []

    def beliefs_of(self, word: str) -> dict[str, float]:
        """type -> probability that a noun names it."""
        return self.beliefs.posterior.of(word)

    def lexicon(self) -> list[Entry]:
        """Every noun with what it may mean, and from which commands."""
        return lexicon(self.beliefs)

    def forget(self, word: str) -> None:
        """Forget all that was heard of a noun, and train."""
        self.mind = replace(self.mind, beliefs=self.beliefs.forget(word))
        self._renew()

    def correct(self, word: str, type_: str) -> None:
        """Settle a noun on a type, and train."""
        self.mind = replace(self.mind, beliefs=self.beliefs.correct(word, type_))
        self._renew()

    def _meet(self, scene: Scene) -> None:
        """Take note of the types and colours seen, and of how many there are."""
        beliefs = self.beliefs.meet(p.type for p in scene.percepts)
        colors = self.mind.color_beliefs.meet(p.color for p in scene.percepts if p.color is not None)
        census = self.mind.census
        if scene.looked:
            census = census.count(scene.percepts, len(beliefs.types) * max(1, len(colors.types)))
        self.mind = replace(self.mind, beliefs=beliefs, color_beliefs=colors, census=census)

    def _landmarks(self, solution: Solution) -> list[tuple[str, dict[str, float]]]:
        """Of every landmark whose noun isn't settled: the noun, and how probably which type was the landmark."""
        settled = self.beliefs.settled.keys() | PLACE_WORDS
        if all(node.phrase.noun is None or node.phrase.noun in settled for node in _below_target(solution.tree)):
            return []
        type_of = {o.id: o.type for o in solution.world.objects if not o.hypothetical and o.type is not None}
        out = []
        for word, fits in landmark_fits(solution, self.features, self.loglinear, self.variant.beam):
            if word in settled:
                continue
            by_type: dict[str, float] = {}
            for id_, amount in fits.items():
                if id_ in type_of:
                    by_type[type_of[id_]] = by_type.get(type_of[id_], 0.0) + amount
            out.append((word, by_type))
        return out

    def _hear(self, noun: str | None, color: str | None, scene: Scene, fit_of: Mapping[str, float] | None) -> None:
        """Weigh a noun in the light of the colour said, the colour in the light of the noun, both in that of the rest.

        Args:
            fit_of: object id -> how well the rest of the command fits it; None: it says nothing.
        """
        colors = self.mind.color_beliefs
        meant = [p for p in scene.percepts if scene.meant is None or p.id in scene.meant]
        by_color = dict[str, float]()
        by_type = dict[str, float]()
        said_of = {} if noun is None else _said(self.beliefs, noun)
        color_of = None if color is None else _said(colors, color)
        for p in meant:
            fits = 1.0 if fit_of is None else fit_of.get(p.id, 0.0)
            as_colored = 1.0 if color_of is None or p.color is None else color_of.get(p.color, 0.0)
            by_type[p.type] = by_type.get(p.type, 0.0) + fits * as_colored
            if p.color is not None:
                as_named = 1.0 if noun is None else said_of.get(p.type, 0.0)
                by_color[p.color] = by_color.get(p.color, 0.0) + fits * as_named
        unseen = 0.0 if scene.certain else self.mind.expected_unseen(looked=scene.looked)
        beliefs = self.beliefs
        if noun is not None and noun not in PLACE_WORDS:
            several = 1 if color is not None else self.mind.colors
            beliefs = beliefs.weigh(Evidence(noun, by_type, unseen * several, scene.source))
        if color is not None:
            colors = colors.weigh(Evidence(color, by_color, unseen, scene.source))
        self.mind = replace(self.mind, beliefs=beliefs, color_beliefs=colors)

    def _renew(self, max_steps: int = 500) -> None:
        """Columns for what is new, the symbols held, and a fit."""
        self.features = self.features.include(
            nouns=self.beliefs.posterior.words,
            types=self.beliefs.types,
            colors=(*self.mind.color_beliefs.posterior.words, *self.mind.color_beliefs.types),
        )
        self.loglinear.grow(self.features.pairs)
        best = {w: self.beliefs.posterior.best(w) for w in self.beliefs.posterior.words}
        self.symbols = {w: Symbol(w, t) for w, (t, p) in best.items() if p >= HELD and t != UNMET}
        self.train(max_steps=max_steps)


def _said(beliefs: Beliefs, word: str) -> dict[str, float]:
    """How readily a word is said of each type (or colour) met."""
    table, new = beliefs.said_of()
    words = beliefs.posterior.words
    row = table[words.index(word)] if word in words else new
    return dict(zip(beliefs.posterior.types, map(float, row), strict=True))


def _is_plain_noun(example: Example) -> bool:
    phrase = example.phrase
    return phrase.kind is PhraseKind.NOUN and not phrase.words and not example.children


def _below_target(tree: ParseTree) -> list[ParseTree]:
    """The landmarks of the object meant."""
    noun = target(tree)
    return [] if noun is None else [landmark for modifier in noun.children for landmark in modifier.children]
