"""What a model asks of the part of it that learns, and what came of a command that it heard."""

from __future__ import annotations

from collections.abc import Collection, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Protocol

from dcg_torch.grounding.features import FeatureSet
from dcg_torch.grounding.solution import Solution
from dcg_torch.grounding.statistics import SoftLabels
from dcg_torch.learning.census import FrameCounts
from dcg_torch.learning.evidence import Ground
from dcg_torch.learning.lexicon import Entry
from dcg_torch.types import Example, Symbol
from dcg_torch.types.arrays import Bools


@dataclass(frozen=True, slots=True)
class Experience:
    """How a command was carried out, as far as it bears on what can be learned.

    Attributes:
        looked: had the robot seen all the ground that it can?
        certain: did the speaker say which object is meant?
        taught: is it a lesson, from which the weights have been fitted already?
        source: which command it was, for the lexicon.
    """

    looked: bool = False
    certain: bool = False
    taught: bool = False
    source: str = ""


@dataclass(frozen=True, slots=True)
class TrainingSet:
    """The labelled examples of Alg. 1, line 5, with the symbols and colours that they make known."""

    symbols: tuple[Symbol, ...]
    colors: tuple[str, ...]
    examples: tuple[Example, ...]


@dataclass(frozen=True, slots=True)
class Learned:
    """What came of a command for the lexicon. True where a symbol was made or changed.

    Attributes:
        symbol: made or changed by this command.
        reason: why there is none, one sentence; None where there is one.
    """

    symbol: Symbol | None = None
    reason: str | None = None

    def __bool__(self) -> bool:
        return self.symbol is not None


class Learner(Protocol):
    """What a model has learned of words, as a frozen value, and how it goes on.

    The weights of the model follow from `training_examples` and `soft_labels`: one fit of those that are `trainable`.
    """

    @property
    def symbols(self) -> Mapping[str, Symbol]:
        """The words that are held to name a type."""

    @property
    def known_types(self) -> tuple[str, ...]:
        """The types that are known: in the order in which they became so."""

    @property
    def settled(self) -> frozenset[str]:
        """The words of which nothing is left to be learned."""

    @property
    def open_words(self) -> frozenset[str]:
        """The nouns and words for colours that were heard, and of which something is left to be learned."""

    @property
    def frames(self) -> FrameCounts | None:
        """Whose left and right are meant; None where there is one frame of reference alone."""
        ...

    @property
    def readings(self) -> Mapping[str, float]:
        """ "rule=option" -> what was learned to add to the log-weight of a reading that takes the option."""
        ...

    def hear(self, solution: Solution, experience: Experience, ground: Ground) -> tuple[Learner, Learned]:
        """The learner after a command."""

    def told(self, word: str, type_: str) -> Learner:
        """The learner after a person said what a noun names."""

    def forget(self, word: str) -> Learner:
        """The learner without all that it heard of a noun."""

    def with_frames(self, frames: FrameCounts | None) -> Learner:
        """The learner with other counts of frames of reference."""
        ...

    def with_readings(self, readings: Mapping[str, float]) -> Learner:
        """The learner with other weights of readings."""
        ...

    def taught(self, taught: Taught) -> Learner:
        """The learner after lessons whose objects were known."""

    def training_examples(self, features: FeatureSet) -> Sequence[Example]:
        """What the weights are to follow; one that was there before is the same object again."""

    def soft_labels(self, features: FeatureSet) -> Sequence[SoftLabels]:
        """What else they are to follow: of every one of some phrases with every one of some objects."""

    def columns(self, features: FeatureSet) -> FeatureSet:
        """The features, with columns for all that has been learned."""

    def trainable(self, features: FeatureSet) -> Bools | None:
        """(L, G) the weights that follow from the training examples; None: all."""

    def names(self) -> dict[str, str]:
        """type -> a word for it that the robot holds for certain."""

    def meanings(self, word: str) -> dict[str, float]:
        """type -> probability that a noun names it."""

    def beliefs(self, but: Collection[str]) -> dict[str, dict[str, float]] | None:
        """noun -> type -> probability, of all nouns `but` some; None where there are no degrees of belief."""

    def lexicon(self) -> list[Entry]:
        """Every noun with what it may mean, and from which commands."""


@dataclass(frozen=True)
class Taught:
    """What lessons with known objects say of words.

    Attributes:
        types: of all objects meant.
        colors: words for colours, and colours, that were met.
        nouns: noun -> type -> in how many lessons it was said of it.
        color_words: the same for words for colours.
        passed: noun -> type -> in how many lessons it was said of another type though such a thing was there.
    """

    types: tuple[str, ...]
    colors: tuple[str, ...]
    nouns: Mapping[str, Mapping[str, int]]
    color_words: Mapping[str, Mapping[str, int]]
    passed: Mapping[str, Mapping[str, int]] = field(default_factory=dict)

    def denies(self, noun: str, type_: str) -> bool:
        """Do lessons tell that a noun hardly names a type: was it said of others where there was one to choose?"""
        passed = self.passed.get(noun, {}).get(type_, 0)
        return passed > _PASSED * (passed + self.nouns.get(noun, {}).get(type_, 0))


_PASSED = 0.2
"""Share of lessons with a noun and a thing of a type that may be about another thing, if the noun names the type."""
