"""Weights by the conditional likelihood of what is meant: which of the things of a scene, or which set of them.

A fit of labelled factors asks of each thing alone whether a phrase describes it. A command asks which one it means:
it may describe several, and one best. So commands whose objects are known are fitted by

    log p(meant)  = sum_j y_j (s_j - log sum_i exp s_i)                        one thing is meant
    log p(set)    = sum_j y_j log q_j + (1 - y_j) log(1 - q_j)                  all that is described is meant
    s_j           = log Psi(ACTIVE) - log Psi(INACTIVE) + sum_m log Psi_m(j)    as the factor graph scores it
    log q_j       = log Psi(ACTIVE) + sum_m log Psi_m(j)
    Psi_m(j)      = (1 - slip) sum_c p(c) Psi(asserted | j, c) + slip           `hypotheses.ModifierFactor`

with p(c), the probability of a modifier's landmarks, as the model has it before. What is denied of several landmarks
of one name counts for each of them here, where the graph takes the worst (`measured_relations.of_denied`). What
moves is the difference of the weights of ACTIVE and INACTIVE; their mean stays, and so do the weights of other
correspondences.

Conventions
    R rows of factors, distinct ones; N candidates, those of one choice after another; C choices
    cells: what fires of a phrase and a thing, each pair once; a row fires some of them, and a weight counts in some
    S terms of modifiers, those of one candidate and modifier (a slot) after another
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, field

import numpy as np

from dcg_torch.fitting import solvers
from dcg_torch.fitting.design import row_hashes, stack_bags
from dcg_torch.fitting.psi import Bag, LogLinearFactor
from dcg_torch.fitting.threads import one_thread
from dcg_torch.grounding.features import FeatureSet
from dcg_torch.grounding.hypotheses import SLIP
from dcg_torch.types import Correspondence, Phrase
from dcg_torch.types.arrays import Bools, Floats, Ints


@dataclass(frozen=True)
class Modified:
    """What a modifier says of the candidates of a choice.

    Attributes:
        bag: (c, n, k) its factors to each tuple of landmarks, of every candidate.
        log_prior: (c,) log p(c).
        denied: is it negated, so that INACTIVE is asserted?
    """

    phrase: Phrase
    bag: Bag
    log_prior: Floats
    denied: bool


@dataclass(frozen=True)
class Choice:
    """One noun phrase, the candidates that it chooses from, and which it means.

    Attributes:
        bag: (n, k) its factors.
        meant: (n,) the share of each candidate; of a set, 1 for every member.
        weight: in the likelihood.
        a_set: are all meant that the phrase describes?
    """

    phrase: Phrase
    bag: Bag
    meant: Floats
    weight: float = 1.0
    modifiers: tuple[Modified, ...] = ()
    a_set: bool = False


@dataclass
class _Rows:
    """Rows of factors as they are gathered, with a number for every phrase."""

    phrases: dict[Phrase, int] = field(default_factory=dict)
    bags: list[Bag] = field(default_factory=list)
    phrase: list[Ints] = field(default_factory=list)
    count: int = 0

    def add(self, phrase: Phrase, bag: Bag) -> Ints:
        """The numbers of new rows."""
        number = self.phrases.setdefault(phrase, len(self.phrases))
        self.bags.append(bag)
        self.phrase.append(np.full(len(bag), number))
        self.count += len(bag)
        return np.arange(self.count - len(bag), self.count)


class Likelihood:
    """The penalised negative log-likelihood of choices, as a function of the differences of free weights.

    Args:
        choices: at least one.
        free: (L, G) the features that may move; None: all.
        l2: strength of the penalty on the distance from `prior`.
        prior: (P, L, G) weights that cost nothing.
    """

    def __init__(
        self,
        choices: Sequence[Choice],
        features: FeatureSet,
        factor: LogLinearFactor,
        *,
        free: Bools | None,
        l2: float,
        prior: Floats,
    ) -> None:
        from scipy.sparse import csr_array  # here: only who teaches needs it

        self._l2 = l2
        rows = _Rows()
        noun, term = self._gather(choices, rows)
        languages, groundings = features.shape
        bag = stack_bags(rows.bags)
        phrase = np.concatenate(rows.phrase)
        cell = np.where(bag < 0, -1, bag + (phrase * groundings)[:, None])
        first, which = np.unique(row_hashes(cell), return_index=True, return_inverse=True)[1:]
        self._noun: Ints = which[noun]  # rows that fire the same are one
        self._term: Ints = which[term]
        cell = cell[first]
        row, k = np.nonzero(cell >= 0)
        cells, of_row = np.unique(cell[row, k], return_inverse=True)
        self._rows = csr_array((np.ones(len(row)), (row, of_row)), shape=(len(cell), len(cells)))
        language = features.encode_phrases(list(rows.phrases))[cells // groundings]
        at, k = np.nonzero(language >= 0)
        fires = language[at, k] * groundings + (cells % groundings)[at]
        active = features.pairs & (np.bincount(fires, minlength=languages * groundings) > 0).reshape(features.shape)
        self.free: Bools = active if free is None else active & free
        moves = self.free.ravel()[fires]
        number = np.cumsum(self.free) - 1
        self._moves = csr_array(
            (np.ones(int(moves.sum())), (at[moves], number[fires[moves]])), shape=(len(cells), int(self.free.sum()))
        )
        weight = factor.weight.detach().cpu().numpy()
        self._signs = correspondence_signs(factor)
        adds = csr_array((np.ones(len(at)), (at, fires)), shape=(len(cells), languages * groundings))
        self._fixed: list[Floats] = [self._rows @ (adds @ (w * features.pairs).ravel()) for w in weight]
        self._asserted = factor.correspondences.index(Correspondence.ACTIVE)
        self._denied = factor.correspondences.index(Correspondence.INACTIVE)
        told = np.where(self._is_denied, self._denied, self._asserted)
        self._told: Ints = told * len(cell) + self._term  # where in a table of log Psi a term's is
        self._sign: Floats = self._signs[told]
        self.start: Floats = (weight[self._asserted] - weight[self._denied])[self.free]
        self._centre: Floats = (prior[self._asserted] - prior[self._denied])[self.free]

    def _gather(self, choices: Sequence[Choice], rows: _Rows) -> tuple[Ints, Ints]:
        """The rows of all nouns and of all terms."""
        noun, term, slot, log_prior, denied, candidate = [], [], [], [], [], []
        begins, slots = 0, 0
        for choice in choices:
            n = len(choice.meant)
            noun.append(rows.add(choice.phrase, choice.bag))
            for modifier in choice.modifiers:
                c = len(modifier.log_prior)
                own = rows.add(modifier.phrase, modifier.bag.reshape(c * n, -1))
                term.append(own.reshape(c, n).T.ravel())
                slot.append(np.repeat(np.arange(slots, slots + n), c))
                log_prior.append(np.tile(modifier.log_prior, n))
                denied.append(np.full(c * n, modifier.denied))
                candidate.append(np.arange(begins, begins + n))
                slots += n
            begins += n
        sizes = [len(choice.meant) for choice in choices]
        self._begin = np.concatenate([[0], np.cumsum(sizes)[:-1]]).astype(np.int64)
        self._choice = np.repeat(np.arange(len(choices)), sizes)
        self._meant = np.concatenate([choice.meant for choice in choices])
        self._weight: Floats = np.array([choice.weight for choice in choices])[self._choice]
        self._in_a_set: Ints = np.flatnonzero(np.array([choice.a_set for choice in choices])[self._choice])
        self._slot = np.concatenate(slot) if slot else np.zeros(0, dtype=np.int64)
        self._log_prior = np.concatenate(log_prior) if term else np.zeros(0)
        self._is_denied = np.concatenate(denied) if term else np.zeros(0, dtype=np.bool_)
        self._candidate = np.concatenate(candidate) if term else np.zeros(0, dtype=np.int64)
        self._slot_begin = np.searchsorted(self._slot, np.arange(slots))
        self._candidate_of_term: Ints = self._candidate[self._slot]
        return np.concatenate(noun), np.concatenate(term) if term else np.zeros(0, dtype=np.int64)

    def __call__(self, at: Floats) -> solvers.Point:
        """Value and gradient where the differences of the free weights are `at`."""
        moved = self._rows @ (self._moves @ (at - self.start))
        table = np.stack([own + sign * moved for own, sign in zip(self._fixed, self._signs, strict=True)])
        table -= np.logaddexp.reduce(table, axis=0)
        # d log Psi(phi) / d move = sign(phi) - sum over phi' of sign(phi') Psi(phi')
        mean = self._signs @ np.exp(table)
        said, kept = self._modifiers(table)
        value, by_noun, by_modifiers = self._choices(table, said)
        of_noun = by_noun[0] * (self._signs[self._asserted] - mean[self._noun])
        of_noun += by_noun[1] * (self._signs[self._denied] - mean[self._noun])
        of_term = by_modifiers[self._candidate_of_term] * kept * (self._sign - mean[self._term])
        slope = np.bincount(self._noun, of_noun, minlength=len(moved))
        slope += np.bincount(self._term, of_term, minlength=len(moved))
        gradient = self._moves.T @ (self._rows.T @ slope)
        distance = at - self._centre
        value += 0.25 * self._l2 * float(distance @ distance)
        gradient += 0.5 * self._l2 * distance
        return solvers.Point(at, value, gradient, float(np.abs(gradient).max(initial=0.0)), np.zeros(0))

    def _modifiers(self, table: Floats) -> tuple[Floats, Floats]:
        """(N,) what all modifiers say of a candidate, and (S,) the share of each term in it."""
        said = np.zeros(len(self._noun))
        if not len(self._term):
            return said, np.zeros(0)
        summand = table.take(self._told) + self._log_prior
        most = np.maximum.reduceat(summand, self._slot_begin)
        total = np.log(np.add.reduceat(np.exp(summand - most[self._slot]), self._slot_begin)) + most
        of_slot = np.logaddexp(math.log1p(-SLIP) + total, math.log(SLIP))
        np.add.at(said, self._candidate, of_slot)
        return said, np.exp(math.log1p(-SLIP) + summand - of_slot[self._slot])

    def _choices(self, table: Floats, said: Floats) -> tuple[float, tuple[Floats, Floats], Floats]:
        """The value, and its derivatives by log Psi(ACTIVE) and log Psi(INACTIVE) of the nouns and by `said`, (N,)."""
        active, inactive = table[self._asserted, self._noun], table[self._denied, self._noun]
        score = active - inactive + said
        most = np.maximum.reduceat(score, self._begin)[self._choice]
        odds = np.exp(score - most)
        total = np.add.reduceat(odds, self._begin)
        log_likelihood = self._meant * (score - most - np.log(total)[self._choice])
        by_said = -self._weight * (self._meant - odds / total[self._choice])
        by_inactive = -by_said
        if len(self._in_a_set):
            some = self._in_a_set
            meant, described = self._meant[some], np.minimum(active[some] + said[some], -1e-9)
            log_not = np.log(-np.expm1(described))
            log_likelihood[some] = meant * described + (1.0 - meant) * log_not
            by_said[some] = -self._weight[some] * (meant - (1.0 - meant) * np.exp(described - log_not))
            by_inactive[some] = 0.0
        return -float((self._weight * log_likelihood).sum()), (by_said, by_inactive), by_said


def correspondence_signs(factor: LogLinearFactor) -> Floats:
    """(P,) how far each correspondence's weight moves when the difference of ACTIVE and INACTIVE does."""
    half = {Correspondence.ACTIVE: 0.5, Correspondence.INACTIVE: -0.5}
    return np.array([half.get(c, 0.0) for c in factor.correspondences])


def fit_choices(
    factor: LogLinearFactor,
    choices: Sequence[Choice],
    features: FeatureSet,
    *,
    free: Bools | None,
    l2: float,
    prior: Floats,
    max_steps: int = 60,
    tolerance: float = 1e-3,
) -> Bools:
    """Move the free weights of a factor to the likeliest of choices, in place, by L-BFGS.

    Args:
        free, l2, prior: as for `Likelihood`.
        max_steps: at the most.
        tolerance: max-norm of the gradient at which the fit has arrived.

    Returns:
        (L, G) the features that fired and were free.
    """
    if not choices:
        return np.zeros(features.shape, dtype=np.bool_)
    function = Likelihood(choices, features, factor, free=free, l2=l2, prior=prior)
    with one_thread():
        found = solvers.lbfgs(function, function.start, tolerance=tolerance, max_steps=max_steps)
    weight = factor.weight.detach().cpu().numpy().copy()
    for own, sign in zip(weight, correspondence_signs(factor), strict=True):
        own[function.free] += sign * (found.point.at - function.start)
    factor.set_weight(weight)
    return function.free
