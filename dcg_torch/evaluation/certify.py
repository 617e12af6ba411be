"""How often an answer changes as it should when the episode changes a little."""

from __future__ import annotations

from collections.abc import Callable, Collection, Sequence

from dcg_torch.evaluation.episodes import Episode
from dcg_torch.evaluation.perturbations import PERTURBATIONS

Answer = Callable[[Episode], Collection[str]]
"""The ids that are answered for an episode; none where nothing is meant, or where it is no order about a thing."""


def certify(answer: Answer, episodes: Sequence[Episode]) -> dict[str, dict[str, int]]:
    """Counts for each kind of change (`perturb.PERTURBATIONS`).

    Only an episode that is answered right as it is says something: an answer that was wrong need not change.

    Returns:
        `applicable`: episodes to which the change applies; `n`: those of them that were answered right before;
        `right`: those of these for which the answer is right after the change.
    """
    counts = {kind: {"applicable": 0, "n": 0, "right": 0} for kind in PERTURBATIONS}
    for episode in episodes:
        changes = {kind: change for kind, perturb in PERTURBATIONS.items() if (change := perturb(episode)) is not None}
        was_right = bool(changes) and frozenset(answer(episode)) == frozenset(episode.target)
        for kind, change in changes.items():
            counts[kind]["applicable"] += 1
            if was_right:
                counts[kind]["n"] += 1
                counts[kind]["right"] += change.expected.allows(answer(change.episode))
    return counts
