"""What is on a side of a thing as the only one of its kind, however far off and aslant.

Scenes and commands are ours.
"""

from __future__ import annotations

import pytest
from asked import grounded

from dcg_torch import Percept

PITCH = [  # a robot at the origin looks along x
    Percept("mark", "cube", "yellow", (3.3, 0.4, 0.2), size=(0.4, 0.4, 0.4)),
    Percept("before", "cylinder", "gray", (2.4, -0.5, 0.2), size=(0.4, 0.4, 0.4)),
    Percept("beside", "cylinder", "brown", (3.2, 2.2, 0.2), size=(0.4, 0.4, 0.4)),
    Percept("beyond", "cylinder", "blue", (6.0, -2.2, 0.2), size=(0.4, 0.4, 0.4)),
]


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("the cylinder behind the yellow cube", "beyond"),  # aslant and far off, but no other is behind it
        ("the cylinder in front of the yellow cube", "before"),
        ("the cylinder left of the yellow cube", "beside"),
        ("the thing that is the same size as the cube and behind it", "beyond"),
    ],
)
def test_the_only_one_on_a_side(text: str, expected: str) -> None:
    assert [o.id for o in grounded(text, PITCH).objects] == [expected]
