"""The simulated robot: it perceives through its camera and moves by its wheels (Alg. 1, lines 8, 13 and 15)."""

from __future__ import annotations

import contextlib
import math
import threading
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from dcg_torch.simulator import navigation
from dcg_torch.simulator.bodies import add_object, extent, footprint
from dcg_torch.simulator.camera import Camera
from dcg_torch.simulator.client import Client, Closing
from dcg_torch.simulator.driver import Driver, Planner
from dcg_torch.simulator.errors import SimulatorError
from dcg_torch.simulator.limits import ARRIVED, AT_PLACE, LEFT, MAX_DISTANCE, check_spin, find_percept
from dcg_torch.simulator.navigation import Circle
from dcg_torch.simulator.recogniser import Recogniser
from dcg_torch.simulator.view import Pixels
from dcg_torch.simulator.wheels import ROBOT_RADIUS, Base
from dcg_torch.simulator.window import OPTIONS, Window
from dcg_torch.types import DriveResult, Percept, Pose
from dcg_torch.types.arrays import Points
from dcg_torch.types.geometry import bearing
from dcg_torch.world.files import World, WorldObject


@dataclass(frozen=True, slots=True)
class _Placed:
    """An object of the world: the truth about it, and what the recogniser takes it for (None: nothing)."""

    percept: Percept
    recognised: Percept | None
    radius: float


@dataclass(frozen=True, slots=True)
class _Visit:
    """The world that the robot is in, its body there, and what moves it."""

    world: World
    base: Base
    driver: Driver


class SimulatedRobot(Closing):
    """An `agent.robot.SimulationRobot` in a physics client of its own. Load a world before asking it anything.

    Another thread may call `stop`, to end what it is doing; the robot then stands until `resume` or the next world.

    Args:
        camera: what the robot sees with.
        recogniser: how well it names what it sees; perfect by default.
        rng: draws the recogniser's mistakes at each `load`; needed only if it makes any.
        gui: open PyBullet's window.
        observed: ticks between two calls of `on_tick`, at 30 ticks to a simulated second.

    Attributes:
        on_tick: called with the pose while the robot moves; it may be changed at any time.

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
        observed: int = 3,
    ) -> None:
        self.camera = camera or Camera()
        self.recogniser = recogniser or Recogniser()
        if rng is None and (self.recogniser.wrong_class or self.recogniser.missed):
            raise ValueError("a recogniser that makes mistakes needs an rng to draw them from")
        self._rng = rng or np.random.default_rng(0)
        self.on_tick: Callable[[Pose], None] | None = None
        self._observed = observed
        self.client = Client(gui=gui, options=OPTIONS)
        self._window = Window(self.client.id) if gui else None
        self._loaded: _Visit | None = None
        self._stop = threading.Event()
        self._by_body: dict[int, _Placed] = {}
        self._noticed: dict[str, Percept] = {}

    def close(self) -> None:
        """Let go of the physics client; a second call does nothing."""
        self.client.close()

    def load(self, world: World, *, rng: np.random.Generator | None = None) -> None:
        """Go to the start pose of `world`, with all counters at zero.

        What happens in a world doesn't depend on those visited before, but for the state of the generator that
        draws the recogniser's mistakes; give another `rng` to be free of that too.

        Raises:
            SimulatorError: an object of a type or colour that the simulator doesn't have, or one that stands where
                the robot starts or more than `limits.MAX_DISTANCE` away.
        """
        with self._window.still() if self._window else contextlib.nullcontext():
            self._load(world, self._rng if rng is None else rng)

    def _load(self, world: World, rng: np.random.Generator) -> None:
        self._loaded = None
        self._stop.clear()
        self.client.empty()
        base = Base(self.client, world.start, self._observed)
        labels = self.recogniser.labels([o.type for o in world.objects], rng)
        self._by_body, self._noticed = {}, {}
        for item, label in zip(world.objects, labels, strict=True):
            body, placed = self._place(world, item, label)
            self._by_body[body] = placed
        radii = {placed.percept.id: placed.radius for placed in self._by_body.values()}
        self._loaded = _Visit(world, base, Driver(base, radii, self._notice, self._stop.is_set))
        if self._window:
            self._window.show(world, base.body, self.camera)

    def _place(self, world: World, item: WorldObject, label: str | None) -> tuple[int, _Placed]:
        """Put an object into the physics, recognised as `label`; its body number, and what is known of it."""
        distance = math.dist(item.position, (world.start.x, world.start.y))
        if not distance <= MAX_DISTANCE:
            raise SimulatorError(
                f"world {world.name}: {item.id} stands {distance:.4g} m from the robot; "
                f"move it within {MAX_DISTANCE:g} m"
            )
        try:
            body = add_object(self.client.id, item.type, item.color, item.position, item.yaw)
        except ValueError as error:
            raise SimulatorError(f"world {world.name}: {item.id}: {error}") from None
        percept = Percept(item.id, item.type, item.color, (*item.position, 0.0), extent(item.type))
        recognised = None if label is None else Percept(item.id, label, item.color, percept.position, percept.size)
        radius = footprint(item.type)
        if distance < radius + ROBOT_RADIUS:
            raise SimulatorError(f"world {world.name}: {item.id} stands where the robot starts; move one of them")
        return body, _Placed(percept, recognised, radius)

    def say(self, text: str) -> None:
        """Write a line into the window, if there is one."""
        if self._window:
            self._window.say(text)

    @property
    def world(self) -> World:
        """The world the robot is in."""
        return self._visit.world

    @property
    def bodies(self) -> dict[str, int]:
        """Object id -> body number in the physics client."""
        return {placed.percept.id: body for body, placed in self._by_body.items()}

    @property
    def pose(self) -> Pose:
        """Where the robot is."""
        return self._visit.base.pose

    @property
    def path_length(self) -> float:
        """Metres driven since the world was loaded."""
        return self._visit.base.path_length

    @property
    def turned(self) -> float:
        """Radians turned since the world was loaded, both directions counted positive."""
        return self._visit.base.turned

    @property
    def collisions(self) -> int:
        """How often the robot has come to touch an object since the world was loaded."""
        return self._visit.base.collisions

    @property
    def seconds(self) -> float:
        """Simulated seconds that the robot has moved since the world was loaded."""
        return self._visit.base.seconds

    def perceive(self) -> list[Percept]:
        """The recognised objects in view, in the order of the bearing from the middle of the view outwards."""
        seen = [placed.recognised for placed in self._look() if placed.recognised is not None]
        return sorted(seen, key=lambda percept: (abs(bearing(self.pose, *percept.position[:2])), percept.id))

    def picture(self, *, width: int = 320, height: int = 180) -> Pixels:
        """What the camera sees, as (height, width, 3) bytes."""
        return self.camera.picture(self.client, self.pose, width=width, height=height)

    def stop(self) -> None:
        """End the motion under way, and do nothing more until `resume` or `load`; any thread may call it."""
        self._stop.set()

    def resume(self) -> None:
        """Move again when asked to."""
        self._stop.clear()

    def spin(self, angle: float) -> None:
        """Turn in place by `angle` radians, left positive, to within 0.02.

        Raises:
            ValueError: `angle` is not finite, or more than `limits.MAX_SPIN`.
        """
        check_spin(angle)
        self._visit.driver.spin(angle)

    def drive_to(self, target: str, percepts: Sequence[Percept]) -> DriveResult:
        """Drive to the object `target` round all others; it has arrived within 0.5 m of it.

        The robot goes round `percepts` and whatever else it has seen in this world or notices on the way.

        Raises:
            ValueError: `target` is not among the percepts.
        """
        goal = find_percept(target, percepts)

        def plan(obstacles: dict[str, Circle]) -> Points | None:
            return navigation.approach(self._here, obstacles.pop(target), [*obstacles.values()])

        return self._drive(plan, goal.position[:2], percepts, lambda distance: distance <= ARRIVED)

    def drive_away(self, target: str, percepts: Sequence[Percept]) -> DriveResult:
        """Leave the surroundings of `target`: end 1.5 m or more from it, and farther than before.

        Raises:
            ValueError: `target` is not among the percepts.
        """
        goal = find_percept(target, percepts)
        least = max(LEFT, self._distance(goal.position[:2]))

        def plan(obstacles: dict[str, Circle]) -> Points | None:
            return navigation.retreat(self._here, obstacles.pop(target), [*obstacles.values()])

        return self._drive(plan, goal.position[:2], percepts, lambda distance: distance >= least)

    def go_to(self, x: float, y: float, percepts: Sequence[Percept]) -> DriveResult:
        """Drive to a place, round all objects, to see what can be seen from there; it is there within 0.1 m."""

        def plan(obstacles: dict[str, Circle]) -> Points | None:
            goals = np.array([[x, y]], dtype=np.float64)
            return navigation.shortest_path(self._here, goals, [*obstacles.values()])

        return self._drive(plan, (x, y), percepts, lambda distance: distance <= AT_PLACE)

    def _drive(
        self, plan: Planner, place: tuple[float, float], percepts: Sequence[Percept], there: Callable[[float], bool]
    ) -> DriveResult:
        """Drive by a plan; whether it arrived is said by the distance from `place` in the end."""
        if not self._distance(place) <= MAX_DISTANCE:
            return DriveResult.TOO_FAR
        # what is farther than any drive, or nowhere, is in no way
        near = (p for p in percepts if self._distance(p.position[:2]) <= 2 * MAX_DISTANCE)
        self._noticed |= {percept.id: percept for percept in near}
        result = self._visit.driver.follow(plan, self._noticed)
        if result is DriveResult.STOPPED:
            return result
        if there(self._distance(place)):
            return DriveResult.ARRIVED
        return DriveResult.BLOCKED if result is DriveResult.ARRIVED else result

    @property
    def _visit(self) -> _Visit:
        if self._loaded is None:
            raise SimulatorError("the robot is in no world yet; load one first")
        # the observer may be changed at any time
        self._loaded.base.on_tick = self.on_tick
        return self._loaded

    def _look(self) -> list[_Placed]:
        """What the camera shows now; it is remembered as an obstacle, recognised or not."""
        away = [body for body, placed in self._by_body.items() if not self._in_reach(placed)]
        if len(away) == len(self._by_body):
            return []
        counts = self.camera.pixels(self.client, self.pose, away)
        seen = [placed for body, placed in self._by_body.items() if counts.get(body, 0) >= self.recogniser.min_pixels]
        self._noticed.update((placed.percept.id, placed.percept) for placed in seen)
        return seen

    def _notice(self) -> Mapping[str, Percept]:
        """Look, unless there can be no news, and give all that has been noticed in this world."""
        strange = (p for p in self._by_body.values() if self._noticed.get(p.percept.id) != p.percept)
        if any(map(self._in_reach, strange)):
            self._look()
        return self._noticed

    def _in_reach(self, placed: _Placed) -> bool:
        return self.camera.in_reach(self.pose, placed.percept.position[:2], placed.radius)

    @property
    def _here(self) -> tuple[float, float]:
        return self.pose.x, self.pose.y

    def _distance(self, place: tuple[float, float]) -> float:
        return math.dist(self._here, place)
