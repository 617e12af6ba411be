"""One of two, whichever is more so; what bears a thing; what is not wanted, and other plain wordings. Written for this
project."""

from __future__ import annotations

import numpy as np
import pytest
from asked import meant

from dcg_torch.types import Percept


def tins(seed: int) -> list[Percept]:
    """Three tins, the red one the smallest and the blue one the largest, and a jar beside the green one."""
    at = 0.7 * np.random.default_rng(seed).permutation(3) - 0.7
    sizes = {"red": 0.1, "green": 0.2, "blue": 0.4}
    found = [
        Percept(color, "tin", color, (2.0, float(y), 0.0), (size,) * 3)
        for (color, size), y in zip(sizes.items(), at, strict=True)
    ]
    return [*found, Percept("jar", "jar", "white", (2.6, float(at[1]), 0.0), (0.1, 0.1, 0.25))]


@pytest.mark.parametrize("seed", range(5))
@pytest.mark.parametrize(
    ("text", "which"),
    [
        ("the red or the green tin, whichever is bigger", "green"),
        ("the green or the blue tin, whichever is smaller", "green"),
        ("the bigger of the red and the green tin", "green"),
        ("take the smaller one of the blue and green tins", "green"),
        ("whichever of the green and blue tins is closer to the jar", "green"),
        ("the tin that is bigger than the red one but smaller than the blue one", "green"),
        ("the tin of medium size", "green"),
        ("the middle-sized tin", "green"),
    ],
)
def test_whichever_of_two_is_more_so(text: str, which: str, seed: int) -> None:
    assert meant(text, tins(seed)) == {which}


@pytest.mark.parametrize("side", [1.0, -1.0])
@pytest.mark.parametrize(
    "text",
    [
        "the tin on the table with the plant on it",
        "the tin on the same table as the plant",
        "take the tin on the table that the plant is on",
        "the tin on the table on which the plant stands",
    ],
)
def test_what_bears_a_thing_is_the_landmark(text: str, side: float) -> None:
    tables = [Percept(f"t{k}", "table", None, (3.0, y, 0.0), (1.0, 1.0, 0.7)) for k, y in enumerate((1.5, -1.5))]
    on = [Percept(f"c{k}", "tin", None, (3.0, y, 0.7), (0.1, 0.1, 0.1)) for k, y in enumerate((1.4, -1.7))]
    plant = Percept("p", "plant", None, (3.2, 1.7 * side, 0.7), (0.2, 0.2, 0.4))
    assert meant(text, [*tables, *on, plant]) == {"c0" if side > 0.0 else "c1"}


@pytest.mark.parametrize("number", range(3))
@pytest.mark.parametrize(
    "text",
    [
        "I don't want the {other} tin. Give me the {color} one.",
        "I do not want the {other} tin, I want the {color} one",
        "no jar, only the {color} tin",
        "the user wants the {color} tin",
        "I think the {color} tin is near the jar",
    ],
)
def test_what_is_wanted_is_told_from_what_is_not(text: str, number: int) -> None:
    colors = ("red", "green", "blue")
    color, other = colors[number], colors[(number + 1) % 3]
    assert meant(text.format(color=color, other=other), tins(number)) == {color}


def test_a_place_is_looked_at_and_then_named_again() -> None:
    box = Percept("box", "box", None, (2.4, 0.0, 0.0), (0.5, 0.5, 0.6))
    cups = [Percept(i, "cup", None, at, (0.1, 0.1, 0.1)) for i, at in (("h", (3.1, 0.0, 0.0)), ("f", (2.0, 1.5, 0.0)))]
    for text in (
        "look behind the box; there is a cup",
        "I think the cup is behind the box",
    ):
        assert meant(text, [box, *cups]) == {"h"}, text
    back = Percept("b", "cup", None, (-2.0, 0.1, 0.0), (0.1, 0.1, 0.1))
    assert meant("turn around and get the cup", [box, *cups, back]) == {"b"}
