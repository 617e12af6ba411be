"""What is like another thing: its colour, its size, its shape, its material. Commands that we wrote."""

from __future__ import annotations

import math

import pytest
from asked import shipped

from dcg_torch.interpretation.sameness import SAME_AS, log_same
from dcg_torch.language import default_parser
from dcg_torch.types import Object, Percept, Pose

THINGS = (
    ("sphere", "red", 0.2, "metal"),
    ("sphere", "blue", 0.1, "rubber"),
    ("cube", "green", 0.2, "rubber"),
    ("cube", "blue", 0.1, "metal"),
    ("cylinder", "red", 0.1, "metal"),
    ("cylinder", "yellow", 0.205, "rubber"),
)


@pytest.mark.parametrize(
    ("text", "number"),
    [
        ("the cylinder of the same colour as the red sphere", "4"),
        ("the sphere that has the same color as the blue cube", "1"),
        ("the cube with the same size as the red sphere", "2"),
        ("the sphere made of the same material as the green cube", "1"),
        ("the cylinder that is made of the same material as the green cube", "5"),
        ("the blue thing which is the same shape as the green cube", "3"),
        ("the ball that shares the same colour as the red cylinder", "0"),
        ("take the sphere that is not the same colour as the blue cube", "0"),
    ],
)
def test_what_is_like_a_landmark(text: str, number: str) -> None:
    percepts = [
        Percept(
            str(k), type_, color, (1.0 + 0.2 * k, 0.6 - 0.25 * k, size / 2), (size,) * 3, frozenset({f"material: {m}"})
        )
        for k, (type_, color, size, m) in enumerate(THINGS)
    ]
    world = shipped().world_model(percepts, Pose(0.0, 0.0), looked=True)
    found = shipped().ground(default_parser().parse(text), world).object
    assert found is not None
    assert found.id == number


def _thing(id_: str, *, color: str | None = None, rgb: tuple[float, float, float] | None = None) -> Object:
    return Object(id_, "dot", known=False, color=color, rgb=rgb)


def test_names_of_one_color_and_looks_that_are_alike() -> None:
    gray, grey, other = _thing("a", color="gray"), _thing("b", color="Grey"), _thing("c", color="green")
    dark, darker, light = (_thing(f"{v}", rgb=(v, v, v)) for v in (20.0, 30.0, 200.0))
    assert log_same("same color as", [gray, grey, other], [(0,)], denied=False)[0].argmax() == 1
    assert log_same("same color as", [dark, darker, light], [(0,)], denied=False)[0].argmax() == 1


@pytest.mark.parametrize("name", sorted(SAME_AS))
def test_of_what_nothing_is_known_either_may_be(name: str) -> None:
    things = [Object(i, None, known=False) for i in "ab"]
    (found,) = log_same(name, things, [(0,)], denied=False)
    assert found[1] == pytest.approx(math.log(0.5))


def test_nothing_is_like_itself() -> None:
    things = [_thing("a", color="red"), _thing("b", color="red")]
    (found,) = log_same("same color as", things, [(0,)], denied=False)
    assert found[0] < math.log(0.1) < found[1]
    (denied,) = log_same("same color as", things, [(0,)], denied=True)
    assert denied[1] < math.log(0.1)
