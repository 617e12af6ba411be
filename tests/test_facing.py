"""One of several things that are faced, in a room where nobody knows who stands where."""

from __future__ import annotations

import pytest
from seen_whole import meant, thing

from dcg_torch.grounding.frames import faced
from dcg_torch.grounding.solution import Solution
from dcg_torch.language import parse_command
from dcg_torch.types import ParseTree, Pose, WorldModel

WALLS = {"north": 5.95, "south": 0.05}


@pytest.mark.parametrize(("wall", "right"), [("north", "east"), ("south", "west")])
def test_sides_of_those_that_are_faced(wall: str, right: str) -> None:
    """North is y, east is x: who faces the wall in the north has the east on the right."""
    room = [
        thing("west", "window", 1.5, WALLS[wall], z=1.5, size=(1.2, 0.1, 1.2)),
        thing("east", "window", 5.5, WALLS[wall], z=1.5, size=(1.2, 0.1, 1.2)),
        thing("table", "table", 2.0, 3.0, z=0.4, size=(1.2, 0.8, 0.8)),
        thing("couch", "couch", 5.0, 2.8, z=0.4, size=(0.9, 1.9, 0.8)),
        thing("lamp", "lamp", 0.6, 3.2, z=0.7, size=(0.4, 0.4, 1.4)),
    ]
    left = "west" if right == "east" else "east"
    assert meant("facing the windows, it is the one on the right", room, robot=None) == [right]
    assert meant("facing the windows, it's the one on the left", room, robot=None) == [left]
    assert meant("facing the windows, the window on the right", room, robot=None) == [right]


def test_nothing_is_grounded_for_the_sides_of_a_robot_whose_place_is_known() -> None:
    """Its left is known; where nobody knows where it is, it is first asked which windows one would stand before."""
    tree, asked = parse_command("the left window").tree, list[ParseTree]()
    assert tree is not None

    def solve(bare: ParseTree) -> Solution:
        asked.append(bare)
        return Solution(bare, WorldModel(()))

    assert faced(tree, WorldModel((), robot=Pose(0.0, 0.0)), solve) is None
    assert not asked
    assert faced(tree, WorldModel(()), solve) is None
    assert len(asked) == 1
