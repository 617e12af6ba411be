"""Which thing is meant, of the probabilities of all: where the likeliest configuration is not the answer."""

from __future__ import annotations

import math

import numpy as np

from dcg_torch.grounding.absence import judges_absence
from dcg_torch.grounding.encoding import WorldEncoder
from dcg_torch.names.vocabulary import LED
from dcg_torch.types import Object, ParseTree
from dcg_torch.types.arrays import Floats

_EQUAL = math.log(0.9)
"""Log of the share of the best thing's probability from which another is as good."""
_NEARER, _REGARDLESS = 2.0, 0.15
"""Metres by which a thing is nearer to the robot than another that is described alike and is e times likelier for it,
and the share of people who mean any of them: at arm's length the robot still asks which, and not across a yard."""
_SEVERAL_THERE, _ONE_THERE = math.log(0.5), math.log(2.0 / 3.0)
"""Log of the probability that something is there from which on something is meant that is."""


def rather_near(totals: Floats, noun: ParseTree | None, encoder: WorldEncoder) -> Floats:
    """(meanable,) log-scores in which the nearer of things that are described alike is likelier, where names count.

    What they have together stays what it is. Not so of several that are meant, where the robot does not stand among
    the things, as an arm at a table, and where a way is told: what is near where that begins tells nothing.

    Args:
        totals: (meanable,) log-score of every thing that may be meant, up to a constant.
        noun: the phrase of what is meant.
    """
    robot, among = encoder.world.robot, judges_absence(encoder) and encoder.among_things
    one = noun is not None and not noun.phrase.plural and all(LED not in child.phrase.words for child in noun.children)
    if robot is None or not (among and one):
        return totals
    equal = np.flatnonzero(totals >= totals.max() + _EQUAL)
    things = [encoder.all[int(j)] for j in equal]
    spots = [o.position[:2] for o in things if o.position is not None and not (o.hypothetical or o.members)]
    if len(spots) < max(2, len(things)):
        return totals
    apart = np.linalg.norm(np.array(spots) - (robot.x, robot.y), axis=1)
    rather = totals[equal] - apart / _NEARER
    whole = np.logaddexp.reduce(totals[equal])
    nearer = np.logaddexp(
        math.log1p(-_REGARDLESS) + rather - np.logaddexp.reduce(rather), math.log(_REGARDLESS) + totals[equal] - whole
    )
    found = totals.copy()
    found[equal] = nearer + whole
    return found


def instead_of(best: Object, totals: Floats, encoder: WorldEncoder, *, several: bool) -> str:
    """Id of the thing that is meant, which is the likeliest configuration's unless names count, or several are meant.

    Where names count, something that is there is meant if that is twice as likely as that nothing there is. A phrase
    for several means what is there if that is likelier than not. Where names count, the nearest of equals is meant.

    Args:
        best: what the likeliest configuration is about.
        totals: (meanable,) log-score of every thing that may be meant, up to a constant.
        several: does the noun phrase mean several things?
    """
    named, robot, id_ = judges_absence(encoder), encoder.world.robot, best.id
    if best.hypothetical and (named or several):
        least = np.logaddexp.reduce(totals) + (_SEVERAL_THERE if several else _ONE_THERE)
        totals = np.where(encoder.perceived[: len(totals)], totals, -np.inf)
        if np.logaddexp.reduce(totals) > least:
            best = encoder.all[int(totals.argmax())]
            id_ = best.id
    if robot is None or not named or best.hypothetical or best.members:
        return id_
    least = totals.max() + _EQUAL
    equal = [o for o, total in zip(encoder.world.objects, totals.tolist(), strict=False) if total >= least]
    away = {o.id: math.dist(o.position[:2], (robot.x, robot.y)) for o in equal if o.position is not None}
    return min(away, key=away.__getitem__, default=id_)
