"""What is named again is one of those that were told of before. Commands and scenes that we wrote."""

from __future__ import annotations

import random
from collections.abc import Callable

import pytest
from asked import shipped

from dcg_torch.language import default_parser, target_phrase
from dcg_torch.types import Percept, Pose

TOLD = (
    "There are {n} red cones in a row. Take the {pick}.",
    "Do you see the {n} red cones in a line? Take the {pick}.",
    "In the row of {n} red cones, pick up the {pick}.",
)
PICKS: dict[str, Callable[[int], int]] = {
    "leftmost cone": lambda n: n - 1,
    "middle object": lambda n: n // 2,
    "cone in the middle": lambda n: n // 2,
    "cone at the right end": lambda n: 0,
    "second cone from the left": lambda n: n - 2,
}


def _row_and_others(seed: int) -> tuple[int, list[Percept]]:
    """So many red cones side by side, the rightmost first, and red cones far from them on either side and ahead."""
    rng = random.Random(seed)
    n, x, y = rng.choice([3, 5]), rng.uniform(2.0, 4.0), rng.uniform(-1.0, 1.0)
    row = [(x, y + k - n / 2) for k in range(n)]
    spots = [*row, (x, y - 6.0), (x + 1.0, y + 7.0), (x + 5.0, y)]
    return n, [Percept(f"c{k}", "cone", "red", (*spot, 0.0)) for k, spot in enumerate(spots)]


@pytest.mark.parametrize("told", TOLD)
@pytest.mark.parametrize("pick", PICKS)
def test_what_is_named_again_is_one_of_those_told_of(told: str, pick: str) -> None:
    for seed in range(4):
        n, things = _row_and_others(seed)
        world = shipped().world_model(things, robot=Pose(-1.5, 0.0, 0.0))
        answer = shipped().ground(told.format(n={3: "three", 5: "five"}[n], pick=pick), world)
        assert [o.id for o in answer.objects] == [f"c{PICKS[pick](n)}"], seed


@pytest.mark.parametrize(
    "text",
    [
        "There are three red cones. Take the green cone.",  # another colour
        "There are three red cones. Take the leftmost cube.",  # another noun
        "There are three red cones. Take a cone behind the door.",  # nothing is picked
    ],
)
def test_what_is_no_pick_of_them_stays_as_it_is_said(text: str) -> None:
    tree = default_parser().parse(text).tree
    assert tree is not None
    assert not any(word.startswith("of ") for word in target_phrase(tree).phrase.words)


def test_all_of_that_name_may_be_meant_all_the_same() -> None:
    readings = default_parser().parse("There are three red cones. Take the leftmost cone.").readings
    assert {("of 3" in target_phrase(reading.tree).phrase.words) for reading in readings} == {True, False}


@pytest.mark.parametrize(("end", "k"), [("far", 2), ("near", 0), ("back", 2), ("front", 0)])
@pytest.mark.parametrize("said", ["cone", "one"])
def test_a_row_that_leads_away_has_a_near_and_a_far_end(said: str, end: str, k: int) -> None:
    spots = [(2.0, 0.0), (3.0, 0.0), (4.0, 0.0), (3.0, 5.5), (3.0, -5.5), (8.5, 0.0)]
    things = [Percept(f"c{n}", "cone", "red", (*spot, 0.0)) for n, spot in enumerate(spots)]
    world = shipped().world_model(things, robot=Pose(-1.0, 0.0, 0.0))
    answer = shipped().ground(f"There are three red cones in a row. Take the {said} at the {end} end.", world)
    assert [o.id for o in answer.objects] == [f"c{k}"]
