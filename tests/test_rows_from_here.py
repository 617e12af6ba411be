"""Rows told from where one stands, halves, ends, and what is nearer to one thing than to another. Written for this
project."""

from __future__ import annotations

import numpy as np
import pytest
from asked import meant

from dcg_torch.types import Percept

COLORS = ("red", "green", "blue", "yellow")


def field(rows: int, columns: int, *, sized: bool = True) -> list[Percept]:
    """Crates in rows, the nearest first, each with another colour than those beside it: "12" is in the second row."""
    size = (0.3, 0.3, 0.3) if sized else None
    return [
        Percept(f"{r}{c}", "crate", COLORS[(r + c) % 4], (2.0 + 1.3 * r, 1.5 - 0.9 * c, 0.0), size)
        for r in range(rows)
        for c in range(columns)
    ]


@pytest.mark.parametrize("rows", [2, 3])
@pytest.mark.parametrize(
    ("said", "last"),
    [("closest to you", False), ("nearest you", False), ("farthest from you", True), ("furthest away", True)],
)
def test_a_row_is_told_by_how_far_it_is_from_the_robot(rows: int, said: str, last: bool) -> None:
    things, row = field(rows, 4), rows - 1 if last else 0
    whole = {f"{row}{c}" for c in range(4)}
    assert meant(f"all crates in the row {said}", things) == whole
    assert meant(f"the second crate from the left in the row {said}", things) == {f"{row}1"}
    assert meant(f"take the crate on the right in the row {said}", things) == {f"{row}3"}
    assert meant(f"the last two of the row {said}", things) == {f"{row}2", f"{row}3"}


@pytest.mark.parametrize("rows", [2, 3])
def test_on_a_floor_the_first_row_is_the_nearest_and_on_a_page_the_top_one(rows: int) -> None:
    floor, page = field(rows, 4), field(rows, 4, sized=False)
    assert meant("the rightmost crate in the first row", floor) == {"03"}
    assert meant("the third crate from the left in the second row", floor) == {"12"}
    assert meant("all the crates in the last row", floor) == {f"{rows - 1}{c}" for c in range(4)}
    assert meant("the rightmost crate in the first row", page) == {f"{rows - 1}3"}


@pytest.mark.parametrize("seed", range(4))
def test_a_half_holds_all_that_is_on_that_side(seed: int) -> None:
    rng = np.random.default_rng(seed)
    sides = [("l", 1.0)] * 2 + [("r", -1.0)] * 3
    things = [
        Percept(f"{s}{k}", "tire", None, (2.0 + 0.7 * k, w * float(rng.uniform(0.8, 1.9)), 0.0))
        for k, (s, w) in enumerate(sides)
    ]
    assert meant("the tires on the left half", things) == {"l0", "l1"}
    assert meant("all the tires in the right half of the room", things) == {"r2", "r3", "r4"}


@pytest.mark.parametrize("number", [4, 5, 6])
def test_the_ends_of_a_row_are_left_out(number: int) -> None:
    row = [Percept(f"r{k}", "cone", None, (3.0, 0.5 * (number - 1) - k, 0.0)) for k in range(number)]
    inner = {f"r{k}" for k in range(1, number - 1)}
    for text in (
        "every cone but the first and last",
        "all cones except the leftmost and the rightmost one",
        "all but the two on the ends",
        "all the cones except the ones at the ends",
    ):
        assert meant(text, row) == inner, text
    assert meant("take the cone as far left as possible", row) == {"r0"}


@pytest.mark.parametrize("seed", range(4))
def test_what_is_nearer_to_one_of_two_things_is_measured(seed: int) -> None:
    rng = np.random.default_rng(seed)
    door, pool = Percept("d", "door", None, (4.0, 3.0, 0.0)), Percept("p", "pool", None, (4.0, -3.0, 0.0))
    aside = (0.5, 1.2, 2.0, -0.6, -1.5)
    cones = [
        Percept(f"c{k}", "cone", c, (float(rng.uniform(3.0, 5.0)), y, 0.0))
        for k, (y, c) in enumerate(zip(aside, (*COLORS, "white"), strict=True))
    ]
    things = [*cones, door, pool]
    upper, lower = {"c0", "c1", "c2"}, {"c3", "c4"}
    assert meant("all cones closer to the door than to the pool", things) == upper
    assert meant("the cones that are nearer the pool than the door", things) == lower
    assert meant("the cones farther from the door than from the pool", things) == lower


def test_what_is_nearer_than_another_of_its_kind() -> None:
    barrel = Percept("b", "barrel", None, (2.0, 0.0, 0.0))
    cones = [Percept(f"c{k}", "cone", c, (3.0 + k, 0.3 * (-1) ** k, 0.0)) for k, c in enumerate(COLORS)]
    assert meant("all cones closer to the barrel than the blue one", [*cones, barrel]) == {"c0", "c1"}
    assert meant("the cones that are farther from the barrel than the green cone", [*cones, barrel]) == {"c2", "c3"}
