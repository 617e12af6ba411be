"""The posterior as training examples of the log-linear model.

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

from collections.abc import Collection, Iterable, Iterator
from dataclasses import dataclass

import numpy as np

from dcg_torch.learning.beliefs import UNMET, Beliefs
from dcg_torch.types import Correspondence, Example, Object, Phrase, PhraseKind, WorldModel

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


@dataclass(frozen=True, slots=True)
class Pair:
    """A phrase and an object, and the odds for ACTIVE against INACTIVE that it is to have."""

    phrase: Phrase
    object: Object
    odds: float


def soft_examples(
    nouns: Beliefs,
    colors: Beliefs,
    unseen: Unseen,
    *,
    looked: frozenset[str],
    strength: float = 5.0,
    forgotten: Collection[str] = (),
    fixed: Collection[str] = (),
) -> list[Example]:
    """Equation (2) as examples.

    Args:
        nouns: what the nouns name; at least one is settled.
        colors: what the colour words name.
        unseen: rates of what may be there unseen.
        looked: the attributes of hypothetical objects once the robot has looked round.
        strength: curvature of each pair's likelihood, in examples.
        fixed: words whose weights are not to follow from the posterior; they are left out.
        forgotten: nouns that have columns and no meaning any more: they are as if never heard.
    """
    pairs = [*_nouns(nouns, forgotten, fixed), *_colors(nouns, colors, fixed), *_unseen(nouns, colors, unseen, looked)]
    pairs += _unnamed(nouns, colors, unseen, looked)
    return list(pair_examples(pairs, strength))


_MANY = 40
"""Types with which every noun is shown; where there are more, names and nothing but names tell the others apart."""


def _nouns(nouns: Beliefs, forgotten: Collection[str], fixed: Collection[str]) -> Iterator[Pair]:
    """Every noun with a perceived object of every type, no colour said.

    Of many types a noun is shown with those that it was heard among, and with the first `_MANY` of all.
    """
    table, new = nouns.said_of()
    things = [_object(type_) for type_ in nouns.posterior.types]
    unheard = (NEVER_HEARD, *forgotten)
    for word, row in zip((*nouns.posterior.words, *unheard), (*table, *([new] * len(unheard))), strict=True):
        if word in fixed:
            continue
        phrase, heard = _phrase(word), nouns.heard[word].more if word in nouns.heard else {}
        for k, (thing, odds) in enumerate(zip(things, row.tolist(), strict=True)):
            if k < _MANY or thing.type is None or thing.type in heard:
                yield Pair(phrase, thing, odds)


def _colors(nouns: Beliefs, colors: Beliefs, fixed: Collection[str]) -> Iterator[Pair]:
    """Every colour word with every colour, on a known type and on one not met."""
    table, new = colors.said_of()
    for noun, type_, scale in _anchors(nouns):
        for word, row in zip((*colors.posterior.words, NEVER_HEARD), (*table, new), strict=True):
            if word in fixed:
                continue
            for color, odds in zip(colors.posterior.types, row, strict=True):
                yield Pair(_phrase(noun, word), _object(type_, color), scale * float(odds))


def _unseen(nouns: Beliefs, colors: Beliefs, unseen: Unseen, looked: frozenset[str]) -> Iterator[Pair]:
    """Hypothetical objects, of a known type and of one not met, with a colour said and without."""
    color = next(iter(colors.posterior.words), None)
    for noun, type_, scale in _anchors(nouns):
        for said, ahead in ((None, unseen.ahead), (color, unseen.ahead_colored)):
            for attributes, rate in ((frozenset[str](), ahead), (looked, unseen.after_full_scan)):
                yield Pair(_phrase(noun, said), _object(type_, hypothetical=True, attributes=attributes), scale * rate)


def _unnamed(nouns: Beliefs, colors: Beliefs, unseen: Unseen, looked: frozenset[str]) -> Iterator[Pair]:
    """A phrase without a noun, with a colour said and without: a perceived and an unseen object of every type."""
    said: list[tuple[str | None, str | None, float, float]] = [(None, None, 1.0, unseen.ahead)]
    if colors.posterior.words:
        row = colors.said_of()[0][0]
        color = colors.posterior.types[int(row.argmax())]
        said.append((colors.posterior.words[0], color, float(row.max()), unseen.ahead_colored))
    for word, color_of, odds, ahead in said:
        for type_ in nouns.posterior.types:
            yield Pair(_phrase(None, word), _object(type_, color_of), odds)
        for _, type_, _ in _anchors(nouns):
            for attributes, rate in ((frozenset[str](), ahead), (looked, unseen.after_full_scan)):
                yield Pair(_phrase(None, word), _object(type_, hypothetical=True, attributes=attributes), rate)


def _anchors(nouns: Beliefs) -> Iterator[tuple[str, str, float]]:
    """A known noun with its type, and an unheard one with a type not met: on these, all else is shown."""
    table, new = nouns.said_of()
    posterior = nouns.posterior
    if posterior.words:
        at = int(table[0].argmax())
        yield posterior.words[0], posterior.types[at], float(table[0, at])
    yield NEVER_HEARD, UNMET, float(new[-1])


def _phrase(noun: str | None, color: str | None = None) -> Phrase:
    return Phrase(PhraseKind.NOUN, " ".join(filter(None, (color, noun or "one"))), noun=noun, color=color)


def _object(
    type_: str, color: str | None = None, *, hypothetical: bool = False, attributes: frozenset[str] = frozenset()
) -> Object:
    name = " ".join(filter(None, ("hypothetical" if hypothetical else "", *sorted(attributes), color, type_)))
    met = type_ != UNMET
    return Object(name, type_ if met else None, met, hypothetical, color, attributes=attributes)


def pair_examples(pairs: Iterable[Pair], strength: float) -> Iterator[Example]:
    """Examples from which the model gets the odds of the pairs.

    A soft label a pair, as two examples a phrase: its objects ACTIVE, and the same INACTIVE."""
    by_phrase: dict[Phrase, list[Pair]] = {}
    worlds: dict[tuple[str, ...], WorldModel] = {}  # shared, so that each is encoded once
    for pair in pairs:
        by_phrase.setdefault(pair.phrase, []).append(pair)
    for phrase, of_phrase in by_phrase.items():
        objects = tuple(pair.object for pair in of_phrase)
        world = worlds.setdefault(tuple(o.id for o in objects), WorldModel(objects))
        odds = np.clip([pair.odds for pair in of_phrase], 1e-6, 1e6)
        # weights a and b with a / b = odds and a b / (a + b) = strength
        for label, amounts in ((Correspondence.ACTIVE, 1.0 + odds), (Correspondence.INACTIVE, 1.0 + 1.0 / odds)):
            labels = (label,) * len(of_phrase)
            yield Example(phrase, world, labels, weight=strength, weights=tuple(amounts.tolist()))
