"""The ROS node, by a client in another process: the laboratory demonstration over topics, a bad radio, a restart."""

from __future__ import annotations

import json
import os
import random
import signal
import subprocess
import sys
import time
from collections import Counter
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import pytest

rclpy = pytest.importorskip("rclpy", reason="needs the extra ros")
# What rclpy brings for reading interface files imports a module that Python is to lose.
pytestmark = [pytest.mark.slow, pytest.mark.filterwarnings("ignore:module 'sre_:DeprecationWarning")]

from geometry_msgs.msg import PoseStamped  # noqa: E402  the extra brings them all
from std_msgs.msg import String  # noqa: E402
from std_srvs.srv import Trigger  # noqa: E402
from visualization_msgs.msg import Marker, MarkerArray  # noqa: E402

PATIENCE = 90.0  # seconds, on a busy machine; nothing is measured by it
ENDED = ("done", "failed", "stopped")


@pytest.fixture(scope="module", autouse=True)
def alone(tmp_path_factory: pytest.TempPathFactory) -> Iterator[None]:
    """No other test, and nobody on the network, hears this."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setenv("ROS_AUTOMATIC_DISCOVERY_RANGE", "LOCALHOST")
        patch.setenv("ROS_DOMAIN_ID", str(1 + os.getpid() % 100))
        patch.setenv("ROS_LOG_DIR", str(tmp_path_factory.mktemp("ros")))
        rclpy.init(args=["test"])
        yield
        rclpy.try_shutdown()


class Client:
    """Talks to the node `dcg_torch` of its own namespace, as somebody's program would."""

    def __init__(self, namespace: str) -> None:
        self.namespace = namespace
        self.node = rclpy.create_node("client", namespace=namespace)
        self.acknowledged: list[dict[str, Any]] = []
        self.understood: list[dict[str, Any]] = []
        self.goals: list[Any] = []
        self.words: list[str] = []
        self._processes: list[subprocess.Popen[bytes]] = []
        self._out: dict[str, Any] = {}
        self._listen(String, "dcg_torch/acknowledgement", lambda m: self.acknowledged.append(json.loads(m.data)))
        self._listen(String, "dcg_torch/understood", lambda m: self.understood.append(json.loads(m.data)))
        self._listen(PoseStamped, "goal_pose", self.goals.append)
        self._listen(MarkerArray, "dcg_torch/lexicon_markers", self._on_markers, depth=1)

    def _listen(self, kind: Any, topic: str, handle: Callable[[Any], object], depth: int = 1_000) -> None:
        self.node.create_subscription(kind, topic, handle, depth)

    def _on_markers(self, message: Any) -> None:
        self.words = [marker.text for marker in message.markers if marker.action == Marker.ADD]

    def start(self, module: str, *arguments: str, ros: tuple[str, ...] = ()) -> subprocess.Popen[bytes]:
        names = ("--ros-args", "-r", f"__ns:={self.namespace}", *(part for one in ros for part in ("-p", one)))
        process = subprocess.Popen([sys.executable, "-m", module, *arguments, *names])
        self._processes.append(process)
        return process

    def robot(self, *arguments: str) -> subprocess.Popen[bytes]:
        return self.start("dcg_torch.apps.ros.simulated", *arguments)

    def brain(self, *parameters: str) -> subprocess.Popen[bytes]:
        process = self.start("dcg_torch.ros", ros=("look_timeout:=20.0", *parameters))
        self.call("dcg_torch/lexicon")
        return process

    def spin(self, until: Callable[[], Any], seconds: float = PATIENCE) -> bool:
        ends = time.monotonic() + seconds
        while not until() and time.monotonic() < ends:
            rclpy.spin_once(self.node, timeout_sec=0.05)
        return bool(until())

    def call(self, service: str) -> str:
        """A call may go to a node that was killed a moment ago, so it is made again."""
        client = self.node.create_client(Trigger, service)
        assert client.wait_for_service(PATIENCE), f"no service {service}"
        for _ in range(10):
            future = client.call_async(Trigger.Request())
            if self.spin(future.done, PATIENCE / 10):
                break
        response = future.result()
        assert response is not None, f"no answer of {service}"
        assert response.success, response.message
        return str(response.message)

    def publish(self, topic: str, message: Any) -> None:
        if topic not in self._out:
            self._out[topic] = self.node.create_publisher(type(message), topic, 1_000)
        out = self._out[topic]
        assert self.spin(lambda: out.get_subscription_count() > 0), f"nobody listens to {topic}"
        out.publish(message)

    def say(self, kind: str, text: str, id_: str | None = None) -> None:
        data = text if id_ is None else json.dumps({"id": id_, "text": text})
        self.publish(f"dcg_torch/{kind}", String(data=data))

    def ended(self, id_: str | None) -> list[dict[str, Any]]:
        return [a for a in self.acknowledged if a["id"] == id_ and a["state"] in ENDED]

    def result(self, id_: str | None) -> dict[str, Any]:
        assert self.spin(lambda: self.ended(id_)), f"{id_} never ended: {self.acknowledged[-5:]}"
        return self.ended(id_)[0]

    def known(self) -> dict[str, dict[str, Any]]:
        words = json.loads(self.call("dcg_torch/lexicon"))["words"]
        return {word["word"]: word for word in words}

    def close(self) -> list[int]:
        for process in self._processes:
            if process.poll() is None:
                process.send_signal(signal.SIGTERM)
        statuses = [process.wait(30.0) for process in self._processes]
        self.node.destroy_node()
        return statuses


@pytest.fixture
def client(request: pytest.FixtureRequest) -> Iterator[Client]:
    made = Client(f"/{request.node.name.split('[')[0]}_{os.getpid()}")
    yield made
    made.close()


def test_the_laboratory_demonstration_over_topics(client: Client) -> None:
    client.robot()
    client.brain("model:=paper")
    kinds: dict[str, list[bool]] = {}
    for word in ("cone", "cube", "crate"):
        client.call("reset")
        client.say("command", f"move towards the {word}", word)
        assert client.result(word)["object"] == word
        looks = [one for one in client.understood if one["id"] == word]
        assert looks[-1]["object"] == word
        assert sum(looks[-1]["probabilities"].values()) == pytest.approx(1.0)
        kinds[word] = [one["unseen"] for one in looks]
    assert kinds["cone"] == [False]  # in view: no turning
    for word in ("cube", "crate"):
        assert kinds[word] == [True] * (len(kinds[word]) - 1) + [False]
        assert len(kinds[word]) > 2
    # The cone's and the crate's words were learned, which is why the crate was not taken for the cone.
    assert [client.ended(w)[0]["learned"] for w in kinds] == [{"cone": "traffic cone"}, None, {"crate": "crate"}]
    assert {word: client.known()[word]["types"] for word in ("cone", "crate")} == {
        "cone": [["traffic cone", 1.0]],
        "crate": [["crate", 1.0]],
    }
    assert client.spin(lambda: "crate 100 %" in client.words)


def test_lost_and_doubled_commands_are_each_carried_out_once(client: Client) -> None:
    """Of the commands a share gets lost, a share comes twice, and the robot's own messages fare likewise."""
    client.robot("--fake", "--rate", "20", "--lose", "0.1", "--double", "0.1")
    client.brain("queue:=1000", "resend:=0.2")
    rng, count = random.Random(0), 30
    meant = {f"c{k}": rng.choice(("cone", "cube", "crate")) for k in range(count)}
    for id_, word in meant.items():
        for _ in range(rng.choices((0, 1, 2), (1, 4, 1))[0]):
            client.say("command", f"move towards the {word}", id_)
        client.spin(lambda: False, 0.05)
    while left := [id_ for id_ in meant if not client.ended(id_)]:  # what was lost is sent again
        before = len(client.acknowledged)
        for id_ in left:
            client.say("command", f"move towards the {meant[id_]}", id_)
        assert client.spin(lambda: len(client.acknowledged) > before + len(left))  # noqa: B023
        client.spin(lambda: all(map(client.ended, left)), 5.0)
    assert {id_: client.ended(id_)[0].get("object") for id_ in meant} == meant
    firsts = Counter(a["id"] for a in client.acknowledged if a["state"] in ENDED and not a.get("repeated"))
    assert firsts == dict.fromkeys(meant, 1)
    heard = Counter(meant.values())
    known = client.known()
    for word, type_ in (("cone", "traffic cone"), ("crate", "crate")):
        assert known[word]["commands"] == heard[word]
        assert max(known[word]["types"], key=lambda item: item[1])[0] == type_


def bad_markers() -> MarkerArray:
    """A cone among what no robot can see."""
    nan, nameless, strange, cone = (Marker(ns=name, text="crate") for name in ("nan", "nameless", "strange", "cone"))
    nan.pose.position.x = float("nan")
    nameless.text = "  "
    strange.header.frame_id = "the_moon"
    cone.text, cone.pose.position.x = "traffic cone", 1.5
    cone.scale.x = cone.scale.y = cone.scale.z = 0.3
    return MarkerArray(markers=[nan, nameless, strange, cone, Marker(ns="cone", text="cube")])


def test_malformed_messages_are_left_out_and_the_node_restarts_in_the_middle(client: Client, tmp_path: Path) -> None:
    state = f"state:={tmp_path / 'state'}"
    node = client.brain(state, "model:=paper", "drive_timeout:=60.0")
    here, nowhere, giant = PoseStamped(), PoseStamped(), MarkerArray(markers=[Marker(text="x" * 50)] * 20_000)
    here.pose.orientation.w = 1.0
    nowhere.pose.position.x = float("inf")
    for topic, bad in (("pose", nowhere), ("percepts", giant), ("goal_result", String(data='{"goal": 1e999}'))):
        client.publish(topic, bad)
    for data in ("", "{", '{"text": 5}', "x" * 5_000):
        client.say("command", data)
    assert client.spin(lambda: sum(a["state"] == "refused" for a in client.acknowledged) == 4)

    def obey(id_: str) -> dict[str, Any]:
        """A robot of a few lines: it stands where it is sent, and sees a cone."""
        client.say("command", "move towards the cone", id_)
        ends = time.monotonic() + PATIENCE
        while not client.ended(id_) and time.monotonic() < ends:
            client.publish("pose", nowhere)
            client.publish("pose", client.goals[-1] if client.goals else here)
            client.publish("percepts", bad_markers())
            client.spin(lambda: client.ended(id_), 0.1)
        return client.result(id_)

    assert obey("1")["learned"] == {"cone": "traffic cone"}
    assert client.understood[-1]["probabilities"].keys() >= {"cone"}
    assert not {"nan", "nameless", "strange"} & client.understood[-1]["probabilities"].keys()
    node.kill()
    node.wait(30.0)
    client.acknowledged.clear()
    client.brain(state, "model:=paper")
    assert client.known()["cone"]["types"] == [["traffic cone", 1.0]]
    goals = len(client.goals)
    client.say("command", "move towards the cone", "1")  # as of a client that missed the acknowledgement
    assert client.result("1")["repeated"]
    assert len(client.goals) == goals
    assert obey("2")["object"] == "cone"
    assert client.call("dcg_torch/save").startswith(str(tmp_path))


def test_a_wrong_parameter_is_one_line() -> None:
    arguments = [sys.executable, "-m", "dcg_torch.ros", "--ros-args", "-p", "ask_below:=2.0"]
    done = subprocess.run(arguments, capture_output=True, text=True, check=False)
    assert (done.returncode, done.stderr.count("\n")) == (2, 1), done.stderr
    assert "ask_below" in done.stderr
