"""The paper's figures, and which runs may stand beside them."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

ACCURACY = (0.70, 0.90)
"""Accuracy at each iteration, lowest and highest (Fig. 6a)."""

_PROTOCOL: Mapping[str, Any] = {"iterations": 10, "order": "drawn", "types": 8, "colors": 3, "object_rate": 0.15}


def follows_paper(config: Mapping[str, Any]) -> bool:
    """Is a run of these settings the paper's experiment: its kind of worlds, ten drawn commands by noun and colour?

    Model, robot, seed, number of trials and questions are free. Where settings are missing the answer is no.
    """
    worlds = config.get("worlds") in ("committed", "generated")
    speaker = config.get("speaker") in ("canonical", "written", "human")
    return worlds and speaker and all(config.get(key) == value for key, value in _PROTOCOL.items())
