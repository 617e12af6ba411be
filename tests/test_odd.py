"""The odd one out, and what has nothing beside it. Written for this project."""

from __future__ import annotations

import numpy as np
import pytest
from asked import meant

from dcg_torch.types import Percept

ODD = ("the odd one out", "take the one that is different from the others", "the one that doesn't match the others")


def strewn(seed: int, number: int) -> list[tuple[float, float, float]]:
    rng = np.random.default_rng(seed)
    return [(2.0 + float(rng.uniform(0.0, 0.5)), 0.6 * k - 1.2, 0.0) for k in rng.permutation(number)]


@pytest.mark.parametrize("seed", range(4))
@pytest.mark.parametrize("text", ODD)
@pytest.mark.parametrize("by", ["color", "class", "size", "mark"])
def test_the_odd_one_differs_from_all_others_by_one_thing(seed: int, text: str, by: str) -> None:
    at = strewn(seed, 5)
    things = [
        Percept(
            f"c{k}",
            "pot" if by == "class" and k == 2 else "cone",
            "red" if by == "color" and k == 2 else "white",
            place,
            (0.5 if by == "size" and k == 2 else 0.2,) * 3,
            frozenset({f"state: {'lit' if k == 2 else 'out'}"}) if by == "mark" else frozenset(),
        )
        for k, place in enumerate(at)
    ]
    assert meant(text, things) == {"c2"}


@pytest.mark.parametrize("seed", range(3))
def test_the_odd_one_of_a_kind_is_sought_among_that_kind(seed: int) -> None:
    colors = ("blue", "blue", "green", "blue", "blue")
    cones = [Percept(f"c{k}", "cone", c, at) for k, (c, at) in enumerate(zip(colors, strewn(seed, 5), strict=True))]
    pot = Percept("pot", "pot", "red", (3.4, 0.0, 0.0))
    assert meant("the odd cone out", [*cones, pot]) == {"c2"}
    assert meant("the cone that has a different color", [*cones, pot]) == {"c2"}


@pytest.mark.parametrize("noun", ["tin", "jar"])
def test_what_touches_nothing_and_what_has_nothing_around_it(noun: str) -> None:
    size = (0.2, 0.2, 0.2)
    at = {"a": (2.0, 1.0), "b": (2.0, 0.8), "c": (2.0, 0.4), "d": (2.2, -1.6)}
    things = [Percept(i, noun, None, (*p, 0.0), size) for i, p in at.items()]
    for text in (
        f"the {noun}s that are not touching anything",
        f"the {noun}s touching nothing",
        f"the two {noun}s not touching any other {noun}",
    ):
        assert meant(text, things) == {"c", "d"}, text
    for text in (f"the {noun} with nothing around it", f"take the {noun} that has nothing next to it"):
        assert meant(text, things) == {"d"}, text


def test_what_a_thing_stands_on_is_not_beside_it() -> None:
    table = Percept("t", "table", None, (3.0, 0.0, 0.0), (1.0, 3.0, 0.7))
    size = (0.1, 0.1, 0.1)
    pots = [Percept(f"p{k}", "pot", None, (3.0, y, 0.7), size) for k, y in enumerate((1.0, -0.9, -1.2))]
    assert meant("the pot with nothing near it", [table, *pots]) == {"p0"}
    assert meant("the pot that is next to no pot", [table, *pots]) == {"p0"}


def test_no_other_of_a_kind_is_near() -> None:
    size = (0.2, 0.2, 0.2)
    jars = [Percept(f"j{k}", "jar", None, (2.0, y, 0.0), size) for k, y in enumerate((1.0, 0.8, -1.0))]
    cup = Percept("c", "cup", None, (2.0, -1.2, 0.0), size)
    assert meant("the jar not touching any other jar", [*jars, cup]) == {"j2"}
    assert meant("the jar that is next to no cup and next to the left jar", [*jars, cup]) == {"j1"}
