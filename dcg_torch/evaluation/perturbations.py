"""Small changes of an episode after which it is known, by its words and objects alone, how the answer must change.

Each function returns the changed episode and what is right for it, or None where the change does not apply or where
nothing follows from it. Choices among several changes hang on the episode's id, so that they are the same tomorrow.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Mapping
from typing import Final

from dcg_torch.evaluation.episodes import Episode
from dcg_torch.evaluation.target_descriptions import (
    WORD,
    Expected,
    Perturbed,
    one_meant,
    pick,
    relates,
    replaced,
    said_of,
    same,
    with_text,
)
from dcg_torch.evaluation.turned_texts import swap_ordinal, swap_side
from dcg_torch.names import log_odds, normalise

COLORS: Final = ("red", "green", "blue", "yellow", "orange", "purple", "pink", "brown", "black", "white")


def swap_color(episode: Episode) -> Perturbed | None:
    """Another colour is said, one that a thing of the same class has: the answer must be of that class and colour."""
    target, said = one_meant(episode), said_of(episode)
    if target is None or said is None or said.color is None:
        return None
    alike = [o for o in episode.objects if o.color and same(o.type, target.type) and not same(o.color, target.color)]
    if not alike:
        return None
    color = str(pick(episode, sorted({str(o.color) for o in alike})))
    among = frozenset(o.id for o in alike if o.color == color)
    return with_text(episode, replaced(episode.text, said.color, color), among, "may" if relates(episode) else "no")


def swap_absent_color(episode: Episode) -> Perturbed | None:
    """A colour is said that nothing there has: nothing there is meant."""
    said = said_of(episode)
    there = {normalise(o.color).split(" ")[-1] for o in episode.objects if o.color}
    absent = [color for color in COLORS if color not in there]
    if said is None or said.color is None or not absent:
        return None
    return with_text(episode, replaced(episode.text, said.color, pick(episode, absent)), frozenset(), "must")


def swap_noun(episode: Episode) -> Perturbed | None:
    """Another class is said that is there: the answer must be of it, and of the colour said if one of it has that."""
    target, said = one_meant(episode), said_of(episode)
    if target is None or said is None:
        return None
    others = sorted({o.type for o in episode.objects if log_odds(target.type, o.type) < 0.0 and o.type.isascii()})
    if not others:
        return None
    name = pick(episode, others)
    of_class = [o for o in episode.objects if same(o.type, name)]
    fitting = [o for o in of_class if said.color is None or same(o.color, target.color)]
    text = replaced(episode.text, said.noun, normalise(name))
    may_fail = relates(episode) or not fitting
    return with_text(episode, text, frozenset(o.id for o in fitting or of_class), "may" if may_fail else "no")


def garble(episode: Episode) -> Perturbed | None:
    """Each word of three letters or more loses its vowels and is turned round: nothing is said any more."""
    text = WORD.sub(
        lambda m: re.sub("[aeiouy']", "", m[0].lower())[::-1] + "x" if len(m[0]) > 2 else "zq", episode.text
    )
    return with_text(episode, text, frozenset(), "must")


def take_away(episode: Episode) -> Perturbed | None:
    """All things of the class and colour said are gone: nothing there is meant."""
    target, said = one_meant(episode), said_of(episode)
    if target is None or said is None:
        return None
    noun = episode.text[slice(*said.noun)]
    kept = [
        o
        for o in episode.objects
        if max(log_odds(noun, o.type), log_odds(target.type, o.type)) < 0.0
        or (said.color is not None and o.color is not None and not same(o.color, target.color))
    ]
    if not kept or len(kept) == len(episode.objects):
        return None
    gone = episode.model_copy(update={"objects": tuple(kept), "target": ()})
    return Perturbed(gone, Expected(frozenset(), frozenset(episode.target), "must"))


PERTURBATIONS: Final[Mapping[str, Callable[[Episode], Perturbed | None]]] = {
    "color": swap_color,
    "absent color": swap_absent_color,
    "noun": swap_noun,
    "side": swap_side,
    "ordinal": swap_ordinal,
    "garbled": garble,
    "taken away": take_away,
}
