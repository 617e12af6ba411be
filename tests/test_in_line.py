"""Ordinals that count from nowhere follow the line in which things stand; those with a landmark count away from it."""

from __future__ import annotations

import asked
import pytest
from hypothesis import given
from hypothesis import strategies as st
from making import percept

from dcg_torch.types import Percept, Pose

ORDINALS = ("first", "second", "third", "fourth", "fifth", "sixth", "seventh")
NUMBERS = ("one", "two", "three", "four", "five", "six", "seven")


def meant(text: str, things: list[Percept], robot: Pose | None) -> list[str]:
    """The ids of what a command means, for who has looked all round."""
    return sorted(asked.meant(text, things, robot, looked=True))


def side_by_side(number: int, gap: float = 0.7, kind: str = "grey bucket") -> list[Percept]:
    """From the left, across the way that the robot looks."""
    return [percept(kind, (2.5, gap * ((number - 1) / 2 - k)), name=str(k)) for k in range(number)]


def receding(number: int) -> list[Percept]:
    return [percept("white gate", (1.5 + 1.4 * k, -0.8), name=str(k)) for k in range(number)]


HERE = Pose(0.0, 0.0, 0.0)


@given(number=st.integers(3, 7), k=st.integers(0, 6), y=st.floats(-1.5, 1.5))
def test_what_stands_side_by_side_is_counted_from_the_left(number: int, k: int, y: float) -> None:
    if k < number:
        assert meant(f"take the {ORDINALS[k]} bucket", side_by_side(number), Pose(0.0, y, 0.0)) == [str(k)]


@given(number=st.integers(3, 6), k=st.integers(0, 5))
def test_a_queue_is_counted_from_its_near_end(number: int, k: int) -> None:
    if k < number:
        assert meant(f"go to the {ORDINALS[k]} gate", receding(number), HERE) == [str(k)]


@pytest.mark.parametrize("things", [side_by_side(5), receding(5)])
@pytest.mark.parametrize(
    ("words", "expected"),
    [("last {}", "4"), ("second to last {}", "3"), ("next to last {}", "3"), ("third last {}", "2")],
)
def test_the_last_are_counted_from_the_other_end(things: list[Percept], words: str, expected: str) -> None:
    assert meant(f"go to the {words.format(things[0].type)}", things, HERE) == [expected]


@pytest.mark.parametrize("things", [side_by_side(6), receding(6)])
@pytest.mark.parametrize(("words", "expected"), [("first two", "01"), ("last three", "345"), ("last two", "45")])
def test_a_count_takes_as_many(things: list[Percept], words: str, expected: str) -> None:
    assert meant(f"go to the {words} {things[0].type}s", things, HERE) == list(expected)


@pytest.mark.parametrize("k", range(1, 6))
@pytest.mark.parametrize("words", ["bucket number {name}", "bucket number {digit}", "bucket {digit}"])
def test_a_number_is_an_ordinal(k: int, words: str) -> None:
    said = words.format(name=NUMBERS[k], digit=k + 1)
    assert meant(f"take {said}", side_by_side(6), HERE) == [str(k)]


def test_a_number_that_something_bears_is_its_own() -> None:
    things = [
        Percept(str(k), "bucket", None, (2.5, 1.4 - 0.7 * k, 0.0), attributes=frozenset({f"number: {5 - k}"}))
        for k in range(5)
    ]
    assert meant("take bucket 4", things, HERE) == ["1"]


def test_what_is_of_another_colour_is_not_counted() -> None:
    colors = ("red", "blue", "red", "green", "blue", "red")
    things = [percept(f"{color} bucket", (2.5, 1.75 - 0.7 * k), name=str(k)) for k, color in enumerate(colors)]
    assert meant("take the last blue bucket", things, HERE) == ["4"]
    assert meant("take the second red bucket", things, HERE) == ["2"]
    assert meant("take the third bucket", things, HERE) == ["2"]


@pytest.mark.parametrize("side", ["left", "right"])
@pytest.mark.parametrize("to", ["to the {} of", "{} of"])
@pytest.mark.parametrize("k", range(3))
def test_with_a_landmark_they_count_away_from_it(side: str, to: str, k: int) -> None:
    sign = 1.0 if side == "left" else -1.0
    things = [percept("grey oven", (2.5, 0.1), name="oven")]
    for s in (1.0, -1.0):
        things += [
            percept("white locker", (2.5, 0.1 + s * 0.6 * (n + 1)), name=f"{s * sign:+.0f}{n}") for n in range(3)
        ]
    assert meant(f"open the {ORDINALS[k]} locker {to.format(side)} the oven", things, HERE) == [f"+1{k}"]
