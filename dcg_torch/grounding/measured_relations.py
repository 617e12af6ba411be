"""What is measured of how things stand to landmarks, beside what is learned of it.

In the plural all that stand so are meant. What is denied holds for no landmark that is named alike. Extents say what is
within reach of a thing, and what can be in it.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from dcg_torch.grounding.encoding import WorldEncoder
from dcg_torch.grounding.modifiers import ranks_from
from dcg_torch.names.relations import listed
from dcg_torch.names.vocabulary import DEFINITE, OF_TWO, ORDINALS, PLACE_WORDS, is_superlative
from dcg_torch.scene.bodies import Bodies
from dcg_torch.scene.relation_names import RELATION_NAMES
from dcg_torch.scene.relations import between
from dcg_torch.types import NOT, ParseTree, Phrase
from dcg_torch.types.arrays import Bools, Floats

Column = Floats | float


def means_all(phrase: Phrase) -> bool:
    """Does a modifier in the plural describe all that stand so, and not the nearest of them above all?"""
    whole = phrase.count is None and (phrase.words[0] in ON_A_SIDE or phrase.words[0] in OF_TWO)
    around = phrase.words[0] in _AROUND and phrase.text.split(" ")[0] not in DEFINITE  # no place told before
    return phrase.plural and (whole or around)


def means_several(phrase: Phrase) -> bool:
    """Is a modifier said of all that stand so, however many: "everything above the red box"?"""
    return phrase.plural and phrase.count is None


def ranked_among(noun: ParseTree, modifier: ParseTree) -> ParseTree:
    """A modifier of a noun phrase that ranks: "the farthest cup behind the lamp" is one of all that are behind it."""
    words, phrase = noun.phrase.words, modifier.phrase
    ranks = any(is_superlative(word) and word != "middle" for word in words) and ORDINALS.keys().isdisjoint(words)
    to_you = PLACE_WORDS.get(modifier.children[0].phrase.noun or "", ("", None))[0] == "robot"
    counted = to_you and any(ranks_from(c) for c in noun.children if c is not modifier)  # "the second chair behind you"
    ranks = (ranks or counted) and not noun.phrase.plural
    sided = phrase.words[0] in ON_A_SIDE and ("to a thing" in phrase.context or to_you)
    if not ranks or NOT in phrase.words or not (sided or (to_you and phrase.words[0] == "ahead of")):
        return modifier
    return ParseTree(replace(phrase, plural=True, count=None), modifier.children)


def of_all(phrase: Phrase, log_psi: Floats, landmarks: Sequence[tuple[int, ...]], encoder: WorldEncoder) -> Floats:
    """(combos, things) of a modifier that `means_all`; the rest as it was."""
    name = phrase.words[0]
    if not means_all(phrase):
        return log_psi
    if name in _AROUND:
        return _within_reach(log_psi, [of[0] for of in landmarks], encoder)
    if name in ON_A_SIDE:
        return _on_the_side(name, log_psi, [of[0] for of in landmarks], encoder)
    return _all_between(log_psi, landmarks, encoder) if all(len(of) > 1 for of in landmarks) else log_psi


def of_several(
    phrase: Phrase, log_psi: Floats, landmarks: Sequence[int], chosen: Sequence[Sequence[int]], encoder: WorldEncoder
) -> Floats:
    """(sets, things) log Psi of a modifier of several landmarks, from that of each: "in front of the two cubes".

    What stands on a side of several need be the nearest to one of them alone, and in line with the others.

    Args:
        log_psi: (landmarks, things).
        landmarks: numbers of things.
        chosen: (sets, k) places in `landmarks`.
    """
    each = log_psi[np.array(chosen)]
    if phrase.words[0] not in ON_A_SIDE or NOT in phrase.words:
        return np.asarray(each.mean(axis=1))  # said once, it counts once
    off = aslant(phrase.words[0], landmarks, encoder)
    line = np.where(np.isfinite(off), -np.square(np.nan_to_num(off) / STRAIGHT), log_psi)[np.array(chosen)]
    nearest = [np.delete(line, k, axis=1).sum(axis=1) + each[:, k] for k in range(each.shape[1])]  # the others in line
    best: Floats = np.max(nearest, axis=0)
    return best


def surrounded(
    phrase: Phrase, landmarks: Sequence[int], log_psi: Floats, scores: Floats, encoder: WorldEncoder
) -> Floats:
    """(landmarks, things) "surrounded by chairs": with one of them on every side, and those near.

    Args:
        phrase: of the landmarks, several.
        log_psi: what is learned; it stays for what is no thing.
        scores: (landmarks,) of the landmarks.
    """
    alike = np.flatnonzero(alike_by(scores))
    mark, at = [landmarks[k] for k in alike.tolist()], encoder.layout.position[:, :2]
    number = min(phrase.count or _ON_EVERY_SIDE, len(mark))
    if number < 3 or not encoder.layout.solid[mark].all():
        return log_psi
    x, y = (at[None] - at[mark][:, None]).transpose(2, 0, 1)
    away = np.where(np.isfinite(x) & (np.array(mark)[:, None] != np.arange(len(at))), np.hypot(x, y), np.inf)
    near = np.argsort(away, axis=0)[:number]
    mean = np.take_along_axis(away, near, axis=0).mean(axis=0)
    angle = np.sort(np.arctan2(*(np.take_along_axis(v, near, axis=0) for v in (y, x))), axis=0)
    gap = np.diff(angle, axis=0, append=angle[:1] + math.tau).max(axis=0)
    known = np.isfinite(mean) & np.isfinite(gap)
    if not known.any():
        return log_psi
    lost = np.maximum(gap - math.tau / number, 0.0) / _OPEN + np.log(mean / mean[known].min())
    found = log_psi.copy()
    found[alike] = np.where(known, -lost, log_psi[alike].min())
    return found


_ON_EVERY_SIDE, _OPEN = 4, math.radians(45.0)
"""Things that surround another where nobody counts them, and the open angle for which it loses a nat."""


def _within_reach(log_psi: Floats, landmarks: Sequence[int], encoder: WorldEncoder) -> Floats:
    """(combos, things) "the chairs around the table" are all that stand close to it, not the nearest one above all."""
    near = within_reach(landmarks, encoder)
    found = np.where(np.isfinite(near), near, log_psi)
    found[np.arange(len(landmarks)), landmarks] = log_psi[np.arange(len(landmarks)), landmarks]
    return found


def within_reach(landmarks: Sequence[int], encoder: WorldEncoder, up_to: float | None = None) -> Floats:
    """(combos, things) how surely each thing stands close to a landmark; NaN where nobody knows.

    Args:
        up_to: units; None: `_REACH`, or `_STEP` where nobody says how large things are.
    """
    gap, reach = gaps(landmarks, encoder)
    reach = reach if up_to is None else up_to
    return np.where(np.isfinite(gap), -np.logaddexp(0.0, (np.nan_to_num(gap) - reach) / (_VAGUE * reach)), np.nan)


def of_denied(
    name: str, log_psi: Floats, landmarks: Sequence[int], scores: Floats, encoder: WorldEncoder, *, denied: bool
) -> Floats | None:
    """(combos, things) of a modifier that is denied, or that denies nearness by itself ("far from"); None of others."""
    if not denied and name not in _FAR_OFF:
        return None
    far = _beyond_reach(name, landmarks, scores, encoder)
    return far if far is not None else _of_none(log_psi, scores) if denied else None


def _beyond_reach(name: str, landmarks: Sequence[int], scores: Floats, encoder: WorldEncoder) -> Floats | None:
    """(combos, things) "the chair that isn't near a table" stands close to none of those that are named alike.

    The farther it stands the likelier: who denies that it is near may still have the others nearer.

    Args:
        scores: (combos,) of the landmarks.

    Returns:
        None for what is no nearness, and for places.
    """
    alike = alike_by(scores)
    if name not in _APART | _FAR_OFF or not encoder.layout.solid[np.array(landmarks)[alike]].all():
        return None
    gap, reach = gaps(landmarks, encoder)
    gap[np.arange(len(landmarks)), landmarks] = 0.0
    gap[alike] = np.where(np.isfinite(gap[alike]), gap[alike], np.inf).min(axis=0)
    far = np.where(np.isfinite(gap), gap, 0.0)
    log_far = np.log(np.maximum(far, TOUCHING))
    found: Floats = -np.logaddexp(0.0, (reach - far) / (_VAGUE * reach)) + log_far - log_far.max(axis=1, keepdims=True)
    return found


def gaps(landmarks: Sequence[int], encoder: WorldEncoder, bodies: Bodies | None = None) -> tuple[Floats, float]:
    """(combos, things) units from each landmark to every thing, between extents where these are known; NaN where
    nobody knows, and up to how many units things are near.

    Args:
        bodies: how large things are; None: as the layout says.
    """
    where = encoder.layout
    bodies = bodies or where.bodies
    at = where.position[:, :2]
    apart = np.abs(at[list(landmarks)][:, None] - at[None])
    if bodies is None or max(landmarks, default=0) >= len(bodies.half):
        return np.where(where.solid[None], np.linalg.norm(apart, axis=2), np.nan), _STEP
    half = np.pad(bodies.half, ((0, len(at) - len(bodies.half)), (0, 0)))
    gap = np.linalg.norm(np.maximum(apart - half[list(landmarks)][:, None] - half[None], 0.0), axis=2)
    return np.where(where.solid[None], gap, np.nan), _REACH


_AROUND = listed("around")
_APART = _AROUND | {"close to"}
NEARNESS = _APART - {"around", "surrounded by"}
_FAR_OFF = listed("far off")
_REACH, _STEP, _VAGUE = 0.6, 1.25, 0.2
"""Units of a gap, and of a distance where nobody says how large things are, up to which things stand around another,
and the share of it by which that is vague."""


def _on_the_side(name: str, log_psi: Floats, landmarks: Sequence[int], encoder: WorldEncoder) -> Floats:
    """(combos, things) "the chairs left of the table" are all on that side of it, not the nearest of them above all.

    Args:
        name: one of `ON_A_SIDE`.
        log_psi: what is known of the one that is meant.
        landmarks: numbers of things.
    """
    off = aslant(name, landmarks, encoder)
    found = np.where(np.isfinite(off), -np.logaddexp(0.0, (np.nan_to_num(off) - ASLANT) / UNSURE), log_psi)
    found[np.arange(len(landmarks)), landmarks] = log_psi[np.arange(len(landmarks)), landmarks]
    return found


def aslant(name: str, landmarks: Sequence[int], encoder: WorldEncoder) -> Floats:
    """(combos, things) radians by which a thing is off a side of each landmark; NaN for what is nowhere."""
    where, (along, across) = encoder.layout, _ways(ON_A_SIDE[name], landmarks, encoder)
    at, mark = where.position.T[:2], where.position[landmarks, :2].T
    x, y = at[:, None, :] - mark[:, :, None]
    if where.wide is not None:
        half = where.half[landmarks].T[:, :, None]
        x, y = (np.sign(v) * np.maximum(np.abs(v) - out, 0.0) for v, out in zip((x, y), half, strict=True))
    ahead = x * along + y * across + 0.0  # no zero below zero, which would be a half turn off
    found: Floats = np.arctan2(np.abs(y * along - x * across), ahead)
    return found


def _ways(side: tuple[float, float], landmarks: Sequence[int], encoder: WorldEncoder) -> tuple[Column, Column]:
    """Where a side of each landmark is, as it is looked at: x and y, (combos, 1) each, or of all alike."""
    x, y = side
    if encoder.layout.outlook is None:
        return x, y
    angle = np.nan_to_num(encoder.layout.outlook[list(landmarks)])[:, None]
    return x * np.cos(angle) - y * np.sin(angle), x * np.sin(angle) + y * np.cos(angle)


def sides_of(side: tuple[float, float], landmarks: Sequence[int], encoder: WorldEncoder) -> Floats:
    """(landmarks, 2) where a side of each is, as it is looked at."""
    x, y = (np.broadcast_to(v, (len(landmarks), 1)) for v in _ways(side, landmarks, encoder))
    return np.concatenate([x, y], axis=1)


ON_A_SIDE = {"left of": (0.0, 1.0), "right of": (0.0, -1.0), "behind": (1.0, 0.0), "in front of": (-1.0, 0.0)}
"""Preposition -> the direction in which what is so stands, as who looks sees it."""
TOUCHING = 0.1
"""Units of a gap below which distances are alike."""
ASLANT, UNSURE = math.radians(65.0), math.radians(6.0)
"""Angle off that direction up to which a thing is on that side, and how vague that is."""
STRAIGHT = math.radians(35.0)
"""The same where it is the nearest on that side: who means what stands aslant, if not so far off, says more."""


def _all_between(log_psi: Floats, landmarks: Sequence[tuple[int, ...]], encoder: WorldEncoder) -> Floats:
    """(combos, things) "the chairs between the table and the door" are all of them, as much as the likeliest is."""
    inside = is_between(landmarks, encoder)
    best = np.where(inside, log_psi, -np.inf).max(axis=1, keepdims=True)
    return np.where(inside, best, log_psi)


def is_between(landmarks: Sequence[Sequence[int]], encoder: WorldEncoder) -> Bools:
    """(combos, things) what stands between the first two of each."""
    inside: Bools = between(encoder.layout, landmarks) == RELATION_NAMES.index(f"{_BETWEEN}between")
    return inside


_BETWEEN = "relation: between, "


def _of_none(log_psi: Floats, scores: Floats) -> Floats:
    """(combos, things) what is not at a desk is at none of them: of landmarks that are named alike the worst counts."""
    alike = alike_by(scores)
    found = log_psi.copy()
    found[alike] = log_psi[alike].min(axis=0)
    return found


_ALIKE = 1.0
"""Nats by which the scores of landmarks of one name may differ."""


def alike_by(scores: Floats) -> Bools:
    """(combos,) the landmarks that are named as well as the best."""
    alike: Bools = scores >= scores.max() - _ALIKE
    return alike


def inside_of(name: str, landmarks: Sequence[tuple[int, ...]], encoder: WorldEncoder) -> Floats | None:
    """(combos, things) what things lose that are too large to be in a landmark, or are not above the floor it covers.

    Returns:
        None where nobody says how large the landmarks are, and for all other prepositions.
    """
    where = encoder.layout
    if name not in _INSIDE or where.bodies is None:
        return None
    half = where.bodies.half
    if any(len(of) != 1 or of[0] >= len(half) for of in landmarks):
        return None
    mark = [of[0] for of in landmarks]
    area, at = half.prod(axis=1), where.position[: len(half), :2]
    with np.errstate(invalid="ignore"):
        larger = area[None] > _LARGER * area[mark][:, None]
        within = (np.abs(at[mark][:, None] - at[None]) <= half[mark][:, None] + _RIM).all(axis=2) & ~larger
    within[np.arange(len(mark)), mark] = False
    out = np.isfinite(area[mark])[:, None] & within.any(axis=1)[:, None] & ~within
    return np.pad(np.where(larger | out, -_NOT_IN, 0.0), ((0, 0), (0, len(encoder.all) - len(area))))


_INSIDE = listed("inside")
_NOT_IN = 5.0
"""Nats that a thing loses that can't be in a landmark."""
_LARGER = 1.5
"""How much more floor than a landmark a thing covers at most that is in it."""
_RIM = 0.05
"""Units that the middle of what is in a thing may be beyond its rim."""
