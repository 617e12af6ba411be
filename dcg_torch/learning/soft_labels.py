"""The posterior as soft labels of the log-linear model.

A grounding's probability is the softmax over objects of the log-odds of ACTIVE against INACTIVE, so the model says
what the posterior says once these odds are proportional to P(this object | command). That is how a ratio of
densities is estimated by logistic regression from true and from contrasting examples (noise-contrastive estimation,
Gutmann and Hyvarinen 2010): of every pair of phrase and object there are ACTIVE examples in the amount of the
posterior, and INACTIVE ones in an amount that is the same for all:

    odds(object | word, colour)  =  said_of[word, type]  *  said_of[colour word, colour]  *  expected number    (2)

where the expected number is 1 for an object that is perceived and less for a hypothetical one. The weights of a pair
are scaled so that each has the same curvature, `strength`: the fit is then well conditioned, and rare pairs are met
as exactly as common ones. All of (2) is a sum of features in the logarithm, so few pairs suffice: each word with
each type, each colour word with each colour, and the hypothetical objects once.
"""

from __future__ import annotations

import functools
from collections.abc import Collection, Iterator, Sequence
from dataclasses import dataclass

import numpy as np

from dcg_torch.grounding.statistics import SoftLabels
from dcg_torch.learning.beliefs import UNMET, Beliefs
from dcg_torch.types import Object, Phrase, PhraseKind
from dcg_torch.types.arrays import Bools, Floats

NEVER_HEARD = "(never heard)"
"""A noun and a colour word that nobody says; it has no column, as no unheard word has."""


@dataclass(frozen=True, slots=True)
class Unseen:
    """How much the objects of a type that the robot has not seen weigh against one that it has.

    Attributes:
        ahead: before it has looked round, no colour said.
        ahead_colored: the same, those of the colour said.
        after_full_scan: after it has looked round, for what is hidden or not there at all.
    """

    ahead: float
    ahead_colored: float
    after_full_scan: float


def soft_labels(
    nouns: Beliefs,
    colors: Beliefs,
    unseen: Unseen,
    *,
    looked: frozenset[str],
    strength: float = 5.0,
    forgotten: Collection[str] = (),
    fixed: Collection[str] = (),
) -> list[SoftLabels]:
    """Equation (2) as soft labels.

    Args:
        nouns: what the nouns name; at least one is settled.
        colors: what the colour words name.
        unseen: rates of what may be there unseen.
        looked: the attributes of hypothetical objects once the robot has looked round.
        strength: curvature of each pair's likelihood, in examples.
        fixed: words whose weights are not to follow from the posterior; they are left out.
        forgotten: nouns that have columns and no meaning any more: they are as if never heard.
    """
    found = [
        *_nouns(nouns, forgotten, fixed),
        *_colors(nouns, colors, fixed),
        *_unseen(nouns, colors, unseen, looked),
        *_unnamed(nouns, colors, unseen, looked),
    ]
    return [_labelled(table, strength) for table in found if table.phrases]


@dataclass(frozen=True)
class _Odds:
    """(phrases, objects) the odds for ACTIVE against INACTIVE that each pair is to have; `shown` are those in use."""

    phrases: Sequence[Phrase]
    objects: Sequence[Object]
    odds: Floats
    shown: Bools | None = None


def _labelled(table: _Odds, strength: float) -> SoftLabels:
    shown = np.ones(table.odds.shape, dtype=np.bool_) if table.shown is None else table.shown
    odds = np.clip(table.odds[shown], 1e-6, 1e6)
    active, inactive = np.zeros(shown.shape), np.zeros(shown.shape)
    # weights a and b with a / b = odds and a b / (a + b) = strength
    active[shown], inactive[shown] = strength * (1.0 + odds), strength * (1.0 + 1.0 / odds)
    return SoftLabels(table.phrases, table.objects, active, inactive, table.shown)


_MANY = 40
"""Types with which every noun is shown; where there are more, names and nothing but names tell the others apart."""


def _nouns(nouns: Beliefs, forgotten: Collection[str], fixed: Collection[str]) -> Iterator[_Odds]:
    """Every noun with a perceived object of every type, no colour said.

    Of many types a noun is shown with those that it was heard among, and with the first `_MANY` of all.
    """
    table, new = nouns.said_of
    types, column = nouns.posterior.types, nouns.posterior.column
    words = [(word, row) for word, row in enumerate(nouns.posterior.words) if row not in fixed]
    heard = [[column[t] for t in nouns.heard[word].more] if word in nouns.heard else [] for _, word in words]
    kept = sorted({*range(min(_MANY, len(types))), len(types) - 1, *(k for of in heard for k in of)})
    unheard = (NEVER_HEARD, *forgotten)
    known = table[np.ix_([k for k, _ in words], kept)]
    odds = np.vstack([known, np.broadcast_to(new[kept], (len(unheard), len(kept)))])
    shown = np.zeros(odds.shape, dtype=np.bool_)
    shown[:, :_MANY] = shown[:, -1] = True
    place = {k: at for at, k in enumerate(kept)}
    for k, ((_, word), of) in enumerate(zip(words, heard, strict=True)):
        shown[k, [place[t] for t in of]] = True
        if nouns.prior.names:
            among = np.flatnonzero(shown[k])
            odds[k, among] = np.maximum(odds[k, among], [nouns.akin(word, types[kept[at]]) for at in among])
    phrases = [_phrase(word) for word in (*(word for _, word in words), *unheard)]
    yield _Odds(phrases, [_object(types[k]) for k in kept], odds, shown)


def _colors(nouns: Beliefs, colors: Beliefs, fixed: Collection[str]) -> Iterator[_Odds]:
    """Every colour word with every colour, on a known type and on one not met."""
    table, new = colors.said_of
    words = [*((w, row) for w, row in zip(colors.posterior.words, table, strict=True) if w not in fixed)]
    words.append((NEVER_HEARD, new))
    for noun, type_, scale in _anchors(nouns):
        objects = [_object(type_, color) for color in colors.posterior.types]
        yield _Odds([_phrase(noun, word) for word, _ in words], objects, scale * np.stack([row for _, row in words]))


def _unseen(nouns: Beliefs, colors: Beliefs, unseen: Unseen, looked: frozenset[str]) -> Iterator[_Odds]:
    """Hypothetical objects, of a known type and of one not met, with a colour said and without."""
    color = next(iter(colors.posterior.words), None)
    for noun, type_, scale in _anchors(nouns):
        for said, ahead in ((None, unseen.ahead), (color, unseen.ahead_colored)):
            odds = scale * np.array([[ahead, unseen.after_full_scan]])
            yield _Odds([_phrase(noun, said)], _hypothetical(type_, looked), odds)


def _unnamed(nouns: Beliefs, colors: Beliefs, unseen: Unseen, looked: frozenset[str]) -> Iterator[_Odds]:
    """A phrase without a noun, with a colour said and without: a perceived and an unseen object of every type."""
    said: list[tuple[str | None, str | None, float, float]] = [(None, None, 1.0, unseen.ahead)]
    if colors.posterior.words:
        row = colors.said_of[0][0]
        color = colors.posterior.types[int(row.argmax())]
        said.append((colors.posterior.words[0], color, float(row.max()), unseen.ahead_colored))
    for word, color_of, odds, ahead in said:
        objects = [_object(type_, color_of) for type_ in nouns.posterior.types]
        values = [odds] * len(objects)
        for _, type_, _ in _anchors(nouns):
            objects += _hypothetical(type_, looked)
            values += [ahead, unseen.after_full_scan]
        yield _Odds([_phrase(None, word)], objects, np.array([values]))


def _anchors(nouns: Beliefs) -> Iterator[tuple[str, str, float]]:
    """A known noun with its type, and an unheard one with a type not met: on these, all else is shown."""
    table, new = nouns.said_of
    posterior = nouns.posterior
    if posterior.words:
        at = int(table[0].argmax())
        yield posterior.words[0], posterior.types[at], float(table[0, at])
    yield NEVER_HEARD, UNMET, float(new[-1])


@functools.lru_cache(maxsize=1 << 16)
def _phrase(noun: str | None, color: str | None = None) -> Phrase:
    return Phrase(PhraseKind.NOUN, " ".join(filter(None, (color, noun or "one"))), noun=noun, color=color)


def _hypothetical(type_: str, looked: frozenset[str]) -> list[Object]:
    """The unseen object of a type, before the robot has looked round and after."""
    return [_object(type_, hypothetical=True, attributes=attributes) for attributes in (frozenset[str](), looked)]


@functools.lru_cache(maxsize=1 << 16)
def _object(
    type_: str, color: str | None = None, *, hypothetical: bool = False, attributes: frozenset[str] = frozenset()
) -> Object:
    name = " ".join(filter(None, ("hypothetical" if hypothetical else "", *sorted(attributes), color, type_)))
    met = type_ != UNMET
    return Object(name, type_ if met else None, met, hypothetical, color, attributes=attributes)
