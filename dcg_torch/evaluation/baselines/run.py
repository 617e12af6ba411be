"""Every baseline on the same episodes in the same order."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass

from dcg_torch.evaluation.baselines.base import Baseline
from dcg_torch.evaluation.episodes import Episode


@dataclass(frozen=True, slots=True)
class Outcome:
    """What came of one episode of a file: how sure the baseline was, and was it right?"""

    file: str
    id: str
    predicted: tuple[str, ...]
    probability: float
    correct: bool


def run_baseline(
    baseline: Baseline,
    train: Sequence[Episode],
    test: Mapping[str, Sequence[Episode]],
    *,
    advance: Callable[[], object] = lambda: None,
) -> list[Outcome]:
    """Train a baseline, then go through the test in its order; it learns from its own choices if it is one that does.

    Args:
        test: the episodes of each file by its name.
        advance: called after each test episode.

    Raises:
        BaselineError: the baseline learns from training episodes, and there are none.
    """
    baseline.fit(train)
    baseline.look_ahead([episode for episodes in test.values() for episode in episodes])
    outcomes = []
    for file, episodes in test.items():
        for episode in episodes:
            guess = baseline.predict(episode)
            baseline.learn(episode, guess)
            right = set(guess.objects) == set(episode.target)
            outcomes.append(Outcome(file, episode.id, guess.objects, guess.probability, right))
            advance()
    return outcomes
