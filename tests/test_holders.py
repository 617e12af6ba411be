"""Orders about what is not there, and of which it is said what is to hold it, among things of several kinds."""

from __future__ import annotations

import pytest
from seen_whole import meant, thing

KITCHEN = [
    thing("fridge", "refrigerator", 3.0, 1.0),
    thing("sink", "sink", 3.0, -1.0),
    thing("desk", "desk", 1.0, 2.0),
    thing("cup", "cup", 2.0, 0.5),
]


@pytest.mark.parametrize(
    ("text", "ids"),
    [
        ("put my leftovers in the fridge", ["fridge"]),
        ("put some milk into the refrigerator", ["fridge"]),
        ("my keys are in the desk", ["desk"]),
        ("put my cup in the sink", ["cup"]),  # it is there
        ("bring me the apple in the fridge", []),  # that is an apple, and none is there
    ],
)
def test_what_is_to_hold_what_the_speaker_has(text: str, ids: list[str]) -> None:
    assert meant(text, KITCHEN) == ids
