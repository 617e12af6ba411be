"""What is said not to be meant; attributes and sizes say among what a thing ranks; with the shipped model."""

import pytest
from asked import grounded

from dcg_torch import Percept

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
    answer = grounded(text, things, looked=True)
    assert answer.object is not None
    assert answer.object.id == meant


def _disc(id_: str, at: tuple[float, float], size: float, color: str) -> Percept:
    return Percept(id_, "circle", color, (2.0, *at), (0.0, size, size))


DISCS = [
    _disc("a", (1.5, 0.4), 0.22, "black"),
    _disc("b", (1.2, 0.9), 0.10, "black"),
    _disc("c", (0.2, 1.6), 0.10, "white"),
    _disc("d", (-0.1, 1.2), 0.22, "gray"),
    _disc("e", (-0.6, -1.1), 0.14, "black"),
    _disc("f", (-1.1, 0.3), 0.22, "white"),
    _disc("g", (-1.3, 0.1), 0.08, "gray"),
    _disc("h", (-0.9, -1.4), 0.22, "white"),
]


@pytest.mark.parametrize(
    ("text", "meant"),
    [
        ("the upper large white one", "f"),
        ("the lower of the two big white ones", "h"),
        ("the lowest black circle", "e"),
        ("the leftmost small circle", "b"),
        ("the lowest circle", "h"),
        ("the highest circle", "c"),
    ],
)
def test_places_pick_among_things_of_a_size(text: str, meant: str) -> None:
    answer = grounded(text, DISCS, looked=True)
    assert answer.object is not None
    assert answer.object.id == meant


def test_of_things_that_are_as_good_as_equal_the_nearest_is_meant() -> None:
    boxes = [
        Percept(f"{k}", "box", None, (x, y, 0.0)) for k, (x, y) in enumerate([(6.0, 1.0), (2.0, -1.0), (4.0, 2.0)])
    ]
    for things in (boxes, boxes[::-1]):
        answer = grounded("pick up a box", things, looked=True)
        assert answer.object is not None
        assert answer.object.id == "1"
        assert answer.probability == pytest.approx(1 / 3, abs=0.02)
