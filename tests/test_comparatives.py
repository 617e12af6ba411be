"""What is compared with one thing that is named: sizes, heights and shades. Scenes and commands are ours."""

from __future__ import annotations

import pytest
from asked import grounded, seen

from dcg_torch.types import Percept

THINGS = (  # id, class, x, y, extents, gray
    ("thin", "crate", 2.0, 1.5, (0.2, 0.2, 1.1), 40),
    ("mean", "crate", 3.0, 0.3, (0.5, 0.5, 0.5), 120),
    ("vast", "crate", 2.5, -1.0, (1.0, 1.0, 0.9), 220),
    ("drum", "drum", 4.0, 1.0, (0.4, 0.4, 0.4), 80),
    ("tank", "tank", 4.5, -1.2, (0.8, 0.8, 1.0), 170),
)


def _meant(text: str, *, known: bool = True) -> tuple[set[str], float | None]:
    percepts = [
        Percept(id_, kind, None, (x, y, 0.0), size=size if known else None, rgb=(gray,) * 3 if known else None)
        for id_, kind, x, y, size, gray in THINGS
    ]
    solution = grounded(text, percepts, looked=True)
    return seen(solution), solution.probability


@pytest.mark.parametrize(
    ("text", "meant"),
    [
        ("the crate that is bigger than the tank", {"vast"}),
        ("take the crate smaller than the drum", {"thin"}),
        ("the crate taller than the tank", {"thin"}),
        ("the crates taller than the drum", {"thin", "mean", "vast"}),
        ("the crates which are larger than the drum", {"mean", "vast"}),
        ("all crates that are not larger than the drum", {"thin"}),
        ("the crate darker than the drum", {"thin"}),
        ("the crate that is lighter than the tank", {"vast"}),
    ],
)
def test_more_or_less_than_what_is_named(text: str, meant: set[str]) -> None:
    assert _meant(text)[0] == meant


def test_nobody_knows_what_is_bigger_where_no_sizes_are_given() -> None:
    _, probability = _meant("the crate bigger than the tank", known=False)
    assert probability is not None
    assert probability < 0.5
