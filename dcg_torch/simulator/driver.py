"""Follows planned paths by the wheels, looks on the way, and plans anew when something is in it."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass

from dcg_torch.simulator import navigation
from dcg_torch.simulator.navigation import Circle
from dcg_torch.simulator.track import Track
from dcg_torch.simulator.wheels import MAX_SPEED, ROBOT_RADIUS, Base, speed_towards, turn_towards
from dcg_torch.types import DriveResult, Percept
from dcg_torch.types.arrays import Points
from dcg_torch.types.geometry import wrap_angle

Planner = Callable[[dict[str, Circle]], Points | None]
"""A path from where the robot is among obstacles, given by the id of the object; None: there is no way."""

_LOOK_SECONDS, _LOOK_ANGLE = 0.4, 0.35  # while driving, look this often (simulated seconds; radians turned)
_SPIN_GAIN = 7.0  # 1/s, see `turn_towards`
_FACING = 0.5  # radians off course, beyond which it turns without driving on
_UNKNOWN_RADIUS = 0.22  # metres, for a percept that says no size
_PATIENCE, _SLOWNESS = 15.0, 4.0  # seconds, and times the least time, after which a drive is given up


@dataclass(frozen=True, slots=True)
class _Gait:
    """How a path is driven: metres between robot and objects, metres along the path that it steers to, m/s at most.

    Steering to a point ahead cuts corners, by less than the margin.
    """

    margin: float
    lookahead: float
    speed: float


_GAITS = (_Gait(0.08, 0.25, MAX_SPEED), _Gait(0.03, 0.10, 0.2))  # the second where the first has no way


class Driver:
    """Moves a base in one world.

    Args:
        base: the robot's body.
        radii: object id -> radius in metres, of all objects that there are.
        look: takes a look, and gives all that has been noticed in this world by then, by id.
        stopped: asked at every tick; when it says yes, the motion ends.
    """

    def __init__(
        self,
        base: Base,
        radii: Mapping[str, float],
        look: Callable[[], Mapping[str, Percept]],
        stopped: Callable[[], bool],
    ) -> None:
        self._base, self._radii, self._look, self._stopped = base, radii, look, stopped
        self._looked_at, self._looked_towards = -math.inf, math.inf

    def spin(self, angle: float) -> None:
        """Turn in place by `angle` radians, left positive, to within 0.02."""
        base = self._base
        goal = base.heading + angle
        deadline = base.seconds + 5.0 + abs(angle)
        while (
            (abs(goal - base.heading) > 0.004 or abs(base.turn) > 0.05)
            and base.seconds < deadline
            and not self._stopped()
        ):
            base.tick(0.0, turn_towards(goal - base.heading, _SPIN_GAIN))
        base.halt()

    def follow(self, plan: Planner, noticed: Mapping[str, Percept]) -> DriveResult:
        """Plan and drive; it ends standing still. ARRIVED is the end of the path, wherever that is.

        Args:
            noticed: the objects to go round, by id; what is noticed on the way is added.
        """
        self._looked_at, self._looked_towards = -math.inf, math.inf
        known, result = dict(noticed), None
        while result is None:
            planned = self._planned(plan, known)
            result = DriveResult.NO_WAY if planned is None else self._along(*planned, known)
        self._base.halt()
        return result

    def _along(self, track: Track, gait: _Gait, known: dict[str, Percept]) -> DriveResult | None:
        """Drive along a path until it ends; None as soon as something new is in the way. New objects enter `known`."""
        base = self._base
        deadline = base.seconds + _PATIENCE + _SLOWNESS * track.length / gait.speed
        while not self._stopped():
            progress = track.progress(base.pose.x, base.pose.y)
            left = track.length - progress
            if left < 0.01 and base.speed < 0.06:
                return DriveResult.ARRIVED
            if base.seconds > deadline:
                return DriveResult.BLOCKED
            ahead = track.point(progress + gait.lookahead)
            error = wrap_angle(math.atan2(ahead[1] - base.pose.y, ahead[0] - base.pose.x) - base.heading)
            if abs(error) < _FACING and self._wants_to_look(known):
                new = self._news(known)
                known |= new
                if not navigation.is_clear(
                    track.rest(progress), [*self._obstacles(new.values(), _GAITS[0].margin).values()]
                ):
                    return None
            speed = min(gait.speed, speed_towards(left))
            base.tick(speed * max(0.0, 1.0 - abs(error) / _FACING), turn_towards(error))
        return DriveResult.STOPPED

    def _wants_to_look(self, known: Mapping[str, Percept]) -> bool:
        """Is there anything left to notice, and is the last look a while ago?"""
        if known.keys() >= self._radii.keys():
            return False
        base = self._base
        return base.seconds - self._looked_at >= _LOOK_SECONDS or abs(base.heading - self._looked_towards) > _LOOK_ANGLE

    def _news(self, known: Mapping[str, Percept]) -> dict[str, Percept]:
        """Look, and give what was not known."""
        self._looked_at, self._looked_towards = self._base.seconds, self._base.heading
        return {id_: percept for id_, percept in self._look().items() if id_ not in known}

    def _planned(self, plan: Planner, known: Mapping[str, Percept]) -> tuple[Track, _Gait] | None:
        """The first path found, from a generous margin to a tight one, and how to drive it."""
        for gait in _GAITS:
            path = plan(self._obstacles(known.values(), gait.margin))
            if path is not None:
                return Track(path), gait
        return None

    def _obstacles(self, percepts: Iterable[Percept], margin: float) -> dict[str, Circle]:
        """Where the robot's middle must not go, by object."""
        circles = {}
        for percept in percepts:
            half = math.hypot(*percept.size[:2]) / 2 if percept.size else _UNKNOWN_RADIUS
            radius = self._radii.get(percept.id, half) + ROBOT_RADIUS + margin
            circles[percept.id] = Circle(percept.position[0], percept.position[1], radius)
        return circles
