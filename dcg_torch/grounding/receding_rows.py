"""Left and right in a row that leads away from the robot along one of its sides: buttons on the wall to its left.

All of them are as far to the left, and the nearest is leftmost as the robot turns to them. That is measured by where
they are seen, not learned.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from dcg_torch.grounding.counting import behind
from dcg_torch.grounding.encoding import WorldEncoder
from dcg_torch.names.vocabulary import ORDINALS
from dcg_torch.types import Phrase
from dcg_torch.types.arrays import Bools, Floats

_ENDS = {"leftmost": 1.0, "rightmost": -1.0, "left": 1.0, "right": -1.0, "from the left": 1.0, "from the right": -1.0}
"""Word -> whether the first is the one that is seen farthest to the left."""
_AS_WELL = 1.5
"""Nats by which what is in the row is described less well than the best."""
_LEVEL, _ASIDE = 0.3, 0.5
"""Share of how far a row leads away by which its things differ to the side at most, and by which all are aside."""


def of_receding_row(phrase: Phrase, described: tuple[Bools, Floats], encoder: WorldEncoder) -> tuple[Phrase, Floats]:
    """What a noun phrase in the singular says of an end of such a row.

    Args:
        described: (things,) what the rest of the phrase describes, and the log-factor of how well it does.

    Returns:
        The phrase without the words that are taken up, and the log-factor of each thing.
    """
    (among, fit), where = described, encoder.layout
    log = np.zeros(len(among))
    said = [word for word in phrase.words if word in _ENDS]
    if len(said) != 1 or phrase.plural or encoder.world.robot is None or where.picture:
        return phrase, log
    among = among & where.solid & np.isfinite(where.position).all(axis=1)
    at = np.flatnonzero(among & (fit >= fit[among].max(initial=-np.inf) - _AS_WELL))
    if len(at) < 2:
        return phrase, log
    ahead, aside = (where.position[at, :2] - where.robot).T
    deep = np.ptp(ahead)
    if not (ahead > 0.0).all() or np.ptp(aside) > _LEVEL * deep or np.abs(aside).min() < _ASIDE * deep:
        return phrase, log
    number = next((ORDINALS[word] for word in phrase.words if word in ORDINALS), 1)
    loss = behind(_ENDS[said[0]] * np.arctan2(aside, ahead), number, 1)
    log[at] = -loss
    log[np.setdiff1d(np.arange(len(log)), at)] = -loss.max()
    kept = tuple(word for word in phrase.words if word not in said and word not in ORDINALS)
    return replace(phrase, words=kept), log
