"""What a baseline is, and the one way in which scores of objects become a choice with a probability."""

from __future__ import annotations

import zlib
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Final, Protocol

import numpy as np

from dcg_torch.evaluation.episodes import Episode
from dcg_torch.storage.errors import UserError
from dcg_torch.types.arrays import Floats

_TEMPERATURES: Final = tuple(float(t) for t in np.geomspace(0.01, 100.0, 33))
_SLIP = 0.02
"""Share of commands that no score tells anything about: people err, too."""


class BaselineError(UserError):
    """A baseline that there is not, or that lacks what it needs; the message is one line."""


@dataclass(frozen=True, slots=True)
class Guess:
    """The ids of the objects chosen, and the probability that it is they."""

    objects: tuple[str, ...]
    probability: float


class Baseline(Protocol):
    """Something that can choose objects for a command; it never sees the target of an episode it predicts."""

    def fit(self, train: Sequence[Episode]) -> None:
        """Learn from episodes and their targets; there may be none."""

    def look_ahead(self, test: Sequence[Episode]) -> None:
        """Make ready for episodes to come, which is faster together than one by one; it changes no prediction."""
        return

    def predict(self, episode: Episode) -> Guess:
        """Choose among the objects of an episode."""

    def learn(self, episode: Episode, guess: Guess) -> None:
        """Learn from what was chosen, as if it had been right; most baselines learn nothing."""
        return


def choose(episode: Episode, scores: Floats, temperature: float, *, several: bool = False) -> Guess:
    """The object of the highest score; all that have it where the text asks for several.

    Equals are told apart by the episode's id, so that the choice is neither always the first nor another one tomorrow.

    Args:
        scores: (n,), one for each object.
        temperature: what the scores are divided by before they are log-odds.
        several: may all of the highest score be meant together?
    """
    share = probabilities(scores, temperature)
    best = np.flatnonzero(scores > scores.max() - 1e-9)
    if several and 1 < len(best) < len(scores):
        return Guess(tuple(episode.objects[k].id for k in best), float(share[best].sum()))
    one = int(best[zlib.crc32(episode.id.encode()) % len(best)])
    return Guess((episode.objects[one].id,), float(share[one]))


def probabilities(scores: Floats, temperature: float) -> Floats:
    """Softmax of scores (n,), with a share that is spread evenly."""
    weight = np.exp((scores - scores.max()) / temperature)
    result: Floats = (1.0 - _SLIP) * weight / weight.sum() + _SLIP / len(scores)
    return result


def fit_temperature(scored: Sequence[tuple[Floats, Sequence[int]]], default: float) -> float:
    """The temperature under which what was meant is likeliest.

    Args:
        scored: scores (n,) and the places of the objects meant, an episode each; those with no target tell nothing.
        default: what it is without episodes.
    """
    told = [(scores, list(meant)) for scores, meant in scored if meant]
    if not told:
        return default
    losses = [
        -sum(float(np.log(probabilities(scores, t)[meant]).mean()) for scores, meant in told) for t in _TEMPERATURES
    ]
    return _TEMPERATURES[int(np.argmin(losses))]


def places_meant(episode: Episode) -> list[int]:
    """Where the objects meant stand in the list of objects."""
    return [k for k, o in enumerate(episode.objects) if o.id in episode.target]
