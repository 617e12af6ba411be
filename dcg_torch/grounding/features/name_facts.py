"""What the name of a class, of a colour or of an attribute says about a phrase: facts as grounding features.

They depend on the phrase as well as on the object: "lamp" holds of a floor lamp as its head. Which facts hold, `names`
says. Their weights are known from the start (`fact_odds`), so that a class name is evidence before anything is learned;
what is learned of a word comes on top.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from dcg_torch.names.attributes import ATTRIBUTE_FACTS, attribute_evidence
from dcg_torch.names.color_names import color_evidence
from dcg_torch.names.colors import color_scores, looks_like
from dcg_torch.names.evidence import evidence
from dcg_torch.names.normal_form import normalise
from dcg_torch.names.palette import color_words, named_rgb
from dcg_torch.names.weights import FACTS, fact_weights, log_odds
from dcg_torch.types import LOOKED_ROUND, NOT, OPAQUE, Object, Phrase
from dcg_torch.types.arrays import Floats, Ints

_SAME_COLOR = frozenset({"color: equal", "color: same hue", "color: alike"})
_TRUST = 0.6
"""Share of the facts' log-odds that is believed: a parser's noun is wrong more often than a list of nouns is."""
_HEAD = 1.5
"""What a class that ends with the noun has beside: who means an office chair often says "chair" where chairs are, too.
The list of nouns has few such pairs, and there a class of just that name takes all."""
_ABSENT, _NOT = "name: absent", f"{NOT} "
_ABSENT_ODDS = 3.5
"""Of what is not there, once all has been seen: a noun that no class is named by mostly means nothing that is there."""
_COLOR_ODDS = {"equal": 4.0, "same hue": -0.5, "alike": 2.5, "near": -1.0, "shades apart": -2.0, "far": -4.0}
_ATTRIBUTE_ODDS = {"equal": 3.0, "alike": 3.0, "contrary": -3.0, "silent": -0.5}
_LOOKS = (0.0, 0.5, 1.0, 2.0, 4.0, 8.0)
"""Bounds of how far a colour's score stays behind the best in view."""
_LOOK_ODDS = 3.0
"""Of the colour that the words fit best: without them, what was never seen would be as likely."""
LOOK_FACTS = tuple(f"look: {k}" for k in range(len(_LOOKS) + 1))


@dataclass(frozen=True, slots=True)
class Said:
    """What a noun phrase says of an object's class, colour and attributes.

    Attributes:
        look: the words by which the object's colour as it is seen is to be judged.
    """

    noun: str | None
    color: str | None
    words: tuple[str, ...]
    look: tuple[str, ...] = ()

    @classmethod
    def of(cls, phrase: Phrase) -> Said:
        """What a phrase says."""
        return cls(phrase.noun, phrase.color, phrase.words, phrase.look)

    def denies(self) -> bool:
        """Does a word say what a thing is not: "not red"?"""
        return any(word.startswith(_NOT) for word in self.words)


def fact_odds() -> dict[str, float]:
    """Name of a grounding feature -> its log-odds before anything is learned."""
    weights = fact_weights()
    odds = {f"said {fact}": _TRUST * weights.get(fact, 0.0) for fact in FACTS}
    odds["said name: head"] += _HEAD
    odds[f"said {_ABSENT}"] = _ABSENT_ODDS
    odds |= {f"said color: {name}": value for name, value in _COLOR_ODDS.items()}
    odds |= {f"said attribute: {name}": value for name, value in _ATTRIBUTE_ODDS.items()}
    return odds | {f"said {fact}": _LOOK_ODDS - _behind(k) for k, fact in enumerate(LOOK_FACTS)}


def _behind(k: int) -> float:
    """About how far behind the best a colour in the k-th class of scores is."""
    if k == 0:
        return 0.0
    return (_LOOKS[k - 1] + _LOOKS[min(k, len(_LOOKS) - 1)]) / 2.0


def said_features() -> list[str]:
    """The names of all such features."""
    names = [*FACTS, _ABSENT, *(f"color: {name}" for name in _COLOR_ODDS), *ATTRIBUTE_FACTS, *LOOK_FACTS]
    return [f"said {name}" for name in names]


def facts(said: Said, thing: Object, look: int) -> list[str]:
    """The names of the features that fire for a thing: by its type, colour, attributes and look.

    Args:
        look: see `look_codes`.
    """
    found: list[str] = []
    if said.noun is not None and thing.type is None and LOOKED_ROUND in thing.attributes:
        found.append(_ABSENT)
    if said.noun is not None and thing.type is not None and not thing.type.startswith(OPAQUE):
        found += evidence(said.noun, thing.type)
    if look >= 0:
        found.append(LOOK_FACTS[look])
    if said.color is not None and thing.color is not None:
        found += color_evidence(said.color, thing.color)
    if said.words and thing.attributes:
        found += attribute_evidence(said.words, thing.attributes)
    if said.words and is_ruled_out(said.words, thing, look < 0):
        found = list(dict.fromkeys([*found, "attribute: contrary"]))
    return [f"said {name}" for name in found]


def is_ruled_out(words: Sequence[str], thing: Object, named: bool) -> bool:
    """Does a word such as "not red" or "not cube" rule a thing out?

    Args:
        named: are colours to be judged by their names?
    """
    return any(_denies(word.removeprefix(_NOT), thing, named) for word in words if word.startswith(_NOT))


def _denies(denied: str, thing: Object, named: bool) -> bool:
    of_color = named and thing.color is not None and not _SAME_COLOR.isdisjoint(color_evidence(denied, thing.color))
    if named and thing.color is None and thing.rgb is not None:
        of_color = looks_like(denied, thing.rgb)
    shown = named and (thing.color is not None or thing.rgb is not None)
    if shown and normalise(denied) in color_words().basic:  # no person is "a red" then
        return of_color
    return of_color or (
        thing.type is not None and not thing.type.startswith(OPAQUE) and log_odds(denied, thing.type) > 0.0
    )


def look_codes(words: tuple[str, ...], things: Sequence[Object]) -> Ints | None:
    """How far each thing that shows its colour stays behind the one that the words fit best.

    Returns:
        (things,) numbers of `LOOK_FACTS`, -1 for what shows none; None where the words say nothing of colours.
    """
    scores = look_scores(words, things)
    if scores is None:
        return None
    shown = np.isfinite(scores)
    found = np.full(len(things), -1, dtype=np.int64)
    found[shown] = np.searchsorted(_LOOKS, scores[shown].max() - scores[shown], side="left")
    return found


def look_scores(words: tuple[str, ...], things: Sequence[Object]) -> Floats | None:
    """(things,) how well words fit what each looks like, among these things; NaN for what shows no colour.

    Where none shows it, the names of their colours say what they look like. None where the words say nothing of it.
    """
    looks = {j: thing.rgb for j, thing in enumerate(things) if thing.rgb is not None} if words else {}
    if words and not looks:
        named = {j: named_rgb(thing.color) for j, thing in enumerate(things) if thing.color is not None}
        looks = {j: rgb for j, rgb in named.items() if rgb is not None}
    if not looks:
        return None
    scores = color_scores(words, np.array(list(looks.values()), dtype=np.float64))
    if np.ptp(scores) <= 1e-9:
        return None
    found = np.full(len(things), np.nan)
    found[list(looks)] = scores
    return found
