"""The middle one of a row of a picture is as many places from one end as from the other, wherever the others stand."""

from __future__ import annotations

import pytest
from seen_whole import meant, thing

from dcg_torch.types import Percept


def _row(name: str, height: float, *lefts: float) -> list[Percept]:
    return [thing(f"{name} {k}", "boy", 2.0, y, z=height, size=(0.1, 0.4, 0.7)) for k, y in enumerate(lefts)]


_PHOTO = [
    *_row("top", 2.4, 1.5, 1.0, 0.5, -0.4, -1.5),  # the third is far to the left of the middle
    *_row("low", 0.7, 1.2, 0.5, -0.3, -1.1),
]


@pytest.mark.parametrize(
    ("text", "id_"),
    [
        ("middle boy in the top row", "top 2"),
        ("the center boy in the top row", "top 2"),
        ("second boy from the left in the top row", "top 1"),
    ],
)
def test_the_middle_one_is_counted(text: str, id_: str) -> None:
    assert meant(text, _PHOTO) == [id_]


def test_of_four_one_in_the_middle_is_meant() -> None:
    assert meant("middle boy in the bottom row", _PHOTO) in (["low 1"], ["low 2"])
