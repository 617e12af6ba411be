"""The robot's body: two driven wheels, and what the wheels have done.

Conventions: speeds are in m/s forward and rad/s to the left; the pose is that of the point between the wheels.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from pathlib import Path

from dcg_torch.simulator.client import STEP, Client
from dcg_torch.simulator.engine import pybullet
from dcg_torch.types import Pose

ROBOT_RADIUS = 0.178
"""Metres; nothing of the robot is farther from its middle, seen from above."""
MAX_SPEED, MAX_TURN = 0.65, 2.0  # m/s, rad/s: the TurtleBot 2's own limit, and a brisk turn
_ACCELERATION, _TURN_ACCELERATION = 1.2, 6.0  # m/s2, rad/s2
_TICK_STEPS = 2
TICK = _TICK_STEPS * STEP
"""Seconds between two commands to the wheels (30 Hz)."""
_WHEEL_RADIUS, _HALF_TRACK = 0.038, 0.115  # metres, as in robot.urdf
_WHEELS = ("left_wheel_joint", "right_wheel_joint")
_MODEL = Path(__file__).parent / "models" / "robot.urdf"
_TORQUE = 4.0  # N m, at most, for each wheel


def add_robot(client: int, pose: Pose, *, shown: bool = True) -> int:
    """Put the robot into the physics client of this number, standing at `pose`; its body number.

    Args:
        shown: it has looks; without them it takes half of the time. Its own camera never sees it.
    """
    flags = pybullet.URDF_USE_INERTIA_FROM_FILE | (0 if shown else pybullet.URDF_IGNORE_VISUAL_SHAPES)
    turn = pybullet.getQuaternionFromEuler([0.0, 0.0, pose.yaw])
    body: int = pybullet.loadURDF(str(_MODEL), [pose.x, pose.y, 0.0], turn, flags=flags, physicsClientId=client)
    if not shown:  # what can collide would be drawn in place of looks
        for link in range(-1, pybullet.getNumJoints(body, physicsClientId=client)):
            pybullet.changeVisualShape(body, link, rgbaColor=[0.0] * 4, physicsClientId=client)
    return body


class Base:
    """The robot's body in a physics client, driven by the velocities of its wheels alone.

    `path_length` (metres), `turned` (radians, both directions positive) and `collisions` (how often it came to
    touch an object) count from the start. `heading` is the yaw without its wrap at pi. `on_tick` is called with the
    pose at every `observed`-th tick.
    """

    def __init__(self, client: Client, start: Pose, observed: int = 3) -> None:
        self._client = client
        self._observed = observed
        self.body = add_robot(client.id, start, shown=client.gui)
        names = [
            pybullet.getJointInfo(self.body, joint, physicsClientId=client.id)[1].decode()
            for joint in range(pybullet.getNumJoints(self.body, physicsClientId=client.id))
        ]
        self._wheels = [names.index(name) for name in _WHEELS]
        self.pose = client.pose(self.body)
        self.heading = self.pose.yaw
        self.path_length = 0.0
        self.turned = 0.0
        self.collisions = 0
        self.seconds = 0.0
        self.on_tick: Callable[[Pose], None] | None = None
        self.speed = 0.0
        self.turn = 0.0
        self._touching: set[int] = set()
        self._ticks = 0

    def tick(self, speed: float, turn: float) -> None:
        """Run for `TICK` seconds, as near to these speeds as the greatest accelerations allow."""
        self.speed = _step_towards(self.speed, speed, _ACCELERATION * TICK)
        self.turn = _step_towards(self.turn, turn, _TURN_ACCELERATION * TICK)
        side = self.turn * _HALF_TRACK
        pybullet.setJointMotorControlArray(
            self.body,
            self._wheels,
            pybullet.VELOCITY_CONTROL,
            targetVelocities=[(self.speed - side) / _WHEEL_RADIUS, (self.speed + side) / _WHEEL_RADIUS],
            forces=[_TORQUE, _TORQUE],
            physicsClientId=self._client.id,
        )
        self._client.step(_TICK_STEPS)
        self._count()

    def halt(self) -> None:
        """Brake to a stand, and let the body come to rest; nothing happens if it stands."""
        if not (self.speed or self.turn):
            return
        while self.speed or self.turn:
            self.tick(0.0, 0.0)
        for _ in range(3):
            self.tick(0.0, 0.0)

    def _count(self) -> None:
        before, now = self.pose, self._client.pose(self.body)
        turned = math.remainder(now.yaw - before.yaw, math.tau)
        self.path_length += math.hypot(now.x - before.x, now.y - before.y)
        self.turned += abs(turned)
        self.heading += turned
        self.pose = now
        touching = self._client.touching(self.body)
        self.collisions += len(touching - self._touching)
        self._touching = touching
        self.seconds += TICK
        self._ticks += 1
        if self.on_tick is not None and self._ticks % self._observed == 0:
            self.on_tick(now)


def turn_towards(error: float, gain: float = 3.0) -> float:
    """The turning speed (rad/s) at which an angle `error` (radians) can still be stopped at.

    The last of the way is slowed down in proportion, by `gain` (1/s): gentle while driving, brisk in place.
    """
    size = min(MAX_TURN, math.sqrt(1.4 * _TURN_ACCELERATION * abs(error)), gain * abs(error))
    return math.copysign(size, error)


def speed_towards(distance: float) -> float:
    """The speed (m/s) at which a stop within `distance` (metres) is still possible."""
    distance = max(0.0, distance)
    return min(MAX_SPEED, math.sqrt(1.4 * _ACCELERATION * distance), 3.0 * distance)


def _step_towards(value: float, goal: float, most: float) -> float:
    return min(max(goal, value - most), value + most)
