"""`python -m dcg_torch.apps.ros.simulated [--world FILE] [--fake]`: the simulator's robot as a robot on topics.

It publishes `pose` and `percepts`, goes where `goal_pose` says, and says on `goal_result` how it fared. The service
`reset` puts it back to its start. `--lose` and `--double` make its messages as bad as a radio's.
"""

from __future__ import annotations

import argparse
import contextlib
import json
import random
import sys
import threading
from pathlib import Path
from typing import Any

import rclpy
from geometry_msgs.msg import PoseStamped
from rclpy.executors import ExternalShutdownException, SingleThreadedExecutor
from rclpy.utilities import remove_ros_args
from std_msgs.msg import String
from std_srvs.srv import Trigger
from visualization_msgs.msg import MarkerArray

from dcg_torch.apps.ros.messages import percept_markers, pose_message, read_pose, to_stamp
from dcg_torch.cli.application import one_line_errors
from dcg_torch.simulator import FakeRobot
from dcg_torch.simulator.bodies.colors import rgb
from dcg_torch.storage.arguments import Arguments
from dcg_torch.storage.resources import resource
from dcg_torch.types import DriveResult, Pose
from dcg_torch.types.geometry import wrap_angle
from dcg_torch.world.files import World, load_world

_FRAME = "map"


class SimulatedNode:
    """A simulated robot that is known by its messages; `run` in the thread that made the robot."""

    def __init__(self, robot: Any, world: World, rate: float, lose: float, double: float) -> None:
        self.ros = rclpy.create_node("robot")
        self._robot, self._world, self._period = robot, world, 1.0 / rate
        self._lose, self._double, self._rng = lose, double, random.Random(0)
        self._rgb = {o.id: rgb(o.color) for o in world.objects}
        self._changed = threading.Condition()
        self._goal: tuple[Pose, int] | None = None
        self._heeded = self._resets = self._reset_done = 0
        kinds = {"pose": PoseStamped, "percepts": MarkerArray, "goal_result": String}
        self._out = {topic: self.ros.create_publisher(kind, topic, 100) for topic, kind in kinds.items()}
        self.ros.create_subscription(PoseStamped, "goal_pose", self._on_goal, 100)
        self.ros.create_service(Trigger, "reset", self._on_reset)

    def run(self) -> None:
        """Go where it is sent, and say what it sees `rate` times a second while it stands."""
        self._robot.load(self._world)
        self._robot.on_tick = self._say_pose
        while rclpy.ok():
            self._say_all()
            with self._changed:
                self._changed.wait_for(lambda: self._goal or self._resets > self._reset_done, self._period)
                goal, self._goal = self._goal, None
                resets = self._resets
                self._interrupt("resume")
            if resets > self._reset_done:
                self._robot.load(self._world)
                self._say_all()
                with self._changed:
                    self._reset_done = resets
                    self._changed.notify_all()
            elif goal is not None:
                result = self._go(goal[0])
                self._say_all()
                self._publish("goal_result", String(data=json.dumps({"goal": goal[1], "result": result.value})))

    def _go(self, goal: Pose) -> DriveResult:
        """To the place, then to the heading."""
        here = self._robot.pose
        result = DriveResult.ARRIVED
        if abs(here.x - goal.x) + abs(here.y - goal.y) > 0.02:
            result = self._robot.go_to(goal.x, goal.y, ())
        if result:
            self._robot.spin(wrap_angle(goal.yaw - self._robot.pose.yaw))
        return result

    def _on_goal(self, message: Any) -> None:
        stamp = to_stamp(message.header.stamp)
        with self._changed, contextlib.suppress(ValueError):
            if stamp <= self._heeded or self._rng.random() < self._lose:
                return
            self._goal, self._heeded = (read_pose(message.pose), stamp), stamp
            self._interrupt("stop")
            self._changed.notify_all()

    def _on_reset(self, _: Any, response: Any) -> Any:
        with self._changed:
            self._resets += 1
            wanted = self._resets
            self._goal = None
            self._interrupt("stop")
            self._changed.notify_all()
            response.success = self._changed.wait_for(lambda: self._reset_done >= wanted, 30.0)
        return response

    def _interrupt(self, method: str) -> None:
        """The fake robot is wherever it is sent at once, so there is nothing to stop."""
        getattr(self._robot, method, lambda: None)()

    def _say_all(self) -> None:
        self._say_pose(self._robot.pose)
        self._publish("percepts", percept_markers(self._robot.perceive(), self._rgb, _FRAME, self._now()))

    def _say_pose(self, pose: Pose) -> None:
        self._publish("pose", pose_message(pose, _FRAME, self._now()))

    def _publish(self, topic: str, message: Any) -> None:
        times = 0 if self._rng.random() < self._lose else 2 if self._rng.random() < self._double else 1
        for _ in range(times):
            try:
                self._out[topic].publish(message)
            except RuntimeError:  # rclpy's errors are no better told apart
                if rclpy.ok():  # else it was asked to end meanwhile, and `run` is about to notice
                    raise

    def _now(self) -> int:
        return int(self.ros.get_clock().now().nanoseconds)


def _arguments() -> argparse.Namespace:
    parser = Arguments(prog="python -m dcg_torch.apps.ros.simulated", description=__doc__)
    parser.add_argument("--world", type=Path, help="a world file; by default the paper's laboratory")
    parser.add_argument("--fake", action="store_true", help="pure geometry instead of PyBullet")
    parser.add_argument("--gui", action="store_true", help="open PyBullet's window")
    parser.add_argument("--rate", type=float, default=10.0, help="looks a second while it stands")
    parser.add_argument("--lose", type=float, default=0.0, help="share of its messages and goals that get lost")
    parser.add_argument("--double", type=float, default=0.0, help="share of its messages that come twice")
    return parser.parse_args(remove_ros_args(sys.argv)[1:])


def main() -> int:
    """Run the robot until it is asked to end."""
    arguments = _arguments()
    with one_line_errors(), contextlib.ExitStack() as stack:
        world = load_world(arguments.world or resource("worlds") / "hardware" / "laboratory.yaml")
        if arguments.fake:
            robot: Any = FakeRobot()
        else:
            from dcg_torch.simulator import SimulatedRobot  # here: the fake robot needs no PyBullet

            robot = stack.enter_context(SimulatedRobot(gui=arguments.gui))
        rclpy.init(args=sys.argv)
        stack.callback(rclpy.try_shutdown)
        node = SimulatedNode(robot, world, arguments.rate, arguments.lose, arguments.double)
        executor = SingleThreadedExecutor()
        executor.add_node(node.ros)
        listener = threading.Thread(target=_spin, args=(executor,), daemon=True)
        listener.start()
        node.run()
        listener.join(5.0)  # what it uses goes away with this function
    return 0


def _spin(executor: Any) -> None:
    with contextlib.suppress(ExternalShutdownException):
        executor.spin()


if __name__ == "__main__":
    sys.exit(main())
