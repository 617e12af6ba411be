"""The model that does not lock in its mistakes: `model=open_world`.

It is the paper's log-linear factor graph, with one difference in what it is trained on. The paper's robot adds its
own guess to the training set and believes it for ever. This one keeps a posterior over what each word names
(`meaning`), moved by every command with all that was in the world, and trains on it: soft examples that are made
anew from the posterior before every fit. When later evidence contradicts an earlier one, the weights of the wrong
columns fade. Every type met and every word heard has columns, whether or not their bond is known yet.

Grounding is still that of `graph.FactorGraph`, and nothing else decides.
"""

from __future__ import annotations

import math
from collections.abc import Collection, Iterable
from dataclasses import dataclass, field, replace

from dcg_torch.features import LOOKED_ROUND, PAPER, FeatureSet, Group
from dcg_torch.graph import Solution
from dcg_torch.loglinear import TERNARY, FitResult, LogLinearModel, fit
from dcg_torch.meaning.beliefs import UNMET, Beliefs, Evidence, Prior
from dcg_torch.meaning.lexicon import Entry, lexicon
from dcg_torch.meaning.soft import Unseen, soft_examples
from dcg_torch.model import GroundingModel, Scene, TrainingSet, Variant, encode
from dcg_torch.symbols import Example, Percept, PhraseKind, Pose, Symbol, WorldModel
from dcg_torch.world.upsilon import world_model

LOOKED = frozenset({LOOKED_ROUND})
_SURE = 0.95  # probability from which on the robot uses a word itself
HELD = 0.5
"""Probability from which on a word counts among `symbols`."""


@dataclass(frozen=True, slots=True)
class Census:
    """How many objects there are in a world that was looked at all round.

    Attributes:
        objects, cells: objects found, and pairs of type and colour that were looked for.
        again, found: objects found of a type and colour of which one was there already, and all that were found.

    The defaults are what is assumed before the first world, and give way to what is counted.
    """

    objects: float = 1.5
    cells: float = 10.0
    again: float = 0.25
    found: float = 10.0

    @property
    def rate(self) -> float:
        """Expected objects of one type and colour."""
        return self.objects / self.cells

    @property
    def repeats(self) -> float:
        """Expected further objects of a type and colour of which one is there."""
        return self.again / self.found

    def count(self, percepts: Collection[Percept], cells: int) -> Census:
        """With one more world."""
        repeated = len(percepts) - len({(p.type, p.color) for p in percepts})
        n = len(percepts)
        return Census(self.objects + n, self.cells + cells, self.again + repeated, self.found + n)


@dataclass(frozen=True, slots=True)
class OpenWorld:
    """What is assumed of the world and of speakers.

    Attributes:
        nouns: of nouns.
        colors: of colour words, which are hardly ever wrong.
        hidden: number of objects of a type and colour to be expected though the robot has looked round: hidden
            ones, and such that a speaker believes to be there.
        strength: see `soft.soft_examples`.
    """

    nouns: Prior = field(default_factory=Prior)
    colors: Prior = field(default_factory=lambda: Prior(slip=0.005))
    hidden: float = 0.01
    strength: float = 5.0


@dataclass(frozen=True)
class Mind:
    """All that an open-world model has learned; its weights follow from it.

    Attributes:
        beliefs: what the nouns name.
        color_beliefs: what the colour words name.
        assumed: what it takes for granted.
        census: how many objects there are.
    """

    beliefs: Beliefs
    color_beliefs: Beliefs
    assumed: OpenWorld = OpenWorld()
    census: Census = Census()


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
        loglinear: LogLinearModel,
        *,
        mind: Mind,
    ) -> None:
        super().__init__(variant, symbols, examples, features, loglinear)
        self.mind = mind

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
        features = FeatureSet.initial(variant.groups, training.symbols, training.colors, kept)
        model = cls(
            variant,
            training.symbols,
            kept,
            features,
            LogLinearModel(features.pairs, TERNARY),
            mind=Mind(
                Beliefs.start({s.word: s.type for s in training.symbols}, assumed.nouns),
                Beliefs.start({c: c for c in training.colors}, assumed.colors),
                assumed,
            ),
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

    def world_model(
        self,
        percepts: Iterable[Percept],
        robot: Pose | None = None,
        speaker: Pose | None = None,
        *,
        looked: bool = False,
    ) -> WorldModel:
        """Upsilon; its hypothetical objects say whether the robot has looked round."""
        unseen = LOOKED if looked else frozenset()
        return world_model(percepts, self.known_types, robot=robot, speaker=speaker, unseen=unseen)

    def learn(self, solution: Solution, scene: Scene | None = None, *, max_steps: int = 500) -> Symbol | None:
        """Weigh a command's evidence and train on the posterior that follows.

        What the robot chose to do is no evidence, so it doesn't enter.

        Args:
            scene: what was perceived and said; without it nothing can be learned.

        Returns:
            The command's word, if this command moved its probability above `HELD`.
        """
        phrase = solution.noun
        if scene is None or phrase is None or phrase.noun is None or not self.variant.learns:
            return None
        self._meet(scene)
        before = self.symbols.get(phrase.noun)
        self._hear(phrase.noun, phrase.color, scene)
        self._renew(max_steps)
        now = self.symbols.get(phrase.noun)
        return now if now != before else None

    def train(self, *, max_steps: int = 500) -> FitResult:
        """Fit from the present weights, on the training set and on the posterior."""
        colors = max(1, len(self.mind.color_beliefs.types))
        unseen = Unseen(
            ahead=_rivals((self.mind.census.rate * (colors - 1) + self.mind.census.repeats) * _UNSEEN)
            + self.mind.assumed.hidden,
            ahead_colored=_rivals(self.mind.census.repeats * _UNSEEN) + self.mind.assumed.hidden,
            left=self.mind.assumed.hidden,
        )
        soft = soft_examples(
            self.beliefs,
            self.mind.color_beliefs,
            unseen,
            looked=LOOKED,
            strength=self.mind.assumed.strength,
            forgotten=sorted(self.features.nouns - set(self.beliefs.posterior.words)),
        )
        tables = encode([*self.examples, *soft], self.features, self.loglinear)
        # a gradient of a hundredth of a pair's curvature is a hundredth of a nat in its log-odds
        tolerance = 0.01 * self.mind.assumed.strength / sum(float(table.count.sum()) for table in tables)
        self.fitted = fit(self.loglinear, tables, l2=self.variant.l2, tolerance=tolerance, max_steps=max_steps)
        return self.fitted

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

    def _hear(self, noun: str, color: str | None, scene: Scene) -> None:
        """Weigh a noun in the light of the colour said, and the colour in the light of the noun."""
        colors = self.mind.color_beliefs
        meant = [p for p in scene.percepts if scene.meant is None or p.id in scene.meant]
        by_color = dict[str, float]()
        by_type = dict[str, float]()
        said_of = _said(self.beliefs, noun)
        color_of = None if color is None else _said(colors, color)
        for p in meant:
            as_colored = 1.0 if color_of is None or p.color is None else color_of.get(p.color, 0.0)
            by_type[p.type] = by_type.get(p.type, 0.0) + as_colored
            if p.color is not None:
                by_color[p.color] = by_color.get(p.color, 0.0) + said_of.get(p.type, 0.0)
        unseen = 0.0
        if not scene.certain:
            unseen = (
                self.mind.assumed.hidden * self.mind.census.rate if scene.looked else self.mind.census.rate * _UNSEEN
            )
        several = 1 if color is not None else max(1, len(colors.types))
        beliefs = self.beliefs.weigh(Evidence(noun, by_type, unseen * several, scene.source))
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


_UNSEEN = 1.0 - 57.0 / 360.0
"""Share of the ground that is out of view before the robot turns."""


def _rivals(expected: float) -> float:
    """The odds of the unseen objects of a kind against one that is seen, when each is meant as likely as any other.

    With n of them, n Poisson, that one is meant with probability E[1 / (1 + n)], which is more than 1 / (1 + E[n]).
    """
    return expected / -math.expm1(-expected) - 1.0 if expected > 1e-9 else expected / 2.0


def _said(beliefs: Beliefs, word: str) -> dict[str, float]:
    """How readily a word is said of each type (or colour) met."""
    table, new = beliefs.said_of()
    words = beliefs.posterior.words
    row = table[words.index(word)] if word in words else new
    return dict(zip(beliefs.posterior.types, map(float, row), strict=True))


def _is_plain_noun(example: Example) -> bool:
    phrase = example.phrase
    return phrase.kind is PhraseKind.NOUN and not phrase.words and not example.children
