"""What is said not to be meant, and attributes that say among what a thing ranks; with the shipped model."""

import pytest

from dcg_torch import Percept, Pose, pretrained

SOLIDS = [
    ("a", "cube", "metal", "red", 1.0, (4.0, 1.0)),
    ("b", "cube", "rubber", "red", 1.6, (5.0, -1.0)),
    ("c", "cube", "metal", "blue", 0.6, (3.0, -2.0)),
    ("d", "sphere", "metal", "green", 1.3, (6.0, 2.0)),
    ("e", "sphere", "rubber", "green", 0.7, (3.0, 2.0)),
    ("f", "cube", "rubber", "yellow", 0.6, (7.0, 0.0)),
]


@pytest.mark.parametrize(
    ("text", "meant"),
    [
        ("the farthest metal cube", "a"),
        ("the second largest metal object", "a"),
        ("the biggest metal cube", "a"),
        ("the nearest rubber thing", "e"),
        ("the thing that is not a cube and made of rubber", "e"),
        ("the thing made of metal that is not a cube", "d"),
        ("the metal cube that is not red", "c"),
    ],
)
def test_ranks_are_among_what_the_attributes_describe(text: str, meant: str) -> None:
    things = [
        Percept(id_, type_, color, (*at, 0.0), (size,) * 3, attributes=frozenset({f"material: {material}"}))
        for id_, type_, material, color, size, at in SOLIDS
    ]
    model = pretrained()
    answer = model.ground(text, model.world_model(things, Pose(0.0, 0.0), looked=True))
    assert answer.object is not None
    assert answer.object.id == meant
