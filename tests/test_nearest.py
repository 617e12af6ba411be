"""Landmarks of which there are several, and places of a scene without a workspace. Scenes that we wrote."""

from __future__ import annotations

import math
import random
from collections.abc import Callable, Sequence

import pytest
from asked import grounded, shipped

from dcg_torch.scene.workspace import Workspace
from dcg_torch.types import Percept, Pose

Point = tuple[float, float]
Measure = Callable[[Point, Sequence[Point]], float]


def _scene(seed: int, measure: Measure, margin: float) -> tuple[str, list[Percept]]:
    """Six mugs and two lamps by chance; the mug of the least measure, by a margin to the second."""
    rng = random.Random(seed)
    while True:
        points = [(rng.uniform(1.0, 6.0), rng.uniform(-3.0, 3.0)) for _ in range(8)]
        if min(math.dist(a, b) for i, a in enumerate(points) for b in points[:i]) < 0.4:
            continue
        values = [measure(point, points) for point in points[:6]]
        best, second = sorted(values)[:2]
        if second - best > margin:
            break
    things = [Percept(f"m{i}", "mug", "red", (*point, 0.0)) for i, point in enumerate(points[:6])]
    things += [Percept(f"l{i}", "lamp", "white", (*point, 0.0)) for i, point in enumerate(points[6:])]
    return f"m{values.index(best)}", things


def _to_a_lamp(point: Point, points: Sequence[Point]) -> float:
    return min(math.dist(point, lamp) for lamp in points[6:])


def _box(points: Sequence[Point]) -> tuple[Point, Point]:
    (x0, *_, x1), (y0, *_, y1) = (sorted(axis) for axis in zip(*points, strict=True))
    return (x0, y0), (x1, y1)


def _to_a_corner(point: Point, points: Sequence[Point]) -> float:
    (x0, y0), (x1, y1) = _box(points)
    return min(math.dist(point, corner) for corner in ((x0, y0), (x0, y1), (x1, y0), (x1, y1)))


def _to_far_left(point: Point, points: Sequence[Point]) -> float:
    _, corner = _box(points)
    return math.dist(point, corner)


def _to_middle(point: Point, points: Sequence[Point]) -> float:
    (x0, y0), (x1, y1) = _box(points)
    return math.dist(point, ((x0 + x1) / 2, (y0 + y1) / 2))


@pytest.mark.parametrize(
    ("text", "measure", "margin"),
    [
        ("take the mug closest to a lamp", _to_a_lamp, 0.5),
        ("take the mug that is nearest to one of the lamps", _to_a_lamp, 0.5),
        ("take the mug next to a lamp", _to_a_lamp, 0.5),
        ("take the mug farthest from the lamps", lambda p, all_: -_to_a_lamp(p, all_), 0.9),
        ("take the mug in the corner", _to_a_corner, 0.5),
        ("take the mug in the far left corner", _to_far_left, 0.5),
        ("take the mug in the middle", _to_middle, 0.5),
    ],
)
def test_of_several_landmarks_the_nearest_and_places_without_a_workspace(
    text: str, measure: Measure, margin: float
) -> None:
    right = 0
    for seed in range(8):
        meant, things = _scene(seed, measure, margin)
        answer = grounded(text, things, Pose(-1.5, 0.0, 0.0))
        right += [o.id for o in answer.objects] == [meant]
    assert right >= 7


def test_the_nearer_of_the_two_is_the_likelier_however_small_the_difference() -> None:
    for gap in (0.6, 0.8, 0.95):
        things = [
            Percept("near", "mug", "red", (3.0, 2.0 - gap, 0.0)),
            Percept("far", "mug", "red", (3.0, -1.0, 0.0)),
            Percept("left", "lamp", "white", (3.0, 2.0, 0.0)),
            Percept("right", "lamp", "white", (3.0, -2.0, 0.0)),
        ]
        answer = grounded("take the mug closest to a lamp", things)
        assert [o.id for o in answer.objects] == ["near"], gap
        assert answer.probabilities["near"] > answer.probabilities["far"]


LAMPS = [
    Percept("cabinet", "cabinet", None, (0.8, 2.9, 0.4)),
    Percept("table lamp", "table lamp", None, (1.3, 2.7, 1.0)),
    Percept("floor lamp", "floor lamp", None, (8.7, -3.9, 0.8)),
    Percept("sofa", "sofa", None, (6.7, -3.9, 0.4)),
    Percept("pillow", "pillow", None, (6.6, -3.8, 0.6)),
    Percept("television", "television", None, (7.0, -0.9, 0.7)),
    Percept("near umbrella", "umbrella", "red", (1.9, 1.4, 0.0)),
    Percept("far umbrella", "umbrella", "yellow", (5.8, 3.8, 0.0)),
]


@pytest.mark.parametrize("unit", [0.5, 0.7, 1.0])
def test_the_only_near_one_is_beside_it_at_another_height(unit: float) -> None:
    """The floor lamp is 2 m from the sofa, the other 8.5 m; both stand higher than it."""
    model = shipped()
    workspace = Workspace(None, unit)
    world = model.world_model(LAMPS, robot=Pose(0.0, 0.0), looked=True, workspace=workspace)
    for text in ("the lamp beside the sofa", "switch on the lamp next to the sofa"):
        assert [o.id for o in model.ground(text, world).objects] == ["floor lamp"], text


@pytest.mark.parametrize(
    ("text", "meant"),
    [
        ("the far umbrella", "far umbrella"),
        ("the distant umbrella", "far umbrella"),
        ("take the umbrella that is far away", "far umbrella"),
        ("the umbrella, the far one", "far umbrella"),
        ("the near umbrella", "near umbrella"),
        ("the nearby umbrella", "near umbrella"),
    ],
)
def test_far_and_near_by_themselves_rank(text: str, meant: str) -> None:
    """They stand 2.4 m and 6.9 m from the robot."""
    model = shipped()
    world = model.world_model(LAMPS, robot=Pose(0.0, 0.0), looked=True)
    assert [o.id for o in model.ground(text, world).objects] == [meant]
