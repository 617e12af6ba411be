"""What points back to a landmark of the sentence before. We wrote the commands."""

from __future__ import annotations

import pytest

import dcg_torch
from dcg_torch import GroundingModel, Percept, Pose
from dcg_torch.interpretation.anaphora import refer_back

SCENE = [
    Percept("lit", "table", None, (2.0, 1.0, 0.4), (1.0, 1.0, 0.8)),
    Percept("lamp", "lamp", None, (2.0, 1.0, 1.0), (0.2, 0.2, 0.4)),
    Percept("bare", "table", None, (2.0, -1.0, 0.4), (1.0, 1.0, 0.8)),
    Percept("cup", "cup", None, (3.0, 2.0, 0.0), (0.1, 0.1, 0.1)),
    Percept("by the cup", "plate", None, (3.0, 2.3, 0.0), (0.2, 0.2, 0.1)),
    Percept("alone", "plate", None, (3.0, -2.0, 0.0), (0.2, 0.2, 0.1)),
]


@pytest.mark.parametrize(
    ("text", "id_"),
    [
        ("There is a lamp on a table. Go to that table.", "lit"),
        ("There is a cup next to a plate. Take that plate.", "by the cup"),
        ("Do you see the lamp on the table? I want that table.", "lit"),
        ("Go to that table.", None),  # which one nobody has said
    ],
)
def test_a_landmark_that_is_pointed_back_to(model: GroundingModel, text: str, id_: str | None) -> None:
    answer = model.ground(text, model.world_model(SCENE, robot=Pose(0.0, 0.0, 0.0), looked=True))
    if id_ is None:
        assert abs(answer.probabilities["lit"] - answer.probabilities["bare"]) < 0.1
    else:
        assert [thing.id for thing in answer.objects] == [id_]
        assert answer.probabilities[id_] > 0.6


def test_what_points_to_nothing_stays() -> None:
    trees = [reading.tree for reading in dcg_torch.parse("go to that table").readings]
    assert refer_back(trees, trees) == trees
