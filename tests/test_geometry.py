"""The robot's frame and segments among discs, against definitions written another way."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays

from dcg_torch.types import Pose
from dcg_torch.types.arrays import Floats
from dcg_torch.types.geometry import (
    bearing,
    from_robot_frame,
    in_field_of_view,
    segment_distances,
    segments_clear,
    to_robot_frame,
    wrap_angle,
    wrap_angles,
)

metres = st.floats(-10.0, 10.0)
poses = st.builds(Pose, metres, metres, st.floats(-10.0, 10.0))


@pytest.mark.parametrize(
    ("robot", "point", "ahead", "left"),
    [
        (Pose(1.0, 2.0, 0.0), (3.0, 2.5), 2.0, 0.5),
        (Pose(1.0, 2.0, math.pi / 2), (1.0, 5.0), 3.0, 0.0),
        (Pose(0.0, 0.0, math.pi), (1.0, 1.0), -1.0, -1.0),
    ],
)
def test_ahead_and_left_are_of_the_heading(robot: Pose, point: tuple[float, float], ahead: float, left: float) -> None:
    assert to_robot_frame(robot, np.array([point])) == pytest.approx(np.array([[ahead, left]]))
    assert from_robot_frame(robot, ahead, left) == pytest.approx(point)
    assert bearing(robot, *point) == pytest.approx(math.atan2(left, ahead))


@given(poses, metres, metres)
def test_the_frame_goes_there_and_back(robot: Pose, x: float, y: float) -> None:
    ((ahead, left),) = to_robot_frame(robot, np.array([[x, y]])).tolist()
    assert from_robot_frame(robot, ahead, left) == pytest.approx((x, y), abs=1e-9)
    assert math.hypot(ahead, left) == pytest.approx(math.dist((x, y), (robot.x, robot.y)), abs=1e-9)


@given(st.floats(-50.0, 50.0))
def test_a_wrapped_angle_is_the_same_direction(angle: float) -> None:
    for wrapped in (wrap_angle(angle), float(wrap_angles(np.array([angle]))[0])):
        assert abs(wrapped) <= math.pi + 1e-12
        assert (math.cos(wrapped), math.sin(wrapped)) == pytest.approx((math.cos(angle), math.sin(angle)), abs=1e-9)


@pytest.mark.parametrize("side", [1.0, -1.0])
def test_the_view_is_57_degrees_wide(side: float) -> None:
    robot = Pose(0.5, -1.0, 2.0)
    for degrees, seen in ((28.4, True), (28.6, False), (170.0, False)):
        angle = robot.yaw + side * math.radians(degrees)
        assert in_field_of_view(robot, 0.5 + 3.0 * math.cos(angle), -1.0 + 3.0 * math.sin(angle)) == seen


@given(
    arrays(float, (3, 2), elements=metres),
    arrays(float, (3, 2), elements=metres),
    arrays(float, (4, 2), elements=metres),
    arrays(float, (4,), elements=st.floats(0.01, 3.0)),
)
def test_segments_keep_the_distance_of_their_nearest_point(
    starts: Floats, ends: Floats, centres: Floats, radii: Floats
) -> None:
    distance, foot = segment_distances(starts, ends, centres)
    shares = np.linspace(0.0, 1.0, 801)
    for i, (a, b) in enumerate(zip(starts, ends, strict=True)):
        walked = a + shares[:, None] * (b - a)
        nearest = np.linalg.norm(walked[:, None] - centres[None], axis=2).min(axis=0)
        step = math.dist(a, b) / 800
        assert (distance[i] <= nearest + 1e-9).all()
        assert (distance[i] >= nearest - step).all()
        on_line = a + foot[i][:, None] * (b - a)
        inside = (foot[i] >= 0.0) & (foot[i] <= 1.0)
        assert np.linalg.norm(on_line - centres, axis=1)[inside] == pytest.approx(distance[i][inside], abs=1e-6)
    assert segments_clear(starts, ends, centres, radii).tolist() == (distance >= radii).all(axis=1).tolist()
