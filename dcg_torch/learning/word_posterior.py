"""The learner that does not lock in its mistakes: a posterior over what each word names.

The paper's robot adds its own guess to the training set and believes it for ever. This one keeps a posterior over
what nouns and words for colours name (`beliefs`), moved by every command with all that was in the world and all
else that was said (`evidence`), and trains on it: soft examples that are made anew from the posterior before every
fit. When later evidence contradicts an earlier one, the weights of the wrong columns fade. Every type met and every
word heard has columns, whether or not their bond is known yet.

What the robot chose to do is no evidence, so it doesn't enter.
"""

from __future__ import annotations

import math
from collections.abc import Collection, Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property

from dcg_torch.grounding.features import FeatureSet
from dcg_torch.grounding.solution import Solution
from dcg_torch.grounding.statistics import SoftLabels
from dcg_torch.learning.beliefs import UNMET, Beliefs, Evidence, Prior
from dcg_torch.learning.census import Census, FrameCounts
from dcg_torch.learning.evidence import Attribute, Ground, WordEvidence, evidence, told_by_look
from dcg_torch.learning.learner import Experience, Learned, Taught, TrainingSet
from dcg_torch.learning.lexicon import Entry, lexicon
from dcg_torch.learning.soft_labels import Unseen, soft_labels
from dcg_torch.learning.trainable import believed_mask
from dcg_torch.names.vocabulary import GROUP_WORDS, PLACE_WORDS
from dcg_torch.types import LOOKED_ROUND, Example, Object, PhraseKind, Symbol
from dcg_torch.types.arrays import Bools

OUT_OF_VIEW = 1.0 - 57.0 / 360.0
"""Share of the ground that is out of view before the robot turns."""
HELD = 0.5
"""Probability from which on a word counts among `symbols`."""
_SURE = 0.95  # probability from which on the robot uses a word itself
_AGREEING, _AGREED = 3, 0.8
"""A word of the lessons is settled by as many that agree, if they are this share of all that had it ..."""
_MANY = 8
"""... or by as many, whatever they say: its weights then follow from them, be they about several types."""


@dataclass(frozen=True, slots=True)
class Assumptions:
    """What is assumed of the world and of speakers.

    Attributes:
        nouns: of nouns.
        colors: of colour words, which are hardly ever wrong.
        hidden: number of objects of a type and colour to be expected though the robot has looked round: hidden
            ones, and such that a speaker believes to be there.
        strength: see `soft_labels.soft_labels`.
    """

    nouns: Prior = field(default_factory=Prior)
    colors: Prior = field(default_factory=lambda: Prior(slip=0.005))
    hidden: float = 0.01
    strength: float = 5.0

    def __post_init__(self) -> None:
        if not (0.0 <= self.hidden < math.inf and 0.0 < self.strength < math.inf):
            raise ValueError("hidden must not be negative, strength must be positive, and both finite")

    def with_names(self, *, evident: bool) -> Assumptions:
        """The assumptions with the names of types and colours as evidence for words, or without."""
        return replace(self, nouns=replace(self.nouns, names=evident), colors=replace(self.colors, names=evident))


@dataclass(frozen=True)
class WordPosterior:
    """What has been learned of words.

    Attributes:
        nouns: what the nouns name.
        colors: what the words for colours name.
        assumed: what it takes for granted.
        census: how many objects there are.
        examples: of verbs and prepositions, which are taught once.
        fixed: nouns and words for colours whose weights lessons have taught, so that they follow from no posterior.
        frames: whose left and right speakers mean.
        readings: what corpora taught of the choices that a parser makes, see `learning.readings`.
    """

    nouns: Beliefs
    colors: Beliefs
    assumed: Assumptions = Assumptions()
    census: Census = field(default_factory=Census)
    examples: tuple[Example, ...] = ()
    fixed: frozenset[str] = frozenset()
    frames: FrameCounts = field(default_factory=FrameCounts)
    readings: Mapping[str, float] = field(default_factory=dict)

    @classmethod
    def start(cls, training: TrainingSet, assumed: Assumptions | None = None) -> WordPosterior:
        """Before the first command.

        Of the training set, the examples of verbs and prepositions are kept as they are; those of a bare noun and
        colour are what the settled words say.
        """
        assumed = assumed or Assumptions()
        return cls(
            Beliefs.start({s.word: s.type for s in training.symbols}, assumed.nouns),
            Beliefs.start({c: c for c in training.colors}, assumed.colors),
            assumed,
            examples=tuple(e for e in training.examples if not _is_plain_noun(e)),
        )

    @cached_property
    def symbols(self) -> Mapping[str, Symbol]:
        """The words that name a type with a probability of at least `HELD`."""
        best = self.nouns.posterior.best_of_all()
        return {w: Symbol(w, t) for w, (t, p) in best.items() if p >= HELD and t != UNMET}

    @property
    def known_types(self) -> tuple[str, ...]:
        """The types met so far; before the first command, those that the training set names."""
        return self.nouns.types

    @property
    def settled(self) -> frozenset[str]:
        """Words whose meaning was given, and those for places and groups."""
        return frozenset((*self.nouns.settled, *self.colors.settled, *PLACE_WORDS, *GROUP_WORDS))

    @property
    def open_words(self) -> frozenset[str]:
        """The words that were heard: their posterior is never closed."""
        return frozenset((*self.nouns.heard, *self.colors.heard))

    def hear(self, solution: Solution, experience: Experience, ground: Ground) -> tuple[WordPosterior, Learned]:
        """Weigh all that a command tells of its nouns and colours, in the light of what was believed before it."""
        found = [e for part in (solution, *solution.further) for e in evidence(part, ground, self._is_open)]
        heard = self._met([o for o in solution.world.objects if not o.hypothetical], looked=experience.looked)
        type_of, color_of = ({o.id: getattr(o, a) for o in solution.world.objects} for a in ("type", "color"))
        for one in found:
            if one.attribute == "color" and told_by_look(one.word, solution.world.objects):
                continue
            fitting = one.by(type_of if one.attribute == "noun" else color_of)
            told = Evidence(one.word, fitting, heard._unseen(one, experience), experience.source)
            if one.attribute == "noun":
                heard = replace(heard, nouns=heard.nouns.weigh(told))
            else:
                heard = replace(heard, colors=heard.colors.weigh(told))
        heard = replace(heard, frames=self.frames.count(solution.speakers_frame))
        if experience.taught:
            return heard, Learned(reason="a lesson says what it teaches")
        noun = solution.noun
        if noun is None:
            return heard, Learned(reason="the command was not grounded to an object")
        before, now = self.symbols.get(noun.noun or ""), heard.symbols.get(noun.noun or "")
        if now is not None and now != before:
            return heard, Learned(now)
        return heard, Learned(reason=heard._why_not(noun.noun, [e.word for e in found]))

    def _is_open(self, attribute: Attribute, word: str) -> bool:
        beliefs = self.nouns if attribute == "noun" else self.colors
        return word not in beliefs.settled and not (attribute == "noun" and word in (*PLACE_WORDS, *GROUP_WORDS))

    def _why_not(self, noun: str | None, words: Sequence[str]) -> str:
        if noun is None:
            return "the command names no noun"
        if noun in self.settled:
            return f"{noun!r} is known already"
        if noun not in words:
            return f"nothing is said of {noun!r}"
        meaning, probability = self.nouns.posterior.best(noun)
        what = "something not met yet" if meaning == UNMET else repr(meaning)
        return (
            f"{noun!r} is {what} with probability {probability:.2f}, as before"
            if probability >= HELD
            else (f"{noun!r} may be several things; {what} is the likeliest, with probability {probability:.2f}")
        )

    def _met(self, seen: Sequence[Object], *, looked: bool) -> WordPosterior:
        """With note of the types and colours seen, and of how many there are."""
        nouns = self.nouns.meet(o.type for o in seen if o.type is not None)
        colors = self.colors.meet(o.color for o in seen if o.color is not None)
        census = self.census.count(seen, len(nouns.types) * max(1, len(colors.types))) if looked else self.census
        return replace(self, nouns=nouns, colors=colors, census=census)

    def _unseen(self, one: WordEvidence, experience: Experience) -> float:
        """Objects of each type (or colour) that may have been there unseen and that the command may mean."""
        if experience.certain and not one.landmark:
            return 0.0
        share = self.assumed.hidden if experience.looked else OUT_OF_VIEW
        several = self._number_of_colors if one.attribute == "noun" and one.phrase.color is None else 1
        return self.census.rate * share * (1 if one.landmark else several)

    @property
    def _number_of_colors(self) -> int:
        return max(1, len(self.colors.types))

    def told(self, word: str, type_: str) -> WordPosterior:
        """The learner with a noun settled on a type."""
        return replace(self, nouns=self.nouns.correct(word, type_))

    def with_names(self, *, evident: bool) -> WordPosterior:
        """The learner with the names of types and colours as evidence for words, or without."""
        assumed = self.assumed.with_names(evident=evident)
        nouns, colors = replace(self.nouns, prior=assumed.nouns), replace(self.colors, prior=assumed.colors)
        return replace(self, nouns=nouns, colors=colors, assumed=assumed)

    def forget(self, word: str) -> WordPosterior:
        """The learner as if a noun had never been heard."""
        return replace(self, nouns=self.nouns.forget(word))

    def with_frames(self, frames: FrameCounts | None) -> WordPosterior:
        """The learner with other counts of frames of reference."""
        return self if frames is None else replace(self, frames=frames)

    def with_readings(self, readings: Mapping[str, float]) -> WordPosterior:
        """The learner with other weights of readings."""
        return replace(self, readings=readings)

    def taught(self, taught: Taught) -> WordPosterior:
        """The learner with the words of lessons. What few lessons had is not settled: it is heard, as in a command."""
        nouns, colors = self.nouns.meet(taught.types), self.colors.meet(taught.colors)
        nouns, colors = _settled(nouns, taught.nouns), _settled(colors, taught.color_words)
        return replace(self, nouns=nouns, colors=colors, fixed=frozenset((*nouns.settled, *colors.settled)))

    def training_examples(self, features: FeatureSet) -> Sequence[Example]:
        """The examples of verbs and prepositions."""
        return self.examples

    def soft_labels(self, features: FeatureSet) -> Sequence[SoftLabels]:
        """The posterior as soft labels of phrases and objects."""
        return soft_labels(
            self.nouns,
            self.colors,
            self._rates,
            looked=frozenset({LOOKED_ROUND}),
            strength=self.assumed.strength,
            fixed=self.fixed,
            forgotten=sorted(features.nouns - {*self.nouns.posterior.words, *PLACE_WORDS, *GROUP_WORDS}),
        )

    @property
    def _rates(self) -> Unseen:
        """How much what the robot has not seen weighs."""
        hidden, census = self.assumed.hidden, self.census
        return Unseen(
            ahead=_rivals((census.rate * (self._number_of_colors - 1) + census.repeats) * OUT_OF_VIEW) + hidden,
            ahead_colored=_rivals(census.repeats * OUT_OF_VIEW) + hidden,
            after_full_scan=hidden,
        )

    def columns(self, features: FeatureSet) -> FeatureSet:
        """Columns for every word heard and every type and colour met."""
        return features.include(
            nouns=self.nouns.posterior.words,
            types=self.nouns.types,
            colors=(*self.colors.posterior.words, *self.colors.types),
        )

    def trainable(self, features: FeatureSet) -> Bools | None:
        """(L, G) the weights of nouns, colours, verbs and prepositions."""
        return believed_mask(features)

    def names(self) -> dict[str, str]:
        """type -> the word that most certainly names it, if any does."""
        best = self.nouns.posterior.best_of_all()
        sure = sorted((p, word, t) for word, (t, p) in best.items() if p >= _SURE and t != UNMET)
        return {t: word for _, word, t in sure}

    def meanings(self, word: str) -> dict[str, float]:
        """type -> probability that a noun names it."""
        return self.nouns.posterior.of(word)

    def beliefs(self, but: Collection[str]) -> dict[str, dict[str, float]]:
        """noun -> type -> probability, of all nouns `but` some; what is below a thousandth is left out."""
        posterior = self.nouns.posterior
        return {
            word: {t: round(p, 6) for t, p in posterior.of(word).items() if p >= 1e-3}
            for word in posterior.words
            if word not in but
        }

    def lexicon(self) -> list[Entry]:
        """Every noun with what it may mean, and from which commands."""
        return lexicon(self.nouns)


def _is_plain_noun(example: Example) -> bool:
    phrase = example.phrase
    return phrase.kind is PhraseKind.NOUN and not phrase.words and not example.children


def _rivals(expected: float) -> float:
    """The odds of the unseen objects of a kind against one that is seen, when each is meant as likely as any other.

    With n of them, n Poisson, that one is meant with probability E[1 / (1 + n)], which is more than 1 / (1 + E[n]).
    """
    return expected / -math.expm1(-expected) - 1.0 if expected > 1e-9 else expected / 2.0


def _settled(beliefs: Beliefs, said: Mapping[str, Mapping[str, int]]) -> Beliefs:
    """With the words of which lessons have said enough."""
    for word, of in said.items():
        most = max(of, key=lambda meaning: of[meaning])
        agreed = of[most] >= max(_AGREEING, _AGREED * sum(of.values()))
        if word not in beliefs.settled and (agreed or sum(of.values()) >= _MANY):
            beliefs = beliefs.correct(word, most)
    return beliefs
