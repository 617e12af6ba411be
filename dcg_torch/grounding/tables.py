"""log Psi of the phrases of one command: tables over the things of a world.

Rows of features that are alike are scored once. As in `LogLinearFactor.log_psi`, equal factors have equal bits wherever
they stand: sums go column by column, in an order that depends on what fires alone.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from fractions import Fraction

import numpy as np
import torch

from dcg_torch import scene
from dcg_torch.fitting.psi import Bag, LogLinearFactor
from dcg_torch.grounding.encoding import WorldEncoder
from dcg_torch.grounding.features import FeatureSet, Ranking, Said, padded, ranking
from dcg_torch.types import Child, Correspondence, GroundingKind, Object, Phrase
from dcg_torch.types.arrays import Floats

_ENTRIES = 1 << 16
"""Weights that are gathered at once; beyond, they are added column by column."""
_PHRASES = 1024
"""Phrases of which tables are kept, at the most."""
_FEW = 256
"""Values up to which a sum is taken of them written out."""


Pattern = tuple[tuple[tuple[str, int], ...], tuple[bool, ...]]
"""Of a region or action, the kind and correspondence of each child grounding, and which are about the same object."""


class Tables:
    """The tables of several phrases under the weights as they are now; to be thrown away when these change.

    What depends on the phrase alone is kept: of every command it is much the same.

    Args:
        features: the columns.
        factor: the weights.
    """

    def __init__(self, features: FeatureSet, factor: LogLinearFactor) -> None:
        self.features = features
        self.factor = factor
        self._of = weight = factor.weight
        self._version = _version(weight)
        self._weight = None if weight.device.type != "cpu" or weight.requires_grad else weight.numpy()
        self._sides: dict[Phrase, Floats] = {}
        self._ranking: dict[Phrase, bool] = {}
        self._related: dict[Phrase, Floats] = {}
        self._patterns: dict[Phrase, dict[Pattern, Floats]] = {}
        self._spread: dict[tuple[Phrase, int], dict[object, Floats]] = {}

    def hold(self, features: FeatureSet, factor: LogLinearFactor) -> bool:
        """Are these still the tables of such columns and weights?"""
        weight = factor.weight
        same = self.features is features and self.factor is factor and self._of is weight
        return same and self._version == _version(weight) and len(self._sides) < _PHRASES > len(self._spread)

    def noun(self, encoder: WorldEncoder, phrase: Phrase, members: np.ndarray | None = None) -> Floats:
        """(P, things) log Psi of a noun phrase.

        Args:
            members: (things,) those among which it ranks; None: all.
        """
        ranks = bool(phrase.words) and self._weighs_ranks(phrase)
        coded = encoder.noun(phrase, members) if ranks else encoder.unranked(phrase)
        table = self._log_psi(phrase, coded.bag)
        return table if coded.code is None else table[:, coded.code]

    def _weighs_ranks(self, phrase: Phrase) -> bool:
        """Is there a weight between a word of a phrase and some rank? Without one it matters not which ranks fire."""
        if self._weight is None:
            return True
        found = self._ranking.get(phrase)
        if found is None:
            ranks = self.features.rank_of
            found = self._ranking[phrase] = bool(self._side(phrase)[:, ranks[ranks >= 0]].any())
        return found

    def unranked(self, encoder: WorldEncoder, phrase: Phrase) -> Floats:
        """(P, things) log Psi of a noun phrase as if it ranked nothing."""
        coded = encoder.unranked(phrase)
        table = self._log_psi(phrase, coded.bag)
        return table if coded.code is None else table[:, coded.code]

    def log_odds(self, encoder: WorldEncoder, phrase: Phrase) -> Floats:
        """(objects,) log-odds of ACTIVE against INACTIVE of a noun phrase as if it ranked nothing."""
        return self._against_inactive(self.unranked(encoder, phrase)[:, : len(encoder.world.objects)])

    def log_odds_of(self, phrase: Phrase, things: Sequence[Object]) -> Floats:
        """(things,) such log-odds of things that need not be in the world."""
        named = self.features.said_columns(Said.of(phrase), things, [-1] * len(things))
        bag = padded([self.features.thing_columns(o) + said for o, said in zip(things, named, strict=True)])
        return self._against_inactive(self._log_psi(phrase, bag))

    def _against_inactive(self, table: Floats) -> Floats:
        of = self.factor.correspondences.index
        odds: Floats = table[of(Correspondence.ACTIVE)] - table[of(Correspondence.INACTIVE)]
        return odds

    def placed(
        self,
        encoder: WorldEncoder,
        phrase: Phrase,
        landmarks: Sequence[tuple[int, ...]],
        members: np.ndarray | None = None,
    ) -> Floats:
        """(P, landmarks, things) log Psi of a modifier, to each tuple of numbers of landmarks; all are as long.

        Args:
            members: (things,) those among which it ranks; None: all of a kind.
        """
        counted = ranking(phrase) or Ranking("all")
        n = len(encoder.all)
        if self._weight is None or not encoder.related:
            bag = encoder.placed(landmarks, counted, members)
            table = self._log_psi(phrase, bag.reshape(-1, bag.shape[2]))
            return table.reshape(len(table), len(landmarks), n)
        side = self._side(phrase)
        own = self._related.get(phrase)
        if own is None:
            own = self._related[phrase] = side[:, self.features.relation_of]
        first = list(dict.fromkeys([of[0] for of in landmarks]))
        out = side[:, self.features.placed_column, None].repeat(len(first) * n, axis=1)
        step = max(1, _ENTRIES // (n * 16))
        for start in range(0, len(first), step) if own.any() else ():  # "facing" is measured alone
            part = [(j,) for j in first[start : start + step]]
            flat = encoder.relations(part, counted, members).reshape(-1, len(part) * n)
            flat = flat[flat.max(axis=1, initial=-1) >= 0].astype(np.int64)  # to most things half of them tell nothing
            _add(out[:, start * n : (start + len(part)) * n], own, flat)
        out = out.reshape(len(side), -1, n)
        if landmarks and len(landmarks[0]) > 1:
            out = out[:, [first.index(of[0]) for of in landmarks]]
            out += own[:, scene.between(encoder.layout, landmarks)]
        return _normal(out)

    def patterns(self, phrase: Phrase, kind: GroundingKind, patterns: Mapping[Pattern, Sequence[Child]]) -> Floats:
        """(P, patterns) log Psi of regions or actions.

        Args:
            patterns: of each, some child groundings that are such.
        """
        kept = self._patterns.get(phrase)
        if kept is None:
            kept = self._patterns[phrase] = {}
        if new := [pattern for pattern in patterns if pattern not in kept]:
            columns = [self.features.action_columns(kind, patterns[pattern], pattern[1]) for pattern in new]
            kept.update(zip(new, self._log_psi(phrase, padded(columns)).T, strict=True))
        return np.array([kept[pattern] for pattern in patterns]).T

    def spread(self, phrase: Phrase, count: int) -> dict[object, Floats]:
        """What is kept of a region or an action among so many things; more is added, see `patterns.Spread`."""
        return self._spread.setdefault((phrase, count), {})

    def _side(self, phrase: Phrase) -> Floats:
        """(P, G + 1) the weights that meet what fires for a phrase, summed; the last column is the padding's."""
        found = self._sides.get(phrase)
        if found is None:
            assert self._weight is not None
            found = np.zeros((len(self._weight), self._weight.shape[2] + 1))
            columns = sorted({self.features.language[name] for name in self.features.language_names(phrase)})
            self._weight[:, columns].sum(axis=1, out=found[:, :-1])
            self._sides[phrase] = found
        return found

    def _log_psi(self, phrase: Phrase, bag: Bag) -> Floats:
        """(P, n) of the rows (n, k) of a bag, in which no column stands twice, and those that fire in one order."""
        if self._weight is None:
            language = self.features.encode_phrases([phrase])
            with torch.no_grad():
                found = self.factor.log_psi(language, bag, np.zeros(len(bag), dtype=np.int64))
            return found.cpu().numpy().T
        side = self._side(phrase)
        total = np.zeros((len(side), len(bag)))
        _add(total, side, bag.T)
        return _normal(total)


def _version(weight: torch.Tensor) -> int:
    """Grows when someone changes the values in place; torch keeps no count of tensors made in its inference mode."""
    return 0 if weight.is_inference() else weight._version


def _add(total: Floats, table: Floats, columns: Bag) -> None:
    """Add to (P, n) the entries (P, m) of a table that (k, n) columns name, in their order; in place."""
    if columns.size * len(table) <= _ENTRIES:
        gathered = table.take(columns, axis=1)
        if len(columns):
            gathered[:, 0] += total
            gathered.sum(axis=1, out=total)
        return
    for column in columns:
        total += table.take(column, axis=1)


def _normal(total: Floats) -> Floats:
    """Scores (P, n) as log-probabilities, in place."""
    total -= total.max(axis=0)
    total -= np.log(np.exp(total).sum(axis=0))
    return total


def exact_sum(values: Sequence[float], times: Sequence[int]) -> float:
    """The sum of values, each so many times, rounded once: the order of things changes no bit of it."""
    if sum(times) <= _FEW:
        return math.fsum([v for v, t in zip(values, times, strict=True) for _ in range(t)])
    return float(sum(Fraction(v) * t for v, t in zip(values, times, strict=True)))
