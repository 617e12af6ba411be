"""What "above" and "under" mean where all lies on one level, as on a board that is seen from above."""

from __future__ import annotations

import pytest
from asked import grounded

from dcg_torch.types import Percept

COUNTERS = {
    **{"Q": (1.8, 0.5), "W": (1.75, 0.0), "V": (1.7, -0.6), "X": (1.3, 0.45), "Z": (1.2, -0.1)},
    **{"Y": (1.25, -0.65), "J": (0.6, 0.5), "H": (0.65, -0.05), "G": (0.55, -0.6)},
}


@pytest.mark.parametrize(
    ("text", "letter"),
    [
        ("the counter under the Q", "X"),
        ("the counter right under the V", "Y"),
        ("the counter above the H", "Z"),
        ("the one over the G", "Y"),
    ],
)
def test_what_is_above_is_beyond(text: str, letter: str) -> None:
    things = [
        Percept(name, "counter", None, (x, y, 0.0), (0.2, 0.2, 0.2), attributes=frozenset({f"letter: {name}"}))
        for name, (x, y) in COUNTERS.items()
    ]
    answer = grounded(text, things, looked=True)
    assert [thing.id for thing in answer.objects] == [letter]
