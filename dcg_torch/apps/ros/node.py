"""The node: topics, services and parameters, wired to the worker.

Messages come in one thread, and what they ask for is done in another.
"""

from __future__ import annotations

import contextlib
import functools
import json
import signal
import threading
import time
from collections.abc import Callable, Iterator, Sequence
from dataclasses import fields
from pathlib import Path
from typing import Any

import rclpy
from geometry_msgs.msg import PoseStamped
from nav_msgs.msg import Odometry
from rcl_interfaces.msg import FloatingPointRange, IntegerRange, ParameterDescriptor
from rclpy.exceptions import InvalidParameterTypeException, InvalidParameterValueException
from rclpy.executors import ExternalShutdownException, SingleThreadedExecutor
from rclpy.qos import DurabilityPolicy, QoSProfile
from rclpy.serialization import deserialize_message
from rclpy.signals import SignalHandlerOptions
from std_msgs.msg import String
from std_srvs.srv import Trigger
from visualization_msgs.msg import MarkerArray

from dcg_torch.apps.ros.messages import lexicon_markers, lexicon_text, pose_message, read_percepts, read_pose, to_stamp
from dcg_torch.apps.ros.options import Options
from dcg_torch.apps.ros.robot import TopicRobot
from dcg_torch.apps.ros.senses import Senses
from dcg_torch.apps.ros.state import MARK, Store
from dcg_torch.apps.ros.tasks import Tasks
from dcg_torch.apps.ros.worker import Worker
from dcg_torch.learning.lexicon import Entry
from dcg_torch.lessons import initial_training
from dcg_torch.model import GroundingModel
from dcg_torch.model.checkpoint import load
from dcg_torch.model.pretrain import pretrained
from dcg_torch.storage.atomic_files import write_whole
from dcg_torch.storage.claim import claim
from dcg_torch.storage.errors import UserError
from dcg_torch.storage.untrusted_files import plain, shown
from dcg_torch.types import DriveResult, Percept, Pose

_MOST_BYTES = 2_000_000
"""Of a message: a larger one is refused before it is unpacked, which would take seconds."""
BURST = QoSProfile(depth=1_000)
"""So many messages may wait unread."""
KEPT = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)
"""Those who come later get the last one."""


class Node:
    """A `rclpy` node and what it says; `tasks.Outlet` is what the worker sees of it."""

    def __init__(self, name: str = "dcg_torch") -> None:
        self.ros = rclpy.create_node(name)
        try:
            self._declare()
        except (InvalidParameterTypeException, InvalidParameterValueException) as error:
            raise UserError(f"{error}; --help lists the parameters") from None
        self.senses = Senses()
        self._frame, self._robot_frame = self.options().frame, self.options().robot_frame
        self._goals = self.ros.create_publisher(PoseStamped, "goal_pose", BURST)
        self._texts = {
            topic: self.ros.create_publisher(String, f"~/{topic}", KEPT if topic == "lexicon" else BURST)
            for topic in ("acknowledgement", "understood", "question", "lexicon")
        }
        self._markers = self.ros.create_publisher(MarkerArray, "~/lexicon_markers", KEPT)
        self._shown = ""

    def options(self) -> Options:
        """The parameters as they are now."""
        return Options(**{one.name: self.ros.get_parameter(one.name).value for one in fields(Options)})

    def _declare(self) -> None:
        for one in fields(Options):
            low, high = one.metadata["low"], one.metadata["high"]
            described = ParameterDescriptor(description=one.metadata["help"], read_only=one.metadata["fixed"])
            if isinstance(one.default, float):
                described.floating_point_range = [FloatingPointRange(from_value=low, to_value=high)]
            elif low is not None:
                described.integer_range = [IntegerRange(from_value=low, to_value=high)]
            self.ros.declare_parameter(one.name, one.default, described)

    def say(self, topic: str, text: str) -> None:
        """Publish a text under the node's name."""
        self._texts[topic].publish(String(data=text))

    def show(self, entries: list[Entry], percepts: tuple[Percept, ...]) -> None:
        """Publish the lexicon where it changed, and its markers."""
        text = lexicon_text(entries)
        if text != self._shown:
            self._shown = text
            self.say("lexicon", text)
        self._markers.publish(lexicon_markers(entries, percepts, self._frame))

    def complain(self, text: str) -> None:
        """Log an error."""
        self.ros.get_logger().error(text)

    def send(self, goal: Pose, stamp: int) -> None:
        """Send the robot somewhere."""
        self._goals.publish(pose_message(goal, self._frame, stamp))

    def listen(self, worker: Worker, tasks: Tasks) -> None:
        """Take messages and calls; what the robot says before what people say."""
        self._take(PoseStamped, "pose", lambda m: self._on_pose(m.header, m.pose))
        self._take(Odometry, "odom", lambda m: self._on_pose(m.header, m.pose.pose))
        self._take(MarkerArray, "percepts", self._on_percepts)
        self._take(String, "goal_result", lambda m: self._on_result(m.data))
        for kind in ("command", "teach", "correct", "forget"):
            self._take(String, f"~/{kind}", functools.partial(lambda k, m: worker.accept(k, m.data), kind))
        self._take(String, "~/answer", lambda m: tasks.answer(m.data))
        self._serve("stop", lambda: (True, worker.stop()))
        self._serve("save", worker.save)
        self._serve("lexicon", lambda: (True, worker.lexicon()))

    def _take(self, kind: Any, topic: str, handle: Callable[[Any], object]) -> None:
        def on_bytes(data: bytes) -> None:
            try:
                if len(data) > _MOST_BYTES:
                    raise ValueError(f"a message of {len(data)} bytes")
                handle(deserialize_message(data, kind))
            except Exception as error:  # whatever a message holds, the next one must be heard
                self._refuse(topic, plain(str(error) or type(error).__name__, 200))

        self.ros.create_subscription(kind, topic, on_bytes, BURST, raw=True)

    def _serve(self, name: str, act: Callable[[], tuple[bool, str]]) -> None:
        def on_call(_: Any, response: Any) -> Any:
            try:
                response.success, response.message = act()
            except Exception as error:  # as above
                response.success, response.message = False, f"{type(error).__name__}: {plain(str(error), 200)}"
                self.complain(response.message)
            return response

        self.ros.create_service(Trigger, f"~/{name}", on_call)

    def _refuse(self, topic: str, why: str) -> None:
        self.senses.refused = f"{topic}: {why}"
        self.ros.get_logger().warning(f"{topic}: left out: {why}", throttle_duration_sec=5.0)

    def _on_pose(self, header: Any, pose: Any) -> None:
        own = header.frame_id.lstrip("/")
        if own not in ("", self._frame):
            raise ValueError(f"in the frame {shown(own)}, which is not the parameter frame, {self._frame!r}")
        self.senses.put_pose(read_pose(pose), to_stamp(header.stamp))

    def _on_percepts(self, message: Any) -> None:
        markers = message.markers
        most = self.options().most_objects
        percepts, wrong = read_percepts(markers, self._frame, self._robot_frame, self.senses.here(), most)
        self.senses.put_look(percepts, max((to_stamp(m.header.stamp) for m in markers[: most + 1]), default=0))
        if wrong:
            self._refuse("percepts", wrong)

    def _on_result(self, data: str) -> None:
        try:
            said = json.loads(data[:1_000])
            self.senses.put_result(int(said["goal"]), DriveResult(said["result"]))
        except (KeyError, TypeError, ArithmeticError, RecursionError):
            raise ValueError('write {"goal": STAMP, "result": "arrived"}') from None


def _first_model(name: str) -> GroundingModel:
    if name == "shipped":
        return pretrained()
    return GroundingModel.trained(initial_training()) if name == "paper" else load(Path(name))


@contextlib.contextmanager
def _signals(close: Callable[[], None]) -> Iterator[None]:
    """End cleanly when the process is asked to end."""
    numbers = (signal.SIGINT, signal.SIGTERM, signal.SIGHUP)
    heeded = [number for number in numbers if signal.getsignal(number) is not signal.SIG_IGN]  # not under nohup
    before = {n: signal.signal(n, lambda *_: threading.Thread(target=close).start()) for n in heeded}
    try:
        yield
    finally:
        for number, handler in before.items():
            signal.signal(number, handler)


def serve(arguments: Sequence[str], began: float) -> None:
    """Run the node until it is asked to end; `began` is when the process did, by `time.perf_counter`.

    Raises:
        UserError: a parameter makes no sense, or the model or the folder cannot be used.
    """
    rclpy.init(args=["dcg_torch", *arguments], signal_handler_options=SignalHandlerOptions.NO)
    with contextlib.ExitStack() as stack:
        stack.callback(rclpy.try_shutdown)
        node = Node()
        options = node.options()
        store, model, handled = None, None, {}
        if options.state:
            directory = Path(options.state)
            stack.enter_context(claim(directory, {MARK}, setting="state"))
            write_whole(directory / MARK, "[]\n") if not (directory / MARK).exists() else None
            store = Store(directory)
            model, handled = store.restore() or (None, {})
        model = model or _first_model(options.model)
        robot = TopicRobot(node.senses, node.send, node.options)
        tasks = Tasks(model, node.senses, robot, node.options, node)
        worker = Worker(tasks, node.senses, robot, node.options, node, store, handled)
        node.listen(worker, tasks)
        executor = SingleThreadedExecutor()
        executor.add_node(node.ros)
        listener = threading.Thread(target=_spin, args=(executor,), daemon=True)
        listener.start()
        node.ros.get_logger().info(f"ready after {time.perf_counter() - began:.1f} s")
        with _signals(worker.close):
            worker.run()
        executor.shutdown()
        listener.join(2.0)


def _spin(executor: Any) -> None:
    with contextlib.suppress(ExternalShutdownException):
        executor.spin()
