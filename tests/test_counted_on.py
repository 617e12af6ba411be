"""How many a thing has on it, what is counted from a landmark or along a line, and what is opposite. Written for this
project."""

from __future__ import annotations

import numpy as np
import pytest
from asked import meant

from dcg_torch.types import Percept

COLORS = ("red", "green", "blue", "yellow", "black", "white", "orange")


def benches(seed: int) -> list[Percept]:
    """Benches with one, two and three pots on them: "b2" has "p20", "p21" and "p22"."""
    at = 2.4 * np.random.default_rng(seed).permutation(3) - 2.4
    found = [Percept(f"b{k}", "bench", None, (3.0, float(y), 0.0), (0.6, 1.6, 0.5)) for k, y in enumerate(at)]
    for k, y in enumerate(at):
        found += [
            Percept(f"p{k}{j}", "pot", COLORS[j], (2.9 + 0.1 * j, float(y) + 0.4 * (j - 1), 0.5), (0.2,) * 3)
            for j in range(k + 1)
        ]
    return found


@pytest.mark.parametrize("seed", range(4))
@pytest.mark.parametrize(
    ("text", "which"),
    [
        ("the bench with two pots", {"b1"}),
        ("the bench that has exactly two pots on it", {"b1"}),
        ("go to the bench on which there are two pots", {"b1"}),
        ("the bench with the most pots", {"b2"}),
        ("the bench with more than two pots on it", {"b2"}),
        ("the bench with the fewest pots", {"b0"}),
        ("the bench with only one pot", {"b0"}),
        ("both pots on the bench with two pots", {"p10", "p11"}),
        ("the green pot on the bench with three pots", {"p21"}),
    ],
)
def test_a_bench_is_told_by_how_many_are_on_it(text: str, which: set[str], seed: int) -> None:
    assert meant(text, benches(seed)) == which


def line(number: int) -> list[Percept]:
    return [Percept(f"c{k}", "cone", COLORS[k], (3.0, 0.6 * (number - 1) / 2 - 0.6 * k, 0.0)) for k in range(number)]


@pytest.mark.parametrize("mark", [2, 3, 4])
def test_what_is_counted_beside_a_landmark_is_counted_from_it(mark: int) -> None:
    row, named = line(7), COLORS[mark]
    assert meant(f"the second cone left of the {named} one", row) == {f"c{mark - 2}"}
    assert meant(f"the second cone to the right of the {named} cone", row) == {f"c{mark + 2}"}
    assert meant(f"the cone two to the right of the {named} one", row) == {f"c{mark + 2}"}
    assert meant(f"the cones on both sides of the {named} one", row) == {f"c{mark - 1}", f"c{mark + 1}"}
    assert meant(f"the rest of the cones besides the {named} one", row) == {f"c{k}" for k in range(7) if k != mark}


@pytest.mark.parametrize("number", [5, 6, 7])
def test_a_row_across_is_counted_from_the_left(number: int) -> None:
    row = line(number)
    for k, nth in enumerate(("first", "second", "third", "fourth", "fifth")):
        assert meant(f"take the {nth} cone", row) == {f"c{k}"}
    assert meant("the cones between the first and the last", row) == {f"c{k}" for k in range(1, number - 1)}


@pytest.mark.parametrize("number", [4, 5])
def test_all_that_is_over_or_under_a_thing_of_a_stack_is_meant_in_the_plural(number: int) -> None:
    stack = [Percept(f"s{k}", "crate", COLORS[k], (2.5, 0.6, 0.3 * k), (0.3,) * 3) for k in range(number)]
    aside = Percept("a", "crate", "orange", (2.5, -0.9, 0.0), (0.3,) * 3)
    assert meant("all the crates under the blue one", [*stack, aside]) == {"s0", "s1"}
    assert meant("the crates above the green crate", [*stack, aside]) == {f"s{k}" for k in range(2, number)}


@pytest.mark.parametrize("turn", [0.0, 0.7])
def test_opposite_is_across_what_stands_between(turn: float) -> None:
    table = Percept("t", "table", None, (4.0, 0.5, 0.0), (1.2, 1.2, 0.7))
    ways = [turn + k * np.pi / 2 for k in range(4)]
    chairs = [
        Percept(f"c{k}", "chair", c, (4.0 + 1.1 * float(np.cos(w)), 0.5 + 1.1 * float(np.sin(w)), 0.0), (0.4,) * 3)
        for k, (w, c) in enumerate(zip(ways, COLORS, strict=False))
    ]
    for k in range(4):
        for text in (
            f"the chair opposite the {COLORS[k]} one",
            f"the chair across the table from the {COLORS[k]} chair",
        ):
            assert meant(text, [table, *chairs]) == {f"c{(k + 2) % 4}"}, text


def test_neither_the_biggest_nor_the_smallest() -> None:
    tins = [
        Percept(f"t{k}", "tin", None, (2.0, 1.0 - 0.5 * k, 0.0), (s,) * 3) for k, s in enumerate((0.2, 0.5, 0.1, 0.3))
    ]
    assert meant("the tins that are neither the biggest nor the smallest", tins) == {"t0", "t3"}
