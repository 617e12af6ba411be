"""What describes a noun phrase's object: its modifiers' factors, and which things its ranks are among."""

from __future__ import annotations

import functools
import itertools
import math
from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from dcg_torch.grounding.encode import WorldEncoder
from dcg_torch.grounding.features import picked_from, ranking
from dcg_torch.grounding.sameness import SAME_AS, log_same
from dcg_torch.grounding.solution import Hypothesis, ModifierFactor
from dcg_torch.grounding.tables import Tables
from dcg_torch.grounding.together import closest_together
from dcg_torch.names.attributes import OF_KEY, attribute_evidence, says_size, size_side, states_value
from dcg_torch.names.vocabulary import CELL, GROUP_WORDS, LATERAL, RANKING, SIDED, TOGETHER, WITHIN, counted
from dcg_torch.scene.bodies import bulk
from dcg_torch.types import NOT, Correspondence, Object, ParseTree, Phrase, PhraseKind

Floats = NDArray[np.float64]
Bools = NDArray[np.bool_]

_IN_THE_SET = math.log(0.5)
_GROUP_IN_THE_SET = math.log(0.1)
"""The same of groups: a stack of four is less usual than one of three, and may be the tallest."""
_BEHIND = 6.0
"""A thing is compared where it is described at least half as well as the best, and not by so many nats less: a thing of
just the name and of another colour is still described well, but not where one of the colour is there."""

_NEAR = 4.4
"""The same of what its name and its colour alone say: brown is near orange, and no orange; light gray is no gray where
something is called gray."""

_SAME_SIZE = 0.05
"""Logarithms of volumes that differ by less are equal."""
_LIKE_SIZES = 0.15
"""Sizes that differ by no more than this share of the differences among all of a kind are not told apart."""
_SIZED = 5.0
"""Nats that the smallest of some loses where it is called large."""
_OFF = 0.5
"""How far from the size that is said a thing may be to be compared."""
_UNMARKED = 2.0
"""As many such words is a mark that a thing does not bear: "block 7" of block 8."""
_JUDGED, _BY_EYE = 0.7, frozenset({"orientation", "age", "size"})
"""The same of a word for what people judge by eye, and judge in many ways."""
_AGAIN = 2.0
"""Nats that a thing loses for each word that its attributes contradict beside the first: each part of a description
counts, and one that nobody fits does not make all alike."""
_BEYOND = 1e6
"""More than any coordinate: what is not described as well comes after all that is."""
_ALIKE = 0.7
"""Nats by which things differ that are described alike."""
_MOST_COUNTED = 3
"""Landmarks up to which those of "behind the two cones" are told apart."""
_APART, _FARTHEST = 0.5, 8.0
"""Each unit that two landmarks are farther apart takes so much from their log-score, up to a number of units: people
speak of two things at once that stand together."""
_LANDMARKS = 8
"""Landmarks that are weighed where several are meant together."""


def modifier_factor(
    tree: ParseTree,
    beams: Sequence[Sequence[Hypothesis]],
    encoder: WorldEncoder,
    tables: Tables,
    compared: Bools | None = None,
) -> ModifierFactor:
    """The factor of a modifier, from its log Psi under every choice of landmarks.

    Args:
        beams: the hypotheses of each landmark.
        compared: (things,) those among which it ranks; None: all of a kind.
    """
    number, several = encoder.number, _counted_landmark(tree)
    combos = list(itertools.product(*beams))
    landmarks = [tuple(number[h.child.grounding.object.id] for h in combo) for combo in combos]
    denied = NOT in tree.phrase.words
    if tree.phrase.words[0] in SAME_AS:
        log_psi = log_same(tree.phrase.words[0], encoder.all, landmarks, denied=denied)
    else:
        table = tables.placed(encoder, tree.phrase, landmarks, compared)
        asserted = Correspondence.INACTIVE if denied else Correspondence.ACTIVE
        log_psi = table[tables.factor.correspondences.index(asserted)]
    of_each = several > 0 and len(combos) >= several
    if of_each:
        chosen = list(itertools.combinations(range(min(len(combos), _LANDMARKS)), several))
        combos = [tuple(beams[0][k] for k in of) for of in chosen]
        landmarks = [tuple(landmarks[k][0] for k in of) for of in chosen]
        log_psi = log_psi[np.array(chosen)].sum(axis=1)
    scores = np.array([sum(h.log_score for h in combo) for combo in combos])
    if of_each or len(beams) > 1:
        scores = scores - _APART * _spread(np.array(landmarks), encoder.layout.position[:, :2])
    share = scores - np.logaddexp.reduce(scores)
    return ModifierFactor(tree, combos, log_psi + share[:, None], share, compared, of_each)


def _spread(landmarks: NDArray[np.int64], place: Floats) -> Floats:
    """(combos,) how far the landmarks that are spoken of together are apart, beyond those that are closest, units.

    Args:
        landmarks: (combos, k) numbers of things.
        place: (things, 2).
    """
    at, ordered = place[landmarks], np.sort(landmarks, axis=1)
    apart = np.linalg.norm(at[:, :, None] - at[:, None], axis=3).max(axis=(1, 2))
    once = (ordered[:, 1:] == ordered[:, :-1]).any(axis=1)
    apart = np.where(np.isfinite(apart) & ~once, apart, np.inf)
    near: Floats = np.minimum(apart - apart.min(), _FARTHEST) if np.isfinite(apart.min()) else np.zeros(len(apart))
    return near


def _counted_landmark(tree: ParseTree) -> int:
    """How many landmarks a modifier is to, each by itself ("behind the two cones"); 0 for all others."""
    count = tree.children[0].phrase.count if len(tree.children) == 1 else None
    return count if count is not None and 2 <= count <= _MOST_COUNTED else 0


def ranks_from(tree: ParseTree) -> bool:
    """Is it a modifier by which things are ranked from a landmark: "second closest to"?"""
    name = tree.phrase.words[0]
    return name in RANKING or name.partition(" ")[2] in RANKING


def picks_a_side(tree: ParseTree) -> bool:
    """Is it a modifier that picks by a side: "(of the two cubes) the one on the left"?"""
    return tree.phrase.words[0] != WITHIN and len(tree.children) == 1 and tree.children[0].phrase.noun in SIDED


def is_to_a_place(tree: ParseTree) -> bool:
    """Does a modifier say in which part of the scene a thing is? What stands by a thing is a vaguer set."""
    return "to a thing" not in tree.phrase.context


@dataclass(frozen=True)
class Comparison:
    """What a noun phrase picks from.

    Attributes:
        among: (things,) what it describes apart from its ranks: as well as half of what it describes best. Or as many
            as it says that there are: "the middle one of the five on the left".
        log_size: (things,) log-factor of the size that it says, of standing close together, and of what contradicts a
            thing more than once.
        phrase: the phrase without the words that `log_size` has taken up.
    """

    among: Bools
    log_size: Floats
    phrase: Phrase


def comparison_set(
    tree: ParseTree, modifiers: Sequence[ModifierFactor], encoder: WorldEncoder, tables: Tables
) -> Comparison:
    """What the words of a noun phrase compare with: what all the rest of it describes.

    Words for a size ("the upper large one") describe by degrees: how far is a thing from the largest, or the smallest?
    They compare with all of the phrase's name where places leave one size alone ("the large one at the top"), or sizes
    that differ by little beside those of all of its kind ("the tiny black specks").
    """
    phrase = tree.phrase
    told = of_attributes(phrase.words, encoder)
    table = tables.unranked(encoder, replace(phrase, words=tuple(word for word in told if not says_size(word))))
    number = tables.factor.correspondences.index
    fit: Floats = np.where(encoder.perceived, table[number(Correspondence.ACTIVE)], -np.inf)
    odds = fit - table[number(Correspondence.INACTIVE)]
    named, own = _described(fit, odds), odds
    for modifier in modifiers:
        fit, odds = fit + modifier.log_psi, odds + modifier.log_psi
    log_size = _contradictions(told, encoder)
    fit, odds = fit + log_size, odds + log_size
    sizes = {word: side for word in phrase.words if word not in told and (side := size_side(word)) is not None}
    if sizes:
        off = _off_size(tuple(sizes.values()), encoder, _described(fit, odds), named, _of_kind(phrase, encoder, tables))
        if off is not None:
            phrase = replace(phrase, words=tuple(w for w in phrase.words if w not in sizes))
            log_size = log_size - _SIZED * off**2
            fit, odds = (np.where(off > _OFF, v - _BEHIND - 1.0, v) for v in (fit, odds))
    for side in _denied_sizes(phrase.words):
        off = _off_size((side,), encoder, named, _of_kind(phrase, encoder, tables))
        off = np.ones(len(fit)) if off is None else off
        log_size = log_size - _SIZED * (1.0 - off) ** 2
        fit, odds = (np.where(off < _OFF, v - _BEHIND - 1.0, v) for v in (fit, odds))
    several = counted(phrase.words, TOGETHER)
    close = several is not None
    several = several or picked_from(phrase)
    among = _so_many(several, own if close else fit, fit, modifiers, encoder, close) if several else None
    if among is not None:
        return Comparison(among[0], log_size + among[1] if close else log_size, phrase)
    described = _described(fit, odds, _GROUP_IN_THE_SET if phrase.noun in GROUP_WORDS else _IN_THE_SET)
    if phrase.color is not None:
        described &= own >= own[described].max(initial=-np.inf) - _NEAR
    return Comparison(described, log_size, phrase)


def _denied_sizes(words: Sequence[str]) -> list[int]:
    """The sizes that words such as "not small" rule out."""
    sides = (size_side(word.removeprefix(f"{NOT} ")) for word in words if word.startswith(f"{NOT} "))
    return [side for side in sides if side is not None]


def _of_kind(phrase: Phrase, encoder: WorldEncoder, tables: Tables) -> Bools:
    """(things,) those that the noun of a phrase names."""
    table = tables.unranked(encoder, replace(phrase, color=None, look=(), words=()))
    number = tables.factor.correspondences.index
    fit: Floats = np.where(encoder.perceived, table[number(Correspondence.ACTIVE)], -np.inf)
    return _described(fit, fit - table[number(Correspondence.INACTIVE)])


def _contradictions(told: Sequence[str], encoder: WorldEncoder) -> Floats:
    """(things,) log-factor of the words that contradict a thing's attributes, beside the first of them."""
    if len(told) < 2:
        return np.zeros(len(encoder.all))
    return np.array([-_AGAIN * max(0.0, contradicted(told, o) - 1.0) for o in encoder.all])


def _so_many(
    several: int, own: Floats, fit: Floats, modifiers: Sequence[ModifierFactor], encoder: WorldEncoder, close: bool
) -> tuple[Bools, Floats] | None:
    """The so many things that a phrase speaks of, and the log-factor of being one of those that stand together.

    Where more are described alike, or they are said to be `close` together, they are those that stand closest together.
    None where there are not so many.
    """
    objects = len(encoder.world.objects)
    position = encoder.layout.position
    there = np.isfinite(position[:objects]).all(axis=1) & np.isfinite(own[:objects])
    if several > there.sum():
        return None
    found = np.zeros(len(fit), dtype=np.bool_)
    sided = None if close else _along_a_side(fit, modifiers, encoder)
    values = np.where(there, (own if sided is None else sided)[:objects], -np.inf)
    first = highest(values, several + 1)
    last = float(values[first[several - 1]])
    tied = len(first) > several and last - values[first[several]] < _ALIKE
    if sided is not None or not (close or tied):
        found[first[:several]] = True
        return found, np.zeros(len(fit))
    alike = np.zeros(len(fit), dtype=np.bool_)
    alike[:objects] = values >= last - _ALIKE
    return closest_together(position, alike, fit, several)


def _along_a_side(fit: Floats, modifiers: Sequence[ModifierFactor], encoder: WorldEncoder) -> Floats | None:
    """(things,) how well each is one of those on a side: "the five cubes on the left" are the five farthest left.

    What a modifier says of a single thing is no measure of it: the leftmost of its kind outdoes all others. None where
    nothing is ranked within a side.
    """
    sided = [(m, m.tree.children[0].phrase.noun) for m in modifiers if m.tree.phrase.words[0] == WITHIN]
    sides = [(m, side) for m, side in sided if side in LATERAL]
    if len(sides) != 1:
        return None
    modifier, side = sides[0]
    rest = fit - modifier.log_psi
    y = encoder.layout.position[:, 1]
    described = (rest >= rest.max() + _IN_THE_SET) & np.isfinite(y)
    return np.where(described, y if side == "left" else -y, fit - _BEYOND)


def is_narrowed(phrase: Phrase, encoder: WorldEncoder) -> bool:
    """Does a noun phrase say more than a name of what is ranked from a landmark: "the red one closest to the door"?"""
    looks = phrase.color is not None or bool(phrase.look)
    sized = any(size_side(word) is not None for word in phrase.words)
    return looks or sized or bool(of_attributes(phrase.words, encoder))


def _described(fit: Floats, odds: Floats, least: float = _IN_THE_SET) -> Bools:
    described: Bools = (fit >= fit.max() + least) & (odds >= odds.max() - _BEHIND)
    return described


def _off_size(sides: Sequence[int], encoder: WorldEncoder, *sets: Bools) -> Floats | None:
    """(things,) from 0 to 1: how far a thing is from the largest (1), smallest (-1) or mean size (0) that is said.

    Args:
        sets: (things,) the first of them that has several sizes is what is compared; the last is all of a kind.

    Returns:
        The largest of the distances, 0 for what has no size; None where all are of one size.
    """
    sizes = [math.nan if o.size is None else bulk(o.size) for o in encoder.world.objects]
    logs = np.log([v if v > 0.0 else math.nan for v in sizes])
    differ = [
        float(np.ptp(logs[own])) if (own := among[: len(logs)] & np.isfinite(logs)).any() else 0.0 for among in sets
    ]
    least = 2 if 0 in sides else 1  # of two none is of medium size
    for among in (*sets, encoder.perceived) if 0 in sides else sets:
        known = logs[among[: len(logs)] & np.isfinite(logs)]
        if len(known) > least and np.ptp(known) > max(_SAME_SIZE, _LIKE_SIZES * differ[-1]):
            place = np.clip((logs - known.min()) / np.ptp(known), 0.0, 1.0)
            off = [2.0 * np.abs(place - 0.5) if not side else 1.0 - place if side > 0 else place for side in sides]
            return np.pad(np.nan_to_num(np.max(off, axis=0)), (0, len(encoder.all) - len(logs)))
    return None


def of_attributes(words: Sequence[str], encoder: WorldEncoder) -> tuple[str, ...]:
    """Those of a noun phrase's words that say something of an attribute: "the biggest metal cube"."""
    told = {word: set(attribute_evidence((word,), encoder.given)) for word in words}
    return tuple(w for w in words if told[w] - {"attribute: silent"} or OF_KEY in w or w.startswith(f"{NOT} "))


def contradicted(words: Sequence[str], thing: Object) -> float:
    """How many words the attributes of a thing contradict; marks that it does not bear count more."""
    heard = [word for word in words if not word.startswith(CELL)]
    told = [(word, attribute_evidence((word,), thing.attributes)) for word in heard]
    marks = sum(OF_KEY in word and found == ("attribute: silent",) for word, found in told)
    others = sum(_weight(word) for word, found in told if "attribute: contrary" in found)
    return others + _UNMARKED * marks


@functools.lru_cache(maxsize=4096)
def _weight(word: str) -> float:
    if OF_KEY in word:
        return _UNMARKED
    return _JUDGED if states_value(word.removeprefix(f"{NOT} "), _BY_EYE) else 1.0


def highest(values: Floats, count: int) -> NDArray[np.int64]:
    """The numbers of the highest of (n,) values, the highest first; of equal ones the first."""
    if count == 1:
        return np.array([values.argmax()])
    if len(values) <= max(512, 2 * count):
        return np.argsort(-values, kind="stable")[:count]
    least = np.partition(values, len(values) - count)[len(values) - count]
    among = np.flatnonzero(values >= least)
    return among[np.argsort(-values[among], kind="stable")[:count]]


def ranks(tree: ParseTree) -> bool:
    """Is it a noun phrase with words that may rank?"""
    return tree.phrase.kind is PhraseKind.NOUN and ranking(tree.phrase) is not None
