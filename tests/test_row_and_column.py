"""Boards of rows and columns in the words of players: "r2c3", "of the red ones the leftmost", "diagonal from the red".

Scenes and commands are ours.
"""

from __future__ import annotations

import pytest
from asked import grounded

from dcg_torch import Percept

_COLORS = (  # as who plays sees them, the first row is the farthest
    ("white", "red", "blue"),
    ("blue", "green", "white"),
    ("red", "yellow", "black"),
)
BOARD = [
    Percept(
        f"{row + 1} {column + 1}", "tile", color, (1.2 - 0.1 * row, 0.1 - 0.1 * column, 0.0), size=(0.06, 0.06, 0.01)
    )
    for row, colors in enumerate(_COLORS)
    for column, color in enumerate(colors)
]


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("row 2 column 3", {"2 3"}),
        ("second row, third column", {"2 3"}),
        ("r3c1", {"3 1"}),
        ("end of row 2", {"2 3"}),
        ("from the top left, third row, first one", {"3 1"}),
        ("count 2 rows down and 3 across", {"2 3"}),
        ("go to row two and take the third tile", {"2 3"}),
        ("look at the bottom row and pick the red tile", {"3 1"}),
        ("of the red ones the leftmost", {"3 1"}),
        ("of the white ones the lowest", {"2 3"}),
        ("yellow tile: the one above it", {"2 2"}),
        ("next to the yellow one, on its left", {"3 1"}),
        ("diagonal from the green, upper right", {"1 3"}),
        ("down one and left one from the green one", {"3 1"}),
        ("start at the yellow tile and move two squares up", {"1 2"}),
        ("the tile in the exact center", {"2 2"}),
        ("the four corners", {"1 1", "1 3", "3 1", "3 3"}),
    ],
)
def test_in_rows_and_columns(text: str, expected: set[str]) -> None:
    assert {o.id for o in grounded(text, BOARD).objects} == expected
