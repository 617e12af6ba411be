"""What the ROS node does with commands, lessons and its state, without ROS."""

from __future__ import annotations

import json
import threading
from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import pytest
from robotics import SOON, Far

from dcg_torch.apps.ros.options import Options
from dcg_torch.apps.ros.robot import TopicRobot
from dcg_torch.apps.ros.state import Handled, Store
from dcg_torch.apps.ros.tasks import Tasks
from dcg_torch.apps.ros.worker import Worker
from dcg_torch.learning.lexicon import Entry
from dcg_torch.model import GroundingModel
from dcg_torch.storage.errors import UserError
from dcg_torch.types import Percept, Pose


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
