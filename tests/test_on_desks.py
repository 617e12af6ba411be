"""Desks by how many things are on them.

Scenes and commands are ours.
"""

from __future__ import annotations

import pytest
from asked import grounded

from dcg_torch import Percept

DESKS = [
    Percept("three", "desk", None, (1.0, 0.0, 0.37), size=(1.6, 0.7, 0.74)),
    Percept("one", "desk", None, (1.0, 3.0, 0.37), size=(1.6, 0.7, 0.74)),
    Percept("two", "desk", None, (1.0, -3.0, 0.37), size=(1.6, 0.7, 0.74)),
    Percept("plant", "plant", None, (4.0, 0.0, 0.3), size=(0.3, 0.3, 0.6)),
    *(
        Percept(f"screen {k}", "monitor", None, (x, y, 0.94), size=(0.4, 0.1, 0.4))
        for k, (x, y) in enumerate([(0.5, 0.0), (1.0, 0.0), (1.5, 0.0), (1.0, 3.0), (0.7, -3.0), (1.3, -3.0)])
    ),
]


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("the desk with one monitor on it", "one"),
        ("the desk with two monitors", "two"),
        ("the desk that has three monitors", "three"),
        ("the desk with more monitors", "three"),
        ("the desk with fewer monitors", "one"),
    ],
)
def test_how_many_are_on_a_desk(text: str, expected: str) -> None:
    assert [o.id for o in grounded(text, DESKS, None).objects] == [expected]
