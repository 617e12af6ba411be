"""The ROS node's parts that need no ROS: notes, senses, a robot of messages, the worker, its snapshots."""

from __future__ import annotations

import json
import math
import threading
import time
from collections.abc import Callable, Iterator
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any

import pytest

from dcg_torch.agent.asking import Question, Reply
from dcg_torch.apps.ros.notes import BadNoteError, Note, read_correction, read_note, read_reply
from dcg_torch.apps.ros.options import Options
from dcg_torch.apps.ros.robot import TopicRobot, approach
from dcg_torch.apps.ros.senses import HaltedError, RobotSilentError, Senses
from dcg_torch.apps.ros.state import Handled, Store
from dcg_torch.apps.ros.tasks import Tasks
from dcg_torch.apps.ros.worker import Worker
from dcg_torch.learning.lexicon import Entry
from dcg_torch.model import GroundingModel
from dcg_torch.storage.errors import UserError
from dcg_torch.types import DriveResult, Percept, Pose

CONE = Percept("cone", "traffic cone", "orange", (2.0, 0.0, 0.0))
CUBE = Percept("cube", "cube", "blue", (2.0, 1.5, 0.0))
SOON = Options(look_timeout=60.0, drive_timeout=0.3, resend=0.03, answer_timeout=0.3)


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


@dataclass
class Far:
    """A robot at the other end of a bad radio: it heeds each goal once, from the `heeds`-th sending on."""

    senses: Senses
    world: tuple[Percept, ...] = (CONE, CUBE)
    heeds: int = 1
    says: DriveResult | None = None
    sent: list[tuple[Pose, int]] = field(default_factory=list)
    on_goal: Callable[[], None] = lambda: None

    def send(self, goal: Pose, stamp: int) -> None:
        self.sent.append((goal, stamp))
        self.on_goal()
        if [s for _, s in self.sent].count(stamp) != self.heeds:
            return
        if self.says is not None:
            self.senses.put_result(stamp, self.says)
        else:
            self.stand_at(goal)

    def stand_at(self, pose: Pose) -> None:
        self.senses.put_pose(pose, 0)
        self.senses.put_look(self.world, 0)

    @property
    def goals(self) -> int:
        return len({stamp for _, stamp in self.sent})


@pytest.fixture
def far() -> Far:
    robot = Far(Senses())
    robot.stand_at(Pose(0.0, 0.0))
    return robot


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


class Heard:
    """What the node says."""

    def __init__(self) -> None:
        self.texts: list[tuple[str, dict[str, Any]]] = []
        self.words: list[str] = []
        self._changed = threading.Condition()

    def say(self, topic: str, text: str) -> None:
        with self._changed:
            self.texts.append((topic, json.loads(text)))
            self._changed.notify_all()

    def show(self, entries: list[Entry], percepts: tuple[Percept, ...]) -> None:
        self.words = [entry.word for entry in entries]

    def complain(self, text: str) -> None:
        self.say("complaint", json.dumps({"text": text}))

    def of(self, topic: str, **wanted: Any) -> list[dict[str, Any]]:
        return [c for t, c in list(self.texts) if t == topic and all(c.get(k) == v for k, v in wanted.items())]

    def wait(self, topic: str = "acknowledgement", **wanted: Any) -> dict[str, Any]:
        with self._changed:
            assert self._changed.wait_for(lambda: self.of(topic, **wanted), 60.0), (wanted, self.texts)
        return self.of(topic, **wanted)[0]


@dataclass
class Robotics:
    """A worker with all that it needs, in a thread."""

    far: Far
    model: GroundingModel
    options: Options = SOON
    store: Store | None = None
    handled: Handled | None = None

    def __post_init__(self) -> None:
        self.heard = Heard()
        robot = TopicRobot(self.far.senses, self.far.send, lambda: self.options)
        self.tasks = Tasks(self.model, self.far.senses, robot, lambda: self.options, self.heard)
        self.worker = Worker(
            self.tasks, self.far.senses, robot, lambda: self.options, self.heard, self.store, self.handled
        )
        self.thread = threading.Thread(target=self.worker.run, daemon=True)
        self.thread.start()

    def close(self) -> None:
        self.worker.close()
        self.thread.join(10.0)
        assert not self.thread.is_alive()


Start = Callable[..., Robotics]


@pytest.fixture
def start(far: Far, pupil: Callable[[], GroundingModel]) -> Iterator[Start]:
    running: list[Robotics] = []

    def begin(**more: Any) -> Robotics:
        running.append(Robotics(far, more.pop("model", None) or pupil(), **more))
        return running[-1]

    yield begin
    for one in running:
        one.close()


def command(text: str, id_: str | None = None) -> str:
    return text if id_ is None else json.dumps({"text": text, "id": id_})


def test_a_command_that_comes_twice_is_carried_out_once(start: Start, far: Far) -> None:
    robotics = start()
    for _ in range(2):
        robotics.worker.accept("command", command("move towards the cone", "1"))
    done = robotics.heard.wait(id="1", state="done")
    assert (done["object"], done["learned"]) == ("cone", {"cone": "traffic cone"})
    robotics.worker.accept("command", command("move towards the cone", "1"))
    assert robotics.heard.wait(id="1", state="done", repeated=True)["object"] == "cone"
    assert far.goals == 1
    assert "cone" in robotics.heard.words


def test_lessons_and_corrections(start: Start) -> None:
    heard = (robotics := start()).heard
    robotics.worker.accept("teach", '{"text": "this is a pylon", "pointing_at": "cone", "id": "1"}')
    assert heard.wait(id="1", state="done")["learned"] == {"pylon": "traffic cone"}
    robotics.worker.accept("correct", '{"text": "pylon = cube", "id": "2"}')
    assert heard.wait(id="2", state="done")["learned"] == {"pylon": "cube"}
    robotics.worker.accept("correct", '{"text": "pylon = dragon", "id": "3"}')
    assert "ever met" in heard.wait(id="3", state="failed")["said"]
    robotics.worker.accept("forget", '{"text": "pylon", "id": "4"}')
    heard.wait(id="4", state="done")
    assert "pylon" not in heard.words
    assert not heard.of("complaint")


def test_more_than_may_wait_is_refused_and_a_stop_drops_the_rest(start: Start, far: Far) -> None:
    far.heeds = 1_000
    robotics = start(options=replace(SOON, queue=2, drive_timeout=60.0))
    robotics.worker.accept("command", command("move towards the cone", "1"))
    robotics.heard.wait("understood", id="1")
    for id_ in "234":
        robotics.worker.accept("command", command("move towards the cube", id_))
    assert "later" in robotics.heard.wait(id="4", state="refused")["said"]
    assert "2 that waited" in robotics.worker.stop()
    for id_ in "123":
        robotics.heard.wait(id=id_, state="stopped")
    assert far.sent[-1][0] == Pose(0.0, 0.0)
    assert "cone" not in robotics.model.symbols  # a drive that was stopped teaches nothing
    far.heeds = 1
    robotics.worker.accept("command", command("move towards the cone", "5"))
    robotics.heard.wait(id="5", state="done")


def test_a_robot_that_is_silent_is_said_and_the_next_command_goes_on(start: Start, far: Far) -> None:
    robotics = start(options=replace(SOON, look_timeout=0.2))
    far.senses._pose = None
    robotics.worker.accept("command", command("move towards the cone", "1"))
    assert "no pose" in robotics.heard.wait(id="1", state="failed")["said"]
    robotics.options = SOON
    far.stand_at(Pose(0.0, 0.0))
    robotics.worker.accept("command", command("move towards the cone", "2"))
    robotics.heard.wait(id="2", state="done")


def test_an_error_of_the_program_ends_one_command_alone(start: Start, monkeypatch: pytest.MonkeyPatch) -> None:
    robotics = start()
    with monkeypatch.context() as patch:
        patch.setattr("dcg_torch.apps.ros.tasks.carry_out", lambda *_, **__: 1 / 0)
        robotics.worker.accept("command", command("move towards the cone", "1"))
        assert "ZeroDivisionError" in robotics.heard.wait(id="1", state="failed")["said"]
    robotics.worker.accept("command", command("move towards the cone", "2"))
    robotics.heard.wait(id="2", state="done")


def test_what_is_no_order_is_said(start: Start) -> None:
    robotics = start()
    robotics.worker.accept("command", command("what time is it?", "1"))
    assert robotics.heard.wait(id="1", state="failed")["said"]
    robotics.worker.accept("command", "")
    robotics.heard.wait(id=None, state="refused")


def test_a_question_is_asked_until_it_is_answered(start: Start, far: Far) -> None:
    from dcg_torch.model.pretrain import pretrained

    far.world = (Percept("a", "cube", "red", (2.0, 0.5, 0.0)), Percept("b", "cube", "red", (2.0, -0.5, 0.0)))
    far.stand_at(Pose(0.0, 0.0))
    robotics = start(model=pretrained(), options=replace(SOON, answer_timeout=20.0))
    robotics.worker.accept("command", command("go to the cube", "1"))
    asked = robotics.heard.wait("question", id="1")
    assert set(asked["candidates"]) == {"a", "b"}
    robotics.tasks.answer("banana")
    robotics.tasks.answer("b")
    assert robotics.heard.wait(id="1", state="done")["object"] == "b"
    robotics.options = SOON
    robotics.worker.accept("command", command("go to the cube", "2"))
    assert "nobody answered" in robotics.heard.wait(id="2", state="failed")["said"]


def test_a_node_goes_on_from_its_snapshot_and_does_nothing_twice(start: Start, far: Far, tmp_path: Path) -> None:
    first = start(store=Store(tmp_path))
    first.worker.accept("command", command("move towards the cone", "1"))
    first.heard.wait(id="1", state="done")
    first.close()
    (tmp_path / ".snapshot-00000009.ab.part").mkdir()  # what a killed writer leaves
    model, handled = Store(tmp_path).restore() or pytest.fail("nothing was saved")
    goals = far.goals
    second = start(model=model, store=Store(tmp_path), handled=handled)
    assert model.symbols["cone"].type == "traffic cone"
    second.worker.accept("command", command("move towards the cone", "1"))
    second.heard.wait(id="1", state="done", repeated=True)
    assert far.goals == goals


def test_a_broken_snapshot_gives_way_to_the_one_before(tmp_path: Path, pupil: Callable[[], GroundingModel]) -> None:
    store, model = Store(tmp_path), pupil()
    for number in range(4):
        newest = store.save(model, {"n": {"number": number}})
    assert len(list(tmp_path.glob("snapshot-*"))) == 2
    (newest / "weights.safetensors").write_bytes(b"cut sh")
    restored = Store(tmp_path).restore()
    assert restored is not None
    assert restored[1] == {"n": {"number": 2}}
    for path in tmp_path.glob("snapshot-*/model.json"):
        path.unlink()
    with pytest.raises(UserError, match="no snapshot can be read"):
        Store(tmp_path).restore()


def test_a_full_disk_is_said_and_stops_nothing(start: Start, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    robotics = start(store=(store := Store(tmp_path)))

    def full(*_: Any) -> Path:
        raise OSError(28, "No space left on device")

    monkeypatch.setattr(store, "save", full)
    robotics.worker.accept("command", command("move towards the cone", "1"))
    assert "No space" in robotics.heard.wait(id="1", state="done")["unsaved"]
    assert robotics.worker.save()[0] is False
