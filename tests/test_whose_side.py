"""Whose side of a thing is meant where speaker and robot stand on two sides of it."""

from __future__ import annotations

import pytest

from dcg_torch.model.pretrain import pretrained
from dcg_torch.types import Percept, Pose

_SMALL = (0.1, 0.1, 0.2)
THINGS = [  # the robot west of the bench, the speaker east of it; jars on all four sides
    Percept("bench", "bench", None, (0.0, 4.0, 0.0), (0.6, 0.6, 0.8)),
    Percept("by robot", "jar", None, (-1.4, 4.0, 0.0), _SMALL),
    Percept("by speaker", "jar", None, (1.4, 4.0, 0.0), _SMALL),
    Percept("robot's left", "jar", None, (0.0, 5.4, 0.0), _SMALL),
    Percept("robot's right", "jar", None, (0.0, 2.6, 0.0), _SMALL),
]


@pytest.mark.parametrize(
    ("text", "id_"),
    [
        ("the jar on my side of the bench", "by speaker"),
        ("take the jar on your side of the bench", "by robot"),
        ("the jar on the other side of the bench from me", "by robot"),
        ("the jar on the far side of the bench from you", "by speaker"),
        ("the jar behind the bench as I see it", "by robot"),
        ("from where I stand, the jar to the left of the bench", "robot's right"),
        ("the jar to the left of the bench from where you stand", "robot's left"),
    ],
)
def test_the_side_of_somebody_is_where_they_are(text: str, id_: str) -> None:
    model = pretrained()
    world = model.world_model(THINGS, Pose(-4.0, 4.0, 0.0), Pose(4.0, 4.1, 3.1))
    assert [o.id for o in model.ground(text, world).objects] == [id_]
