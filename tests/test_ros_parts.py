"""The ROS node's parts that need no ROS: notes, senses, a robot of messages, the worker, its snapshots."""

from __future__ import annotations

import math
import time
from dataclasses import replace

import pytest
from robotics import CONE, CUBE, SOON, Far

from dcg_torch.agent.asking import Question, Reply
from dcg_torch.apps.ros.notes import BadNoteError, Note, read_correction, read_note, read_reply
from dcg_torch.apps.ros.robot import TopicRobot, approach
from dcg_torch.apps.ros.senses import HaltedError, RobotSilentError, Senses
from dcg_torch.types import DriveResult, Pose


def test_a_note_is_text_or_an_object_with_text() -> None:
    assert read_note("  go to\nthe cone ") == Note(text="go to the cone")
    assert read_note('{"text": "go", "id": "7"}') == Note(text="go", id="7")


@pytest.mark.parametrize(
    "data",
    [
        "",
        "  \n",
        "{",
        '{"id": "7"}',
        '{"text": 3}',
        '{"text": " "}',
        '{"text": "go", "x": 1}',
        "x" * 3_000,
        "{" * 1_500,
    ],
)
def test_what_is_no_note_is_refused_in_one_line(data: str) -> None:
    with pytest.raises(BadNoteError) as caught:
        read_note(data)
    assert 0 < len(str(caught.value)) < 300
    assert "\n" not in str(caught.value)


def test_a_correction_has_a_word_and_a_type() -> None:
    assert read_correction("Pallet =  euro pallet") == ("pallet", "euro pallet")
    for wrong in ("pallet", "= euro pallet", "pallet ="):
        with pytest.raises(BadNoteError):
            read_correction(wrong)


def test_answers() -> None:
    two, one = Question("Do you mean a, or b?", ("a", "b")), Question("Do you mean a?", ("a",))
    assert read_reply("the second one", two) == Reply("b")
    assert read_reply("b", two) == Reply("b")
    assert read_reply("None of them.", two) == Reply(None)
    assert read_reply("yes, please", one) == Reply("a")
    for unclear in ("yes", "the third one", "first or second", "go to the cone", ""):
        assert read_reply(unclear, two) is None


def test_a_late_message_changes_nothing_and_a_clock_that_was_set_anew_does(monkeypatch: pytest.MonkeyPatch) -> None:
    now = [100.0]
    monkeypatch.setattr("dcg_torch.apps.ros.senses.time.monotonic", lambda: now[0])
    senses = Senses()
    senses.put_pose(Pose(1.0, 0.0), 2_000)
    senses.put_pose(Pose(9.0, 0.0), 1_000)
    assert senses.here() == Pose(1.0, 0.0)
    now[0] += 3.0
    senses.put_pose(Pose(2.0, 0.0), 1_001)
    assert senses.here() == Pose(2.0, 0.0)


@pytest.mark.parametrize("stamped", [True, False])
def test_a_look_counts_only_if_it_was_taken_where_the_robot_stands(stamped: bool) -> None:
    senses = Senses()
    stamps = iter(range(1, 10)) if stamped else iter([0] * 10)
    senses.put_pose(Pose(0.0, 0.0), next(stamps))
    senses.put_look((CONE,), next(stamps))
    assert senses.look(0.1) == (CONE,)
    senses.put_pose(Pose(0.001, 0.0), next(stamps))  # jitter
    assert senses.look(0.1) == (CONE,)
    senses.put_pose(Pose(1.0, 0.0), next(stamps))
    with pytest.raises(RobotSilentError, match="no percepts"):
        senses.look(0.05)
    senses.put_look((CUBE,), next(stamps))
    assert senses.look(0.1) == (CUBE,)


def test_an_old_pose_is_none(monkeypatch: pytest.MonkeyPatch) -> None:
    senses = Senses()
    senses.put_pose(Pose(0.0, 0.0), 1)
    monkeypatch.setattr("dcg_torch.apps.ros.senses.time.monotonic", lambda clock=time.monotonic: clock() + 60.0)
    with pytest.raises(RobotSilentError, match="no pose"):
        senses.pose(0.05)


def test_a_lost_goal_is_sent_again_with_the_same_stamp(far: Far) -> None:
    far.heeds = 3
    assert TopicRobot(far.senses, far.send, lambda: SOON).drive_to("cone", far.world) is DriveResult.ARRIVED
    assert (len(far.sent), far.goals) == (3, 1)


def test_a_robot_that_moved_before_it_lost_the_goal_gets_it_again(far: Far) -> None:
    far.heeds = 3
    far.on_goal = lambda: far.senses.put_pose(Pose(0.3, 0.0), 0)  # the end of an earlier motion, heard late
    assert TopicRobot(far.senses, far.send, lambda: SOON).drive_to("cone", far.world) is DriveResult.ARRIVED


def test_a_drive_ends_as_the_robot_says(far: Far) -> None:
    far.says = DriveResult.NO_WAY
    assert TopicRobot(far.senses, far.send, lambda: SOON).drive_to("cone", far.world) is DriveResult.NO_WAY


def test_where_the_robot_arrived_must_be_known_before_it_goes_on(far: Far) -> None:
    far.says = DriveResult.ARRIVED

    def late() -> None:  # the pose is lost at first
        if len(far.sent) == 2:
            far.stand_at(far.sent[-1][0])

    far.on_goal = late
    robot = TopicRobot(far.senses, far.send, lambda: SOON)
    robot.spin(0.8)
    assert len(far.sent) == 2
    assert robot.pose.yaw == pytest.approx(0.8)


def test_a_robot_that_does_not_come_is_told_to_stand(far: Far) -> None:
    far.heeds = 1_000
    assert TopicRobot(far.senses, far.send, lambda: SOON).drive_to("cone", far.world) is DriveResult.BLOCKED
    assert far.sent[-1][0] == Pose(0.0, 0.0)
    assert far.goals == 2


def test_a_stop_ends_a_drive_and_a_turn(far: Far) -> None:
    far.heeds, far.on_goal = 1_000, far.senses.halt
    robot = TopicRobot(far.senses, far.send, lambda: SOON)
    assert robot.drive_to("cone", far.world) is DriveResult.STOPPED
    far.senses.go_on()
    with pytest.raises(HaltedError):
        robot.spin(1.0)


def test_it_stands_before_the_object_and_faces_it() -> None:
    goal = approach(Pose(0.0, 0.0), "cone", (CONE, CUBE), 0.6)
    assert (goal.x, goal.y, goal.yaw) == pytest.approx((1.4, 0.0, 0.0))
    taken = replace(CUBE, position=(1.3, 0.0, 0.0))
    aside = approach(Pose(0.0, 0.0), "cone", (CONE, taken), 0.6)
    assert math.dist((aside.x, aside.y), CONE.position[:2]) == pytest.approx(0.6)
    assert math.dist((aside.x, aside.y), taken.position[:2]) > 0.5
    assert aside.yaw == pytest.approx(math.atan2(-aside.y, 2.0 - aside.x))
