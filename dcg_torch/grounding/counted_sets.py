"""A counted few: "the two dots that almost touch", "the left one of the three cups", "the five on the left".

People who count a few of many mean those that are nearest to one another. That is measured, not learned: a thing is as
likely one of N as the distance to its Nth nearest is small beside that of the closest N.
"""

from __future__ import annotations

import math
from collections.abc import Collection, Sequence
from dataclasses import replace

import numpy as np

from dcg_torch.grounding.counting import WAYS
from dcg_torch.grounding.encoding import WorldEncoder
from dcg_torch.grounding.features.name_facts import look_scores
from dcg_torch.grounding.hypotheses import ModifierFactor
from dcg_torch.grounding.modifiers import ranks_from, tells_which_few
from dcg_torch.names.attribute_values import size_side
from dcg_torch.names.colors import comparing_words
from dcg_torch.names.vocabulary import LATERAL, ORDINALS, WITHIN
from dcg_torch.scene.neighbours import LEVEL, nearest
from dcg_torch.scene.order import highest
from dcg_torch.types import ParseTree, Phrase
from dcg_torch.types.arrays import Bools, Floats

_IN_THE_SET = math.log(0.5)
_BEYOND = 1e6
"""More than any coordinate: what is not described as well comes after all that is."""
_ALIKE = 0.7
"""Nats by which things differ that are described alike."""
_SHADED = 2.0
"""Nats for each unit by which a colour's score stays behind the best of those that are compared."""
_COUNTED = 3.0
"""Nats for each place by which a thing stays behind "the second darkest"."""
_NONE_OF_THEM = 2.0
"""Nats that are lost by what is none of those that are described best."""
_NOT_THERE = 4.0
"""The same where they are the farthest to a side, which is measured."""
_TIGHT = 4.0
"""Nats that a thing loses for each e-fold by which its N stand wider than the closest."""
_FAR = -8.0
"""The most that it loses."""
_TOUCHING = 0.02
"""Share of the diagonal of the box around all below which distances are alike."""


def counted_set(
    several: int, own: Floats, fit: Floats, modifiers: Sequence[ModifierFactor], encoder: WorldEncoder, close: bool
) -> tuple[Bools, Floats] | None:
    """The so many things that a phrase speaks of, and the log-factor of being one of them.

    Where more are described alike, or they are said to be `close` together, they are those that stand closest together.
    None where there are not so many.
    """
    objects = len(encoder.world.objects)
    position = encoder.layout.position
    there = np.isfinite(position[:objects]).all(axis=1) & np.isfinite(own[:objects])
    if several > there.sum():
        return None
    found = np.zeros(len(fit), dtype=np.bool_)
    ranks = [m for m in modifiers if ranks_from(m.tree)]
    ranking = np.sum([m.log_psi for m in ranks], axis=0)
    picking = np.sum([m.log_psi for m in ranks if not m.tree.phrase.text], axis=0)  # "the higher one"
    sided = None if close else _along_a_side(fit - ranking, modifiers, encoder)
    for described in (own - ranking if sided is None and not close else sided, own - picking, own):
        values = np.where(there, (own if described is None else described)[:objects], -np.inf)
        first = highest(values, several + 1)
        last = float(values[first[several - 1]])
        tied = len(first) > several and last - values[first[several]] < _ALIKE
        if not tied or close or sided is not None:
            break  # "closest to the corner" picks one of so many; where there are more, it says which so many
    if sided is not None or not (close or tied):
        found[first[:several]] = True
        return found, np.where(found, 0.0, -_NONE_OF_THEM if sided is None else -_NOT_THERE)
    alike = np.zeros(len(fit), dtype=np.bool_)
    alike[:objects] = values >= last - _ALIKE
    found, log_close = closest_together(position, alike, fit, several)
    return found, log_close if close else np.zeros(len(fit))


def evenly(noun: ParseTree, found: Bools, modifiers: Sequence[ModifierFactor]) -> Floats:
    """The log-factor by which what tells which few are picked from says the same of each of them.

    Args:
        noun: the noun phrase.
        found: (things,) the few.
    """
    trees = tells_which_few(noun)
    told = np.sum([m.log_psi for m in modifiers if m.tree in trees] or [np.zeros(len(found))], axis=0)
    return np.where(found, told[found].max(initial=-_BEYOND) - told, 0.0)


def closest_together(position: Floats, candidates: Bools, log_fit: Floats, several: int) -> tuple[Bools, Floats]:
    """The so many things that stand closest together, and how likely each thing is one of such.

    Args:
        position: (n, 3).
        candidates: (n,) the things that are compared; there are at least `several`.
        log_fit: (n,) what else says how well a thing is meant.

    Returns:
        (n,) which these are; (n,) the log-factor of every thing, 0 for these.
    """
    at = np.flatnonzero(candidates)
    away, near = nearest(position[at], several)
    wide = away[:, -1] + _TOUCHING * np.linalg.norm(np.ptp(position[at], axis=0)) + 1e-9
    loss = -_TIGHT * np.log(wide / wide.min())
    first = int((loss + log_fit[at]).argmax())
    found = np.zeros(len(position), dtype=np.bool_)
    found[at[near[first]]] = True
    log_close = np.full(len(position), _FAR)
    log_close[at] = np.maximum(_FAR, np.minimum(0.0, loss - loss[first]))
    return found, np.where(found, 0.0, log_close)


_CALLED = {"top": "back", "bottom": "front"}


def _along_a_side(fit: Floats, modifiers: Sequence[ModifierFactor], encoder: WorldEncoder) -> Floats | None:
    """(things,) how well each is one of those on a side: "the five cubes on the left" are the five farthest left.

    What a modifier says of a single thing is no measure of it: the leftmost of its kind outdoes all others. None where
    nothing is ranked within a side, or "the top" may be a height.
    """
    sided = [(m, m.tree.children[0].phrase.noun) for m in modifiers if m.tree.phrase.words[0] == WITHIN]
    sides = [(m, _CALLED.get(side, side)) for m, side in sided if side in WAYS.keys() | _CALLED.keys()]
    if len(sides) != 1:
        return None
    modifier, side = sides[0]
    rest, where = fit - modifier.log_psi, encoder.layout
    described = (rest >= rest.max() + _IN_THE_SET) & np.isfinite(where.position).all(axis=1)
    if side not in LATERAL and not (where.picture or np.ptp(where.position[described, 2]) <= LEVEL):
        return None
    return np.where(described, where.position[:, :2] @ np.array(WAYS[side]), fit - _BEYOND)


def shaded(said: Phrase, phrase: Phrase, described: Bools, encoder: WorldEncoder) -> tuple[Phrase, Floats]:
    """ "The darkest of the small ones" is compared with these, not with all in view; "the second darkest" is counted.

    Args:
        said: the phrase with all its words.
        phrase: the same without those that are taken up.
        described: (things,) what the rest of it describes.

    Returns:
        The phrase without what compares colours, and the log-factor of each thing; both as before where colours are
        compared among all.
    """
    nothing = np.zeros(len(described))
    number = next((ORDINALS[word] for word in said.words if word in ORDINALS), None)
    shades = tuple(word for word in comparing_words(said.look) if word.endswith("est"))
    if not shades or (number is None and all(size_side(word) is None for word in said.words)):
        return phrase, nothing
    among = described & encoder.perceived
    log_shade = shades_among(shades, among, encoder)
    members = np.flatnonzero(among & np.array([o.color is not None or o.rgb is not None for o in encoder.all]))
    if not log_shade.any() or len(members) < (number or 1):
        return phrase, nothing
    if number is not None:
        place = np.argsort(np.argsort(-log_shade[members], kind="stable"))
        log_shade[members] = -_COUNTED * np.abs(place + 1 - number)
    log_shade[~among] = log_shade.min()
    return without_shades(phrase, (*shades, *ORDINALS)), log_shade


def without_shades(phrase: Phrase, shades: Collection[str]) -> Phrase:
    """A phrase without words that compare colours, which are measured."""
    words, look = (tuple(word for word in said if word not in shades) for said in (phrase.words, phrase.look))
    return phrase if (words, look) == (phrase.words, phrase.look) else replace(phrase, words=words, look=look)


def shades_among(words: tuple[str, ...], among: Bools, encoder: WorldEncoder) -> Floats:
    """(things,) log-factor of what compares colours, "the darker of the two": among these, not among all in view."""
    log_shade = np.zeros(len(among))
    members = np.flatnonzero(among)
    scores = look_scores(words, [encoder.all[j] for j in members.tolist()])
    if scores is not None:
        log_shade[members] = _SHADED * np.nan_to_num(scores - np.nanmax(scores))
    return log_shade
