"""The robot in physics: what it sees is what a camera would, what it does is what its wheels do."""

from __future__ import annotations

import math
import threading
from collections.abc import Iterator

import numpy as np
import pytest
from physics import distance, everything, seen, world

from dcg_torch.simulator import Client, SimulatedRobot, SimulatorError
from dcg_torch.simulator.bodies import footprint
from dcg_torch.simulator.client import STEP
from dcg_torch.simulator.wheels import ROBOT_RADIUS
from dcg_torch.types import DriveResult, Percept, Pose
from dcg_torch.world.files import World
from dcg_torch.world.generator import generate_world


@pytest.mark.parametrize("angle", [0.3, -1.0, math.pi, -math.tau, 0.01, 7.5])
def test_spin_turns_by_the_angle_and_stays_in_place(shared: SimulatedRobot, angle: float) -> None:
    shared.load(world(("a", "cube", 2.0, 0.0), start=(0.5, -0.3, 2.9)))
    shared.spin(angle)
    assert abs(math.remainder(shared.pose.yaw - 2.9 - angle, math.tau)) < 0.02
    assert math.dist((shared.pose.x, shared.pose.y), (0.5, -0.3)) < 0.02
    assert shared.turned == pytest.approx(abs(angle), abs=0.03)
    assert shared.path_length < 0.05
    # and it stands: nothing moves in the next simulated second
    before = shared.client.pose(shared._visit.base.body)
    shared.client.step(round(1.0 / STEP))
    after = shared.client.pose(shared._visit.base.body)
    assert math.dist((before.x, before.y), (after.x, after.y)) < 1e-3
    assert abs(before.yaw - after.yaw) < 1e-3


def test_many_spins_do_not_drift(shared: SimulatedRobot) -> None:
    shared.load(world(("a", "cube", 2.0, 0.0)))
    for _ in range(16):
        shared.spin(math.tau / 8)
    assert math.hypot(shared.pose.x, shared.pose.y) < 0.1


@pytest.mark.parametrize("angle", [math.nan, math.inf, 1e4, -1e4])
def test_no_turn_by_what_is_no_angle(shared: SimulatedRobot, angle: float) -> None:
    shared.load(world(("a", "cube", 2.0, 0.0)))
    with pytest.raises(ValueError, match="can't turn"):
        shared.spin(angle)


# driving


@pytest.mark.parametrize("seed", range(8))
def test_in_random_worlds_it_arrives_and_leaves_touching_nothing(shared: SimulatedRobot, seed: int) -> None:
    rng = np.random.default_rng(seed)
    there = generate_world(rng, "w", probability=0.35)
    target = str(rng.choice([o.id for o in there.objects]))
    shared.load(there)
    # it knows its goal and what it sees, and has to notice the rest on the way
    known = [percept for percept in everything(there) if percept.id == target]
    straight = distance(shared, there, target)
    assert shared.drive_to(target, [*shared.perceive(), *known])
    assert distance(shared, there, target) <= 0.5
    assert shared.path_length >= straight - 0.5 - 0.01
    assert shared.drive_away(target, known)
    assert distance(shared, there, target) >= 1.5
    assert shared.collisions == 0


def test_an_obstacle_on_the_straight_way_is_gone_round(shared: SimulatedRobot) -> None:
    there = world(("goal", "cube", 4.0, 0.0), ("wall", "sphere", 2.0, 0.0))
    shared.load(there)
    assert shared.drive_to("goal", everything(there))
    assert shared.collisions == 0
    assert 3.5 < shared.path_length < 4.0


@pytest.mark.parametrize("looking", [True, False])
def test_an_obstacle_that_was_hidden_is_noticed_on_the_way(
    shared: SimulatedRobot, monkeypatch: pytest.MonkeyPatch, looking: bool
) -> None:
    # the cylinder hides behind the sphere, and stands in the way that is planned round it
    there = world(("goal", "cube", 4.6, 0.0), ("near", "sphere", 1.2, 0.0), ("hidden", "cylinder", 3.2, 0.0))
    assert "hidden" not in seen(shared, there)
    if not looking:
        monkeypatch.setattr(shared, "_look", list)
    known = [percept for percept in everything(there) if percept.id != "hidden"]
    assert bool(shared.drive_to("goal", known)) == looking
    assert (shared.collisions == 0) == looking


def test_touching_is_counted(shared: SimulatedRobot) -> None:
    shared.load(world(("a", "cube", 0.6, 0.0)))
    for _ in range(60):
        shared._visit.base.tick(0.4, 0.0)
    assert shared.collisions == 1
    assert shared.pose.x < 0.6 - 0.15 - 0.1


def test_no_way_is_said_at_once(shared: SimulatedRobot) -> None:
    fence = [(f"f{k}", "sphere", 1.0 * math.cos(k * 0.6283), 1.0 * math.sin(k * 0.6283)) for k in range(10)]
    there = world(("goal", "cube", 4.0, 0.0), *fence)
    shared.load(there)
    assert shared.drive_to("goal", everything(there)) is DriveResult.NO_WAY
    assert shared.path_length == 0.0
    assert shared.collisions == 0


def test_through_a_narrow_door_it_keeps_the_margin_that_was_planned(shared: SimulatedRobot) -> None:
    # a fence of spheres round the robot, with one gap that leaves it 5 cm on either side
    radius, reach = footprint("sphere"), 1.3
    half = math.asin((radius + ROBOT_RADIUS + 0.05) / reach)
    angles = [half + k * (math.tau - 2 * half) / 9 for k in range(10)]
    fence = [(f"f{k}", "sphere", reach * math.cos(a), reach * math.sin(a)) for k, a in enumerate(angles)]
    there = world(("goal", "cube", 0.6, 2.4), *fence, start=(-0.3, 0.3, 2.0))
    nearest: list[float] = []
    shared.load(there)
    shared.on_tick = lambda pose: nearest.append(min(math.dist((pose.x, pose.y), (x, y)) for _, _, x, y in fence))
    try:
        assert shared.drive_to("goal", everything(there))
    finally:
        shared.on_tick = None
    assert 0.025 < min(nearest) - radius - ROBOT_RADIUS < 0.05


@pytest.mark.parametrize("start", [(1.2, 0.0), (3.0, 1.0)])
def test_leaving_ends_farther_away(shared: SimulatedRobot, start: tuple[float, float]) -> None:
    there = world(("a", "cube", 0.0, 0.0), start=(*start, math.pi))
    shared.load(there)
    assert shared.drive_away("a", everything(there))
    assert distance(shared, there, "a") > max(1.5, math.hypot(*start))


def test_it_drives_on_to_the_next_object_from_beside_the_last(shared: SimulatedRobot) -> None:
    there = world(("a", "cube", 1.5, 0.0), ("b", "cube", -1.5, 0.2), ("c", "cube", 3.0, 0.0))
    shared.load(there)
    for target in ("a", "c", "b"):
        assert shared.drive_to(target, everything(there))
    assert shared.collisions == 0


def test_it_goes_to_a_free_place_and_not_into_an_object(shared: SimulatedRobot) -> None:
    there = world(("a", "sphere", 1.5, 0.0))
    shared.load(there)
    assert shared.go_to(3.0, 0.0, everything(there))
    assert math.dist((shared.pose.x, shared.pose.y), (3.0, 0.0)) <= 0.1
    assert shared.go_to(1.5, 0.1, everything(there)) is DriveResult.NO_WAY
    assert shared.collisions == 0


def test_there_is_no_driving_to_what_was_not_perceived(shared: SimulatedRobot) -> None:
    shared.load(world(("a", "cube", 2.0, 0.0)))
    with pytest.raises(ValueError, match="no percept of 'b'"):
        shared.drive_to("b", shared.perceive())


def test_the_observer_is_called_ten_times_a_second(shared: SimulatedRobot) -> None:
    poses: list[Pose] = []
    shared.load(world(("a", "cube", 2.0, 0.0)))
    shared.on_tick = poses.append
    try:
        shared.spin(math.pi)
    finally:
        shared.on_tick = None
    assert len(poses) == pytest.approx(10 * shared.seconds, abs=1)


@pytest.mark.parametrize("x", [1e4, 1e308, math.inf, math.nan])
def test_it_does_not_set_out_for_what_is_too_far(shared: SimulatedRobot, x: float) -> None:
    there = world(("a", "cube", 2.0, 0.0))
    shared.load(there)
    far = Percept("far", "cube", "red", (x, 0.0, 0.0))
    assert shared.drive_to("far", [far]) is DriveResult.TOO_FAR
    assert shared.go_to(x, 0.0, everything(there)) is DriveResult.TOO_FAR
    assert shared.seconds == 0.0
    # and it is no obstacle to others
    assert shared.drive_to("a", [far, *everything(there)]) is DriveResult.ARRIVED


@pytest.mark.parametrize(
    ("type_", "ahead", "why"),
    [
        ("cube", 500.0, "a stands 500 m from the robot; move it within 100 m"),
        ("cube", 0.2, "a stands where the robot starts"),
        ("unicorn", 2.0, "world test: a: no body for object type"),
    ],
)
def test_an_object_that_cannot_stand_there_is_refused(
    shared: SimulatedRobot, type_: str, ahead: float, why: str
) -> None:
    with pytest.raises(SimulatorError, match=why):
        shared.load(world(("a", type_, ahead, 0.0)))


def test_a_robot_that_is_held_does_not_get_there(shared: SimulatedRobot, monkeypatch: pytest.MonkeyPatch) -> None:
    there = world(("a", "cube", 2.0, 0.0))
    shared.load(there)
    base = shared._visit.base
    tick = base.tick
    monkeypatch.setattr(base, "tick", lambda speed, turn: tick(0.0, 0.0))
    assert shared.drive_to("a", everything(there)) is DriveResult.BLOCKED
    assert shared.seconds < 40.0


def test_it_can_be_stopped_from_another_thread(shared: SimulatedRobot) -> None:
    there = world(("a", "cube", 8.0, 0.0))
    shared.load(there)

    def stop_soon(pose: Pose) -> None:
        if shared.path_length > 1.0:
            thread = threading.Thread(target=shared.stop)
            thread.start()
            thread.join()

    shared.on_tick = stop_soon
    try:
        assert shared.drive_to("a", everything(there)) is DriveResult.STOPPED
    finally:
        shared.on_tick = None
    driven, turned = shared.path_length, shared.turned
    assert 1.0 < driven < 1.6  # it brakes, and stands
    assert shared.drive_to("a", everything(there)) is DriveResult.STOPPED
    shared.spin(1.0)
    assert (shared.path_length, shared.turned) == (driven, turned)
    shared.resume()
    assert shared.drive_to("a", everything(there)) is DriveResult.ARRIVED


# worlds and clients


def journey(robot: SimulatedRobot, there: World) -> Iterator[tuple[object, ...]]:
    """A visit in three stages, each giving all that can be seen of it."""
    robot.load(there)
    yield robot.pose, tuple(robot.perceive())
    robot.spin(2.0)
    yield robot.pose, tuple(robot.perceive())
    robot.drive_to(there.objects[-1].id, everything(there))
    yield robot.pose, robot.path_length, robot.turned, robot.seconds, tuple(robot.perceive())


def test_a_visit_does_not_depend_on_earlier_visits_or_other_clients_or_pictures() -> None:
    first, second = (generate_world(np.random.default_rng(seed), "w", probability=0.3) for seed in (1, 2))
    with SimulatedRobot() as robot:
        alone = list(journey(robot, first))
    with SimulatedRobot() as one, SimulatedRobot() as two:
        interleaved = [stage for stage, _ in zip(journey(one, first), journey(two, second), strict=True)]
        between = list(journey(two, first))  # after another world, beside another client
        with_pictures = []
        for stage in journey(one, first):
            one.picture(width=32, height=18)
            with_pictures.append(stage)
    # exactly: floats compared bit by bit through equality
    assert interleaved == alone
    assert between == alone
    assert with_pictures == alone


def test_loading_sets_the_counters_to_zero(shared: SimulatedRobot) -> None:
    shared.load(world(("a", "cube", 2.0, 0.0)))
    shared.spin(1.0)
    shared.load(world(("a", "cube", 2.0, 0.0), start=(0.25, -0.5, 1.0)))
    assert (shared.turned, shared.path_length, shared.collisions, shared.seconds) == (0.0, 0.0, 0, 0.0)
    pose = shared.pose
    assert (pose.x, pose.y, pose.yaw) == pytest.approx((0.25, -0.5, 1.0), abs=1e-9)


def test_nothing_works_before_a_world_is_loaded() -> None:
    with SimulatedRobot() as robot, pytest.raises(SimulatorError, match="load one first"):
        robot.spin(1.0)


def test_a_window_without_a_screen_is_one_clear_line(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("sys.platform", "linux")
    monkeypatch.delenv("DISPLAY", raising=False)
    with pytest.raises(SimulatorError, match=r"DISPLAY is not set: run with simulator\.gui=false") as error:
        Client(gui=True)
    assert "\n" not in str(error.value)


def test_a_client_can_be_closed_twice() -> None:
    with Client() as client:
        client.close()
    client.close()
