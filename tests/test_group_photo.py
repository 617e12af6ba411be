"""People in a picture by what they wear, how they are and who stands beside them, in few words.

Scenes and commands are ours.
"""

from __future__ import annotations

import pytest
from asked import grounded

from dcg_torch import Percept

PHOTO = [
    Percept(name, kind, None, at, size=(0.3, 0.4, tall), attributes=frozenset(told))
    for name, kind, at, tall, told in (
        ("ann", "woman", (2.0, 1.0, 0.8), 1.6, {"shirt: white", "pose: standing", "hat: 0"}),
        ("bob", "man", (2.0, 0.4, 0.9), 1.8, {"shirt: green", "pose: sitting", "hat: 1"}),
        ("cy", "boy", (2.1, -0.2, 0.6), 1.2, {"shirt: red", "pose: standing", "hat: 1"}),
        ("dee", "girl", (2.0, -0.8, 0.6), 1.2, {"shirt: blue", "pose: lying", "hat: 1"}),
    )
]


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("the gentleman", "bob"),
        ("the lady", "ann"),
        ("the person who is sitting", "bob"),
        ("only person lying down", "dee"),
        ("the boy standing up", "cy"),
        ("no hat", "ann"),
        ("person just left of the green shirt", "ann"),
        ("the one right of the red shirt", "dee"),
        ("number 2 from left", "bob"),
        ("all the way to the right", "dee"),
    ],
)
def test_who_is_meant(text: str, expected: str) -> None:
    assert [o.id for o in grounded(text, PHOTO).objects] == [expected]
