"""Playing cards, whose names have an "of" in the middle, in rows on a table.

Scenes and commands are ours.
"""

from __future__ import annotations

import pytest
from asked import grounded

from dcg_torch import Percept

TABLE = [  # two rows before the player: x is away, y to the left
    Percept(name, name, color, at, size=(0.06, 0.06, 0.0))
    for name, color, at in (
        ("two of spades", "black", (0.6, 0.15, 0.7)),
        ("jack of clubs", "black", (0.6, 0.0, 0.7)),
        ("jack of hearts", "red", (0.6, -0.15, 0.7)),
        ("nine of hearts", "red", (0.45, 0.15, 0.7)),
        ("queen of spades", "black", (0.45, 0.0, 0.7)),
        ("three of diamonds", "red", (0.45, -0.15, 0.7)),
    )
]


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("the jack of hearts", "jack of hearts"),
        ("the two of spades", "two of spades"),
        ("the queen", "queen of spades"),
        ("the red jack", "jack of hearts"),
        ("the card between the two of spades and the jack of hearts", "jack of clubs"),
        ("the card right of the queen of spades", "three of diamonds"),
    ],
)
def test_cards(text: str, expected: str) -> None:
    assert [o.id for o in grounded(text, TABLE).objects] == [expected]


def test_a_card_that_is_not_there_is_none_of_its_rank_for_certain() -> None:
    found = grounded("the jack of diamonds", TABLE)
    assert max(found.probabilities.get(o.id, 0.0) for o in TABLE) < 0.6
