"""Things that are told by sides of several others."""

from __future__ import annotations

import pytest
from asked import shipped
from seen_whole import HERE, meant, thing

CUPS = [
    thing("near", "cup", 1.5, 0.6),
    thing("far", "cup", 3.0, -1.0),
    thing("before", "cup", 0.5, -1.0),
    thing("lamp", "lamp", 1.0, 0.5),
    thing("plate", "plate", 2.5, 0.3),
]
"""Of the two cups behind the lamp the near one is left of the plate, and the far one right of it."""


@pytest.mark.parametrize(
    ("text", "id_"),
    [
        ("take the cup behind the lamp and right of the plate", "far"),
        ("any cup that is right of the plate and behind the lamp", "far"),
        ("take the cup behind the lamp and left of the plate", "near"),
        ("take the cup in front of the lamp and to the right of the plate", "before"),
        ("take the thing behind the lamp and to the right of the plate", "far"),
    ],
)
def test_on_the_side_of_each_the_nearest_of_neither(text: str, id_: str) -> None:
    assert meant(text, CUPS) == [id_]


def test_of_equals_the_one_that_is_meant_by_a_side_alone() -> None:
    """Both cups are behind the lamp and left of the plate; the second is far off."""
    things = [*CUPS[3:], thing("first", "cup", 1.5, 0.6), thing("second", "cup", 4.0, 2.5)]
    assert meant("take the cup behind the lamp and left of the plate", things) == ["first"]


def test_north_of_two_is_a_probability() -> None:
    """What is not north of one of them is out, which once left nothing but not-a-number."""
    blocks = [
        thing("west", "block", 2.0, 0.5, "orange"),
        thing("east", "block", 3.0, -0.5, "orange"),
        thing("beyond", "block", 4.0, 0.2, "green"),
        thing("south", "block", 1.0, 0.0, "green"),
    ]
    model = shipped()
    found = model.ground("the green block north of the two orange blocks", model.world_model(blocks, robot=HERE))
    assert [o.id for o in found.objects] == ["beyond"]
    assert all(0.0 <= p <= 1.0 + 1e-9 for p in found.probabilities.values())


@pytest.mark.parametrize(
    ("text", "id_"),
    [
        ("look at the plate that is right of the lamp; any cup behind it", "behind"),
        ("find the plate. any cup behind it", "behind"),
        ("take the plate. any cup behind it is fine", "plate"),
    ],
)
def test_any_beside_what_is_looked_at(text: str, id_: str) -> None:
    things = [
        thing("behind", "cup", 2.5, 0.1),
        thing("before", "cup", 0.8, 0.1),
        thing("plate", "plate", 1.5, 0.0),
        thing("lamp", "lamp", 1.5, 1.2),
    ]
    assert meant(text, things) == [id_]
