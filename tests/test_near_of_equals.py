"""Of things that are described alike the nearer is likelier, where the robot stands somewhere and no way is told."""

from __future__ import annotations

import pytest
from asked import HERE, grounded, standing

from dcg_torch.types import Pose

CRATES = (("near", "crate", None, 3.0, 0.0), ("far", "crate", None, 9.0, 0.0))
AROUND = (("truck", "truck", None, -5.0, 4.0), ("gate", "gate", None, -4.0, -6.0))
YARD = standing(*CRATES, *AROUND)


def odds(text: str, robot: Pose | None) -> float:
    """How many times likelier the near crate is than the far one."""
    probabilities = grounded(text, YARD, robot, looked=True).probabilities
    return probabilities["near"] / probabilities["far"]


@pytest.mark.parametrize("text", ["lift the crate", "pick up a crate"])
def test_the_nearer_of_equals_is_likelier(text: str) -> None:
    assert odds(text, HERE) > 3.0


def test_nearness_alone_makes_nobody_sure() -> None:
    """One speaker in seven means any of them, so that no more than 93 of 100 mean the nearer of two."""
    assert odds("lift the crate", Pose(2.9, 0.0)) < 0.93 / 0.07


def test_it_is_the_way_there_that_counts() -> None:
    """Of two that are half a metre and a metre off either may be meant: 0.85 * 1 / (1 + e**-0.25) + 0.075 is 0.55."""
    close = standing(("near", "crate", None, 0.5, 0.0), ("far", "crate", None, 1.0, 0.0), *AROUND)
    probabilities = grounded("lift the crate", close, HERE, looked=True).probabilities
    assert probabilities["near"] / probabilities["far"] == pytest.approx(0.553 / 0.447, abs=0.02)


@pytest.mark.parametrize("text", ["lift the crate", "pick up a crate"])
def test_they_are_equal_where_nobody_stands(text: str) -> None:
    assert odds(text, None) == pytest.approx(1.0)


def test_they_are_equal_at_the_same_distance() -> None:
    assert odds("lift the crate", Pose(6.0, 1.0)) == pytest.approx(1.0)


def test_they_are_equal_to_who_is_not_among_the_things() -> None:
    ahead = standing(*CRATES, ("truck", "truck", None, 5.0, 4.0))
    probabilities = grounded("lift the crate", ahead, HERE, looked=True).probabilities
    assert probabilities["near"] == pytest.approx(probabilities["far"])


def test_what_is_near_where_a_way_begins_tells_nothing() -> None:
    assert odds("turn left and lift the crate", HERE) == pytest.approx(1.0)


def test_words_that_tell_them_apart_count_for_more() -> None:
    assert odds("lift the farthest crate", HERE) < 1.0


def test_all_that_is_alike_keeps_its_share() -> None:
    here, nowhere = (grounded("lift the crate", YARD, robot, looked=True).probabilities for robot in (HERE, None))
    assert here["near"] + here["far"] == pytest.approx(nowhere["near"] + nowhere["far"], abs=1e-6)
