"""Paths keep their clearance, are no longer than they need be, and say so when there is no way."""

from __future__ import annotations

import itertools
import math
import time
import tracemalloc
from collections.abc import Sequence

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.ndimage import label

from dcg_torch.simulator.navigation import (
    Circle,
    approach,
    clearance,
    is_clear,
    length,
    retreat,
    ring,
    shortest_path,
    shrink_to_reach,
)
from dcg_torch.simulator.roadmap import tightened
from dcg_torch.types.arrays import Points

coordinate = st.floats(-4.0, 4.0).map(lambda v: round(v, 3))
circles = st.lists(st.builds(Circle, coordinate, coordinate, st.floats(0.1, 1.0)), max_size=8)


def sampled_distance(path: Points, circle: Circle) -> float:
    """The oracle: how near the path comes to the centre, by walking along it in small steps."""
    walked = np.concatenate([np.linspace(a, b, 400) for a, b in itertools.pairwise(path)])
    return float(np.linalg.norm(walked - [circle.x, circle.y], axis=1).min())


@given(circles, coordinate, coordinate, coordinate, coordinate)
def test_clearance_is_the_distance_of_the_nearest_point(
    obstacles: list[Circle], x0: float, y0: float, x1: float, y1: float
) -> None:
    path = np.array([[x0, y0], [x1, y1]])
    found = clearance(path[:-1], path[1:], obstacles)
    assert found.shape == (1, len(obstacles))
    step = math.hypot(x1 - x0, y1 - y0) / 399
    for circle, value in zip(obstacles, found[0], strict=True):
        sampled = sampled_distance(path, circle) - circle.radius
        assert sampled - step <= value <= sampled + 1e-9


@settings(max_examples=60, deadline=None)
@given(circles, coordinate, coordinate, coordinate, coordinate)
def test_a_path_keeps_outside_every_obstacle(
    obstacles: list[Circle], x0: float, y0: float, x1: float, y1: float
) -> None:
    start, goal = (x0, y0), (x1, y1)
    path = shortest_path(start, np.array([goal]), obstacles)
    if path is None:
        return
    assert tuple(path[0]) == start
    assert tuple(path[-1]) == goal
    assert length(path) >= math.dist(start, goal) - 1e-9
    for circle in shrink_to_reach(obstacles, start):
        assert sampled_distance(path, circle) >= circle.radius - 1e-5


@settings(max_examples=40, deadline=None)
@given(circles, coordinate, coordinate, coordinate, coordinate)
def test_straight_when_nothing_is_in_the_way(
    obstacles: list[Circle], x0: float, y0: float, x1: float, y1: float
) -> None:
    straight = np.array([[x0, y0], [x1, y1]])
    if is_clear(straight, obstacles):
        path = shortest_path((x0, y0), straight[1:], obstacles)
        assert path is not None
        np.testing.assert_array_equal(path, straight)


def test_round_one_obstacle_the_path_is_the_tangents_and_the_arc() -> None:
    radius, half = 1.0, 3.0
    path = shortest_path((-half, 0.0), np.array([[half, 0.0]]), [Circle(0.0, 0.0, radius)])
    assert path is not None
    best = 2.0 * (math.sqrt(half**2 - radius**2) + radius * math.asin(radius / half))
    assert best <= length(path) <= 1.02 * best


@settings(max_examples=40, deadline=None)
@given(circles, coordinate, coordinate, st.floats(0.1, 0.45))
def test_approach_ends_on_the_ring_round_the_target(obstacles: list[Circle], x: float, y: float, radius: float) -> None:
    target = Circle(0.0, 0.0, radius)
    path = approach((x, y), target, obstacles)
    if path is None:
        return
    assert target.distance(*path[-1]) <= 0.47 + 1e-9
    if math.hypot(x, y) > 0.47:
        for circle in [*shrink_to_reach(obstacles, (x, y)), target]:
            assert sampled_distance(path, circle) >= circle.radius - 1e-5


def test_approach_from_within_reach_stays() -> None:
    path = approach((0.3, 0.0), Circle(0.0, 0.0, 0.2), [])
    assert path is not None
    assert length(path) == 0.0


def test_goals_inside_an_obstacle_are_not_used() -> None:
    # the near side of the target is covered, so the robot goes round to the far side
    cover = Circle(0.8, 0.0, 0.75)
    path = approach((3.0, 0.0), Circle(0.0, 0.0, 0.3), [cover])
    assert path is not None
    assert cover.distance(*path[-1]) >= cover.radius - 1e-6


@pytest.mark.parametrize("inside", ["start", "target"])
def test_no_way_out_of_or_into_a_closed_ring(inside: str) -> None:
    wall = [Circle(x, y, 0.45) for x, y in ring(Circle(0.0, 0.0, 1.5), 14)]
    start, target = ((0.0, 0.0), Circle(4.0, 0.0, 0.2)) if inside == "start" else ((4.0, 0.0), Circle(0.0, 0.0, 0.2))
    assert approach(start, target, wall) is None
    # with one stone of the wall taken out there is
    assert approach(start, target, wall[:5] + wall[7:]) is not None


@settings(max_examples=40, deadline=None)
@given(circles, coordinate, coordinate)
def test_retreat_ends_farther_away(obstacles: list[Circle], x: float, y: float) -> None:
    target = Circle(0.0, 0.0, 0.4)
    path = retreat((x, y), target, obstacles)
    if path is None:
        return
    assert target.distance(*path[-1]) >= max(1.6, math.hypot(x, y) + 0.3) - 1e-9
    for circle in shrink_to_reach([*obstacles, target], (x, y)):
        assert sampled_distance(path, circle) >= circle.radius - 1e-5


@pytest.mark.parametrize("point", [(0.0, 0.0), (0.4, 0.3), (3.0, 0.0)])
def test_an_obstacle_shrinks_just_enough_to_leave_the_point_outside(point: tuple[float, float]) -> None:
    (circle,) = shrink_to_reach([Circle(0.0, 0.0, 1.0)], point)
    assert circle.radius == pytest.approx(min(1.0, math.hypot(*point)), abs=1e-5)
    assert circle.distance(*point) >= circle.radius


def scattered(
    rng: np.random.Generator, count: int, half: float, apart: float, keep: tuple[float, float]
) -> list[Circle]:
    """Circles of 0.4 m with their middles at least `apart` from one another and 4 m from `keep`."""
    found: list[Circle] = []
    while len(found) < count:
        x, y = rng.uniform(-half, half, 2).tolist()
        if math.dist((x, y), keep) > 4.0 and all(c.distance(x, y) > apart for c in found):
            found.append(Circle(x, y, 0.4))
    return found


def measured(
    start: tuple[float, float], target: Circle, obstacles: Sequence[Circle]
) -> tuple[Points | None, float, float]:
    """The path, the seconds of processor time, and the megabytes at the peak."""
    began = time.process_time()
    path = approach(start, target, obstacles)
    seconds = time.process_time() - began
    tracemalloc.start()
    approach(start, target, obstacles)
    peak = tracemalloc.get_traced_memory()[1]
    tracemalloc.stop()
    return path, seconds, peak / 1e6


def test_that_there_is_no_way_is_said_quickly_however_much_stands_far_away() -> None:
    wall = [Circle(x, y, 0.35) for x, y in ring(Circle(0.0, 0.0, 1.5), 16)]
    far = scattered(np.random.default_rng(0), 300, 20.0, 0.9, (0.0, 0.0))
    start, target = (30.0, 0.0), Circle(0.0, 0.0, 0.3)
    path, seconds, megabytes = measured(start, target, [*wall, *far])
    assert path is None
    assert seconds < 0.1
    assert megabytes < 50.0
    gap = [*wall[1:], *far]
    found = approach(start, target, gap)
    assert found is not None
    assert is_clear(found, gap)


def test_a_way_through_very_many_is_found_in_time() -> None:
    crowd = scattered(np.random.default_rng(1), 300, 11.5, 0.95, (-20.0, -20.0))
    target = max(crowd, key=lambda c: c.x + c.y)
    others = [c for c in crowd if c is not target]
    path, seconds, megabytes = measured((-12.5, -12.5), Circle(target.x, target.y, 0.3), others)
    assert path is not None
    assert is_clear(path, others)
    assert seconds < 1.0
    assert megabytes < 50.0
    # a straight line is the least; through gaps between circles a path winds by a few percent
    assert length(path) < 1.1 * (target.distance(-12.5, -12.5) - 0.47)


@settings(max_examples=30, deadline=None)
@given(st.integers(0, 10**6), st.integers(2, 40))
def test_there_is_a_way_exactly_where_a_fine_grid_finds_one(seed: int, count: int) -> None:
    """The oracle: cells of 4 cm, flooded from the start. Gaps that it can't tell from touching are left out."""
    rng = np.random.default_rng(seed)
    places, radii = rng.uniform(-2.0, 2.0, (count, 2)).tolist(), rng.uniform(0.2, 0.6, count).tolist()
    obstacles = [Circle(x, y, radius) for (x, y), radius in zip(places, radii, strict=True)]
    start = (-3.0, 0.0)
    x, y = rng.uniform(-2.0, 2.0, 2).tolist()
    if min(c.distance(x, y) - c.radius for c in obstacles) < 0.06:
        return
    flooded = [connected(obstacles, start, (x, y), wider) for wider in (-0.04, 0.04)]
    if flooded[0] != flooded[1]:
        return
    path = shortest_path(start, np.array([(x, y)]), obstacles)
    assert (path is not None) == flooded[0]
    assert path is None or is_clear(path, obstacles)


def connected(obstacles: Sequence[Circle], start: tuple[float, float], goal: tuple[float, float], wider: float) -> bool:
    """Whether cells of 4 cm outside the circles, made wider, join the start and the goal."""
    axis = np.arange(-3.6, 3.6, 0.04)
    x, y = np.meshgrid(axis, axis, indexing="ij")
    free = np.ones_like(x, dtype=np.bool_)
    for c in obstacles:
        free &= np.hypot(x - c.x, y - c.y) > c.radius + wider
    regions, _ = label(free)
    here, there = (regions[int(np.abs(axis - a).argmin()), int(np.abs(axis - b).argmin())] for a, b in (start, goal))
    return bool(here == there != 0)


def test_a_tightened_way_is_shorter_and_outside() -> None:
    half = 2.5
    angles = np.arange(math.pi, -0.1, -0.1)
    wide = np.stack([half * np.cos(angles), half * np.sin(angles)], axis=1)
    path = tightened(wide, np.array([[0.0, 0.0]]), np.array([1.0]))
    assert is_clear(path, [Circle(0.0, 0.0, 1.0)])
    np.testing.assert_array_equal(path[[0, -1]], wide[[0, -1]])
    best = 2.0 * (math.sqrt(half**2 - 1.0) + math.asin(1.0 / half))
    assert 0.97 * best <= length(path) <= 1.1 * best < length(wide)
