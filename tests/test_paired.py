"""One thing that is spoken of in the plural, and the sides of a thing as they are seen."""

from __future__ import annotations

import pytest
from asked import grounded

from dcg_torch.types import Percept, Pose

Three = tuple[float, float, float]


def put(id_: str, type_: str, at: Three, size: Three, color: str | None = None) -> Percept:
    return Percept(id_, type_, color, at, size)


SMALL = (0.1, 0.1, 0.05)
RACK = [  # of each three, from left to right
    *(put(f"tongs{k}", "tongs", (1.0, 0.6 - 0.2 * k, 0.8), SMALL) for k in range(3)),
    *(put(f"shears{k}", "garden_shears", (1.2, 0.7 - 0.3 * k, 0.8), SMALL) for k in range(3)),
    *(put(f"ladle{k}", "ladle", (1.4, 0.5 - 0.2 * k, 0.8), SMALL) for k in range(3)),
]
ROOM = [  # a workbench before the robot, pots on it, stools around it
    put("workbench", "workbench", (3.0, 0.0, 0.4), (1.0, 2.4, 0.8)),
    put("left pot", "pot", (3.1, 0.9, 0.9), (0.2, 0.2, 0.2)),
    put("right pot", "pot", (2.9, -0.8, 0.9), (0.2, 0.2, 0.2)),
    put("far stool", "stool", (4.0, 0.1, 0.25), (0.4, 0.4, 0.5)),
    put("near stool", "stool", (2.0, -0.1, 0.25), (0.4, 0.4, 0.5)),
    put("left stool", "stool", (3.0, 1.7, 0.25), (0.4, 0.4, 0.5)),
    put("door", "door", (6.0, -4.0, 1.0), (0.1, 1.0, 2.0)),
]


def meant(text: str, things: list[Percept], robot: Pose | None) -> tuple[list[str], float]:
    answer = grounded(text, things, robot, looked=True)
    return sorted(o.id for o in answer.objects), answer.probability or 0.0


@pytest.mark.parametrize(
    ("text", "ids"),
    [
        ("the tongs on the left", ["tongs0"]),
        ("the tongs in the middle", ["tongs1"]),
        ("hand me the rightmost pair of shears", ["shears2"]),
        ("the garden shears on the right", ["shears2"]),
        ("all the tongs", ["tongs0", "tongs1", "tongs2"]),
        ("both ladles on the left", ["ladle0", "ladle1"]),
    ],
)
def test_what_is_called_by_a_plural_is_one_thing(text: str, ids: list[str]) -> None:
    assert meant(text, RACK, Pose(0.0, 0.0))[0] == ids


@pytest.mark.parametrize("turned", [0.0, 3.14159])
@pytest.mark.parametrize(
    ("text", "here", "behind"),
    [
        ("the stool on the far side of the workbench", "far stool", "near stool"),
        ("the stool on the near side of the workbench", "near stool", "far stool"),
        ("the stool on the other side of the workbench", "far stool", "near stool"),
        ("the pot on the left side of the workbench", "left pot", "right pot"),
        ("the pot on the right side of the workbench", "right pot", "left pot"),
    ],
)
def test_sides_of_a_thing_are_those_that_the_robot_sees(text: str, here: str, behind: str, turned: float) -> None:
    robot = Pose(0.0, 0.0) if turned == 0.0 else Pose(6.0, 0.0, turned)
    found, probability = meant(text, ROOM, robot)
    assert found == [here if turned == 0.0 else behind]
    assert probability > 0.6
