"""The simulated robot: it perceives through its camera and moves by its wheels (Alg. 1, lines 8, 13 and 15)."""

from __future__ import annotations

import contextlib
import math
from collections.abc import Callable, Iterable
from dataclasses import dataclass
from types import TracebackType

import numpy as np
from numpy.typing import NDArray

from dcg_torch.simulator import navigation
from dcg_torch.simulator.base import MAX_SPEED, ROBOT_RADIUS, Base, speed_towards, turn_towards
from dcg_torch.simulator.bodies import add_object, extent, footprint
from dcg_torch.simulator.camera import Camera, Recogniser, bearing, view_from
from dcg_torch.simulator.client import Client, SimulatorError
from dcg_torch.simulator.navigation import Circle, Points, Track
from dcg_torch.simulator.window import OPTIONS, Window
from dcg_torch.types import Percept, Pose
from dcg_torch.world.files import World

ARRIVED = 0.5
"""Metres from the middle of an object within which the robot has arrived at it."""
LEFT = 1.5
"""Metres from the middle of an object beyond which the robot has left its surroundings."""

_REACH = 0.47  # metres from the target's middle at which a drive is planned to end
_MARGINS = (0.08, 0.03)  # metres between robot and objects; the second where the first leaves no way
_BERTHS = (1.05, 0.85, 0.70)  # metres from the middle of what is to be avoided, the widest possible first
_LOOK_SECONDS, _LOOK_ANGLE = 0.4, 0.35  # while driving, look this often (simulated seconds; radians turned)
_LOOKAHEAD = 0.25  # metres along the path, where the robot steers to
_SPIN_GAIN = 7.0  # 1/s, see `turn_towards`
_FACING = 0.5  # radians off course, beyond which it turns without driving on
_UNKNOWN_RADIUS = 0.22  # metres, for a percept that says no size


@dataclass(frozen=True, slots=True)
class _Placed:
    """An object of the world: the truth about it, and what the recogniser takes it for (None: nothing)."""

    percept: Percept
    recognised: Percept | None
    radius: float


class SimulatedRobot:
    """A `trial.robot.Robot` in a physics client of its own. Load a world before asking it anything.

    Args:
        camera: what the robot sees with.
        recogniser: how well it names what it sees; perfect by default.
        rng: draws the recogniser's mistakes at each `load`; needed only if it makes any.
        gui: open PyBullet's window.

    Attributes:
        on_tick: called with the pose about ten times per simulated second while the robot moves.

    Raises:
        SimulatorError: there is no screen for the window.
        ValueError: the recogniser makes mistakes, and there is no `rng`.
    """

    def __init__(
        self,
        *,
        camera: Camera | None = None,
        recogniser: Recogniser | None = None,
        rng: np.random.Generator | None = None,
        gui: bool = False,
        on_tick: Callable[[Pose], None] | None = None,
    ) -> None:
        self.camera = camera or Camera()
        self.recogniser = recogniser or Recogniser()
        if rng is None and (self.recogniser.wrong_class or self.recogniser.missed):
            raise ValueError("a recogniser that makes mistakes needs an rng to draw them from")
        self._rng = rng or np.random.default_rng(0)
        self.on_tick = on_tick
        self.client = Client(gui=gui, options=OPTIONS)
        self._window = Window(self.client.id) if gui else None
        self._loaded: tuple[World, Base] | None = None
        self._by_body: dict[int, _Placed] = {}
        self._noticed: dict[str, Percept] = {}

    def __enter__(self) -> SimulatedRobot:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, value: BaseException | None, traceback: TracebackType | None
    ) -> None:
        self.close()

    def close(self) -> None:
        """Let go of the physics client; a second call does nothing."""
        self.client.close()

    def load(self, world: World, *, rng: np.random.Generator | None = None) -> None:
        """Go to the start pose of `world`, with all counters at zero.

        What happens in a world doesn't depend on those visited before, but for the state of the generator that
        draws the recogniser's mistakes; give another `rng` to be free of that too.

        Raises:
            SimulatorError: an object of a type or colour that the simulator doesn't have, or one that stands where
                the robot starts.
        """
        with self._window.still() if self._window else contextlib.nullcontext():
            self._load(world, self._rng if rng is None else rng)

    def _load(self, world: World, rng: np.random.Generator) -> None:
        self._loaded = None
        self.client.empty()
        base = Base(self.client, world.start)
        labels = self.recogniser.labels([o.type for o in world.objects], rng)
        self._by_body, self._noticed = {}, {}
        for item, label in zip(world.objects, labels, strict=True):
            try:
                body = add_object(self.client.id, item.type, item.color, item.position, item.yaw)
            except ValueError as error:
                raise SimulatorError(f"world {world.name}: {item.id}: {error}") from None
            percept = Percept(item.id, item.type, item.color, (*item.position, 0.0), extent(item.type))
            recognised = None if label is None else Percept(item.id, label, item.color, percept.position, percept.size)
            radius = footprint(item.type)
            if math.dist(item.position, (world.start.x, world.start.y)) < radius + ROBOT_RADIUS:
                raise SimulatorError(f"world {world.name}: {item.id} stands where the robot starts; move one of them")
            self._by_body[body] = _Placed(percept, recognised, radius)
        self._loaded = world, base
        if self._window:
            self._window.show(world, base.body, self.camera)

    def say(self, text: str) -> None:
        """Write a line into the window, if there is one."""
        if self._window:
            self._window.say(text)

    @property
    def world(self) -> World:
        """The world the robot is in."""
        return self._state()[0]

    @property
    def bodies(self) -> dict[str, int]:
        """Object id -> body number in the physics client."""
        return {placed.percept.id: body for body, placed in self._by_body.items()}

    @property
    def pose(self) -> Pose:
        """Where the robot is."""
        return self._base.pose

    @property
    def path_length(self) -> float:
        """Metres driven since the world was loaded."""
        return self._base.path_length

    @property
    def turned(self) -> float:
        """Radians turned since the world was loaded, both directions counted positive."""
        return self._base.turned

    @property
    def collisions(self) -> int:
        """How often the robot has come to touch an object since the world was loaded."""
        return self._base.collisions

    @property
    def seconds(self) -> float:
        """Simulated seconds that the robot has moved since the world was loaded."""
        return self._base.seconds

    def perceive(self) -> list[Percept]:
        """The recognised objects in view, in the order of the bearing from the middle of the view outwards."""
        seen = [placed.recognised for placed in self._look() if placed.recognised is not None]
        return sorted(seen, key=lambda percept: (abs(bearing(self.pose, percept)), percept.id))

    def picture(self, *, width: int = 320, height: int = 180) -> NDArray[np.uint8]:
        """What the camera sees, as (height, width, 3) bytes."""
        return self.camera.picture(self.client, self.pose, width=width, height=height)

    def picture_from(
        self,
        eye: tuple[float, float, float],
        towards: tuple[float, float, float],
        *,
        up: tuple[float, float, float] = (0.0, 0.0, 1.0),
        width: int = 320,
        height: int = 240,
    ) -> NDArray[np.uint8]:
        """The world with the robot in it from anywhere, as (height, width, 3) bytes (see `camera.view_from`)."""
        return view_from(self.client, eye, towards, up=up, width=width, height=height)

    def spin(self, angle: float) -> None:
        """Turn in place by `angle` radians, left positive, to within 0.02.

        Raises:
            ValueError: `angle` is not a finite number.
        """
        if not math.isfinite(angle):
            raise ValueError(f"can't turn by {angle} radians")
        base = self._base
        goal = base.heading + angle
        deadline = base.seconds + 5.0 + abs(angle)
        while (abs(goal - base.heading) > 0.004 or abs(base.turn) > 0.05) and base.seconds < deadline:
            base.tick(0.0, turn_towards(goal - base.heading, _SPIN_GAIN))
        base.halt()

    def drive_to(self, target: str, percepts: list[Percept], *, avoid: frozenset[str] = frozenset()) -> bool:
        """Drive to the object `target` round all others; True when it ended within 0.5 m of it.

        The robot goes round `percepts` and whatever else it has seen in this world or notices on the way. From the
        objects `avoid` it keeps a metre away, where there is room. False: there is no way, or it got stuck.

        Raises:
            ValueError: `target` is not among the percepts.
        """
        goal = _find(target, percepts)
        avoid = avoid - {target}

        def plan(obstacles: dict[str, Circle]) -> Points | None:
            others = [circle for id_, circle in obstacles.items() if id_ != target]
            return navigation.approach((self.pose.x, self.pose.y), obstacles[target], others, reach=_REACH)

        self._follow(plan, percepts, avoid)
        return self._distance(goal) <= ARRIVED

    def drive_away(self, target: str, percepts: list[Percept]) -> bool:
        """Leave the surroundings of `target`; True when it ended 1.5 m or more from it, and farther than before.

        Raises:
            ValueError: `target` is not among the percepts.
        """
        goal = _find(target, percepts)
        before = self._distance(goal)

        def plan(obstacles: dict[str, Circle]) -> Points | None:
            others = [circle for id_, circle in obstacles.items() if id_ != target]
            return navigation.retreat((self.pose.x, self.pose.y), obstacles[target], others)

        self._follow(plan, percepts, frozenset())
        return self._distance(goal) >= max(LEFT, before)

    def go_to(self, x: float, y: float, percepts: list[Percept]) -> bool:
        """Drive to a place, round all objects, to see what can be seen from there; True when within 0.1 m of it."""

        def plan(obstacles: dict[str, Circle]) -> Points | None:
            return navigation.shortest_path(
                (self.pose.x, self.pose.y), np.array([[x, y]], dtype=np.float64), list(obstacles.values())
            )

        self._follow(plan, percepts, frozenset())
        return math.dist((self.pose.x, self.pose.y), (x, y)) <= 0.1

    @property
    def _base(self) -> Base:
        return self._state()[1]

    def _state(self) -> tuple[World, Base]:
        if self._loaded is None:
            raise SimulatorError("the robot is in no world yet; load one first")
        # the observer may be changed at any time
        self._loaded[1].on_tick = self.on_tick
        return self._loaded

    def _look(self) -> list[_Placed]:
        """What the camera shows now; it is remembered as an obstacle, recognised or not."""
        counts = self.camera.pixels(self.client, self.pose)
        seen = [placed for body, placed in self._by_body.items() if counts.get(body, 0) >= self.recogniser.min_pixels]
        self._noticed.update((placed.percept.id, placed.percept) for placed in seen)
        return seen

    def _distance(self, percept: Percept) -> float:
        return math.dist((self.pose.x, self.pose.y), percept.position[:2])

    def _obstacles(
        self, percepts: Iterable[Percept], avoid: frozenset[str], berth: float, margin: float
    ) -> dict[str, Circle]:
        """Where the robot's middle must not go, by object."""
        radii = {placed.percept.id: placed.radius for placed in self._by_body.values()}
        circles = {}
        for percept in percepts:
            half = math.hypot(*percept.size[:2]) / 2 if percept.size else _UNKNOWN_RADIUS
            radius = radii.get(percept.id, half) + ROBOT_RADIUS + margin
            if percept.id in avoid:
                radius = max(radius, berth)
            circles[percept.id] = Circle(percept.position[0], percept.position[1], radius)
        return circles

    def _plan(
        self,
        plan: Callable[[dict[str, Circle]], Points | None],
        known: dict[str, Percept],
        avoid: frozenset[str],
    ) -> Track | None:
        """The first path found, from generous clearances to tight ones."""
        berths = (*_BERTHS, 0.0) if avoid else (0.0,)
        for margin in _MARGINS:
            for berth in berths:
                path = plan(self._obstacles(known.values(), avoid, berth, margin))
                if path is not None:
                    return Track(path)
        return None

    def _follow(
        self,
        plan: Callable[[dict[str, Circle]], Points | None],
        percepts: list[Percept],
        avoid: frozenset[str],
    ) -> None:
        """Plan and drive, looking on the way, planning anew when something is in the way; ends standing still."""
        base = self._base
        self._noticed |= {percept.id: percept for percept in percepts}
        known = dict(self._noticed)
        news = not known.keys() >= self.bodies.keys()  # else looking can change nothing, and only takes time
        track = self._plan(plan, known, avoid)
        looked_at, looked_towards = -math.inf, math.inf
        deadline = math.inf
        while track is not None:
            if deadline == math.inf:
                deadline = base.seconds + 15.0 + 4.0 * track.length / MAX_SPEED
            progress = track.progress(base.pose.x, base.pose.y)
            left = track.length - progress
            if base.seconds > deadline or (left < 0.01 and base.speed < 0.06):
                break
            ahead = track.point(progress + _LOOKAHEAD)
            course = math.atan2(ahead[1] - base.pose.y, ahead[0] - base.pose.x)
            error = math.remainder(course - base.heading, math.tau)
            if (
                news
                and abs(error) < _FACING
                and (base.seconds - looked_at >= _LOOK_SECONDS or abs(base.heading - looked_towards) > _LOOK_ANGLE)
            ):
                looked_at, looked_towards = base.seconds, base.heading
                self._look()
                new = {id_: percept for id_, percept in self._noticed.items() if id_ not in known}
                known |= new
                news = not known.keys() >= self.bodies.keys()
                in_the_way = list(self._obstacles(new.values(), avoid, _BERTHS[0], _MARGINS[0]).values())
                if not navigation.is_clear(track.rest(progress), in_the_way):
                    track = self._plan(plan, known, avoid)
                    deadline = math.inf
                    continue
            base.tick(speed_towards(left) * max(0.0, 1.0 - abs(error) / _FACING), turn_towards(error))
        base.halt()


def _find(target: str, percepts: list[Percept]) -> Percept:
    for percept in percepts:
        if percept.id == target:
            return percept
    raise ValueError(f"no percept of {target!r} to drive by; perceived are {sorted(p.id for p in percepts)}")
