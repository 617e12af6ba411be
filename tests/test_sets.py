"""What is left out of a set, how many of it are meant, and which level of a stack. We wrote the commands."""

from __future__ import annotations

import pytest

from dcg_torch import GroundingModel, Percept, Pose
from dcg_torch.grounding.solution import Solution

TABLE = [
    Percept("table", "table", "brown", (2.0, 0.0, 0.4), (1.0, 1.0, 0.8)),
    Percept("red", "block", "red", (1.8, 0.2, 0.85), (0.1, 0.1, 0.1)),
    Percept("blue", "block", "blue", (2.1, -0.2, 0.85), (0.1, 0.1, 0.1)),
    Percept("green", "block", "green", (1.0, 1.2, 0.05), (0.1, 0.1, 0.1)),
    Percept("yellow", "block", "yellow", (1.0, -1.2, 0.05), (0.1, 0.1, 0.1)),
]
CUPS = [
    Percept("fork", "fork", "silver", (2.0, 1.2, 0.0), (0.1, 0.1, 0.1)),
    Percept("left", "cup", "white", (2.0, 0.6, 0.0), (0.1, 0.1, 0.1)),
    Percept("middle", "cup", "blue", (2.2, 0.0, 0.0), (0.1, 0.1, 0.1)),
    Percept("right", "cup", "red", (1.9, -0.6, 0.0), (0.1, 0.1, 0.1)),
]
CUBES = [
    Percept(str(i), "cube", color, (2.0, 1.5 - 0.6 * i, 0.0), (0.1, 0.1, 0.1))
    for i, color in enumerate(["red", "blue", "green", "yellow", "red", "blue"])
]
STACK = [
    *(
        Percept(str(i), "block", color, (2.0, 0.0, 0.1 * i - 0.05), (0.1, 0.1, 0.1))
        for i, color in enumerate(["red", "blue", "green", "yellow"], 1)
    ),
    Percept("apart", "block", "purple", (2.0, 1.5, 0.05), (0.1, 0.1, 0.1)),
]


def grounded(model: GroundingModel, text: str, things: list[Percept]) -> Solution:
    return model.ground(text, model.world_model(things, robot=Pose(0.0, 0.0, 0.0)))


def meant(model: GroundingModel, text: str, things: list[Percept]) -> set[str]:
    return {thing.id for thing in grounded(model, text, things).objects}


@pytest.mark.parametrize(
    ("text", "things", "ids"),
    [
        ("take everything but the fork", CUPS, "left middle right"),
        ("all cups but the white one", CUPS, "middle right"),
        ("every cup apart from the blue one", CUPS, "left right"),
        ("take the cups except for the one on the left", CUPS, "middle right"),
        ("anything other than a cup", CUPS, "fork"),
        ("everything except the cups", CUPS, "fork"),
        ("all the blocks excluding those on the table", TABLE, "green yellow"),
        ("everything on the table but the red block", TABLE, "blue"),
        ("every block but the ones on the floor", TABLE, "red blue"),
        ("every block not on the table", TABLE, "green yellow"),
        ("everything except the fork, the white cup and the red cup", CUPS, "middle"),
        ("all the cups but the white and the blue one", CUPS, "right"),
        ("every cup apart from the leftmost", CUPS, "middle right"),
        ("nothing but the fork", CUPS, "fork"),
    ],
)
def test_what_is_left_out_is_not_meant_and_all_else_is(
    model: GroundingModel, text: str, things: list[Percept], ids: str
) -> None:
    assert meant(model, text, things) == set(ids.split())


@pytest.mark.parametrize(
    ("text", "number"),
    [
        ("take all but one of the cubes", 5),
        ("all but two of the cubes", 4),
        ("take half of the cubes", 3),
        ("a few of the cubes", 3),
        ("a couple of the cubes", 2),
        ("one of the cubes", 1),
    ],
)
def test_so_many_are_meant_and_whichever_they_are_it_is_certain(model: GroundingModel, text: str, number: int) -> None:
    solution = grounded(model, text, CUBES)
    assert len(solution.objects) == number
    assert (solution.probability or 0.0) > 0.9


@pytest.mark.parametrize("text", ["take the eight cubes", "the three red cubes", "seven cubes"])
def test_more_than_there_are_is_no_certainty(model: GroundingModel, text: str) -> None:
    solution = grounded(model, text, CUBES)
    assert (solution.probability or 0.0) < 0.5
    assert not any(thing.hypothetical for thing in solution.objects)


@pytest.mark.parametrize("text", ["take zero cubes", "take none of the cubes", "neither of the red cubes"])
def test_none_is_no_order(model: GroundingModel, text: str) -> None:
    solution = grounded(model, text, CUBES)
    assert solution.objects == ()
    assert solution.problem == "it asks for none of them"


def test_none_of_some_leaves_the_others(model: GroundingModel) -> None:
    assert meant(model, "take no red cube, take the green cube", CUBES) == {"2"}


@pytest.mark.parametrize(
    ("text", "id_"),
    [
        ("the lowest one of the stack", "1"),
        ("take the bottom one in the tower", "1"),
        ("the base of the tower", "1"),
        ("the block at the bottom of the stack", "1"),
        ("the second block from the bottom of the stack", "2"),
        ("the third from the top of the stack", "2"),
        ("the second from the top", "3"),
        ("the top of the tower", "4"),
        ("the block under all the others", "1"),
    ],
)
def test_levels_are_counted_from_both_ends_of_a_stack(model: GroundingModel, text: str, id_: str) -> None:
    assert meant(model, text, STACK) == {id_}


@pytest.mark.parametrize(
    ("text", "id_"),
    [
        ("There is a fork and a red cup. Take the former.", "fork"),
        ("There is a fork and a red cup. Take the latter.", "right"),
        ("I see a white cup, a fork and a blue cup. Bring me the last one I mentioned.", "middle"),
        ("look at the red cup and the fork, then go to the first one I mentioned", "right"),
        ("take neither the red nor the white cup but the blue one", "middle"),
        ("a cup, neither the red nor the blue one", "left"),
    ],
)
def test_what_was_named_before_is_meant_by_its_place_in_what_was_said(
    model: GroundingModel, text: str, id_: str
) -> None:
    assert meant(model, text, CUPS) == {id_}
