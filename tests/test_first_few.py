"""The first few along a line: "the two nearest in the column", "the last two of the row". Written for this project."""

from __future__ import annotations

import numpy as np
import pytest
from asked import meant

from dcg_torch.types import Percept

COUNTS = {2: "two", 3: "three"}


def strewn(seed: int) -> tuple[list[Percept], list[int], list[int]]:
    """Six crates strewn about; their numbers from the nearest on, and from the left."""
    rng = np.random.default_rng(seed)
    far, left = 2.0 + 0.8 * rng.permutation(6), 2.5 - 1.0 * rng.permutation(6)
    away = np.sqrt(far**2 - (0.3 * left) ** 2)  # so that who is aside is not much farther
    things = [Percept(f"c{k}", "crate", None, (float(away[k]), float(0.3 * left[k]), 0.0)) for k in range(6)]
    return things, np.argsort(far).tolist(), np.argsort(-left).tolist()


@pytest.mark.parametrize("seed", range(4))
@pytest.mark.parametrize("count", COUNTS)
def test_the_first_few_are_told_by_their_places(seed: int, count: int) -> None:
    things, near, left = strewn(seed)
    said = COUNTS[count]
    first, last = ({f"c{k}" for k in order} for order in (near[:count], near[-count:]))
    for text in (f"the {said} nearest crates", f"take the closest {said} crates", f"the {said} closest"):
        assert meant(text, things) == first, text
    assert meant(f"the {said} farthest crates", things) == last
    first, last = ({f"c{k}" for k in order} for order in (left[:count], left[-count:]))
    for text in (f"the {said} leftmost crates", f"the first {said} crates from the left"):
        assert meant(text, things) == first, text
    for text in (f"the rightmost {said} crates", f"the last {said} crates from the left"):
        assert meant(text, things) == last, text
    assert meant(f"all but the {said} nearest crates", things) == {f"c{k}" for k in near[count:]}


@pytest.mark.parametrize("rows", [3, 4])
@pytest.mark.parametrize(("column", "at"), [("left", 0), ("second", 1), ("rightmost", 3)])
def test_in_a_column_only_what_is_in_it_is_ranked(rows: int, column: str, at: int) -> None:
    things = [
        Percept(f"{r}{c}", "barrel", None, (2.0 + 1.1 * r, 1.5 - 1.0 * c, 0.0)) for r in range(rows) for c in range(4)
    ]
    assert meant(f"the two nearest barrels in the {column} column", things) == {f"0{at}", f"1{at}"}
    assert meant(f"the two farthest barrels in the {column} column", things) == {f"{rows - 2}{at}", f"{rows - 1}{at}"}
    assert meant(f"the two barrels nearest the robot in the {column} column", things) == {f"0{at}", f"1{at}"}


@pytest.mark.parametrize("seed", range(4))
@pytest.mark.parametrize("count", COUNTS)
def test_the_few_closest_to_a_thing_are_told_by_their_distance(seed: int, count: int) -> None:
    things, _, _ = strewn(seed)
    gate = Percept("gate", "gate", None, (12.0, 0.0, 0.0))
    away = sorted(things, key=lambda o: np.hypot(o.position[0] - 12.0, o.position[1]))
    said = COUNTS[count]
    assert meant(f"the {said} crates closest to the gate", [*things, gate]) == {o.id for o in away[:count]}
    assert meant(f"the {said} crates farthest from the gate", [*things, gate]) == {o.id for o in away[-count:]}


@pytest.mark.parametrize("number", [4, 5, 7])
def test_a_row_begins_at_its_left_end_and_a_queue_at_its_nearest(number: int) -> None:
    across = [Percept(f"c{k}", "cone", None, (3.0, 0.5 * (number - 1) - k, 0.0)) for k in range(number)]
    queue = [Percept(f"c{k}", "cone", None, (2.0 + k, 0.4, 0.0)) for k in range(number)]
    for things in (across, queue):
        for text in ("the first two cones", "the first two of the row"):
            assert meant(text, things) == {"c0", "c1"}, text
        for text in ("the last two cones", "take the last two"):
            assert meant(text, things) == {f"c{number - 2}", f"c{number - 1}"}, text
