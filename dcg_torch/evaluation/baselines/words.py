"""Baselines that compare words with names: what a user writes in ten minutes, and two things added to it."""

from __future__ import annotations

import re
from collections import defaultdict
from collections.abc import Callable, Sequence

import numpy as np

from dcg_torch.evaluation.baselines.base import Baseline, Guess, choose, fit_temperature, places_meant
from dcg_torch.evaluation.episodes import Episode
from dcg_torch.names.normal_form import normalise
from dcg_torch.types.arrays import Floats

_TOYS = {"ball": "sphere", "block": "cube", "box": "cube", "brick": "cube", "square": "cube"}
"""The few synonyms that whoever works with blocks would think of."""
_HEAD, _SHARE, _LATE, _COLOR = 10.0, 5.0, 0.2, 3.0
_NEAREST = 3.0
_ASSOCIATED = 2.0  # points of overlap that a word is worth for each nat that it tells of a type
_ALL = frozenset({"all", "both", "every", "each", "two", "three", "four", "five", "six"})
_PRIOR = 3.0  # commands' worth of doubt in what a word goes with


def words_of(text: str) -> list[str]:
    """The words of a text in normal form, toy names replaced."""
    found = [normalise(word) for word in re.findall(r"[a-z]+", text.lower())]
    return [_TOYS.get(word, word) for word in found]


def overlap(episode: Episode) -> Floats:
    """How much of each object's class and colour the text names: (n,), 0 for nothing.

    A class counts by its last word, by the share of its words, and by how early it is named; a colour only where it
    is said before the class.
    """
    first: dict[str, int] = {}
    for place, word in enumerate(words_of(episode.text)):
        first.setdefault(word, place)
    scores = np.zeros(len(episode.objects))
    for k, thing in enumerate(episode.objects):
        name = words_of(normalise(thing.type))
        hits = [first[word] for word in name if word in first]
        if hits:
            scores[k] = _HEAD * (name[-1] in first) + _SHARE * len(hits) / len(name) - _LATE * min(hits)
        color = words_of(thing.color)[-1:] if thing.color else []
        scores[k] += _COLOR * any(c in first and (not hits or first[c] <= min(hits)) for c in color)
    return scores


def nearest(episode: Episode) -> Floats:
    """(objects,) `overlap`, and a few points for the nearest of those that come first; without a pose, none."""
    scores = overlap(episode)
    if episode.pose is not None:
        best = np.flatnonzero(scores > scores.max() - 1e-9)
        places = np.array([episode.objects[k].position[:2] for k in best])
        away = np.linalg.norm(places - np.array([episode.pose.x, episode.pose.y]), axis=1)
        scores[best[int(away.argmin())]] += _NEAREST
    return scores


class Scored(Baseline):
    """A baseline whose scores are a function of the episode; it learns only how sure it may be.

    Args:
        scores: of an episode, (n,).
        temperature: what it is before there was any training.
    """

    def __init__(self, scores: Callable[[Episode], Floats], temperature: float) -> None:
        self._scores, self._temperature = scores, temperature

    def fit(self, train: Sequence[Episode]) -> None:
        """Learn the temperature."""
        scored = [(self._scores(e), places_meant(e)) for e in train]
        self._temperature = fit_temperature(scored, self._temperature)

    def predict(self, episode: Episode) -> Guess:
        """Choose the object of the highest score."""
        scores = self._scores(episode)
        return choose(episode, scores, self._temperature, several=asks_for_several(episode, scores))


class Outcomes(Scored):
    """`overlap`, and what went with each word: the word that tells most of a type speaks for it.

    For a word and a type it compares how often the type was chosen where the word was said and the type was there,
    with how often it was chosen where it was there at all.
    """

    def __init__(self, temperature: float = 3.0) -> None:
        super().__init__(self._told, temperature)
        self._chosen: defaultdict[tuple[str | None, str], float] = defaultdict(float)
        self._offered: defaultdict[tuple[str | None, str], float] = defaultdict(float)

    def fit(self, train: Sequence[Episode]) -> None:
        """Count words and the types meant, then learn the temperature."""
        for episode in train:
            self._count(episode, episode.target)
        super().fit(train)

    def learn(self, episode: Episode, guess: Guess) -> None:
        """Count the words and the types chosen, as far as it is sure of them."""
        self._count(episode, guess.objects, guess.probability)

    def _count(self, episode: Episode, meant: Sequence[str], weight: float = 1.0) -> None:
        words: list[str | None] = [*set(words_of(episode.text)), None]  # None: whatever was said
        there = {normalise(o.type): False for o in episode.objects}
        there |= {normalise(o.type): True for o in episode.objects if o.id in meant}
        for word in words:
            for kind, chosen in there.items():
                self._offered[word, kind] += weight
                self._chosen[word, kind] += weight * chosen

    def _told(self, episode: Episode) -> Floats:
        kinds = [normalise(o.type) for o in episode.objects]
        words = set(words_of(episode.text))
        usual = 1.0 / len(set(kinds))
        told = {}
        for kind in set(kinds):
            rate = (self._chosen.get((None, kind), 0.0) + usual) / (self._offered.get((None, kind), 0.0) + 1.0)
            rates = [
                (self._chosen.get((word, kind), 0.0) + _PRIOR * rate) / (self._offered.get((word, kind), 0.0) + _PRIOR)
                for word in words
            ]
            told[kind] = float(np.log(max(rates, default=rate) / rate))
        return overlap(episode) + _ASSOCIATED * np.array([told[kind] for kind in kinds])


def asks_for_several(episode: Episode, scores: Floats) -> bool:
    """Does the text count the objects of the highest score, or name their class in the plural?"""
    said = re.findall(r"[a-z]+", episode.text.lower())
    heads = {
        words_of(normalise(o.type))[-1:][0]
        for o, score in zip(episode.objects, scores, strict=True)
        if score > scores.max() - 1e-9 and words_of(normalise(o.type))
    }
    plurals = (word for word in said if normalise(word) == word[: len(normalise(word))] != word)
    return bool(_ALL & set(said)) or any(_TOYS.get(normalise(w), normalise(w)) in heads for w in plurals)
