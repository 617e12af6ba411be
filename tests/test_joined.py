"""Noun phrases that a command joins: several things, one of several, each that is picked. Scenes and texts are ours."""

from __future__ import annotations

import pytest
from asked import grounded, seen

from dcg_torch.interpretation.factor_tree import coordinated
from dcg_torch.language import parse_command, target_phrase
from dcg_torch.types import Percept

KITCHEN = (  # id, class, x, y
    ("by the pan", "jug", 2.0, 1.6),
    ("by the tin", "jug", 3.0, -1.5),
    ("alone", "jug", 5.0, 0.2),
    ("pan", "pan", 2.0, 1.9),
    ("tin", "tin", 3.0, -1.8),
)
LINE = tuple((str(k), "cone", 3.0, 2.0 - k) for k in range(5))


def _meant(text: str, things: tuple[tuple[str, str, float, float], ...]) -> tuple[set[str], float | None]:
    solution = grounded(text, [Percept(id_, kind, None, (x, y, 0.0)) for id_, kind, x, y in things], looked=True)
    return seen(solution), solution.probability


@pytest.mark.parametrize(
    ("text", "meant"),
    [
        ("the jug next to the pan and the jug next to the tin", {"by the pan", "by the tin"}),
        ("take the jug by the pan and the one by the tin", {"by the pan", "by the tin"}),
        ("go to the jug beside the pan and the jug beside the tin", {"by the pan", "by the tin"}),
        ("the jug near the pan and the tin", None),  # the tin is a landmark, or meant itself: but no second jug
    ],
)
def test_the_same_again_beside_another_landmark(text: str, meant: set[str] | None) -> None:
    found, _ = _meant(text, KITCHEN)
    assert found == meant if meant is not None else "by the tin" not in found


def test_between_keeps_both_its_landmarks() -> None:
    (whole,) = coordinated(parse_command("the jug between the pan and the jug next to the tin").readings[0].tree)
    assert len(target_phrase(whole).children[0].children) == 2


@pytest.mark.parametrize(
    ("text", "meant"),
    [
        ("the leftmost and the rightmost cone", {"0", "4"}),
        ("take the leftmost and rightmost cones", {"0", "4"}),
        ("the first and the third cone from the left", {"0", "2"}),
        ("the first and the last cone from the right", {"0", "4"}),
        ("the second and the third cone from the right", {"2", "3"}),
    ],
)
def test_each_that_is_picked(text: str, meant: set[str]) -> None:
    assert _meant(text, LINE)[0] == meant


@pytest.mark.parametrize(
    "text", ["the pan or the tin", "bring me the pan or the tin", "either the pan or the tin", "go to a pan or a tin"]
)
def test_one_of_two_whichever_and_unsure(text: str) -> None:
    found, probability = _meant(text, KITCHEN)
    assert len(found) == 1
    assert found <= {"pan", "tin"}
    assert probability is not None
    assert 0.3 < probability < 0.7


def test_of_two_the_one_that_is_there() -> None:
    found, probability = _meant("take the ladder or the tin", KITCHEN)
    assert found == {"tin"}
    assert probability is not None
    assert probability > 0.8
