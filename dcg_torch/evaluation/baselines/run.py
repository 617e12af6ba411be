"""Every baseline on the same episodes in the same order."""

from __future__ import annotations

from collections.abc import Callable, Sequence

from dcg_torch.evaluation.baselines.base import Baseline
from dcg_torch.evaluation.episodes import Episode
from dcg_torch.evaluation.files import FiledEpisode, Outcome


def run_baseline(
    baseline: Baseline,
    train: Sequence[Episode],
    test: Sequence[FiledEpisode],
    *,
    advance: Callable[[], object] = lambda: None,
) -> list[Outcome]:
    """Train a baseline, then go through the test in its order; it learns from its own choices if it is one that does.

    Args:
        advance: called after each test episode.
    """
    baseline.fit(train)
    outcomes = []
    for filed in test:
        guess = baseline.predict(filed.episode)
        baseline.learn(filed.episode, guess)
        outcomes.append(Outcome(filed.file, guess.probability, set(guess.objects) == set(filed.episode.target)))
        advance()
    return outcomes
