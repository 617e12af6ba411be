"""What people say to a partner across a table of cubes: ranks on a side, pairs, surroundings. We wrote the commands."""

from __future__ import annotations

import pytest

from dcg_torch import GroundingModel, Percept, Pose, Workspace
from dcg_torch.grounding.solution import Solution

# x is away from the robot, y to its left. Two pairs of green cubes and one between them on the left, two more on the
# right; behind "near right" two orange cubes in a line, and aslant of it a third.
GREEN = {
    **{"pair 1": (0.33, 0.11), "pair 2": (0.36, 0.08), "between": (0.47, 0.10), "pair 3": (0.57, 0.08)},
    **{"pair 4": (0.60, 0.14), "in line": (0.53, 0.00), "right": (0.58, -0.07)},
}
ORANGE = {"first": (0.62, 0.00), "second": (0.72, 0.01), "aslant": (0.64, -0.10)}
YELLOW = {"y1": (0.33, -0.02), "y2": (0.40, 0.02)}
CUBES = [
    Percept(name, "cube", color, (x, y, 0.0))
    for color, of in (("green", GREEN), ("orange", ORANGE), ("yellow", YELLOW))
    for name, (x, y) in of.items()
]
ACROSS = {"robot": Pose(-0.3, 0.0, 0.0), "speaker": Pose(1.3, 0.0, 3.14159)}


def grounded(model: GroundingModel, text: str, things: list[Percept]) -> Solution:
    where = Workspace.of(things)
    return model.ground(text, model.world_model(things, **ACROSS, looked=True, workspace=where))


@pytest.mark.parametrize(
    ("text", "name"),
    [
        # In line with both of two, and the nearest to one of them alone.
        ("pick up the green block directly in front of the two orange blocks", "in line"),
        # On a table what is below a thing is before it, whoever sits round it.
        ("pick up the green block that is directly below two orange blocks", "in line"),
        ("the yellow block just above the other yellow block", "y2"),
        # Between pairs; nothing of a pair is between it and another.
        ("pick up the green block in between two sets of green blocks", "between"),
        ("the green block in the middle of 2 pairs of green blocks", "between"),
        # Ranks on a side count all that is there, not what is farthest to that side.
        ("the green block on your left side that is third closest to you", "between"),
        ("of the green blocks to your far left, the one third closest to you", "between"),
        # An end that is said in another way.
        ("the green block that is second farthest to the right", "in line"),
        ("the green block second from the rightmost green block", "in line"),
        ("the green block second furthermost to the right", "in line"),
        # What is introduced is no landmark, and nobody turns to it.
        ("Look for a green block. Pick up the second green block from the right.", "in line"),
        ("Look at a green block. Pick up the green block that is farthest to the right of you.", "right"),
    ],
)
def test_one_of_many_on_a_table(model: GroundingModel, text: str, name: str) -> None:
    assert [thing.id for thing in grounded(model, text, CUBES).objects] == [name]


@pytest.mark.parametrize("seats", [3, 4, 5])
def test_what_is_surrounded_has_them_on_every_side(model: GroundingModel, seats: int) -> None:
    round_table = [(2.0, 1.5), (2.0, 2.5), (1.5, 2.0), (2.5, 2.0), (1.6, 1.6)][:seats]
    beside = [(2.0, -1.0), (1.9, -1.1), (2.1, -1.1), (2.2, -1.0), (1.8, -1.0)][:seats]
    things = [Percept("round", "table", None, (2.0, 2.0, 0.0)), Percept("other", "table", None, (2.0, -1.4, 0.0))]
    for k, (x, y) in enumerate((*round_table, *beside)):
        things.append(Percept(f"chair {k}", "chair", None, (x, y, 0.0)))
    answer = model.ground(
        f"the table surrounded by {seats} chairs", model.world_model(things, robot=Pose(0.0, 0.0, 0.0))
    )
    assert [thing.id for thing in answer.objects] == ["round"]


@pytest.mark.parametrize(
    "text", ["the cup next to the plate", "take the cup beside the plate", "the cup near the plate"]
)
def test_what_is_next_to_a_thing_is_not_the_farther_one(model: GroundingModel, text: str) -> None:
    """Behind the plate one stands close by, to its left another twice as far off."""
    places = {"plate": (0.6, 0.0), "close by": (0.75, 0.0), "farther": (0.6, 0.32), "apart": (1.0, -0.4)}
    things = [
        Percept(name, "plate" if name == "plate" else "cup", None, (x, y, 0.75), (0.1, 0.1, 0.1))
        for name, (x, y) in places.items()
    ]
    world = model.world_model(things, robot=Pose(0.0, 0.0, 0.0), looked=True, workspace=Workspace.of(things))
    assert [thing.id for thing in model.ground(text, world).objects] == ["close by"]


@pytest.mark.parametrize("text", ["go to the table", "move towards the table", "the table"])
def test_a_table_with_a_lamp_on_it_is_no_covered_one(model: GroundingModel, text: str) -> None:
    things = [
        Percept("lit", "table", None, (2.0, 1.0, 0.4), (1.0, 1.0, 0.8)),
        Percept("bare", "table", None, (2.0, -1.0, 0.4), (1.0, 1.0, 0.8)),
        Percept("lamp", "lamp", None, (2.0, 1.0, 1.0), (0.2, 0.2, 0.4)),
    ]
    answer = model.ground(text, model.world_model(things, robot=Pose(0.0, 0.0, 0.0), looked=True))
    assert answer.probabilities["lit"] == pytest.approx(answer.probabilities["bare"], abs=0.05)


@pytest.mark.parametrize(
    "text",
    [
        "the green block north of the two orange blocks",
        "the yellow block south of two orange blocks",
        "the orange block behind the two orange blocks",
        "the green cube left of the two green cubes",
    ],
)
def test_several_landmarks_leave_a_distribution(model: GroundingModel, text: str) -> None:
    """Also where some are nothing at all to a thing, as what is south of it to what is north."""
    answer = grounded(model, text, CUBES)
    assert sum(answer.probabilities.values()) == pytest.approx(1.0)
    assert answer.probability is not None
    assert 0.0 < answer.probability <= 1.0


@pytest.mark.parametrize("away", [0.2, 0.35, 0.5, 0.55, 0.7, 1.0])
@pytest.mark.parametrize(
    ("side", "x", "y"), [("behind", 1, 0), ("in front of", -1, 0), ("left of", 0, 1), ("right of", 0, -1)]
)
def test_what_is_close_on_a_side_is_not_on_the_spot(
    model: GroundingModel, side: str, x: int, y: int, away: float
) -> None:
    """Things of which no extents are known, on one floor: the near one that is straight on, not the far one aslant."""
    things = [
        Percept("lamp", "lamp", None, (2.0, 0.0, 0.0)),
        Percept("near", "cup", None, (2.0 + away * x, away * y, 0.0)),
        Percept("far", "cup", None, (2.0 + 2.0 * x + 1.5 * y, 2.0 * y - 1.5 * x, 0.0)),
    ]
    answer = model.ground(f"the cup {side} the lamp", model.world_model(things, robot=Pose(0.0, 0.0, 0.0), looked=True))
    assert [thing.id for thing in answer.objects] == ["near"]
