"""The few on an edge of a page: "the smaller of the bottom two", "the two dots on the left, the lighter one".

Scenes and commands are ours.
"""

from __future__ import annotations

import pytest
from asked import grounded

from dcg_torch import Percept, Pose

PAGE = [  # x is up, y to the left: two at the bottom, two on the left over them, one at the top right
    Percept("bottom small", "dot", None, (0.05, 0.1, 0.0), size=(0.03, 0.03, 0.0), rgb=(90, 90, 90)),
    Percept("bottom large", "dot", None, (0.1, -0.4, 0.0), size=(0.09, 0.09, 0.0), rgb=(20, 20, 20)),
    Percept("left light", "dot", None, (0.6, 0.8, 0.0), size=(0.06, 0.06, 0.0), rgb=(215, 215, 215)),
    Percept("left dark", "dot", None, (0.8, 0.7, 0.0), size=(0.06, 0.06, 0.0), rgb=(50, 50, 50)),
    Percept("top", "dot", None, (1.0, -0.5, 0.0), size=(0.02, 0.02, 0.0), rgb=(130, 130, 130)),
]


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("the smaller of the bottom two", "bottom small"),
        ("of the bottom two dots, the smallest one", "bottom small"),
        ("the lighter of the two on the bottom", "bottom small"),
        ("the darkest of the two bottom dots", "bottom large"),
        ("of the two leftmost dots, the lightest", "left light"),
        ("look at the two leftmost dots and take the darkest one", "left dark"),
        ("do you see the lightest one? the dot right above it", "left dark"),
        ("do you see the darkest one? the dot to the left of it", "bottom small"),
        ("the dot most to the upper right", "top"),
        ("not the smallest, the next smallest", "bottom small"),
        ("the closest pair of dots: the lighter one", "left light"),
        ("the loner", "top"),
        ("it is large and black", "bottom large"),
    ],
)
def test_the_few_on_an_edge(text: str, expected: str) -> None:
    assert [o.id for o in grounded(text, PAGE, Pose(-2.0, 0.0)).objects] == [expected]
