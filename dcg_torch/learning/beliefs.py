"""The evidence about words, and the posterior over what they name.

A word names one type. A command with the word w, heard in a world, is evidence whatever the robot then did: the
speaker draws the object meant evenly from the world and names it, so that

    P(command | w names t)  ~  (1 - slip) * n[t]  +  slip / SPREAD * (n - n[t])                              (1)

with n[t] the number of objects of type t that fit the rest of the command (a stated colour), n their sum, and
`slip` the share of commands in which the word is not the right one for the type that the recogniser reports. What
may be there unseen counts too: n[t] gains the number of unseen objects to be expected of each type.

Given what words name, commands are independent, so that the sums of log (1) over a word's commands are sufficient:
a number per word and type met. Memory and time don't grow with the number of commands. Types that were in none of
a word's worlds share one number, `absent`.

The prior over assignments is that of `assignment`: words repel one another; a word that is settled holds its type
for certain, and other words can be further names of it. The same serves for colours, which are named as well.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field, replace
from functools import cached_property

import numpy as np

from dcg_torch.learning.assignment import marginals
from dcg_torch.names.weights import log_odds
from dcg_torch.types import OPAQUE
from dcg_torch.types.arrays import Floats

UNMET = "(unmet)"
"""Stands for all types that no object met so far was of."""
SPREAD = 10.0
"""Number of words among which a slip falls."""
_AKIN = 0.1
"""How readily a word is said of a type whose name means what the word's type is called."""
_SOURCES = 8  # commands kept for each word, the ones that told most


@dataclass(frozen=True, slots=True)
class Prior:
    """What is believed before anything is heard.

    Attributes:
        synonym: factor for a word that names a type which has a name already ("ball" for a sphere).
        unmet: weight of all types not met yet, where each met one has weight 1.
        slip: share of commands whose word is not the one for the type reported.
        names: are the names of types evidence for what words name? If not, they are opaque.
    """

    synonym: float = 0.05
    unmet: float = 1.0
    slip: float = 0.02
    names: bool = False

    def __post_init__(self) -> None:
        if not 0.0 < self.synonym <= 1.0:
            raise ValueError(f"synonym is {self.synonym}; a factor for further names lies above 0 and at most at 1")
        if not self.unmet > 0.0:
            raise ValueError(f"unmet is {self.unmet}; the weight of types not met must be positive")
        if not 0.0 < self.slip < 1.0:
            raise ValueError(f"slip is {self.slip}; a share between 0 and 1, both excluded, or no belief could change")


@dataclass(frozen=True, slots=True)
class Evidence:
    """One command (or answer, or correction) about one word.

    Attributes:
        word: the word heard.
        fitting: type -> number of objects seen of it that fit the rest of the command; fractions where unsure.
        unseen: number of further fitting objects of each type that may have been there unseen.
        source: which command, for the lexicon.
    """

    word: str
    fitting: Mapping[str, float]
    unseen: float = 0.0
    source: str = ""


@dataclass(frozen=True, slots=True)
class Heard:
    """All that is kept of a word's evidence: sums of log-likelihoods.

    Attributes:
        commands: how many there were.
        absent: of a type that was in none of the word's worlds.
        more: type -> what its sum is above `absent`.
        sources: (command, nats by which it told types apart), the most telling ones, in order of hearing.
    """

    commands: int = 0
    absent: float = 0.0
    more: Mapping[str, float] = field(default_factory=dict)
    sources: tuple[tuple[str, float], ...] = ()

    def of(self, type_: str) -> float:
        """The sum of log-likelihoods of one type."""
        return self.absent + self.more.get(type_, 0.0)


@dataclass(frozen=True)
class Posterior:
    """P(word names type).

    Attributes:
        words: the rows, settled ones first.
        types: the columns, the last of them UNMET.
        table: (W, T), rows sum to 1.
        new: (T,) the same for a word never heard.
    """

    words: tuple[str, ...]
    types: tuple[str, ...]
    table: Floats
    new: Floats

    def of(self, word: str) -> dict[str, float]:
        """type -> probability; that of a new word if it was never heard."""
        row = self.table[self._row[word]] if word in self._row else self.new
        return {t: float(p) for t, p in zip(self.types, row, strict=True)}

    def best(self, word: str) -> tuple[str, float]:
        """The most probable type of a word and its probability."""
        row = self.table[self._row[word]] if word in self._row else self.new
        at = int(row.argmax())
        return self.types[at], float(row[at])

    def best_of_all(self) -> dict[str, tuple[str, float]]:
        """word -> its most probable type, and the probability."""
        at = self.table.argmax(axis=1) if self.words else np.zeros(0, dtype=np.int64)
        found = self.table[np.arange(len(at)), at].tolist()
        return {w: (self.types[k], p) for w, k, p in zip(self.words, at.tolist(), found, strict=True)}

    @cached_property
    def _row(self) -> dict[str, int]:
        return {w: k for k, w in enumerate(self.words)}

    @cached_property
    def column(self) -> dict[str, int]:
        """Type -> its column."""
        return {t: k for k, t in enumerate(self.types)}


@dataclass(frozen=True)
class Beliefs:
    """What is known about the words of one category (nouns, or colours). A value: every change makes a new one.

    Attributes:
        prior: as above.
        settled: words whose meaning is given: known from the start, or corrected by a person.
        heard: the evidence about the other words, in the order of first hearing.
        types: the types met, in order.
    """

    prior: Prior = Prior()
    settled: Mapping[str, str] = field(default_factory=dict)
    heard: Mapping[str, Heard] = field(default_factory=dict)
    types: tuple[str, ...] = ()

    @classmethod
    def start(cls, settled: Mapping[str, str], prior: Prior | None = None) -> Beliefs:
        """Beliefs with some words known, and no evidence yet."""
        return cls(prior or Prior(), dict(settled), {}, tuple(dict.fromkeys(settled.values())))

    def meet(self, types: Iterable[str]) -> Beliefs:
        """The beliefs with these types among those met."""
        new = [t for t in dict.fromkeys(types) if t not in self.types]
        return replace(self, types=(*self.types, *new)) if new else self

    def weigh(self, evidence: Evidence) -> Beliefs:
        """The beliefs with one more piece of evidence. That about a settled word changes nothing."""
        beliefs = self.meet(t for t, n in evidence.fitting.items() if n > 0)
        if evidence.word in self.settled:
            return beliefs
        old = self.heard.get(evidence.word, Heard())
        absent, present = likelihoods(evidence, self.prior.slip)
        if not math.isfinite(absent):
            return beliefs
        more = dict(old.more)
        for t, value in present.items():
            more[t] = more.get(t, 0.0) + value - absent
        told = max((value - absent for value in present.values()), default=0.0)
        sources = [*old.sources, (evidence.source, told)]
        if len(sources) > _SOURCES:
            sources.remove(min(sources, key=lambda source: source[1]))
        new = Heard(old.commands + 1, old.absent + absent, more, tuple(sources))
        return replace(beliefs, heard={**beliefs.heard, evidence.word: new})

    def forget(self, word: str) -> Beliefs:
        """The beliefs without all that was heard of a word, be it settled or not."""
        return replace(
            self,
            settled={w: t for w, t in self.settled.items() if w != word},
            heard={w: h for w, h in self.heard.items() if w != word},
        )

    def correct(self, word: str, type_: str) -> Beliefs:
        """The beliefs with the word settled on a type, by someone who knows."""
        beliefs = self.forget(word).meet([type_])
        return replace(beliefs, settled={**beliefs.settled, word: type_})

    @cached_property
    def posterior(self) -> Posterior:
        """P(word names type), for every word heard, every type met, and a word never heard."""
        prior, types = self.prior, (*self.types, UNMET)
        column = {t: k for k, t in enumerate(types)}
        settled = set(self.settled.values())
        named = np.array([t in settled for t in self.types] + [False])
        free = ~named
        free[-1] = False
        weight = np.where(named, prior.synonym, 1.0)
        weight[-1] = prior.unmet
        scores = np.zeros((len(self.heard), len(types)))
        for row, heard in zip(scores, self.heard.values(), strict=True):
            for t, value in heard.more.items():
                row[column[t]] = value
        if prior.names:
            for row, word in zip(scores, self.heard, strict=True):
                row[:-1] += [0.0 if t.startswith(OPAQUE) else log_odds(word, t) for t in self.types]
        psi = np.exp(scores - scores.max(axis=1, initial=0.0, keepdims=True)) * weight
        found = marginals(psi, prior.synonym, free)
        fixed = np.zeros((len(self.settled), len(types)))
        fixed[np.arange(len(fixed)), [column[t] for t in self.settled.values()]] = 1.0
        new = weight * (1.0 - found.taken * (1.0 - prior.synonym))
        return Posterior((*self.settled, *self.heard), types, np.vstack([fixed, found.word]), new / new.sum())

    @cached_property
    def said_of(self) -> tuple[Floats, Floats]:
        """How readily each word is said of an object of each type: the posterior, with slips.

        Returns:
            (W, T) and (T,), the latter for a word never heard; as `posterior.table` and `posterior.new`.
        """
        slip = self.prior.slip
        table, new = self.posterior.table, self.posterior.new
        return (1.0 - slip) * table + slip / SPREAD * (1.0 - table), (1.0 - slip) * new + slip / SPREAD * (1.0 - new)

    def akin(self, word: str, type_: str) -> float:
        """How readily a word is said of a type because what it names is called alike, where that itself is not there.

        What one recogniser calls a laptop is a computer to another.
        """
        meaning, probability = self.posterior.best(word)
        if UNMET in (meaning, type_) or meaning == type_ or meaning.startswith(OPAQUE) or type_.startswith(OPAQUE):
            return 0.0
        return _AKIN * probability / (1.0 + math.exp(-log_odds(meaning, type_)))


def likelihoods(evidence: Evidence, slip: float) -> tuple[float, dict[str, float]]:
    """log of (1): of a type that was not seen, and of each that was.

    -inf for the first says that the evidence says nothing: nothing fits, and nothing may be there unseen.
    """
    total = math.fsum(evidence.fitting.values())

    def log_likelihood(n: float) -> float:
        value = (1.0 - slip) * (n + evidence.unseen) + slip / SPREAD * (total - n)
        return math.log(value) if value > 0.0 else -math.inf

    return log_likelihood(0.0), {t: log_likelihood(n) for t, n in evidence.fitting.items() if n > 0}
