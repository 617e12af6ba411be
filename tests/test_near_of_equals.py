"""Of things that are described alike the nearer is likelier, where the robot stands somewhere and no way is told."""

from __future__ import annotations

import pytest
from asked import HERE, grounded, standing

from dcg_torch.types import Pose

CRATES = (("near", "crate", None, 3.0, 0.0), ("far", "crate", None, 9.0, 0.0))
YARD = standing(*CRATES, ("truck", "truck", None, -5.0, 4.0), ("gate", "gate", None, -4.0, -6.0))


def odds(text: str, robot: Pose | None) -> float:
    """How many times likelier the near crate is than the far one."""
    probabilities = grounded(text, YARD, robot, looked=True).probabilities
    return probabilities["near"] / probabilities["far"]


@pytest.mark.parametrize("text", ["lift the crate", "pick up a crate"])
def test_the_nearer_of_equals_is_likelier(text: str) -> None:
    assert odds(text, HERE) > 3.0


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
