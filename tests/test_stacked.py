"""What lies over, under and between the things of a stack; the ends of a row. Written for this project."""

from __future__ import annotations

import numpy as np
import pytest
from asked import meant

from dcg_torch.types import Percept

COLORS = ("red", "green", "blue", "yellow", "white")


def stack(seed: int, noun: str, step: float) -> tuple[list[Percept], list[str]]:
    """Five things on one another, the lowest first, with a colour each, and two aside; the colours of the stack."""
    rng = np.random.default_rng(seed)
    colors = [str(c) for c in rng.permutation(COLORS)]
    things = [Percept(f"s{k}", noun, c, (2.0, 0.5, step * k), (step,) * 3) for k, c in enumerate(colors)]
    aside = [Percept(f"a{k}", noun, "black", (2.0, -0.6, step * k), (step,) * 3) for k in range(2)]
    return [*things, *aside], colors


@pytest.mark.parametrize("seed", range(5))
@pytest.mark.parametrize(("noun", "step"), [("box", 0.12), ("crate", 0.4), ("book", 0.05)])
def test_what_is_straight_over_or_under_a_thing_is_the_next_one(seed: int, noun: str, step: float) -> None:
    things, colors = stack(seed, noun, step)
    for k in range(1, 4):
        for over in ("on top of", "above", "over", "on", "directly on top of"):
            assert meant(f"the {noun} {over} the {colors[k]} {noun}", things) == {f"s{k + 1}"}, over
        for under in ("under", "below", "beneath"):
            assert meant(f"the {noun} {under} the {colors[k]} {noun}", things) == {f"s{k - 1}"}, under


@pytest.mark.parametrize("seed", range(5))
def test_what_is_between_two_things_of_a_stack_lies_on_one_and_under_the_other(seed: int) -> None:
    things, colors = stack(seed, "tin", 0.12)
    for k in range(3):
        low, high = f"the {colors[k]} tin", f"the {colors[k + 2]} tin"
        assert meant(f"take the tin between {low} and {high}", things) == {f"s{k + 1}"}
        assert meant(f"take the tin between {high} and {low}", things) == {f"s{k + 1}"}


@pytest.mark.parametrize("count", [4, 5, 6])
@pytest.mark.parametrize("at", ["at", "on"])
def test_an_end_of_all_that_is_there_has_the_outermost(count: int, at: str) -> None:
    """Where nobody says whose end it is."""
    row = [Percept(f"r{k}", "lamp", None, (2.0, 0.4 * (count - 1) / 2 - 0.4 * k, 0.0)) for k in range(count)]
    assert meant(f"the lamp {at} the left end", row) == {"r0"}
    assert meant(f"take the lamp {at} the right-hand end", row) == {f"r{count - 1}"}
