"""Where the time goes: `Timing` rows summed up."""

from __future__ import annotations

import math
from collections.abc import Sequence

from dcg_torch.storage.records import Timing

PHASES = ("load_world", "parse", "perceive", "ground", "explore", "drive", "train")
"""The parts of a command's time, in the order they happen; they do not overlap."""


def total_seconds(timing: Timing) -> float:
    """Seconds of one command, all phases."""
    return math.fsum(getattr(timing, phase) for phase in PHASES)


def summarise_seconds(timings: Sequence[Timing]) -> dict[str, float]:
    """Mean seconds per command of each phase, their sum `command`, and the longest `train_max`, `ground_max`.

    `ground_max` is the longest that grounding one command took, over all the looks it needed. Empty without timings.
    """
    if not timings:
        return {}
    means = {phase: math.fsum(getattr(t, phase) for t in timings) / len(timings) for phase in PHASES}
    return {
        **means,
        "command": math.fsum(means.values()),
        "train_max": max(t.train for t in timings),
        "ground_max": max(t.ground for t in timings),
    }
